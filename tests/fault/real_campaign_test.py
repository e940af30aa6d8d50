#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_campaign.py judges, it sees: planted on pages as a watch has them, and in flights whose plans take nobody down. That fewer
faults than were asked for are a failure, and that nobody goes on with the flights of another build."""
import contextlib
import io
import os
import pathlib
import signal
import tempfile
import threading
import types
import unittest
import unittest.mock

import flight
import kept_flights
import link_gaps
import pages
import reactions
import real_campaign
from demands import Violation
from real_campaign import JOYSTICK, ROBOT
from reactions import CYCLE_S, ERROR_OPERATIONAL, OFFLINE, OPERATIONAL

LOST, FIRST = 10.0, 1000            # s; cycles at the look before it
STORY = ("plan died: network {MANIPULATOR, JOYSTICK} to ErrorOperational and down", "JOYSTICK info STATE_CHANGED STATE=ErrorOperational",
         "MANIPULATOR info STATE_CHANGED STATE=ErrorOperational")


def seen(safe_cycles=1, error_cycles=4, offline_s=0.004, fenced_s=0.0, lateness_s=0.0):
    """A watch that has seen both go down this way behind LOST."""
    watch = pages.Watch.__new__(pages.Watch)
    watch.worst_s, watch.fenced, watch.changes, watch.counts = lateness_s, dict.fromkeys((ROBOT, JOYSTICK), LOST + fenced_s), {}, {}
    for program in (ROBOT, JOYSTICK):
        looks = [(LOST - 1.0, 0, OPERATIONAL, 0, 0), (LOST + safe_cycles * CYCLE_S, FIRST + safe_cycles, OPERATIONAL, 1, FIRST + safe_cycles),
                 (LOST + error_cycles * CYCLE_S, FIRST + error_cycles, ERROR_OPERATIONAL, 1, FIRST + safe_cycles),
                 (LOST + offline_s, FIRST + error_cycles + 1, OFFLINE, 1, FIRST + safe_cycles)]
        watch.changes[program] = [pages.Look(*look) for look in looks]
        watch.counts[program] = [(LOST - 0.001, FIRST), (LOST + 0.001, FIRST + 2)]
    return watch


class Pages(unittest.TestCase):
    def trial(self, story=STORY, obeyed_s=0.0):
        judge = reactions.Reactions()
        judge.craft = types.SimpleNamespace(told=lambda _: [types.SimpleNamespace(told=text) for text in story],
                                            truth=lambda _: {"obeyed_s": obeyed_s})
        return judge

    def judged(self, watch, others=(JOYSTICK,), **trial):
        judge = self.trial(**trial)
        judge.is_safe(watch, reactions.DEATH, LOST, others)
        judge.obeys_nobody(watch, reactions.DEATH, LOST, (0.0, LOST))
        judge.comes_down(watch, reactions.DEATH, LOST, others)
        return judge.figures

    def test_who_keeps_each_deadline_to_its_end_is_told_of_with_what_it_took(self):
        grid = round(reactions.GRID_S / CYCLE_S)
        figures = self.judged(seen(safe_cycles=5 + grid, error_cycles=10 + grid, offline_s=1.999, fenced_s=0.0044),
                              obeyed_s=0.0124)
        self.assertEqual({what: round(1e3 * took, 3) for what, (took,) in figures.items()}, {
            "network fenced behind a death": 4.4, "others inhibited behind a death": 4.5, "robot obeys nobody behind a death": 12.4,
            "others in error behind a death": 7.0, "all Offline behind a death": 1999.0})

    def test_what_is_later_than_that_is_a_violation_each_by_itself(self):
        late = {"network fenced behind a death": {"fenced_s": 0.005}, "others inhibited behind a death": {"safe_cycles": 10, "error_cycles": 11},
                "others in error behind a death": {"error_cycles": 15, "offline_s": 0.1}, "all Offline behind a death": {"offline_s": 2.01}}
        for row, planted in late.items():
            with self.assertRaisesRegex(Violation, f"^{row} only after"):
                self.judged(seen(**planted))
        with self.assertRaisesRegex(Violation, "^robot obeys nobody behind a death only after 13.0 ms"):
            self.judged(seen(), obeyed_s=0.013)

    def test_as_much_longer_as_the_watch_itself_was_late(self):
        self.judged(seen(fenced_s=0.005, lateness_s=0.0006))
        with self.assertRaises(Violation):
            self.judged(seen(fenced_s=0.005, lateness_s=0.0004))

    def test_who_is_left_out_of_it_is_missed(self):
        watch = seen()
        del watch.fenced[JOYSTICK]
        with self.assertRaisesRegex(Violation, "fenced behind a death were only"):
            self.judged(watch)
        for kept, missed in ((1, "actuators of JOYSTICK were not inhibited"), (2, "JOYSTICK was not in Error-Operational"),
                             (3, "JOYSTICK was not Offline")):
            watch = seen()
            del watch.changes[JOYSTICK][kept:]
            with self.assertRaisesRegex(Violation, missed):
                self.judged(watch, others=(ROBOT, JOYSTICK))

    def test_who_goes_down_past_error_operational_or_without_its_network_is_no_reaction(self):
        with self.assertRaisesRegex(Violation, "JOYSTICK was not in Error-Operational"):
            self.judged(seen(), story=(STORY[0], STORY[2]))
        with self.assertRaisesRegex(Violation, "the plan took down {'JOYSTICK'}"):
            self.judged(seen(), story=("plan died: network {JOYSTICK} to ErrorOperational and down", *STORY[1:]))
        with self.assertRaisesRegex(Violation, "no plan took the network down"):
            self.judged(seen(), story=STORY[1:])

    def test_a_process_that_hung_has_to_have_ended_by_then(self):
        with self.assertRaisesRegex(Violation, "all Offline behind a hang only after 2100.0 ms"):
            self.trial().comes_down(seen(), reactions.HANG, LOST, [JOYSTICK], LOST + 2.1)


class Links(unittest.TestCase):
    """Of links 1 and 2, whose descriptors permit three cycles."""

    def judged(self, gaps=None, stale=(), lateness_s=0.0):
        watch = pages.Watch.__new__(pages.Watch)
        watch.worst_s = lateness_s
        watch.gaps = {JOYSTICK: {1: 0}, ROBOT: {2: 3}} | (gaps or {})
        watch.stale = {JOYSTICK: set(), ROBOT: set(stale)}
        watch.vital = lambda _: types.SimpleNamespace(configuration=lambda: link_gaps.COUPLED, realtime=lambda: 1)
        judge = link_gaps.LinkGaps()
        judge.no_link_had_a_gap(watch, (JOYSTICK, ROBOT), LOST, LOST + 0.05)
        return judge.figures

    def test_what_is_permitted_is_told_of_for_each_link(self):
        self.assertEqual(self.judged(), {"link gap, 3 cycles permitted": [0.0, 3 * CYCLE_S]})

    def test_four_cycles_without_a_new_sample_are_a_gap(self):
        with self.assertRaisesRegex(Violation, "link 2 had nothing new for 4 cycles of hirosco-spinnable-manipulator, which permits 3"):
            self.judged({ROBOT: {2: 4}})
        self.judged({ROBOT: {2: 4}}, lateness_s=0.0006)

    def test_a_consumer_that_took_it_for_stale_saw_a_gap_that_no_look_did(self):
        with self.assertRaisesRegex(Violation, r"took link \{2\} for stale"):
            self.judged(stale=[2], lateness_s=1.0)

    def test_who_has_no_link_is_not_judged_to_have_had_no_gap(self):
        with self.assertRaisesRegex(Violation, "has no link"):
            self.judged({ROBOT: {}})

    def test_a_partner_that_stands_still_while_there_is_no_supervisor_is_seen_in_a_flight(self):
        kill = flight.Flight.kill

        def with_its_partner_stopped(craft, name, number=signal.SIGKILL):
            if name != "hirosco-supervisor" or number == signal.SIGTERM:
                return kill(craft, name, number)
            pid, lost = craft.pid_of(JOYSTICK), kill(craft, name, number)
            os.kill(pid, signal.SIGSTOP)
            threading.Timer(0.005, os.kill, (pid, signal.SIGCONT)).start()
            return lost
        with flight.MissionCopy({**real_campaign.SPINNABLE, **real_campaign.RESTARTS}) as mission, contextlib.redirect_stdout(io.StringIO()) as told, \
             unittest.mock.patch.object(flight.Flight, "kill", with_its_partner_stopped):
            self.assertFalse(real_campaign.flown(mission, real_campaign.Trial(1, 0, "supervisor_killed", 1), ""))
        self.assertRegex(told.getvalue(), r"VIOLATION (link 2 had nothing new for|hirosco-spinnable-manipulator took link \{2\} for stale)")


class Hundreds(unittest.TestCase):
    def ends(self, done, outcome=True):
        """(whether it passed, what it printed) where each flight comes so far in what it was to do."""
        def flown(_, trial, *__):
            trial.done = done(len(trial.steps))
            return outcome
        with unittest.mock.patch.object(real_campaign, "flown", flown), contextlib.redirect_stdout(io.StringIO()) as told:
            return real_campaign.hundreds(None, 1, 12, None), told.getvalue()

    def test_passes_when_all_were_done(self):
        passed, told = self.ends(lambda wanted: wanted)
        self.assertTrue(passed)
        self.assertNotIn("FEWER", told)

    def test_fewer_than_wanted_is_a_failure_that_is_told_even_without_a_violation(self):
        passed, told = self.ends(lambda _: 0, None)
        self.assertFalse(passed)
        self.assertIn("0 violations", told)
        self.assertIn("FEWER than were asked for: spinning was done 0 times of 12; ", told)

    def test_a_violation_is_a_failure_with_all_done(self):
        self.assertFalse(self.ends(lambda wanted: wanted, False)[0])


class Kept(unittest.TestCase):
    """By programs of a folder of their own, which nobody starts."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.file = self.folder / "kept"
        self.program = self.folder / "hirosco-manipulator"
        self.program.write_bytes(b"as it was built")
        self.enterContext(unittest.mock.patch.object(flight, "BINARIES", self.folder))

    def kept(self, seed=1, kind=None):
        return kept_flights.KeptFlights(self.file, flight.ROKVISS, seed, kind)

    def test_whoever_goes_on_has_all_that_it_took_until_then(self):
        self.kept().add(0, True, {"adopted": [0.1, 0.2]})
        self.kept().add(1, False, {"adopted": [0.3]})
        again = self.kept()
        self.assertEqual((again.passed, again.figures), ({0: True, 1: False}, {"adopted": [0.1, 0.2, 0.3]}))
        self.assertEqual(self.kept(seed=2).passed, {})

    def test_one_octet_of_a_program_is_another_build_which_is_refused(self):
        under_way = self.kept()
        under_way.add(0, True, {})
        self.program.write_bytes(b"as it was built anew")
        with self.assertRaisesRegex(SystemExit, "kept: its flights are those of .*build.*, what flies now is .*: name another file"):
            self.kept()
        with self.assertRaisesRegex(SystemExit, "flight 1 was flown while the programs were built anew"):
            under_way.add(1, True, {})
        self.program.write_bytes(b"as it was built")
        self.assertEqual(self.kept().passed, {0: True})

    def test_so_is_one_of_another_kind_and_one_that_does_not_say_of_which_build_it_is(self):
        self.kept().add(0, True, {})
        with self.assertRaisesRegex(SystemExit, "'kind': None"):
            self.kept(kind="killed")
        self.file.write_text("1 0 passed\n")
        with self.assertRaisesRegex(SystemExit, "does not say of which build"):
            self.kept()

    def test_a_line_in_the_midst_of_which_it_was_ended_is_flown_again(self):
        self.kept().add(0, True, {})
        with self.file.open("a") as file:
            file.write('{"seed": 1, "number": 1, "pas')
        self.kept().add(1, True, {})
        self.assertEqual(self.kept().passed, {0: True, 1: True})


class NoReaction(unittest.TestCase):
    def test_a_flight_whose_plans_take_nobody_down_is_no_campaign(self):
        changes = {**real_campaign.SPINNABLE, **real_campaign.RESTARTS, "shut_down_network": "log"}
        for kind, told_of in (("killed", "no plan took the network down behind a death"), ("unplugged", "network fenced behind an unplugging only after")):
            with flight.MissionCopy(changes) as mission, contextlib.redirect_stdout(io.StringIO()) as told:
                self.assertFalse(real_campaign.flown(mission, real_campaign.Trial(1, 0, kind, 1), ""))
            self.assertIn(f"VIOLATION {told_of}", told.getvalue())


if __name__ == "__main__":
    flight.main()
