# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The links of metronome.py, a producer: what it provides, agrees to and gives back (service 128). Written from docs/interfaces/packets.md alone;
Python's standard library only."""
import struct

from metronome_packets import NOT_NOW, UNKNOWN, Refusal, bad
from metronome_parts import Producer, Reader

OFFLINE, PRE, SAFE, OPERATIONAL, ERROR, POST = 0, 3, 4, 5, 6, 7
CYCLIC = PRE, SAFE, OPERATIONAL, ERROR
STOPPING = 3


class Links:
    """Of the subsystem that has them: its configuration, parameters and reports are its own."""

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
