#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""One flight of the real processes through configurations, laws and hands by telecommand, without a restart."""
import time
import unittest

import flight

MEMBERS = ("MANIPULATOR", "JOYSTICK", "COMMUNICATION")


class Switching(unittest.TestCase):
    def test_configurations_laws_and_hands_follow_one_another(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.a_commanded_hand_leads_the_robot(rokviss)
            self.laws_change_and_nonsense_is_refused(rokviss)
            self.the_spring_programme_runs_on_board(rokviss)
            self.the_joystick_goes_to_ground(rokviss)
            self.a_hot_joint_stops_the_robot_alone(rokviss)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def done(self, rokviss, *words):
        code, reports = rokviss.tc(*words)
        self.assertEqual(code, 0, f"{words}: {reports}")
        return reports

    def refused(self, rokviss, reason, *words):
        result = rokviss.hirosco("tc", *map(str, words), "--mission", rokviss.mission)
        self.assertNotEqual(result.returncode, 0, words)
        self.assertIn(reason, result.stdout + result.stderr)

    def a_commanded_hand_leads_the_robot(self, rokviss):
        self.done(rokviss, "JOYSTICK", "SET_HAND", 1)
        self.done(rokviss, "JOYSTICK", "HAND", 0, 0)
        time.sleep(1.0)
        before = rokviss.truth("robot")
        self.done(rokviss, "JOYSTICK", "HAND", 0.1, 0)
        time.sleep(1.5)
        after = rokviss.truth("robot")
        # 0.1 rad of the first joint move a tip that is 0.3275 m away by 33 mm.
        self.assertAlmostEqual(after["tip_y"] - before["tip_y"], 0.033, delta=0.004)
        self.done(rokviss, "JOYSTICK", "HAND", 0, 0)
        time.sleep(1.0)

    def laws_change_and_nonsense_is_refused(self, rokviss):
        self.done(rokviss, "JOYSTICK", "PASSIVITY", 1)
        self.done(rokviss, "JOYSTICK", "PASSIVITY", 0)
        self.refused(rokviss, "not permitted now", "JOYSTICK", "SET_HAND", 2)
        self.refused(rokviss, "not permitted in this mode", "MANIPULATOR", "RUN_SCRIPT", 1)
        self.refused(rokviss, "not permitted in this mode", "COMMUNICATION", "SET_DELAY", 20, 0)

    def the_spring_programme_runs_on_board(self, rokviss):
        self.done(rokviss, "SUPERVISOR", "SET_MODE", "automatic")
        self.refused(rokviss, "not permitted in this mode", "JOYSTICK", "HAND", 0, 0)
        begin = time.monotonic()
        reports = self.done(rokviss, "MANIPULATOR", "RUN_SCRIPT", 2)
        flight.measure(f"spring programme: {time.monotonic() - begin:.2f} s (9 expected)")
        self.assertEqual(reports.count("1,5"), 4, reports)

    def the_joystick_goes_to_ground(self, rokviss):
        """Its own ground link is reconfigured by telecommands over that very link."""
        self.done(rokviss, "SUPERVISOR", "SET_MODE", "remote")
        self.done(rokviss, "COMMUNICATION", "SET_DELAY", 30, 0.001)
        self.done(rokviss, "JOYSTICK", "SET_HAND", 1)
        self.done(rokviss, "JOYSTICK", "HAND", 0, 0)
        time.sleep(1.0)
        before = rokviss.truth("robot")
        self.done(rokviss, "JOYSTICK", "HAND", -0.1, 0)
        time.sleep(1.5)
        self.assertAlmostEqual(rokviss.truth("robot")["tip_y"] - before["tip_y"], -0.033, delta=0.005)

    def a_hot_joint_stops_the_robot_alone(self, rokviss):
        begin = rokviss.count()
        rokviss.fault("robot", "temperature", 2, 72)
        rokviss.wait_told("MANIPULATOR medium TEMPERATURE_CRITICAL", 2.0, begin)
        rokviss.wait_told("MANIPULATOR info STATE_CHANGED STATE=SafeOperational", 2.0, begin)
        status = rokviss.wait_status(lambda s: True, 3.0)
        states = {member["name"]: member["state"] for member in status["subsystems"]}
        self.assertEqual([states[member] for member in MEMBERS], ["SafeOperational", "Operational", "Operational"])


if __name__ == "__main__":
    flight.main()
