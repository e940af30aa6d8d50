# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A ground that asks for what was said before (TC[129,11], docs/adr/0140) and keeps what comes."""
import binascii
import socket
import struct
import time

import honest

SOURCE = 0x2F02
EVER = b"\xff" * 7


def telecommand(count, housekeeping):
    data = bytes(7) + EVER + bytes([housekeeping])
    body = struct.pack(">HHHBBBH", 0x1801, 0xC000 | count, 5 + len(data) + 1, 0x2F, 129, 11, SOURCE) + data
    return body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF))


def packets(link, until):
    """Each packet of the stream as it comes."""
    buffer = b""
    while (left := until - time.monotonic()) > 0:
        while len(buffer) >= 6 and len(buffer) >= (size := 7 + int.from_bytes(buffer[4:6], "big")):
            yield buffer[:size]
            buffer = buffer[size:]
        link.settimeout(left)
        octets = link.recv(1 << 20)
        if not octets:
            raise AssertionError("the ground link was closed while it told what was said before")
        buffer += octets


def all_again(limit_s, housekeeping=False):
    """([(number, packet)] as they came, (reports, left out, missing, damaged, why) of the end)."""
    came = []
    with socket.create_connection(("127.0.0.1", honest.TELEMETRY_PORT), 5.0) as down, \
            socket.create_connection(("127.0.0.1", honest.TELECOMMAND_PORT), 5.0) as up:
        asked = telecommand(1, housekeeping)
        up.sendall(asked)
        for packet in packets(down, time.monotonic() + limit_s):
            apid, destination = int.from_bytes(packet[:2], "big") & 0x7FF, int.from_bytes(packet[11:13], "big")
            if (apid, packet[7], destination) != (honest.SUPERVISOR, 129, SOURCE):
                continue
            data = packet[20:-2]
            if packet[8] == 12:
                came.append((int.from_bytes(data[:8], "big"), data[8:]))
            elif packet[8] == 13 and data[:4] == asked[:4]:
                return came, (*struct.unpack(">4I", data[4:20]), data[21:].decode())
    raise AssertionError(f"what was said before had no end in {limit_s} s, {len(came)} reports came")
