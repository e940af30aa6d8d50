#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Robots of example-robot-data keep from themselves: random goals whose straight path coal finds free on the meshes as they are, and such where it finds a
collision, are asked of the arm itself, which flies on virtual time without gravity. What it did is judged by coal again, all along the way.

    collisions_test.py COLLISION_PROBE [--goals 300] [--robots ur5_robot,panda,...] [--seed 1]

Prints both counts of each robot; ends with 1 unless of so many goals each at least 95 % of the free ones were reached, and all colliding ones refused, or
stopped before contact, because of a pair that was too near. What is refused for its way is jogged along it besides, which nobody judges beforehand, and
touches nobody either."""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy

import collision_judge
import robots

# Which file, where its tool is, what of it is somebody else's and where that is in flight, who follows whom. The second Panda is as `hirosco new robot
# --gripper` makes it: its fingers are the gripper's, and a flight begins with them open.
FOLLOWS = {"panda_finger_joint2": "panda_finger_joint1"}
ROBOTS = {"ur5_robot": ("ur5_robot", "tool0", {}, {}), "panda": ("panda", "panda_hand_tcp", {}, FOLLOWS),
          "panda_and_gripper": ("panda", "panda_hand_tcp", {"panda_finger_joint1": 0.04}, FOLLOWS), "xarm7": ("xarm7", "link_eef", {}, {}),
          "kinova": ("kinova", "j2s6s200_end_effector", {}, {}),
          "tiago_no_hand": ("tiago_no_hand", "wrist_ft_tool_link", {"wheel_left_joint": 0, "wheel_right_joint": 0}, {})}
LEAST_REACHED = 0.95
TOO_NEAR = "800a"
NOT_MOVED = 1e-3  # rad or m


class Arm:
    """The probe with one robot."""

    def __init__(self, probe, name, folder):
        self.name = name
        stem, self.tip, stands, mimics = ROBOTS[name]
        source = next(path for path in robots.files() if path.stem == stem)
        self.urdf = folder / f"{name}.urdf"
        shutil.copy(source, self.urdf)
        if not (beside := folder / "example-robot-data").exists():
            beside.symlink_to(robots.folder().parent)
        self.process = subprocess.Popen([probe, self.urdf, self.tip, ",".join(stands)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        joints = []
        for words in (line.split() for line in self.process.stdout):
            if words[0] == "joint":
                joints.append((words[1], float(words[2]), float(words[3])))
            elif words[0] == "read":
                break
        else:
            sys.exit(f"{name}: the probe does not read it")
        self.judge = collision_judge.Judge(self.urdf, joints, stands, mimics)

    def move(self, start, goal, how="move"):
        """What became of it, and where it was. As a "jog" nobody judges the way beforehand."""
        print(how, *start, *goal, file=self.process.stdin, flush=True)
        trail = []
        for line in self.process.stdout:
            words = line.split()
            if words[0] == "at":
                trail.append(numpy.array(words[1:], dtype=float))
            elif words[0] == "ended":
                return line.split(maxsplit=1)[1].strip(), trail
        sys.exit(f"{self.name}: the probe is gone")


def outcome_of(text):
    """reached, refused, stopped, or what else it was."""
    reports = text.split(" off ")[0].split()
    off = float(text.split(" off ")[1].split()[0])
    if reports[-1] == "7":
        return "reached" if off < 1.1e-3 else f"done {off} off"
    kind, _, code = reports[-1].partition(":")
    if code[:4].lower() == TOO_NEAR:
        return "refused" if kind == "4" else "stopped"
    return text


def campaign(arm, goals, seed):
    random = numpy.random.default_rng(seed)
    began = time.process_time()
    said = arm.judge.learn(random)
    print(f"{arm.name}: {len(arm.judge.pairs)} pairs", *said, sep="\n    ", flush=True)
    counts = {"free": {}, "colliding": {}}
    wrong, near, jogs, stopped = [], 0, 0, 0
    while min(sum(found.values()) for found in counts.values()) < goals:
        start = arm.judge.anywhere(random)
        if not arm.judge.is_free(start):
            continue
        goal = arm.judge.anywhere(random)
        # Once there are free ones enough, whoever touches nothing at some places of the way is not looked at closely.
        if sum(counts["free"].values()) >= goals and not arm.judge.touches(start, goal):
            continue
        verdict, whom = arm.judge.path(start, goal)
        if verdict == "near":
            near += 1
            continue
        if sum(counts[verdict].values()) >= goals:
            continue
        text, trail = arm.move(start, goal)
        became = outcome_of(text)
        if became == "stopped" and trail and max(numpy.abs(where - start).max() for where in trail) < NOT_MOVED:
            became = "refused"  # its way was judged while it stood
            # Whoever looks ahead on the way is to do without that.
            jogged, trail = arm.move(start, goal, "jog")
            jogs, stopped = jogs + 1, stopped + (outcome_of(jogged) == "stopped")
            if touched := arm.judge.contact(trail):
                became = f"contact of {touched} on a jog"
        if became in ("reached", "stopped") and (touched := arm.judge.contact(trail)):
            became = f"contact of {touched}"
        kind = became if became in ("reached", "refused", "stopped") else "other"
        counts[verdict][kind] = counts[verdict].get(kind, 0) + 1
        if kind not in (("reached",) if verdict == "free" else ("refused", "stopped")):
            wrong.append(f"{verdict} {whom}: {became}, {text}: from {start.tolist()} to {goal.tolist()}")
    free, colliding = counts["free"], counts["colliding"]
    reached, kept = free.get("reached", 0), colliding.get("refused", 0) + colliding.get("stopped", 0)
    good = reached >= LEAST_REACHED * goals and kept == goals and not any(" contact of " in text for text in wrong)
    print(*wrong, sep="\n")
    print(f"{'ok      ' if good else 'FAILED  '}{arm.name}: of {goals} free {reached} reached ({free}); of {goals} colliding {kept} refused or stopped before "
          f"contact ({colliding}), {stopped} of {jogs} jogs too; {near} were neither; {time.process_time() - began:.0f} s of the judge", flush=True)
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("probe", type=pathlib.Path)
    parser.add_argument("--goals", type=int, default=300)
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        results = [campaign(Arm(options.probe, name, pathlib.Path(folder)), options.goals, options.seed) for name in options.robots.split(",")]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
