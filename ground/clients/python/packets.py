# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Packets on the link, octet by octet, and what can go wrong there. CRC-16 of the whole packet, CUC 4+3 time of TAI since 1958,
numbers big-endian."""
from __future__ import annotations

import binascii
import dataclasses
import struct
from typing import List, Optional

ACK_ALL = 15                      # acceptance, start, progress, completion
LARGEST_PACKET = 4096
CUC_OCTETS = 7


class HiroscoError(Exception):
    """Whatever this client raises."""


class ArgumentError(HiroscoError, ValueError):
    """Not sent: a value outside its range, of another kind, or a name nobody knows."""


class LinkLost(HiroscoError, ConnectionError):
    """The spacecraft's end of the link is gone."""


class NoAnswer(HiroscoError, TimeoutError):
    """What was waited for did not come in time. It may still come, and the request may still be executed."""


def crc16(octets: bytes) -> int:
    """CCSDS error control: polynomial 0x1021, preset 0xFFFF. 0 over a whole undamaged packet."""
    return binascii.crc_hqx(octets, 0xFFFF)


def telecommand(apid: int, count: int, service: int, subtype: int, source: int, data: bytes = b"",
                ack: int = ACK_ALL) -> bytes:
    """A whole telecommand packet with PUS-C header."""
    header = struct.pack(">HHHBBBH", 0x1800 | apid, 0xC000 | count, len(data) + 6, 0x20 | ack, service, subtype, source)
    packet = header + data
    if len(packet) + 2 > LARGEST_PACKET:
        raise ArgumentError(f"a telecommand has at most {LARGEST_PACKET} octets, this one {len(packet) + 2}")
    return packet + struct.pack(">H", crc16(packet))


@dataclasses.dataclass(frozen=True)
class Telemetry:
    """A telemetry packet with PUS-C header."""
    apid: int
    count: int
    service: int
    subtype: int
    destination: int
    time_s: float                 # TAI since 1958
    data: bytes

    @classmethod
    def parse(cls, packet: bytes) -> Optional[Telemetry]:
        """None for what is damaged or is no PUS-C telemetry."""
        if not 22 <= len(packet) <= LARGEST_PACKET or packet[0] >> 3 != 1 or packet[6] >> 4 != 2 or crc16(packet) != 0:
            return None
        first, second, length = struct.unpack(">HHH", packet[:6])
        if length + 7 != len(packet):
            return None
        service, subtype, _, destination = struct.unpack(">BBHH", packet[7:13])
        return cls(first & 0x7FF, second & 0x3FFF, service, subtype, destination, cuc_seconds(packet[13:20]),
                   packet[20:-2])


def cuc_seconds(octets: bytes) -> float:
    return int.from_bytes(octets[:4], "big") + int.from_bytes(octets[4:7], "big") / 2**24


def cuc_octets(seconds: float) -> bytes:
    """OverflowError, ValueError: no time that it has."""
    return round(seconds * 2**24).to_bytes(CUC_OCTETS, "big")


def cut(stream: bytearray) -> List[bytes]:
    """Takes the whole packets off the front of a stream. LinkLost: this is no telemetry, so nothing has an end."""
    packets = []
    while len(stream) >= 6:
        size = 7 + int.from_bytes(stream[4:6], "big")
        if stream[0] >> 4 != 0 or size > LARGEST_PACKET:
            raise LinkLost("what comes from there is no telemetry")
        if len(stream) < size:
            break
        packets.append(bytes(stream[:size]))
        del stream[:size]
    return packets
