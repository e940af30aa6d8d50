# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A client of the ground that asks both machines without a pause, and one that keeps when it heard each packet, so that it is found
in the log again."""
import array
import dataclasses
import math
import socket
import struct
import threading
import time

import flight
import honest

POS_SCALE = flight.MANIPULATOR << 16 | 10 << 8 | 8
HOUSEKEEPING, ALIVE, VALUES = 3 << 8 | 25, 17 << 8 | 2, 20 << 8 | 2
ACCEPTED, STARTED = 1 << 8 | 1, 1 << 8 | 3
MEDIUM, HIGH = 5 << 8 | 3, 5 << 8 | 4
NO_REQUEST = 0


@dataclasses.dataclass(slots=True)
class Said:
    """A report: what it is, never its words, of which there are millions."""
    key: int                      # of all its octets
    at: float
    apid: int
    kind: int                     # service << 8 | subtype
    count: int                    # sequence count, the addressee's own numbering
    destination: int
    request: int                  # of service 1, else NO_REQUEST


def said(packet, at):
    kind = packet[7] << 8 | packet[8]
    request = int.from_bytes(packet[20:24], "big") if packet[7] == 1 else NO_REQUEST
    return Said(hash(packet), at, (packet[0] & 7) << 8 | packet[1], kind, (packet[2] & 0x3F) << 8 | packet[3], packet[11] << 8 | packet[12], request)


class Reports:
    """Many of them in little memory."""

    def __init__(self):
        self.columns = [array.array(code) for code in "qdHHHHI"]

    def add(self, report):
        for column, field in zip(self.columns, (report.key, report.at, report.apid, report.kind, report.count, report.destination, report.request)):
            column.append(field)

    def __iter__(self):
        return (Said(*row) for row in zip(*self.columns))

    def __len__(self):
        return len(self.columns[0])

    def keys(self):
        return set(self.columns[0])


class Witness(honest.Honest):
    """Keeps each packet, beside what an honest client keeps."""

    def __init__(self):
        self.heard = Reports()
        super().__init__()

    def take(self, buffer, now):
        rest = super().take(buffer, now)
        at, end = 0, len(buffer) - len(rest)
        while at < end:
            size = 7 + (buffer[at + 4] << 8 | buffer[at + 5])
            self.heard.add(said(buffer[at:at + size], now))
            at += size
        return rest

    def next(self):
        """Of two threads that ask."""
        with self.arrived:
            return super().next()

    def heard_since(self, begin, apid, kind):
        """When the first such report came from number `begin` of all that were heard on, else infinity."""
        _, times, apids, kinds, *_ = self.heard.columns
        with self.arrived:
            return next((times[i] for i in range(begin, len(times)) if apids[i] == apid and kinds[i] == kind), math.inf)


class Client:
    """Asks both machines in turn: a ping, which waits for nothing, and the value of a parameter, which waits for the log. Each of them makes its
    addressee say something once."""

    def __init__(self, ground, port=honest.TELECOMMAND_PORT, pause_s=0.005):
        self.ground, self.sent, self.ending, self.pause_s = ground, [], False, pause_s
        self.mutex = threading.Lock()
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.ending:
            apid = (flight.MANIPULATOR, flight.JOYSTICK)[len(self.sent) // 2 % 2]
            if len(self.sent) % 2 or apid == flight.JOYSTICK:
                self.send(honest.telecommand(apid, self.ground.next()))
            else:
                self.send(honest.telecommand(apid, self.ground.next(), 20, struct.pack(">BI", 1, POS_SCALE)))
            time.sleep(self.pause_s)

    def send(self, packet):
        with self.mutex:
            self.sent.append((packet, time.monotonic()))
            self.socket.sendall(packet)
        return packet
