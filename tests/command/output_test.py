# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `hirosco` cannot write is no success, and what it cannot make out of its arguments is named: with a code that says
so, in words, and never by a crash."""

import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"
ROKVISS = REPOSITORY / "missions/rokviss/mission.xml"
USAGE, ENVIRONMENT = 2, 3


class Output(unittest.TestCase):
    def hirosco(self, *words, to=None):
        """Exit code and what it said; `to` is where its standard output goes."""
        with tempfile.TemporaryDirectory(prefix="hirosco-output-") as folder:
            with open(to or os.devnull, "w", encoding="utf-8") as out:
                done = subprocess.run([HIROSCO, *map(str, words)], stdout=out, stderr=subprocess.PIPE, text=True,
                                      check=False, cwd=folder,
                                      env={**os.environ, "NO_COLOR": "1", "XDG_RUNTIME_DIR": folder})
            return done.returncode, done.stderr

    def refused(self, code, text, *words, to=None):
        found, said = self.hirosco(*words, to=to)
        self.assertEqual(found, code, f"{words}: {said}")
        self.assertIn(text, said)

    def test_a_full_device_is_no_success(self):
        for words in (("check", ROKVISS), ("check", "--show", ROKVISS),
                      ("simulate", ROKVISS, "--for", "0.2s"), ("--version",), ("--help",)):
            with self.subTest(words):
                self.refused(ENVIRONMENT, "No space left on device", *words, to="/dev/full")
        self.refused(ENVIRONMENT, "No space left on device", "simulate", ROKVISS, "--for", "0.2s", "--trace", "/dev/full")

    def test_a_trace_goes_on_when_there_is_no_cycle_and_changes_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            trace = os.path.join(folder, "trace.csv")
            words = ["simulate", ROKVISS, "--for", "3s", "--at", "1.5 robot unplug"]
            alone, traced = (subprocess.run([HIROSCO, *words, *more], capture_output=True, check=False).stdout for more in ((), ("--trace", trace)))
            self.assertEqual(alone, traced)
            with open(trace, encoding="ascii") as rows:
                times = [float(row.partition(",")[0]) for row in list(rows)[2:]]
        self.assertAlmostEqual(times[-1], 3.0, delta=0.011)
        steps = [(after - before, before) for before, after in zip(times, times[1:])]
        self.assertLess(max(steps)[0], 0.0105)
        self.assertLess(max(step for step, at in steps if 1.0 < at < 1.4), 0.0006, "at cycle rate while it cycles")

    def test_an_export_that_cannot_be_written_is_no_success(self):
        for what in ("python", "xtce", "yamcs", "icd"):
            with self.subTest(what):
                self.refused(ENVIRONMENT, "cannot be written", "export", what, ROKVISS, "--to", "/dev/null/here")
        self.assertEqual(self.hirosco("export", "hieroglyphs", ROKVISS)[0], USAGE)

    def test_a_computer_without_memory_is_named(self):
        told = set()
        for megabytes in (12, 16, 20, 24, 28, 32, 36, 40, 60):
            limit = megabytes << 20
            done = subprocess.run([HIROSCO, "simulate", ROKVISS, "--for", "0.2s"], capture_output=True, text=True, check=False,
                                  env={**os.environ, "NO_COLOR": "1"},
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            if done.returncode == 127:  # not even its libraries have room
                continue
            if done.stderr == "terminate called without an active exception\n":  # nor what they make before main()
                continue
            with self.subTest(megabytes):
                self.assertIn(done.returncode, (0, ENVIRONMENT), done.stderr)
                self.assertTrue(done.returncode == 0 or done.stderr.startswith("hirosco: "), done.stderr)
            told.add(done.returncode)
        self.assertIn(ENVIRONMENT, told, "no limit was too low")

    def test_a_seed_that_is_none_is_named(self):
        for seed in ("-1", "18446744073709551616", "1e3", "x"):
            self.refused(USAGE, f"not a seed: '{seed}'", "simulate", ROKVISS, "--for", "0.1s", f"--seed={seed}")
        self.assertEqual(self.hirosco("simulate", ROKVISS, "--for", "0.1s", "--seed=18446744073709551615")[0], 0)

    def test_a_fault_for_nobody_is_named(self):
        for line, text in (("0.1 kill NOBODY", "no subsystem 'NOBODY'"), ("0.1 nobody unplug", "no device 'nobody'"),
                           ("0.1 tc NOBODY PING", "no subsystem 'NOBODY'"), ("0.1 tc MANIPULATOR", "which function? MANIPULATOR has"),
                           ("0.1 tc MANIPULATOR PING 'x", "a quote is not closed")):
            self.refused(USAGE, text, "simulate", ROKVISS, "--for", "0.2s", "--at", line)

    def test_a_fault_that_would_come_when_the_flight_is_over_is_named_and_none_is_flown(self):
        for at in ("5 robot unplug", "0.2 robot unplug", "5 kill MANIPULATOR"):
            self.refused(USAGE, f"--at '{at}' would come when the flight is over: it takes 0.2 s",
                         "simulate", ROKVISS, "--for", "0.2s", "--at", at)

    def test_faults_come_at_their_times_in_whatever_order_they_are_typed(self):
        faults = ("--at", "1.5 robot unplug"), ("--at", "1.2 joystick hand cartesian 0.01 0 1")
        def flown(*words):
            return subprocess.run([HIROSCO, "simulate", ROKVISS, "--for", "2s", "--octets", *words], capture_output=True, check=False).stdout
        in_turn = flown(*faults[0], *faults[1])
        self.assertEqual(in_turn, flown(*faults[1], *faults[0]))
        self.assertNotEqual(in_turn, flown(*faults[0]), "the hand has moved something before")

    def test_a_telecommand_from_ground_is_carried_out_or_refused_as_any_other(self):
        done = subprocess.run([HIROSCO, "simulate", ROKVISS, "--for", "4s", "--mode", "standalone", "--at", "2 tc manipulator move_to -0.9 1.8 1",
                               "--at", "2.1 tc MANIPULATOR CONFIGURE 1"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        sent = [line for line in done.stdout.splitlines() if " TM[1," in line or " ground -> MANIPULATOR" in line]
        self.assertRegex("\n".join(sent), r"(?s)   2\.0\d+ [^\n]*MOVE_TO.* TM\[1,1\][^\n]* #0\n.*   2\.1\d+ [^\n]*CONFIGURE.* TM\[1,2\][^\n]* #1: not permitted in this "
                         r"mode\n.*   3\.\d+ [^\n]* TM\[1,7\][^\n]* #0")
        done = subprocess.run([HIROSCO, "simulate", ROKVISS, "--for", "0.5s", "--at", "0 tc MANIPULATOR PING"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("'MANIPULATOR PING' did not go up after 0 s: no ground link was open", done.stderr)

    def test_a_fault_beyond_its_length_is_named(self):
        self.refused(USAGE, "at most 255 characters, not 100000", "fault", "robot", "x" * 100_000, "--mission", ROKVISS)


if __name__ == "__main__":
    unittest.main()
