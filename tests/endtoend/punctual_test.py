#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A failed flight is flown again for one reason only, and that reason is true."""
import pathlib
import sys
import unittest
import xml.etree.ElementTree as xml

import punctual

SOURCES = pathlib.Path(__file__).resolve().parents[2]
LATE = punctual.WATCHDOG_S * 2


class Punctual(unittest.TestCase):
    def judged(self, *attempts):
        """(exit code, how many attempts were made)."""
        made = []
        return punctual.last_of((made.append(one) or one for one in attempts), lambda text: None), len(made)

    def test_a_failure_on_a_punctual_host_is_a_failure_at_once(self):
        self.assertEqual(self.judged((1, punctual.WATCHDOG_S), (0, 0.0)), (1, 1))

    def test_where_lateness_cannot_be_told_from_our_own_a_failure_is_a_failure(self):
        self.assertEqual(self.judged((1, None), (0, 0.0)), (1, 1))

    def test_a_failure_on_a_late_host_is_no_verdict_until_the_last(self):
        self.assertEqual(self.judged((1, LATE), (0, LATE), (1, 0.0)), (0, 2))
        self.assertEqual(self.judged((1, LATE), (1, 0.0), (0, 0.0)), (1, 2))
        self.assertEqual(self.judged(*[(1, LATE)] * 3), (1, 3))

    def test_a_skip_is_a_skip(self):
        self.assertEqual(self.judged((punctual.SKIPPED, LATE), (0, 0.0)), (punctual.SKIPPED, 1))

    def test_what_the_program_says_is_what_comes_of_an_attempt(self):
        for code in (0, 3):
            self.assertEqual(punctual.attempt([sys.executable, "-c", f"raise SystemExit({code})"], 60.0)[0], code)

    def test_what_the_host_stood_still_in_a_time_is_that_of_one_processor_and_of_that_time(self):
        host = punctual.Lateness()
        for processor, begin, end in ((0, 1.0, 1.009), (0, 2.0, 2.010), (1, 1.995, 2.004), (1, 5.0, 5.0 + punctual.NOTABLE_S / 2)):
            host._note(processor, begin, end)
        self.assertAlmostEqual(host.stood_still_s(0.0, 9.0), 0.019)
        self.assertAlmostEqual(host.stood_still_s(1.9, 2.002), 0.007)
        self.assertEqual(host.stood_still_s(3.0, 6.0), 0.0)
        self.assertAlmostEqual(host.worst_s, 0.010)

    def test_late_means_later_than_the_shortest_watchdog_of_the_shipped_descriptors(self):
        watchdogs = [float(device.get("watchdog_ms")) for file in SOURCES.glob("subsystems/*/*.xml")
                     for device in xml.parse(file).iter("Device") if device.get("watchdog_ms")]
        self.assertEqual(min(watchdogs), 1e3 * punctual.WATCHDOG_S)


if __name__ == "__main__":
    unittest.main()
