#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A field more in a link comes with other versions of its ends, in flight (docs/adr/0236): the producer first, whose consumer goes on without
knowing it, then the consumer; the other way round it is refused by name, and so is the link where the producer has gone back alone."""
import os
import struct
import tempfile
import time
import unittest

import flight
import versions_test

PILOT, READER = versions_test.PILOT, 9
PROGRAM = "hirosco-test-reader"
PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL, POST_OPERATIONAL, OFFLINE = 3, 4, 5, 7, 0
SEEN = 4800
GOAL_RAD, TOLD_APART_RAD = 0.3, 10.0          # of hello at its begin; as reads_goal.cpp has it
PROVIDES = '<RealTimeLinkService><Provides name="TURN"><ParamRef name="CUR_VALUES.POSITION"/></Provides></RealTimeLinkService>'
REQUIRES = '<Field name="POSITION" type="DOUBLE" unit="rad"/>'
READER_XML = f"""<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="READER" id="{READER}">
  <Resources memory_kB="65536" shared_memory_kB="16384" threads="6" descriptors="64" processor_percent="50"/>
  <Parameters><ParamRef name="SEEN" id="1" type="DOUBLE" unit="rad"/></Parameters>
  <Configuration name="READING" id="1" priority="70" sampling_us="1000" budget_us="50">
    <FunctionService/><EventService/><TestService/>
    <HKService id="{SEEN}" interval="100"><SampledOnce><ParamRef name="SEEN"/></SampledOnce></HKService>
    <RealTimeLinkService><Requires name="TURN" from="PILOT" age="50" age_reduced="500" missing="hold">{REQUIRES}</Requires></RealTimeLinkService>
  </Configuration>
</Subsystem>
"""


class Craft(versions_test.Craft):
    """That of the versions, whose PILOT tells READER how it turns."""

    def __init__(self, folder):
        super().__init__(folder, "pilot.xml")
        text = self.descriptor.read_text()
        self.turning = text.replace("<TestService/>", "<TestService/>" + PROVIDES, 1)
        self.telling_more = self.turning.replace('<ParamRef name="CUR_VALUES.POSITION"/></Provides>',
                                                 '<ParamRef name="CUR_VALUES.POSITION"/><ParamRef name="DES_POSITION"/></Provides>')
        self.reading_more = READER_XML.replace(REQUIRES, REQUIRES + REQUIRES.replace("POSITION", "DES_POSITION"))
        assert len({text, self.turning, self.telling_more}) == 3 and self.reading_more != READER_XML
        self.descriptor.write_text(self.turning)
        self.reader = self.descriptor.parent / "reader.xml"
        self.reader.write_text(READER_XML)
        mission = self.mission.read_text()
        mission = mission.replace("<Modes", f'<Subsystem executable="{PROGRAM}" descriptor="../../subsystems/hello/reader.xml"/>\n'
                                  '  <Links><Link id="1" from="PILOT.TURN" to="READER.TURN"/></Links>\n  <Modes', 1)
        mission = mission.replace("REPLACE CONFIRM", "LINK UNLINK REPLACE CONFIRM", 1)
        mission = mission.replace('<Permit subsystem="PILOT" functions="*"/>',
                                  '<Permit subsystem="PILOT" functions="*"/><Permit subsystem="READER" functions="*"/>')
        self.mission.write_text(mission)
        for version, program in (("", "hirosco-reads-position"), ("@goal", "hirosco-reads-goal")):
            file = self.programs / (PROGRAM + version)
            file.write_bytes((flight.BINARIES / program).read_bytes())
            file.chmod(0o755)
            self.list(file, file.name)
        self.add("more")


class LinkVersions(unittest.TestCase):
    def do(self, *words):
        code, _ = self.craft.tc(*words)
        self.assertEqual(code, 0, (words, self.craft.answers))

    def refuses(self, why, *words):
        begin = self.craft.count()
        self.assertNotEqual(self.craft.tc(*words)[0], 0, words)
        self.craft.wait_told(why, 5.0, begin)

    def to(self, *states):
        for state in states:
            for name in ("PILOT", "READER"):
                self.do(name, "SET_STATE", state)

    def configured(self):
        self.to(PRE_OPERATIONAL)
        for name in ("PILOT", "READER"):
            self.do(name, "CONFIGURE", 1)

    def sees(self, wanted_rad):
        """Over the link, from its begin to Offline."""
        self.configured()
        self.do("SUPERVISOR", "LINK", 1)
        self.to(SAFE_OPERATIONAL, OPERATIONAL)
        with flight.Telemetry() as ground:
            end, seen = time.monotonic() + 10.0, []
            while not seen or abs(seen[-1] - wanted_rad) > 1e-6:
                self.assertLess(time.monotonic(), end, f"{seen[-3:]} and not {wanted_rad}")
                time.sleep(0.05)
                seen = [struct.unpack(">d", report.data[2:])[0] for report in list(ground.reports)
                        if (report.apid, report.service, report.subtype) == (READER, 3, 25) and report.data[:2] == struct.pack(">H", SEEN)]
        self.to(SAFE_OPERATIONAL, POST_OPERATIONAL, OFFLINE)

    def replace(self, apid, version, told):
        begin = self.craft.count()
        self.do("SUPERVISOR", "REPLACE", apid, version, 60)
        self.craft.wait_told(told, 10.0, begin)
        self.do("SUPERVISOR", "CONFIRM", apid)

    def test_a_field_of_a_link_comes_with_its_ends_one_after_the_other(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-link-versions-") as folder, \
                tempfile.TemporaryDirectory(prefix="hirosco-link-versions-ground-") as ground:
            files, of_ground = Craft(folder), Craft(ground)   # of whoever commands: what refuses is the craft
            with flight.Flight(mission=files.mission, environment={"PATH": f"{files.programs}:{os.environ['PATH']}"}) as self.craft:
                self.craft.wait_told("commissioned: mode operation", 20.0)
                self.craft.mission = str(of_ground.mission)
                self.sees(GOAL_RAD)

                # Who reads what nobody provides is refused, with the field named.
                files.reader.write_text(files.reading_more)
                self.refuses("DES_POSITION", "SUPERVISOR", "REPLACE", READER, "goal", 60)
                files.reader.write_text(READER_XML)
                files.descriptor.write_text(files.telling_more)
                self.refuses("provided set TURN: field DES_POSITION is new: not by REREAD", "SUPERVISOR", "REREAD", PILOT)

                self.replace(PILOT, "more", "of PILOT configuration STAND_ALONE: provided set TURN: field DES_POSITION is new: hirosco tc")
                self.sees(GOAL_RAD)           # who does not ask for it reads on
                files.reader.write_text(files.reading_more)
                self.replace(READER, "goal", "of READER configuration READING: required set TURN: field DES_POSITION is new: hirosco tc")
                self.sees(GOAL_RAD + TOLD_APART_RAD)

                # Back alone, the producer is not read, and says by whom.
                begin = self.craft.count()
                self.do("SUPERVISOR", "TAKE_BACK", PILOT)
                self.craft.wait_told("READER reads DES_POSITION of PILOT.TURN (link 1), which it provides no more", 10.0, begin)
                self.craft.wait_told("PILOT runs the mission's own version again", 10.0, begin)
                self.configured()
                self.refuses("DES_POSITION", "SUPERVISOR", "LINK", 1)
                self.to(OFFLINE)
                self.do("SUPERVISOR", "TAKE_BACK", READER)
                self.craft.wait_told("READER runs the mission's own version again", 10.0, begin)
                self.sees(GOAL_RAD)
                self.assertEqual(self.craft.end(), 0, self.craft.errors)


if __name__ == "__main__":
    flight.main()
