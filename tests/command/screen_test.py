# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco-screen` without a flight: what it is told comes by its two pipes from here. However it ends the terminal is as it was, and whoever
tells it something is never held up."""
import fcntl
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "endtoend"))
import emulated

PROGRAM = str(pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco-screen")
HIGH = 20    # descriptors that are in nobody's way


class Screen(emulated.Emulated):
    """The screen under a keeper that does nothing but wait for it."""

    def __init__(self, **environment):
        super().__init__(self.keep)
        self.environment = {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", **environment}

    def __enter__(self):
        self.pipes = [os.pipe(), os.pipe()]
        self.reading = [fcntl.fcntl(read, fcntl.F_DUPFD, HIGH) for read, _ in self.pipes]
        super().__enter__()
        for (read, _), high in zip(self.pipes, self.reading):
            os.close(read)
            os.close(high)
        self.told, self.others = (write for _, write in self.pipes)
        return self

    def __exit__(self, *what):
        self.close()
        super().__exit__(*what)

    def keep(self):
        for _, write in self.pipes:
            os.close(write)
        keeper = os.getpid()
        screen = os.fork()
        if screen == 0:
            for number, high in zip((3, 4), self.reading):
                os.dup2(high, number)
            os.closerange(5, 100)
            os.execve(PROGRAM, [PROGRAM, "--keeper", str(keeper), "--log", "log/pair.db"], self.environment)
        for high in self.reading:
            os.close(high)
        signal.signal(signal.SIGUSR1, lambda *_: os.write(1, b""))
        signal.signal(signal.SIGTERM, lambda *_: None)
        while True:
            try:
                _, status = os.waitpid(screen, 0)
                os._exit(os.waitstatus_to_exitcode(status) & 0x7F)
            except InterruptedError:
                continue

    def close(self):
        """The flight is over."""
        for write in (self.told, self.others):
            try:
                os.close(write)
            except OSError:
                pass

    def tell(self, **what):
        os.write(self.told, json.dumps(what).encode() + b"\n")

    def overview(self, state="Operational", up_s=7.5):
        member = {"name": "ARM", "runs": True, "state": state, "wanted": "Operational", "cycling": True, "realtime": True, "inhibited": 0,
                  "period_ns": 500000, "cycles": 100, "overruns": 0, "missed": 0, "latency_max_ns": 31000, "execution_mean_ns": 20000}
        self.tell(up_s=up_s, mission="PAIR", mode="coupled", initial_mode="commissioning", usual_mode="coupled", waits_for="",
                  members=[member], links=[], values=[])

    def children(self):
        """The one that holds how the terminal was, and the one that draws."""
        def of(pid):
            return [int(word) for word in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
        holder, = of(self.pid)
        drawer, = of(holder)
        return holder, drawer


class ScreenTest(unittest.TestCase):
    def shown(self, screen):
        screen.overview()
        screen.until(lambda text: "● well" in text, "a craft that is well")

    def test_shows_what_it_is_told_and_says_farewell_when_the_flight_is_over(self):
        with Screen() as screen:
            self.shown(screen)
            screen.tell(at_s=1.5, told="ARM high DEVICE_LOST")
            os.write(screen.others, b'{"url":"http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef","observer_url":"http://127.0.0.1:8080/#token=b"}\n')
            os.write(screen.others, b"hirosco: the supervisor has died; another one goes on\n")
            screen.overview(state="Offline")
            text = screen.until(lambda text: "NOT WELL" in text and "another one goes on" in text, "what has happened")
            self.assertIn("■ ARM high DEVICE_LOST", text)
            self.assertIn(" page     http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef\n", text)
            screen.close()
            self.assertEqual(screen.wait(), 0)
            self.assertEqual(screen.until_as_before(), [])
            text = screen.text()
            self.assertIn("PAIR flew 0:00:07, in mode coupled at the end. It was NOT WELL:", text)
            self.assertIn("1.500 s: ARM high DEVICE_LOST", text)
            self.assertIn("hirosco why", text)
            self.assertIn("log/pair.db", text)
            self.assertIn("hirosco: the supervisor has died; another one goes on", text, "what went wrong is not lost with the screen")

    def test_the_terminal_is_as_it_was_however_one_of_the_two_ends(self):
        for which in (0, 1):
            for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGKILL):
                if which == 0 and number == signal.SIGHUP:
                    continue    # passed on: to the one that draws it says that the terminal is gone
                with self.subTest(which=("holder", "drawer")[which], number=number), Screen() as screen:
                    self.shown(screen)
                    self.assertNotEqual(screen.why_not_as_before(), [])
                    os.kill(screen.children()[which], number)
                    if number == signal.SIGHUP:
                        screen.close()
                    self.assertEqual(screen.until_as_before(), [])
                    screen.wait()

    def test_ctrl_z_and_ctrl_backslash_stop_nobody_and_ctrl_c_is_the_keepers(self):
        with Screen() as screen:
            self.shown(screen)
            screen.press(b"\x1a\x1c")
            screen.overview(up_s=3600)
            screen.until(lambda text: "1:00:00" in text, "that it goes on")
            holder, drawer = screen.children()
            for pid in (screen.pid, holder, drawer):
                self.assertIn(pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0], "SR")

    def test_who_tells_is_never_held_up_by_a_terminal_that_takes_nothing(self):
        for held in (False, True):
            with self.subTest(held=held), Screen() as screen:
                self.shown(screen)
                if held:
                    screen.press(b"\x13")
                else:
                    screen.reads.clear()
                    screen.overview()    # the reader's last turn
                for number in range(20_000):    # some megabytes through a pipe of 64 KiB: it would stand here
                    screen.tell(at_s=number, told=f"ARM info {'x' * 200} {number}")
                screen.overview(up_s=3600)
                screen.reads.set()
                screen.press(b"\x11")
                screen.until(lambda text: "1:00:00" in text and "19999" in text, "the newest picture")

    def test_a_window_gets_larger_and_smaller(self):
        with Screen() as screen:
            self.shown(screen)
            for columns, rows in ((120, 40), (60, 12), (80, 24)):
                screen.resize(columns, rows)
                screen.until(lambda text, rows=rows: "q end" in text.split("\n")[rows - 1] and "PAIR" in text.split("\n")[0], f"{columns}x{rows}")

    def test_without_unicode_and_without_colour(self):
        with Screen(LC_ALL="C", LANG="C", NO_COLOR="1") as screen:
            screen.overview()
            screen.until(lambda text: "* well" in text, "a craft that is well")
            self.assertTrue(all(octet < 0x80 for octet in screen.sent))
            self.assertNotRegex(screen.sent, rb"\x1b\[[0-9;]*[349][0-7]m")

    def test_is_background_work(self):
        with Screen() as screen:
            self.shown(screen)
            drawer = screen.children()[1]
            self.assertGreaterEqual(int(pathlib.Path(f"/proc/{drawer}/stat").read_text().rsplit(")", 1)[1].split()[16]), 10)

    def test_is_started_by_nobody_else(self):
        done = subprocess.run([PROGRAM], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("started by 'hirosco run MISSION' on a terminal", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
