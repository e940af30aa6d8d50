#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_couplings.py judges, it sees: in flights whose links say something else than it expects, and whose files are not those that were edited."""
import contextlib
import io
import unittest
import unittest.mock

import flight
import real_couplings
from real_couplings import Craft, Trial


def judged(step, change=lambda text: text, edit=Craft.edit):
    """(whether it passed, what was told) of one flight with this step, of a mission that was changed."""
    copy = Craft.copy

    def changed(folder):
        mission = copy(folder)
        mission.write_text(change(mission.read_text()))
        return mission

    trial = Trial(1, 0, threads=False)
    trial.steps = [getattr(trial, step)]
    with unittest.mock.patch.object(Craft, "copy", staticmethod(changed)), unittest.mock.patch.object(Craft, "edit", edit), \
            contextlib.redirect_stdout(io.StringIO()) as told:
        return real_couplings.flown(trial, False, "--planted"), told.getvalue()


class Seen(unittest.TestCase):
    def test_nothing_is_said_of_a_flight_as_it_is(self):
        passed, told = judged("leaves")
        self.assertTrue(passed, told)

    def test_whoever_holds_on_for_longer_is_seen(self):
        passed, told = judged("leaves", lambda text: text.replace('hold_ms="1500"', 'hold_ms="9000"'))
        self.assertFalse(passed)
        self.assertIn("VIOLATION not told within 2.5 s: 'COUNTER: TICKS did not come back in time'", told)

    def test_whoever_does_not_fall_back_is_seen(self):
        passed, told = judged("dies", lambda text: text.replace(' on_loss="fallback" fallback="ALONE"', ""))
        self.assertFalse(passed)
        self.assertIn("VIOLATION not told within 2 s: 'FALLING has lost TICKS of ENCODER: fallback'", told)

    def test_a_text_that_is_none_and_is_taken_is_seen(self):
        passed, told = judged("reads_again_what_is_none", edit=lambda craft, member, how: craft.text_of(member))
        self.assertFalse(passed)
        self.assertRegex(told, r"VIOLATION SUPERVISOR REREAD \(\d+,\) was not refused")


if __name__ == "__main__":
    flight.main()
