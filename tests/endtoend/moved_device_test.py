#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The device of a subsystem moves to another address in shared memory while the subsystem lives in its sandbox (docs/adr/0236): the same process
uses it there and lets go of the old place; what is wrong, or somebody else's, leaves the one before; so it is also for who goes on for a supervisor."""
import contextlib
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

import flight

JOYSTICK = 11
OFFLINE, PRE_OPERATIONAL, SAFE_OPERATIONAL = 0, 3, 4
COMMISSIONING, STANDALONE = 1, 1      # a mode, a configuration
MEMORY = pathlib.Path("/dev/shm/hirosco")
OLD, NEW = "joystick-handle", "joystick-handle-moved"
PROGRAM, DEVICE = "hirosco-joystick", "hirosco-sim-joystick"
PARTS = ("missions/rokviss", "subsystems/communication", "subsystems/manipulator", "subsystems/joystick", "supervisor")


def copy_of(folder):
    """The mission rokviss, its REREAD permitted, where it may be written."""
    for part in PARTS:
        shutil.copytree(flight.REPOSITORY / part, pathlib.Path(folder) / part)
    mission = pathlib.Path(folder) / "missions/rokviss/mission.xml"
    text = mission.read_text()
    mission.write_text(text.replace("CONFIGURE SET_MODE", "CONFIGURE REREAD SET_MODE", 1))
    return mission, pathlib.Path(folder) / "subsystems/joystick/joystick.xml"


@contextlib.contextmanager
def another_device(craft, folder):
    """The same device once more, at the new address. Nobody enables it."""
    words = pathlib.Path(f"/proc/{craft.pid_of(DEVICE)}/cmdline").read_bytes().decode().split("\0")[:-1]
    for option, value in (("--address", NEW), ("--enable-address", f"{NEW}-enable"), ("--control", f"{folder}/control")):
        words[words.index(option) + 1] = value
    with subprocess.Popen(words, stdin=subprocess.PIPE, cwd=folder) as process:
        try:
            yield process
        finally:
            process.stdin.close()         # by which it ends
            process.wait(10.0)


class MovedDevice(unittest.TestCase):
    def tearDown(self):
        with contextlib.suppress(OSError):
            (MEMORY / NEW).rmdir()

    def states(self, craft, *states):
        for state in states:
            code, reports = craft.tc("JOYSTICK", "SET_STATE", state)
            self.assertEqual(code, 0, f"{state}: {reports}")

    def reread(self, craft, text):
        self.descriptor.write_text(text)
        return craft.tc("SUPERVISOR", "REREAD", JOYSTICK)[0]

    def uses(self, process):
        """Addresses whose frames it has mapped."""
        lines = pathlib.Path(f"/proc/{process}/maps").read_text().splitlines()
        return {pathlib.Path(line.split()[5]).parent.name for line in lines if f"{MEMORY}/" in line and line.endswith("/frames")}

    def works_with(self, craft, process, address):
        """In Safe-Operational, which it reaches with a device that answers; and back."""
        self.assertEqual(craft.tc("JOYSTICK", "CONFIGURE", STANDALONE)[0], 0)
        self.states(craft, SAFE_OPERATIONAL)
        self.assertEqual(craft.pid_of(PROGRAM), process, "the same process")
        self.assertEqual(self.uses(process), {address})
        begin = craft.count()
        time.sleep(0.5)                   # silence of its device would take it out of the state
        self.assertEqual([line.told for line in craft.told(begin) if "JOYSTICK" in line.told], [])
        self.states(craft, OFFLINE, PRE_OPERATIONAL)
        self.assertEqual(self.uses(process), set())

    def spares(self, process):
        return sorted(path.name for path in pathlib.Path("/dev/shm").glob(f"hirosco-spare.{process}.*"))

    def test_the_same_process_uses_its_device_at_another_address_and_leaves_the_one_before(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-moved-") as folder, tempfile.TemporaryDirectory(prefix="hirosco-moved-ground-") as ground:
            mission, self.descriptor = copy_of(folder)
            ground_mission, _ = copy_of(ground)   # of whoever commands: what refuses is the craft
            shipped = self.descriptor.read_text()
            moved = shipped.replace(f'address="{OLD}"', f'address="{NEW}"')
            self.assertGreater(shipped.count(f'address="{OLD}"'), 1)
            with flight.Flight(mission=mission) as craft:
                craft.wait_commissioned()
                craft.mission = str(ground_mission)
                self.assertEqual(craft.tc("SUPERVISOR", "SET_MODE", COMMISSIONING)[0], 0)
                process = craft.pid_of(PROGRAM)
                self.states(craft, SAFE_OPERATIONAL, OFFLINE, PRE_OPERATIONAL)
                self.assertEqual(len(self.spares(process)), 1, "as many as it has addresses")
                let_in, before = self.node(f"/dev/shm/{self.spares(process)[0]}"), self.node(MEMORY / OLD)
                with another_device(craft, folder):
                    self.moves(craft, moved)
                    self.assertEqual(self.node(MEMORY / NEW), let_in)
                    self.assertNotEqual(self.node(MEMORY / OLD), before, "it would be let in to that one")
                    self.works_with(craft, process, NEW)

                    # What is wrong leaves it where it is.
                    self.keeps(craft, moved.replace(f'address="{NEW}"', 'address=""'), "joystick.xml:")
                    self.keeps(craft, moved.replace(f'transfer="shared_memory" address="{NEW}"', 'transfer="tcp" address="127.0.0.1:5999"'),
                               "JOYSTICK cannot reach TCP port 5999")
                    (MEMORY / f"{OLD}-shut").touch()
                    self.keeps(craft, moved.replace(f'address="{NEW}"', f'address="{OLD}-shut"'),
                               f"JOYSTICK cannot be let in to {MEMORY}/{OLD}-shut: a file or link stands where")
                    (MEMORY / f"{OLD}-shut").unlink()
                    self.works_with(craft, process, NEW)

                    # Who goes on for a supervisor knows where it is, and moves it back.
                    begin = craft.count()
                    craft.kill("hirosco-supervisor")
                    craft.wait_told("this supervisor goes on for one that died", 10.0, begin)
                    # What is sent between the two may end as one of which nobody knows.
                    craft.wait_told("SUPERVISOR info STATE_CHANGED STATE=Operational", 10.0, begin)
                    self.moves(craft, shipped)
                    self.works_with(craft, process, OLD)
                    self.assertEqual(len(self.spares(process)), 1)
                self.assertEqual(craft.end(), 0, craft.errors)
            self.assertEqual(self.spares(process), [], "they go with their process")

    def node(self, path):
        return pathlib.Path(path).stat().st_ino

    def moves(self, craft, text):
        begin = craft.count()
        self.assertEqual(self.reread(craft, text), 0, craft.answers)
        craft.wait_told("JOYSTICK flies by", 5.0, begin)

    def keeps(self, craft, text, why):
        begin = craft.count()
        self.assertNotEqual(self.reread(craft, text), 0)
        craft.wait_told(why, 5.0, begin)


if __name__ == "__main__":
    flight.main()
