#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cores that a mission gives its subsystems (docs/adr/0234), as the system tells of each thread (Cpus_allowed_list): in processes and among
threads of one; who goes elsewhere is ended and named; what this computer has not, or is another flight's alone, is refused."""
import json
import os
import pathlib
import re
import subprocess
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "cores.xml"
HERE = sorted(os.sched_getaffinity(0))
OWN, REST = str(HERE[0]), str(HERE[-1])     # the mission's 0 and 1, whatever two this computer has for us
NONE = 1000                                 # that no computer of ours has


def copy(more=None):
    return flight.MissionCopy({"0": OWN, "1": REST, **(more or {})}, MISSION)


def allowed(pid):
    """{name of a thread: where it may go}, of each thread of a process."""
    found = {}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        lines = dict(line.split(":\t", 1) for line in (task / "status").read_text().splitlines() if ":\t" in line)
        found[lines["Name"]] = lines["Cpus_allowed_list"]
    return found


def in_range(text):
    """"0-2,5" as a set."""
    ends = [part.split("-") for part in text.split(",")]
    return {number for each in ends for number in range(int(each[0]), int(each[-1]) + 1)}


class Cores(unittest.TestCase):
    def only(self, threads, name, core):
        self.assertEqual(threads[name], core, threads)

    def others(self, threads, *but):
        """None of these may use what is the manipulator's alone."""
        for name, where in threads.items():
            if name not in but:
                self.assertNotIn(int(OWN), in_range(where), (name, threads))

    def test_each_thread_of_each_process_is_where_the_mission_has_it_and_who_strays_is_ended(self):
        with copy() as mission, flight.Flight(mission) as craft:
            craft.wait_told("commissioned: mode operation")
            arm = allowed(craft.pid_of("hirosco-manipulator"))
            self.only(arm, "cycle", OWN)
            self.assertGreater(len(arm), 1)
            for name, where in arm.items():
                if name != "cycle":
                    self.assertEqual(where, REST, (name, arm))
            for program in ("hirosco-hello", "hirosco-communication", "hirosco-supervisor", "hirosco"):
                self.others(allowed(craft.pid_of(program)))
            self.assertIn(OWN, allowed(craft.pid_of("hirosco-sim-robot")).values(), "its device is beside it")
            told = craft.hirosco("resources", str(mission), "--json")
            rows = {(row["subsystem"], row["resource"]): row for row in map(json.loads, told.stdout.splitlines())}
            self.assertEqual(rows["MANIPULATOR", f"cycles_percent of core {OWN}"]["declared"], 20, "100 of 500 us")
            self.assertIn(("SUPERVISOR", f"cycles_percent of core {OWN}"), rows)
            self.assertIn(("SUPERVISOR", "cycles_percent"), rows)
            self.assertEqual(self.core_told(craft), [int(OWN)], "as it says itself")
            self.another_flight_keeps_off(craft, mission)
            self.who_strays_is_ended_and_comes_back(craft)

    def core_told(self, craft):
        """By the manipulator itself, in RESOURCE_STATS; its structure comes each two seconds."""
        end = time.monotonic() + 10.0
        while time.monotonic() < end:
            told = [record["values"] for record in craft.log("--service", "3", last=2000) if "MANIPULATOR" in record["text"]]
            cores = [values["RESOURCE_STATS.CORE"] for values in told if "RESOURCE_STATS.CORE" in values]
            if cores:
                return cores[-1]
            time.sleep(0.3)
        self.fail("no RESOURCE_STATS of the manipulator")

    def another_flight_keeps_off(self, craft, mission):
        beside = [str(craft.binaries / "hirosco"), "run", str(mission), "--instance", "BESIDE", "--plain", "--no-ground", "--for", "1s"]
        refused = subprocess.run(beside, cwd=craft.folder, env={**craft.environment, flight.MARK: ""}, stdin=subprocess.DEVNULL,
                                 capture_output=True, text=True, timeout=30.0, check=False)
        self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
        self.assertIn(f"core {OWN} is CORES's alone", refused.stderr)
        with flight.Flight(flight.HELLO, folder=craft.folder, instance="BESIDE") as hello:
            hello.wait_told("commissioned: mode operation")
            for program in ("hirosco-hello", "hirosco-communication", "hirosco-supervisor"):
                self.others(allowed(hello.pid_of(program)))
            self.assertEqual(hello.end(), 0, hello.errors)

    def who_strays_is_ended_and_comes_back(self, craft):
        pid = craft.pid_of("hirosco-manipulator")
        cycle, = (int(task.name) for task in pathlib.Path(f"/proc/{pid}/task").iterdir() if (task / "comm").read_text() == "cycle\n")
        start = craft.count()
        os.sched_setaffinity(cycle, {int(REST)})
        told = craft.wait_told(f"MANIPULATOR has a thread cycle that may go on core {REST}, which the mission does not give it: it is ended",
                               10.0, start)
        flight.measure(f"found {told.at_s:.2f} s after the start of the flight")
        craft.wait_told("SUPERVISOR medium RESOURCE_EXCEEDED", 5.0, start)
        craft.wait_told("started MANIPULATOR", 10.0, start)
        end = time.monotonic() + 5.0
        while allowed(craft.pid_of("hirosco-manipulator")).get("cycle") != OWN:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def test_threads_of_one_process_are_where_the_mission_has_them(self):
        with copy() as mission, flight.Flight(mission, more=("--no-ground", "--threads")) as craft:
            craft.wait_told("commissioned: mode operation")
            threads = allowed(craft.pid_of("hirosco-threads"))
            self.only(threads, "MANIPULATOR cyc", OWN)
            self.others(threads, "MANIPULATOR cyc")
            self.assertEqual(craft.end(), 0, craft.errors)

    def check(self, mission, *words):
        return subprocess.run([str(flight.BINARIES / "hirosco"), "check", *words, str(mission)], capture_output=True, text=True,
                              timeout=60.0, check=False, env={**os.environ, "NO_COLOR": "1"})

    def test_what_this_computer_has_not_is_a_warning_of_a_check_and_nothing_flies_by_it(self):
        with copy({"0": str(NONE)}) as mission:
            words = f"the cycle of MANIPULATOR is to have core {NONE}, and this computer has none of this number for us"
            place = f"{mission}:11:3: "
            told = self.check(mission)
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertIn(f"{place}warning: E0423: {words}", told.stderr)
            told = self.check(mission, "--fly")
            self.assertEqual(told.returncode, 1, told.stderr)
            self.assertIn(f"{place}error: E0423: {words}", told.stderr)
            refused = subprocess.run([str(flight.BINARIES / "hirosco"), "run", str(mission), "--plain", "--no-ground", "--for", "1s"],
                                     cwd=mission.parent, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=30.0, check=False)
            self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
            self.assertIn(words, refused.stderr)

    def test_in_simulated_time_there_are_none(self):
        """It flies by the same octets with them and without."""
        with copy() as mission:
            flown = []
            for text in (mission.read_text(), re.sub(r' (core|core_alone|service_cores)="[^"]*"', "", mission.read_text())):
                mission.write_text(text)
                told = subprocess.run([str(flight.BINARIES / "hirosco"), "simulate", str(mission), "--for", "2s", "--seed", "1", "--octets"],
                                      cwd=mission.parent, capture_output=True, timeout=120.0, check=False)
                self.assertEqual(told.returncode, 0, told.stderr)
                flown.append(told.stdout)
            self.assertGreater(len(flown[0]), 10_000)
            self.assertEqual(*flown)

    def test_what_takes_which_core_is_shown(self):
        with copy() as mission:
            told = self.check(mission, "--show")
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertIn(f"its cycle goes on core {OWN}, alone", told.stdout)
            self.assertIn(f"  cycles take 20 % of core {OWN}", told.stdout)
            self.assertIn(f"cycle MANIPULATOR STANDALONE on core {OWN}: 100 us", told.stdout)


if __name__ == "__main__":
    if len(HERE) < 2:
        flight.skip("no-second-processor")
    flight.main()
