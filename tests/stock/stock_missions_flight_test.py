#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The missions of this folder with real processes: what is ready in subsystems/ flies in a mission that is not its own."""
import pathlib
import time
import unittest

import flight

HERE = pathlib.Path(__file__).resolve().parent


class StockMissions(unittest.TestCase):
    def test_a_relay_alone_joins_hand_and_arm(self):
        with flight.Flight(HERE / "relay.xml") as craft:
            craft.wait_told("commissioned: mode remote", 30.0)
            begin = craft.count()
            self.assertEqual(craft.tc("COMMUNICATION", "SET_DELAY", 20, 1)[0], 0)
            craft.wait_told("plan ground-lost: MANIPULATOR to SafeOperational", 10.0, begin)
            craft.wait_told("MANIPULATOR info STATE_CHANGED STATE=SafeOperational", 5.0, begin)
            craft.end()

    def test_a_platform_goes_through_an_eclipse(self):
        with flight.Flight(HERE / "platform.xml") as craft:
            craft.wait_told("commissioned: mode station", 30.0)
            begin = craft.count()
            craft.fault("power", "eclipse on")
            craft.wait_told("ECLIPSE_BEGINS", 5.0, begin)
            time.sleep(1.5)  # each half second the supervisor hears what power there is
            self.assertNotEqual(craft.tc("SUPERVISOR", "SET_MODE", "work")[0], 0, "there is no power for the arm")
            craft.fault("power", "eclipse off")
            craft.wait_told("ECLIPSE_ENDS", 5.0, begin)
            time.sleep(1.5)
            code, said = craft.tc("SUPERVISOR", "SET_MODE", "work")[:2]
            self.assertEqual(code, 0, said)
            craft.end()

    def test_a_script_takes_a_box_and_puts_it_back(self):
        with flight.Flight(HERE / "pick.xml") as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            before = craft.truth("arm")
            code, said = craft.tc("PLAYER", "PLAY", "PICK_AND_PUT_BACK")[:2]
            self.assertEqual(code, 0, said)
            self.assertAlmostEqual(craft.truth("arm")["body_box_z"], before["body_box_z"], delta=5e-3)
            craft.end()


if __name__ == "__main__":
    flight.main()
