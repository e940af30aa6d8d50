#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A robot with its gripper, made by one command and flown with real processes as it was made: goals, lines, something gripped and nothing,
devices unplugged, limits.

    new_robot_flight_test.py FILE TIP GRIPPER PLACE BUILD      FILE: of the repository, or of example-robot-data (77: it cannot be had)
                                                               PLACE: between the fingers, X,Y,Z in the tip's frame, m"""
import contextlib
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

import flight

FILE, TIP, GRIPPER, PLACE, BUILD = sys.argv[1:6]
NAME, SUBSYSTEM = "made", "MADE"


def given():
    if (file := flight.REPOSITORY / FILE).exists():
        return file
    sys.path[:0] = [str(flight.REPOSITORY / "tests/client")]
    import with_library
    os.environ["PYTHONPATH"] = os.pathsep.join([str(flight.REPOSITORY / "tests/robotics"), os.environ.get("PYTHONPATH", "")])
    python = with_library.interpreter_or_skip(pathlib.Path(BUILD) / "python_judges", "import robots; robots.folder()",
                                              flight.REPOSITORY / "tests/robotics/requirements.txt", 600)
    done = subprocess.run([python, "-c", "import robots; print(robots.folder())"], capture_output=True, text=True, check=True)
    return pathlib.Path(done.stdout.strip()) / FILE


def numbers(text):
    return [float(word) for word in text.split()]


def times(one, other):
    return [[sum(one[i][k] * other[k][j] for k in range(len(other))) for j in range(len(other[0]))] for i in range(len(one))]


def about(axis, angle):
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return [[c + x * x * d, x * y * d - z * s, x * z * d + y * s], [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d]]


def added(one, other):
    return [a + b for a, b in zip(one, other)]


def turned_by(orientation, place):
    w, x, y, z = orientation
    angle = 2 * math.acos(max(-1.0, min(1.0, w)))
    length = math.hypot(x, y, z) or 1.0
    turned = times(about((x / length, y / length, z / length), angle), [[each] for each in place])
    return [row[0] for row in turned]


class Robot:
    """What the test needs of the file, by a reader of its own."""

    def __init__(self, file):
        root = ElementTree.parse(file).getroot()
        self.joints = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
        moving = [joint for joint in root.findall("joint") if joint.get("type") != "fixed"]
        self.world = [joint.get("name") for joint in moving if joint.find("mimic") is None]  # as the world counts them
        self.arm = [name for name in self.world if name not in GRIPPER.split(",")]

    def turned(self, link, posture):
        """w x y z of a link in the axes of the base."""
        rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        while link in self.joints:
            joint = self.joints[link]
            origin = joint.find("origin")
            roll, pitch, yaw = numbers(origin.get("rpy", "0 0 0")) if origin is not None else (0, 0, 0)
            its = times(about((0, 0, 1), yaw), times(about((0, 1, 0), pitch), about((1, 0, 0), roll)))
            if joint.get("type") in ("revolute", "continuous"):
                its = times(its, about(numbers(joint.find("axis").get("xyz")), posture[joint.get("name")]))
            rotation, link = times(its, rotation), joint.find("parent").get("link")
        trace = sum(rotation[i][i] for i in range(3))
        # The largest part first: the others are told by it.
        parts = [trace] + [rotation[i][i] for i in range(3)]
        most = parts.index(max(parts))
        (a, b, c), (d, e, f), (g, h, i) = rotation
        if most == 0:
            found = [1 + trace, h - f, c - g, d - b]
        elif most == 1:
            found = [h - f, 1 + a - e - i, b + d, c + g]
        elif most == 2:
            found = [c - g, b + d, 1 + e - a - i, f + h]
        else:
            found = [d - b, c + g, f + h, 1 + i - a - e]
        length = math.hypot(*found)
        return [part / length for part in found]


class Made(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hirosco-new-robot-")
        self.addCleanup(folder.cleanup)
        self.file = given()
        self.hirosco("new", "robot", NAME, "--urdf", self.file, "--tip", TIP, "--gripper", GRIPPER, "--to", folder.name)
        self.folder = pathlib.Path(folder.name) / NAME
        self.mission = self.folder / "mission.xml"
        told = (self.folder / "README.md").read_text()
        self.goal = [float(word) for word in re.search(rf"tc {NAME} MOVE_J (\S+)", told)[1].split(",")]
        self.force, self.speed = map(float, re.search(rf"tc {NAME}_gripper GRIP (\S+) (\S+)", told).groups())

    def hirosco(self, *words):
        done = subprocess.run([str(flight.BINARIES / "hirosco"), *map(str, words)], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def does(self, craft, *words):
        code, reports = craft.tc(*words)[:2]
        self.assertEqual(code, 0, f"{words}: {reports}")

    def lean(self, craft, begin):
        """Ever harder: who falls on it at once meets the hard limit of a torque, which is another plan's."""
        force = 20.0
        while force < 5000:
            craft.fault(NAME, "push", 0, 0, -force)
            with contextlib.suppress(AssertionError):
                craft.wait_told("_LIMIT_EXCEEDED", 0.3, begin)
                return
            force *= 1.12
        self.fail("no limit was exceeded")

    def test_it_is_checked_and_simulates_the_same_octets_twice(self):
        self.hirosco("check", self.mission)
        first, second = (self.hirosco("simulate", self.mission, "--for", "3s", "--octets") for _ in range(2))
        self.assertIn("commissioned: mode operation", first)
        self.assertEqual(first, second)

    def test_it_flies_as_it_was_made(self):
        robot, hand = Robot(self.file), f"{SUBSYSTEM}_GRIPPER"

        def truth():
            found = craft.truth(NAME)
            return found, {name: found[f"q{i + 1}"] for i, name in enumerate(robot.world)}, [found[f"tip_{axis}"] for axis in "xyz"]

        with flight.Flight(self.mission) as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            self.does(craft, SUBSYSTEM, "MOVE_J", ",".join(map(str, self.goal)), 0.5)
            _, joints, tool = truth()
            off = max(abs(joints[name] - goal) for name, goal in zip(robot.arm, self.goal))
            self.assertLess(off, 1e-3)

            # Where a line of 30 mm goes to depends on where its joints have room.
            turned = ",".join(map(str, robot.turned(TIP, joints)))
            for axis, step in ((2, 0.03), (2, -0.03), (1, 0.03), (1, -0.03), (0, 0.03), (0, -0.03)):
                wanted = list(truth()[2])
                wanted[axis] += step
                code = craft.tc(SUBSYSTEM, "MOVE_L", ",".join(map(str, wanted)), turned, 0.1, 0.5)[0]
                if code == 0:
                    break
                time.sleep(1)  # it brakes
                self.does(craft, SUBSYSTEM, "MOVE_J", ",".join(map(str, self.goal)), 0.5)
            self.assertEqual(code, 0, "no line was gone to its end")
            _, _, tool = truth()
            beside = math.dist(tool, wanted)
            self.assertLess(beside, 1e-3)

            begin = craft.count()
            code, _ = craft.tc(hand, "GRIP", self.force, self.speed)[:2]
            self.assertNotEqual(code, 0, "there is nothing between its fingers")
            craft.wait_told("NOTHING_MET", 5.0, begin)
            self.does(craft, hand, "OPEN", self.speed)

            _, joints, tool = truth()
            between = added(tool, turned_by(robot.turned(TIP, joints), [float(word) for word in PLACE.split(",")]))
            craft.fault(NAME, "obstacle_ball", "sphere", 0.015, ",".join(map(str, between)), 0.5)
            self.does(craft, hand, "GRIP", self.force, self.speed)
            pressed = truth()[0]["contact_n"] / 2
            self.assertAlmostEqual(pressed, self.force, delta=0.1 * self.force)
            self.does(craft, hand, "OPEN", self.speed)
            craft.fault(NAME, "obstacle_ball", "none")
            flight.measure(f"{1e3 * off:.2f} mrad off its goal, {1e3 * beside:.2f} mm off the end of its line, gripped with {pressed:.1f} N of {self.force:g}")

            begin = craft.count()
            craft.fault(f"{NAME}_gripper", "unplug")
            craft.wait_told(f"{hand} is Offline", 10.0, begin)
            self.does(craft, SUBSYSTEM, "MOVE_J", ",".join(map(str, self.goal)), 0.5)

            # Whoever leans on it is no contact to stop at, but its limits hold.
            begin = craft.count()
            self.does(craft, SUBSYSTEM, "SET_CONTACT", 0, 1)
            self.lean(craft, begin)
            craft.fault(NAME, "push", 0, 0, 0)
            craft.wait_told(f"{SUBSYSTEM} info STATE_CHANGED STATE=SafeOperational", 5.0, begin)

            begin = craft.count()
            craft.fault(NAME, "unplug")
            craft.wait_told(f"{SUBSYSTEM} is Offline", 10.0, begin)
            time.sleep(0.5)
            after = truth()[0]
            self.assertLess(max(abs(after[f"qd{i + 1}"]) for i in range(len(robot.world))), 1e-3)
            craft.end()


if __name__ == "__main__":
    del sys.argv[1:6]
    flight.main()
