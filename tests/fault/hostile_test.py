#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A subsystem that turns on its supervisor while its robot pushes: it can change nothing that gates it, and where it looks
away, makes a permission of its own and hears nothing any more, the robot is stopped without it (hazard SF13)."""
import pathlib
import signal
import time
import unittest

import flight

HOSTILE = "hirosco-hostile-manipulator"
ORPHANS_GONE_S = 12.0           # the keeper's patience, the grace of orphans that do not end themselves, and their end


class Hostile(unittest.TestCase):
    def fly(self):
        return flight.MissionCopy({"hirosco-manipulator": HOSTILE})

    def push(self, craft):
        """The robot pushes on the rail; that does not pass by itself."""
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")

    def turn(self, craft):
        """It turns; the lines of what it has tried."""
        craft.kill(HOSTILE, signal.SIGUSR2)
        process = craft.pid_of(HOSTILE)
        end = time.monotonic() + 15.0
        while not self.memory_of(process, "hostile-done"):
            self.assertLess(time.monotonic(), end, "it has made its attempts")
            time.sleep(0.01)
        return self.memory_of(process, "hostile-report").read_text().splitlines()

    def memory_of(self, process, name):
        """A piece of memory that it has made, as a file; none while it has not."""
        for entry in pathlib.Path(f"/proc/{process}/fd").iterdir():
            try:
                if f"memfd:{name} " in str(entry.readlink()):
                    return entry
            except OSError:
                pass                       # closed in between
        return None

    def assert_nothing_was_changed(self, craft, lines):
        flight.measure(f"{len(lines) - 1} attempts on pages and links of others")
        self.assertGreaterEqual(len([line for line in lines if line.startswith("hirosco-permit")]), 12)
        self.assertGreaterEqual(len([line for line in lines if line.startswith("others: ")]), 12)
        for what, how_many in (("inhibits", 2), ("frames", 1)):     # inhibits of its own device and another's; frames of another's
            found = [line.split()[2].rstrip(":") for line in lines if line.startswith(f"{what}: open ")]
            self.assertEqual([path for path in found if pathlib.Path(path).is_file()], found, "there to be opened")
            self.assertEqual(len(found), how_many, what)
        for tried in ("connect to the ground's telecommand port", "send a datagram"):
            self.assertIn(f"inhibits: {tried}: refused", lines)
        done = ["own frames: DONE", "look-alike: DONE"]
        # Root in a container that may not limit whom it starts says so at the start (docs/adr/0146).
        if any("every real-time priority is open" in line.told for line in craft.told()):
            done.insert(0, "others: before the keeper: DONE")
        self.assertEqual([line for line in lines if not line.endswith(": refused")], done)
        end = time.monotonic() + 5.0        # what it says goes by another thread of this test than what it did
        while not any("the sandbox refuses system call 101 ptrace" in text for text in craft.errors):
            self.assertLess(time.monotonic(), end, craft.errors)
            time.sleep(0.01)
        self.assertEqual(craft.tc("supervisor", "ping")[0], 0)
        self.assertEqual(craft.tc("joystick", "ping")[0], 0)

    def test_a_stop_reaches_the_robot_of_a_subsystem_that_permits_itself_and_does_not_listen(self):
        with self.fly() as mission, flight.Flight(mission) as craft:
            craft.wait_commissioned()
            self.push(craft)
            self.turns_and_is_stopped(craft, pushing=True)
            self.bring_up(craft)
            # The page of a process that was started again is as good as the first.
            self.turns_and_is_stopped(craft, pushing=False)

    def turns_and_is_stopped(self, craft, pushing):
        begin = craft.count()
        self.assert_nothing_was_changed(craft, self.turn(craft))
        if pushing:
            self.assertGreater(craft.truth("robot")["force"], 20.0, "it pushes on, as nobody stopped it")
        asked = time.monotonic()
        done = craft.hirosco("safe")
        craft.wait_at_rest("robot", asked)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, "ROBOT stopped .*says the device")
        # It does not see what it is told: it looks at a page of its own.
        craft.wait_told("MANIPULATOR hangs: its vital or permit page is damaged", 3.0, begin)
        craft.wait_told("MANIPULATOR died: signal 9", 3.0, begin)
        craft.wait_told("started MANIPULATOR", 3.0, begin)
        craft.wait_at_rest("robot", asked)

    def test_without_a_supervisor_its_robot_stops_too_and_it_is_no_orphan(self):
        with self.fly() as mission, flight.Flight(mission) as craft:
            craft.wait_commissioned()
            self.push(craft)
            self.assert_nothing_was_changed(craft, self.turn(craft))
            craft.process.send_signal(signal.SIGSTOP)  # or another supervisor would go on
            killed = craft.kill("hirosco-supervisor")
            craft.wait_at_rest("robot", killed)
            craft.process.send_signal(signal.SIGCONT)
            # Each that goes on dies young, until nobody does any more.
            while craft.process.poll() is None and time.monotonic() < killed + ORPHANS_GONE_S:
                if any(name == "hirosco-supervisor" for name in craft.processes().values()):
                    craft.kill("hirosco-supervisor")
                time.sleep(0.02)
            self.assertEqual(craft.wait_until_gone(ORPHANS_GONE_S), {})
            flight.measure(f"everything of the flight gone {time.monotonic() - killed:.1f} s after its first supervisor was killed")
            self.assertEqual(craft.process.wait(5.0), 4)
            with flight.Flight(mission, folder=craft.folder) as again:
                again.wait_commissioned()
                self.push(again)

    def bring_up(self, craft):
        time.sleep(0.5)
        craft.bring_up(lambda *words: self.do(craft, *words))

    def do(self, craft, subsystem, function, *arguments):
        code, reports = craft.tc(subsystem, function, *arguments)
        self.assertEqual(code, 0, f"{subsystem} {function} {arguments}: {reports}")


if __name__ == "__main__":
    flight.main()
