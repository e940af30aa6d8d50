#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A hostile ground against the ports of a running mission: every announced length, every bit flip of a ping, noise,
one octet per second, clients that never say or never read anything. Meanwhile an honest client pings all the time and
others connect anew; each of them has to be answered within 500 ms. At the end the counters of rejections are read back
as housekeeping 4731 (communication) and 4701 (supervisor).

    pip install -r requirements.txt
    hostile.py [--host H] [--port P] [--telecommand-port P] [--mission mission.xml] [--quick]

Exit code 0: every honest ping was answered in time, nothing came damaged, and the rejections were counted."""
import argparse
import contextlib
import multiprocessing
import os
import random
import select
import socket
import struct
import sys
import threading
import time

from fastcrc import crc16
from spacepackets.ecss import PusTc

from pus_link import APIDS, COMMUNICATION, MANIPULATOR, SUPERVISOR, GroundLink, Mission, Table, add_arguments

LIMIT_MS = 500.0
SHORTEST, LONGEST = 6, 4096 - 7          # plausible values of the length field: 13 to 4096 octets in all


# What is thrown.

def ping(apid, count, ack=15, source=0):
    telecommand = PusTc(service=17, message_subtype=1, apid=apid, seq_count=count, ack_flags=ack, source_id=source)
    return bytes(telecommand.pack())


def header(apid, length, count=0):
    """Primary header of a telecommand with any length field."""
    return struct.pack(">HHH", 0x1800 | apid, 0xC000 | count, length)


def with_checksum(octets):
    return octets + struct.pack(">H", crc16.ibm_3740(octets))


def bit_flips(octets):
    for bit in range(8 * len(octets)):
        flipped = bytearray(octets)
        flipped[bit // 8] ^= 0x80 >> bit % 8
        yield bytes(flipped)


class Target:
    """Where the attacks go. Each connection comes from another loopback address, so that closed ones do not use up the
    local ports."""

    def __init__(self, host, telemetry, telecommand):
        self.host, self.telemetry, self.telecommand = host, telemetry, telecommand
        self.made = 0

    def connect(self, port=None, timeout=10.0):
        self.made += 1
        source = (f"127.{os.getpid() % 200 + 1}.{self.made // 250 % 250}.{self.made % 250 + 1}", 0) \
            if self.host.startswith("127.") else None
        return socket.create_connection((self.host, port or self.telecommand), timeout, source)

    def throw(self, octets, port=None, wait=True, reset=False):
        """Sends on a connection of its own; `wait`: until the other end has seen the end of it and closed."""
        try:
            with self.connect(port) as link:
                if reset:
                    link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                link.sendall(octets)
                if wait and not reset:
                    link.shutdown(socket.SHUT_WR)
                    while link.recv(65536):
                        pass
        except (ConnectionError, TimeoutError, BrokenPipeError):
            pass                          # being cut off is the right answer


def step(quick):
    return 97 if quick else 1


def lengths(quick):
    return range(0, 0x10000, step(quick))


def every_length(target, quick):
    rest = ping(MANIPULATOR, 0)[6:]
    for length in lengths(quick):
        target.throw(header(MANIPULATOR, length) + rest, reset=length % 16 == 15)


def every_plausible_length(target, quick):
    """Whole packets with a good checksum and every plausible length, in one stream: refused, the stream goes on."""
    begin = ping(MANIPULATOR, 0)[6:11]
    with target.connect() as link:
        for length in range(SHORTEST + 1, LONGEST + 1, step(quick)):
            body = header(MANIPULATOR, length) + begin
            link.sendall(with_checksum(body.ljust(length + 7 - 2, b"\0")))


def every_bit_flip(target, quick):
    for flip in bit_flips(ping(MANIPULATOR, 1)):
        for port in (target.telecommand, target.telemetry):
            target.throw(flip, port, wait=port == target.telecommand)


def noise(target, quick):
    generator = random.Random(1)
    for _ in range(20 if quick else 300):
        target.throw(generator.randbytes(generator.randrange(1, 65536)), wait=False)


def damaged_stream(target, quick):
    """Good headers, damaged checksums: reported at a limited rate, and the stream goes on."""
    with target.connect() as link:
        for count in range(200 if quick else 5000):
            octets = bytearray(ping(MANIPULATOR, count))
            octets[-1] ^= 0x55
            link.sendall(octets)


ATTACKS = [every_length, every_plausible_length, every_bit_flip, noise, damaged_stream]


def attack(target, name, quick):
    os.nice(10)                           # what is measured is the spacecraft, not the shortage of our own processors
    globals()[name](target, quick)


# Who is slow.

class Slow(threading.Thread):
    """Clients that send one octet of a ping per second; each has to be cut off, never answered."""

    def __init__(self, target, number):
        super().__init__(daemon=True)
        self.target, self.number = target, number
        self.cut, self.answered, self.longest = 0, 0, 0.0
        self.stop = threading.Event()

    def run(self):
        octets = ping(MANIPULATOR, 2)
        clients = []
        for _ in range(self.number):
            with contextlib.suppress(OSError):
                clients.append((self.target.connect(), time.monotonic()))
        place = 0
        while clients and not self.stop.wait(1.0):
            for client, begun in list(clients):
                try:
                    client.sendall(octets[place % 13:place % 13 + 1])
                    readable, _, _ = select.select([client], [], [], 0)
                    ended = bool(readable) and not client.recv(100)
                    self.answered += bool(readable) and not ended
                except ConnectionError:
                    ended = True
                if ended:
                    self.cut += 1
                    self.longest = max(self.longest, time.monotonic() - begun)
                    client.close()
                    clients.remove((client, begun))
            place += 1


# Who is honest.

class Honest(threading.Thread):
    """Pings without end on one connection."""

    def __init__(self, link, period):
        super().__init__(daemon=True)
        self.link, self.period = link, period
        self.times, self.lost = [], 0
        self.stop = threading.Event()

    def run(self):
        apids = list(APIDS)
        number = 0
        while not self.stop.wait(self.period):
            apid = apids[number % len(apids)]
            number += 1
            took = answered(self.link, apid)
            if took is None:
                self.lost += 1
            else:
                self.times.append(took)


def stolen_ms():
    """What a host has taken from this machine's processors since it runs: in that time nobody can answer."""
    with open("/proc/stat", encoding="ascii") as file:
        return int(file.readline().split()[8]) * 1000 / os.sysconf("SC_CLK_TCK")


def answered(link, apid):
    """Milliseconds from TC[17,1] to its TM[17,2], without those that were stolen; None after two seconds."""
    begin, stolen = time.monotonic(), stolen_ms()
    try:
        link.send(link.telecommand(apid, 17, 1, ack=0))
    except OSError:
        return None
    report = link.wait(lambda r: r.kind == (17, 2) and r.packet.apid == apid and r.destination == link.source, 2.0)
    return max(0.0, (report.received - begin) * 1000 - (stolen_ms() - stolen)) if report else None


class Reconnecting(threading.Thread):
    """Connects, pings, leaves, again and again."""

    def __init__(self, options):
        super().__init__(daemon=True)
        self.options = options
        self.times, self.lost = [], 0
        self.stop = threading.Event()

    def run(self):
        while not self.stop.wait(0.1):
            begin, stolen = time.monotonic(), stolen_ms()
            try:
                with GroundLink(self.options.host, self.options.port) as link:
                    took = answered(link, COMMUNICATION)
            except OSError:
                took = None
            if took is None:
                self.lost += 1
            else:
                self.times.append(max(0.0, (time.monotonic() - begin) * 1000 - (stolen_ms() - stolen)))


# What is counted on board.

def counters(link, descriptor, identifier):
    """{name: integer} of a housekeeping structure as it is reported next; None when it does not come."""
    link.forget()
    report = link.wait(lambda r: r.kind == (3, 25) and r.packet.apid == descriptor.apid and
                       int.from_bytes(r.packet.tm_data[:2], "big") == identifier, 5.0)
    if report is None:
        return None
    found = {}
    for name, value in descriptor.decode(report.packet.tm_data).items():
        values = value if isinstance(value, tuple) else (value,)
        for place, number in enumerate(values):
            if isinstance(number, int):
                found[name if len(values) == 1 else f"{name}[{place}]"] = number
    return found


def compare_counters(table, what, before, after, least):
    """`least`: name -> by how much that counter must have risen."""
    if before is None or after is None:
        return table.row(False, f"{what} read back", "no housekeeping")
    rose = {name: after[name] - before[name] for name in after if after[name] > before[name]}
    for name, number in least.items():
        table.row(rose.get(name, 0) >= number, f"{what}: {name} counted", f"+{rose.get(name, 0)}, at least {number}")
    table.row(True, f"{what}: all that rose", ", ".join(f"{name} +{number}" for name, number in rose.items()))


def judge(table, who, client):
    times = sorted(client.times)
    if not times:
        return table.row(False, f"{who} answered", "never")
    found = (f"{len(times)} answered, {client.lost} lost, p50 {times[len(times) // 2]:.1f} ms, "
             f"largest {times[-1]:.1f} ms")
    return table.row(client.lost == 0 and times[-1] <= LIMIT_MS, f"{who} within {LIMIT_MS:.0f} ms", found)


def silent_clients(target, number):
    clients = []
    for place in range(number):
        with contextlib.suppress(OSError):
            clients.append(target.connect(target.telemetry if place % 2 else target.telecommand))
    return clients


def run(options):
    table = Table()
    mission = Mission(options.mission)
    supervisor = next(d for d in mission.subsystems.values() if d.apid == SUPERVISOR)
    communication = next(d for d in mission.subsystems.values() if d.apid == COMMUNICATION)
    target = Target(options.host, options.port, options.telecommand_port)

    observer = GroundLink(options.host, options.port)
    table.row(answered(observer, SUPERVISOR) is not None, "a ping before the storm")   # and a silent one would give way
    before = (counters(observer, communication, 4731), counters(observer, supervisor, 4701))
    honest = Honest(GroundLink(options.host, options.port), 0.02)
    reconnecting = Reconnecting(options)
    honest.start()
    time.sleep(0.5)                       # it has sent a valid packet: silent ones give way first
    silent = silent_clients(target, options.silent)
    table.row(len(silent) == options.silent, f"{options.silent} silent clients connected", f"{len(silent)}")
    reconnecting.start()
    slow = Slow(target, 20)
    slow.start()

    for one in ATTACKS:
        begin = time.monotonic()
        process = multiprocessing.Process(target=attack, args=(target, one.__name__, options.quick))
        process.start()
        process.join(options.most_seconds)
        ended = process.exitcode == 0
        if process.is_alive():
            process.terminate()
            process.join()
        table.row(ended, one.__name__.replace("_", " "), f"{time.monotonic() - begin:.1f} s")
    slow.join(max(0.0, 8.0))
    slow.stop.set()
    table.row(slow.cut == 20 and slow.answered == 0, "one octet per second is cut off",
              f"{slow.cut} of 20 cut, the last after {slow.longest:.1f} s, {slow.answered} answered")

    for client in (honest, reconnecting):
        client.stop.set()
        client.join(5.0)
    judge(table, "honest client", honest)
    judge(table, "reconnecting client", reconnecting)
    for client in silent:
        client.close()
    for apid in APIDS:
        took = answered(observer, apid)
        table.row(took is not None and took <= LIMIT_MS, f"afterwards {APIDS[apid]} answers", "", took)
    after = (counters(observer, communication, 4731), counters(observer, supervisor, 4701))
    compare_counters(table, "4731", before[0], after[0], {
        "CLIENTS.BAD_LENGTH": sum(not SHORTEST <= n <= LONGEST and n % 16 != 15 for n in lengths(options.quick)),
        "CLIENTS.BAD_HEADER": 6,          # the bit flips of version and type
        "CLIENTS.INCOMPLETE": 20})
    compare_counters(table, "4701", before[1], after[1], {
        "REJECTIONS[5]": 200 if options.quick else 5000,
        "REJECTIONS[8]": len(range(SHORTEST + 1, LONGEST + 1, step(options.quick)))})
    for name, link in (("honest client", honest.link), ("observer", observer)):
        table.row(not link.malformed and not link.gaps and not link.closed,
                  f"{name}: {link.received} packets, none malformed, no gap",
                  "; ".join([*link.malformed[:2], *map(str, link.gaps[:2])]) + (" closed" if link.closed else ""))
        link.close()
    return table.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    parser.add_argument("--telecommand-port", type=int, default=10025)
    parser.add_argument("--silent", type=int, default=200, help="silent clients held all the time")
    parser.add_argument("--most-seconds", type=float, default=300.0, help="time limit of one attack")
    parser.add_argument("--quick", action="store_true", help="every 97th length, less noise")
    return run(parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
