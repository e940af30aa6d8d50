#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The mission six_joints with real processes, in their sandboxes: it moves, and an unplugged arm is held by its brakes."""
import pathlib
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parents[1] / "mission.xml"
GOAL = (-0.4, 0.2, 0.9, 0.1, 0.2, 0.5)


class SixJoints(unittest.TestCase):
    def test_it_moves_and_is_held_when_it_is_unplugged(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            code, said = craft.tc("ARM", "MOVE_J", ",".join(map(str, GOAL)), 0.8)[:2]
            self.assertEqual(code, 0, said)
            truth = craft.truth("arm")
            flight.measure("off its goal: " + ", ".join(f"{1e3 * abs(truth[f'q{i + 1}'] - goal):.2f}" for i, goal in enumerate(GOAL)) + " mrad")
            for i, goal in enumerate(GOAL):
                self.assertLess(abs(truth[f"q{i + 1}"] - goal), 1e-3)
            begin = craft.count()
            craft.fault("arm", "unplug")
            craft.wait_told("ARM is Offline", 10.0, begin)
            time.sleep(0.5)
            after = craft.truth("arm")
            for i in range(6):
                self.assertLess(abs(after[f"qd{i + 1}"]), 1e-3)
            craft.end()


if __name__ == "__main__":
    flight.main()
