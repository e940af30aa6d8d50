#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Motions from point to point take at most 1.1 times as long as Ruckig's of the same kind under the same limits: with a curve for each joint, and straight
from posture to posture as an arm goes (docs/adr/0126), where Ruckig goes straight, too. None is quicker than the quickest there is. How much longer the
straight way is than Ruckig's quickest is told (docs/adr/0231).

    ruckig_test.py PROBE"""
import subprocess
import sys

import numpy
import ruckig

MOTIONS = 2000
LONGEST = 1.1
QUICKEST = 1 - 1e-9
# Of so many Ruckig finds the straight way at least, or nothing was compared.
LEAST_STRAIGHT = MOTIONS // 10


def theirs(motion, straight=False):
    """How long, and whether it goes straight."""
    count = len(motion)
    asked = ruckig.InputParameter(count)
    asked.current_position, asked.target_position, asked.max_velocity, asked.max_acceleration, asked.max_jerk = map(list, motion.T)
    zero = [0.0] * count
    asked.current_velocity = asked.current_acceleration = asked.target_velocity = asked.target_acceleration = zero
    if straight:
        asked.synchronization = ruckig.Synchronization.Phase
    found = ruckig.Trajectory(count)
    result = ruckig.Ruckig(count).calculate(asked, found)
    if result != ruckig.Result.Working:
        sys.exit(f"Ruckig has no trajectory: {result}")
    begin, way = motion[:, 0], motion[:, 1] - motion[:, 0]
    shares = [(numpy.array(found.at_time(part * found.duration)[0]) - begin) / way for part in (0.2, 0.4, 0.6, 0.8)]
    return found.duration, all(numpy.ptp(share) < 1e-6 for share in shares)


def ours(probe, how, motions):
    lines = [" ".join([str(len(motion)), *(repr(float(value)) for value in motion.reshape(-1))]) for motion in motions]
    done = subprocess.run([probe, how], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return numpy.array([float(each) for each in done.stdout.split()])


def judge(what, ratios, least):
    good = len(ratios) >= least and ratios.max() <= LONGEST and ratios.min() >= QUICKEST
    print(f"{len(ratios)} motions of 1 to 7 joints, {what}: {ratios.min():.9f} to {ratios.max():.9f} of Ruckig's time{'' if good else ': NOT AS IT IS TO BE'}")
    return good


def main():
    random = numpy.random.default_rng(1)
    motions = []
    for _ in range(MOTIONS):
        count = random.integers(1, 8)
        motions.append(numpy.column_stack([random.uniform(-3, 3, count), random.uniform(-3, 3, count), 10 ** random.uniform(-1.5, 1.5, (count, 3))]))
    quickest = numpy.array([theirs(motion)[0] for motion in motions])
    straight = ours(sys.argv[1], "straight", motions)
    alike = [(mine, its) for mine, (its, goes_straight) in zip(straight, (theirs(motion, True) for motion in motions)) if goes_straight]
    good = judge("a curve for each joint", ours(sys.argv[1], "free", motions) / quickest, MOTIONS)
    good &= judge("straight", numpy.array([mine / its for mine, its in alike]), LEAST_STRAIGHT)
    longer = straight / quickest
    print(f"straight beside Ruckig's quickest: median {numpy.median(longer):.3f}, at most {longer.max():.3f}, above {LONGEST} {numpy.mean(longer > LONGEST):.1%}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
