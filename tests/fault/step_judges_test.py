#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each judge of losses in the midst of a step sees the fault that it is there for, and nothing where there is none: on what is made up."""
import unittest

import pages
import step_judges
from kill_windows import HIT

PROGRAM = "hirosco-manipulator"
LOST, GONE_ON = 100.0, 100.9


class Watched:
    """What a pages.Watch has seen: cycles each millisecond but in `pause`, and states."""
    first = pages.Watch.first
    longest_pause_s = pages.Watch.longest_pause_s

    def __init__(self, looks, pause=(0.0, 0.0), worst_s=0.001):
        times = [99.0 + 0.001 * count for count in range(4000)]
        self.counts = {PROGRAM: [(at, count) for count, at in enumerate(times) if not pause[0] < at < pause[1]]}
        self.changes = {PROGRAM: [pages.Look(at, 0, state, inhibited, 0) for at, state, inhibited in looks]}
        self.worst_s = worst_s


def status(mode, *states):
    return {"mode": mode, "subsystems": [{"name": name, "state": state} for name, state in zip(("MANIPULATOR", "JOYSTICK"), states)]}


class Windows(unittest.TestCase):
    def test_a_loss_before_acceptance_or_behind_an_end_is_none_in_the_step(self):
        self.assertEqual(step_judges.in_a_step([(1, 99.9), (7, 100.2)], LOST), HIT)
        self.assertNotEqual(step_judges.in_a_step([(1, 100.1), (7, 100.2)], LOST), HIT)
        self.assertNotEqual(step_judges.in_a_step([(1, 99.9), (7, 99.95)], LOST), HIT)
        self.assertNotEqual(step_judges.in_a_step([], LOST), HIT)

    def test_a_plan_lasts_from_its_event_to_the_last_state_that_it_leads_to(self):
        self.assertEqual(step_judges.in_a_plan(99.9, 100.2, LOST), HIT)
        self.assertNotEqual(step_judges.in_a_plan(100.1, 100.2, LOST), HIT)
        self.assertNotEqual(step_judges.in_a_plan(99.8, 99.9, LOST), HIT)

    def test_what_lasts_has_to_last_for_the_whole_step(self):
        reports = [(1, 99.9), (7, 100.2)]
        self.assertEqual(step_judges.in_the_whole(reports, 99.8, 100.3), HIT)
        self.assertNotEqual(step_judges.in_the_whole(reports, 99.95, 100.3), HIT)
        self.assertNotEqual(step_judges.in_the_whole(reports, 99.8, 100.1), HIT)


class GoesOn(unittest.TestCase):
    def test_a_successor_that_comes_late_is_seen_and_one_that_hung_before_has_the_keepers_patience_more(self):
        self.assertEqual(step_judges.gone_on_late(LOST, LOST + 0.99, 0.0), [])
        self.assertEqual(len(step_judges.gone_on_late(LOST, LOST + 1.01, 0.0)), 1)
        self.assertEqual(step_judges.gone_on_late(LOST, LOST + 1.79, step_judges.PATIENCE_S), [])
        self.assertEqual(len(step_judges.gone_on_late(LOST, LOST + 1.81, step_judges.PATIENCE_S)), 1)

    def test_a_pause_of_whose_state_stays_and_a_link_that_is_lost_are_seen(self):
        def told(watch):
            return len(step_judges.stood_still(watch, PROGRAM, LOST, GONE_ON))
        moving, safe = [(99.0, 5, 0)], [(99.0, 4, 1)]
        for looks in (moving, safe):
            self.assertEqual(told(Watched(looks)), 0)
            self.assertEqual(told(Watched(looks, pause=(100.3, 100.36))), 1)
            self.assertEqual(told(Watched(looks, pause=(100.3, 100.36), worst_s=0.02)), 0, "the watch itself was late")
            self.assertEqual(told(Watched(looks, pause=(101.3, 101.36))), 0, "behind the loss")
        self.assertEqual(told(Watched([*moving, (100.2, 5, step_judges.BY_LINK)])), 1)
        self.assertEqual(told(Watched([*moving, (100.2, 5, 1)])), 0, "a stop is no lost link")
        self.assertEqual(told(Watched([*moving, (100.2, 6, 0)], pause=(100.3, 100.36))), 0, "it was on its way elsewhere")


class ComesToRest(unittest.TestCase):
    def test_who_moves_for_longer_than_its_time_without_anybody_is_seen(self):
        def told(looks, end=103.0):
            return len(step_judges.moves_still(Watched(looks), PROGRAM, LOST, end))
        self.assertEqual(told([(99.0, 5, 0), (102.05, 5, 32)]), 0)
        self.assertEqual(told([(99.0, 5, 1)]), 0, "it was stopped already")
        self.assertEqual(told([(99.0, 5, 0), (102.2, 5, 32)]), 1)
        self.assertEqual(told([(99.0, 5, 0)]), 1)

    def test_another_mode_or_one_that_moves_behind_a_plan_or_a_stop_is_seen(self):
        def told(step, *where):
            return len(step_judges.ended_elsewhere(step, "telepresence", "standalone", status(*where)))
        for mode in ("telepresence", "standalone"):
            self.assertEqual(told("mode change", mode, "Operational", "Operational"), 0)
            self.assertEqual(told("SAFE_ALL", mode, "SafeOperational", "SafeOperational"), 0)
            self.assertEqual(told("SAFE_ALL", mode, "SafeOperational", "Operational"), 1)
            self.assertEqual(told("plan", mode, "Operational", "Offline"), 1)
        self.assertEqual(told("mode change", "automatic", "Offline", "Offline"), 1)
        self.assertEqual(told("mode change", "commissioning", "Operational", "Offline"), 1)
        self.assertEqual(told("mode change", "commissioning", "SafeOperational", "PreOperational"), 0)


if __name__ == "__main__":
    unittest.main()
