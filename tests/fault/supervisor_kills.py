#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of the supervisor, N times (`--kills N`) or more, while the robot pushes on the rail and a client commands without a pause
(docs/adr/0093), so that more than a thousand packets a second pass. Each time another one goes on with both machines as they are. A sixth of N
falls between TM[1,1] and TM[1,7], of a SAFE_ALL and of a motion of the robot's in turn, a sixth into a change of the log's strategy, a sixth into
the begin of a new piece of the log: behind each kill it is looked whether it did, and one that missed counts as one at any moment. A sixth
follows an event of high severity. (`--plain`: fewer packets, and a sixth of N in a SAFE_ALL, the rest at any moment.) In the end what the client
sent and heard is compared with each other and with the log, octet by octet: each telecommand has one end; none was carried out twice, as its
addressee says, or without a word; of one that was being read at the very kill nothing is said, and nothing was done, so that it may be said again;
what was heard for longer than it takes to the disk is in the log; and the log is silent for no longer than nobody was there."""
import math
import os
import random
import signal
import sqlite3
import struct
import sys
import time

import flight
import honest
import kill_windows
import late_host
import stored_log
import witness
from accounts import ADOPTED_S, FREE_MM, PUSHES_N, Accounts

KILLS = int(sys.argv.pop(sys.argv.index("--kills") + 1)) if "--kills" in sys.argv else 6
if "--kills" in sys.argv:
    sys.argv.remove("--kills")
# The slice of a check: no kill into the log's work, and fewer packets.
PLAIN = "--plain" in sys.argv
if PLAIN:
    sys.argv.remove("--plain")
SEED = 20261124
# A supervisor that lives for 2 s is no part of a crash loop (supervisor/keeper/kept.hpp).
LIVES_S = 2.2
STANDALONE, TELEPRESENCE = 2, 3
PIECES = {"64": "4"}             # of the log, in MB, so that one begins every second or two
SQLITE, ASCII = 0, 1
STRATEGIES = {SQLITE: "sqlite", ASCII: "ascii"}
PACKETS_PER_S = 1000
# Of the joints: the robot's home, and a place to go to that is free of the rail.
HOME_RAD, AWAY_RAD, MOTION_S = (-0.8, 1.6), (-0.9, 1.8), 1.0
COLD_C, TOO_HOT_C = 20, 81
EVENT_S = 0.05                   # behind an event that was heard, at most, it is killed

SAFE_ALL, MOTION, SWITCH, PIECE, EVENT = (
    "between TM[1,1] and TM[1,7] of SAFE_ALL", "between those of a motion", "in a change of the log's strategy", "in the begin of a piece of the log",
    "behind an event of high severity")
WANTED = {SAFE_ALL: KILLS // 12, MOTION: KILLS // 6 - KILLS // 12, SWITCH: KILLS // 6, PIECE: KILLS // 6, EVENT: KILLS // 6}


class SupervisorKills(Accounts):
    def test_nothing_is_lost_and_the_robot_stays_coupled(self):
        self.draw = random.Random(SEED)
        self.tally = kill_windows.Tally({SAFE_ALL: KILLS // 6} if PLAIN else WANTED)
        self.aims = {name: kill_windows.Aim(self.draw, longest_s) for name, longest_s in ((SAFE_ALL, 0.05), (SWITCH, 0.01), (PIECE, 0.005))}
        self.strategy, self.took, self.deaths, self.late = SQLITE, [], [], 0
        with late_host.LateHost() as self.host, flight.MissionCopy({} if PLAIN else PIECES) as mission, flight.Flight(mission) as self.rokviss:
            self.rokviss.wait_commissioned()
            self.push(self.rokviss)
            before = self.rokviss.log(last=1)[-1]["number"]
            self.ground = witness.Witness()
            self.client = witness.Client(self.ground, pause_s=0.005 if PLAIN else 0.0025)
            began, packets = time.monotonic(), self.ground.packets
            try:
                self.kill_all()
            finally:
                sent = list(self.client.sent)
                rate = (len(sent) + self.ground.packets - packets) / (time.monotonic() - began)
                self.tell(len(sent), rate)
            self.compare(self.rokviss, self.ground, sent, self.deaths, len(self.deaths) // 50, before)
            self.assertEqual(self.tally.missed(), [], "each window was hit as often as is wanted")
            if not PLAIN:
                self.assertGreater(rate, PACKETS_PER_S)

    def kill_all(self):
        self.begin = self.rokviss.count()
        while self.tally.open() or len(self.deaths) < KILLS:
            self.host.forget()
            time.sleep(LIVES_S + self.draw.uniform(0.0, 0.3))
            self.coupled_on("")
            self.strike()
        time.sleep(LIVES_S)
        self.client.ending = True
        self.client.thread.join()
        for packet, _ in self.client.sent[-200:]:
            self.ground.verdict(packet, 5.0)

    def tell(self, telecommands, rate):
        took = sorted(self.took) or [0.0]
        flight.measure(f"{len(self.deaths)} kills of the supervisor, {self.tally}, {telecommands} telecommands, {rate:.0f} packets/s, another one went on "
                       f"after {took[len(took) // 2]:.3f} s, {took[-1]:.3f} s at most; on a late host the robot was let go {self.late} times")

    def strike(self):
        """Into the window that lacks most; at any moment, as often as that, while there are kills left for it."""
        windows = self.tally.open()
        left = KILLS - len(self.deaths) - sum(self.tally.wanted[name] - self.tally.hits[name] for name in windows)
        if not windows or (left > 0 and self.draw.random() < 0.5):
            return self.at_any_moment()
        self.tally.count(windows[0], self.STROKES[windows[0]](self))

    def struck(self, pid=None):
        """It is killed, another one goes on in time, and says how it found the craft."""
        self.begin = self.rokviss.count()
        pid = pid or self.rokviss.pid_of("hirosco-supervisor")
        self.killed = time.monotonic()
        os.kill(pid, signal.SIGKILL)
        self.rokviss.wait_told("goes on for one that died", 5.0, self.begin)
        told = self.rokviss.wait_told("goes on with MANIPULATOR", 5.0, self.begin)
        self.took.append(told.received - self.killed)
        self.deaths.append((self.killed, told.received))
        self.assertLess(self.took[-1], ADOPTED_S, f"kill {len(self.deaths)}")
        return told.told

    def coupled_on(self, told):
        """Before a kill, and behind one of which nobody is to feel anything."""
        truth = self.rokviss.truth("robot")
        if "stopped" not in told and truth["force"] > PUSHES_N:
            return
        time.sleep(1.0)
        # Of a host that stood still for longer than a device waits the robot's being let go says nothing; what is said and logged is judged all the same.
        if self.host.was_late() and self.late < KILLS / 10:
            self.late += 1
            return self.couple_again(4)
        status = self.rokviss.wait_status(lambda status: True, 3.0)
        since = "\n".join([f"{status and status['subsystems']}", *(f"{line.at_s:.4f} s  {line.told}" for line in self.rokviss.told(self.begin)),
                           *(record["text"] for record in self.rokviss.records("--text", "event", last=40))])
        self.fail(f"after kill {len(self.deaths)} the robot does not go on: {truth}, a second later {self.rokviss.truth('robot')}, the host was late by "
                  f"{1e3 * self.host.worst_s():.1f} ms at most\n{since}")

    def at_any_moment(self):
        self.coupled_on(self.struck())

    def before_its_stop_is_done(self):
        pid = self.rokviss.pid_of("hirosco-supervisor")
        packet = self.sent_and_accepted(honest.safe_all(self.ground.next()))
        time.sleep(self.aims[SAFE_ALL].wait_s())
        self.struck(pid)
        self.rokviss.wait_at_rest("robot", time.monotonic())
        self.assertTrue(self.ends_of(packet), "SAFE_ALL has an end")
        miss = self.was_in(packet)
        self.aims[SAFE_ALL].learn(miss == kill_windows.HIT)
        # The robot stands at the rail; the hand comes back before they are coupled again where they are.
        self.couple_again(4)
        return miss

    def before_its_motion_is_done(self):
        """The robot's own, which nobody may begin again or end: it is where it was told to go."""
        rokviss = self.rokviss
        self.mode(STANDALONE)
        self.assertEqual(self.moved(HOME_RAD), [7])
        pid = rokviss.pid_of("hirosco-supervisor")
        packet = self.sent_and_accepted(self.move_to(AWAY_RAD))
        time.sleep(self.draw.uniform(0.0, 0.9 * MOTION_S))
        told = self.struck(pid)
        self.assertNotIn("stopped", told)
        self.assertEqual(self.ends_of(packet), [7], "the motion comes to its end")
        miss = self.was_in(packet)
        self.assertEqual(self.moved(HOME_RAD), [7])
        self.couple_again(FREE_MM)
        return miss

    def while_the_log_changes_its_strategy(self):
        pid, known = self.rokviss.pid_of("hirosco-supervisor"), self.pieces()
        packet = self.sent_and_accepted(self.other_strategy())
        time.sleep(self.aims[SWITCH].wait_s())
        told = self.struck(pid)
        self.assertTrue(self.ends_of(packet), "SET_DATABASE has an end")
        self.coupled_on(told)
        suffix = stored_log.SUFFIXES[STRATEGIES[self.strategy]]
        begun = self.taken([path for path in self.pieces() - known if path.suffix == suffix])
        miss = kill_windows.in_a_switch(self.heard_of(packet), begun, self.killed)
        self.aims[SWITCH].learn(miss == kill_windows.HIT)
        return miss

    def other_strategy(self):
        self.strategy = ASCII if self.strategy == SQLITE else SQLITE
        return honest.call(self.ground.next(), "SET_DATABASE", bytes([self.strategy]))

    def as_a_piece_of_the_log_begins(self):
        """Of SQLite, whose opening takes several writes to the disk. In ASCII a piece begins with its first records, in one write of some microseconds."""
        if self.strategy == ASCII:
            self.sent_and_accepted(self.other_strategy())
            time.sleep(1.0)
        pid, end = self.rokviss.pid_of("hirosco-supervisor"), time.monotonic() + 30.0
        number, newest = stored_log.pieces(self.rokviss.folder / "log")[-1]
        if newest.suffix != stored_log.SUFFIXES["sqlite"]:
            # A supervisor that died in a switch may have made none of it: who goes on writes as before.
            self.strategy = ASCII
            self.at_any_moment()
            return "the newest piece was ASCII's"
        begun = newest.with_name(f"{newest.name.split('.')[0]}.{number + 1}{newest.suffix}")
        while not begun.exists():
            self.assertLess(time.monotonic(), end, f"kill {len(self.deaths)}: no new piece of the log")
            time.sleep(0.0002)
        seen = time.monotonic()
        time.sleep(self.aims[PIECE].wait_s())
        told = self.struck(pid)
        miss = kill_windows.in_the_begin_of_a_piece(seen, self.taken([begun]), self.killed)
        self.aims[PIECE].learn(miss == kill_windows.HIT)
        self.coupled_on(told)
        return miss

    def behind_an_event_of_high_severity(self):
        """The robot is too hot, which takes the network down; it is cold again when it is brought up."""
        rokviss, begin = self.rokviss, len(self.ground.heard)
        pid = rokviss.pid_of("hirosco-supervisor")
        rokviss.ask("robot", "temperature", 2, TOO_HOT_C)
        heard = lambda: self.ground.heard_since(begin, flight.MANIPULATOR, witness.HIGH)
        self.assertTrue(self.ground.wait(lambda: heard() < math.inf, 2.0), "the event is heard")
        time.sleep(self.draw.uniform(0.0, EVENT_S))
        self.struck(pid)
        rokviss.wait_at_rest("robot", time.monotonic())
        rokviss.ask("robot", "temperature", 2, COLD_C)
        self.couple_again(4)
        return kill_windows.HIT if heard() < self.killed else "the event was not heard before the kill"

    STROKES = {SAFE_ALL: before_its_stop_is_done, MOTION: before_its_motion_is_done, SWITCH: while_the_log_changes_its_strategy,
               PIECE: as_a_piece_of_the_log_begins, EVENT: behind_an_event_of_high_severity}

    def pieces(self):
        return {path for _, path in stored_log.pieces(self.rokviss.folder / "log")}

    def taken(self, paths):
        """{piece: its records}. One whose making was cut off is read once the next supervisor has mended it."""
        end = time.monotonic() + 2.0
        while True:
            try:
                return {path: list(stored_log.records_of(path)) for path in paths if path.exists()}
            except sqlite3.OperationalError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.05)

    def heard_of(self, packet):
        """[(subtype, when)] since it was sent: its number was another one's 16384 telecommands before."""
        with self.ground.arrived:
            return [(subtype, at) for subtype, at in self.ground.reports.get(packet[:4], []) if at >= self.sent_at_s]

    def ends_of(self, packet):
        """The subtypes of its ends, once there is one."""
        self.ground.wait(lambda: any(subtype in honest.ENDS for subtype, _ in self.heard_of(packet)), 5.0)
        return [subtype for subtype, _ in self.heard_of(packet) if subtype in honest.ENDS]

    def was_in(self, packet):
        """By what the client heard, and the newest pieces of the log."""
        newest = [path for _, path in stored_log.pieces(self.rokviss.folder / "log")[-3:]]
        around = [record for records in self.taken(newest).values() for record in records if record.at > self.killed - 10.0]
        return kill_windows.in_a_telecommand(self.heard_of(packet), around, packet[:4], self.killed, self.deaths[-1][1])

    def sent_and_accepted(self, packet):
        self.send(packet)
        self.assertTrue(self.ground.wait(lambda: any(subtype == 1 for subtype, _ in self.heard_of(packet)), 2.0), "it is accepted")
        return packet

    def send(self, packet):
        self.sent_at_s = time.monotonic()
        return self.client.send(packet)

    def move_to(self, goal_rad):
        arguments = [bytes([place]) + struct.pack(">d", value) for place, value in enumerate((*goal_rad, MOTION_S), 1)]
        return honest.telecommand(flight.MANIPULATOR, self.ground.next(), 8, b"MOVE_TO".ljust(16, b"\0") + bytes([3]) + b"".join(arguments))

    def moved(self, goal_rad):
        return self.ends_of(self.send(self.move_to(goal_rad)))

    def mode(self, number):
        """A stop that is not over yet refuses it."""
        end = time.monotonic() + 10.0
        while self.rokviss.tc("supervisor", "SET_MODE", number)[0] != 0:
            self.assertLess(time.monotonic(), end, f"kill {len(self.deaths)}: mode {number} comes up")
            time.sleep(0.5)

    def couple_again(self, from_mm):
        self.rokviss.fault("joystick", "hand", "cartesian", 0, 0, 0.5)
        time.sleep(1.0)
        self.mode(TELEPRESENCE)
        self.push(self.rokviss, from_mm)


if __name__ == "__main__":
    flight.main()
