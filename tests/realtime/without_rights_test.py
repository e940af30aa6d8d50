#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""without_rights_test.py [SECONDS]: an ordinary user without real-time rights flies coupled on a busy computer, and no
reaction of the spacecraft is provoked by that."""
import contextlib
import os
import shutil
import subprocess
import sys
import unittest

import flight
from ordinary_user import ordinary_user

SECONDS = 8.0


@contextlib.contextmanager
def busy_processors():
    with contextlib.ExitStack() as stack:
        load = subprocess.Popen(["stress-ng", "--quiet", "--cpu", str(os.cpu_count() or 2)])
        stack.callback(load.wait)
        stack.callback(load.terminate)
        yield


class WithoutRights(unittest.TestCase):
    def test_a_busy_computer_provokes_no_reaction(self):
        # A host that takes a processor away is no busy computer: such a flight shows nothing, unless it holds.
        for _ in range(1 if SECONDS > 60 else 3):
            stolen = flight.stolen_s()
            reaction = self.first_reaction()
            if reaction is None:
                return
            if flight.stolen_s() - stolen < 0.02:
                break
        self.fail(reaction.told)

    def first_reaction(self):
        with ordinary_user() as arguments, busy_processors(), flight.Flight(**arguments) as rokviss:
            rokviss.wait_told("no real-time scheduling", 5.0)
            rokviss.wait_commissioned(40.0)
            begin = rokviss.count()
            if reaction := rokviss.wait_line(lambda line: line.told.startswith("plan "), SECONDS, begin):
                return reaction
            told = [line.told for line in rokviss.told(begin)]
            self.assertEqual([text for text in told if " info " not in text], [])
            status = rokviss.wait_status(lambda s: True, 10.0)
            self.assertEqual({m["state"] for m in status["subsystems"]}, {"Operational"})
            for member in status["subsystems"]:
                flight.measure(", ".join(f"{name} {member[name]}" for name in
                                         ("name", "cycles", "missed", "overruns", "latency_max_ns", "execution_mean_ns")
                                         if name in member))
            self.assertEqual(rokviss.end(seconds=30.0), 0, rokviss.errors)
            return None


if __name__ == "__main__":
    if len(sys.argv) > 1:
        SECONDS = float(sys.argv.pop(1))
    if not shutil.which("stress-ng"):
        flight.skip("no-stress-ng")
    flight.main()
