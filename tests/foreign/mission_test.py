# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Subsystems in Python and C fly beside those of the framework: they are commissioned, commanded, linked, killed and brought back. The metronome (Python)
produces what the joystick (C++) and the lantern (C) consume."""
import contextlib
import os
import pathlib
import platform
import select
import signal
import struct
import sys
import tempfile
import threading
import time
import unittest

import flight as flights
import honest
from flight import Flight

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "tools/conform")]
from partners import PlayedDevice           # noqa: E402
from suite_test import compiled             # noqa: E402

METRONOME, LANTERN, JOYSTICK = 60, 61, 11
INSTANCE = "foreign"          # so that it needs no port that another flight may have


class Lamp:
    """The lantern's device, for as long as the block lasts."""

    def __init__(self, folder):
        self.device, self.over = PlayedDevice("unix", str(folder / f"foreign-lamp.{INSTANCE}"), 4), threading.Event()
        self.thread = threading.Thread(target=self.play, daemon=True)

    def play(self):
        while not self.over.is_set():
            if select.select([self.device], [], [], 0.1)[0]:
                self.device.readable()

    def __enter__(self):
        self.thread.start()
        return self.device

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()
        self.device.close()


def mission_in(folder):
    """The mission beside descriptors of its own: the joystick is told from whom its set comes."""
    root = HERE.parents[1]
    joystick = (root / "subsystems/joystick/joystick.xml").read_text().replace('from="MANIPULATOR"', 'from="METRONOME"')
    (folder / "joystick.xml").write_text(joystick)
    for name in ("metronome.xml", "lantern.xml"):
        (folder / name).write_text((HERE / name).read_text())
    text = (HERE / "mission.xml").read_text().replace("../../subsystems/joystick/joystick.xml", "joystick.xml")
    (folder / "mission.xml").write_text(text)
    return folder / "mission.xml"


def pid_of(flight, word):
    """Of the process of the flight whose command has this word."""
    for pid in flights.marked_processes(flight.mark):
        with contextlib.suppress(OSError):
            command = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
            if any(part.endswith(word.encode()) for part in command[:2]):
                return pid
    return None


class Mission(unittest.TestCase):
    def wait(self, condition, seconds, words):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, f"{words} within {seconds} s")
            time.sleep(0.05)

    def swings(self, ground):
        """What the pendulum does reaches whom it is for: bits of it in C++ and in C change."""
        peers, seen = set(), set()
        for _ in range(4):
            peers.add(ground.fresh_housekeeping(JOYSTICK, 4721)[4 + 48:4 + 48 + 16])
            light = ground.fresh_housekeeping(LANTERN, 6110)
            seen.add(struct.unpack_from(">I", light, 4)[0])
        return len(peers) > 1 and len(seen) > 1

    def bring_back(self, flight, ground, word, subsystem):
        before, name = pid_of(flight, word), f"the {subsystem}"
        self.assertIsNotNone(before, word)
        start = flight.count()
        os.kill(before, signal.SIGKILL)
        killed = time.monotonic()
        flight.wait_told("died: signal 9", 10, start)
        self.wait(lambda: flight.tc(subsystem, "SET_STATE", 0)[0] == 0, 20, f"{name} does not answer again")
        # Started is told when the process exists; it bears its own name only when it has found its interpreter.
        self.wait(lambda: pid_of(flight, word) not in (None, before), 20, f"no new process of {name}")
        flights.measure(f"{name} was started again {time.monotonic() - killed:.2f} s after it was killed")
        done = None
        for _ in range(10):           # who is being recovered refuses for a moment
            done = flight.hirosco("mode", "swing", "--instance", INSTANCE, seconds=60)
            if done.returncode == 0:
                break
            time.sleep(1)
        self.assertEqual(done.returncode, 0, f"mode swing: {done.stdout}{done.stderr}\n{[l.told for l in flight.told(start)]}")
        self.wait(lambda: self.swings(ground), 20, f"the links are not back after {name} was killed")
        flights.measure(f"{name} brought the craft back into its mode after {time.monotonic() - killed:.1f} s")

    def is_in_a_sandbox(self, flight):
        """The script, too: by the filter of its calls that the kernel tells of (docs/adr/0210)."""
        self.assertFalse([line.told for line in flight.told() if "METRONOME is not isolated" in line.told])
        if platform.machine() == "x86_64" and os.environ.get("HIROSCO_SANDBOX") != "off":
            status = pathlib.Path(f"/proc/{pid_of(flight, 'metronome.py')}/status").read_text()
            self.assertIn("\nSeccomp:\t2\n", status)

    def test_a_subsystem_in_python_and_one_in_c_fly_beside_those_in_cpp(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-foreign-") as place:
            folder = pathlib.Path(place)
            compiled(str(HERE / "lantern.c"), place)
            # This interpreter, before a script of its name that starts one: such flies in no sandbox.
            path = f"{place}:{HERE}:{os.path.dirname(sys.executable)}:{os.environ['PATH']}"
            with Lamp(folder) as lamp, Flight(mission_in(folder), environment={"PATH": path}, folder=folder, instance=INSTANCE) as flight:
                flight.wait_told("commissioned: mode swing", 30)
                self.is_in_a_sandbox(flight)
                honest.TELEMETRY_PORT = int(flight.place()["telemetry"].rpartition(":")[2])
                ground = honest.Honest()
                self.wait(lambda: self.swings(ground), 20, "no set arrives")
                self.assertEqual(lamp.commands[-1][0], 1, "the lamp is commanded Active")
                # Commanded: done, refused for its range, refused for its state.
                self.assertEqual(flight.tc("metronome", "SET_TEMPO", 2.5)[0], 0)
                tempo = struct.unpack_from(">d", ground.fresh_housekeeping(METRONOME, 6010), 4 + 32 + 1)[0]
                self.assertEqual(tempo, 2.5)
                self.assertEqual(flight.tc("lantern", "FLASH", 3)[0], 0)
                self.assertNotEqual(flight.tc("metronome", "SET_STATE", 2)[0], 0)
                self.bring_back(flight, ground, "metronome.py", "metronome")
                self.bring_back(flight, ground, "lantern", "lantern")
                self.assertEqual(flight.tc("lantern", "FLASH", 1)[0], 0)
                # Everything stops: the lamp has its safe output, by its own cycle.
                begin = time.monotonic()
                flight.hirosco("safe", "--instance", INSTANCE, seconds=60)
                self.wait(lambda: lamp.commands[-1][0] != 1, 5, "the lamp is not safe")
                flights.measure(f"the lamp was safe {time.monotonic() - begin:.2f} s after `hirosco safe` was typed")
                # In order, but for the two deaths that nobody of the flight had caused (README.md).
                self.assertEqual(flight.end(), 5)
                ground.socket.close()


if __name__ == "__main__":
    flights.main()
