#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A subsystem in Python, written from docs/interfaces alone: a pendulum that provides a set, takes functions and keeps every duty. It
reads its descriptor; what that may declare beyond (devices, required sets, services of its own) is not for it. One thread does both
loops, at 50 Hz. Python's standard library only."""
import collections
import fcntl
import math
import os
import platform
import select
import signal
import socket
import struct
import sys
import time
import xml.etree.ElementTree

sys.dont_write_bytecode = True
from metronome_links import CYCLIC, ERROR, OFFLINE, OPERATIONAL, POST, PRE, SAFE  # noqa: E402
from metronome_packets import BUSY, NOT_NOW, UNKNOWN, Refusal, bad, say  # noqa: E402
from metronome_parts import Structure, Value, Words  # noqa: E402
from metronome_services import Services  # noqa: E402

WAYS = {(0, 3): [1, 2, 3], (3, 0): [7, 8, 9, 0], (3, 4): [4], (3, 6): [6], (3, 7): [7], (4, 0): [7, 8, 9, 0], (4, 3): [7, 3], (4, 5): [5],
        (4, 6): [6], (4, 7): [7], (5, 4): [4], (5, 6): [6], (6, 0): [7, 8, 9, 0], (6, 3): [7, 3], (6, 7): [7], (7, 0): [8, 9, 0], (7, 3): [3]}
MAGIC, VERSION, VITAL_OCTETS, PERMIT_OCTETS = 0x48495243, 8, 4976, 56
VALID, DEGRADED, FAULT = 1, 2, 4
SILENCE_S = 2
M64 = (1 << 64) - 1


def checked(number):
    return number & 0xFFFF | (~number & 0xFFFF) << 16


def permission_word(epoch):
    word = epoch + 0x9E3779B97F4A7C15 & M64
    word = (word ^ word >> 30) * 0xBF58476D1CE4E5B9 & M64
    word = (word ^ word >> 27) * 0x94D049BB133111EB & M64
    return word ^ word >> 31


class Metronome(Services):
    """The subsystem: services, states, cycle. Its pendulum is in control()."""

    def __init__(self, options, changes):
        self.root = xml.etree.ElementTree.parse(options["--descriptor"]).getroot()
        self.name, self.apid = self.root.get("name"), int(self.root.get("id"))
        if self.name != "METRONOME":
            raise ValueError(f"a descriptor of {self.name}")
        self.parameters = [Value(each) for each in self.root.findall("Parameters/*")]
        self.functions = {each.get("name"): each for each in self.root.iter("Function")}
        self.events = {int(each.get("id")): {"info": 1, "low": 2, "medium": 3, "high": 4}[each.get("severity")] for each in self.root.iter("Event")}
        self.events |= {0xF000: 1, 0xF001: 4, 0xF002: 2, 0xF003: 3, 0xF005: 2}
        self.configurations = {int(each.get("id")): each for each in self.root.findall("Configuration")}
        for word, text in changes:
            if word == "--as":
                self.name, self.apid = text.rsplit(":", 1)[0], int(text.rsplit(":", 1)[1])
            elif word == "--set":
                self.find(text.partition("=")[0]).init = text.partition("=")[2]
            else:
                raise ValueError(f"{word} {text}: there is nothing here for it")
        self.channel = socket.socket(fileno=int(options["--channel"]))
        self.channel.setblocking(False)
        self.vital, self.permit = (self.page(options[word], octets, readonly) for word, octets, readonly in (
            ("--vital", VITAL_OCTETS, False), ("--permit", PERMIT_OCTETS, True)))
        if self.permit.narrow[0] != MAGIC or self.vital.narrow[0] != MAGIC:
            raise ValueError("what should be the supervisor's pages are none")
        for page in (self.permit, self.vital):
            if page.narrow[1] != VERSION:
                raise ValueError(f"the supervisor's pages are of version {page.narrow[1]}, this program's of version {VERSION}")
        self.vital.narrow[6] = checked(0)                   # no real-time scheduling
        self.waiting, self.state, self.way, self.way_request, self.entering = collections.deque(), OFFLINE, [], None, None
        self.disabled, self.configuration, self.period_ns, self.structures, self.links = set(), None, 0, {}, {}
        self.calls, self.writes, self.inhibited, self.entered_epoch, self.next_ns = [], [], 0, 0, 0
        self.heartbeat, self.silent_cycles, self.silent_since, self.lost, self.finished, self.told_version = 0, 0, time.monotonic(), False, False, False
        epoch = os.environ.get("HIROSCO_EPOCH_NS")
        self.epoch_ns = int(epoch) if epoch else time.time_ns() - time.monotonic_ns() + (378_691_200 + 37) * 10**9
        self.times = {"latency": 0, "longest": 0, "mean": 0.0}

    @staticmethod
    def page(number, octets, readonly):
        number = int(number)
        if os.fstat(number).st_size < octets:
            raise ValueError("a page that is too small")
        page = Words(number, octets, readonly)
        os.close(number)
        return page

    def another_permit_page(self, number):
        """Of a supervisor that goes on for one that died: sealed against shrinking, growing and other writers."""
        try:
            sealed = fcntl.fcntl(number, 1034) & 0x16 == 0x16
            page = Words(number, PERMIT_OCTETS, True) if sealed and os.fstat(number).st_size == PERMIT_OCTETS else None
        except OSError:
            return False
        if page is None or (page.narrow[0], page.narrow[1]) != (MAGIC, VERSION):
            return False
        self.permit, self.heartbeat = page, page.wide[4]
        return True

    def find(self, name):
        head, _, tail = name.partition(".")
        value = next(p for p in self.parameters if p.name == head)
        return next(m for m in value.members if m.name == tail) if tail else value

    # --- states ------------------------------------------------------------------------------------------------------------

    def permitted(self):
        epoch = self.permit.narrow[2]
        return self.permit.wide[2] == permission_word(epoch), epoch

    def set_state(self, request, target):
        if self.way and not (target == ERROR and self.state in CYCLIC and self.way[0] in CYCLIC and self.way[0] != ERROR):
            raise Refusal(4, BUSY)
        wrong = Refusal(4, 10, bytes([self.state]))
        if (self.state, target) not in WAYS:
            raise wrong
        if target == ERROR and self.configuration is None or (self.state, target) == (PRE, SAFE) and self.configuration is None:
            raise wrong
        if target == OPERATIONAL and not self.permitted()[0]:
            raise Refusal(4, NOT_NOW, b"\0")
        if self.way_request:
            self.fail(self.way_request, 8, 0x0204)
        self.verify(request, 3)
        self.go(target, request)

    def go(self, target, request=None):
        self.way, self.way_request = list(WAYS[self.state, target]), request
        self.advance()

    def advance(self):
        """As far as it goes without the cycle."""
        while self.way and not (self.way[0] in CYCLIC and self.configuration is not None):
            state = self.way[0]
            self.show(state)
            if state == 1:
                for parameter in self.parameters:
                    parameter.reset()
            elif state == POST:
                self.release()
            self.arrive(state)

    def show(self, state):
        self.vital.narrow[2] = checked(state)

    def arrive(self, state):
        self.state = state
        self.show(state)
        self.event(0xF000, bytes([state]))
        self.way.pop(0)
        if not self.way and self.way_request:
            self.verify(self.way_request, 7)
            self.way_request = None

    def configure(self, request, number):
        if self.way:
            raise Refusal(4, BUSY)
        if self.state != PRE:
            raise Refusal(4, 10, bytes([self.state]))
        if number not in self.configurations:
            raise bad(UNKNOWN, 0, number)
        wanted = self.configurations[number]
        if self.configuration is not None and self.configuration is not wanted:
            raise bad(0x0103, 0, number)
        self.verify(request, 3)
        if self.configuration is None:
            self.configuration, self.period_ns = wanted, int(wanted.get("sampling_us")) * 1000
            for each in wanted.findall("Set"):
                value = self.find(each.get("parameter"))
                value.value = value.parse(each.get("value"))
            self.structures = {int(each.get("id")): Structure(each, self.find) for place in (self.root, wanted) for each in place.findall("HKService")}
            self.inhibited, self.heartbeat, self.silent_cycles = 0, self.permit.wide[4], 0
            self.times = {"latency": 0, "longest": 0, "mean": 0.0}
            self.vital.wide[7] = 0
            self.vital.narrow[3] = checked(number)
            self.vital.wide[4] = self.period_ns
            self.vital.narrow[7] = checked(1)
            self.next_ns = time.monotonic_ns() + self.period_ns
        self.verify(request, 7)

    def release(self):
        if self.configuration is None:
            return
        for link in list(self.links):
            self.let_go(link)
        for request, _, _ in self.calls:
            self.fail(request, 4, 0x0204)
        self.calls = []
        self.apply_writes()
        self.vital.narrow[7] = checked(0)
        self.configuration, self.structures = None, {}
        self.vital.narrow[3], self.vital.narrow[4] = checked(0), 0

    def watch_supervisor(self):
        if self.silent_cycles > self.silence_limit() and self.state == OPERATIONAL and not self.way or self.lost and self.state == OPERATIONAL:
            self.inhibited |= 32
            self.go(ERROR)
        elif self.lost and not self.way:
            if self.state == OFFLINE:
                self.finished = True
            elif self.state != OFFLINE:
                self.go(OFFLINE)

    def silence_limit(self):
        return max(1, -(-SILENCE_S * 10**9 // max(self.period_ns, 1)))

    # --- the cycle ---------------------------------------------------------------------------------------------------------

    def cycle(self):
        started, planned = time.monotonic_ns(), self.next_ns
        was_inhibited = self.inhibited
        heartbeat = self.permit.wide[4]
        self.silent_cycles = 0 if heartbeat != self.heartbeat else self.silent_cycles + 1
        self.heartbeat = heartbeat
        moves, epoch = self.permitted()
        if self.permit.narrow[3] or self.state == OPERATIONAL and (epoch != self.entered_epoch or not moves):
            self.inhibited |= 1
        if self.silent_cycles > self.silence_limit():
            self.inhibited |= 32
            if self.silent_cycles == self.silence_limit() + 1:
                self.event(0xF005, struct.pack(">I", self.silent_cycles))
        self.vital.narrow[5] = epoch
        self.apply_writes()
        self.enter(moves, epoch)
        calls, self.calls = self.calls, []
        for request, name, given in calls:
            self.verify(request, 3)
            self.call(name, given)
            self.verify(request, 7)
        self.control()
        for end in self.links.values():
            status = FAULT if self.state == ERROR else DEGRADED if self.inhibited else VALID
            end.write(b"".join(leaf.pack("<" if end.order == 1 else ">") for leaf in self.provided(end.set)[2]), planned, status)
        for structure in self.structures.values():
            for data in structure.tick():
                self.report(3, 25, 0, data)
        self.account(planned, started, was_inhibited)

    def enter(self, moves, epoch):
        """An ordered state, at this boundary."""
        if not self.way:
            return
        state = self.way[0]
        if state == OPERATIONAL:
            self.entered_epoch, self.inhibited = epoch, 0 if moves and not self.permit.narrow[3] else 1
        self.arrive(state)
        self.advance()

    def account(self, planned, started, was_inhibited):
        wide, narrow, finished = self.vital.wide, self.vital.narrow, time.monotonic_ns()
        if self.configuration is None:
            return
        work, times = finished - started, self.times
        times["latency"], times["longest"] = max(times["latency"], started - planned), max(times["longest"], work)
        times["mean"] += 1e-3 * (work - times["mean"])
        narrow[18], narrow[19], narrow[20] = (min(int(number), 0xFFFFFFFF) for number in (times["latency"], times["longest"], times["mean"]))
        wide[7] += work > self.period_ns
        if self.inhibited and not was_inhibited:
            wide[11] = wide[5] + 1
        narrow[4] = self.inhibited
        wide[5] += 1
        self.next_ns = planned + self.period_ns
        if finished > self.next_ns:
            skipped = (finished - self.next_ns) // self.period_ns + 1
            wide[8] += skipped
            self.next_ns += skipped * self.period_ns

    # --- what it is for ----------------------------------------------------------------------------------------------------

    def call(self, name, given):
        if name == "SET_TEMPO":
            self.find("TEMPO").value = [given[0]]
            self.find("LABEL").value = list(given[1].ljust(12, b"\0"))
        else:
            self.event(6001, struct.pack(">I", self.find("PENDULUM.BEAT").value[0]))

    def control(self):
        """The pendulum swings in Safe-Operational and Operational."""
        if self.state not in (SAFE, OPERATIONAL):
            return
        beat, swing = self.find("PENDULUM.BEAT"), self.find("PENDULUM.POSITION")
        phase = 2 * math.pi * self.find("TEMPO").value[0] * beat.value[0] * self.period_ns / 1e9
        swing.value = [0.3 * math.sin(phase), 0.3 * math.cos(phase)]
        self.find("PENDULUM.TORQUE").value = [-0.1 * angle for angle in swing.value]
        self.find("PENDULUM.ACTIVE").value = [int(self.state == OPERATIONAL)]
        beat.value = [beat.value[0] + 1 & 0xFFFFFFFF]

    # --- both loops --------------------------------------------------------------------------------------------------------

    def run(self):
        poll = select.poll()
        poll.register(self.channel, select.POLLIN)
        while not self.finished:
            self.vital.wide[6] += 1
            now = time.monotonic_ns()
            if self.configuration is not None and now >= self.next_ns:
                self.cycle()
                now = time.monotonic_ns()
            due = min(10**7, self.next_ns - now) if self.configuration is not None else 10**7
            if not self.lost:
                poll.poll(max(0, due) / 1e6)
            else:
                time.sleep(max(0, due) / 1e9)
            self.receive()
            self.watch_supervisor()
            self.flush()


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    options, changes, judged = {}, [], None
    for word, text in zip(sys.argv[1::2], sys.argv[2::2]):
        if word in ("--descriptor", "--channel", "--vital", "--permit"):
            options[word] = text
        elif word == "--text":
            judged = f"/dev/fd/{text}"
        else:
            changes.append((word, text))
    if judged and "--descriptor" in options:
        options["--descriptor"] = judged    # what the supervisor has judged, whatever the file says by now
    if len(options) < 4:
        say("the supervisor starts it: --descriptor FILE --channel FD --vital FD --permit FD")
        return 2
    if platform.machine() not in ("x86_64", "AMD64"):
        say("its words need a processor that keeps the order of stores (docs/interfaces/memory.md)")
        return 3
    try:
        metronome = Metronome(options, changes)
    except (ValueError, OSError, KeyError, StopIteration, SyntaxError) as problem:
        say(problem)
        return 3
    metronome.run()
    return 0


if __name__ == "__main__":
    sys.exit(main())
