#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Another version of a subsystem is put in its place in flight (docs/adr/0089) while a peer cycles at 2 kHz: on trial, back by itself
when it is not confirmed or dies, kept when it is confirmed, taken back by command; one that the manifest does not list is refused. What
its descriptor says more comes with it, is used, and goes with it (docs/adr/0214)."""
import hashlib
import os
import pathlib
import shutil
import signal
import struct
import sys
import tempfile
import time
import unittest

import flight
import missed

PROGRAM = "hirosco-test-pilot"    # nowhere else in PATH
PILOT = 8
EXCHANGES_S = 4.5                 # what they take together
PEER = "memfd:hirosco-hello (deleted)"     # started as the manifest has it
STILL_S = 0.020                   # of a peer that is stopped to be seen: far from a hang
# What the next version has, each by where it goes: behind the parameters that were there, all else where it likes.
ADDITIONS = (
    ('<ParamRef name="DES_POSITION" id="1" type="DOUBLE" unit="rad" init="0.3"/>',
     '\n    <ParamRef name="SPEED" id="2" type="DOUBLE" unit="rad/s" init="0.2" minimum="0" maximum="1"/>'),
    ("<FunctionService>", '<Function name="TURN_AT" states="Operational"><Argument name="SPEED" of="SPEED"/></Function>'),
    ('<Configuration name="STAND_ALONE" id="1" priority="80" sampling_us="500" budget_us="50">',
     '<HKService id="4712" interval="200"><SampledOnce><ParamRef name="SPEED"/></SampledOnce></HKService>'))
EVENT = ('<EventService><Event name="SPEED_SET" id="1" severity="info"><Argument name="SPEED" type="DOUBLE" unit="rad/s"/></Event>'
         '</EventService>')


class Craft:
    """The mission hello with a second hello, PILOT, which is a program of its own and stays Offline."""

    def __init__(self, folder, descriptor="hello.xml"):
        self.folder = pathlib.Path(folder)
        for part in ("missions/hello", "subsystems/hello", "subsystems/communication", "supervisor"):
            for file in (flight.REPOSITORY / part).glob("*.xml"):
                copy = self.folder / file.relative_to(flight.REPOSITORY)
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(file.read_text())
        self.descriptor = self.folder / "subsystems/hello" / descriptor
        if not self.descriptor.exists():
            shutil.copy(self.folder / "subsystems/hello/hello.xml", self.descriptor)
        self.programs = self.folder / "programs"
        self.programs.mkdir()
        self.mission = self.folder / "missions/hello/mission.xml"
        text = self.mission.read_text()
        text = text.replace("<Modes", '<Manifest path="manifest.sha256"/>\n  '
                            f'<Subsystem executable="{PROGRAM}" descriptor="../../subsystems/hello/{descriptor}" name="PILOT" '
                            f'id="{PILOT}"/>\n  <Modes', 1)
        text = text.replace('functions="SET_MODE SHUTDOWN"/>', 'functions="SET_MODE SHUTDOWN REPLACE CONFIRM TAKE_BACK REREAD"/>\n'
                            '      <Permit subsystem="PILOT" functions="*"/>')
        self.mission.write_text(text)
        self.manifest = self.mission.parent / "manifest.sha256"
        self.manifest.write_text("")
        for name in ("hirosco-communication", "hirosco-hello"):
            self.list(flight.BINARIES / name, name)
        shutil.copy(flight.BINARIES / "hirosco-hello", self.programs / PROGRAM)
        self.list(self.programs / PROGRAM, PROGRAM)

    def list(self, file, name):
        with self.manifest.open("a") as lines:
            lines.write(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {name}\n")

    def add(self, version, octets=None, listed=True):
        """The same program with another digest, or another one."""
        file = self.programs / f"{PROGRAM}@{version}"
        file.write_bytes(octets or (self.programs / PROGRAM).read_bytes() + version.encode())
        file.chmod(0o755)
        if listed:
            self.list(file, file.name)


def with_additions(text):
    for place, addition in ADDITIONS:
        assert text.count(place) == 1, place
        text = text.replace(place, place + addition)
    assert text.count("<EventService/>") == 1
    return text.replace("<EventService/>", EVENT)


def runs(craft):
    """The one program of PILOT that runs."""
    name, = (name for name in craft.processes().values() if PROGRAM in name)
    return name.removeprefix(f"memfd:{PROGRAM}").removesuffix(" (deleted)")


def peer(craft):
    status = craft.wait_status(lambda _: True, 5.0)
    return next(member for member in status["subsystems"] if member["name"] == "HELLO")


class Versions(unittest.TestCase):
    def runs(self, craft, version):
        self.assertEqual(runs(craft), version)

    def test_versions_come_and_go_while_a_peer_cycles(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-versions-") as folder:
            files = Craft(folder)
            with flight.Flight(mission=files.mission,
                               environment={"PATH": f"{files.programs}:{os.environ['PATH']}"}) as craft:
                craft.wait_told("commissioned: mode operation", 20.0)
                pid = craft.pid_of(PEER)
                with missed.Missed(pid) as before:
                    time.sleep(EXCHANGES_S)
                begin = craft.count()
                self.runs(craft, "")
                with missed.Missed(pid) as during:
                    for exchange in (self.comes_back_unless_it_is_confirmed, self.stays_when_it_is_confirmed_and_is_taken_back_by_command,
                                     self.falls_back_when_it_dies, self.is_refused):
                        exchange(craft, files)
                        self.peer_cycles_on(craft, begin)
                flight.measure(f"cycles that the peer missed in a row by itself at 2 kHz: {during.in_a_row} at most during all of it, {before.in_a_row} before, where "
                               f"{during.limit(files.descriptor)} end it; all that it missed, with the pauses of its processor: {sum(many for _, many in during.rows)} in "
                               f"{len(during.pauses)} pauses, before {sum(many for _, many in before.rows)} in {len(before.pauses)}")
                self.misses_fewer_in_a_row_than_end_it(during, files.descriptor)
                self.assertEqual(craft.end(), 0, craft.errors)

    def misses_fewer_in_a_row_than_end_it(self, during, descriptor):
        self.assertLess(during.in_a_row, during.limit(descriptor), f"missed {during.rows}, while its processor stood still {during.pauses}")

    def test_a_peer_that_stands_still_meanwhile_is_seen(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-versions-") as folder:
            files = Craft(folder)
            with flight.Flight(mission=files.mission, environment={"PATH": f"{files.programs}:{os.environ['PATH']}"}) as craft:
                craft.wait_told("commissioned: mode operation", 20.0)
                pid = craft.pid_of(PEER)
                with missed.Missed(pid) as still:
                    os.kill(pid, signal.SIGSTOP)
                    time.sleep(STILL_S)
                    os.kill(pid, signal.SIGCONT)
                    time.sleep(STILL_S)
                with self.assertRaises(AssertionError):
                    self.misses_fewer_in_a_row_than_end_it(still, files.descriptor)
                craft.end()

    def test_what_its_processor_did_for_nobody_is_not_missed_by_a_peer(self):
        rows = [(1.0, 2), (2.0, 5)]
        self.assertEqual(missed.in_a_row(rows, [], 0.0005), 5)
        self.assertEqual(missed.in_a_row(rows, [(1.9985, 2.0)], 0.0005), 2)
        self.assertEqual(missed.in_a_row(rows, [(1.5, 1.9), (2.1, 2.2)], 0.0005), 5, "another pause is none of it")

    def peer_cycles_on(self, craft, begin):
        """As before, and nothing was told of it since, by itself or by who watches it, but that the machine was late."""
        now = peer(craft)
        self.assertEqual(now["state"], "Operational", now)
        self.assertGreater(peer(craft)["cycles"], now["cycles"])
        told = [line.told for line in craft.told(begin) if "HELLO" in line.told and "CYCLE_OVER_BUDGET" not in line.told]
        self.assertEqual(told, [])

    def comes_back_unless_it_is_confirmed(self, craft, files):
        files.add("2")
        begin = craft.count()
        self.assertEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "2", 3)[0], 0)
        craft.wait_told("PILOT runs version 2: CONFIRM within 3 s keeps it", start=begin)
        self.runs(craft, "@2")
        craft.wait_told("PILOT was not confirmed as version 2 in its time", start=begin)
        craft.wait_told("PILOT runs the mission's own version again", start=begin)
        self.runs(craft, "")

    def stays_when_it_is_confirmed_and_is_taken_back_by_command(self, craft, files):
        files.add("3")
        begin = craft.count()
        self.assertEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "3", 30)[0], 0)
        for function, argument in (("SET_STATE", 3), ("CONFIGURE", 1), ("SET_STATE", 4), ("SET_STATE", 5)):
            self.assertEqual(craft.tc("PILOT", function, argument)[0], 0, (function, argument))
        self.assertEqual(craft.tc("SUPERVISOR", "CONFIRM", PILOT)[0], 0)
        craft.wait_told("PILOT stays version 3: confirmed", start=begin)
        self.assertNotEqual(craft.tc("SUPERVISOR", "TAKE_BACK", PILOT)[0], 0, "it is Operational")
        self.assertNotEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "2", 30)[0], 0, "it is Operational")
        for state in (4, 7, 0):
            self.assertEqual(craft.tc("PILOT", "SET_STATE", state)[0], 0, state)
        self.assertEqual(craft.tc("SUPERVISOR", "TAKE_BACK", PILOT)[0], 0)
        craft.wait_told("PILOT runs the mission's own version again", start=begin)
        self.runs(craft, "")

    def falls_back_when_it_dies(self, craft, files):
        files.add("bad", b"#!/bin/sh\nexit 3\n")
        begin = craft.count()
        craft.tc("SUPERVISOR", "REPLACE", PILOT, "bad", 30)
        craft.wait_told("not all of PILOT is in the manifest: it is a script", start=begin)
        craft.wait_told("PILOT died as version bad, which was not confirmed", start=begin)
        craft.wait_told("PILOT runs the mission's own version again", start=begin)
        self.runs(craft, "")

    def is_refused(self, craft, files):
        files.add("4", listed=False)
        begin = craft.count()
        self.assertNotEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "4", 30)[0], 0)
        craft.wait_told(f"PILOT stays the mission's own version: {PROGRAM}@4 is not in the manifest", start=begin)
        files.add("5")
        (files.programs / f"{PROGRAM}@5").write_bytes(b"#!/bin/sh\nexit 3\n")
        self.assertNotEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "5", 30)[0], 0)
        craft.wait_told(f"{PROGRAM}@5 has the SHA-256 {hashlib.sha256(b'#!/bin/sh' + bytes([10]) + b'exit 3' + bytes([10])).hexdigest()}",
                        start=begin)
        self.runs(craft, "")


class Additions(unittest.TestCase):
    def do(self, craft, subsystem, function, *arguments):
        code, _ = craft.tc(subsystem, function, *arguments)
        self.assertEqual(code, 0, (subsystem, function, arguments, craft.answers))

    def up(self, craft, behind=0):
        for function, argument in (("SET_STATE", 3), ("CONFIGURE", 1), ("SET_STATE", 4), ("SET_STATE", 5)):
            if (function, argument) != ("SET_STATE", behind):
                self.do(craft, "PILOT", function, argument)

    def down(self, craft):
        for state in (4, 7, 0):
            self.do(craft, "PILOT", "SET_STATE", state)

    def test_what_a_version_adds_comes_is_used_and_goes_with_it(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-additions-") as folder:
            files = Craft(folder, "pilot.xml")
            before = files.descriptor.read_text()
            more = with_additions(before)
            files.add("more", (flight.BINARIES / "hirosco-with-more").read_bytes())
            with flight.Flight(mission=files.mission,
                               environment={"PATH": f"{files.programs}:{os.environ['PATH']}"}) as craft:
                craft.wait_told("commissioned: mode operation", 20.0)
                cycles = peer(craft)["cycles"]
                self.is_told_the_way(craft, files, more)
                self.is_refused_as_a_whole(craft, files, more)
                self.comes_and_is_used(craft, files, more)
                self.is_taken_back(craft, before, files)
                self.goes_back_when_the_supervisor_dies(craft, files, more)
                self.assertEqual(peer(craft)["state"], "Operational")
                self.assertGreater(peer(craft)["cycles"], cycles)
                craft.end()

    def is_told_the_way(self, craft, files, more):
        files.descriptor.write_text(more)
        begin = craft.count()
        self.assertNotEqual(craft.tc("SUPERVISOR", "REREAD", PILOT)[0], 0)
        craft.wait_told("parameter SPEED is new: not by REREAD (a program has to have it: REPLACE starts one", start=begin)
        craft.wait_told("function TURN_AT is new: not by REREAD", start=begin)
        craft.wait_told("event SPEED_SET is new: not by REREAD", start=begin)

    def is_refused_as_a_whole(self, craft, files, more):
        """Something of it is no addition: neither the text nor the program is taken."""
        files.descriptor.write_text(more.replace('name="DES_POSITION" id="1"', 'name="DES_POSITION" id="3"'))
        begin = craft.count()
        self.assertNotEqual(craft.tc("SUPERVISOR", "REPLACE", PILOT, "more", 60)[0], 0)
        craft.wait_told("parameter DES_POSITION: its id cannot change in flight", start=begin)
        craft.wait_told("PILOT keeps its descriptor", start=begin)
        self.assertEqual(runs(craft), "")

    def comes_and_is_used(self, craft, files, more):
        files.descriptor.write_text(more)
        begin = craft.count()
        self.do(craft, "SUPERVISOR", "REPLACE", PILOT, "more", 60)
        craft.wait_told("of PILOT parameter SPEED is new, event SPEED_SET is new, function TURN_AT is new: hirosco tc", start=begin)
        craft.wait_told("PILOT runs version more: CONFIRM within 60 s keeps it", start=begin)
        self.assertEqual(runs(craft), "@more")
        self.assertNotEqual(craft.tc("SUPERVISOR", "REREAD", PILOT)[0], 0, "it is on trial with its text")
        with flight.Telemetry() as ground:
            self.up(craft)
            self.do(craft, "PILOT", "TURN_AT", 0.5)
            self.wait_report(ground, 5, 1, struct.pack(">Hd", 1, 0.5))
            self.wait_report(ground, 3, 25, struct.pack(">Hd", 4712, 0.5))
        self.do(craft, "SUPERVISOR", "CONFIRM", PILOT)

    def is_taken_back(self, craft, before, files):
        self.down(craft)
        begin = craft.count()
        self.do(craft, "SUPERVISOR", "TAKE_BACK", PILOT)
        craft.wait_told("PILOT flies by the text before", start=begin)
        craft.wait_told("PILOT runs the mission's own version again", start=begin)
        self.assertEqual(runs(craft), "")
        with flight.Telemetry() as ground:
            self.up(craft)
            # The file has it still, and so has who reads it: who refuses is the craft.
            self.assertNotEqual(craft.tc("PILOT", "TURN_AT", 0.5)[0], 0)
            self.do(craft, "PILOT", "MOVE_TO", 0.1)
            self.wait_report(ground, 3, 25, struct.pack(">H", 4711))
            self.assertEqual([r for r in ground.reports if r.apid == PILOT and r.service == 3 and r.data[:2] == struct.pack(">H", 4712)], [])
        self.down(craft)
        files.descriptor.write_text(before)

    def goes_back_when_the_supervisor_dies(self, craft, files, more):
        files.descriptor.write_text(more)
        begin = craft.count()
        self.do(craft, "SUPERVISOR", "REPLACE", PILOT, "more", 600)
        craft.wait_told("PILOT runs version more", start=begin)
        craft.kill("hirosco-supervisor")
        craft.wait_told("this supervisor goes on for one that died", start=begin)
        craft.wait_told("PILOT flies by the text before", 20.0, begin)
        craft.wait_told("PILOT runs the mission's own version again", 20.0, begin)
        self.assertEqual(runs(craft), "")
        # Behind a supervisor's death what is said may be refused as said before a stop: it is said again.
        if "1,2" in craft.tc("PILOT", "SET_STATE", 3)[1]:
            print(f"said again: {craft.answers}", file=sys.stderr)
            self.do(craft, "PILOT", "SET_STATE", 3)
        self.up(craft, behind=3)
        self.do(craft, "PILOT", "MOVE_TO", 0.2)
        self.down(craft)

    def wait_report(self, ground, service, subtype, data, seconds=10.0):
        """Of PILOT, that begins so."""
        end = time.monotonic() + seconds
        while not any((r.apid, r.service, r.subtype) == (PILOT, service, subtype) and r.data.startswith(data) for r in list(ground.reports)):
            self.assertLess(time.monotonic(), end, f"no TM[{service},{subtype}] {data.hex()}")
            time.sleep(0.05)


if __name__ == "__main__":
    flight.main()
