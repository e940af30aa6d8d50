# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a client sent and received around deaths of the supervisor, compared with each other and with the log (docs/adr/0217)."""
import collections
import dataclasses
import math
import struct
import time
import unittest

import flight
import honest
import judges
import stored_log
import witness

ADOPTED_S = 1.0
PUSHES_N = 10.0
FREE_MM = 22                     # the robot, at its home, is so far from the rail
# From the client's hand until the supervisor has read it; how old what is under way at a kill may be; and from asking for a kill to its end.
READ_S, UNDER_WAY_S, KILLED_S = 0.5, 2.0, 0.05
PING = "17,1"                    # waits for no disk
# What an addressee says of one execution: accepted, started, the answer, completed.
OF_ONE_EXECUTION = 4
NAMES = {honest.SUPERVISOR: "SUPERVISOR", honest.COMMUNICATION: "COMMUNICATION", flight.MANIPULATOR: "MANIPULATOR", flight.JOYSTICK: "JOYSTICK"}
MACHINES = (flight.MANIPULATOR, flight.JOYSTICK)
ANSWERS = {"17,1": witness.ALIVE, "20,1": witness.VALUES}


def call_of(packet):
    """(service and subtype, addressee, sequence count) of a telecommand."""
    apid, count = struct.unpack(">HH", packet[:4])
    return f"{packet[7]},{packet[8]}", NAMES[apid & 0x7FF], f"#{count & 0x3FFF}"


@dataclasses.dataclass
class Log:
    """What the log of a flight has of telecommands and reports."""
    gaps: int = 0
    missing: int = 0                   # numbers that stand in gaps
    silence_s: float = 0.0             # the longest between two records
    noted: collections.Counter = dataclasses.field(default_factory=collections.Counter)        # call -> how often it was received
    forwarded: collections.Counter = dataclasses.field(default_factory=collections.Counter)    # call -> how often it was handed to its addressee
    said: witness.Reports = dataclasses.field(default_factory=witness.Reports)                 # behind the number from which on it is compared


class Accounts(unittest.TestCase):
    def push(self, craft, from_mm=FREE_MM):
        """Until the robot leans on the rail: the hand goes so far, and farther. What is felt in the blow alone is over after a second."""
        for reach_mm in range(from_mm, from_mm + 30, 4):
            craft.fault("joystick", "hand", "cartesian", reach_mm / 1e3, 0, 0.5)
            time.sleep(1.0)
            if craft.truth("robot")["force"] > 2 * PUSHES_N:
                return
        self.fail("the robot does not push")

    def compare(self, rokviss, ground, sent, deaths=(), most_silent=0, before=None, most_silence_s=ADOPTED_S, most_unheard=None):
        """`deaths`: when each supervisor was lost, and when another one went on. `before`: the newest number of the log when nobody of the ground
        listened yet; what was said since then, which a Witness heard, is compared, too, and how long the log was silent, `most_silence_s` at most.
        `most_unheard`: reports that stand in the log and did not come, where it is not as few as telecommands without a word."""
        silent, several, accepted_only, unknown = [], [], [], []
        asked, answered, accepted = collections.Counter(), collections.Counter(), collections.Counter()
        for request, calls in self.sent_at(sent).items():
            reports = ground.reports.get(request, [])
            # A sequence count comes again after 16384: what is told until then is about the telecommand before.
            for (at, call), until in zip(calls, [*(later for later, _ in calls[1:]), math.inf]):
                subtypes = [subtype for subtype, told_at in reports if at <= told_at < until]
                ends = [subtype for subtype in subtypes if subtype in honest.ENDS]
                if not subtypes:
                    silent.append((call, at))
                elif not ends:
                    accepted_only.append((call, subtypes))
                if len(ends) > 1:
                    several.append((call, subtypes))
                if 8 in subtypes:
                    unknown.append((call, at))
                asked[call] += 1
                answered[call] += bool(subtypes)
                accepted[call] += 1 in subtypes
        flight.measure(f"ended as unknown: {len(unknown)}, without any report: {len(silent)}")
        heard_until = time.monotonic()
        time.sleep(judges.TELEMETRY_S)        # what was heard by now stands in the log, and what stands in it by now is on its way
        log = self.read(rokviss, before)
        self.stands_in_the_log(answered, accepted, log)
        self.was_handed_on_once(asked, silent, answered, log)
        if before is not None:
            time.sleep(judges.TELEMETRY_S)
            self.assertLessEqual(log.gaps, len(deaths), "what is missing went with a supervisor")
            self.assertLess(log.silence_s, most_silence_s, "the log goes on with the next one")
            self.was_said(ground.heard, log, deaths, heard_until, most_silent if most_unheard is None else most_unheard)
            self.was_carried_out_once(sent, ground.heard, log)
        self.assertEqual(several, [], "one end each")
        self.assertEqual(accepted_only, [], "what was accepted has an end")
        self.was_in_flight(silent, unknown, deaths)
        self.assertLessEqual(len(silent), most_silent, f"between reading and noting: {silent[:5]}")

    @staticmethod
    def sent_at(sent):
        """{request id: [(when it was sent, the call)], first of all first}."""
        calls = {}
        for packet, at in sent:
            calls.setdefault(packet[:4], []).append((at, call_of(packet)))
        return calls

    def was_in_flight(self, silent, unknown, deaths):
        """Nothing is said only of what a supervisor was reading as it was killed, one each time: it was not accepted, and may be said again
        (docs/adr/0093). Its outcome is unknown only of what was under way then."""
        read = collections.Counter()
        for call, at in silent:
            by = next((lost for lost, _ in deaths if lost - READ_S <= at <= lost + KILLED_S), None)
            self.assertIsNotNone(by, f"{call} was lost while a supervisor was there")
            read[by] += 1
        self.assertLessEqual(max(read.values(), default=0), 1, f"each reads one at a time: {silent}")
        for call, at in unknown:
            self.assertTrue(any(lost - UNDER_WAY_S <= at <= gone_on for lost, gone_on in deaths), f"{call} is unknown though nobody died then")

    def was_handed_on_once(self, asked, silent, answered, log):
        """Of what only the client asks its members for, as the supervisor itself notes."""
        twice = {call: (log.forwarded[call], times) for call, times in asked.items() if call[1] != "SUPERVISOR" and log.forwarded[call] > times}
        self.assertEqual(twice, {}, "handed on more often than it was sent")
        unseen = [call for call, _ in silent if call[1] != "SUPERVISOR" and log.forwarded[call] > answered[call]]
        self.assertEqual(unseen, [], "nothing was said of it, and it was carried out")

    def was_carried_out_once(self, sent, heard, log):
        """As the addressees say and number it themselves: whatever they said is in the log or came to the ground, but for what a supervisor had read
        as it was killed. Of two executions one would be missing whole in the addressee's own count."""
        reports = judges.united(log.said, heard)
        requests, asked = {}, collections.Counter()
        for packet, at in sent:
            requests.setdefault(int.from_bytes(packet[:4], "big"), []).append(at)
            kind, name, _ = call_of(packet)
            if kind in ANSWERS:
                asked[next(apid for apid, known in NAMES.items() if known == name), ANSWERS[kind]] += 1
        runs = {NAMES[apid]: judges.missing_runs(reports, apid) for apid in MACHINES}
        flight.measure("telecommands that their addressee says it has begun: " +
                       f"{sum(1 for said in judges.executions(requests, reports).values() if said[witness.STARTED])}; numbers of addressees' own counts that "
                       "nobody has: " + ", ".join(f"{name} {sum(lengths)}, {max(lengths, default=0)} in a row at most" for name, lengths in runs.items()))
        self.assertEqual(judges.carried_out_twice(requests, reports), [])
        self.assertEqual(judges.answered_more_often(asked, reports), [])
        for name, lengths in runs.items():
            self.assertLess(max(lengths, default=0), OF_ONE_EXECUTION, f"{name}: an execution may have gone unseen")

    def stored(self, rokviss):
        """Records of the log, oldest first."""
        return stored_log.records(rokviss.folder / "log")

    def read(self, rokviss, before=None):
        """Each number of the log once, in a record or in a gap that says so. Reports and silence are taken behind number `before`."""
        log, expected, at = Log(), None, None
        for record in self.stored(rokviss):
            if expected is not None and record.number < expected:
                continue                # not acknowledged in one piece, and stored again in the next
            if expected is not None:
                self.assertEqual(record.number, expected, record)
            expected = record.number + 1
            if record.kind == stored_log.GAP:
                expected = record.last_missing() + 1
                self.assertEqual(expected - record.number, record.lost, record)
                log.gaps += 1
                log.missing += record.lost
                continue
            was, at = at, record.at
            compared = before is not None and record.number > before
            if compared and was is not None:
                log.silence_s = max(log.silence_s, at - was)
            if record.kind in (stored_log.RECEIVED, stored_log.FORWARDED):
                if record.packet[9:11] == struct.pack(">H", honest.HONEST):
                    (log.noted if record.kind == stored_log.RECEIVED else log.forwarded)[call_of(record.packet)] += 1
            elif record.kind in (stored_log.TELEMETRY, stored_log.EVENT) and compared:
                log.said.add(witness.said(record.packet, at))
        flight.measure(f"numbers of the log that stand in gaps: {log.missing} in {log.gaps}; longest silence of the log {log.silence_s:.3f} s")
        return log

    def was_said(self, heard, log, deaths, until, most_unheard):
        """Whatever came to the ground stands in the log octet by octet, but for what its gaps say, and that was heard within the time that it takes
        to the disk before a kill; and what stands there came, but for housekeeping, of which a slow link leaves out some."""
        absent = judges.not_in_the_log(heard, log.said.keys(), deaths, until)
        there = heard.keys()
        unheard = [report for report in log.said if report.kind != witness.HOUSEKEEPING and report.key not in there]
        flight.measure(f"reports that came to the ground: {len(heard)}, of them not in the log: {len(absent)}; in the log, and did not come: {len(unheard)}")
        alarms = [judges.before_kill_s(report.at, deaths) for report in heard if judges.class_of(report) == judges.EVENTS]
        soon = sum(1 for before_s in alarms if judges.EVENT_S < before_s < 0.1)
        flight.measure(f"{judges.EVENTS} that came: {len(alarms)}, {soon} of them {1e3 * judges.EVENT_S:.0f} to 100 ms before a kill; not in the log was at most, heard before a kill: " +
                       ("; ".join(f"{name} {1e3 * before_s:.1f} ms" for name, before_s in judges.longest_s(absent).items()) or "nothing"))
        self.assertGreater(len(log.said), 0)
        self.assertEqual(judges.lost(absent), [])
        self.assertLessEqual(len(absent), log.missing)
        self.assertLessEqual(len(unheard), most_unheard, f"between noting and telling: {unheard[:5]}")

    def stands_in_the_log(self, answered, accepted, log):
        """What was answered. An essential telecommand is answered before it stands there, and is in a gap where it never came so far; any other has
        waited for the disk before its addressee could accept it."""
        absent = {call: (times, log.noted[call]) for call, times in answered.items() if times > log.noted[call]}
        lost = sum(times - there for times, there in absent.values())
        flight.measure(f"answered, and in a gap of the log: {lost}")
        self.assertLessEqual(lost, log.missing, absent)
        waited = {call: (times, log.noted[call]) for call, times in accepted.items()
                  if call[0] != PING and call[1] != "SUPERVISOR" and times > log.noted[call]}
        self.assertEqual(waited, {}, "it was accepted before it stood in the log")
        self.assertGreater(sum(log.noted.values()), 0)
