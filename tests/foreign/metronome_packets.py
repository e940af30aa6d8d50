# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The packets of metronome.py on its control channel: what it says and hears, and how a request is refused. Written from
docs/interfaces/packets.md alone; Python's standard library only."""
import binascii
import collections
import os
import select
import socket
import struct
import sys
import time

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


class Packets:
    """Of the subsystem that has them: its channel, pages, counts and services are its own."""

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
