#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The mission servicer with real processes: one device program has joints and base in one world, the arm moves its tool, and when its
control is killed in motion the AOCS takes the station over. Before that the sun does not suffice for the arm, and goes while it moves."""
import math
import pathlib
import threading
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parents[1] / "mission.xml"


def turned_deg(base):
    return math.degrees(2 * math.atan2(math.hypot(base["qx"], base["qy"], base["qz"]), abs(base["qw"])))


class Servicer(unittest.TestCase):
    def test_it_tracks_and_hands_its_station_over(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode coast", 30.0)
            begin = craft.count()
            craft.fault("power", "sun_angle 70")
            time.sleep(1.2)
            code, said = craft.tc("SUPERVISOR", "SET_MODE", "track")[:2]
            self.assertNotEqual(code, 0, said)
            craft.wait_told("MCS needs 260 W, 257.818 W of 457.818 W are free: POWER.BUDGET_W measures it", 2.0, begin)
            craft.fault("power", "sun_angle 0")
            time.sleep(1.2)
            code, said = craft.tc("SUPERVISOR", "SET_MODE", "track")[:2]
            self.assertEqual(code, 0, said)
            begin = craft.count()
            moves = threading.Thread(target=craft.tc, args=("MCS", "MOVE_TOOL", "0.02,0,0", 8))
            moves.start()
            time.sleep(2)
            craft.ask("power", "eclipse on")
            craft.wait_told("MCS to SafeOperational because of BUS_LOW", 2.0, begin)
            moves.join()
            for i in range(7):
                self.assertLess(abs(craft.truth("arm")[f"qd{i + 1}"]), 1e-3)
            craft.fault("power", "eclipse off")
            time.sleep(1.2)
            for mode in ("coast", "track"):
                code, said = craft.tc("SUPERVISOR", "SET_MODE", mode)[:2]
                self.assertEqual(code, 0, said)
            before = craft.truth("arm")
            code, said = craft.tc("MCS", "MOVE_TOOL", "0.02,0,0", 3)[:2]
            self.assertEqual(code, 0, said)
            after = craft.truth("arm")
            flight.measure(f"tool went {1e3 * (after['tip_x'] - before['tip_x']):.2f} mm of 20, base turned by {turned_deg(craft.truth('base')):.3f} deg")
            self.assertLess(abs(after["tip_x"] - before["tip_x"] - 0.02), 2e-3)
            begin = craft.count()
            craft.kill("hirosco-floating-arm")
            craft.wait_told("is with AOCS", 10.0, begin)
            turned = turned_deg(craft.truth("base"))
            time.sleep(3)
            base = craft.truth("base")
            flight.measure(f"attitude off by {turned:.3f} deg at the hand-over, by {turned_deg(base):.3f} deg after 3 s")
            self.assertLess(turned_deg(base), turned)
            for i in range(7):
                self.assertLess(abs(craft.truth("arm")[f"qd{i + 1}"]), 1e-3)
            craft.end()


if __name__ == "__main__":
    flight.main()
