#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Supervisor or keeper are killed, stopped or spin while the robot pushes: it stops, nobody is left behind, and who is left
says so (hazard SF18, reliability 5.1)."""
import os
import pathlib
import signal
import tempfile
import time
import unittest

import flight

ORPHANS_GONE_S = 10.0
# supervisor/keeper/keeper.hpp: how long keeper or supervisor may stand still; Guard::supervisor_limit; and the pace at
# which either is looked at.
PATIENCE_S, GUARD_S, PACE_S = 3.0, 1.0, 0.5


class StandsStill(unittest.TestCase):
    def push(self, craft):
        """The robot pushes on the rail; that does not pass by itself."""
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")

    def test_a_killed_supervisor_leaves_a_robot_that_stops_by_itself_though_no_keeper_looks(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            rokviss.process.send_signal(signal.SIGSTOP)
            killed = rokviss.kill("hirosco-supervisor")
            rokviss.wait_at_rest("robot", killed)
            rokviss.process.send_signal(signal.SIGCONT)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            self.assertEqual(rokviss.process.wait(5.0), 4, "ended by a signal")

    def test_a_supervisor_that_stands_still_stops_the_robot_at_once_and_is_ended_by_its_keeper(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            stopped = rokviss.kill("hirosco-supervisor", signal.SIGSTOP)
            rokviss.wait_at_rest("robot", stopped)
            self.is_ended(rokviss, stopped)

    def test_a_supervisor_that_spins_is_stopped_for_by_its_guard_and_ended_by_its_keeper(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-spinnable-", dir=flight.BINARIES) as programs:
            for program in flight.BINARIES.glob("hirosco*"):
                if program.is_file() and program.name != "hirosco-supervisor":
                    os.link(program, pathlib.Path(programs) / program.name)
            os.link(flight.BINARIES / "hirosco-spinnable-supervisor", pathlib.Path(programs) / "hirosco-supervisor")
            with flight.Flight(binaries=programs) as rokviss:
                rokviss.wait_commissioned()
                self.push(rokviss)
                # To the process: its first thread, which is the supervisor's loop, takes it.
                spins = rokviss.kill("hirosco-supervisor", signal.SIGUSR2)
                time.sleep(max(0.0, spins + GUARD_S + PACE_S / 10 - time.monotonic()))
                rokviss.wait_at_rest("robot", spins + GUARD_S + PACE_S)
                self.is_ended(rokviss, spins)

    def is_ended(self, rokviss, since):
        self.assertEqual(rokviss.wait_until_gone(PATIENCE_S + ORPHANS_GONE_S), {})
        took = time.monotonic() - since
        flight.measure(f"everything gone {took:.2f} s after the supervisor stood still")
        self.assertGreater(took, PATIENCE_S - PACE_S, "it has its patience")
        self.assertEqual(rokviss.process.wait(5.0), 4)
        self.assertIn("the supervisor stands still and is ended", " ".join(rokviss.errors))

    def test_a_keeper_that_stands_still_is_told_of_and_the_flight_goes_on(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin = rokviss.count()
            rokviss.process.send_signal(signal.SIGSTOP)
            rokviss.wait_told("the keeper stands still", PATIENCE_S + PACE_S, begin)
            rokviss.wait_told("KEEPER_STILL", 1.0, begin)
            self.assertGreater(rokviss.truth("robot")["force"], 20.0, "it pushes on")
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            rokviss.process.send_signal(signal.SIGCONT)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def test_a_killed_keeper_leaves_a_robot_that_stops_in_order(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            rokviss.kill("hirosco")
            rokviss.wait_told("shutdown", 1.0)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            story = [line.told for line in rokviss.told()]
            self.assertLess(story.index("shutdown"),
                            story.index("MANIPULATOR info STATE_CHANGED STATE=SafeOperational", story.index("shutdown")))


if __name__ == "__main__":
    flight.main()
