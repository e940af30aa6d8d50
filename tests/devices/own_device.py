# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Tries a device of your own, which runs already, by its wire alone; nothing but Python's standard library:

  duties_test.py udp|tcp HOST:PORT --takes OCTETS --gives OCTETS [--enable KIND ADDRESS] [--values V,V,...] [--rest SECONDS] [--just-begun]
  duties_test.py serial FILE@BAUD  ...
  duties_test.py unix FILE  ...
  duties_test.py shared_memory|message_queue NAME  ...   a driver in this computer, by the name that its endnode has

--takes and --gives: sizes of the payloads, as <Output> and <Input> of the descriptor have them; a DOUBLE has 8 octets. --enable: of its second
inhibit, by any of these kinds; what it does is seen there alone, without it by its flags only. --values: DOUBLEs that it is told while it is active,
0 where not said.
--rest: within so long its stop has to be at rest. --just-begun: it was switched on or started just now and nobody has spoken with it
since; then its first command of all is to be active, which it may not obey (4: who begins is let go). It cannot be tried otherwise.
It IS told to be active: see to it that nothing falls when these values are done."""
import argparse
import os
import pathlib
import select
import socket
import struct
import sys
import termios
import threading
import time
import tty

from local_wires import MessageQueues, SharedMemory
from reference import ACTIVE, OFF, OLD_EPOCH, STOP, TRIPPED, crc, streamed

PATIENCE = 1.0
WATCHDOG_S = 0.05
KINDS = ("udp", "tcp", "serial", "unix", "shared_memory", "message_queue")
OUTPUTS = ("off", "active", "stopping", "holding")


class Wire:
    """Frames to it and from it, whatever the wire."""

    def __init__(self, kind, address):
        self.stream, self.octets, self.bound = kind not in ("udp", "unix"), b"", None
        if kind == "serial":
            name, _, baud = address.partition("@")
            self.descriptor = os.open(name, os.O_RDWR | os.O_NOCTTY)
            tty.setraw(self.descriptor)
            how = termios.tcgetattr(self.descriptor)
            how[4] = how[5] = getattr(termios, f"B{baud or 115200}")
            termios.tcsetattr(self.descriptor, termios.TCSANOW, how)
            return
        if kind == "unix":
            self.bound = pathlib.Path(f"{address}.subsystem")
            self.bound.unlink(missing_ok=True)
            self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            self.socket.bind(str(self.bound))
            self.socket.connect(address)
            self.descriptor = self.socket.fileno()
            return
        host, _, port = address.rpartition(":")
        self.socket = socket.socket(type=socket.SOCK_STREAM if self.stream else socket.SOCK_DGRAM)
        try:
            self.socket.connect((host, int(port)))
        except OSError:
            self.socket.close()
            raise
        if self.stream:
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.descriptor = self.socket.fileno()

    def close(self):
        if hasattr(self, "socket"):
            self.socket.close()
        else:
            os.close(self.descriptor)
        if self.bound:
            self.bound.unlink(missing_ok=True)

    def put(self, octets):
        while octets:
            octets = octets[os.write(self.descriptor, octets):]

    def flood(self, made, seconds):
        """Sends, and reads nothing of what comes."""
        os.set_blocking(self.descriptor, False)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                frame = made()
                os.write(self.descriptor, streamed(frame) if self.stream else frame)
            except (BlockingIOError, ConnectionRefusedError):
                time.sleep(0.0001)
            except ConnectionError:
                break  # it may leave who does not read
        os.set_blocking(self.descriptor, True)

    def send(self, frame):
        try:
            self.put(streamed(frame) if self.stream else frame)
        except ConnectionRefusedError:
            pass  # nobody listens there yet: no answer comes either

    def receive(self, seconds):
        """A frame; None: none came."""
        end = time.monotonic() + seconds
        while True:
            if len(self.octets) >= 6 and len(self.octets) >= (size := 8 + int.from_bytes(self.octets[2:4], "little")):
                frame, self.octets = self.octets[6:size - 2], self.octets[size:]
                return frame
            try:
                if not select.select([self.descriptor], [], [], max(0, end - time.monotonic()))[0]:
                    return None
                octets = os.read(self.descriptor, 4096)
            except ConnectionRefusedError:
                continue
            if not octets:
                raise AssertionError("it hung up")
            if not self.stream:
                return octets
            self.octets += octets


def wire_to(kind, address, of_supervisor=False):
    """Shared memory of who holds a second inhibit lies elsewhere than that of frames."""
    if kind == "shared_memory":
        return SharedMemory(address, of_supervisor)
    return MessageQueues(address) if kind == "message_queue" else Wire(kind, address)


class Enable(threading.Thread):
    """The supervisor's side of its second inhibit: a command each 5 ms, and what its newest answer says."""

    def __init__(self, kind, address):
        super().__init__(daemon=True)
        self.wire, self.epoch, self.on, self.output, self.answers = wire_to(kind, address, of_supervisor=True), 0, 0, None, 0
        self.place = f"{kind} {address}"
        self.over = threading.Event()
        self.start()

    def end(self):
        self.over.set()
        self.join()
        self.wire.close()

    def run(self):
        sequence = 0
        while not self.over.is_set():
            sequence += 1
            frame = struct.pack("<HBBHII", 0x4845, 0x33, self.on, 0, self.epoch, sequence)
            self.wire.send(frame + crc(frame))
            time.sleep(0.005)
            while (answer := self.wire.receive(0)) is not None:
                if len(answer) == 16 and answer[:3] == b"EH\x4c" and crc(answer[:-2]) == answer[-2:]:
                    self.output, self.answers = OUTPUTS[answer[3] & 3], self.answers + 1


class Own:
    def __init__(self, wire, takes, gives, values=(), enable=None, rest=1.0, just_begun=False):
        self.wire, self.gives, self.enable, self.rest, self.sequence = wire, gives, enable, rest, 0
        self.payload = struct.pack(f"<{len(values)}d", *values).ljust(takes, b"\0")
        assert len(self.payload) == takes, f"--values has {len(self.payload)} octets, --takes says {takes}"
        try:
            self.first = self.begin() if just_begun else None
            self.epoch = max((self.first or self.tell(1, OFF))["epoch"], 1)
        except AssertionError:
            wire.close()
            raise

    def begin(self):
        """The answer of who has heard nobody to its first command, which is Active. One may have kept its epoch: what it refuses it has not
        accepted."""
        self.name(1)
        answer = self.tell(1)
        if answer["flags"] & OLD_EPOCH:
            self.name(answer["epoch"] + 1)
            answer = self.tell(answer["epoch"] + 1)
        return answer

    def command(self, epoch, mode, payload=None, watchdog_s=WATCHDOG_S):
        self.sequence += 1
        payload = self.payload if payload is None else payload
        frame = struct.pack("<HBBIIHHI", 0x4844, 1, mode, epoch, self.sequence, 0, len(payload), int(watchdog_s * 1e6)) + payload
        return frame + crc(frame)

    def tell(self, epoch, mode=ACTIVE, **more):
        """A command and the answer to it. What came before is let go, as is what it says again by a clock of its own."""
        while self.wire.receive(0) is not None:
            pass
        self.wire.send(self.command(epoch, mode, **more))
        end = time.monotonic() + PATIENCE
        while True:
            frame = self.wire.receive(max(0, end - time.monotonic()))
            assert frame is not None, f"duty 1: a command is not answered within {PATIENCE} s; is it started, and by this address? Where other work has the processors (`uptime`), try again"
            answer = self.status(frame)
            if answer["sequence"] == self.sequence or answer["flags"] & OLD_EPOCH:
                return answer

    def status(self, frame):
        assert len(frame) == 22 + self.gives, f"its answer has {len(frame) - 22} octets of payload, --gives says {self.gives}"
        assert crc(frame[:-2]) == frame[-2:], "the CRC of its answer is wrong"
        magic, kind, _, its_epoch, sequence, flags, octets, _ = struct.unpack_from("<HBBIIHHI", frame)
        assert (magic, kind, octets) == (0x4844, 2, self.gives), "its answer is no status"
        return {"epoch": its_epoch, "sequence": sequence, "flags": flags}

    def next_epoch(self):
        """At rest, with a higher epoch, which its second inhibit has been told."""
        self.tell(self.epoch, OFF)
        self.output("off", "holding")
        self.epoch += 1
        self.name(self.epoch)

    def name(self, epoch):
        if self.enable:
            self.enable.epoch, self.enable.on = epoch, 1
            time.sleep(0.05)

    def heard_of_enable(self):
        """Once, before any duty: what never answers is not there, and no duty would say so."""
        if not self.enable:
            return
        self.name(self.epoch)
        end = time.monotonic() + self.rest
        while not self.enable.answers:
            assert time.monotonic() < end, (f"nothing at all answers at {self.enable.place}, its second inhibit: is the driver started with this name? "
                                            "A UNIX socket is a file of the folder in which it was started: type this in the same folder; "
                                            "of a flight with --instance NAME the name ends with .NAME")
            time.sleep(0.002)

    def output(self, *wanted):
        if not self.enable:
            return
        end = time.monotonic() + self.rest
        while self.enable.output not in wanted:
            assert time.monotonic() < end, f"after {self.rest} s it is {self.enable.output}, not {' or '.join(wanted)}"
            time.sleep(0.002)

    def keep_active(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = self.tell(self.epoch)
            assert not answer["flags"] & TRIPPED, "it says watchdog_tripped while commands come"
            time.sleep(0.005)
        return answer

    def lets_go_who_begins(self):
        "4: who begins is let go: told to be active first, it waits for a higher epoch"
        if self.first is None:
            return "not tried"
        answer = self.first
        for _ in range(5):
            assert answer["flags"] & TRIPPED, "its first command was to be active, and it does not say watchdog_tripped; or had somebody spoken with it before?"
            assert not self.enable or self.enable.output != "active", "it is active"
            time.sleep(0.01)
            answer = self.tell(self.epoch)

    def answers_each_command(self):
        "1: each command is answered, by its sequence"
        self.next_epoch()
        for _ in range(5):
            assert self.tell(self.epoch, OFF)["sequence"] == self.sequence, "the answer does not name its command"

    def fences(self):
        "2: an older epoch is refused"
        self.next_epoch()
        self.tell(self.epoch, OFF)
        answer = self.tell(self.epoch - 1, OFF)
        assert answer["flags"] & OLD_EPOCH, "flag old_epoch_refused is not set"
        assert answer["epoch"] == self.epoch and answer["sequence"] != self.sequence, "what was refused counts as accepted"
        assert not self.tell(self.epoch, OFF)["flags"] & OLD_EPOCH, "the flag stays"

    def watchdog(self):
        "3, 5: without commands its watchdog trips, and it stops"
        self.next_epoch()
        assert self.keep_active(0.1)["epoch"] == self.epoch, "a higher epoch is not taken over"
        self.output("active")
        time.sleep(6 * WATCHDOG_S)
        self.output("off", "holding")
        assert self.tell(self.epoch)["flags"] & TRIPPED, f"{6 * WATCHDOG_S:.1f} s without a command, and it does not say watchdog_tripped"

    def latch(self):
        "4: what the watchdog took comes back with a higher epoch only"
        for _ in range(5):
            assert self.tell(self.epoch)["flags"] & TRIPPED, "the same epoch gives it back"
        assert not self.enable or self.enable.output != "active", "it is active again by itself"
        self.next_epoch()
        self.keep_active(0.05)
        self.output("active")

    def stops(self):
        "5: it stops when it is told, by mode Stop and by mode Off"
        for mode in (STOP, OFF):
            self.next_epoch()
            self.keep_active(0.05)
            self.output("active")
            end = time.monotonic() + self.rest
            while time.monotonic() < end and (not self.enable or self.enable.output not in ("off", "holding")):
                assert not self.tell(self.epoch, mode)["flags"] & TRIPPED
                time.sleep(0.005)
                end = end if self.enable else 0
            self.output("off", "holding")

    def waits_for_nobody(self):
        "6: whoever floods it and does not read holds up nobody"
        self.next_epoch()
        self.wire.flood(lambda: self.command(self.epoch, OFF), 0.5)
        return "again"

    def takes_whole_frames(self):
        "7: what is no command is not answered, and after damage it finds its place again"
        self.next_epoch()
        good = self.command(self.epoch, OFF)
        for wrong in (good[:-1], good[:-1] + bytes([good[-1] ^ 1]), b"\0\0" + good[2:], good[:2] + b"\2" + good[3:], good[:-2] + b"\0" + good[-2:]):
            self.wire.send(wrong)
            time.sleep(0.01)  # of several that have come it may look at the newest alone
        end = time.monotonic() + 0.2
        while (frame := self.wire.receive(max(0, end - time.monotonic()))) is not None:
            assert self.status(frame)["sequence"] != self.sequence, "what is no command is answered"
        if self.wire.stream:
            whole = streamed(good)
            for harm in (b"HS", whole[:17], whole[5:], bytes(50), whole[:10] + whole[11:]):
                self.wire.put(harm)
                for _ in range(3):
                    self.wire.send(self.command(self.epoch, OFF))
                time.sleep(0.05)
        assert self.tell(self.epoch, OFF)["sequence"] == self.sequence, "after damage it is lost"

    def second_inhibit(self):
        "second inhibit: without a fresh enable command of its epoch it is not active"
        if not self.enable:
            return "not tried"
        for harm in ({"on": 0}, {"epoch": self.epoch + 100}):
            self.next_epoch()
            vars(self.enable).update(harm)
            time.sleep(0.15)
            before, end = self.enable.answers, time.monotonic() + 0.1
            while time.monotonic() < end:
                self.tell(self.epoch)
                time.sleep(0.005)
                assert self.enable.output != "active", f"it is active though its enable has {harm}"
            assert self.enable.answers > before, "it does not answer enable commands"
        self.enable.epoch = self.epoch

    DUTIES = (lets_go_who_begins, answers_each_command, fences, watchdog, latch, stops, takes_whole_frames, second_inhibit, waits_for_nobody)


def tried(connect, **about):
    """The duties that it breaks, told one a line."""
    broken = []
    own = Own(connect(), **about)
    try:
        own.heard_of_enable()
    except AssertionError:
        own.wire.close()
        raise
    print(f"the highest epoch that it has accepted is {own.epoch}; a flight in another folder has to begin above it (log/MISSION.epoch)")
    for duty in Own.DUTIES:
        try:
            found = duty(own)
            if found == "again":  # by a wire that is not full of what nobody read
                own.wire.close()
                time.sleep(0.2)  # what still waits before it leaves room for a datagram
                last, own = own, Own(connect(), **(about | {"just_begun": False}))
                assert own.epoch >= last.epoch - 1, "it forgot its epoch"
            print(f"{'-' if found == 'not tried' else 'ok':8}{duty.__doc__}", flush=True)
        except AssertionError as error:
            broken.append(duty.__name__)
            print(f"BROKEN  {duty.__doc__}: {error}", flush=True)
    own.wire.close()
    return broken


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("address")
    parser.add_argument("--takes", type=int, required=True)
    parser.add_argument("--gives", type=int, required=True)
    parser.add_argument("--enable", nargs=2, metavar=("KIND", "ADDRESS"))
    parser.add_argument("--values", type=lambda text: [float(each) for each in text.split(",")], default=[])
    parser.add_argument("--rest", type=float, default=1.0)
    parser.add_argument("--just-begun", action="store_true")
    asked = parser.parse_args(words)
    try:
        enable = Enable(*asked.enable) if asked.enable else None
        broken = tried(lambda: wire_to(asked.kind, asked.address), takes=asked.takes, gives=asked.gives, values=asked.values, enable=enable,
                       rest=asked.rest, just_begun=asked.just_begun)
        if enable:
            enable.end()
    except (AssertionError, OSError) as error:
        sys.exit(f"duties_test: {asked.kind} {asked.address}: {error}")
    return 1 if broken else 0
