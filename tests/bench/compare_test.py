#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""bench/compare with planted figures of two trees: one that is slower, and one that no longer says how quick it is, are not as good."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import sys
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))


def loaded():
    loader = importlib.machinery.SourceFileLoader("compare", str(BENCH / "compare"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
    loader.exec_module(module)
    return module


compare = loaded()


class Judged(unittest.TestCase):
    def good(self, **measured):
        with contextlib.redirect_stdout(io.StringIO()):
            return compare.judged(measured, False)

    def test_as_quick_as_before_is_good_and_slower_by_more_than_a_tenth_is_not(self):
        self.assertTrue(self.good(link=([100.0, 100.0, 100.0], [100.0, 109.0, 130.0])))
        self.assertFalse(self.good(link=([100.0, 100.0, 100.0], [100.0, 111.0, 130.0])))

    def test_what_an_old_tree_has_not_measured_yet_is_good_and_what_a_new_one_no_longer_does_is_not(self):
        self.assertTrue(self.good(link=([100.0], [100.0]), routing=([], [20.0])))
        self.assertFalse(self.good(link=([100.0], [100.0]), routing=([20.0], [])))

    def test_nothing_measured_is_not_good(self):
        self.assertFalse(self.good())

    def test_a_flight_that_is_larger_than_it_may_be_is_not_good(self):
        memory = "in flight, proportional memory / MB"
        self.assertTrue(self.good(**{memory: ([60.0], [compare.LARGEST_MB])}))
        self.assertFalse(self.good(**{memory: ([64.0], [compare.LARGEST_MB + 0.1])}))


if __name__ == "__main__":
    unittest.main(verbosity=2)
