#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a telecommand sets of a persistent parameter outlives kill -9 of the whole flight, and one damaged copy."""
import binascii
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import struct
import tempfile
import time
import unittest

import flight

HELLO = 7
DES_POSITION = HELLO << 16 | 10 << 8 | 1     # APID, DOUBLE, id
DECLARED = 0.3
GROUND = 0x2F00                             # source id
PERMIT = '<Permit subsystem="HELLO" functions="*"'
WRITABLE = 'init="0.3" minimum="-3.2" maximum="3.2" writable="PreOperational SafeOperational Operational" persistent="yes"'


def telecommand(subtype, data, count):
    body = struct.pack(">HHHBBBH", 0x1800 | HELLO, 0xC000 | count, 5 + len(data) + 1, 0x2F, 20, subtype, GROUND) + data
    return body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF))


class Persistent(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-persistent-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "supervisor").symlink_to(flight.REPOSITORY / "supervisor")
        shutil.copytree(flight.REPOSITORY / "subsystems", self.folder / "subsystems", symlinks=True)
        shutil.copytree(flight.REPOSITORY / "missions/hello", self.folder / "missions/hello")
        descriptor = self.folder / "subsystems/hello/hello.xml"
        text = descriptor.read_text()
        self.assertIn('init="0.3"', text)
        descriptor.write_text(text.replace('init="0.3"', WRITABLE))
        self.mission = self.folder / "missions/hello/mission.xml"
        text = self.mission.read_text()
        self.assertIn(PERMIT, text)
        self.mission.write_text(text.replace(PERMIT, f'{PERMIT} parameters="DES_POSITION"'))
        self.copies = [self.folder / f"log/hello.values/HELLO.{number}" for number in (1, 2)]

    def fly(self):
        return flight.Flight(self.mission, folder=self.folder)

    def ask(self, subtype, data, answer, count=1):
        """The first report of `answer`, (service, subtype), on a telecommand of ST[20]."""
        with flight.Telemetry() as telemetry, socket.create_connection(("127.0.0.1", 10025), 5.0) as link:
            link.sendall(telecommand(subtype, data, count))
            end = time.monotonic() + 10.0
            while time.monotonic() < end:
                for report in list(telemetry.reports):
                    if report.apid == HELLO and (report.service, report.subtype) == answer:
                        return report.data
                time.sleep(0.02)
        came = [(report.service, report.subtype, report.data.hex()) for report in telemetry.reports if report.service in (1, 20)]
        self.fail(f"no TM{list(answer)} within 10 s: {came}")

    def stands_at(self, value):
        data = self.ask(1, struct.pack(">BI", 1, DES_POSITION), (20, 2))
        self.assertEqual(data, struct.pack(">BId", 1, DES_POSITION, value))

    def kill_all(self, hello):
        for pid in hello.processes():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.assertEqual(hello.wait_until_gone(10.0), {})

    def damage(self, copy):
        octets = bytearray(copy.read_bytes())
        octets[len(octets) // 2] ^= 1
        copy.write_bytes(octets)

    def test_what_was_set_is_there_after_kill_9_of_everything(self):
        with self.fly() as hello:
            hello.wait_told("commissioned: mode operation")
            self.stands_at(DECLARED)
            self.ask(3, struct.pack(">BId", 1, DES_POSITION, 1.25), (1, 7), 2)
            hello.wait_told("VALUES_KEPT")
            self.kill_all(hello)
        with self.fly() as hello:
            hello.wait_told("HELLO takes over 1 stored value, of ")
            hello.wait_told("commissioned: mode operation")
            hello.wait_told("VALUES_TAKEN")
            self.stands_at(1.25)
            self.kill_all(hello)
        self.damage(self.copies[0])
        with self.fly() as hello:
            hello.wait_told("copy 1 of HELLO's stored values is not used: damaged")
            hello.wait_told("commissioned: mode operation")
            self.stands_at(1.25)
            self.kill_all(hello)
        for copy in self.copies:
            self.damage(copy)
        with self.fly() as hello:
            hello.wait_told("HELLO begins as its descriptor says: none of its stored values is used")
            hello.wait_told("commissioned: mode operation")
            self.stands_at(DECLARED)
            self.assertEqual(hello.end(), 0, hello.errors)


if __name__ == "__main__":
    flight.main()
