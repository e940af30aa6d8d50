#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The descriptor of a subsystem is edited while it flies (docs/adr/0095): refused in Operational; in Pre-Operational its range and
housekeeping change with the same process; a bad edit changes nothing and is told by file, line and column, also to who crashes then."""
import os
import pathlib
import signal
import struct
import tempfile
import unittest
import zlib

import flight

HELLO = 7
OFFLINE, PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL = 0, 3, 4, 5
FAR = 1.4                                 # beyond the range that MOVE_TO has at first


def copy_of(folder):
    """The mission hello, its REREAD permitted, in a folder where it may be written."""
    for part in ("missions/hello", "subsystems/hello", "subsystems/communication", "supervisor"):
        for file in (flight.REPOSITORY / part).glob("*.xml"):
            copy = pathlib.Path(folder) / file.relative_to(flight.REPOSITORY)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(file.read_text())
    mission = pathlib.Path(folder) / "missions/hello/mission.xml"
    text = mission.read_text().replace('functions="SET_MODE SHUTDOWN"/>', 'functions="SET_MODE SHUTDOWN REREAD"/>')
    mission.write_text(text.replace("<Recovery>", '<Recovery>\n    <Plan name="again"><When event="PROCESS_DIED"/>'
                                    '<Do action="restart"/></Plan>', 1))
    return mission, pathlib.Path(folder) / "subsystems/hello/hello.xml"


class Reread(unittest.TestCase):
    def states(self, craft, *states):
        for state in states:
            self.assertEqual(craft.tc("HELLO", "SET_STATE", state)[0], 0, state)

    def up(self, craft):
        """From Pre-Operational."""
        self.assertEqual(craft.tc("HELLO", "CONFIGURE", 1)[0], 0)
        self.states(craft, SAFE_OPERATIONAL, OPERATIONAL)

    def reread(self, craft):
        return craft.tc("SUPERVISOR", "REREAD", HELLO)[0]

    def test_a_descriptor_is_edited_while_it_flies(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-reread-") as folder, \
                tempfile.TemporaryDirectory(prefix="hirosco-reread-ground-") as ground:
            mission, descriptor = copy_of(folder)
            # The ground's own copy, wider from the beginning: what refuses is the craft.
            ground_mission, ground_descriptor = copy_of(ground)
            first = descriptor.read_text().replace('minimum="-3.2" maximum="3.2"', 'minimum="-1" maximum="1"')
            descriptor.write_text(first)
            ranged = first.replace('minimum="-1" maximum="1"', 'minimum="-1.5" maximum="1.5"')
            wider = ranged.replace('<HKService id="4711" interval="500">',
                                   '<HKService id="4712" interval="200"><SampledOnce><ParamRef name="DESCRIPTOR"/>'
                                   '</SampledOnce></HKService>\n    <HKService id="4711" interval="1000">')
            self.assertEqual(len({first, ranged, wider}), 3)
            ground_descriptor.write_text(ranged)
            with flight.Flight(mission=mission) as craft:
                craft.wait_told("commissioned: mode operation", 20.0)
                craft.mission = str(ground_mission)
                process = craft.pid_of("hirosco-hello")
                self.assertNotEqual(craft.tc("HELLO", "MOVE_TO", FAR)[0], 0)

                descriptor.write_text(wider)
                self.assertNotEqual(self.reread(craft), 0, "it is Operational")
                self.states(craft, SAFE_OPERATIONAL, OFFLINE, PRE_OPERATIONAL)
                self.assertEqual(self.reread(craft), 0)
                craft.wait_told(f"CRC-32 {zlib.crc32(wider.encode()):08x}", 5.0)
                self.up(craft)
                self.assertEqual(craft.tc("HELLO", "MOVE_TO", FAR)[0], 0)
                self.assertEqual(craft.pid_of("hirosco-hello"), process, "the same process")
                self.assertEqual(self.housekeeping(craft, 4712)[:4], struct.pack(">I", zlib.crc32(wider.encode())))

                bad = wider.replace('maximum="1.5"', 'maximum="much"')
                line = 1 + bad[:bad.index('maximum="much"')].count("\n")
                descriptor.write_text(bad)
                self.states(craft, SAFE_OPERATIONAL, OFFLINE)
                begin = craft.count()
                self.assertNotEqual(self.reread(craft), 0)
                craft.wait_told(f"hello.xml:{line}:", 5.0, begin)
                descriptor.write_text(wider.replace('name="DES_POSITION" id="1"', 'name="DES_POSITION" id="2"'))
                self.assertNotEqual(self.reread(craft), 0)
                craft.wait_told("parameter DES_POSITION: its id cannot change in flight", 5.0, begin)

                # Who dies comes back by what is in force, not by what the disk says: the supervisor, too.
                descriptor.write_text(bad)
                craft.kill("hirosco-supervisor")
                craft.wait_told("this supervisor goes on for one that died", 10.0, begin)
                self.assertEqual(craft.pid_of("hirosco-hello"), process, "what is Offline goes on, too")
                os.kill(process, signal.SIGKILL)
                craft.wait_told("started HELLO", 20.0, begin)
                self.assertNotEqual(craft.pid_of("hirosco-hello"), process)
                self.states(craft, PRE_OPERATIONAL)
                self.up(craft)
                self.assertEqual(craft.tc("HELLO", "MOVE_TO", FAR)[0], 0)

                descriptor.write_text(first)
                self.states(craft, SAFE_OPERATIONAL, OFFLINE)
                self.assertEqual(self.reread(craft), 0)
                self.states(craft, PRE_OPERATIONAL)
                self.up(craft)
                self.assertNotEqual(craft.tc("HELLO", "MOVE_TO", FAR)[0], 0)
                craft.end()

    def housekeeping(self, craft, structure):
        """Values of the next report with this id."""
        import socket
        with socket.create_connection(("127.0.0.1", flight.PORT), 5.0) as link:
            link.settimeout(5.0)
            stream = link.makefile("rb")
            while True:
                head = stream.read(6)
                body = stream.read(struct.unpack(">H", head[4:6])[0] + 1)
                apid = struct.unpack(">H", head[:2])[0] & 0x7FF
                # version and status, service, subtype, counter u16, destination u16, time of 7 octets
                if apid == HELLO and body[1:3] == bytes([3, 25]) and struct.unpack(">H", body[14:16])[0] == structure:
                    return body[16:-2]


if __name__ == "__main__":
    flight.main()
