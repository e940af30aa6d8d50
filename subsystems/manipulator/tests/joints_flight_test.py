#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""hirosco-arm of six joints with real processes, in its sandbox: it moves, its brakes have it when it is unplugged and when its control is killed in a motion, and
it flies again both times when it is asked to. How long a stop takes is judged by joints_flight_test.cpp."""
import pathlib
import threading
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"
PROGRAM = "hirosco-arm"
HOME = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
GOAL = (-0.5, 0.85, -0.4, 1.15, -0.3, 1.45)
TOLERANCE_RAD = 5e-3


class AnArmOfSixJoints(unittest.TestCase):
    def reach(self, craft, where):
        code, said = craft.tc("ARM", "MOVE_TO", *where, 2)
        self.assertEqual(code, 0, said)
        truth = craft.truth("arm")
        off = [abs(truth[f"q{i + 1}"] - wanted) for i, wanted in enumerate(where)]
        flight.measure("off its goal: " + ", ".join(f"{1e3 * each:.2f}" for each in off) + " mrad")
        self.assertLess(max(off), TOLERANCE_RAD)

    def stop(self, craft, where, how, told):
        """Its command is taken away by how() when it is half-way there, which is over when that is told."""
        begin = craft.count()
        moves = threading.Thread(target=craft.tc, args=("ARM", "MOVE_TO", *where, 4))
        moves.start()
        end = time.monotonic() + 5.0
        while abs((truth := craft.truth("arm"))["qd1"]) < 0.2 and time.monotonic() < end:
            time.sleep(0.01)
        self.assertGreaterEqual(abs(truth["qd1"]), 0.2)
        how()
        craft.wait_told(told, 10.0, begin)
        moves.join()
        time.sleep(0.5)
        rests = craft.truth("arm")
        for i, wanted in enumerate(where):
            self.assertLess(abs(rests[f"qd{i + 1}"]), 1e-3, rests)
            self.assertEqual(rests[f"motor_{i + 1}"], 0, rests)
            self.assertGreater(abs(rests[f"q{i + 1}"] - wanted), 0.1, "it did not arrive")

    def come_up(self, craft):
        """As soon as it may: who died is started again first."""
        end = time.monotonic() + 10.0
        while (asked := craft.tc("SUPERVISOR", "SET_MODE", "operation"))[0] != 0 and time.monotonic() < end:
            time.sleep(0.2)
        self.assertEqual(asked[0], 0, asked)

    def test_it_moves_stops_by_itself_and_flies_again(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.reach(craft, GOAL)
            self.stop(craft, HOME, lambda: craft.ask("arm", "unplug"), "ARM is Offline")
            craft.fault("arm", "plug")
            self.come_up(craft)
            self.reach(craft, HOME)
            self.stop(craft, GOAL, lambda: craft.kill(PROGRAM), "started ARM")
            self.come_up(craft)
            self.reach(craft, GOAL)
            craft.end()


if __name__ == "__main__":
    flight.main()
