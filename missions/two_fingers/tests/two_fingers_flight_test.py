#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The mission two_fingers with real processes, in their sandboxes: it holds a loose box, also when it is unplugged."""
import pathlib
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parents[1] / "mission.xml"


class TwoFingers(unittest.TestCase):
    def test_it_holds_a_box_and_goes_on_when_it_is_unplugged(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            code, said = craft.tc("GRIPPER", "GRIP", 20, 0.05)[:2]
            self.assertEqual(code, 0, said)
            craft.fault("gripper", "obstacle_table", "none")
            time.sleep(0.5)
            held = craft.truth("gripper")
            flight.measure(f"pressed with {held['body_box_pressed_n'] / 2:.2f} N")
            self.assertAlmostEqual(held["body_box_pressed_n"] / 2, 20, delta=1.5)
            begin = craft.count()
            craft.fault("gripper", "unplug")
            craft.wait_told("GRIPPER is Offline", 10.0, begin)
            time.sleep(0.5)
            self.assertAlmostEqual(craft.truth("gripper")["body_box_z"], held["body_box_z"], delta=2e-3)
            craft.end()


if __name__ == "__main__":
    flight.main()
