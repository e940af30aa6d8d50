#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of real processes in a mission whose plan brings them back to the commanded state (docs/adr/0076): state, configuration,
a parameter set by telecommand, a housekeeping interval, an event that is not reported, links; and of the ground link, which changes
nothing of theirs. `--kills N` of each of the three."""
import struct
import sys
import time

import flight
from operators import Operator

KILLS = int(sys.argv.pop(sys.argv.index("--kills") + 1)) if "--kills" in sys.argv else 3
if "--kills" in sys.argv:
    sys.argv.remove("--kills")
# A death every other second is no crash loop here: the limit counts those of one second.
PLAN = {"60": '1" pause_ms="20" to="commanded'}
POS_SCALE = flight.MANIPULATOR << 16 | 10 << 8 | 8     # its id on the wire: subsystem, layout DOUBLE, number
STATE_CHANGED = 0xF000
COUPLED = 2


class Restoration(flight.unittest.TestCase):
    def settings_are_made(self, rokviss, operator):
        self.assertEqual(rokviss.tc("manipulator", "SET_STATE", 4)[0], 0)
        self.assertEqual(operator.send(20, 3, struct.pack(">BId", 1, POS_SCALE, 0.9)), 7)
        self.assertEqual(rokviss.tc("manipulator", "SET_STATE", 5)[0], 0)
        self.assertEqual(operator.send(3, 31, struct.pack(">BHI", 1, 4711, 1000)), 7)
        self.assertEqual(operator.send(5, 6, struct.pack(">BH", 1, STATE_CHANGED)), 7)

    def all_is_as_commanded(self, rokviss, operator):
        operator.forget()
        self.assertEqual(operator.send(20, 1, struct.pack(">BI", 1, POS_SCALE)), 7)
        self.assertEqual(operator.newest(20, 2), struct.pack(">BId", 1, POS_SCALE, 0.9))
        self.assertEqual(operator.send(3, 33, struct.pack(">BH", 1, 4711)), 7)
        self.assertEqual(operator.newest(3, 35), struct.pack(">BHBI", 1, 4711, 1, 1000))
        self.assertEqual(operator.send(5, 7, b""), 7)
        self.assertEqual(operator.newest(5, 8), struct.pack(">BH", 1, STATE_CHANGED))
        back = rokviss.wait_status(lambda status: all(
            member["state"] == "Operational" for member in status["subsystems"] if member["name"] != "SUPERVISOR"), 3.0)
        self.assertIsNotNone(back)
        # The links deliver: the robot hears the hand.
        operator.forget()
        self.assertLess(operator.wait_housekeeping(4721, 2)[-1][1]["peer_age"], 50)

    def test_who_is_killed_comes_back_as_commanded(self):
        took = {"manipulator": [], "joystick": [], "telepresence-relay": []}
        told = {"telepresence-relay": "the ground link is back"}
        with flight.MissionCopy(PLAN) as mission, flight.Flight(mission) as rokviss:
            rokviss.wait_commissioned()
            operator = Operator().__enter__()
            try:
                self.settings_are_made(rokviss, operator)
                self.all_is_as_commanded(rokviss, operator)
                for name in [*took] * KILLS:
                    before, begin = rokviss.pid_of(f"hirosco-{name}"), rokviss.count()
                    killed = rokviss.kill(f"hirosco-{name}")
                    back = rokviss.wait_told(told.get(name, ": as commanded"), 20.0, begin)
                    took[name].append(back.received - killed)
                    self.assertNotEqual(rokviss.pid_of(f"hirosco-{name}"), before)
                    if name in told:        # who listened by it has to come again
                        operator.__exit__()
                        operator = Operator().__enter__()
                    self.all_is_as_commanded(rokviss, operator)
                    time.sleep(1.0)
            finally:
                operator.__exit__()
        for name, seconds in took.items():
            seconds.sort()
            flight.measure(f"{name}: {len(seconds)} kills, back as commanded after {seconds[len(seconds) // 2]:.2f} s (median), "
                           f"{seconds[-1]:.2f} s at most")


if __name__ == "__main__":
    flight.main()
