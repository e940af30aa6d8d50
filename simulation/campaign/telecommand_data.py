# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Draws the application data of a telecommand: values of every type, mostly those of an honest sender."""
import struct

import retrieval
from descriptors import OFFLINE, OPERATIONAL, PRE, TYPES

RETRIEVAL = "129.11"    # what was said before comes down again (docs/adr/0140); the supervisor's alone to answer
# Of every subsystem, beside those of its descriptor: states, failures, lost devices and stale sets.
FRAMEWORK_EVENTS = [*range(0xF000, 0xF006), *range(0xF100, 0xF103), *range(0xF200, 0xF204)]


class TelecommandData:
    def __init__(self, random):
        self.random = random

    def argument(self, argument):
        """All values of one argument, as they stand on the wire."""
        return self.words(argument) if argument.type == "TEXT" else b"".join(self.value(argument) for _ in range(argument.count))

    def words(self, argument):
        """Mostly a text, of any length up to the declared one, then what is none."""
        r, most = self.random, argument.octets
        text = "".join(r.choice("ab \u20ac\U0001f680") for _ in range(r.choice([0, 1, most // 2, most]))).encode()[:most].decode(errors="ignore").encode()
        draw = r.random()
        if draw > 0.8:
            text = r.choice([b"x" * most, b"x" * (most + 1), text[:-1] + b"\xff", b"\0" + text[1:], b"\xed\xa0\x80", b"\xe2\x82"])
        octets = len(text) if draw < 0.97 else r.choice([0, len(text) + 1, 65535])
        return struct.pack(">H", octets) + text

    def stored_words(self, field):
        """A text as a parameter has it: as many octets as are declared, zeros behind the words. Mostly; then words behind the zeros, and what is no text."""
        return self.random.choice([b"a", b"a" * field.octets, "\u20ac".encode(), b"", b"", b"\0a", b"\xff"])[:field.octets].ljust(field.octets, b"\0")

    def value(self, argument):
        """Mostly in range, then its corners, just beside them, and what no honest sender sends."""
        if argument.values is not None:
            honest = self.random.random() < 0.8
            return pack(argument.type, self.random.choice(sorted(argument.values)) if honest else self.random.randrange(-3, 260))
        if argument.type in ("UINT64", "INT64"):
            return self.whole(argument)
        low = argument.minimum if argument.minimum is not None else {"D": -1e6, "F": -1e6}.get(argument.type[:1], 0)
        high = argument.maximum if argument.maximum is not None else {"D": 1e6, "F": 1e6}.get(argument.type[:1], 255)
        draw = self.random.random()
        if draw < 0.55:
            value = self.random.uniform(low, high)
        elif draw < 0.8:
            value = self.random.choice([low, high])
        elif draw < 0.9:
            value = self.random.choice([low - 1, high + 1, low - 1e-9, high + 1e-9, 0, -0.0])
        else:
            value = self.random.choice([float("nan"), float("inf"), -float("inf"), 1e300, 255, 1e-300])
        return pack(argument.type, value)

    def whole(self, argument):
        """Of 64 bits, where a double would lose digits."""
        r = self.random
        ends = (0, 2**64 - 1) if argument.type == "UINT64" else (-2**63, 2**63 - 1)
        low, high = (int(end if given is None else given) for given, end in zip((argument.minimum, argument.maximum), ends))
        near = r.choice([low, high, low - 1, high + 1, 2**53 + 1, -2**53 - 1, low + 1, high - 1])
        value = r.randint(low, high) if r.random() < 0.5 else min(max(near, ends[0]), ends[1])
        return struct.pack(">Q", value % 2**64)

    def call(self, name, arguments):
        data = name.encode()[:16].ljust(16, b"\0")
        number = len(arguments)
        if self.random.random() < 0.04:
            number = self.random.randrange(0, 9)
        data += bytes([number])
        for place, argument in enumerate(arguments[:number], 1):
            data += bytes([place if self.random.random() > 0.02 else self.random.randrange(256)]) + self.argument(argument)
        return data[:-1] if self.random.random() < 0.02 else data

    def parameter_write(self, subsystem):
        chosen = self.random.sample(subsystem.parameters, min(len(subsystem.parameters), self.random.choice([1, 1, 1, 2, 3])))
        data = bytes([len(chosen)])
        for parameter in chosen:
            data += struct.pack(">I", parameter.wire_id if self.random.random() > 0.03 else self.random.getrandbits(32))
            for field in parameter.fields:
                data += self.stored_words(field) if field.type == "TEXT" else b"".join(self.value(field) for _ in range(field.count))
        return data

    def of(self, kind, subsystem):
        """(service, subtype, application data)"""
        r = self.random
        structures = [h for c in subsystem.configurations.values() for h in c.housekeeping] or [1]
        ids = lambda values, width: bytes([len(values)]) + b"".join(v.to_bytes(width, "big") for v in values)
        some_ids = lambda: r.sample([p.wire_id for p in subsystem.parameters], min(len(subsystem.parameters), r.randrange(1, 5)))
        if "." in kind:
            service, subtype = map(int, kind.split("."))
            if r.random() < 0.1:
                return service, subtype, r.randbytes(r.randrange(0, 40))
            if (service, subtype) in ((3, 1), (3, 29)):
                return service, subtype, (struct.pack(">HI", r.choice([9000, 9001, structures[0]]), r.choice([1, 2, 100, 2000]))
                                          + ids(some_ids(), 4) + bytes([0]))
            if service == 3 and subtype == 31:
                return service, subtype, bytes([1]) + struct.pack(">HI", r.choice(structures), r.choice([1, 10, 1000]))
            if service == 3:
                return service, subtype, ids([r.choice([*structures, 9000])], 2)
            if service == 5 and subtype != 7:
                return service, subtype, ids([r.choice([*subsystem.events, *FRAMEWORK_EVENTS])], 2)
            if (service, subtype) == (20, 1):
                return service, subtype, ids(some_ids(), 4)
            if (service, subtype) == (20, 3):
                return service, subtype, self.parameter_write(subsystem)
            if service == 128:
                return service, subtype, r.randbytes(r.choice([1, 4, 20]))
            if kind == RETRIEVAL:
                return service, subtype, retrieval.data(r)
            return service, subtype, b""
        if kind == "SET_STATE":
            return 8, 1, b"SET_STATE".ljust(16, b"\0") + bytes([1, 1, r.choice([*range(10), OPERATIONAL, OFFLINE, PRE, 255])])
        if kind == "CONFIGURE":
            return 8, 1, b"CONFIGURE".ljust(16, b"\0") + bytes([1, 1, r.choice([*subsystem.configurations, 0, 99])])
        if kind == "unknown":
            return 8, 1, r.choice([b"NOBODY_HAS_IT".ljust(16, b"\0") + b"\0", r.randbytes(17), b"HOL"])
        return 8, 1, self.call(kind, subsystem.functions[kind].arguments)


def pack(kind, value):
    octets = 1 if kind == "BOOL" else TYPES[kind][1] if kind in TYPES and kind != "STRUCT" else 8
    if kind == "DOUBLE":
        return struct.pack(">d", value)
    if kind == "FLOAT":
        try:
            return struct.pack(">f", value)
        except OverflowError:
            return struct.pack(">f", float("inf"))
    if value != value or abs(value) == float("inf"):
        value = (1 << 8 * octets) - 1
    return (int(max(-2.0**63, min(value, 2.0**63))) & ((1 << 8 * octets) - 1)).to_bytes(octets, "big")
