#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The catalogue with real processes: the threads that its descriptor says, period and priority that follow the configuration
without a restart, values set in a loop of their own, a loop of services that hangs, seen by the guard."""
import pathlib
import struct
import threading
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"
PROGRAM = "hirosco-catalogue"


class Loops(unittest.TestCase):
    def threads(self, craft):
        """Of the catalogue, by name: scheduling policy and real-time priority (fields 41 and 40 of /proc/PID/task/TID/stat)."""
        found = {}
        for task in pathlib.Path(f"/proc/{craft.pid_of(PROGRAM)}/task").iterdir():
            name, rest = (task / "stat").read_text().split("(", 1)[1].rsplit(")", 1)
            fields = rest.split()
            found[name] = (int(fields[38]), int(fields[37]))
        return found

    def test_period_and_priority_follow_the_configuration_without_a_restart(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            pid, realtime = craft.pid_of(PROGRAM), self.threads(craft)["cycle"][0] == 1
            self.assertLessEqual({"loop.PAGES", "loop.VALUES"}, set(self.threads(craft)))
            if realtime:
                self.assertEqual(self.threads(craft)["loop.PAGES"], (1, 12))
                self.assertEqual(self.threads(craft)["loop.VALUES"], (1, 8))
            measured = []
            for configuration, sampling_s, priority in ((2, 0.002, 50), (1, 0.004, 30), (2, 0.002, 50)):
                code, reports = craft.tc("CATALOGUE", "CONFIGURE", configuration)
                self.assertEqual((code, reports[-1]), (0, "1,7"))
                rate = self.rate(craft)
                measured.append(f"{rate:.0f} Hz")
                self.assertLess(abs(rate * sampling_s - 1), 0.15, measured)
                if realtime:
                    self.assertEqual(self.threads(craft)["cycle"], (1, priority))
            for configuration, scheduling in ((8, (0, 0)), (1, (1, 8))):
                self.assertEqual(craft.tc("CATALOGUE", "CONFIGURE", configuration)[0], 0)
                self.assertEqual(craft.tc("CATALOGUE", "SET:PAGE", 10)[0], 0)
                if realtime:
                    self.assertEqual(self.threads(craft)["loop.VALUES"], scheduling, configuration)
            self.assertEqual(craft.pid_of(PROGRAM), pid)
            code, reports = craft.tc("CATALOGUE", "COUNT")
            self.assertEqual((code, reports[-1]), (0, "1,7"))
            self.assertEqual(craft.tc("CATALOGUE", "CONFIGURE", 3)[0], 0)
            self.assertNotEqual(craft.tc("CATALOGUE", "COUNT")[0], 0)
            flight.measure(f"{', '.join(measured)}; real-time: {realtime}")
            craft.end()

    def rate(self, craft, span_s=2.0):
        """Wake-ups of the cycle's thread, which sleeps once in a cycle."""
        def woken():
            for task in pathlib.Path(f"/proc/{craft.pid_of(PROGRAM)}/task").iterdir():
                status = (task / "status").read_text()
                if status.startswith("Name:\tcycle\n"):
                    return int(status.split("\nvoluntary_ctxt_switches:\t")[1].split()[0])
            raise AssertionError("no thread of the cycle")
        begin, first = time.monotonic(), woken()
        time.sleep(span_s)
        return (woken() - first) / (time.monotonic() - begin)

    def newest(self, telemetry, structure, since):
        """The values of the newest report of the catalogue's structure after `since`, as they came."""
        end = time.monotonic() + 10.0
        while time.monotonic() < end:
            for report in reversed(list(telemetry.reports)):
                if report.received > since and (report.service, report.subtype) == (3, 25) and report.data[:2] == bytes((0, structure)) and report.apid == 24:
                    return report.data[2:]
            time.sleep(0.05)
        raise AssertionError(f"structure {structure} is not reported")

    def told(self, telemetry, since, loop=0):
        """CYCLE_SPIN and LOOP_STATS of the newest report of structure 2 after `since`; the latter of one loop."""
        spin_us, longest_us, exceeded, *loops = struct.unpack(">ffQ8f8f8Q8Q", self.newest(telemetry, 2, since)[:208])
        return (spin_us, longest_us, exceeded), tuple(loops[loop::8])

    def test_a_precise_configuration_spins_and_its_loop_says_what_its_steps_take(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            realtime = self.threads(craft)["cycle"][0] == 1
            fine, calm, pause_s = 6, 1, 1.5
            with flight.Telemetry() as telemetry:
                spin, loop = self.told(telemetry, time.monotonic())
                self.assertEqual(spin, (0.0, 0.0, 0), "it sleeps where nothing is said")
                self.assertEqual(loop[0], 2000.0)
                self.assertEqual(craft.tc("CATALOGUE", "CONFIGURE", fine)[0], 0)
                self.assertEqual(craft.tc("CATALOGUE", "COUNT")[0], 0)
                time.sleep(pause_s)
                spin, loop = self.told(telemetry, time.monotonic())
                flight.measure(f"spin in force, longest / us, exceeded: {spin}; loop: budget, longest / us, exceeded, missed: {loop}")
                self.assertEqual(spin[0], 150.0 if realtime else 0.0)
                self.assertEqual(spin[1] > 0.0, realtime)
                self.assertGreater(loop[1], 0.0)
                self.assertEqual(craft.tc("CATALOGUE", "CONFIGURE", calm)[0], 0)
                time.sleep(pause_s)
                self.assertEqual(self.told(telemetry, time.monotonic())[0], (0.0, 0.0, 0))
            craft.end()

    def test_values_are_set_and_told_in_a_loop_of_their_own_beside_those_of_the_archive(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            begin = craft.count()
            for configuration, page in ((2, 100), (1, 50), (2, 100)):
                code, reports = craft.tc("CATALOGUE", "SET:PAGE", page)
                self.assertEqual((code, reports[-1]), (0, "1,7"))
                self.assertEqual(craft.tc("CATALOGUE", "CONFIGURE", configuration)[0], 0)
            self.assertNotEqual(craft.tc("CATALOGUE", "SET:PAGE", 0)[0], 0)
            with flight.Telemetry() as telemetry:
                _, sorted_first = struct.unpack(">II", self.newest(telemetry, 1, time.monotonic())[:8])
                time.sleep(1.5)
                _, sorted_then = struct.unpack(">II", self.newest(telemetry, 1, time.monotonic())[:8])
                loop = self.told(telemetry, time.monotonic(), 1)[1]
            flight.measure(f"sorted: {sorted_first}, {sorted_then}; VALUES: budget, longest / us, exceeded, missed: {loop}")
            self.assertGreater(sorted_then, sorted_first)
            self.assertEqual(sorted_then % 100, 0, "in whole pages, as ST[20] has set it")
            self.assertEqual(loop[0], 500.0)
            self.assertGreater(loop[1], 0.0)
            self.assertFalse([line for line in craft.told(begin) if "SERVICE_LOOP_HANGS" in line.told])
            craft.end()

    def test_a_loop_that_hangs_is_seen_by_the_guard_and_its_process_ended(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            begin = craft.count()
            asking = threading.Thread(target=lambda: craft.tc("CATALOGUE", "HANG", 5000))
            asking.start()
            craft.wait_told("CATALOGUE low SERVICE_LOOP_HANGS", 8.0, begin)
            craft.wait_told("CATALOGUE hangs: its service loop stands still", 8.0, begin)
            asking.join()
            craft.end()


if __name__ == "__main__":
    flight.main()
