# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco run` at a terminal, seen by a foreign emulator (pyte): what stands on the screen, that it follows the window, that a terminal
which takes nothing changes nothing in the flight, and that the terminal is as it was after every end."""
import itertools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import uuid

import emulated
import flight


class Terminal(emulated.Emulated):
    """`hirosco run MISSION` in a terminal; `with Terminal(...) as it`."""

    def __init__(self, mission, *more, environment=None):
        super().__init__(self.fly)
        self.words = [str(flight.BINARIES / "hirosco"), "run", str(mission), *more]
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-terminal-"))
        (self.folder / "runtime").mkdir()
        self.mark = uuid.uuid4().hex
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": str(self.folder / "runtime"), "TERM": "xterm-256color",
                            "LANG": "C.UTF-8", "LC_ALL": "C.UTF-8", flight.MARK: self.mark}
        self.environment.pop("NO_COLOR", None)
        self.environment.update(environment or {})

    def fly(self):
        os.chdir(self.folder)
        os.execve(self.words[0], self.words, self.environment)

    def __exit__(self, kind, *rest):
        super().__exit__(kind, *rest)
        left = flight.marked_processes(self.mark)
        for pid in left:
            os.kill(pid, signal.SIGKILL)
        shutil.rmtree(self.folder, ignore_errors=True)
        if left and kind is None:
            raise AssertionError(f"processes were left behind: {left}")

    def hirosco(self, *words):
        return subprocess.run([self.words[0], *words], cwd=self.folder, env={**self.environment, flight.MARK: ""},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=30, check=False)

    def cycles(self):
        """Of everybody, as the ground hears it."""
        for line in self.hirosco("status", "--json").stdout.splitlines():
            if json.loads(line).get("subsystem") == "SUPERVISOR":
                return sum(json.loads(line)["values"]["SUBSYSTEMS.CYCLES"])
        raise AssertionError("the supervisor tells nothing")


def clock_s(text):
    """The header's time since the start."""
    hours, minutes, seconds = text.splitlines()[0].split()[-1].split(":")
    return 3600 * int(hours) + 60 * int(minutes) + int(seconds)


def rows(lines):
    """The table's, by the subsystem's name; a remark, behind an empty line, begins with one, too."""
    begin = next(number for number, line in enumerate(lines) if line.split()[:2] == ["SUBSYSTEM", "STATE"]) + 1
    return {line.split()[1]: line for line in itertools.takewhile(lambda line: line[:3] in (" ● ", " ◆ "), lines[begin:])}


class TerminalTest(unittest.TestCase):
    def assert_as_before(self, terminal):
        self.assertEqual(terminal.until_as_before(), [])

    def test_a_flight_on_a_screen_that_is_resized_held_and_not_read_and_ended_by_its_keys(self):
        station = (flight.BINARIES / "hirosco-ground").exists()
        with Terminal(flight.ROKVISS, *(() if station else ("--no-ground",))) as terminal:
            text = terminal.until(lambda t: "● well" in t and (not station or "#token=" in t), "that it is well")
            lines = text.splitlines()
            self.assertIn(" ROKVISS  telepresence", lines[0])
            table = rows(lines)
            self.assertEqual(set(table), {"COMMUNICATION", "MANIPULATOR", "JOYSTICK"})
            for row in table.values():
                self.assertIn("Operational", row)
                self.assertIn(" Hz ", row)
            self.assertIn(" links 2/6  ● MANIPULATOR → JOYSTICK  ● JOYSTICK → MANIPULATOR", text)
            self.assertIn("commissioned: mode telepresence", text)
            self.assertIn("q end", lines[-1])
            if station:
                urls = [line.split()[-1] for line in lines if "http://127.0.0.1:" in line]
                self.assertEqual(len(urls), 2, "one to command, one to look")
                for url in urls:
                    self.assertRegex(url, r"^http://127\.0\.0\.1:\d+/#token=[0-9a-f]{32}$")
            self.assertNotEqual(terminal.modes(), terminal.before, "keys come one by one")

            terminal.resize(120, 40)
            wide = terminal.until(lambda t: "ACTUATORS" in t and "q end" in "".join(t.splitlines()[39:]), "the wider table")
            self.assertIn("free", wide)

            # Held by Ctrl-S, then not read at all: nobody of the flight notices.
            terminal.press(b"\x13")
            time.sleep(0.3)
            held, cycles = terminal.text(), terminal.cycles()
            self.assertEqual(terminal.text(), held, "nothing is drawn")
            self.assertGreater(terminal.cycles(), cycles)
            terminal.reads.clear()
            terminal.press(b"\x11")
            done = terminal.hirosco("status")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertRegex(done.stdout, r"^well: mode telepresence, 3 subsystems as it has them, 2 links up\n")
            self.assertLessEqual(max(map(len, done.stdout.splitlines())), 80)
            terminal.reads.set()
            terminal.until(lambda t: clock_s(t) > clock_s(held) and "● well" in t, "the newest picture", 5.0)

            terminal.press(b"q")
            terminal.until(lambda t: "End the flight?" in t, "the question")
            terminal.press(b"q")
            self.assertEqual(terminal.wait(), 0)
            self.assert_as_before(terminal)
            self.assertIn("ROKVISS flew 0:00:", terminal.text())
            self.assertIn("It was well.", terminal.text())
            self.assertIn("All of it: hirosco log", terminal.text())

    def test_a_screen_that_is_killed_leaves_the_terminal_as_it_was_and_the_flight_as_it_is(self):
        with Terminal(flight.HELLO, "--no-ground", environment={"NO_COLOR": "1"}) as terminal:
            self.assertNotRegex(terminal.sent, rb"\x1b\[[0-9;]*[349][0-7]m", "no colour where nobody wants any")
            terminal.until(lambda t: "● well" in t, "that it is well")
            screens = sorted(pid for pid, name in flight.marked_processes(terminal.mark).items() if name == "hirosco-screen")
            self.assertEqual(len(screens), 2, "one that draws, one that holds how the terminal was")
            os.kill(screens[1], signal.SIGKILL)
            self.assert_as_before(terminal)
            done = terminal.hirosco("status")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertEqual(terminal.hirosco("safe").returncode, 0)
            done = terminal.hirosco("status")
            self.assertIn(" stopped by the supervisor or SAFE ALL\n", done.stdout, "no line is cut")
            os.kill(terminal.pid, signal.SIGTERM)
            self.assertEqual(terminal.wait(), 0)
            self.assert_as_before(terminal)

    def test_an_end_from_outside_while_nobody_reads_the_terminal(self):
        with Terminal(flight.HELLO, "--no-ground") as terminal:
            terminal.until(lambda t: "● well" in t, "that it is well")
            terminal.press(b"\x13")
            time.sleep(0.2)
            os.kill(terminal.pid, signal.SIGTERM)
            self.assertEqual(terminal.wait(), 0)
            self.assert_as_before(terminal)

    def test_a_supervisor_that_stands_still_is_replaced_while_ctrl_s_holds_a_terminal_with_lines(self):
        with Terminal(flight.HELLO, "--no-ground", "--plain") as terminal:
            def supervisors():
                return [pid for pid, name in flight.marked_processes(terminal.mark).items() if name == "hirosco-supervisor"]
            terminal.until(lambda t: "commissioned" in t, "that it flies")
            terminal.press(b"\x13")
            time.sleep(0.2)
            before = supervisors()
            os.kill(before[0], signal.SIGSTOP)
            end = time.monotonic() + 10.0
            while not set(supervisors()) - set(before):
                self.assertLess(time.monotonic(), end, "another one goes on")
                time.sleep(0.02)
            terminal.press(b"\x11")
            terminal.until(lambda t: "this supervisor goes on for one that died" in " ".join(t.split()), "what the next one says")
            os.kill(terminal.pid, signal.SIGTERM)
            self.assertEqual(terminal.wait(), 0)

    def test_lines_tell_changes_and_nothing_else_where_there_is_no_terminal(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-lines-") as folder:
            done = subprocess.run([str(flight.BINARIES / "hirosco"), "run", str(flight.HELLO), "--no-ground", "--for", "3s"],
                                  cwd=folder, env={**os.environ, "XDG_RUNTIME_DIR": folder}, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, timeout=30, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("\x1b", done.stdout)
        changes = [line for line in done.stdout.splitlines() if line.startswith("[")]
        self.assertEqual(sum("mode operation" in line for line in changes), 1, done.stdout)
        self.assertEqual(len(changes), len({line[10:] for line in changes}), f"nothing is told twice: {changes}")
        self.assertRegex(done.stdout, r"HELLO: \d+ cycles, \d+ missed")


if __name__ == "__main__":
    flight.main()
