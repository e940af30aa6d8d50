# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Space packets as PUS-C writes them, decoded once more: an oracle of its own beside the framework's codec."""
import dataclasses, struct


def crc16(octets):
    crc = 0xFFFF
    for octet in octets:
        crc ^= octet << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021) & 0xFFFF if crc & 0x8000 else crc << 1
    return crc


@dataclasses.dataclass
class Telecommand:
    apid: int
    count: int
    request: int
    ack: int
    service: int
    subtype: int
    source: int
    data: bytes

    @property
    def key(self):
        return (self.source, self.request)

    @property
    def function(self):
        """Name of the function that TC[8,1] calls, else None."""
        if (self.service, self.subtype) != (8, 1) or len(self.data) < 16:
            return None
        return self.data[:16].split(b"\0")[0].decode("ascii", "replace")

    @property
    def first_argument(self):
        """Of SET_STATE and its kin: one argument of one octet."""
        return self.data[18] if len(self.data) == 19 else None


@dataclasses.dataclass
class Report:
    apid: int
    count: int
    service: int
    subtype: int
    destination: int
    time: int
    data: bytes

    @property
    def request_key(self):
        return (self.destination, struct.unpack(">I", self.data[:4])[0])


def telecommand(octets):
    """None for what is none; the error control is believed, as the log's octets are judged for what they say."""
    if len(octets) < 13 or octets[0] >> 5 or not octets[0] & 0x10:
        return None
    request, _, version, service, subtype, source = struct.unpack(">IHBBBH", octets[:11])
    return Telecommand(request >> 16 & 0x7FF, request & 0x3FFF, request, version & 15, service, subtype, source, octets[11:-2])


def report(octets):
    if len(octets) < 22 or octets[0] >> 5 or octets[0] & 0x10:
        return None
    head, _, _, service, subtype, _, destination = struct.unpack(">IHBBBHH", octets[:13])
    return Report(head >> 16 & 0x7FF, head & 0x3FFF, service, subtype, destination, int.from_bytes(octets[13:20], "big"),
                  octets[20:-2])
