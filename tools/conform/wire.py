# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Octets of docs/interfaces/packets.md: packets, values, the link handshake. A codec of its own, so that no mistake of the craft's is
shared by its judge. Python's standard library only."""
import binascii
import dataclasses
import struct
import time

UINT8, UINT16, UINT32, STRUCT, BOOL, TEXT = 1, 3, 5, 32, 33, 34
TYPES = {"UINT8": 1, "INT8": 2, "UINT16": 3, "INT16": 4, "UINT32": 5, "INT32": 6, "UINT64": 7, "INT64": 8, "FLOAT": 9,
         "DOUBLE": 10, "STRUCT": 32, "BOOL": 33, "TEXT": 34}
FORMS = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 7: "Q", 8: "q", 9: "f", 10: "d", 33: "B"}
ACCEPTANCE, START, PROGRESS, COMPLETION, ALL = 1, 2, 4, 8, 15
EPOCH_S = 378_691_200 + 37
SHIFT_S = 1000                # of the on-board time that the environment gives, so that a program is seen to look there


def crc(octets):
    return binascii.crc_hqx(octets, 0xFFFF)


def octets_of(kind):
    return struct.calcsize("=" + FORMS[kind])


def lowest(kind):
    return 0 if kind % 2 or kind == BOOL else -(1 << 8 * octets_of(kind) - 1)


def highest(kind):
    if kind == BOOL:
        return 1
    bits = 8 * octets_of(kind)
    return (1 << bits) - 1 if kind % 2 else (1 << bits - 1) - 1


def put(kind, values, order=">"):
    return struct.pack(f"{order}{len(values)}{FORMS[kind]}", *values)


def telecommand(apid, count, service, subtype, data=b"", ack=ALL, source=1):
    body = struct.pack(">HHHBBBH", 0x1800 | apid, 0xC000 | count & 0x3FFF, len(data) + 6, 0x20 | ack, service, subtype,
                       source) + data
    return body + struct.pack(">H", crc(body))


def with_crc(body):
    return body + struct.pack(">H", crc(body))


def call(name, arguments=()):
    """Data of TC[8,1]; arguments: (id, octets)."""
    return (name.encode().ljust(16, b"\0") + bytes([len(arguments)])
            + b"".join(bytes([number]) + octets for number, octets in arguments))


@dataclasses.dataclass
class Report:
    octets: bytes
    at: float                                     # time.monotonic() when it was read
    after_event: int = 0                          # event messages that came before it

    @classmethod
    def of(cls, octets, at):
        """The report, or the words why it is none."""
        if len(octets) < 22:
            return f"a packet of {len(octets)} octets"
        identification, sequence, length = struct.unpack_from(">HHH", octets)
        if identification >> 11 != 1:
            return f"identification 0x{identification:04X}: not version 0, telemetry, with secondary header"
        if sequence >> 14 != 3:
            return f"sequence flags {sequence >> 14}"
        if length != len(octets) - 7:
            return f"length field {length} in {len(octets)} octets"
        if crc(octets) != 0:
            return "error control of a report"
        if octets[6] != 0x20:
            return f"PUS version and time status 0x{octets[6]:02X}"
        return cls(octets, at)

    @property
    def apid(self):
        return struct.unpack_from(">H", self.octets)[0] & 0x7FF

    @property
    def count(self):
        return struct.unpack_from(">H", self.octets, 2)[0] & 0x3FFF

    @property
    def kind(self):
        return self.octets[7], self.octets[8]

    @property
    def message_count(self):
        return struct.unpack_from(">H", self.octets, 9)[0]

    @property
    def destination(self):
        return struct.unpack_from(">H", self.octets, 11)[0]

    @property
    def time_s(self):
        """On-board time in the calendar of this computer."""
        seconds, fraction = struct.unpack_from(">IB", self.octets, 13)
        return seconds + (fraction << 16 | struct.unpack_from(">H", self.octets, 18)[0]) / (1 << 24) - EPOCH_S - SHIFT_S

    @property
    def data(self):
        return self.octets[20:-2]

    def words(self):
        service, subtype = self.kind
        if service == 1 and len(self.data) >= 4:
            code = f" code 0x{struct.unpack_from('>H', self.data, 4)[0]:04X}" if len(self.data) >= 6 else ""
            return f"TM[1,{subtype}]{code} {self.data[6:].hex()}".rstrip()
        return f"TM[{service},{subtype}] {self.data[:24].hex()}".rstrip()


# --- the handshake of links ----------------------------------------------------------------------------------------------

def string(text):
    return bytes([len(text)]) + text.encode()


@dataclasses.dataclass(frozen=True)
class LinkField:
    name: str
    type: int
    count: int = 1

    def octets(self):
        return string(self.name) + struct.pack(">BI", self.type, self.count)


def fields_octets(fields):
    return bytes([len(fields)]) + b"".join(field.octets() for field in fields)


@dataclasses.dataclass
class Offer:
    set: str
    period_ns: int
    methods: list
    orders: list
    kinds: list
    depth: int
    fields: list
    wakes: int = 0

    def octets(self):
        lists = b"".join(bytes([len(each), *each]) for each in (self.methods, self.orders, self.kinds))
        return string(self.set) + struct.pack(">q", self.period_ns) + lists + struct.pack(">HB", self.depth, self.wakes) + fields_octets(self.fields)


@dataclasses.dataclass
class Agreement:
    method: int
    order: int
    kind: int
    depth: int
    producer_ns: int
    consumer_ns: int
    fields: list
    wakes: int = 0

    def octets(self):
        return struct.pack(">BBBHBqq", self.method, self.order, self.kind, self.depth, self.wakes, self.producer_ns,
                           self.consumer_ns) + fields_octets(self.fields)

    def payload(self):
        end, most = 0, 1
        for field in self.fields:
            each = octets_of(field.type)
            if self.kind == 3:
                end, most = up(end, each), max(most, each)
            end += each * field.count
        return up(end, most) if self.kind == 3 else end

    def places(self):
        """{field name: (offset, struct format)} in a sample."""
        at, found = 0, {}
        for field in self.fields:
            each = octets_of(field.type)
            at = up(at, each) if self.kind == 3 else at
            found[field.name] = at, f"{'<' if self.order == 1 else '>'}{field.count}{FORMS[field.type]}"
            at += each * field.count
        return found

    def layout_hash(self):
        value = 0xCBF29CE484222325
        for octet in fields_octets(self.fields) + bytes([self.order, self.kind]):
            value = (value ^ octet) * 0x100000001B3 & (1 << 64) - 1
        return value


def up(number, multiple):
    return (number + multiple - 1) // multiple * multiple


class Reader:
    """Reads what was written in the forms above; raises struct.error, IndexError or ValueError where it is none."""

    def __init__(self, octets):
        self.octets, self.at = octets, 0

    def take(self, form):
        values = struct.unpack_from(">" + form, self.octets, self.at)
        self.at += struct.calcsize(">" + form)
        return values if len(values) > 1 else values[0]

    def string(self):
        length = self.take("B")
        if self.at + length > len(self.octets):
            raise ValueError("a string beyond the end")
        self.at += length
        return self.octets[self.at - length:self.at].decode("ascii")

    def numbers(self):
        count = self.take("B")
        return [self.take("B") for _ in range(count)]

    def fields(self):
        return [LinkField(self.string(), *self.take("BI")) for _ in range(self.take("B"))]

    def offer(self):
        head = self.string(), self.take("q"), self.numbers(), self.numbers(), self.numbers()
        depth, wakes = self.take("HB")
        return Offer(*head, depth, self.fields(), wakes)

    def agreement(self):
        method, order, kind, depth, wakes, producer_ns, consumer_ns = self.take("BBBHBqq")
        return Agreement(method, order, kind, depth, producer_ns, consumer_ns, self.fields(), wakes)

    def end(self):
        if self.at != len(self.octets):
            raise ValueError(f"{len(self.octets) - self.at} octets too many")


def permission_word(epoch):
    everything = (1 << 64) - 1
    word = epoch + 0x9E3779B97F4A7C15 & everything
    word = (word ^ word >> 30) * 0xBF58476D1CE4E5B9 & everything
    word = (word ^ word >> 27) * 0x94D049BB133111EB & everything
    return word ^ word >> 31


def calendar_s():
    return time.time()
