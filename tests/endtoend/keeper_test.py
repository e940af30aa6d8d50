#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How a flight begins and ends: one at a time, in order when asked, and without orphans when it is not; and without
its keeper, with which it goes on (docs/adr/0217)."""
import contextlib
import os
import pathlib
import resource
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import flight

ORPHANS_GONE_S = 10.0


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
            self.assertIn("shutdown, asked for by SIGINT (signal 2)", [line.told for line in rokviss.told()])
            self.assertEqual(rokviss.wait_until_gone(2.0), {})

    def test_a_service_manager_hears_that_the_mission_is_commissioned_and_that_it_ends(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-manager-") as folder, \
                socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.bind(f"{folder}/notify")
            manager.setblocking(False)
            with flight.Flight(flight.HELLO, environment={"NOTIFY_SOCKET": f"{folder}/notify"}) as hello:
                hello.wait_told("commissioned: mode operation", 20.0)
                manager.settimeout(5.0)
                self.assertEqual(manager.recv(200).split(b"\n")[0], b"READY=1")
                for pid in hello.processes():
                    if pid == hello.process.pid:  # it was given it, and has it in its first environment for good
                        continue
                    environment = pathlib.Path(f"/proc/{pid}/environ").read_bytes()
                    self.assertNotIn(b"NOTIFY_SOCKET", environment, "nobody else speaks to the manager")
                self.assertEqual(hello.end(), 0)
            self.assertEqual(manager.recv(200).split(b"\n")[0], b"STOPPING=1")
            with self.assertRaises(TimeoutError):
                manager.settimeout(0.1)
                manager.recv(200)

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

    def test_what_the_system_refuses_at_the_start_is_named(self):
        for descriptors in range(5, 45, 3):
            with self.subTest(descriptors), tempfile.TemporaryDirectory(prefix="hirosco-few-") as folder:
                limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (descriptors, descriptors))
                few = subprocess.run([str(flight.BINARIES / "hirosco"), "run", str(flight.ROKVISS), "--no-ground", "--for", "1s"],
                                     cwd=folder, env={**os.environ, "XDG_RUNTIME_DIR": folder}, stdin=subprocess.DEVNULL,
                                     capture_output=True, text=True, timeout=60, check=False, preexec_fn=limit)
                self.assertTrue(few.returncode == 0 or few.stdout + few.stderr != "", f"{few.returncode} without a word")
                self.assertNotIn("terminate called", few.stderr)
                self.assertNotIn(few.returncode, (-6, 134), few.stderr)

    def test_without_its_keeper_a_flight_goes_on_and_all_that_the_keeper_had_begun_ends_with_it_in_order(self):
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.assertEqual(len(rokviss.processes()), 7)
            begin = rokviss.count()
            rokviss.kill("hirosco")
            rokviss.process.wait(5.0)
            rokviss.wait_told("KEEPER_LOST", 2.0, begin)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            status = rokviss.hirosco("status", "--mission", rokviss.mission)
            self.assertEqual(status.returncode, 1, status.stdout)
            self.assertIn("the keeper of this flight is gone; all else is well", status.stdout)
            second = rokviss.hirosco("run", rokviss.mission, "--no-ground", "--for", "1s")
            self.assertEqual(second.returncode, 3, "its log, name and ports are taken")
            self.assertEqual(len(rokviss.processes()), 6, "simulated devices are there as long as it flies")
            rokviss.kill("hirosco-supervisor", signal.SIGTERM)
            rokviss.wait_told("shutdown, asked for by SIGTERM (signal 15)", 2.0, begin)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
        self.assertEqual(flight.segments(), before)

    def test_without_its_keeper_a_flight_ends_when_its_time_is_over(self):
        with flight.Flight(more=("--no-ground", "--for", "25s")) as rokviss:
            rokviss.wait_commissioned()
            rokviss.kill("hirosco")
            rokviss.wait_told("shutdown, asked for by --for, whose time is over", 30.0)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})

    def test_a_supervisor_that_dies_without_a_keeper_leaves_no_orphans(self):
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            rokviss.kill("hirosco")
            rokviss.wait_told("KEEPER_LOST", 2.0, begin)
            killed = rokviss.kill("hirosco-supervisor")
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            flight.measure(f"without a keeper, supervisor killed: the other five gone {time.monotonic() - killed:.2f} s later")
        self.assertEqual(flight.segments(), before)

    def test_a_crash_loop_of_supervisors_leaves_no_orphans(self):
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            deaths, last = 0, None
            end = time.monotonic() + 60.0
            while rokviss.process.poll() is None:
                self.assertLess(time.monotonic(), end, "it ends")
                pid = next((pid for pid, name in rokviss.processes().items() if name == "hirosco-supervisor"), None)
                if pid is None or pid == last:
                    continue
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
                    deaths, last = deaths + 1, pid
            flight.measure(f"a flight ended after {deaths} supervisors that were killed at once")
            self.assertGreater(deaths, 3)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            self.assertEqual(rokviss.process.returncode, 4, "the end was not an orderly one")
        self.assertEqual(flight.segments(), before)

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
