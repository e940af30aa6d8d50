#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A log in pieces that a mission bounds, read as one log: nothing of it is lost or there twice, and what was removed was declared
and told."""
import unittest

import flight
import floods

PINGS = 4000


class LogPieces(unittest.TestCase):
    def test_a_bounded_log_rotates_and_removes_as_declared_also_while_the_strategy_changes(self):
        with flight.MissionCopy({"64": "1", "4096": "3"}) as mission, flight.Flight(mission) as craft:
            craft.wait_commissioned()
            begin = craft.count()
            for strategy in ("ascii", "sqlite", "ascii", "sqlite"):
                floods.flood(PINGS // 4)
                self.assertEqual(craft.tc("supervisor", "SET_DATABASE", strategy)[0], 0)
            craft.wait_told("SUPERVISOR info LOG_ROTATED", 30.0, begin)
            craft.wait_told("SUPERVISOR low LOG_REMOVED", 30.0, begin)
            craft.wait_told("removed as keep_MB says", 5.0, begin)
            self.assertEqual(craft.end(seconds=30.0), 0, craft.errors)
            pieces = [path for path in (craft.folder / "log").iterdir() if path.suffix in (".db", ".log")]
            octets = sum(path.stat().st_size for path in pieces)
            flight.measure(f"{len(pieces)} pieces, {octets / 1e6:.1f} MB of 3 MB")
            self.assertLess(octets, 4_500_000, "what is declared, and one batch")
            records = craft.log()
            self.assertGreater(records[0]["number"], 1, "the oldest is gone")
            floods.assert_continuous(self, records, records[0]["number"])


if __name__ == "__main__":
    flight.main()
