#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each judge of the campaigns of kills sees the fault that it is there for, and nothing where there is none: on records and reports that are made up."""
import binascii
import pathlib
import sqlite3
import struct
import tempfile
import unittest
import zlib

import accounts
import flight
import honest
import judges
import kill_windows
import stored_log
import witness

ROBOT = flight.MANIPULATOR
KILLED, GONE_ON = 100.0, 100.05
DEATHS = [(50.0, 50.05), (KILLED, GONE_ON)]


def report(count, service, subtype, data=b"", apid=ROBOT):
    body = struct.pack(">HHHBBBHHIBH", 0x0800 | apid, 0xC000 | count, 13 + len(data) + 2 - 1 + 0, 0x20, service, subtype, 0, honest.HONEST, 7, 0, 0) + data
    return body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF))


def heard(*packets):
    reports = witness.Reports()
    for packet, at in packets:
        reports.add(witness.said(packet, at))
    return reports


def complaints(packet, at, stored=()):
    reports = heard((packet, at))
    return judges.lost(judges.not_in_the_log(reports, heard(*stored).keys(), DEATHS))


class Lost(unittest.TestCase):
    def test_an_event_of_high_severity_heard_longer_than_its_bound_before_a_kill_is_missed(self):
        for subtype in (3, 4):
            event = report(1, 5, subtype, b"\x03\xf4")
            self.assertEqual(len(complaints(event, KILLED - 0.011)), 1)
            self.assertEqual(complaints(event, KILLED - 0.009), [])
            self.assertEqual(complaints(event, KILLED - 0.011, [(event, 99.0)]), [])

    def test_a_report_of_a_telecommand_and_housekeeping_are_missed_after_theirs(self):
        for packet in (report(1, 1, 7, bytes(4)), report(1, 3, 25, b"\x12\x69"), report(1, 17, 2)):
            self.assertEqual(len(complaints(packet, KILLED - 1.1)), 1)
            self.assertEqual(complaints(packet, KILLED - 0.9), [])

    def test_what_was_on_its_way_to_the_client_as_the_supervisor_died_counts_before_that_kill(self):
        self.assertEqual(complaints(report(1, 5, 4), KILLED + 0.02), [])

    def test_what_is_missing_though_nobody_died_behind_it_is_missed(self):
        self.assertEqual(len(complaints(report(1, 3, 25), GONE_ON + 0.1)), 1)

    def test_other_octets_of_the_same_kind_are_another_report(self):
        self.assertEqual(len(complaints(report(1, 5, 4, b"\0\1"), KILLED - 0.5, [(report(1, 5, 4, b"\0\2"), 99.0)])), 1)


class Twice(unittest.TestCase):
    call = honest.telecommand(ROBOT, 33)
    request = int.from_bytes(call[:4], "big")

    def said(self, *rows):
        return [witness.said(report(count, 1, subtype, self.call[:4]), at) for count, subtype, at in rows]

    def twice(self, *rows, sent=(10.0,)):
        return judges.carried_out_twice({self.request: list(sent)}, judges.united(self.said(*rows)))

    def test_a_telecommand_whose_addressee_says_started_twice_was_carried_out_twice(self):
        once = ((1, 1, 10.1), (2, 3, 10.1), (3, 7, 10.1))
        self.assertEqual(self.twice(*once), [])
        self.assertEqual(len(self.twice(*once, (8, 3, 10.2))), 1)
        self.assertEqual(len(self.twice(*once, (8, 1, 10.2))), 1)

    def test_the_same_report_in_the_log_and_at_the_client_is_one(self):
        rows = self.said((2, 3, 10.1))
        self.assertEqual(judges.carried_out_twice({self.request: [10.0]}, judges.united(rows, rows)), [])

    def test_a_number_that_came_again_is_another_telecommand(self):
        self.assertEqual(self.twice((2, 3, 10.1), (8, 3, 20.1), sent=(10.0, 20.0)), [])
        self.assertEqual(len(self.twice((2, 3, 10.1), (8, 3, 19.9), sent=(10.0, 20.0))), 1)

    def test_more_answers_than_questions_are_seen_without_any_report_of_telecommands(self):
        answers = [witness.said(report(count, 17, 2), 10.0) for count in (1, 2)]
        asked = lambda times: {(ROBOT, witness.ALIVE): times}
        self.assertEqual(judges.answered_more_often(asked(2), answers), [])
        self.assertEqual(len(judges.answered_more_often(asked(1), answers)), 1)

    def test_an_execution_that_went_unseen_is_missing_in_the_count_of_its_addressee(self):
        counted = lambda *counts: judges.missing_runs([witness.said(report(count, 3, 25), 1.0) for count in counts], ROBOT)
        self.assertEqual(counted(16382, 16383, 0, 1), [])
        self.assertEqual(counted(16382, 3, 5), [4, 1])
        self.assertGreaterEqual(max(counted(1, 6)), accounts.OF_ONE_EXECUTION)


def record(at, kind=stored_log.TELEMETRY, packet=b""):
    return stored_log.Record(1, at, kind, 0, "", packet)


class Windows(unittest.TestCase):
    request = b"\x18\x01\xc0\x07"

    def fell(self, reports, records=()):
        return kill_windows.in_a_telecommand(reports, records, self.request, KILLED, GONE_ON)

    def test_a_kill_between_acceptance_and_end_is_a_hit_only_if_nobody_had_the_end_before(self):
        self.assertEqual(self.fell([(1, 99.9), (7, 100.2)]), kill_windows.HIT)
        self.assertEqual(self.fell([(1, 99.9), (8, 101.2)]), kill_windows.HIT)
        self.assertNotEqual(self.fell([(1, 100.01), (7, 100.2)]), kill_windows.HIT)
        self.assertNotEqual(self.fell([(1, 99.9), (7, 99.95)]), kill_windows.HIT)
        self.assertNotEqual(self.fell([(1, 99.9), (7, 100.01)]), kill_windows.HIT, "it was on its way to the client")
        end = report(1, 1, 7, self.request)
        self.assertNotEqual(self.fell([(1, 99.9), (7, 100.2)], [record(99.99, packet=end)]), kill_windows.HIT)
        self.assertEqual(self.fell([(1, 99.9), (7, 100.2)], [record(100.19, packet=end)]), kill_windows.HIT)

    def test_a_kill_behind_the_first_record_in_the_new_strategy_is_none_in_the_switch(self):
        accepted = [(1, 99.9)]
        self.assertEqual(kill_windows.in_a_switch(accepted, {}, KILLED), kill_windows.HIT)
        self.assertEqual(kill_windows.in_a_switch(accepted, {"7.log": [record(100.06)]}, KILLED), kill_windows.HIT)
        self.assertNotEqual(kill_windows.in_a_switch(accepted, {"7.log": [record(99.99)]}, KILLED), kill_windows.HIT)
        self.assertNotEqual(kill_windows.in_a_switch([(1, 100.01)], {}, KILLED), kill_windows.HIT)

    def test_a_kill_behind_the_first_record_of_a_piece_is_none_in_its_begin(self):
        self.assertEqual(kill_windows.in_the_begin_of_a_piece(99.99, {"8.db": [record(100.06)]}, KILLED), kill_windows.HIT)
        self.assertNotEqual(kill_windows.in_the_begin_of_a_piece(99.99, {"8.db": [record(99.995)]}, KILLED), kill_windows.HIT)

    def test_too_few_kills_in_a_window_are_told_after_a_bounded_number_of_tries(self):
        tally = kill_windows.Tally({"here": 2, "there": 1})
        tally.count("there", kill_windows.HIT)
        while tally.open():
            tally.count("here", "too late" if tally.hits["here"] else kill_windows.HIT)
        self.assertEqual(tally.tries["here"], 2 * kill_windows.Tally.TRIES)
        self.assertEqual(len(tally.missed()), 1)
        self.assertIn("here: 1 of 2", tally.missed()[0])


class StoredLog(unittest.TestCase):
    def test_both_strategies_are_read_in_their_order_without_what_is_torn(self):
        packet = report(5, 5, 4)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            store = sqlite3.connect(folder / "craft.db")
            store.execute("CREATE TABLE log (position INTEGER PRIMARY KEY, run, number, stored, monotonic, kind, source, peer, lost, note, packet)")
            store.execute("INSERT INTO log VALUES (1, 0, 1, 0, 2000000000, 'event', 10, 0, 0, '', ?)", (packet,))
            store.commit()
            store.close()
            (folder / "craft.3.db").touch()
            text = b"2 2026-01-01T00:00:37 2026-01-01T00:00:38 3000000000 gap 0 0 4 - the supervisor died, up to number 5"
            torn = b"6 2026-01-01T00:00:37 2026-01-01T00:00:38 3000000000 event 0 0 0 - "
            (folder / "craft.2.log").write_bytes(b"HIROSCO\n" + text + b" #%08x\n" % zlib.crc32(text) + torn)
            (folder / "craft.db.lock").touch()
            found = list(stored_log.records(folder))
        self.assertEqual([(one.number, one.at, one.kind) for one in found], [(1, 2.0, "event"), (2, 3.0, "gap")])
        self.assertEqual(found[0].packet, packet)
        self.assertEqual(found[1].last_missing(), 5)


if __name__ == "__main__":
    unittest.main()
