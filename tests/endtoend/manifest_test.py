#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What may be started stands in the mission's manifest (docs/adr/0089): in a flight of real processes a program that was exchanged
is not started, one that was exchanged after the flight began does not matter, and one that is not in the start list is started."""
import contextlib
import hashlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import flight

PROGRAM = "hirosco-test-pilot"    # nowhere else in PATH


@contextlib.contextmanager
def mission_with(start=""):
    """The mission hello whose HELLO is a program of its own; yields the mission's file and that program's."""
    with tempfile.TemporaryDirectory(prefix="hirosco-manifest-") as name:
        folder = pathlib.Path(name)
        for part in ("missions/hello", "subsystems/hello", "subsystems/communication", "supervisor"):
            for file in (flight.REPOSITORY / part).glob("*.xml"):
                copy = folder / file.relative_to(flight.REPOSITORY)
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(file.read_text())
        programs = folder / "programs"
        programs.mkdir()
        shutil.copy(flight.BINARIES / "hirosco-hello", programs / PROGRAM)
        mission = folder / "missions/hello/mission.xml"
        text = mission.read_text().replace('"hirosco-hello"', f'"{PROGRAM}"{start}', 1)
        text = text.replace("<Modes", '<Manifest path="manifest.sha256"/>\n  <Modes', 1)
        if start:
            text = re.sub(r' *<Commission subsystem="HELLO".*\n', "", text)
        mission.write_text(text)
        lines = [f"{hashlib.sha256((flight.BINARIES / 'hirosco-communication').read_bytes()).hexdigest()}  hirosco-communication",
                 f"{hashlib.sha256((programs / PROGRAM).read_bytes()).hexdigest()}  {PROGRAM}"]
        (mission.parent / "manifest.sha256").write_text("\n".join(lines) + "\n")
        yield mission, programs / PROGRAM


def path_to(program):
    return {"PATH": f"{program.parent}:{os.environ['PATH']}"}


@contextlib.contextmanager
def craft(start=""):
    with mission_with(start) as (mission, program), flight.Flight(mission=mission, environment=path_to(program)) as hello:
        yield hello, program


def exchange(program):
    """The same program with one octet more, which it does not mind: only its digest is another one. Put there as a new file."""
    other = program.with_suffix(".new")
    other.write_bytes(program.read_bytes() + b"\0")
    other.chmod(0o755)
    other.rename(program)
    return hashlib.sha256(program.read_bytes()).hexdigest()


class Manifest(unittest.TestCase):
    def test_who_crashed_is_what_was_checked_before_the_flight_whatever_became_of_the_file(self):
        with craft() as (hello, program):
            hello.wait_told("commissioned: mode operation", 20.0)
            line = hello.wait_told("executables of")
            flight.measure(line.told)
            exchange(program)
            pid, = [pid for pid, name in hello.processes().items() if PROGRAM in name]
            os.kill(pid, signal.SIGKILL)
            hello.wait_told("HELLO died: signal 9")
            before = hello.count()
            self.assertEqual(hello.tc("HELLO", "SET_STATE", 0)[0], 0, "from memory, which nobody can change")
            hello.wait_told("started HELLO", start=before)
            self.assertEqual(hello.end(), 5, "a reaction of high severity that no fault of a device had caused")

    def test_the_supervisor_itself_refuses_what_was_exchanged(self):
        """`hirosco run` would not begin with it: this is the supervisor alone, as for a file exchanged between the two."""
        with mission_with() as (mission, program):
            right = hashlib.sha256(program.read_bytes()).hexdigest()
            wrong = exchange(program)
            supervisor = subprocess.Popen([flight.BINARIES / "hirosco-supervisor", "--mission", mission, "--json"],
                                          cwd=mission.parent, env={**os.environ, **path_to(program)},
                                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
            try:
                told = next(line for line in supervisor.stdout if "cannot start HELLO" in line)
                self.assertIn(f"has the SHA-256 {wrong}, the manifest says {right}", told)
            finally:
                supervisor.terminate()
                supervisor.communicate(timeout=20)

    def test_one_that_is_not_in_the_start_list_is_started_when_asked(self):
        with craft(start=' start="no"') as (hello, program):
            hello.wait_told("HELLO is not started with the flight: SET_STATE Offline starts it")
            hello.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(hello.tc("HELLO", "SET_STATE", 0)[0], 0)
            hello.wait_told("started HELLO")
            for function, argument in (("SET_STATE", 3), ("CONFIGURE", 1), ("SET_STATE", 4), ("SET_STATE", 5)):
                self.assertEqual(hello.tc("HELLO", function, argument)[0], 0, (function, argument))
            self.assertEqual(hello.end(), 0, hello.errors)


if __name__ == "__main__":
    flight.main()
