# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The supervisor as a subsystem sees it: starts the process, holds its pages and its channel, beats, plays devices and partners of
links, and keeps all that the process says."""
import contextlib
import fcntl
import mmap
import os
import pathlib
import select
import signal
import socket
import struct
import subprocess
import tempfile
import time

import wire
from described import STATES

VITAL_OCTETS, PERMIT_OCTETS, MAGIC, VERSION = 4976, 56, 0x48495243, 8
SEAL_SEAL, SEAL_SHRINK, SEAL_GROW, SEAL_FUTURE_WRITE = 1, 2, 4, 16
ADD_SEALS, GET_SEALS = 1033, 1034
BEAT_S, SOURCE, FENCE = 0.01, 1, 0x3FF0
INSTANCE = "conform"
OFFLINE, PRE, SAFE, OPERATIONAL, ERROR, POST = 0, 3, 4, 5, 6, 7
ENDS = {2, 4, 7, 8, 10}


class Failed(Exception):
    """A duty that is not done, in words."""


class Passed(Exception):
    """There is nothing to judge, in words."""


def expect(condition, words):
    if not condition:
        raise Failed(words)


def sealed_memory(name, octets, seals=SEAL_SHRINK | SEAL_GROW):
    memory = os.memfd_create(name, os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    os.ftruncate(memory, octets)
    fcntl.fcntl(memory, ADD_SEALS, seals)
    return memory


class Page:
    """Words of 4 and 8 octets, each written and read as a whole."""

    def __init__(self, memory, octets, readonly=False):
        self.mapping = mmap.mmap(memory, octets, prot=mmap.PROT_READ if readonly else mmap.PROT_READ | mmap.PROT_WRITE)
        self.view = memoryview(self.mapping)
        self.narrow, self.wide = self.view[:octets // 4 * 4].cast("I"), self.view[:octets // 8 * 8].cast("Q")

    def u32(self, at):
        return self.narrow[at // 4]

    def u64(self, at):
        return self.wide[at // 8]

    def set32(self, at, value):
        self.narrow[at // 4] = value & 0xFFFFFFFF

    def set64(self, at, value):
        self.wide[at // 8] = value & (1 << 64) - 1


def checked(word):
    """The number of a checked word; the word itself, larger than every number, where it is damaged."""
    return word & 0xFFFF if word >> 16 == ~word & 0xFFFF else word | 0x10000


class Outcome:
    """What came of one telecommand, in order."""

    def __init__(self, reports, request):
        self.reports = reports
        self.stages = [report for report in reports if report.kind[0] == 1 and report.data[:4] == request]
        self.others = [report for report in reports if report.kind[0] != 1]

    def kinds(self):
        return [report.kind for report in self.stages]

    def subtypes(self):
        return [report.kind[1] for report in self.stages]

    def failures(self):
        """[(subtype, code, data)]"""
        return [(r.kind[1], struct.unpack_from(">H", r.data, 4)[0], r.data[6:]) for r in self.stages if r.kind[1] in (2, 4, 8, 10)]

    def words(self):
        return ", ".join(report.words() for report in self.reports) or "nothing"

    def expect(self, subtypes, words, failures=None):
        expect(self.subtypes() == list(subtypes), f"{words}: expected stages {list(subtypes)}, came {self.words()}")
        if failures is not None:
            expect(self.failures() == list(failures), f"{words}: expected {[(s, hex(c), d.hex()) for s, c, d in failures]}, came {self.words()}")
        return self

    def expect_refused(self, subtype, code, data, words):
        return self.expect([subtype] if subtype in (2, 10) else [1, subtype], words, [(subtype, code, data)])

    def expect_done(self, words):
        return self.expect([1, 3, 7], words)


class Craft:
    """`with Craft(executable, descriptor) as craft:` starts the process; at the end it is ended by force where it still runs."""

    def __init__(self, executable, descriptor, version=VERSION, magic=MAGIC, folder=None, counters=b""):
        self.command, self.descriptor = list(executable), descriptor
        self.folder = pathlib.Path(folder or tempfile.gettempdir())
        vital, permit = sealed_memory("conform-vital", VITAL_OCTETS), sealed_memory("conform-permit", PERMIT_OCTETS)
        self.vital, self.permit = Page(vital, VITAL_OCTETS), Page(permit, PERMIT_OCTETS)
        for page in (self.vital, self.permit):
            page.set32(0, magic)
            page.set32(4, version)
        for at in (8, 12, 24, 28):
            self.vital.set32(at, 0xFFFF0000)
        self.vital.mapping[1632:1632 + len(counters)] = counters
        self.permit.set32(8, 1000)
        self.permit.set32(24, 1)
        fcntl.fcntl(permit, ADD_SEALS, SEAL_FUTURE_WRITE)
        fcntl.fcntl(permit, ADD_SEALS, SEAL_SEAL)
        self.channel, self.theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.channel.setblocking(False)
        self.theirs.setblocking(False)
        self.pages = vital, permit
        self.reports, self.events, self.problems, self.unread = [], [], [], []
        self.partners, self.watches = [], []
        self.count, self.beats, self.beating, self.next_beat, self.closed = 0, 0, True, 0.0, False
        self.addresses = {}
        self.pages_taken = 0

    # --- life --------------------------------------------------------------------------------------------------------------

    def __enter__(self):
        given = self.theirs.fileno(), *self.pages
        words = ["--descriptor", str(self.descriptor.file), "--as", f"{self.descriptor.name}:{self.descriptor.apid}"]
        for device, address in self.addresses.items():
            words += ["--address", f"{device}={address}"]
        # As the supervisor gives them: 3, 4 and 5.
        parked = [fcntl.fcntl(number, fcntl.F_DUPFD_CLOEXEC, 100) for number in given]
        self.errors = tempfile.TemporaryFile()
        epoch_ns = time.time_ns() - time.monotonic_ns() + (wire.EPOCH_S + wire.SHIFT_S) * 10**9

        def place():
            os.setpgid(0, 0)
            for number, target in zip(parked, (3, 4, 5)):
                os.dup2(number, target)

        self.process = subprocess.Popen(
            [*self.command, *words, "--channel", "3", "--vital", "4", "--permit", "5"], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=self.errors, close_fds=False, preexec_fn=place, cwd=self.folder,
            env={**os.environ, "HIROSCO_INSTANCE": INSTANCE, "HIROSCO_EPOCH_NS": str(epoch_ns)})
        for number in parked:
            os.close(number)
        self.theirs.close()
        for memory in self.pages:
            os.close(memory)
        return self

    def __exit__(self, *_):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.channel.close()
        for partner in self.partners:
            partner.close()
        self.errors.close()

    def said(self):
        """What it has written to its standard error."""
        self.errors.seek(0)
        return self.errors.read().decode(errors="replace")

    def ended(self):
        return self.process.poll()

    def wait_end(self, seconds):
        """Its exit code; negative: a signal."""
        self.until(lambda: self.ended() is not None, seconds, watch_process=False)
        return self.ended()

    def wait_alive(self):
        """Its service loop runs."""
        expect(self.until(lambda: self.vital.u64(48) > 0, 10),
               f"no step of its service loop in 10 s; it said: {self.said()[-300:]}")
        return self

    def hang_up(self):
        """The supervisor is gone."""
        self.channel.close()
        self.closed = True
        self.beating = False

    # --- time --------------------------------------------------------------------------------------------------------------

    def pump(self, seconds=0.001):
        now = time.monotonic()
        if self.beating and now >= self.next_beat:
            self.beats += 1
            self.permit.set64(32, self.beats)
            self.next_beat = now + BEAT_S
        due = min([now + seconds, self.next_beat if self.beating else now + seconds, *(partner.step(now) for partner in self.partners)])
        waits = [partner for partner in self.partners if partner.fileno() is not None]
        ready, _, _ = select.select(([] if self.closed else [self.channel]) + waits, [], [], max(0.0, due - time.monotonic()))
        for each in ready:
            if each is self.channel:
                self._receive()
            else:
                each.readable()
        for watch in self.watches:
            watch()

    def until(self, condition, seconds, watch_process=True):
        """Whether it came true in time."""
        end = time.monotonic() + seconds
        while not condition():
            if watch_process and self.ended() is not None:
                raise Failed(f"the process ended with {self.ended()}; it said: {self.said()[-300:]}")
            if time.monotonic() > end:
                return bool(condition())
            self.pump()
        return True

    def wait(self, seconds):
        self.until(lambda: False, seconds)

    def _receive(self):
        while not self.closed:
            try:
                octets, ancillary, _, _ = self.channel.recvmsg(8192, 4096)
            except (BlockingIOError, ConnectionResetError):
                return
            for level, kind, data in ancillary:
                if (level, kind) == (socket.SOL_SOCKET, socket.SCM_RIGHTS):
                    for (number,) in struct.iter_unpack("i", data[:len(data) // 4 * 4]):
                        os.close(number)
                    self.problems.append("a descriptor came with a message of it")
            if not octets:
                self.closed = True
                return
            self._take(octets, time.monotonic())

    def _take(self, octets, now):
        if octets == b"\x04\x01" + bytes(6):
            self.pages_taken += 1
        elif len(octets) < 8 or octets[1] != 1 or octets[0] not in (1, 3):
            self.problems.append(f"a message that is none: {octets[:16].hex()}")
        elif octets[0] == 3:
            body = octets[8:]
            if len(body) < 4 or not 1 <= body[0] <= 4 or body[1] > 1 or body[2:4] == b"\0\0":
                self.problems.append(f"an event message that is none: {body[:16].hex()}")
            else:
                self.events.append((body[0], body[1], struct.unpack_from(">H", body, 2)[0], body[4:], now))
        else:
            report = wire.Report.of(octets[8:], now)
            if isinstance(report, str):
                self.problems.append(report)
            else:
                report.after_event = len(self.events)
                self.reports.append(report)

    # --- telecommands ------------------------------------------------------------------------------------------------------

    def send_message(self, octets, descriptors=(), kind=1, version=1, mode_epoch=0, envelope=True):
        head = struct.pack(">BBHI", kind, version, 0, mode_epoch) if envelope else b""
        ancillary = [(socket.SOL_SOCKET, socket.SCM_RIGHTS, struct.pack(f"{len(descriptors)}i", *descriptors))] if descriptors else []
        end = time.monotonic() + 5
        while True:
            try:
                return self.channel.sendmsg([head + octets], ancillary)
            except BlockingIOError:
                if time.monotonic() > end:
                    raise Failed("it has not read its channel for 5 s") from None
                self.pump()
            except (BrokenPipeError, ConnectionResetError):
                raise Failed(f"it closed its channel; it said: {self.said()[-300:]}") from None

    def packet(self, service, subtype, data=b"", ack=wire.ALL, source=SOURCE, apid=None):
        self.count = self.count + 1 & 0x3FFF
        return wire.telecommand(self.descriptor.apid if apid is None else apid, self.count, service, subtype, data, ack, source)

    def send(self, service, subtype, data=b"", **options):
        message = {name: options.pop(name) for name in ("descriptors", "mode_epoch") if name in options}
        packet = self.packet(service, subtype, data, **options)
        self.send_message(packet, **message)
        return packet[:4]

    def ask(self, service, subtype, data=b"", seconds=10, **options):
        """Sends it and waits for its end."""
        first = len(self.reports)
        return self.outcome(first, self.send(service, subtype, data, **options), seconds)

    def outcome(self, first, request, seconds=10):
        ends = lambda: any(r.kind[0] == 1 and r.kind[1] in ENDS and r.data[:4] == request for r in self.reports[first:])
        expect(self.until(ends, seconds), f"no final report within {seconds} s; came: {Outcome(self.reports[first:], request).words()}")
        self.fence()
        return Outcome([r for r in self.reports[first:] if r.destination != FENCE], request)

    def fence(self, seconds=5):
        """Everything that was sent before has been read."""
        first = len(self.reports)
        request = self.send(17, 1, ack=wire.COMPLETION, source=FENCE)
        expect(self.until(lambda: any(r.kind == (1, 7) and r.data[:4] == request for r in self.reports[first:]), seconds),
               f"a PING was not answered within {seconds} s")

    def quiet_answers(self, octets, **options):
        """Reports that come of a message which is nobody's request."""
        first = len(self.reports)
        self.send_message(octets, **options)
        self.fence()
        return [r for r in self.reports[first:] if r.destination != FENCE and r.kind != (3, 25)]

    def set_state(self, state, seconds=12, **options):
        return self.ask(8, 1, wire.call("SET_STATE", [(1, bytes([state]))]), seconds, **options)

    def configure(self, number):
        return self.ask(8, 1, wire.call("CONFIGURE", [(1, bytes([number]))]))

    def state(self):
        return checked(self.vital.u32(8))

    def go(self, *states):
        for state in states:
            self.set_state(state).expect_done(f"SET_STATE {STATES[state]}")
        return self

    # --- the guard ---------------------------------------------------------------------------------------------------------

    def epoch(self):
        return self.permit.u32(8)

    def another_permit_page(self, epoch, permitted, seals=SEAL_SHRINK | SEAL_GROW | SEAL_FUTURE_WRITE, octets=PERMIT_OCTETS, version=VERSION):
        """As a supervisor that goes on for one that died hands it over; whether it is said to be in force. Ours from then on."""
        memory = sealed_memory("conform-permit", octets)
        page = Page(memory, octets)
        for at, value in ((0, MAGIC), (4, version), (8, epoch), (24, self.permit.u32(24))):
            page.set32(at, value)
        page.set64(16, wire.permission_word(epoch) if permitted else 0)
        fcntl.fcntl(memory, ADD_SEALS, seals)
        taken = self.pages_taken
        self.send_message(b"", [memory], kind=4)
        os.close(memory)
        self.until(lambda: self.pages_taken > taken, 1)
        if self.pages_taken > taken:
            self.permit = page
        return self.pages_taken > taken

    def permit_move(self):
        self.permit.set64(16, 0)
        self.permit.set32(8, self.epoch() + 1)
        self.permit.set32(12, 0)
        self.permit.set64(16, wire.permission_word(self.epoch()))

    def forbid(self):
        self.permit.set64(16, 0)
        self.permit.set32(8, self.epoch() + 1)
        self.permit.set32(12, 1)

    def inhibited(self):
        return self.vital.u32(16)

    # --- what it holds -----------------------------------------------------------------------------------------------------

    def holdings(self):
        """(open descriptors, shared mappings)"""
        folder = pathlib.Path(f"/proc/{self.process.pid}")
        shared = [line for line in (folder / "maps").read_text().splitlines() if "memfd:" in line or "/dev/shm" in line]
        return len(list((folder / "fd").iterdir())), len(shared)
