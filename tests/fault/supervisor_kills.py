#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of the supervisor, N times (`--kills N`), while the robot pushes on the rail and a client commands without a pause
(docs/adr/0093), so that more than a thousand packets a second pass. Each time another one goes on with both machines as they are. Of
six kills one falls between TM[1,1] and TM[1,7] of a SAFE_ALL, one into a change of the log's strategy, one into the begin of a new
piece of the log (`--plain`: fewer packets, and no kill into the log's work). In the end what the client sent and received is compared
with each other and with the log: each telecommand has one end; none was carried out twice, or without a word; of one that was being read at the very
kill nothing is said, and nothing was done, so that it may be said again; and the log is silent for no longer than nobody was there."""
import collections
import dataclasses
import math
import os
import random
import socket
import struct
import sys
import threading
import time
import unittest

import flight
import honest

KILLS = int(sys.argv.pop(sys.argv.index("--kills") + 1)) if "--kills" in sys.argv else 6
if "--kills" in sys.argv:
    sys.argv.remove("--kills")
# The slice of a check: no kill into the log's work, and fewer packets.
PLAIN = "--plain" in sys.argv
if PLAIN:
    sys.argv.remove("--plain")
SEED = 20261124
ADOPTED_S = 1.0
# A supervisor that lives for 2 s is no part of a crash loop (supervisor/keeper/kept.hpp).
LIVES_S = 2.2
PUSHES_N = 10.0
FREE_MM = 22                     # the robot, at its home, is so far from the rail
POS_SCALE = flight.MANIPULATOR << 16 | 10 << 8 | 8
TELEPRESENCE = 3
PIECES = {"64": "4"}             # of the log, in MB, so that one begins every second or two
SQLITE, ASCII = 0, 1
SWITCH_S, ROTATION_S = 0.030, 0.005    # what a change of strategy takes, and the begin of a piece
PACKETS_PER_S = 1000
# From the client's hand until the supervisor has read it; how old what is under way at a kill may be; and from asking for a kill to its end.
READ_S, UNDER_WAY_S, KILLED_S = 0.5, 2.0, 0.05
PING = "17,1"                    # waits for no disk


NAMES = {honest.SUPERVISOR: "SUPERVISOR", honest.COMMUNICATION: "COMMUNICATION", flight.MANIPULATOR: "MANIPULATOR", flight.JOYSTICK: "JOYSTICK"}


def call_of(packet):
    """(service and subtype, addressee, sequence count) of a telecommand as the log has them."""
    apid, count = struct.unpack(">HH", packet[:4])
    return f"{packet[7]},{packet[8]}", NAMES[apid & 0x7FF], f"#{count & 0x3FFF}"


def call_in(record):
    """The same of a record of the log."""
    kind, addressee, count = record["text"].split(" TC[", 1)[1].split()[:3]
    return kind.rstrip("]"), addressee, count


def second_of_day(record):
    hours, minutes, seconds = record["stored"].rstrip("Z").split("T")[1].split(":")
    return 3600 * int(hours) + 60 * int(minutes) + float(seconds)


@dataclasses.dataclass
class Log:
    """What the log of a flight says of telecommands and reports."""
    gaps: int = 0
    missing: int = 0                   # numbers that stand in gaps
    silence_s: float = 0.0             # the longest between two records
    noted: collections.Counter = dataclasses.field(default_factory=collections.Counter)        # call -> how often it was received
    forwarded: collections.Counter = dataclasses.field(default_factory=collections.Counter)    # call -> how often it was handed to its addressee
    said: collections.Counter = dataclasses.field(default_factory=collections.Counter)         # (source, service, subtype) -> times


class Client:
    """Asks both machines in turn: a ping, which waits for nothing, and the value of a parameter, which waits for the log."""

    def __init__(self, ground, port=honest.TELECOMMAND_PORT, pause_s=0.005):
        self.ground, self.sent, self.ending, self.pause_s = ground, [], False, pause_s
        self.mutex = threading.Lock()
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.ending:
            apid = (flight.MANIPULATOR, flight.JOYSTICK)[len(self.sent) // 2 % 2]
            if len(self.sent) % 2 or apid == flight.JOYSTICK:
                self.send(honest.telecommand(apid, self.ground.next()))
            else:
                self.send(honest.telecommand(apid, self.ground.next(), 20, struct.pack(">BI", 1, POS_SCALE)))
            time.sleep(self.pause_s)

    def send(self, packet):
        with self.mutex:
            self.sent.append((packet, time.monotonic()))
            self.socket.sendall(packet)
        return packet


class Accounts(unittest.TestCase):
    """What a client sent and received, compared with each other and with the log."""

    def push(self, craft, from_mm=FREE_MM):
        """Until the robot leans on the rail: the hand goes so far, and farther. What is felt in the blow alone is over after a second."""
        for reach_mm in range(from_mm, from_mm + 30, 4):
            craft.fault("joystick", "hand", "cartesian", reach_mm / 1e3, 0, 0.5)
            time.sleep(1.0)
            if craft.truth("robot")["force"] > 2 * PUSHES_N:
                return
        self.fail("the robot does not push")

    def compare(self, rokviss, ground, sent, deaths=(), most_silent=0, before=None):
        """`deaths`: when each supervisor was lost, and when another one went on. `before`: the newest number of the log when nobody of the ground
        listened yet; what was said since then is compared, too, and how long the log was silent."""
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
        heard = self.heard(ground)
        log = self.read(rokviss, before)
        self.stands_in_the_log(answered, accepted, log)
        self.was_carried_out_once(asked, silent, answered, log)
        if before is not None:
            self.assertLessEqual(log.gaps, len(deaths), "what is missing went with a supervisor")
            self.assertLess(log.silence_s, ADOPTED_S, "the log goes on with the next one")
            time.sleep(1.0)         # what stands in the log by now is on its way
            self.was_said(heard, self.heard(ground), log, most_silent)
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

    def was_carried_out_once(self, asked, silent, answered, log):
        """Of what only the client asks its members for."""
        twice = {call: (log.forwarded[call], times) for call, times in asked.items() if call[1] != "SUPERVISOR" and log.forwarded[call] > times}
        self.assertEqual(twice, {}, "handed on more often than it was sent")
        unseen = [call for call, _ in silent if call[1] != "SUPERVISOR" and log.forwarded[call] > answered[call]]
        self.assertEqual(unseen, [], "nothing was said of it, and it was carried out")

    def read(self, rokviss, before=None):
        """Each number of the log once, in a record or in a gap that says so. Reports without housekeeping and silence are counted behind number
        `before`."""
        log, expected, at = Log(), None, None
        for record in rokviss.records(last=10_000_000):
            number = record["number"]
            if expected is not None:
                self.assertEqual(number, expected, record)
            expected = number + 1
            if record["kind"] == "gap":
                expected = int(record["text"].rsplit("number ", 1)[1].split('"')[0]) + 1
                log.gaps += 1
                log.missing += expected - number
                continue
            was, at = at, second_of_day(record)
            if before is not None and number > before and was is not None:
                log.silence_s = max(log.silence_s, at - was + (86400 if at - was < -43200 else 0))
            if record["kind"] == "telecommand-received":
                log.noted[call_in(record)] += 1
            elif record["kind"] == "telecommand-forwarded":
                log.forwarded[call_in(record)] += 1
            elif record["kind"] in ("telemetry", "event") and before is not None and number > before:
                kind, source = record["text"].split(" TM[", 1)[1].split()[:2]
                if kind != "3,25]":
                    log.said[source, *map(int, kind.rstrip("]").split(","))] += 1
        flight.measure(f"numbers of the log that stand in gaps: {log.missing} in {log.gaps}; longest silence of the log {log.silence_s:.3f} s")
        return log

    @staticmethod
    def heard(ground):
        with ground.arrived:
            return collections.Counter({(NAMES[apid], service, subtype): times for (apid, service, subtype), times in ground.said.items()})

    def was_said(self, heard, heard_later, log, most_unheard):
        """Whatever came to the ground without housekeeping stands in the log as often as it came, but for what its gaps say; and what
        stands there came."""
        said = log.said
        unlogged = {kind: (times, said[kind]) for kind, times in heard.items() if times > said[kind]}
        lost = sum(times - there for times, there in unlogged.values())
        unheard = sum(max(0, there - heard_later[kind]) for kind, there in said.items())
        flight.measure(f"reports that came to the ground: {sum(heard.values())}, of them not in the log: {lost}; in the log, and did not come: {unheard}")
        self.assertGreater(sum(said.values()), 0)
        self.assertLessEqual(lost, log.missing, unlogged)
        self.assertLessEqual(unheard, most_unheard, "between noting and telling")

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


class SupervisorKills(Accounts):
    """Of six kills the kinds of `STROKES`, and three at any moment."""

    def test_nothing_is_lost_and_the_robot_stays_coupled(self):
        self.draw = random.Random(SEED)
        with flight.MissionCopy({} if PLAIN else PIECES) as mission, flight.Flight(mission) as rokviss:
            self.rokviss, self.strategy, self.took, self.deaths = rokviss, ASCII, [], []
            rokviss.wait_commissioned()
            self.push(rokviss)
            before = rokviss.log(last=1)[-1]["number"]
            self.ground = honest.Honest()
            self.client = Client(self.ground, pause_s=0.005 if PLAIN else 0.0025)
            strokes = {0: SupervisorKills.before_its_stop_is_done} if PLAIN else self.STROKES
            began, packets = time.monotonic(), self.ground.packets
            for self.kill in range(1, KILLS + 1):
                time.sleep(LIVES_S + self.draw.uniform(0.0, 0.3))
                strokes.get(self.kill % 6, SupervisorKills.at_any_moment)(self)
            time.sleep(LIVES_S)
            self.client.ending = True
            self.client.thread.join()
            took_s = time.monotonic() - began
            sent = list(self.client.sent)
            for packet, _ in sent[-200:]:
                self.ground.verdict(packet, 5.0)
            self.compare(rokviss, self.ground, sent, self.deaths, KILLS // 50, before)
            self.took.sort()
            rate = (len(sent) + self.ground.packets - packets) / took_s
            flight.measure(f"{KILLS} kills of the supervisor, {len(sent)} telecommands, {rate:.0f} packets/s, another one went on after "
                           f"{self.took[len(self.took) // 2]:.3f} s, {self.took[-1]:.3f} s at most")
            if not PLAIN:
                self.assertGreater(rate, PACKETS_PER_S)

    def struck(self):
        """It is killed, another one goes on in time, and says how it found the craft."""
        self.begin = self.rokviss.count()
        killed = self.rokviss.kill("hirosco-supervisor")
        told = self.rokviss.wait_told("goes on with MANIPULATOR", 5.0, self.begin)
        self.took.append(told.received - killed)
        self.deaths.append((killed, told.received))
        self.assertLess(self.took[-1], ADOPTED_S, f"kill {self.kill}")
        return told.told

    def coupled_on(self, told):
        truth = self.rokviss.truth("robot")
        if "stopped" in told or truth["force"] <= PUSHES_N:
            time.sleep(1.0)
            since = "\n".join(f"{line.at_s:.4f} s  {line.told}" for line in self.rokviss.told(self.begin))
            self.fail(f"kill {self.kill}: the robot does not go on: {truth}, a second later {self.rokviss.truth('robot')}\n{since}")

    def at_any_moment(self):
        self.coupled_on(self.struck())

    def before_its_stop_is_done(self):
        rokviss = self.rokviss
        packet = self.sent_and_accepted(honest.safe_all(self.ground.next()))
        self.struck()
        rokviss.wait_at_rest("robot", time.monotonic())
        self.assertIsNotNone(self.ground.verdict(packet, 5.0), "SAFE_ALL has an end")
        # The robot stands at the rail; the hand comes back before they are coupled again where they are.
        rokviss.fault("joystick", "hand", "cartesian", 0, 0, 0.5)
        time.sleep(1.0)
        self.assertEqual(rokviss.tc("supervisor", "SET_MODE", TELEPRESENCE)[0], 0, f"kill {self.kill}: up again")
        self.push(rokviss, 4)

    def while_the_log_changes_its_strategy(self):
        packet = self.sent_and_accepted(honest.call(self.ground.next(), "SET_DATABASE", bytes([self.strategy])))
        self.strategy = SQLITE if self.strategy == ASCII else ASCII
        time.sleep(self.draw.uniform(0.0, SWITCH_S))
        told = self.struck()
        self.assertIsNotNone(self.ground.verdict(packet, 5.0), "SET_DATABASE has an end")
        self.coupled_on(told)

    def as_a_piece_of_the_log_begins(self):
        pieces = lambda: set(os.listdir(self.rokviss.folder / "log"))
        before, end = pieces(), time.monotonic() + 30.0
        while pieces() <= before:
            self.assertLess(time.monotonic(), end, f"kill {self.kill}: no new piece of the log")
            time.sleep(0.0002)
        time.sleep(self.draw.uniform(0.0, ROTATION_S))
        self.coupled_on(self.struck())

    def sent_and_accepted(self, packet):
        self.client.send(packet)
        self.assertTrue(self.ground.wait(lambda: self.ground.reports.get(packet[:4]), 2.0), "it is accepted")
        return packet

    STROKES = {0: before_its_stop_is_done, 1: while_the_log_changes_its_strategy, 2: as_a_piece_of_the_log_begins}


if __name__ == "__main__":
    flight.main()
