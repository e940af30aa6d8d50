# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A pseudo terminal with a program in it, seen by a foreign emulator (pyte)."""
import contextlib
import fcntl
import os
import pathlib
import pty
import signal
import struct
import subprocess
import sys
import termios
import threading
import time

sys.path.append("/usr/lib/python3/dist-packages")   # of the distribution, whatever Python this is
try:
    import pyte
except ImportError:
    sys.exit(subprocess.run([pathlib.Path(__file__).resolve().parents[2] / "tools/skip_reason", "no-terminal-emulator",
                             "python3-pyte"], check=False).returncode)


TIOCGPTN = 0x80045430    # of which number the terminal behind is (ioctl_tty(2))


class Screen(pyte.Screen):
    """With an alternate screen, which pyte passes over: whoever leaves it finds an empty one here."""

    def reset_mode(self, *modes, **more):
        super().reset_mode(*modes, **more)
        if more.get("private") and 1049 in modes:
            self.reset()


class Emulated:
    """`with Emulated(run) as terminal:` — `run()` is called in a process of its own that has the terminal, and does not return."""

    def __init__(self, run, columns=80, rows=24):
        self.run = run
        self.screen = Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.sent, self.reads, self.code = b"", threading.Event(), None
        self.lock = threading.Lock()
        self.reads.set()

    def __enter__(self):
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            # Whoever watches knows the modes before anybody changes them.
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", self.screen.lines, self.screen.columns, 0, 0))
            os.read(0, 1)
            self.run()
            os._exit(127)
        number, = struct.unpack("I", fcntl.ioctl(self.master, TIOCGPTN, bytes(4)))
        self.slave = os.open(f"/dev/pts/{number}", os.O_RDWR | os.O_NOCTTY)    # its modes outlive the program
        self.before = termios.tcgetattr(self.slave)
        threading.Thread(target=self._read, daemon=True).start()
        self.press(b"\n")
        return self

    def __exit__(self, kind, *_):
        if self.code is None:
            if kind is not None:
                print(self.text(), file=sys.stderr)
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGTERM)
            self.reads.set()
            with contextlib.suppress(AssertionError):
                self.wait(20)
        os.close(self.slave)
        os.close(self.master)

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
        """The screen's text once `wanted(text)`, and nothing is being drawn."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            text = self.text()
            time.sleep(0.02)
            if wanted(text) and self.text() == text:
                return text
        raise AssertionError(f"never on the screen: {what}\n{self.text()}")

    def press(self, keys):
        os.write(self.master, keys)

    def resize(self, columns, rows):
        with self.lock:
            self.screen.resize(rows, columns)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def modes(self):
        return termios.tcgetattr(self.slave)

    def wait(self, seconds=20.0):
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

    def why_not_as_before(self):
        """Empty once modes, screen and cursor are as they were."""
        found = []
        if self.modes() != self.before:
            found.append("its modes are others")
        with self.lock:
            for on, off, what in ((b"\x1b[?1049h", b"\x1b[?1049l", "the second screen is seen"), (b"\x1b[?25l", b"\x1b[?25h", "no cursor is seen"),
                                  (b"\x1b[?7l", b"\x1b[?7h", "long lines are cut")):
                if self.sent.rfind(on) > self.sent.rfind(off):
                    found.append(what)
        return found

    def until_as_before(self, seconds=10.0):
        end = time.monotonic() + seconds
        while self.why_not_as_before() and time.monotonic() < end:
            time.sleep(0.02)
        return self.why_not_as_before()
