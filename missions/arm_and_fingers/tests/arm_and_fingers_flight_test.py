#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The mission arm_and_fingers with real processes, in their sandboxes: two devices of one process and one world. It holds a loose box, lifts it, and
holds it also when the gripper is unplugged."""
import pathlib
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parents[1] / "mission.xml"
LIFTED = (0.5, 0.1, 1.0, 0.470796, -1.570796, 0.2)


class ArmAndFingers(unittest.TestCase):
    def test_it_lifts_a_box_and_goes_on_holding_it_when_it_is_unplugged(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            code, said = craft.tc("GRIPPER", "GRIP", 20, 0.05)[:2]
            self.assertEqual(code, 0, said)
            below = craft.truth("arm")
            flight.measure(f"pressed with {below['body_box_pressed_n'] / 2:.2f} N")
            self.assertAlmostEqual(below["body_box_pressed_n"] / 2, 20, delta=1.5)
            code, said = craft.tc("ARM", "MOVE_J", ",".join(str(q) for q in LIFTED), 1)[:2]
            self.assertEqual(code, 0, said)
            self.assertGreater(craft.truth("arm")["body_box_z"], below["body_box_z"] + 0.1)
            begin = craft.count()
            craft.fault("gripper", "unplug")
            craft.wait_told("GRIPPER is Offline", 10.0, begin)
            held = craft.truth("arm")
            time.sleep(0.5)
            self.assertAlmostEqual(craft.truth("arm")["body_box_z"], held["body_box_z"], delta=2e-3)
            craft.end()


if __name__ == "__main__":
    flight.main()
