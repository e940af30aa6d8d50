#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""bench/peers with planted figures: each that is not what it is to be, and each that is not there, is told and ends it with 1."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PEERS = REPOSITORY / "bench/peers"


def loaded():
    loader = importlib.machinery.SourceFileLoader("peers", str(PEERS))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("peers", loader))
    sys.modules["peers"] = module
    loader.exec_module(module)
    return module


peers = loaded()

# As the programs print them; each goal is met.
WELL = """\
raw sequence lock, 256 B     p50    100.00  p99    110.00  p99.9    120.00  max     500.00 ns
link, 256 B                  p50    110.00  p99    120.00  p99.9    130.00  max     600.00 ns
link, 256 B    / raw sequence lock, 256 B  p50      1.10  p99      1.09  p99.9      1.08  max       1.20
iceoryx, 256 B               p50    700.00  p99    800.00  p99.9    900.00  max    1000.00 ns
queued link                      20000000 samples/s, 0 lost
iceoryx queue                     1000000 samples/s
latest link, woken           p50     10.40  p99     13.00  p99.9     18.00  max      22.00 us
queued link, woken           p50     10.50  p99     13.00  p99.9     18.00  max      22.00 us
raw futex                    p50     10.00  p99     13.00  p99.9     18.00  max      22.00 us
ours                         p50     26.00  p99     40.00  p99.9     90.00  max     600.00 us
ours, precise                p50      0.08  p99      0.30  p99.9     20.00  max     100.00 us
cyclictest                   p50     25.00  p99     42.00  p99.9     80.00  max     500.00 us
cycle with four links        p50    950.00  p99   1200.00  p99.9   1500.00  max    9000.00 ns
both together                p50    900.00  p99   1100.00  p99.9   1500.00  max    9000.00 ns
cycle, dictionary shared     p50     14.00  p99     20.00  p99.9     40.00  max     500.00 us
cycle, dictionary its own    p50     13.00  p99     19.00  p99.9     38.00  max     500.00 us
checksum of a ping           p50     20.00  p99     22.00  p99.9     25.00  max      90.00 ns
ping to its service          p50     60.00  p99     70.00  p99.9     80.00  max     300.00 ns
bare word, small             p50     70.00  p99    130.00  p99.9    130.00  max     130.00 us
network fenced, small        p50     80.00  p99    140.00  p99.9    140.00  max     140.00 us
bare word, 512 MB            p50     72.00  p99    130.00  p99.9    130.00  max     130.00 us
network fenced, 512 MB       p50     83.00  p99    140.00  p99.9    140.00  max     140.00 us
hirosco                           60000 pings/s, with permission and log
forwarder                        100000 pings/s, batches of a bare socket
raw free list             2.00 ns    1.00 x
pools of one thread       3.00 ns    1.50 x
ours, idle                        1000000 cycles          100 missed  p50 12  p99 20  p99.9 50  p99.99 90  p99.999 200  max 900 us
cyclictest, idle                  1000000 cycles          110 missed  p50 12  p99 20  p99.9 50  p99.99 90  p99.999 200  max 800 us
ours, under load                  1000000 cycles         5600 missed  p50 13  p99 65  p99.9 646  p99.99 6611  p99.999 9000  max 195621 us
cyclictest, under load            1000000 cycles         6000 missed  p50 13  p99 74  p99.9 702  p99.99 6599  p99.999 9000  max 199068 us
"""


def seen_of(text):
    return peers.figures(text)


def planted(name, **values):
    """What was seen, with other figures of one contestant; None: without it."""
    seen = seen_of(WELL)
    for key, value in values.items():
        if value is None:
            del seen[name][key]
        else:
            seen[name][key] = value
    return seen


class Judge(unittest.TestCase):
    def told(self, seen, repeats=9, **how):
        lines, code = peers.judge([seen] * repeats, **how)
        return code, "\n".join(lines)

    def test_figures_that_are_what_they_are_to_be_end_it_with_0(self):
        code, text = self.told(seen_of(WELL))
        self.assertEqual(code, 0, text)
        self.assertNotIn("NOT", text)
        self.assertEqual(len(text.splitlines()), len(peers.GOALS))

    def test_each_goal_that_is_missed_is_told_and_ends_it_with_1(self):
        for goal in peers.GOALS:
            with self.subTest(goal.text):
                other = seen_of(WELL)[goal.other][goal.key] if goal.other else 1
                bound = goal.bound if goal.other else goal.bound + 1
                code, text = self.told(planted(goal.ours, **{goal.key: other * bound * (1.05 if goal.sense == "<=" else 0.95)}))
                self.assertEqual(code, 1)
                self.assertRegex(next(line for line in text.splitlines() if goal.text in line), "NOT MET")

    def test_a_figure_that_is_just_what_it_is_to_be_is_met(self):
        for goal in peers.GOALS:
            other = seen_of(WELL)[goal.other][goal.key] if goal.other else 1
            with self.subTest(goal.text):
                figure = goal.figure(goal.ratios([planted(goal.ours, **{goal.key: other * goal.bound})]))
                self.assertTrue(goal.met(round(figure, 9)))

    def test_a_figure_that_is_not_there_ends_it_with_1_and_not_with_silence(self):
        for goal in peers.GOALS:
            with self.subTest(goal.text):
                code, text = self.told(planted(goal.ours, **{goal.key: None}))
                self.assertEqual(code, 1)
                self.assertRegex(text, "NOT MEASURED")
                self.assertEqual(self.told({}, only=goal.word)[0], 1)

    def test_a_figure_of_some_repeats_only_is_none(self):
        for goal in peers.GOALS:
            with self.subTest(goal.text):
                lines, code = peers.judge([seen_of(WELL)] * 8 + [planted(goal.ours, **{goal.key: None})])
                self.assertEqual(code, 1)
                self.assertRegex("\n".join(lines), "NOT MEASURED in each repeat")

    def test_a_peer_that_cannot_be_had_leaves_its_own_figures_out_and_no_others(self):
        without = {name: values for name, values in seen_of(WELL).items() if "cyclictest" not in name}
        code, text = self.told(without, absent=["cyclictest"])
        self.assertEqual(code, 77)
        self.assertEqual(text.count("no cyclictest here"), sum(goal.peer() == "cyclictest" for goal in peers.GOALS))
        self.assertEqual(self.told(without)[0], 1, "whoever has it and no figures of it has failed")
        without["link, 256 B"]["p50"] = 200.0
        self.assertEqual(self.told(without, absent=["cyclictest"])[0], 1, "what is missed counts before what is left out")

    def test_a_slice_judges_what_one_processor_decides_and_wants_the_others_to_be_there(self):
        self.assertEqual(self.told(planted("link, 256 B", p50=900.0), slice_=True)[0], 0)
        self.assertEqual(self.told(planted("link, 256 B", p50=None), slice_=True)[0], 1)
        self.assertEqual(self.told(planted("cycle with four links", p50=900 * 2.7), slice_=True)[0], 1)
        self.assertEqual(self.told(planted("cycle with four links", p50=900 * 2.5), slice_=True)[0], 0)
        self.assertEqual(self.told(planted("queued link", lost=1), slice_=True)[0], 1)
        without = {name: values for name, values in seen_of(WELL).items() if "iceoryx" not in name}
        self.assertEqual(self.told(without, slice_=True)[0], 0)

    def test_the_median_of_ratios_inside_repeats_counts_and_one_bad_repeat_does_not(self):
        bad, good = planted("link, 256 B", p50=500.0), seen_of(WELL)
        self.assertEqual(peers.judge([bad] * 4 + [good] * 5)[1], 0)
        self.assertEqual(peers.judge([bad] * 5 + [good] * 4)[1], 1)

    def test_one_lost_sample_in_one_repeat_counts(self):
        self.assertEqual(peers.judge([planted("queued link", lost=1)] + [seen_of(WELL)] * 8)[1], 1)

    def test_missed_cycles_count_together_and_those_that_no_peer_can_avoid_do_not(self):
        single, none = planted("ours, idle", missed=9), seen_of(WELL)
        single["cyclictest, idle"]["missed"] = none["cyclictest, idle"]["missed"] = none["ours, idle"]["missed"] = 0
        code, text = self.told(single, only="missed")
        self.assertEqual(code, 0)
        self.assertRegex(text, r"missed cycles beside cyclictest, idle\s+inf .* no more than one of 100,000")
        self.assertEqual(self.told(none, only="missed")[0], 0)
        single["ours, idle"]["missed"] = 11
        self.assertEqual(self.told(single, only="missed")[0], 1)

    def test_a_peer_that_took_nothing_is_beaten_or_not_and_in_no_case_left_out(self):
        self.assertEqual(self.told(planted("raw free list", cost=0.0), only="pool")[0], 1)
        precise = planted("ours, precise", p99=0.0)
        self.assertEqual(self.told(precise, only="loop")[0], 0)
        self.assertEqual(peers.judge([precise] * 4 + [planted("ours, precise", p99=40.0)] * 5, only="loop")[1], 1)

    def test_the_table_has_what_was_missed_of_all_cycles_and_the_latest_of_all(self):
        late = planted("ours, idle", max=5000.0)
        line = next(line for line in peers.table([seen_of(WELL)] * 8 + [late]) if line.strip().startswith("ours, idle"))
        self.assertRegex(line, r"cycles 9,000,000\.00  missed 900\.00  max 5,000\.00")

    def test_ratios_that_programs_print_themselves_are_no_contestants(self):
        self.assertFalse([name for name in seen_of(WELL) if " / " in name])

    def test_the_cycles_asked_for_are_shared_out_over_the_repeats(self):
        def asked(*words):
            return [int(arguments[0]) for _, program, *arguments in peers.commands(peers.parsed(list(words))) if program == "bench_missed_cycles"]
        self.assertEqual(asked(), [1_111_112] * 2)
        self.assertEqual(asked("--cycles", "90000"), [10_000] * 2)
        self.assertLess(max(asked("--slice")), 10_000)


class Program(unittest.TestCase):
    """The whole of it, with scripts in the place of the programs."""

    def ended(self, script, *words):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "bench_pools"
            program.write_text("#!/bin/sh\n" + script)
            program.chmod(0o755)
            return subprocess.run([sys.executable, "-B", PEERS, "--slice", "--only", "pool", *words, "--programs", program],
                                  capture_output=True, text=True, check=False)

    def setUp(self):
        if len(os.sched_getaffinity(0)) < 2:
            self.skipTest("it wants two processors")

    def test_it_prints_what_was_measured_and_what_that_is_to_be(self):
        done = self.ended("echo 'raw free list   2.00 ns  1 x'; echo 'pools of one thread  3.00 ns  1.5 x'")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"pool pair beside a raw free list\s+1\.50  to be <= 1\.6")

    def test_a_program_that_fails_or_says_nothing_or_is_not_there_ends_it_with_1(self):
        for script in ("echo 'raw free list   2.00 ns  1 x'; echo 'pools of one thread  3.00 ns  1.5 x'; exit 1", "exit 0"):
            self.assertEqual(self.ended(script).returncode, 1, script)
        done = self.ended("exit 0", "--only", "ping")
        self.assertEqual(done.returncode, 1)
        self.assertIn("there is no bench_ping", done.stdout)

    def test_a_program_that_does_not_end_is_ended_with_all_that_it_began(self):
        # What it began holds the pipe: as long as that lives, this waits.
        self.assertIsNone(peers.ended(["sh", "-c", "sleep 1000 & wait"], 0.5))
        self.assertEqual(peers.ended(["sh", "-c", "echo told; exit 3"], 100), (3, "told\n", ""))

    def test_a_word_that_it_does_not_know_is_refused(self):
        with contextlib.redirect_stderr(io.StringIO()), self.assertRaises(SystemExit) as refused:
            peers.parsed(["--only", "nonesuch"])
        self.assertEqual(refused.exception.code, 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
