# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A real flight for a test: `hirosco run --json` in a folder of its own, its story as it is told, telecommands, faults,
telemetry, and the certainty that nothing of it is left afterwards. Python's standard library only.

HIROSCO_BIN names the folder of the executables; by default the one of the release preset."""
import contextlib
import ctypes
import dataclasses
import json
import math
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import uuid

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("HIROSCO_BIN", REPOSITORY / "build/release/bin"))
ROKVISS = REPOSITORY / "missions/rokviss/mission.xml"
HELLO = REPOSITORY / "missions/hello/mission.xml"
PORT = 10015
MANIPULATOR, JOYSTICK = 10, 11
# The robot does its stop in the 200 ms that its descriptor declares, from the end of its enable (50 ms; 100 ms reduced) on.
STOP_S = 0.3
MARK = "HIROSCO_TEST_FLIGHT"      # in the environment of every process of a flight, orphans included


def skip(reason, detail=""):
    """Ends the test program as skipped if `reason`, one of tools/skip_reason, is true here; else as failed."""
    sys.exit(subprocess.run([REPOSITORY / "tools/skip_reason", reason, str(detail)], check=False).returncode)


def main():
    """As unittest.main(), but says at the end what was measured, and ends as skipped where every test was."""
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    for line in measured:
        print(line)
    result = program.result
    skipped = result.skipped and len(result.skipped) >= result.testsRun
    sys.exit(1 if not result.wasSuccessful() else 77 if skipped else 0)


measured = []


def measure(text):
    """A figure for the report at the end."""
    measured.append(f"measured: {text}")


def stolen_s():
    """Seconds that a host has taken from this machine's processors since it runs. What passes then passes for nobody."""
    steal = pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[8]
    return int(steal) / os.sysconf("SC_CLK_TCK")


def spin(pid, thread):
    """Makes this thread of a `hirosco-spinnable-` program spin for ever (tests/fault/spinnable.cpp)."""
    number = {"x86_64": 234, "aarch64": 131}[os.uname().machine]
    if ctypes.CDLL(None, use_errno=True).syscall(number, pid, thread, signal.SIGUSR2) != 0:
        raise OSError(ctypes.get_errno(), "tgkill")


def listens(port):
    try:
        with socket.create_connection(("127.0.0.1", port), 1.0):
            return True
    except OSError:
        return False


def segments():
    """Named shared memory of the project on this computer, but for that of unit tests, which may run beside. The folders of device addresses
    stay (docs/adr/0169)."""
    memory = pathlib.Path("/dev/shm")
    with contextlib.suppress(FileNotFoundError):
        return sorted(str(path.relative_to(memory)) for top in memory.glob("hirosco*") for path in [top, *top.rglob("*")]
                      if not path.is_dir() and not any(part.startswith("test-") for part in path.parts))
    return []


def marked_processes(mark):
    """{pid: name} of the living processes with this mark in their environment."""
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        with contextlib.suppress(OSError):
            if f"{MARK}={mark}".encode() not in (folder / "environ").read_bytes().split(b"\0"):
                continue
            state = (folder / "stat").read_text().rsplit(")", 1)[1].split()[0]
            if state not in "ZX":
                found[int(folder.name)] = pathlib.Path(os.readlink(folder / "exe")).name
    return found


@dataclasses.dataclass
class Line:
    received: float               # time.monotonic()
    content: dict

    @property
    def told(self):
        return self.content.get("told", "")

    @property
    def at_s(self):
        return self.content.get("at_s")


class Flight:
    """`with Flight() as flight:` — at the end of the block the flight is shut down in order if it still runs."""

    def __init__(self, mission=ROKVISS, binaries=None, prefix=(), environment=None, folder=None, owner=None, instance=None,
                 quiet=False, more=("--no-ground",)):
        self.quiet = quiet              # what failed is told by who catches it
        self.more = list(more)
        self.mission, self.binaries = str(mission), pathlib.Path(binaries or BINARIES)
        self.prefix, self.extra = list(prefix), dict(environment or {})
        self.mark = uuid.uuid4().hex
        self.own_folder = folder is None
        self.folder = pathlib.Path(folder or tempfile.mkdtemp(prefix="hirosco-flight-"))
        self.owner, self.instance = owner, instance
        self.lines, self.process = [], None
        self._arrived = threading.Condition()
        self._ended = False
        self._readers = []

    # Life.

    def __enter__(self):
        free_by = time.monotonic() + 3.0        # a killed process closes its sockets a moment after it is gone
        while self.instance is None and listens(PORT):    # one with a name of its own takes free ports
            if time.monotonic() > free_by:
                raise RuntimeError(f"something listens on port {PORT} already: another flight?")
            time.sleep(0.05)
        runtime = self.folder / "runtime"
        runtime.mkdir(exist_ok=True)
        if self.owner is not None:
            os.chown(self.folder, self.owner, -1)
            os.chown(runtime, self.owner, -1)
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": str(runtime), "NO_COLOR": "1", MARK: self.mark, **self.extra}
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [*self.prefix, str(self.binaries / "hirosco"), "run", self.mission, "--json", *self.more, *self._which()],
            cwd=self.folder,
            env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.errors = []
        self._readers = [threading.Thread(target=self._read_lines, daemon=True),
                         threading.Thread(target=self._read_errors, daemon=True)]
        for reader in self._readers:
            reader.start()
        return self

    def __exit__(self, kind, *_):
        try:
            if kind is not None and not self.quiet:
                print(self.story(), file=sys.stderr)
            if self.process.poll() is None:
                self.process.send_signal(signal.SIGTERM)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self.process.wait(15.0)
        finally:
            left = self.end_by_force()
            for reader, pipe in zip(self._readers, (self.process.stdout, self.process.stderr)):
                reader.join(5.0)
                if not reader.is_alive():
                    pipe.close()
            if self.own_folder:
                shutil.rmtree(self.folder, ignore_errors=True)
        if left and kind is None:
            raise AssertionError(f"processes were left behind: {left}")

    def end_by_force(self):
        """Kills what is left of the flight; returns what that was."""
        left = self.wait_until_gone(10.0)
        for pid in left:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(5.0)
        return left

    def end(self, number=signal.SIGTERM, seconds=15.0):
        """Asks for an orderly end; the exit code."""
        self.process.send_signal(number)
        code = self.process.wait(seconds)
        for reader in self._readers:
            reader.join(5.0)
        return code

    def _read_lines(self):
        for text in self.process.stdout:    # ends when the last process that holds it has ended
            now = time.monotonic()
            try:
                content = json.loads(text)
            except ValueError:
                content = {"garbled": text.decode(errors="replace")}
            with self._arrived:
                self.lines.append(Line(now, content))
                self._arrived.notify_all()
        with self._arrived:
            self._ended = True
            self._arrived.notify_all()

    def _read_errors(self):
        for text in self.process.stderr:
            self.errors.append(text.decode(errors="replace").rstrip())

    def _which(self):
        return [] if self.instance is None else ["--instance", self.instance]

    def place(self):
        """What a flight with a name of its own says first: its instance, telemetry, telecommand, log and folder."""
        line = self.wait_line(lambda l: "instance" in l.content, 10.0)
        if line is None:
            raise AssertionError("it does not say where it is")
        return line.content

    # What is told.

    def story(self):
        with self._arrived:
            told = [f"{line.at_s:9.4f} s  {line.told}" for line in self.lines if line.told]
        return "\n".join(["what the flight told:", *told, *(f"stderr: {text}" for text in self.errors)])

    def wait_line(self, wanted, seconds, start=0):
        """First line, past or future, from number `start` on, for which `wanted(line)`."""
        end = time.monotonic() + seconds
        place = start
        with self._arrived:
            while True:
                while place < len(self.lines):
                    if wanted(self.lines[place]):
                        return self.lines[place]
                    place += 1
                if self._ended or end <= time.monotonic():
                    return None
                self._arrived.wait(end - time.monotonic())

    def wait_told(self, text, seconds=10.0, start=0):
        """The line that tells `text`; fails when it does not come."""
        line = self.wait_line(lambda l: text in l.told, seconds, start)
        if line is None:
            raise AssertionError(f"not told within {seconds:g} s: {text!r}")
        return line

    def wait_commissioned(self, seconds=20.0):
        return self.wait_told("commissioned: mode telepresence", seconds)

    def wait_status(self, wanted, seconds):
        """First live status, now or later, for which `wanted(status)`."""
        line = self.wait_line(lambda l: "subsystems" in l.content and wanted(l.content), seconds, self.count())
        return line.content if line else None

    def count(self):
        with self._arrived:
            return len(self.lines)

    def told(self, start=0):
        with self._arrived:
            return [line for line in self.lines[start:] if line.told]

    # Hands.

    def hirosco(self, *words, seconds=30.0):
        """Runs `hirosco WORDS` beside the flight."""
        return subprocess.run([str(self.binaries / "hirosco"), *words], cwd=self.folder, env={**self.environment, MARK: ""},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=seconds, check=False)

    def bring_up(self, do):
        """The one bring-up of an operator, from wherever the two are; do(subsystem, function, argument) has to succeed."""
        commissioning, telepresence, coupled = 1, 3, 2
        both = ("manipulator", "joystick")
        do("supervisor", "SET_MODE", commissioning)
        # Who is further on already refuses a step: the states in the end decide.
        for function, argument in (("SET_STATE", 3), ("CONFIGURE", coupled)):
            for name in both:
                self.tc(name, function, argument)
        for link in (1, 2):
            self.tc("supervisor", "LINK", link)
        for name in both:
            self.tc(name, "SET_STATE", 4)
        for name in both:
            do(name, "SET_STATE", 5)
        do("supervisor", "SET_MODE", telepresence)

    def tc(self, subsystem, function, *arguments, seconds=30.0):
        """`hirosco tc`: (exit code, ["1,1", "1,3", ...])."""
        done = self.hirosco("tc", subsystem, function, *map(str, arguments), "--mission", self.mission, "--json",
                            *self._which(), seconds=seconds)
        if done.stderr:
            print(f"hirosco tc {subsystem} {function}: {done.stderr.strip()}", file=sys.stderr)
        self.answers = done.stdout
        return done.returncode, [json.loads(line)["report"] for line in done.stdout.splitlines() if line.startswith("{")]

    def fault(self, device, *words):
        done = self.hirosco("fault", device, *map(str, words), "--mission", self.mission, *self._which())
        if done.returncode != 0:
            raise AssertionError(f"hirosco fault {device} {words}: {done.stdout}{done.stderr}")
        return done.stdout.strip()

    def ask(self, device, *words):
        """As fault(), but past the tool, by the control socket of the device: that takes no time."""
        path, = (self.folder / "runtime").glob(f"hirosco-*/{device}")
        with socket.socket(socket.AF_UNIX) as control:
            control.settimeout(2.0)
            control.connect(str(path))
            control.sendall(" ".join(map(str, words)).encode() + b"\n")
            answer = control.makefile().readline().strip()
        if not answer.startswith("ok"):
            raise AssertionError(f"{device} {words}: {answer}")
        return answer

    def truth(self, device):
        """{name: number} of the simulated device's world."""
        return {name: float(value) for name, value in (word.split("=") for word in self.ask(device, "truth").split()
                                                       if "=" in word)}

    def wait_at_rest(self, device, since):
        """Until its motors give nothing; fails when they still do STOP_S after `since` (time.monotonic()). A simulated world
        leaves out the time that its host was late: from the first look on its own time counts, before that all."""
        before_s, first = time.monotonic() - since, None
        while True:
            truth = self.truth(device)
            first = first or truth
            if (truth["motor_1"], truth["motor_2"]) == (0.0, 0.0):
                return
            moved_s = before_s + truth["world_s"] - first["world_s"]
            if moved_s >= STOP_S:
                raise AssertionError(f"{device} moves still {moved_s:.3f} s later: {truth}")

    def log(self, *words, last=100000):
        """The texts of the log's records, oldest first."""
        return list(self.records(*words, last=last))

    def records(self, *words, last):
        """The same, one by one."""
        command = [self.binaries / "hirosco", "log", "--mission", self.mission, "--json", "--last", str(last), *self._which(), *words]
        with tempfile.TemporaryFile("w+") as errors, subprocess.Popen(command, cwd=self.folder, env={**self.environment, MARK: ""},
                                                                      stdout=subprocess.PIPE, stderr=errors, text=True) as told:
            yield from map(json.loads, told.stdout)
            if told.wait() != 0:
                errors.seek(0)
                raise AssertionError(f"hirosco log: {errors.read()}")

    def processes(self):
        return marked_processes(self.mark)

    def pid_of(self, name):
        found = [pid for pid, program in self.processes().items() if program == name]
        if len(found) != 1:
            raise AssertionError(f"{name}: pids {found}")
        return found[0]

    def kill(self, name, number=signal.SIGKILL):
        """Sends a signal to one process of the flight; the time just before."""
        pid = self.pid_of(name)
        now = time.monotonic()
        os.kill(pid, number)
        return now

    def wait_until_gone(self, seconds):
        """{} once no process of the flight lives, else those that still do."""
        end = time.monotonic() + seconds
        while True:
            left = self.processes()
            if not left or time.monotonic() >= end:
                return left
            time.sleep(0.05)


class MissionCopy:
    """`with MissionCopy({"old": "new"}) as path:` — a mission whose text differs in these words."""

    def __init__(self, changes, mission=ROKVISS):
        self.changes, self.mission = changes, pathlib.Path(mission)

    def __enter__(self):
        # Beside the original in depth, so that what it names by `../../` is found through links.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-mission-"))
        for name in ("supervisor", "subsystems"):
            (self.folder / name).symlink_to(REPOSITORY / name)
        path = self.folder / "missions" / self.mission.parent.name / "mission.xml"
        path.parent.mkdir(parents=True)
        text = self.mission.read_text()
        for old, new in self.changes.items():
            if f'"{old}"' not in text:
                raise ValueError(f"{self.mission} has no \"{old}\"")
            text = text.replace(f'"{old}"', f'"{new}"')
        path.write_text(text)
        return path

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)


# Telemetry. No more of the standard than the tests of one flight need; a foreign implementation is tests/client.

STRUCTURES = {
    4713: (MANIPULATOR, ">2d2d2d2d", (("position", 2), ("torque", 2), ("desired", 2), ("tip_force", 2))),
    4721: (JOYSTICK, ">i2d2d2d2d2dI2d", (("state", 1), ("position", 2), ("velocity", 2), ("torque", 2),
                                         ("peer_position", 2), ("peer_torque", 2), ("peer_age", 1), ("energy", 2))),
}


@dataclasses.dataclass
class Report:
    received: float
    apid: int
    service: int
    subtype: int
    time_s: float                 # on board, TAI
    data: bytes

    def housekeeping(self, identifier):
        """{name: value or tuple} when this is the structure, else None."""
        apid, form, names = STRUCTURES[identifier]
        if (self.apid, self.service, self.subtype) != (apid, 3, 25) or self.data[:2] != struct.pack(">H", identifier):
            return None
        numbers = list(struct.unpack(form, self.data[2:]))
        values = {}
        for name, count in names:
            taken, numbers = numbers[:count], numbers[count:]
            values[name] = taken[0] if count == 1 else tuple(taken)
        return values


class Telemetry:
    """A listener on the telemetry port."""

    def __init__(self, port=PORT):
        self.reports = []
        self._mutex = threading.Lock()
        self._socket = socket.create_connection(("127.0.0.1", port), 5.0)
        self._socket.settimeout(None)
        threading.Thread(target=self._receive, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()

    def _receive(self):
        buffer = bytearray()
        with contextlib.suppress(OSError):
            while octets := self._socket.recv(65536):
                buffer += octets
                while len(buffer) >= 6 and len(buffer) >= (size := 7 + int.from_bytes(buffer[4:6], "big")):
                    self._take(bytes(buffer[:size]))
                    del buffer[:size]

    def _take(self, packet):
        whole, part = int.from_bytes(packet[13:17], "big"), int.from_bytes(packet[17:20], "big")
        report = Report(time.monotonic(), int.from_bytes(packet[:2], "big") & 0x7FF, packet[7], packet[8],
                        whole + part / 2**24, packet[20:-2])
        with self._mutex:
            self.reports.append(report)

    def housekeeping(self, identifier):
        """[(time on board, values)] of all reports of a structure so far."""
        with self._mutex:
            reports = list(self.reports)
        return [(r.time_s, values) for r in reports if (values := r.housekeeping(identifier)) is not None]

    def wait_housekeeping(self, identifier, more_than, seconds=10.0):
        """The same as soon as there are more than that. They are sampled by cycles, of which a late host leaves out some."""
        end = time.monotonic() + seconds
        while len(found := self.housekeeping(identifier)) <= more_than:
            if time.monotonic() >= end:
                raise AssertionError(f"{len(found)} reports of structure {identifier} in {seconds:.0f} s")
            time.sleep(0.05)
        return found

    def forget(self):
        with self._mutex:
            self.reports.clear()


def correlation(first, second):
    """Pearson's; 0 when one of them stands still."""
    count = len(first)
    if count < 2:
        return 0.0
    mean_1, mean_2 = sum(first) / count, sum(second) / count
    product = sum((a - mean_1) * (b - mean_2) for a, b in zip(first, second))
    norm = math.sqrt(sum((a - mean_1) ** 2 for a in first) * sum((b - mean_2) ** 2 for b in second))
    return product / norm if norm > 0 else 0.0
