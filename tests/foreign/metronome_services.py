# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The services of metronome.py: what it hears, what it says, and whether a request is refused. Written from docs/interfaces/packets.md alone;
Python's standard library only."""
import binascii
import collections
import math
import os
import select
import socket
import struct
import sys
import time

from metronome_parts import FORMS, STATES, Producer, Reader, Value, is_utf8

OFFLINE, PRE, SAFE, OPERATIONAL, ERROR, POST = 0, 3, 4, 5, 6, 7
CYCLIC = PRE, SAFE, OPERATIONAL, ERROR
STOPPING = 3
UNKNOWN, NOT_ACCEPTABLE, NOT_NOW, BUSY = 0x0101, 0x0105, 0x0107, 0x0108


def say(words):
    print(f"{sys.argv[0]}: {words}", file=sys.stderr, flush=True)


class Refusal(Exception):
    """Ends a telecommand: subtype of its report, code, data."""

    def __init__(self, subtype, code, data=b""):
        super().__init__()
        self.subtype, self.code, self.data = subtype, code, data


def bad(code, index, identifier):
    return Refusal(4, code, struct.pack(">BI", index, identifier))


Request = collections.namedtuple("Request", "id source ack")


class Services:
    """Of the subsystem that has them: its state, parameters, structures, links and calls are its own."""

    # --- what it says ------------------------------------------------------------------------------------------------------

    def put(self, octets):
        self.waiting.append(octets)
        self.flush()

    def flush(self):
        while self.waiting:
            try:
                self.channel.send(self.waiting[0], socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
            except BlockingIOError:
                return
            except OSError:
                self.waiting.clear()
                return
            self.waiting.popleft()

    def count(self, destination, service, subtype):
        """Counts of the next report, from the block in the page and written on there."""
        block = self.vital.mapping
        used, sequence = struct.unpack_from("=IH", block, 1632)
        struct.pack_into("=H", block, 1636, sequence + 1 & 0x3FFF)
        for i in range(used):
            at = 1640 + 8 * i
            if struct.unpack_from("=HBB", block, at) == (destination, service, subtype):
                (number,) = struct.unpack_from("=H", block, at + 4)
                struct.pack_into("=H", block, at + 4, number + 1 & 0xFFFF)
                return sequence, number
        if used < 64:
            struct.pack_into("=HBBHH", block, 1640 + 8 * used, destination, service, subtype, 1, 0)
            struct.pack_into("=I", block, 1632, used + 1)
        return sequence, 0

    def report(self, service, subtype, destination, data):
        if (service, subtype) == (3, 25) and len(self.waiting) > 512:
            return
        sequence, number = self.count(destination, service, subtype)
        now = time.monotonic_ns() + self.epoch_ns
        stamp = struct.pack(">I", now // 10**9) + (now % 10**9 * (1 << 24) // 10**9).to_bytes(3, "big")
        body = struct.pack(">HHHBBBHH", 0x0800 | self.apid, 0xC000 | sequence, len(data) + 15, 0x20, service, subtype, number, destination) + stamp + data
        self.put(struct.pack(">BBHI", 1, 1, 0, 0) + body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF)))

    def verify(self, request, subtype, data=b""):
        flag = {1: 1, 3: 2, 7: 8}.get(subtype)
        if flag is None or request.ack & flag:
            self.report(1, subtype, request.source, request.id + data)

    def fail(self, request, subtype, code, data=b""):
        self.verify(request, subtype, struct.pack(">H", code) + data)

    def event(self, number, data=b""):
        reported = number not in self.disabled
        self.put(struct.pack(">BBHIBBH", 3, 1, 0, 0, self.events[number], reported, number) + data)
        if reported:
            self.report(5, self.events[number], 0, struct.pack(">H", number) + data)

    # --- what it hears -----------------------------------------------------------------------------------------------------

    def receive(self):
        for _ in range(64):
            if len(self.waiting) >= 512 or self.lost:
                return
            try:
                octets, ancillary, flags, _ = self.channel.recvmsg(8 + 4096, socket.CMSG_SPACE(4 * 16), socket.MSG_CMSG_CLOEXEC)
            except BlockingIOError:
                return
            except OSError:
                self.lost = True
                return
            given = [number for level, kind, data in ancillary if (level, kind) == (socket.SOL_SOCKET, socket.SCM_RIGHTS)
                     for (number,) in struct.iter_unpack("i", data[:len(data) // 4 * 4])]
            try:
                if not octets and self.hung_up():
                    self.lost = True
                    return
                if len(octets) >= 8 and octets[1] != 1 and not self.told_version:
                    self.told_version = True
                    say(f"the supervisor's control channel is of version {octets[1]}, this program's of version 1")
                if len(octets) == 8 and octets[:2] == b"\x04\x01" and len(given) == 1 and self.another_permit_page(given[0]):
                    self.put(struct.pack(">BBHI", 4, 1, 0, 0))
                if len(octets) < 8 or octets[1] != 1 or octets[0] != 1 or flags & (socket.MSG_TRUNC | socket.MSG_CTRUNC) or len(given) > 1:
                    continue
                self.telecommand(octets[8:], struct.unpack_from(">I", octets, 4)[0], given[0] if given else None)
            finally:
                for number in given:
                    os.close(number)

    def hung_up(self):
        poll = select.poll()
        poll.register(self.channel, select.POLLRDHUP)
        return bool(poll.poll(0))

    def telecommand(self, packet, mode_epoch, memory):
        if len(packet) < 6:
            return
        identification, sequence, length = struct.unpack_from(">HHH", packet)
        if identification >> 13 or not identification & 0x1000 or identification & 0x7FF == 0x7FF:
            return
        request = Request(packet[:4], 0, 0)
        try:
            if not 13 <= len(packet) <= 4096 or length != len(packet) - 7:
                raise Refusal(2, 2, struct.pack(">H", length))
            for fine, code in ((identification & 0x0800, 3), (sequence >> 14 == 3, 12), (binascii.crc_hqx(packet, 0xFFFF) == 0, 5), (packet[6] >> 4 == 2, 4)):
                if not fine:
                    raise Refusal(2, code)
            request = Request(packet[:4], struct.unpack_from(">H", packet, 9)[0], packet[6] & 15)
            if identification & 0x7FF != self.apid:
                raise Refusal(10, 1)
            if mode_epoch not in (0, self.permit.narrow[6]):
                raise Refusal(2, 13)
            service, subtype, data = packet[7], packet[8], packet[11:-2]
            handler = {3: self.housekeeping, 5: self.event_service, 8: self.function, 17: self.test, 20: self.parameter, 128: self.link}.get(service)
            if handler is None:
                raise Refusal(2, 6, bytes([service]))
            if service == 3 and self.configuration is None:
                raise Refusal(2, 10, bytes([self.state]))
            if service == 128:
                handler(request, subtype, data, memory)
            else:
                handler(request, subtype, data)
        except Refusal as refusal:
            self.fail(request, refusal.subtype, refusal.code, refusal.data)

    # --- services ----------------------------------------------------------------------------------------------------------

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

    # --- links -------------------------------------------------------------------------------------------------------------

    def provided(self, name):
        """(kinds, byte orders, values) of a set that is provided now."""
        if self.configuration is None or self.state not in CYCLIC:
            return None
        element = next((each for each in self.configuration.iter("Provides") if each.get("name") == name), None)
        if element is None:
            return None
        kinds = [{"latest": 1, "queued": 2, "loaned": 3}[word] for word in element.get("kind", "latest").split()]
        orders = [{"little": 1, "big": 2, "native": 1}[word] for word in element.get("byte_order", "native").split()]
        return kinds, orders, [leaf for ref in element.findall("ParamRef") for leaf in self.find(ref.get("name")).leaves()]

    def refuse_link(self, request, link, item, words):
        words = words.encode()[:255]
        self.report(128, 131, request.source, bytes([link, item, len(words)]) + words)
        raise Refusal(4, NOT_NOW, b"\0")

    def link(self, request, subtype, data, memory):
        if subtype not in (1, 2, 3, 4):
            raise Refusal(2, 7, bytes([128, subtype]))
        reader = Reader(data)
        try:
            asked = reader.link_request(subtype)
        except (struct.error, ValueError, IndexError) as problem:
            raise Refusal(2, 8) from problem
        self.verify(request, 1)
        link = asked["link"]
        if subtype == 1:
            self.refuse_link(request, link, 4, f"no configuration in force requires a set '{asked['set']}'")
        elif subtype == 4:
            if link not in self.links:
                raise bad(UNKNOWN, 0, link)
            self.let_go(link)
            self.verify(request, 3)
            self.verify(request, 7)
        else:
            set_ = self.provided(asked["set"])
            if set_ is None:
                self.refuse_link(request, link, 4, f"no configuration in force provides a set '{asked['set']}'")
            if subtype == 2:
                told = bytes([link]) + self.agree(request, link, set_, asked["offer"])
                self.verify(request, 3)
                self.report(128, 130, request.source, told)
            else:
                self.attach(request, asked, set_, memory)
                self.verify(request, 3)
                self.report(128, 132, request.source, bytes([link, 1]) + bytes(9))  # it stands in memory: no address, no key
            self.verify(request, 7)

    def agree(self, request, link, set_, offer):
        kinds, orders, values = set_
        if 1 not in offer["methods"]:
            self.refuse_link(request, link, 0, "method: producer shared_memory")
        kind = next((each for each in kinds if each in offer["kinds"]), None)
        if kind is None:
            self.refuse_link(request, link, 2, f"kind: consumer {offer['kinds']}, producer {kinds}")
        order = next((each for each in orders if each in offer["orders"]), None)
        if order is None:
            self.refuse_link(request, link, 1, f"byte order: consumer {offer['orders']}, producer {orders}")
        if offer["wakes"]:
            self.refuse_link(request, link, 6, "wake: this producer wakes nobody")
        if self.period_ns % offer["period"] and offer["period"] % self.period_ns:
            self.refuse_link(request, link, 3, f"rate: consumer {offer['period']} ns, producer {self.period_ns} ns")
        own = [(value.name, value.type, value.count) for value in values]
        for field in offer["fields"]:
            if field not in own:
                self.refuse_link(request, link, 4, f"field {field[0]}")
        depth = offer["depth"] if kind == 2 else 0
        if depth * sum(value.octets for value in values) > 64 << 20:
            self.refuse_link(request, link, 5, "depth")
        fields = bytes([len(own)]) + b"".join(bytes([len(name)]) + name.encode() + struct.pack(">BI", type_, count) for name, type_, count in own)
        return struct.pack(">BBBHBqq", 1, order, kind, depth, 0, self.period_ns, offer["period"]) + fields

    def attach(self, request, asked, set_, memory):
        link, agreement = asked["link"], asked["agreement"]
        if asked["role"] != 1:
            self.refuse_link(request, link, 4, "nothing is required")
        if memory is None:
            self.refuse_link(request, link, 0, "no memory beside the attach request")
        if link in self.links and asked["epoch"] <= self.links[link].epoch:
            self.refuse_link(request, link, 0, "the link is attached already")
        if agreement["fields"] != [(value.name, value.type, value.count) for value in set_[2]] or agreement["method"] != 1 or agreement["kind"] == 3 or agreement["wakes"]:
            self.refuse_link(request, link, 0, "the agreement is not of this set")
        try:
            made = Producer(link, asked["set"], asked["epoch"], agreement, memory)
        except (ValueError, OSError) as problem:
            self.refuse_link(request, link, 0, str(problem))
        if link in self.links:
            self.links.pop(link).words.close()
        self.links[link] = made

    def let_go(self, link):
        end = self.links.pop(link)
        end.tell(STOPPING)
        end.words.close()
        self.report(128, 133, 0, bytes([link, 1]))
