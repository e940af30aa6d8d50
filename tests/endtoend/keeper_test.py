#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How a flight begins and ends: one at a time, in order when asked, and without orphans when it is not."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import flight

ORPHANS_GONE_S = 10.0
# supervisor/keeper/keeper.hpp: how long keeper or supervisor may stand still; Guard::supervisor_limit; and the pace at
# which either is looked at.
PATIENCE_S, GUARD_S, PACE_S = 3.0, 1.0, 0.5


class Keeper(unittest.TestCase):
    def test_a_second_flight_of_the_mission_is_refused_and_the_first_ends_by_ctrl_c(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            second = subprocess.run([str(flight.BINARIES / "hirosco"), "run", rokviss.mission], cwd=rokviss.folder,
                                    env=rokviss.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                    timeout=20, check=False)
            self.assertEqual(second.returncode, 3, second.stderr)
            self.assertIn("flies already", second.stderr)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0, "the first flight does not mind")
            # A terminal sends it to every process in front of it, so the supervisor must not be ended by the keeper's copy.
            rokviss.process.send_signal(signal.SIGINT)
            code = rokviss.end(signal.SIGINT)
            self.assertEqual(code, 0, rokviss.errors)
            self.assertIn("shutdown", [line.told for line in rokviss.told()])
            self.assertEqual(rokviss.wait_until_gone(2.0), {})

    def test_two_flights_never_write_one_log_whatever_the_runtime_folder_is(self):
        with flight.Flight() as rokviss, tempfile.TemporaryDirectory(prefix="hirosco-elsewhere-") as elsewhere:
            rokviss.wait_commissioned()
            second = subprocess.run([str(flight.BINARIES / "hirosco"), "run", rokviss.mission], cwd=rokviss.folder,
                                    env={**rokviss.environment, "XDG_RUNTIME_DIR": elsewhere}, stdin=subprocess.DEVNULL,
                                    capture_output=True, text=True, timeout=20, check=False)
            self.assertEqual(second.returncode, 3, second.stderr)
            self.assertIn("another flight writes", second.stderr)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0, "the first flight does not mind")

    def test_an_end_asked_for_before_anything_was_started_is_an_orderly_one(self):
        for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
            with tempfile.TemporaryDirectory(prefix="hirosco-early-") as folder:
                early = subprocess.Popen([str(flight.BINARIES / "hirosco"), "run", str(flight.ROKVISS), "--no-ground"],
                                         cwd=folder, env={**os.environ, "XDG_RUNTIME_DIR": folder},
                                         stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                # The first moment at which it holds the signal back: nothing flies yet.
                while not int(pathlib.Path(f"/proc/{early.pid}/status").read_text().split("SigBlk:")[1].split()[0], 16) \
                        & 1 << (number - 1):
                    pass
                early.send_signal(number)
                out, err = early.communicate(timeout=30)
                self.assertEqual(early.returncode, 0, f"{number.name}: {out}{err}")

    def test_a_killed_keeper_leaves_no_orphans(self):
        self.no_orphans("hirosco")

    def test_a_killed_supervisor_leaves_no_orphans(self):
        rokviss = self.no_orphans("hirosco-supervisor")
        self.assertNotEqual(rokviss.process.returncode, 0, "the end was not an orderly one")

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

    def no_orphans(self, name):
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.assertEqual(len(rokviss.processes()), 7)
            killed = rokviss.kill(name)
            left = rokviss.wait_until_gone(ORPHANS_GONE_S)
            flight.measure(f"{name} killed: the other six gone {time.monotonic() - killed:.2f} s later")
            self.assertEqual(left, {})
            rokviss.process.wait(5.0)
        self.assertEqual(flight.segments(), before)
        return rokviss

    def test_a_flight_can_begin_where_another_was_killed(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            for pid in rokviss.processes():
                os.kill(pid, signal.SIGKILL)
            self.assertEqual(rokviss.wait_until_gone(5.0), {})
            with flight.Flight(folder=rokviss.folder) as again:
                again.wait_commissioned()
                self.assertEqual(again.tc("manipulator", "ping")[0], 0)
                self.assertEqual(again.end(), 0, again.errors)


if __name__ == "__main__":
    flight.main()
