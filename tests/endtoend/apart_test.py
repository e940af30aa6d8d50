#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Flights that are set apart do not meet, and those that cannot be do not fly at a time."""
import pathlib
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
# Takes what a flight takes, says so, and keeps it until told to go.
TAKES = """
import pathlib, socket, sys
sys.path.insert(0, %r)
import apart
mine = [pathlib.Path("/dev/shm/hirosco-apart-test"), apart.REGISTRY / "apart-test"]
for file in mine:
    file.parent.mkdir(mode=0o700, exist_ok=True)
    file.touch(exist_ok=False)
with socket.create_server(("127.0.0.1", 10015)), socket.create_connection(("127.0.0.1", 10015), 5.0):
    print("has it", flush=True)
    sys.stdin.readline()
for file in mine:
    file.unlink()
""" % str(HERE)
# As for someone who is not root.
REFUSED = """
import sys
sys.path.insert(0, %r)
import apart
apart._called = lambda *_: (_ for _ in ()).throw(PermissionError())
apart.main()
""" % str(HERE)


class Apart(unittest.TestCase):
    def begun(self, *before):
        process = subprocess.Popen([sys.executable, "-B", *before, sys.executable, "-c", TAKES], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def ended(self, process):
        _, errors = process.communicate("\n", 30.0)
        self.assertEqual((process.returncode, errors), (0, ""))

    def test_two_have_the_same_port_and_the_same_name_at_a_time(self):
        if subprocess.run(["unshare", "--net", "--ipc", "--mount", "true"], capture_output=True, check=False).returncode:
            true = subprocess.run([HERE.parents[1] / "tools/skip_reason", "no-network-namespace"], capture_output=True, check=False).returncode == 77
            self.assertTrue(true, "network namespaces can be made, but a flight cannot be set apart")
            self.skipTest("no network namespaces here")
        both = [self.begun(str(HERE / "apart.py")) for _ in range(2)]
        for one in both:
            self.assertEqual(one.stdout.readline(), "has it\n")
        for one in both:
            self.ended(one)

    def test_who_cannot_be_set_apart_waits_until_the_one_before_has_ended(self):
        first = self.begun("-c", REFUSED)
        self.assertEqual(first.stdout.readline(), "has it\n")
        second = self.begun("-c", REFUSED)
        self.assertEqual(first.poll(), None)
        self.ended(first)
        self.assertEqual(second.stdout.readline(), "has it\n", second.stderr)
        self.ended(second)


if __name__ == "__main__":
    told = unittest.main(exit=False).result
    sys.exit(1 if not told.wasSuccessful() else 77 if told.skipped else 0)
