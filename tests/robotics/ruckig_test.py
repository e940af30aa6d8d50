#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Motions from point to point take at most 1.1 times as long as Ruckig's under the same limits; and none is quicker than the
quickest there is.

    ruckig_test.py PROBE"""
import subprocess
import sys

import numpy
import ruckig

MOTIONS = 2000
LONGEST = 1.1
QUICKEST = 1 - 1e-9


def theirs(motion):
    count = len(motion)
    asked = ruckig.InputParameter(count)
    asked.current_position, asked.target_position, asked.max_velocity, asked.max_acceleration, asked.max_jerk = map(list, motion.T)
    zero = [0.0] * count
    asked.current_velocity = asked.current_acceleration = asked.target_velocity = asked.target_acceleration = zero
    found = ruckig.Trajectory(count)
    result = ruckig.Ruckig(count).calculate(asked, found)
    if result != ruckig.Result.Working:
        sys.exit(f"Ruckig has no trajectory: {result}")
    return found.duration


def main():
    random = numpy.random.default_rng(1)
    motions = []
    for _ in range(MOTIONS):
        count = random.integers(1, 8)
        motions.append(numpy.column_stack([random.uniform(-3, 3, count), random.uniform(-3, 3, count), 10 ** random.uniform(-1.5, 1.5, (count, 3))]))
    lines = [" ".join([str(len(motion)), *(repr(float(value)) for value in motion.reshape(-1))]) for motion in motions]
    done = subprocess.run([sys.argv[1]], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    ratios = numpy.array([float(ours) for ours in done.stdout.split()]) / [theirs(motion) for motion in motions]
    print(f"{MOTIONS} motions of 1 to 7 joints: {ratios.min():.9f} to {ratios.max():.9f} of Ruckig's time")
    return 0 if len(ratios) == MOTIONS and ratios.max() <= LONGEST and ratios.min() >= QUICKEST else 1


if __name__ == "__main__":
    sys.exit(main())
