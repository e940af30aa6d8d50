# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The services of metronome.py, and whether a request is refused. Written from docs/interfaces/packets.md alone; Python's standard library
only."""
import math
import struct

from metronome_links import OFFLINE, Links
from metronome_packets import NOT_ACCEPTABLE, NOT_NOW, UNKNOWN, Packets, Refusal, bad
from metronome_parts import FORMS, STATES, Value, is_utf8


class Services(Packets, Links):
    """Of the subsystem that has them: its state, parameters, structures and calls are its own."""

    def instructions(self, request, data, form, check, execute, finish=lambda good: None):
        """N u8, N times `form`: what several instructions have in common."""
        each = struct.calcsize(">" + form)
        if not data or len(data) != 1 + data[0] * each:
            raise Refusal(2, 8)
        if data[0] == 0:
            raise Refusal(2, 9, b"\0\0")
        self.verify(request, 1)
        rows, good = [row if len(row) > 1 else row[0] for row in struct.iter_unpack(">" + form, data[1:])], []
        for i, row in enumerate(rows):
            try:
                check(i, row)
                good.append(row)
            except Refusal as refusal:
                self.fail(request, 4, refusal.code, refusal.data)
        if len(good) == len(rows):
            self.verify(request, 3)
        for row in good:
            execute(row)
        if good:
            finish(good)
        if len(good) == len(rows):
            self.verify(request, 7)
        elif good:
            self.fail(request, 8, 0x0201, bytes([len(good), len(rows) - len(good)]))

    def test(self, request, subtype, data):
        if subtype != 1:
            raise Refusal(2, 7, bytes([17, subtype]))
        if data:
            raise Refusal(2, 8)
        self.verify(request, 1)
        self.verify(request, 3)
        self.report(17, 2, request.source, b"")
        self.verify(request, 7)

    def event_service(self, request, subtype, data):
        if subtype == 7:
            if data:
                raise Refusal(2, 8)
            self.verify(request, 1)
            self.verify(request, 3)
            off = sorted(self.disabled)
            self.report(5, 8, request.source, struct.pack(f">B{len(off)}H", len(off), *off))
            self.verify(request, 7)
            return
        if subtype not in (5, 6):
            raise Refusal(2, 7, bytes([5, subtype]))

        def check(i, number):
            if number not in self.events:
                raise bad(UNKNOWN, i, number)
        self.instructions(request, data, "H", check, self.disabled.discard if subtype == 5 else self.disabled.add)

    def by_wire(self, wire):
        """(parameter, the value itself); nothing in Offline."""
        for parameter in self.parameters if self.state != OFFLINE else ():
            for value in (parameter, *parameter.members):
                if wire == self.apid << 16 | value.type << 8 | value.id:
                    return parameter, value
        return None

    def wire(self, value):
        return self.apid << 16 | value.type << 8 | value.id

    def parameter(self, request, subtype, data):
        if subtype == 1:
            room = [4096 - 22 - 1]

            def check(i, wire):
                found = self.by_wire(wire)
                if found is None:
                    raise bad(UNKNOWN, i, wire)
                if found[1].octets + 4 > room[0]:
                    raise Refusal(4, 0x0104, bytes([i]))
                room[0] -= found[1].octets + 4
            tell = lambda good: self.report(20, 2, request.source, bytes([len(good)]) + b"".join(
                struct.pack(">I", wire) + self.by_wire(wire)[1].pack() for wire in good))
            self.instructions(request, data, "I", check, lambda wire: None, tell)
        elif subtype == 3:
            self.set_parameters(request, data)
        else:
            raise Refusal(2, 7, bytes([20, subtype]))

    def set_parameters(self, request, data):
        if not data:
            raise Refusal(2, 8)
        if data == b"\0":
            raise Refusal(2, 9, b"\0\0")
        at, writes = 1, []
        for i in range(data[0]):
            if at + 4 > len(data):
                raise Refusal(2, 8)
            (wire,) = struct.unpack_from(">I", data, at)
            found = self.by_wire(wire)
            if found is None:
                self.verify(request, 1)
                raise bad(UNKNOWN, i, wire)
            writes.append((wire, *found, data[at + 4:at + 4 + found[1].octets]))
            at += 4 + found[1].octets
        if at != len(data):
            raise Refusal(2, 8)
        self.verify(request, 1)
        problems = [(i, wire, NOT_NOW if self.state not in owner.writable else NOT_ACCEPTABLE) for i, (wire, owner, value, octets) in enumerate(writes)
                    if self.state not in owner.writable or not value.permits(octets)]
        for i, wire, code in problems:
            self.fail(request, 4, code, struct.pack(">BI", i, wire))
        if problems:
            return
        self.writes += [(value, octets) for _, _, value, octets in writes]
        if self.configuration is None:
            self.apply_writes()
        self.verify(request, 3)
        self.verify(request, 7)

    def apply_writes(self):
        for value, octets in self.writes:
            value.unpack(octets)
        self.writes = []

    def housekeeping(self, request, subtype, data):
        known = self.structures

        def check(i, row):
            number = row[0] if isinstance(row, tuple) else row
            if number not in known:
                raise bad(UNKNOWN, i, number)
            if isinstance(row, tuple) and not known[number].allows(row[1]):
                raise bad(NOT_ACCEPTABLE, i, number)

        def switch(number):
            each, on = known[number], subtype == 5
            each.collections[0] = (each.collections[0] or each.begin()) if on else None
            each.on = on

        def more(number):
            known[number].once_more += 1

        def set_interval(row):
            known[row[0]].interval = row[1]

        def layout(number):
            each = known[number]
            ids = lambda values: struct.pack(f">B{len(values)}I", len(values), *map(self.wire, values))
            self.report(3, 10, request.source, struct.pack(">HBI", each.id, each.on, each.interval) + ids(each.once) + bytes([len(each.sets)])
                        + b"".join(struct.pack(">H", count) + ids(values) for count, values in each.sets))

        def properties(good):
            self.report(3, 35, request.source, bytes([len(good)]) + b"".join(
                struct.pack(">HBI", number, known[number].on, known[number].interval) for number in good))
        if subtype in (5, 6, 9, 27):
            self.instructions(request, data, "H", check, {5: switch, 6: switch, 9: layout, 27: more}[subtype])
        elif subtype == 31:
            self.instructions(request, data, "HI", check, set_interval)
        elif subtype == 33:
            self.instructions(request, data, "H", check, lambda number: None, properties)
        else:
            raise Refusal(2, 7, bytes([3, subtype]))

    def function(self, request, subtype, data):
        if subtype != 1:
            raise Refusal(2, 7, bytes([8, subtype]))
        if len(data) < 17:
            raise Refusal(2, 8)
        padded = data[:16]
        name = padded.rstrip(b"\0").decode("ascii", "replace")
        built_in = {"SET_STATE": ("STATE", 9), "CONFIGURE": ("CONFIGURATION", 255)}.get(name)
        element = self.functions.get(name)
        if not name or (built_in is None and element is None):
            self.verify(request, 1)
            raise Refusal(4, UNKNOWN, b"\0" + padded)
        if built_in:
            given = self.arguments(request, data[16:], [[built_in[0], 1, 1, 0, built_in[1], None]])
            self.verify(request, 1)
            return self.set_state(request, given[0]) if name == "SET_STATE" else self.configure(request, given[0])
        declared = []
        for each in element.iter("Argument"):
            value = Value(each, self.find(each.get("of")) if each.get("of") else None)
            declared.append([value.name, value.type, value.count, value.minimum, value.maximum, value.default])
        given = self.arguments(request, data[16:], declared)
        self.verify(request, 1)
        if STATES[self.state] not in element.get("states", "Operational").split() or self.configuration is None or self.way:
            raise Refusal(4, 10, bytes([self.state]))
        self.calls.append((request, name, given))
        return None

    def arguments(self, request, data, declared):
        """Values in declared order. A wrong length comes before wrong values, an unknown argument before both."""
        at, found, first = 1, {}, None
        for index in range(data[0]):
            if at >= len(data):
                raise Refusal(2, 8)
            number, at = data[at], at + 1
            if not 1 <= number <= len(declared):
                self.verify(request, 1)
                raise first or bad(NOT_ACCEPTABLE, index, number)
            _, kind, count, minimum, maximum, _ = declared[number - 1]
            try:
                if kind == 34:
                    (length,) = struct.unpack_from(">H", data, at)
                    value, at = data[at + 2:at + 2 + length], at + 2 + length
                    good = length <= count and b"\0" not in value and is_utf8(value)
                else:
                    values = struct.unpack_from(f">{count}{FORMS[kind]}", data, at)
                    value, at = values if count > 1 else values[0], at + struct.calcsize(f">{count}{FORMS[kind]}")
                    good = all(math.isfinite(v) and (minimum is None or v >= minimum) and (maximum is None or v <= maximum)
                               and (kind != 33 or v <= 1) for v in values)
            except struct.error as problem:
                raise Refusal(2, 8) from problem
            if at > len(data):
                raise Refusal(2, 8)
            if (not good or number in found) and first is None:
                first = bad(NOT_ACCEPTABLE, index, number)
            found[number] = value
        if at != len(data):
            raise Refusal(2, 8)
        for number, (_, kind, _, _, _, default) in enumerate(declared, 1):
            if number not in found and default is None and first is None:
                first = bad(NOT_ACCEPTABLE, data[0], number)
            elif number not in found and default is not None:
                found[number] = default.encode() if kind == 34 else float(default) if kind in (9, 10) else int(default, 0)
        if first:
            self.verify(request, 1)
            raise first
        return [found[number] for number in sorted(found)]
