# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Whether a kill fell where it was aimed: told behind it, by when the client heard what, and by what lies in the pieces of the log. Times are
time.monotonic(), which is the log's clock, too; what the next supervisor notes is younger than the kill. judges_test.py has a miss for each."""
import math

import honest
import stored_log

HIT = ""


def first(subtypes, reports):
    return min((at for subtype, at in reports if subtype in subtypes), default=math.inf)


def in_a_telecommand(reports, records, request, killed, gone_on):
    """TM[1,1] was heard before the kill, and no end, neither by the client before another supervisor was there nor by the log before the kill.
    `reports`: [(subtype, when the client heard it)]; `records`: those around the kill."""
    if first((1,), reports) > killed:
        return "TM[1,1] was not heard before the kill"
    if first(honest.ENDS, reports) < gone_on:
        return "its end came from who was killed"
    if any(record.at <= killed and record.packet[7:8] == b"\1" and record.packet[8] in honest.ENDS and record.packet[20:24] == request
           for record in records if record.kind == stored_log.TELEMETRY):
        return "its end stands in the log before the kill"
    return HIT


def in_a_switch(reports, pieces, killed):
    """The supervisor had begun SET_DATABASE when it was killed, and nothing of its log had come to the new strategy's piece.
    `pieces`: {new piece of that strategy: its records}; that none was there yet is as good, for the old one was being ended."""
    if first((1,), reports) > killed:
        return "the switch had not begun"
    if stored_before(pieces, killed):
        return "the log had gone on in the new strategy's piece"
    return HIT


def in_the_begin_of_a_piece(seen, pieces, killed):
    """The file of the new piece was seen in its folder before the kill, and no record had come into it: it was in its opening. Whether one that is
    there had reached the disk, or was on the way to it, cannot be told from outside: that is no hit."""
    if seen > killed:
        return "the piece had not begun"
    if stored_before(pieces, killed):
        return "the piece had taken records"
    return HIT


def stored_before(pieces, killed):
    return any(record.at <= killed and record.kind != stored_log.GAP for records in pieces.values() for record in records)


class Aim:
    """How long to wait for the moment of a kill: as long as the window was found to be."""

    def __init__(self, draw, longest_s):
        self.draw, self.longest_s = draw, longest_s

    def wait_s(self):
        return self.draw.uniform(0.0, self.longest_s)

    def learn(self, hit):
        self.longest_s = min(0.5, self.longest_s * 1.1) if hit else max(0.0002, self.longest_s / 2)


class Tally:
    """How many kills fell into each window, of how many that were aimed at it."""
    TRIES = 4

    def __init__(self, wanted):
        self.wanted = wanted
        self.hits, self.tries = ({name: 0 for name in wanted} for _ in range(2))
        self.misses = {name: {} for name in wanted}          # why -> how often

    def open(self):
        """Windows that want more hits and may be tried again, those that want most first."""
        tried = [name for name in self.wanted if self.hits[name] < self.wanted[name] and self.tries[name] < self.TRIES * self.wanted[name]]
        return sorted(tried, key=lambda name: self.hits[name] / self.wanted[name])

    def count(self, name, miss):
        self.tries[name] += 1
        if miss == HIT:
            self.hits[name] += 1
        else:
            self.misses[name][miss] = self.misses[name].get(miss, 0) + 1

    def missed(self):
        """Complaints: windows with fewer hits than are wanted."""
        return [f"{name}: {self.hits[name]} of {wanted} kills in {self.tries[name]} tries, {self.misses[name]}"
                for name, wanted in self.wanted.items() if self.hits[name] < wanted]

    def __str__(self):
        return ", ".join(f"{self.hits[name]} {name} ({self.tries[name]} tries)" for name in self.wanted)
