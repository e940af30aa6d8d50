#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who keeps the station dies, and another one takes over by itself (docs/adr/0099): on virtual time and with real processes; not where
everything was stopped before."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "handover.xml"
TOLD = "the task of KEEPER is with SPARE"


class HandOver(unittest.TestCase):
    def kill_keeper(self, craft):
        for pid, name in craft.processes().items():
            if name == "hirosco-hello" and b"KEEPER:8" in pathlib.Path(f"/proc/{pid}/cmdline").read_bytes():
                os.kill(pid, signal.SIGKILL)
                return time.monotonic()
        raise AssertionError("no KEEPER")

    def state_of(self, craft, name, wanted):
        return craft.wait_status(lambda status: any(
            member["name"] == name and member["state"] == wanted for member in status["subsystems"]), 5.0)

    def test_on_virtual_time_the_spare_takes_over(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([str(flight.BINARIES / "hirosco"), "simulate", str(MISSION), "--for", "6s", "--at", "3 kill KEEPER"],
                                  cwd=folder, capture_output=True, text=True, check=False, timeout=120)
            told = done.stdout + done.stderr
            self.assertIn("plan keep-on: the task of KEEPER to SPARE because of PROCESS_DIED", told)
            self.assertIn(TOLD, told)

    def test_the_spare_takes_over(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.assertIsNotNone(self.state_of(craft, "SPARE", "PreOperational"))
            begin = craft.count()
            killed = self.kill_keeper(craft)
            line = craft.wait_told(TOLD, 10.0, begin)
            flight.measure(f"the task was handed over {line.received - killed:.3f} s after the kill")
            self.assertIsNotNone(self.state_of(craft, "SPARE", "Operational"))

    def test_who_was_stopped_takes_over_nothing(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(craft.hirosco("safe").returncode, 0)
            begin = craft.count()
            self.kill_keeper(craft)
            craft.wait_told("nobody takes over the task of KEEPER: SPARE was stopped, and nobody has let it go since", 10.0, begin)
            self.assertIsNotNone(self.state_of(craft, "SPARE", "PreOperational"))


if __name__ == "__main__":
    flight.main()
