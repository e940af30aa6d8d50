#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Everything is stopped, the supervisor dies, and then who keeps the station: who was stopped takes over nothing from it under the next
supervisor either (docs/adr/0148)."""
import unittest

import flight
import handover_test


class StoppedBefore(unittest.TestCase):
    def test_who_was_stopped_before_a_supervisor_died_takes_over_nothing(self):
        with flight.Flight(handover_test.MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(craft.hirosco("safe").returncode, 0)
            for _ in range(2):
                begin = craft.count()
                craft.kill("hirosco-supervisor")
                craft.wait_told("goes on with SPARE", 5.0, begin)
                craft.wait_told("SUPERVISOR info STATE_CHANGED STATE=Operational", 5.0, begin)
            begin = craft.count()
            handover_test.HandOver.kill_keeper(self, craft)
            craft.wait_told("nobody takes over the task of KEEPER: SPARE was stopped, and nobody has let it go since", 10.0, begin)
            self.assertIsNotNone(handover_test.HandOver.state_of(self, craft, "SPARE", "PreOperational"))


if __name__ == "__main__":
    flight.main()
