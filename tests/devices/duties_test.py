#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The reference device keeps the duties of docs/guide/your_device.md, in C by every wire that it has and in Python, octet by octet; and each
duty is found missing in a copy of it that breaks it. With a wire and an address: a device of your own is tried (own_device.py, --help)."""
import contextlib
import os
import pathlib
import select
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import tty
import unittest

try:
    import own_device
    import reference
    from reference import ACTIVE, FOLDER, OFF, OLD_EPOCH, STOP, TRIPPED, command, status, streamed
except ModuleNotFoundError as lacking:
    if lacking.name not in ("own_device", "reference", "local_wires"):
        raise
    sys.exit(f"duties_test: {lacking.name}.py is not beside it in {pathlib.Path(__file__).resolve().parent}: "
             "copy the whole folder, /usr/share/doc/hirosco/examples/device (in the repository: tests/devices)")

HERE = pathlib.Path(__file__).resolve().parent
PATIENCE = 10.0


def free_port(kind):
    with socket.socket(type=kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Datagrams:
    def __init__(self, port):
        self.socket = socket.socket(type=socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))

    def send(self, frame):
        self.socket.send(frame)

    def receive(self, seconds):
        with contextlib.suppress(ConnectionRefusedError):
            if select.select([self.socket], [], [], seconds)[0]:
                return self.socket.recv(2048)
        return None

    def close(self):
        self.socket.close()


class Stream:
    """A wire without boundaries: a descriptor that is read and written."""

    def __init__(self, descriptor, owner):
        self.descriptor, self.owner, self.octets = descriptor, owner, b""

    def send(self, frame):
        self.put(streamed(frame))

    def put(self, octets):
        while octets:
            octets = octets[os.write(self.descriptor, octets):]

    def receive(self, seconds):
        end = time.monotonic() + seconds
        while len(self.octets) < 8 or len(self.octets) < 8 + int.from_bytes(self.octets[2:4], "little"):
            if not select.select([self.descriptor], [], [], max(0, end - time.monotonic()))[0]:
                return None
            self.octets += os.read(self.descriptor, 4096)
        frame = self.octets[6:6 + int.from_bytes(self.octets[2:4], "little")]
        assert self.octets[:len(frame) + 8] == streamed(frame), self.octets
        self.octets = self.octets[len(frame) + 8:]
        return frame

    def close(self):
        self.owner()


def connected(port):
    end = time.monotonic() + PATIENCE
    while True:
        try:
            made = socket.create_connection(("127.0.0.1", port))
            made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return Stream(made.fileno(), made.close)
        except ConnectionRefusedError:
            assert time.monotonic() < end


def opened(link):
    end = time.monotonic() + PATIENCE
    while not link.is_symlink():
        assert time.monotonic() < end
    line = os.open(link, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(line)
    return Stream(line, lambda: os.close(line))


@contextlib.contextmanager
def device(kind, folder, program):
    """The device by this wire, and its other end."""
    if kind == "serial":
        address, wire = str(folder / "line"), lambda: opened(folder / "line")
        (folder / "line").unlink(missing_ok=True)
    else:
        port = free_port(socket.SOCK_DGRAM if kind == "udp" else socket.SOCK_STREAM)
        address, wire = f"127.0.0.1:{port}", (lambda: Datagrams(port)) if kind == "udp" else (lambda: connected(port))
    with reference.Device(*program, *([] if kind == "python" else [kind]), address) as played:
        other = wire()
        try:
            yield played, other
        finally:
            other.close()


class Judge:
    """The duties, one after the other; each says what is wrong by raising."""

    def __init__(self, played, wire, kind):
        self.played, self.wire, self.kind, self.sequence = played, wire, kind, 0

    def tell(self, epoch, velocity, **more):
        """A command and the answer to it."""
        self.sequence += 1
        end = time.monotonic() + PATIENCE
        self.wire.send(command(epoch, self.sequence, velocity, **more))
        while True:
            frame = self.wire.receive(0.2 if self.kind == "udp" and self.sequence == 1 else PATIENCE)
            if frame is not None:
                answer = status(frame)
                assert answer is not None, "its answer is no status"
                return answer
            # Of datagrams the first one may come before the device listens.
            assert self.sequence == 1 and time.monotonic() < end, "a command is not answered"
            self.wire.send(command(epoch, self.sequence, velocity, **more))

    def silent(self):
        return self.wire.receive(0.1) is None

    def rest(self, epoch):
        with self.played.changed:
            moves = self.played.lines and self.played.lines[-1]["output"] in ("active", "stopping")
        if moves:
            before = self.played.count()
            self.tell(epoch, 0.0, mode=OFF)
            self.played.wait("holding", PATIENCE, before)

    def active(self, epoch, velocity):
        """Moves; so far the device has not been told of this epoch."""
        self.rest(epoch - 1)
        before = self.played.count()
        answer = self.tell(epoch, velocity)
        assert answer["epoch"] == epoch, "a higher epoch is not taken over"
        line = self.played.wait("active", PATIENCE, before)
        assert abs(line["velocity"] - velocity) < 1e-9, "it does not do what it is told"

    def lets_go_who_begins(self):
        """The first of all: it has heard nobody yet."""
        answer = self.tell(1, 2.0)
        assert answer["sequence"] == self.sequence and answer["epoch"] == 1
        assert answer["flags"] & TRIPPED, "it has just begun, is told to be active, and does not say that it is let go"
        assert self.silent() and not self.played.count(), "it moves though it has just begun"

    def answers_each_command(self):
        for velocity in (0.5, -0.25, 3.0):
            answer = self.tell(1, velocity)
            assert answer["sequence"] == self.sequence, "the answer does not name its command"

    def refuses_what_is_no_command(self):
        good = command(1, 99, 1.0)
        for wrong in (b"", good[:-1], good[:-1] + b"\0", b"\0\0" + good[2:], good[:2] + b"\2" + good[3:]):
            self.wire.send(wrong)
        assert self.silent(), "what is no command is answered"
        assert self.tell(1, 1.0)["sequence"] == self.sequence

    def refuses_who_was_fenced(self):
        self.tell(5, 1.0)
        answer = self.tell(4, 2.0)
        assert answer["flags"] & OLD_EPOCH and answer["epoch"] == 5, "an older epoch is not refused"
        assert answer["sequence"] != self.sequence, "what was refused counts as accepted"
        assert not self.tell(5, 1.0)["flags"] & OLD_EPOCH

    def watchdog_stops_it(self):
        self.played.wait("active", PATIENCE)  # since it was told so above; its line may be late
        self.active(6, 2.0)
        since, before = time.monotonic(), self.played.count()
        line = self.played.wait("stopping", PATIENCE, before)
        assert 0.03 < line["at"] - since < 1.0, f"after {line['at'] - since:.3f} s"
        assert line["flags"] & TRIPPED
        rest = self.played.wait("holding", PATIENCE, before)
        assert 0.09 < rest["at"] - line["at"] < 1.0 and rest["velocity"] == 0, "the stop is not its declared one"

    def latch_opens_for_a_higher_epoch_alone(self):
        before = self.played.count()
        for _ in range(5):
            answer = self.tell(6, 2.0)
            assert answer["flags"] & TRIPPED, "the same epoch gives back what the watchdog took"
        assert self.silent() and not [line for line in self.played.lines[before:] if line["output"] == "active"]
        self.active(7, 2.0)

    def stops_when_it_is_told(self):
        self.active(8, 4.0)
        before = self.played.count()
        self.tell(8, 4.0, mode=STOP)
        assert self.played.wait("stopping", PATIENCE, before)["flags"] == 0
        self.played.wait("holding", PATIENCE, before)
        self.tell(8, float("nan"), mode=ACTIVE)
        assert self.tell(8, 0.0)["velocity"] in (0.0, 4.0), "what is no number is done"

    def finds_its_place_again(self):
        if isinstance(self.wire, Datagrams):
            return
        good = streamed(command(8, 1000, 0.0))
        for harm in (b"HS", good[:17], good[5:], bytes(200), good[:20] + b"x" + good[21:], good[:10] + good[11:]):
            self.wire.put(harm)
            for _ in range(3):                       # one or two frames may be gone with it
                self.sequence += 1
                self.wire.send(command(8, self.sequence, 0.0))
            answer = None
            while answer is None or answer["sequence"] != self.sequence:
                frame = self.wire.receive(PATIENCE)
                assert frame is not None, f"after {harm[:8]} it is lost"
                answer = status(frame)

    def waits_for_nobody(self):
        """Nobody reads its answers; it goes on, and by its own watchdog it stops."""
        self.active(9, 1.0)
        before = self.played.count()
        burst = streamed(command(9, 0, 1.0, watchdog_us=100_000)) if isinstance(self.wire, Stream) else command(9, 0, 1.0, watchdog_us=100_000)
        end = time.monotonic() + 1.0
        descriptor = self.wire.descriptor if isinstance(self.wire, Stream) else self.wire.socket.fileno()
        os.set_blocking(descriptor, False)
        while time.monotonic() < end:
            # It may also leave who does not read.
            with contextlib.suppress(BlockingIOError, ConnectionError):
                os.write(descriptor, burst)
        self.played.wait("stopping", PATIENCE, before)

    DUTIES = (lets_go_who_begins, answers_each_command, refuses_what_is_no_command, refuses_who_was_fenced, watchdog_stops_it,
              latch_opens_for_a_higher_epoch_alone, stops_when_it_is_told, finds_its_place_again, waits_for_nobody)


# What stands in the device, what does in its place, and which duty is broken by it.
MUTANTS = (
    ("take(frame, octets, now)) answer();", "take(frame, octets, now) && axis.sequence % 2) answer();", "answers_each_command"),
    ("get(frame + octets - 2, 2) != crc16(frame, octets - 2)", "0", "refuses_what_is_no_command"),
    ("if (epoch < axis.epoch)", "if (0)", "refuses_who_was_fenced"),
    ("if (axis.mode != OFF && now >= axis.watchdog_at)", "if (0)", "watchdog_stops_it"),
    ("if (epoch > axis.epoch) axis.flags &=", "axis.flags &=", "latch_opens_for_a_higher_epoch_alone"),
    ("if (axis.mode == ACTIVE && !(axis.flags & TRIPPED))", "if (axis.mode != OFF && !(axis.flags & TRIPPED))", "stops_when_it_is_told"),
    ("if (!axis.heard && axis.mode == ACTIVE)", "if (0)", "lets_go_who_begins"),
    ("++at; /* duty 7", "break; /* duty 7", "finds_its_place_again"),
    # It waits for a command, and so its watchdog does not run.
    ("wire = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);", "wire = posix_openpt(O_RDWR | O_NOCTTY);", "watchdog_stops_it"),
)


class WithFolder(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="hirosco-duties-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)


    def tried_own(self, kind, address, **about):
        end = time.monotonic() + PATIENCE
        while True:
            try:
                return own_device.tried(lambda: own_device.wire_to(kind, address), **about)
            except (AssertionError, ConnectionRefusedError):  # it does not listen yet
                if time.monotonic() > end:
                    raise


class Kept(WithFolder):
    def judge(self, kind, program, duties=Judge.DUTIES):
        with device(kind, self.folder, program) as (played, wire):
            judge = Judge(played, wire, kind)
            for duty in duties:
                with self.subTest(kind=kind, duty=duty.__name__):
                    duty(judge)

    def test_in_c_by_datagrams(self):
        self.judge("udp", [reference.built(self.folder)])

    def test_in_c_by_tcp(self):
        self.judge("tcp", [reference.built(self.folder)])

    def test_in_c_by_a_serial_line(self):
        self.judge("serial", [reference.built(self.folder)])

    def test_in_python_by_tcp(self):
        self.judge("python", [reference.PYTHON, "-B", FOLDER / "device.py"])

    def test_who_begins_in_a_motion_stays_let_go_and_is_taken_up_by_a_higher_epoch_or_after_off(self):
        for kind, program in (("udp", [reference.built(self.folder)]), ("python", [reference.PYTHON, "-B", FOLDER / "device.py"])):
            for first in (ACTIVE, OFF, STOP):
                with self.subTest(kind=kind, first=first), device(kind, self.folder, program) as (played, wire):
                    judge = Judge(played, wire, kind)
                    answers = [judge.tell(7, 2.0, mode=first)] + [judge.tell(7, 2.0) for _ in range(5)]
                    self.assertEqual([answer["flags"] for answer in answers], 6 * [TRIPPED if first == ACTIVE else 0])
                    if first == ACTIVE:
                        self.assertTrue(judge.silent() and not played.count())
                        judge.tell(8, 2.0)
                    self.assertEqual(played.wait("active", PATIENCE)["epoch"], 8 if first == ACTIVE else 7)

    def test_as_a_device_of_ones_own(self):
        for kind, program in (("udp", [reference.built(self.folder), "udp"]), ("tcp", [reference.PYTHON, "-B", FOLDER / "device.py"])):
            address = f"127.0.0.1:{free_port(socket.SOCK_DGRAM if kind == 'udp' else socket.SOCK_STREAM)}"
            with self.subTest(kind=kind), reference.Device(*program, address):
                self.assertEqual(self.tried_own(kind, address, takes=8, gives=16, just_begun=True), [])
                again = own_device.Own(own_device.Wire(kind, address), takes=8, gives=16, just_begun=True)
                with self.assertRaisesRegex(AssertionError, "had somebody spoken with it before"):
                    again.lets_go_who_begins()
                again.wire.close()

    def tried_arm(self, kind, frames, enable_kind, enable):
        with subprocess.Popen([pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco-sim-robot", "--transfer", kind, "--address", frames, "--actuator",
                               "--enable-transfer", enable_kind, "--enable-address", enable, "--stop", "controlled", "--stop-within-ms", "200"], stdin=subprocess.PIPE) as arm:
            self.addCleanup(arm.kill)
            end = time.monotonic() + PATIENCE
            while enable_kind == "unix" and not pathlib.Path(enable).exists():
                self.assertLess(time.monotonic(), end, "it has no second inhibit")
            second = own_device.Enable(enable_kind, enable)
            broken = self.tried_own(kind, frames, takes=17, gives=89, enable=second, just_begun=True)
            second.end()
            arm.stdin.close()  # it goes last, and takes away what was between them
            arm.wait(PATIENCE)
            return broken

    @unittest.skipUnless("HIROSCO_BIN" in os.environ, "HIROSCO_BIN names the folder of a simulated arm")
    def test_as_a_device_with_a_second_inhibit(self):
        self.assertEqual(self.tried_arm("udp", f"127.0.0.1:{free_port(socket.SOCK_DGRAM)}", "unix", str(self.folder / "enable")), [])

    @unittest.skipUnless("HIROSCO_BIN" in os.environ, "HIROSCO_BIN names the folder of a simulated arm")
    def test_as_a_driver_in_this_computer(self):
        name = f"duties-{os.getpid()}"
        for kind, left in (("shared_memory", (f"/dev/shm/hirosco/{name}/frames", f"/dev/shm/hirosco.{name}-enable")),
                           ("message_queue", (f"/dev/mqueue/hirosco.{name}.to_device", f"/dev/mqueue/hirosco.{name}-enable.to_device"))):
            with self.subTest(kind=kind):
                self.assertEqual(self.tried_arm(kind, name, kind, f"{name}-enable"), [])
                self.assertEqual([file for file in left if os.path.exists(file)], [], "nothing is left of them")
        os.rmdir(f"/dev/shm/hirosco/{name}")

    def test_a_side_that_somebody_has_is_not_taken(self):
        for kind in ("shared_memory", "message_queue"):
            name = f"duties-{kind}-{os.getpid()}"
            with self.subTest(kind=kind):
                first = own_device.wire_to(kind, name)
                with self.assertRaisesRegex(OSError, "this side of it is open"):
                    own_device.wire_to(kind, name)
                first.close()
                again = own_device.wire_to(kind, name)
                again.send(bytes(22))  # nobody is there
                self.assertIsNone(again.receive(0))
                again.close()
        os.rmdir(f"/dev/shm/hirosco/duties-shared_memory-{os.getpid()}")

    def test_an_arm_in_python_with_a_second_inhibit_by_either_way(self):
        for kind in ("udp", "unix"):
            with self.subTest(kind=kind):
                frames, enable = (f"127.0.0.1:{free_port(socket.SOCK_DGRAM)}" for _ in range(2))
                if kind == "unix":
                    enable = str(self.folder / "arm-enable")
                    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as killed:
                        killed.bind(enable)  # what a driver leaves that did not end by itself
                with subprocess.Popen([reference.PYTHON, "-B", FOLDER / "arm.py", frames, enable]) as arm:
                    self.addCleanup(arm.kill)
                    end = time.monotonic() + PATIENCE
                    while kind == "unix" and not self.is_somebodys(enable):
                        self.assertLess(time.monotonic(), end, "it has no second inhibit")
                    second = own_device.Enable(kind, enable)
                    self.assertEqual(self.tried_own("udp", frames, takes=48, gives=144, enable=second, just_begun=True), [])
                    second.end()
                    arm.kill()

    def test_a_second_inhibit_that_nobody_hears_is_said_once_with_what_to_do(self):
        """A driver answers to the name by which it was asked, in its own folder: asked from another one it never does."""
        below = self.folder / "driver/below"
        below.mkdir(parents=True)
        frames = f"127.0.0.1:{free_port(socket.SOCK_DGRAM)}"
        with subprocess.Popen([reference.PYTHON, "-B", FOLDER / "arm.py", frames, "arm-enable"], cwd=self.folder / "driver") as arm:
            self.addCleanup(arm.kill)
            end = time.monotonic() + PATIENCE
            while not self.is_somebodys(str(self.folder / "driver/arm-enable")):
                self.assertLess(time.monotonic(), end, "it has no second inhibit")
            done = subprocess.run([reference.PYTHON, "-B", HERE / "duties_test.py", "udp", frames, "--takes", "48", "--gives", "144", "--enable", "unix",
                                   "../arm-enable", "--rest", "0.5"], cwd=below, capture_output=True, text=True, check=False)
            arm.kill()
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("nothing at all answers at unix ../arm-enable, its second inhibit", done.stderr)
        self.assertIn("type this in the same folder", done.stderr)
        self.assertNotIn("BROKEN", done.stdout)

    @staticmethod
    def is_somebodys(file):
        """Of the file of a socket that nobody has connecting is refused."""
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe, contextlib.suppress(ConnectionRefusedError, FileNotFoundError):
            probe.connect(file)
            return True
        return False

    def test_without_its_neighbours_it_says_in_one_line_who_is_lacking_and_whence_to_copy(self):
        neighbours = ("local_wires.py", "reference.py", "own_device.py")
        for name in ("duties_test.py", *neighbours):
            shutil.copy(HERE / name, self.folder)
        tried = [reference.PYTHON, "-B", self.folder / "duties_test.py", "--help"]
        self.assertEqual(subprocess.run(tried, capture_output=True, check=False).returncode, 0, "nothing else is wanted")
        for name in neighbours:
            (self.folder / name).unlink()
            done = subprocess.run(tried, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(f"duties_test: {name} is not beside it in {self.folder.resolve()}: ", done.stderr)
            self.assertIn("copy the whole folder, /usr/share/doc/hirosco/examples/device", done.stderr)
            shutil.copy(HERE / name, self.folder)

    def test_they_are_as_small_as_they_are_said_to_be(self):
        self.assertLessEqual(len((FOLDER / "device.c").read_text().splitlines()), 200)
        self.assertLessEqual(len((FOLDER / "device.py").read_text().splitlines()), 80)


class Broken(WithFolder):
    def test_a_device_that_breaks_a_duty_is_found(self):
        text = (FOLDER / "device.c").read_text()
        for old, new, duty in MUTANTS:
            with self.subTest(duty=duty):
                self.assertIn(old, text)
                source, program = self.folder / "mutant.c", self.folder / "mutant"
                source.write_text(text.replace(old, new))
                reference.compiled(source, program)
                with device("serial", self.folder, [program]) as (played, wire):
                    judge, found = Judge(played, wire, "serial"), None
                    for each in Judge.DUTIES:
                        try:
                            each(judge)
                        except AssertionError:
                            found = each.__name__
                            break
                self.assertEqual(found, duty)

    def test_of_ones_own_as_well(self):
        text = (FOLDER / "device.c").read_text()
        # The last is of a serial line; whether it stops for mode Stop is seen by a second inhibit alone, which it does not have.
        for old, new, duty in [each for each in MUTANTS[:-1] if each[2] != "stops_when_it_is_told"]:
            with self.subTest(duty=duty):
                source, program = self.folder / "mutant.c", self.folder / "mutant"
                source.write_text(text.replace(old, new))
                reference.compiled(source, program)
                address = f"127.0.0.1:{free_port(socket.SOCK_STREAM)}"
                with reference.Device(program, "tcp", address):
                    found = self.tried_own("tcp", address, takes=8, gives=16, just_begun=True)
                    self.assertNotEqual(found, [])
                    if duty == "lets_go_who_begins":
                        self.assertEqual(found, [duty], "and nothing else is wrong with it")


if __name__ == "__main__":
    if sys.argv[1:] and sys.argv[1] in (*own_device.KINDS, "--help"):
        sys.exit(own_device.main(sys.argv[1:]))
    unittest.main(verbosity=2)
