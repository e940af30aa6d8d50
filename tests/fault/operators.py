# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""An operator who sends requests of services beside functions, and hears how they end."""
import binascii
import struct
import time

import flight

SUPERVISOR = 1


class Operator(flight.Telemetry):
    """Telecommands to one subsystem besides, on the same connection."""

    count = 0

    def __init__(self, apid=flight.MANIPULATOR):
        super().__init__()
        self.apid = apid

    def send(self, service, subtype, data):
        """Sends it and waits for its end: the subtype of the last report of service 1 on it."""
        self.count += 1
        sequence = 0xC000 | self.count % (1 << 14)
        body = struct.pack(">BBBH", 0x2F, service, subtype, 0x4711) + data
        packet = struct.pack(">HHH", 0x1800 | self.apid, sequence, len(body) + 1) + body
        self._socket.sendall(packet + struct.pack(">H", binascii.crc_hqx(packet, 0xFFFF)))
        end = time.monotonic() + 5.0
        while time.monotonic() < end:
            with self._mutex:
                ends = [r.subtype for r in self.reports if r.service == 1 and r.subtype in (2, 4, 7, 8, 10) and
                        r.data[:4] == packet[:4]]
            if ends:
                return ends[-1]
            time.sleep(0.01)
        raise AssertionError(f"no end of TC[{service},{subtype}]")

    def newest(self, service, subtype):
        with self._mutex:
            return [r.data for r in self.reports if (r.apid, r.service, r.subtype) == (self.apid, service, subtype)][-1]

    def sampled(self, structure):
        """What it has reported of a housekeeping structure, behind its id."""
        with self._mutex:
            return [r.data[2:] for r in self.reports
                    if (r.apid, r.service, r.subtype) == (self.apid, 3, 25) and int.from_bytes(r.data[:2], "big") == structure]

    def events(self):
        """Ids of all events that it has reported."""
        with self._mutex:
            return [int.from_bytes(r.data[:2], "big") for r in self.reports
                    if r.apid == self.apid and r.service == 5 and r.subtype <= 4]
