# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Ground for tests of real flights: an honest client that reads all telemetry and keeps what is about its telecommands, and what
others throw at the spacecraft beside it. Python's standard library only."""
import binascii
import collections
import multiprocessing
import os
import select
import socket
import struct
import threading
import time

TELEMETRY_PORT, TELECOMMAND_PORT = 10015, 10025
SUPERVISOR, COMMUNICATION = 1, 2
ACCEPTANCE, ALL = 1, 15
HONEST, FLOOD = 0x2F00, 0x2F01           # source ids
ENDS = {2, 4, 7, 8, 10}


def telecommand(apid, count, service=17, data=b"", ack=ALL, source=HONEST):
    body = struct.pack(">HHHBBBH", 0x1800 | apid, 0xC000 | count, 5 + len(data) + 1, 0x20 | ack, service, 1,
                       source) + data
    return body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF))


def call(count, function, *arguments):
    """A function of the supervisor, each argument as its octets."""
    data = b"".join(bytes([place]) + argument for place, argument in enumerate(arguments, 1))
    return telecommand(SUPERVISOR, count, 8, function.encode().ljust(16, b"\0") + bytes([len(arguments)]) + data)


def safe_all(count):
    return call(count, "SAFE_ALL")


def request_id(packet):
    return packet[:4]


class Honest:
    """Reads all telemetry as it comes and keeps what is about telecommands."""

    def __init__(self):
        # What waits in the kernel is late already: who minds that lets little wait there.
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 * 1024)
        self.socket.connect(("127.0.0.1", TELEMETRY_PORT))
        self.socket.settimeout(None)
        self.count, self.closed, self.gaps, self.packets = 0, False, 0, 0
        self.reports = {}                                     # request id -> [(subtype, time)]
        self.by_source = collections.Counter()                # (destination, subtype) -> number
        self.said = collections.Counter()                     # (apid, service, subtype) -> number, without housekeeping
        self.housekeeping = {}                                # (apid, structure) -> (number, source data)
        self.sequence = {}
        self.arrived = threading.Condition()
        threading.Thread(target=self.receive, daemon=True).start()

    def receive(self):
        buffer = b""
        while True:
            try:
                octets = self.socket.recv(1 << 20)
            except OSError:
                octets = b""
            now = time.monotonic()
            with self.arrived:
                self.closed = not octets
                buffer = self.take(buffer + octets, now)
                self.arrived.notify_all()
            if not octets:
                return

    def take(self, buffer, now):
        at, end = 0, len(buffer)
        while end - at >= 6:
            size = 7 + (buffer[at + 4] << 8 | buffer[at + 5])
            if end - at < size:
                break
            apid = (buffer[at] & 7) << 8 | buffer[at + 1]
            count = (buffer[at + 2] & 0x3F) << 8 | buffer[at + 3]
            if (self.sequence.get(apid, count - 1) + 1) & 0x3FFF != count:
                self.gaps += 1
            self.sequence[apid] = count
            service, subtype = buffer[at + 7], buffer[at + 8]
            self.packets += 1
            if (service, subtype) != (3, 25):
                self.said[apid, service, subtype] += 1
            if service == 1:
                destination = buffer[at + 11] << 8 | buffer[at + 12]
                self.by_source[destination, subtype] += 1
                if destination == HONEST:
                    self.reports.setdefault(buffer[at + 20:at + 24], []).append((subtype, now))
            elif (service, subtype) == (3, 25):
                structure = buffer[at + 20] << 8 | buffer[at + 21]
                number = self.housekeeping.get((apid, structure), (0, b""))[0]
                self.housekeeping[apid, structure] = (number + 1, buffer[at + 22:at + size - 2])
            at += size
        return buffer[at:]

    def next(self):
        self.count = (self.count + 1) & 0x3FFF
        return self.count

    def wait(self, wanted, seconds):
        with self.arrived:
            return self.arrived.wait_for(lambda: wanted() or self.closed, seconds) and not self.closed

    def verdict(self, packet, seconds):
        """{subtype: time} once a final report is there; None when it does not come."""
        found = lambda: self.reports.get(request_id(packet), [])
        done = self.wait(lambda: any(subtype in ENDS for subtype, _ in found()), seconds)
        return dict(found()) if done else None

    def fresh_housekeeping(self, apid, structure):
        """The structure as it is sampled from now on."""
        before = self.housekeeping.get((apid, structure), (0, b""))[0]
        if not self.wait(lambda: self.housekeeping.get((apid, structure), (0, b""))[0] >= before + 2, 10.0):
            raise AssertionError(f"no housekeeping {structure}")
        return self.housekeeping[apid, structure][1]

    def link(self):
        """(RX, {name: number}) as the communication subsystem counts."""
        data = self.fresh_housekeeping(COMMUNICATION, 4731)
        names = ("accepted", "slow", "evicted", "bad_header", "bad_length", "incomplete", "left", "broken", "refused",
                 "idle", "damaged")
        return struct.unpack_from(">I", data, 1)[0], dict(zip(names, struct.unpack_from(">11I", data, 17)))

    def refused_for_checksum(self):
        data = self.fresh_housekeeping(SUPERVISOR, 4701)
        return struct.unpack_from(">17I", data, 1 + 8)[5]


# What is thrown. Each runs in a process of its own until it is told to stop; `sent` is how many packets were sent whole.

def flood(blocks, ports, stop, sent):
    """The same block again and again on every connection, as fast as it goes; at its end all of it has been read."""
    os.nice(10)                    # what is measured is the spacecraft, not the shortage of our own processors
    links = []
    for port in ports:
        links.append(socket.socket())
        links[-1].setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 64 * 1024)
        links[-1].connect(("127.0.0.1", port))
    silent = {link for link, port in zip(links, ports) if port == TELECOMMAND_PORT}
    rest = {link: memoryview(block) for link, block in zip(links, blocks)}
    whole = {link: (block, len(block) // 13) for link, block in zip(links, blocks)}
    for link in links:
        link.setblocking(False)
    while links:
        readable, writable, _ = select.select(links, links, [], 0.2)
        for link in readable:
            try:
                if not link.recv(1 << 20):
                    raise AssertionError("the flood was cut off")
            except BlockingIOError:
                pass
        for link in writable:
            try:
                rest[link] = rest[link][link.send(rest[link]):]
            except BlockingIOError:
                continue
            if rest[link]:
                continue
            with sent.get_lock():
                sent.value += whole[link][1]
            if not stop.is_set():
                rest[link] = memoryview(whole[link][0])
                continue
            links.remove(link)
            link.setblocking(True)
            link.shutdown(socket.SHUT_WR)
            link.settimeout(30.0)
            while link in silent and link.recv(1 << 20):
                pass
            link.close()


def valid_pings(apid):
    return b"".join(telecommand(apid, count, ack=ACCEPTANCE, source=FLOOD) for count in range(1000))


def damaged_pings():
    return b"".join(packet[:-1] + bytes([packet[-1] ^ 0x55]) for packet in
                    (telecommand(10, count, source=FLOOD) for count in range(1000)))


def one_octet_a_second(stop, number):
    """Clients that never end a packet; those that are cut off come again."""
    os.nice(10)
    packet, links, place = telecommand(10, 0, source=FLOOD), [], 0
    while not stop.is_set():
        links += [socket.create_connection(("127.0.0.1", TELECOMMAND_PORT)) for _ in range(number - len(links))]
        for link in list(links):
            try:
                link.send(packet[place % 12:place % 12 + 1])
            except OSError:
                link.close()
                links.remove(link)
        place += 1
        stop.wait(1.0)


def busy(stop):
    while not stop.is_set():
        pass


class Beside:
    """`with Beside(target, *arguments) as sent:` - while the block runs, so does this process."""

    def __init__(self, target, *arguments):
        self.stop, self.sent = multiprocessing.Event(), multiprocessing.Value("Q", 0)
        extra = (self.stop, self.sent) if target is flood else (self.stop,)
        order = (*arguments, *extra) if target is flood else (*extra, *arguments)
        self.process = multiprocessing.Process(target=target, args=order, daemon=True)

    def __enter__(self):
        self.process.start()
        time.sleep(0.5)              # it is a flood by then
        return self.sent

    def __exit__(self, kind, *_):
        self.stop.set()
        self.process.join(60.0)
        if self.process.is_alive():
            self.process.kill()
        if kind is None and self.process.exitcode != 0:
            raise AssertionError("the flood did not come to its end")
