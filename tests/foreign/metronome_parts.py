# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Parts of metronome.py: values as its descriptor declares them, shared memory in words, the producer's end of a link, housekeeping structures,
the handshake's octets. Written from docs/interfaces alone; Python's standard library only."""
import fcntl
import mmap
import os
import struct

TYPES = {"UINT8": 1, "INT8": 2, "UINT16": 3, "INT16": 4, "UINT32": 5, "INT32": 6, "UINT64": 7, "INT64": 8, "FLOAT": 9, "DOUBLE": 10,
         "STRUCT": 32, "BOOL": 33, "TEXT": 34}
FORMS = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 7: "Q", 8: "q", 9: "f", 10: "d", 33: "B", 34: "B"}
STATES = ["Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational", "ErrorOperational", "PostOperational"]


class Value:
    """A parameter, member, argument or field as declared."""

    def __init__(self, element, base=None):
        get = lambda name, otherwise=None: element.get(name, otherwise)
        self.name, self.id = get("name"), int(get("id", 0))
        self.type = base.type if base else TYPES[get("type")]
        self.count = base.count if base else int(get("octets", 1) if self.type == 34 else get("count", 1))
        self.minimum = base.minimum if base else float(get("minimum")) if get("minimum") else None
        self.maximum = base.maximum if base else float(get("maximum")) if get("maximum") else None
        self.init, self.default = get("init"), get("default")
        self.writable = [STATES.index(word) for word in get("writable", "").split()]
        self.members = [Value(each) for each in element.findall("ParamRef")] if self.type == 32 else []
        self.octets = sum(m.octets for m in self.members) if self.members else struct.calcsize("=" + FORMS[self.type]) * self.count
        self.value = None

    def leaves(self):
        return self.members or [self]

    def parse(self, text):
        """Of `init`, `default`, `value`."""
        if self.type == 34:
            return list(text.encode().ljust(self.count, b"\0"))
        switch = {"on": 1, "off": 0, "true": 1, "false": 0}
        read = float if self.type in (9, 10) else lambda word: switch.get(word.lower()) if word.lower() in switch else int(word, 0)
        return [read(word) for word in text.split()]

    def reset(self):
        for leaf in self.leaves():
            leaf.value = leaf.parse(leaf.init) if leaf.init else [0] * leaf.count

    def pack(self, order=">"):
        return b"".join(struct.pack(f"{order}{leaf.count}{FORMS[leaf.type]}", *leaf.value) for leaf in self.leaves())

    def permits(self, octets):
        """Whether these octets are a value of it."""
        at = 0
        for leaf in self.leaves():
            values = struct.unpack_from(f">{leaf.count}{FORMS[leaf.type]}", octets, at)
            at += leaf.octets
            if leaf.type == 34:
                words = bytes(values).rstrip(b"\0")
                if b"\0" in words or not is_utf8(words):
                    return False
            elif any(v != v or (leaf.minimum is not None and v < leaf.minimum) or (leaf.maximum is not None and v > leaf.maximum)
                     or (leaf.type == 33 and v > 1) for v in values):
                return False
        return True

    def unpack(self, octets):
        at = 0
        for leaf in self.leaves():
            leaf.value = list(struct.unpack_from(f">{leaf.count}{FORMS[leaf.type]}", octets, at))
            at += leaf.octets


def is_utf8(octets):
    try:
        octets.decode()
        return True
    except UnicodeDecodeError:
        return False


class Words:
    """Memory in words, each written and read as a whole (docs/interfaces/memory.md)."""

    def __init__(self, descriptor, octets, readonly=False):
        self.mapping = mmap.mmap(descriptor, octets, prot=mmap.PROT_READ | (0 if readonly else mmap.PROT_WRITE))
        self.view = memoryview(self.mapping)
        self.narrow, self.wide = self.view.cast("I"), self.view.cast("Q")

    def close(self):
        for view in (self.narrow, self.wide, self.view):
            view.release()
        self.mapping.close()


def up(number, multiple):
    return (number + multiple - 1) // multiple * multiple


class Producer:
    """The producer's end of a link: of the newest value, or of every one."""

    def __init__(self, link, name, epoch, agreement, memory):
        self.link, self.set, self.epoch, self.kind, self.depth, self.order = link, name, epoch, agreement["kind"], agreement["depth"], agreement["order"]
        self.payload = agreement["payload"]
        self.slot = up(24 + self.payload, 64)
        size = up(96 + up(self.payload, 8), 64) if self.kind == 1 else 128 + (self.depth + 1) * self.slot
        if memory is None or os.fstat(memory).st_size != size:
            raise ValueError("size of shared memory")
        try:
            if fcntl.fcntl(memory, 1034) & 6 != 6:          # F_GET_SEALS: F_SEAL_SHRINK, F_SEAL_GROW
                raise ValueError("seals of shared memory")
        except OSError as problem:
            raise ValueError("shared memory cannot be sealed") from problem
        self.words = Words(memory, size)
        wide = self.words.wide
        magic, version = (0x4B4E494C52435348, 2) if self.kind == 1 else (0x5545555152435348, 1)
        wide[1], wide[2], wide[3], wide[4] = version << 32 | epoch, self.payload, agreement["hash"], agreement["producer_ns"]
        if self.kind == 2:
            wide[5] = self.depth
        wide[9] = 0xFFFFFFFF << 32
        wide[0] = magic
        fcntl.fcntl(memory, 1033, 16)                       # F_ADD_SEALS: F_SEAL_FUTURE_WRITE, then F_SEAL_SEAL
        fcntl.fcntl(memory, 1033, 1)
        self.count = self.sequence = 0

    def write(self, payload, stamp, status):
        wide, word = self.words.wide, (~status & 0xFFFFFFFF) << 32 | status
        octets = struct.unpack(f"={up(len(payload), 8) // 8}Q", payload.ljust(up(len(payload), 8), b"\0"))
        self.count += 1
        if self.kind == 1:
            wide[8] = self.sequence + 1
            wide[9], wide[10], wide[11] = word, self.count, stamp
            for i, value in enumerate(octets):
                wide[12 + i] = value
            self.sequence += 2
            wide[8] = self.sequence
            return
        slot = (128 + self.count % (self.depth + 1) * self.slot) // 8
        wide[slot] = 2 * self.count - 1
        wide[slot + 1], wide[slot + 2] = word, stamp
        for i, value in enumerate(octets):
            wide[slot + 3 + i] = value
        wide[slot] = 2 * self.count
        wide[9], wide[10] = word, stamp
        wide[8] = self.count

    def tell(self, status):
        word = (~status & 0xFFFFFFFF) << 32 | status
        if self.kind == 1:
            self.words.wide[8] = self.sequence + 1
            self.words.wide[9] = word
            self.sequence += 2
            self.words.wide[8] = self.sequence
        else:
            self.words.wide[9] = word


class Structure:
    """A housekeeping structure while its configuration is in force."""

    def __init__(self, element, find):
        names = lambda each: [find(ref.get("name")) for ref in each.findall("ParamRef")]
        self.id, self.interval, self.on = int(element.get("id")), int(element.get("interval")), element.get("enabled", "yes") == "yes"
        self.once = [value for each in element.findall("SampledOnce") for value in names(each)]
        self.sets = [(int(each.get("nrep")), names(each)) for each in element.findall("SampledNREPTimes")]
        self.once_more = 0
        self.collections = [self.begin() if self.on else None, None]        # the periodic one, one that was asked for

    def allows(self, interval):
        return interval > 0 and all(interval % count == 0 for count, _ in self.sets)

    def begin(self):
        return {"phase": 0, "interval": self.interval, "groups": [b"" for _ in self.sets]}

    def tick(self):
        """Reports that are due in this cycle."""
        if self.once_more and self.collections[1] is None:
            self.once_more -= 1
            self.collections[1] = self.begin() | ({} if self.sets else {"interval": 1})
        for which, each in enumerate(self.collections):
            if each is None:
                continue
            each["phase"] += 1
            for i, (count, values) in enumerate(self.sets):
                if each["phase"] % (each["interval"] // count) == 0:
                    each["groups"][i] += b"".join(value.pack() for value in values)
            if each["phase"] >= each["interval"]:
                yield struct.pack(">H", self.id) + b"".join(value.pack() for value in self.once) + b"".join(each["groups"])
                self.collections[which] = self.begin() if which == 0 else None


class Reader:
    """Data of ST[128]; raises struct.error, ValueError or IndexError where they are none."""

    def __init__(self, octets):
        self.octets, self.at = octets, 0

    def take(self, form):
        values = struct.unpack_from(">" + form, self.octets, self.at)
        self.at += struct.calcsize(">" + form)
        return values if len(values) > 1 else values[0]

    def place(self):
        """Where an end of a link stands: empty in memory."""
        length = self.take("B")
        if self.at + length > len(self.octets):
            raise ValueError("cut")
        self.at += length
        return self.octets[self.at - length:self.at]

    def string(self):
        length = self.take("B")
        text = self.octets[self.at:self.at + length]
        if len(text) != length or not text or any(not 0x20 <= octet <= 0x7E for octet in text):
            raise ValueError("a string")
        self.at += length
        return text.decode()

    def numbers(self, highest):
        found = [self.take("B") for _ in range(self.take("B"))]
        if not 1 <= len(found) <= 16 or any(not 1 <= each <= highest for each in found):
            raise ValueError("a list")
        return found

    def period(self):
        period = self.take("q")
        if period <= 0:
            raise ValueError("a period")
        return period

    def fields(self):
        found = [(self.string(), *self.take("BI")) for _ in range(self.take("B"))]
        if not found or any(not 1 <= type_ <= 10 or not count for _, type_, count in found) or len({name for name, _, _ in found}) != len(found):
            raise ValueError("fields")
        return found

    def depth(self, queued):
        depth = self.take("H")
        if not (2 <= depth <= 4096 if queued else depth == 0):
            raise ValueError("a depth")
        return depth

    def flag(self):
        flag = self.take("B")
        if flag > 1:
            raise ValueError("a flag")
        return flag

    def offer(self):
        offer = {"set": self.string(), "period": self.period(), "methods": self.numbers(6), "orders": self.numbers(2), "kinds": self.numbers(3)}
        return offer | {"depth": self.depth(2 in offer["kinds"]), "wakes": self.flag(), "fields": self.fields()}

    def agreement(self):
        agreed = dict(zip(("method", "order", "kind"), self.take("BBB")))
        if not (1 <= agreed["method"] <= 6 and 1 <= agreed["order"] <= 2 and 1 <= agreed["kind"] <= 3):
            raise ValueError("terms")
        agreed |= {"depth": self.depth(agreed["kind"] == 2), "wakes": self.flag(), "producer_ns": self.period(), "consumer_ns": self.period()}
        begin = self.at
        agreed["fields"] = self.fields()
        agreed["payload"] = sum(struct.calcsize("=" + FORMS[type_]) * count for _, type_, count in agreed["fields"])
        value = 0xCBF29CE484222325
        for octet in self.octets[begin:self.at] + bytes([agreed["order"], agreed["kind"]]):
            value = (value ^ octet) * 0x100000001B3 & (1 << 64) - 1
        agreed["hash"] = value
        return agreed

    def link_request(self, subtype):
        """TC[128,subtype]"""
        asked = {"link": self.take("B")}
        if subtype == 1:
            asked["set"] = self.string()
        elif subtype == 2:
            asked["set"] = self.string()
            if self.take("B") != asked["link"]:
                raise ValueError("another link")
            asked["offer"] = self.offer()
        elif subtype == 3:
            asked |= {"role": self.take("B"), "epoch": self.take("I"), "made": self.take("I"), "set": self.string(), "agreement": self.agreement(),
                      "producer_at": self.place(), "consumer_at": self.place(), "key": self.take("Q")}
            if asked["role"] not in (1, 2) or asked["made"] and (asked["agreement"]["kind"] != 3 or asked["made"] >= asked["epoch"]):
                raise ValueError("a role")
        if self.at != len(self.octets):
            raise ValueError("octets too many")
        return asked
