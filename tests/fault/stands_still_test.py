#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Keeper and supervisor are killed or stopped while the robot pushes: it stops where nobody looks after it, nobody is left behind,
and who is left says so (hazard SF18). The supervisor alone: adoption_test.py, the keeper alone: keeper_lost_test.py."""
import os
import pathlib
import signal
import time
import unittest

import flight

ORPHANS_GONE_S = 10.0
# supervisor/keeper/kept.hpp: how long the keeper may stand still, and the pace at which it is looked at.
PATIENCE_S, PACE_S = 3.0, 0.5
SAFE_S = 2.0                      # without a supervisor


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
            time.sleep(max(0.0, killed + SAFE_S + PACE_S - time.monotonic()))
            begin = rokviss.count()
            rokviss.process.send_signal(signal.SIGCONT)
            rokviss.wait_told("this supervisor goes on for one that died", 5.0, begin)
            truth = rokviss.truth("robot")
            self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0), "nobody begins to move by that")
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)

    def test_a_killed_supervisor_and_a_killed_keeper_leave_a_robot_that_stops_and_nobody(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            keeper, supervisor = rokviss.pid_of("hirosco"), rokviss.pid_of("hirosco-supervisor")
            killed = time.monotonic()
            os.kill(keeper, signal.SIGKILL)
            os.kill(supervisor, signal.SIGKILL)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            flight.measure(f"keeper and supervisor killed: the others gone {time.monotonic() - killed:.2f} s later")

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

    def test_no_terminal_stops_keeper_or_supervisor(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            for number in (signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU):
                for name in ("hirosco", "hirosco-supervisor"):
                    rokviss.kill(name, number)
            for name in ("hirosco", "hirosco-supervisor"):
                status = pathlib.Path(f"/proc/{rokviss.pid_of(name)}/status").read_text()
                self.assertNotIn("State:\tT", status, name)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)


if __name__ == "__main__":
    flight.main()
