# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The duties by their names, as docs/interfaces/subsystem.md has them, and what several of them need."""
import socket
import tempfile
import xml.etree.ElementTree
import pathlib

import wire
from craft import INSTANCE, OPERATIONAL, PRE, SAFE, Craft, Passed, expect
from described import Configuration, Descriptor
from partners import PlayedDevice, PlayedProducer

DUTIES = {}
LATE_S = 0.03                # partners that are played answer within this, on a machine that has other work, too
# Of a link in memory: neither end stands anywhere else, and no key is needed.
IN_MEMORY, STANDS_IN_MEMORY = bytes(10), bytes(9)  # behind TC[128,3], in TM[128,132]
OUTPUT_LIMIT_S = 0.05        # beside two cycles


def duty(name):
    def add(function):
        DUTIES[name] = function
        return function
    return add


class Judged:
    """What is judged: program and descriptor."""

    def __init__(self, executable, descriptor, configuration=None):
        self.executable = executable
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="conform-"))
        self.given = Descriptor(descriptor)
        self.described, self.changed = played(self.given, self.folder)
        names = {each.get("name"): number for number, each in self.described.configurations.items()}
        self.number = names[configuration] if configuration else self.described.richest()

    def craft(self, **options):
        craft = Craft(self.executable, self.described, folder=self.folder, **options)
        for name, transfer in self.transfers().items():
            craft.addresses[name] = name if transfer == "unix" else f"127.0.0.1:{free_port()}"
        return craft

    def configuration(self):
        if self.number is None:
            raise Passed("no configuration is declared")
        return Configuration(self.described, self.number)

    def transfers(self):
        if self.number is None:
            return {}
        return {device.get("name"): device.find("Endnode").get("transfer") for device in self.configuration().devices}


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def played(descriptor, folder):
    """The descriptor as it is, or a copy whose devices are on sockets and whose limits a player in Python can keep."""
    root, changed = descriptor.root, []
    for configuration in root.findall("Configuration"):
        most = int(LATE_S / (int(configuration.get("sampling_us")) / 1e6)) + 1
        for device in configuration.findall("Device"):
            endnode = device.find("Endnode")
            if endnode.get("transfer") not in ("unix", "udp"):
                endnode.set("transfer", "unix")
                endnode.set("address", device.get("name"))
                changed.append(f"{device.get('name')} on a socket")
            for word, default in (("silence", 3), ("silence_reduced", 40)):
                if int(device.get(word, default)) < most:
                    device.set(word, str(most))
                    changed.append(f"{word} {most}")
        for wanted in configuration.iter("Requires"):
            for word, default in (("age", 3), ("age_reduced", 40)):
                if int(wanted.get(word, default)) < most:
                    wanted.set(word, str(most))
                    changed.append(f"{word} {most}")
    if not changed:
        return descriptor, changed
    file = folder / descriptor.file.name
    xml.etree.ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
    return Descriptor(file), sorted(set(changed))


class Flown:
    """A craft in a configuration, with its devices and the producers of what it requires."""

    def __init__(self, judged, craft):
        self.judged, self.craft = judged, craft
        self.configuration = judged.configuration()
        self.devices, self.links, self.next_link, self.link_epoch = {}, {}, 1, 1

    def configure(self):
        """Pre-Operational with the configuration in force."""
        self.craft.wait_alive()
        if self.craft.state() != PRE:
            self.craft.go(PRE)
        for device in self.configuration.devices:
            name = device.get("name")
            inputs = self.judged.described.devices[name].findall("Input/Field")
            octets = sum(wire.octets_of(wire.TYPES[each.get("type")]) * int(each.get("count", 1)) for each in inputs)
            transfer, address = device.find("Endnode").get("transfer"), self.craft.addresses[name]
            place = str(self.judged.folder / f"{address}.{INSTANCE}") if transfer == "unix" else address
            self.devices[name] = PlayedDevice(transfer, place, octets)
            self.craft.partners.append(self.devices[name])
        self.craft.configure(self.configuration.id).expect_done("CONFIGURE")
        # A device that was not heard yet inhibits at once in Safe-Operational.
        if self.devices:
            self.craft.until(lambda: all(len(device.commands) > 2 for device in self.devices.values()), 1 + 5 * self.configuration.period_s)
            self.craft.wait(2 * self.configuration.period_s)
        return self

    def agreement_for(self, required, **changes):
        """What a played producer of this set and it agree on."""
        methods, orders, kinds = self.configuration.terms(required)
        depth = int(required.get("depth", 64)) if kinds[0] == 2 else 0
        agreed = {"method": 1, "order": orders[0], "kind": kinds[0], "depth": depth, "producer_ns": self.configuration.period_ns,
                  "consumer_ns": self.configuration.period_ns, "fields": self.configuration.fields(required),
                  "wakes": int(self.configuration.started_by == required.get("name"))} | changes
        return wire.Agreement(**agreed)

    def attach_data(self, link, role, epoch, name, agreement):
        import struct
        return struct.pack(">BBII", link, role, epoch, 0) + wire.string(name) + agreement.octets() + IN_MEMORY

    def feed(self, required):
        """Makes the link of a required set; the producer is ours."""
        agreement = self.agreement_for(required)
        self.link_epoch += 1
        producer = PlayedProducer(agreement, self.link_epoch).seal()
        link, self.next_link = self.next_link, self.next_link + 1
        producer.link, producer.required = link, required
        self.craft.partners.append(producer)
        outcome = self.craft.ask(128, 3, self.attach_data(link, 2, producer.epoch, required.get("name"), agreement),
                                 descriptors=[producer.memory])
        outcome.expect_done(f"TC[128,3] as consumer of {required.get('name')}")
        attached = [r.data for r in outcome.others if r.kind == (128, 132)]
        expect(attached == [bytes([link, 2]) + STANDS_IN_MEMORY], f"TM[128,132] of {required.get('name')}: came {outcome.words()}")
        self.links[required.get("name")] = producer
        return producer

    def feed_all(self):
        for required in self.configuration.requires:
            self.feed(required)
        return self

    def safe(self):
        self.configure().feed_all()
        self.craft.go(SAFE)
        self.craft.wait(max(0.05, 5 * self.configuration.period_s))
        return self

    def operational(self):
        self.safe()
        if self.configuration.self_test:
            self.craft.ask(17, 128, seconds=60).expect_done("SELF_TEST")
        self.craft.permit_move()
        self.craft.wait(0.02)
        self.craft.go(OPERATIONAL)
        self.craft.wait(max(0.05, 5 * self.configuration.period_s))
        return self
