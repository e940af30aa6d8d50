#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""RO8 and RO9 once each on the real processes; figures are judged in simulation (missions/rokviss/tests), the way is judged here."""
import time
import unittest

import flight


class TorqueLimit(unittest.TestCase):
    def test_ro8_pressing_too_hard_makes_the_robot_limp_and_the_hand_feels_nothing(self):
        with flight.Flight() as rokviss, _telemetry(rokviss) as telemetry:
            rokviss.fault("joystick", "hand", "hold", 0, 0)
            time.sleep(2.0)
            begin = rokviss.count()
            before = time.monotonic()
            rokviss.fault("joystick", "hand", "ramp", 0.065, 0, 0.04)
            asked = rokviss.truth("joystick")["world_s"]
            event = rokviss.wait_told("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED", 5.0, begin)
            # In the time of the hand's world, which stands still while the host keeps the processor or the memory of who moves it.
            took = rokviss.truth("joystick")["world_s"] - asked
            safe = rokviss.wait_told("MANIPULATOR info STATE_CHANGED STATE=SafeOperational", 2.0, begin)
            flight.measure(f"RO8: {event.told} {took:.3f} s after the ramp (0.740 expected), "
                           f"SafeOperational {1e3 * (safe.at_s - event.at_s):.1f} ms later")
            self.assertGreater(event.received - before, 0.740 - 0.1)
            self.assertLess(took, 0.740 + 0.1)
            value = float(event.told.split("VALUE=")[1].split()[0])
            self.assertGreater(abs(value), 12.0)
            self.assertLess(abs(value), 12.5)
            time.sleep(0.5)
            telemetry.forget()
            time.sleep(1.0)
            self.the_joystick_shows_nothing(rokviss, telemetry)
            self.assertEqual(rokviss.truth("robot")["force"], 0.0)
            status = rokviss.wait_status(lambda s: True, 3.0)
            states = {member["name"]: member["state"] for member in status["subsystems"]}
            self.assertEqual((states["MANIPULATOR"], states["JOYSTICK"]), ("SafeOperational", "Operational"))
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def the_joystick_shows_nothing(self, rokviss, telemetry):
        shown = [values["torque"] for _, values in telemetry.wait_housekeeping(4721, 2)]
        self.assertEqual(set(shown), {(0.0, 0.0)})
        truth = rokviss.truth("joystick")
        self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))


class Unplugged(unittest.TestCase):
    def test_ro9_an_unplugged_joystick_in_free_motion_stops_both(self):
        self.stops_both("joystick", "JOYSTICK high JOYSTICK_LOST", ("hand", "sine", 2, 0.05, 0.5), "robot")

    def test_ro9_an_unplugged_robot_in_contact_stops_both(self):
        self.stops_both("robot", "MANIPULATOR high ROBOT_LOST", ("hand", "cartesian", 0.0226, 0, 1), "joystick")

    def stops_both(self, device, event, hand, other):
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            rokviss.fault("joystick", *hand)
            time.sleep(2.0)
            begin = rokviss.count()
            rokviss.fault(device, "unplug")
            lost = rokviss.wait_told(event, 2.0, begin)
            ends = [rokviss.wait_told(f"{name} is Offline", 3.0, begin) for name in ("MANIPULATOR", "JOYSTICK")]
            took = max(end.at_s for end in ends) - lost.at_s
            self.assertLess(took, 2.0)
            rokviss.wait_at_rest(other, lost.received)
            told = [line.told for line in rokviss.told(begin)]
            self.assertTrue([text for text in told if "plan network-down: network {" in text and
                             "MANIPULATOR" in text and "JOYSTICK" in text], told)
            members = {m["name"]: m for m in rokviss.wait_status(lambda s: True, 3.0)["subsystems"]}
            late = {name: members[name]["inhibited_at_cycle"] - members[name]["stopped_at_cycle"]
                    for name in ("MANIPULATOR", "JOYSTICK")}
            self.assertLessEqual(max(late.values()), 5)
            flight.measure(f"RO9 {device}: both Offline {1e3 * took:.1f} ms after the event; actuators inhibited {late} "
                           "own cycles after the supervisor's detection")
            for subsystem in ("supervisor", "communication", "manipulator", "joystick"):
                self.assertEqual(rokviss.tc(subsystem, "ping")[0], 0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
        self.assertEqual(flight.segments(), before)


def _telemetry(rokviss):
    rokviss.wait_commissioned()
    return flight.Telemetry()


if __name__ == "__main__":
    flight.main()
