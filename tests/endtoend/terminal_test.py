# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco run` at a terminal, seen by a foreign emulator (pyte): what stands on the screen, that it follows the window, that a terminal
which takes nothing changes nothing in the flight, and that the terminal is as it was after every end."""
import contextlib
import fcntl
import json
import os
import pathlib
import pty
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest
import uuid

import flight

sys.path.append("/usr/lib/python3/dist-packages")   # of the distribution, whatever Python this is
try:
    import pyte
except ImportError:
    flight.skip("no-terminal-emulator", "python3-pyte")


class Terminal:
    """`hirosco run MISSION` in a pseudo terminal of its own; `with Terminal(...) as it`."""

    def __init__(self, mission, *more, columns=80, rows=24, environment=None):
        self.words = [str(flight.BINARIES / "hirosco"), "run", str(mission), *more]
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-terminal-"))
        (self.folder / "runtime").mkdir()
        self.mark = uuid.uuid4().hex
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": str(self.folder / "runtime"), "TERM": "xterm-256color",
                            "LANG": "C.UTF-8", "LC_ALL": "C.UTF-8", flight.MARK: self.mark, **(environment or {})}
        self.environment.pop("NO_COLOR", None)
        self.sent, self.reads, self.code = b"", threading.Event(), None
        self.lock = threading.Lock()
        self.reads.set()

    def __enter__(self):
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            os.chdir(self.folder)
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", self.screen.lines, self.screen.columns, 0, 0))
            os.execve(self.words[0], self.words, self.environment)
        self.slave = os.open(os.ptsname(self.master), os.O_RDWR | os.O_NOCTTY)    # its modes outlive the flight
        self.before = termios.tcgetattr(self.slave)
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        return self

    def __exit__(self, kind, *_):
        if self.code is None:
            if kind is not None:
                print("\n".join(self.lines()), file=sys.stderr)
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGTERM)
            self.reads.set()
            self.wait(20)
        left = flight.marked_processes(self.mark)
        for pid in left:
            os.kill(pid, signal.SIGKILL)
        os.close(self.slave)
        os.close(self.master)
        shutil.rmtree(self.folder, ignore_errors=True)
        if left and kind is None:
            raise AssertionError(f"processes were left behind: {left}")

    def _read(self):
        with contextlib.suppress(OSError):
            while self.reads.wait():
                octets = os.read(self.master, 65536)
                if not octets:
                    return
                with self.lock:
                    self.sent += octets
                    self.stream.feed(octets)

    def lines(self):
        with self.lock:
            return [line.rstrip() for line in self.screen.display]

    def text(self):
        return "\n".join(self.lines())

    def until(self, wanted, what, seconds=15.0):
        """The screen's text once `wanted(text)`."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if wanted(self.text()):
                return self.text()
            time.sleep(0.02)
        raise AssertionError(f"never on the screen: {what}\n{self.text()}")

    def press(self, keys):
        os.write(self.master, keys)

    def resize(self, columns, rows):
        with self.lock:
            self.screen.resize(rows, columns)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def hirosco(self, *words):
        return subprocess.run([self.words[0], *words], cwd=self.folder, env={**self.environment, flight.MARK: ""},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=30, check=False)

    def cycles(self):
        """Of everybody, as the ground hears it."""
        for line in self.hirosco("status", "--json").stdout.splitlines():
            if json.loads(line)["subsystem"] == "SUPERVISOR":
                return sum(json.loads(line)["values"]["SUBSYSTEMS.CYCLES"])
        raise AssertionError("the supervisor tells nothing")

    def modes(self):
        return termios.tcgetattr(self.slave)

    def wait(self, seconds=15.0):
        """The exit code."""
        end = time.monotonic() + seconds
        while self.code is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.code = os.waitstatus_to_exitcode(status)
            elif time.monotonic() > end:
                os.kill(self.pid, signal.SIGKILL)
                os.waitpid(self.pid, 0)
                self.code = -signal.SIGKILL
                raise AssertionError("it does not end")
            else:
                time.sleep(0.02)
        time.sleep(0.1)    # what was written before comes through the emulator
        return self.code


def clock_s(text):
    """The header's time since the start."""
    hours, minutes, seconds = text.splitlines()[0].split()[-1].split(":")
    return 3600 * int(hours) + 60 * int(minutes) + int(seconds)


class TerminalTest(unittest.TestCase):
    def assert_as_before(self, terminal):
        self.assertEqual(terminal.modes(), terminal.before, "the modes of the terminal are as they were")
        sent = terminal.sent
        self.assertLess(sent.rfind(b"\x1b[?1049h"), sent.rfind(b"\x1b[?1049l"), "the first screen is back")
        self.assertLess(sent.rfind(b"\x1b[?25l"), sent.rfind(b"\x1b[?25h"), "the cursor is seen")
        self.assertLess(sent.rfind(b"\x1b[?7l"), sent.rfind(b"\x1b[?7h"), "long lines are wrapped")

    def test_a_flight_on_a_screen_that_is_resized_held_and_not_read_and_ended_by_its_keys(self):
        station = (flight.BINARIES / "hirosco-ground").exists()
        with Terminal(flight.ROKVISS, *(() if station else ("--no-ground",))) as terminal:
            text = terminal.until(lambda t: "● well" in t and (not station or "#token=" in t), "that it is well")
            lines = text.splitlines()
            self.assertIn(" ROKVISS  telepresence", lines[0])
            for name in ("COMMUNICATION", "MANIPULATOR", "JOYSTICK"):
                row, = (line for line in lines if line.startswith(f" ● {name}") or line.startswith(f" ◆ {name}"))
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
            wide = terminal.until(lambda t: "ACTUATORS" in t and "q end" in t.splitlines()[39], "the wider table")
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
            terminal.environment["NO_COLOR"] = "1"
            terminal.until(lambda t: "● well" in t, "that it is well")
            screens = sorted(pid for pid, name in flight.marked_processes(terminal.mark).items() if name == "hirosco-screen")
            self.assertEqual(len(screens), 2, "one that draws, one that holds how the terminal was")
            os.kill(screens[1], signal.SIGKILL)
            end = time.monotonic() + 5.0
            while terminal.modes() != terminal.before and time.monotonic() < end:
                time.sleep(0.02)
            self.assert_as_before(terminal)
            done = terminal.hirosco("status")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
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
