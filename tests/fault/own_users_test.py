#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each subsystem of a mission is a user of its own (docs/adr/0177): whoever is one of them gets at nothing of another, whatever its sandbox, and
guard, supervisor and keeper stop and end all of them as ever."""
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import time
import unittest

import flight
import ordinary_user

FIRST, LAST = 60600, 60699
RELAY, ROBOT, STICK = 60600, 60601, 60602       # in the order of the mission
WITHOUT_RIGHT = ("setpriv", "--bounding-set=-kill", "--inh-caps=-kill")
UNPROVOKED = (0, 5)                              # 5: a reaction that no fault of the flight's own had caused
ORPHANS_GONE_S = 15.0                            # those of a supervisor that was killed while it ended: 5 s of grace, and their end

KINDS = {"signal": lambda pid: os.kill(pid, 0), "open": lambda path: os.close(os.open(path, os.O_RDWR)),
         "read": lambda path: os.close(os.open(path, os.O_RDONLY)), "make": os.mkdir, "list": os.listdir}


def connect(path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as one:
        one.connect(str(path))


def came_of(kind, at):
    try:
        (connect if kind == "connect" else KINDS[kind])(at)
        return "done"
    except PermissionError:
        return "refused"


def tries(user, *attempts):
    """What comes of each (kind, at) where this user tries it, of no group but its own: "done", "refused", or what else there was. Without
    a program, which the user might not be able to read."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        told = "cannot be this user"
        try:
            os.setgroups([])
            os.setresgid(user, user, user)
            os.setresuid(user, user, user)
            told = "\n".join(came_of(*attempt) for attempt in attempts)
        except OSError as problem:
            told = str(problem)
        finally:
            os.write(writing, told.encode())
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as answer:
        lines = answer.read().splitlines()
    os.waitpid(child, 0)
    return lines


def numbers(pid, word):
    """Of a line of its status."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith(word + ":"):
            return [int(number) for number in line.split()[1:]]
    raise AssertionError(f"{pid}: no {word}")


def processes_of(first, last=None):
    """Of the users with these numbers. Not by their environment, which others need a right to read."""
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        if folder.name.isdigit():
            with contextlib.suppress(OSError, AssertionError):
                if first <= numbers(folder.name, "Uid")[0] <= (last or first):
                    found.append(int(folder.name))
    return found


class OwnUsers(unittest.TestCase):
    @contextlib.contextmanager
    def mission(self):
        """Arguments of a flight; the joystick's device is reached by a UNIX socket."""
        with ordinary_user.open_to_all() as arguments:
            home = arguments["binaries"].parent
            self.socket = arguments["folder"] / "joystick-handle/socket"
            text = arguments["mission"].read_text()
            arguments["mission"].write_text(text.replace("  <Power budget_W", f'  <Isolation users="{FIRST}-{LAST}"/>\n  <Power budget_W', 1))
            stick = home / "subsystems/joystick/joystick.xml"
            text, replaced = re.subn(r'transfer="shared_memory" address="joystick-handle"', 'transfer="unix" address="joystick-handle"',
                                     stick.read_text())
            self.assertGreater(replaced, 0)
            stick.write_text(text)
            yield arguments

    def process_of(self, user):
        found = processes_of(user)
        self.assertEqual(len(found), 1, f"processes of user {user}")
        return found[0]

    def stops_all(self, craft):
        asked = time.monotonic()
        done = craft.hirosco("safe")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        craft.wait_at_rest("robot", asked)
        return [line for line in done.stdout.splitlines() if "says the device" in line]

    def ends_clean(self, craft, codes=(0,)):
        self.assertIn(craft.end(), codes, "\n".join(craft.errors))
        self.assertEqual(processes_of(FIRST, LAST), [])
        for folder in (pathlib.Path("/dev/shm/hirosco/manipulator-robot"), self.socket.parent):
            self.assertFalse(folder.exists(), "a folder that nobody else is let into goes")

    def test_nobody_gets_at_another_and_all_are_stopped_and_end_and_fly_again(self):
        with self.mission() as arguments:
            with flight.Flight(**arguments) as craft:
                craft.wait_commissioned()
                self.each_is_a_user(craft)
                self.nobody_gets_at_another(craft)
                self.assertFalse([line.told for line in craft.told() if "one user" in line.told or "user who flies" in line.told])
                self.assertEqual(len(self.stops_all(craft)), 2)
                self.ends_clean(craft)
            with flight.Flight(**arguments) as again:
                again.wait_commissioned()
                self.each_is_a_user(again)
                self.ends_clean(again)

    def each_is_a_user(self, craft):
        realtime = not any("no real-time scheduling" in line.told for line in craft.told())
        for user in (RELAY, ROBOT, STICK):
            process = self.process_of(user)
            self.assertEqual(numbers(process, "Uid"), [user] * 4)
            self.assertEqual(numbers(process, "Gid"), [user] * 4)
            self.assertEqual(numbers(process, "Groups"), [])
            ranks = [os.sched_getscheduler(int(thread.name)) & ~os.SCHED_RESET_ON_FORK for thread in pathlib.Path(f"/proc/{process}/task").iterdir()]
            self.assertEqual(any(rank in (os.SCHED_FIFO, os.SCHED_RR) for rank in ranks), realtime, "it has the real time of the flight")
        self.assertEqual(numbers(craft.pid_of("hirosco-supervisor"), "Uid"), [os.geteuid()] * 4)

    def nobody_gets_at_another(self, craft):
        frames = pathlib.Path("/dev/shm/hirosco/manipulator-robot/frames")
        supervisor, stick, robot = craft.pid_of("hirosco-supervisor"), self.process_of(STICK), self.process_of(ROBOT)
        ends = [("connect", self.socket), ("connect", f"{self.socket}.subsystem")]
        guards = [("signal", supervisor), ("signal", craft.process.pid), ("open", f"/proc/{supervisor}/mem"),
                  ("open", "/dev/shm/hirosco.manipulator-robot-enable"), ("open", "/dev/shm/hirosco.joystick-handle-enable")]
        of_stick = [*ends, ("list", self.socket.parent), ("make", self.socket.parent / "mine"), ("signal", stick),
                    ("open", f"/proc/{stick}/mem"), ("read", f"/proc/{stick}/environ")]
        of_robot = [("open", frames), ("list", frames.parent), ("make", frames.parent / "mine"), ("signal", robot), ("open", f"/proc/{robot}/mem")]
        for user, others in ((ROBOT, of_stick), (RELAY, of_stick + of_robot), (STICK, of_robot)):
            for attempt in guards + others:
                self.assertEqual(tries(user, attempt), ["refused"], f"{user}: {attempt}")
        # What is its own it gets at: the others were refused for whom they are.
        self.assertEqual(tries(ROBOT, ("open", frames), ("signal", robot)), ["done"] * 2)
        self.assertEqual(tries(STICK, *ends, ("signal", stick)), ["done"] * 3)

    def test_who_hangs_is_ended_by_the_guard_and_comes_back_as_its_user(self):
        with self.mission() as arguments, flight.Flight(**arguments) as craft:
            craft.wait_commissioned()
            begin, before = craft.count(), self.process_of(STICK)
            os.kill(before, signal.SIGSTOP)
            craft.wait_told("JOYSTICK died: signal 9", 10.0, begin)
            craft.wait_told("started JOYSTICK", 10.0, begin)
            self.assertNotEqual(self.process_of(STICK), before)
            self.stops_all(craft)
            self.ends_clean(craft, UNPROVOKED)

    def test_the_next_supervisor_goes_on_with_them_and_stops_them(self):
        with self.mission() as arguments, flight.Flight(**arguments) as craft:
            craft.wait_commissioned()
            begin, before = craft.count(), [self.process_of(user) for user in (RELAY, ROBOT, STICK)]
            craft.kill("hirosco-supervisor")
            self.assertNotIn("stopped", craft.wait_told("goes on with MANIPULATOR", 10.0, begin).told)
            self.assertEqual([self.process_of(user) for user in (RELAY, ROBOT, STICK)], before)
            time.sleep(1.0)                              # its guard listens a moment later
            self.stops_all(craft)
            begin = craft.count()
            os.kill(before[1], signal.SIGSTOP)
            craft.wait_told("MANIPULATOR died: signal 9", 10.0, begin)
            self.ends_clean(craft, UNPROVOKED)

    def test_who_outlives_every_supervisor_is_ended_by_the_keeper(self):
        with self.mission() as arguments, flight.Flight(**arguments) as craft:
            craft.wait_commissioned()
            supervisor = craft.pid_of("hirosco-supervisor")
            os.kill(self.process_of(STICK), signal.SIGSTOP)       # or it would end by itself
            craft.process.send_signal(signal.SIGTERM)
            time.sleep(0.05)
            os.kill(supervisor, signal.SIGKILL)
            self.assertEqual(craft.process.wait(ORPHANS_GONE_S), 4)
            self.assertEqual(processes_of(FIRST, LAST), [])

    def test_a_number_that_somebody_has_is_given_to_nobody(self):
        other = subprocess.Popen(["sleep", "600"], user=LAST, group=LAST, extra_groups=[])
        try:
            with self.mission() as arguments, flight.Flight(**arguments) as craft:
                self.assertEqual(craft.process.wait(10.0), 3)
            self.assertIn(f"sleep ({other.pid}) is one of them", "\n".join(craft.errors))
        finally:
            other.kill()
            other.wait()

    def test_where_the_right_is_lacking_or_nobody_asks_that_all_are_of_one_user_is_told(self):
        with self.mission() as arguments, flight.Flight(**arguments, prefix=WITHOUT_RIGHT) as craft:
            craft.wait_told("subsystems are not isolated as they should be: all are of one user: for users of their own the flight lacks CAP_KILL")
            craft.wait_commissioned()
            self.assertEqual(processes_of(FIRST, LAST), [])
            self.stops_all(craft)
        with flight.Flight() as craft:
            craft.wait_told("subsystems are all of the user who flies")


if __name__ == "__main__":
    if subprocess.run([flight.REPOSITORY / "tools/skip_reason", "no-own-users"], capture_output=True, check=False).returncode == 77:
        flight.skip("no-own-users")
    flight.main()
