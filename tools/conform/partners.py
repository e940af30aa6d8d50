# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who a subsystem meets besides its supervisor: devices (docs/interfaces/devices.md) and the other ends of its real-time links
(docs/interfaces/memory.md)."""
import contextlib
import ctypes
import os
import platform
import socket
import struct
import sys
import threading
import time

import wire
from craft import ADD_SEALS, SEAL_FUTURE_WRITE, SEAL_SEAL, Page, sealed_memory
import fcntl

MAGICS = {1: (0x4B4E494C52435348, 2), 2: (0x5545555152435348, 1), 3: (0x4E414F4C52435348, 1)}
NONE, VALID, DEGRADED, STOPPING, FAULT = range(5)


def status_word(status):
    return (~status & 0xFFFFFFFF) << 32 | status


def status_of(word):
    return word & 0xFFFFFFFF if word in (status_word(s) for s in range(5)) else FAULT


class PlayedDevice:
    """Answers each command with a status; keeps what it was told."""

    def __init__(self, transfer, address, input_octets):
        family = socket.AF_UNIX if transfer == "unix" else socket.AF_INET
        self.socket = socket.socket(family, socket.SOCK_DGRAM)
        self.path = address if transfer == "unix" else None
        if self.path:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(self.path)
            self.socket.bind(self.path)
        else:
            host, port = address.rsplit(":", 1)
            self.socket.bind((host, int(port)))
        self.socket.setblocking(False)
        self.commands, self.problems = [], []
        self.answer, self.input = "well", bytes(input_octets)
        self.repeated = 0

    def fileno(self):
        return self.socket.fileno()

    def step(self, now):
        return now + 1

    def readable(self):
        while True:
            try:
                frame, peer = self.socket.recvfrom(2048)
            except (BlockingIOError, ConnectionRefusedError):
                return
            self._take(frame, peer, time.monotonic())

    def _take(self, frame, peer, now):
        if len(frame) < 22 or struct.unpack_from("<H", frame)[0] != 0x4844 or frame[2] != 1:
            self.problems.append(f"a frame that is none: {frame[:24].hex()}")
            return
        kind, mode, epoch, sequence, flags, octets, watchdog = struct.unpack_from("<BBIIHHI", frame, 2)
        if octets != len(frame) - 22 or struct.unpack_from("<H", frame, len(frame) - 2)[0] != wire.crc(frame[:-2]) or flags or mode > 2:
            self.problems.append(f"a damaged frame: {frame[:24].hex()}")
            return
        self.commands.append((mode, epoch, sequence, watchdog, frame[20:-2], now))
        if self.answer == "silent":
            return
        answered = self.repeated if self.answer == "repeated" else sequence
        self.repeated = answered
        status = struct.pack("<HBBIIHHI", 0x4844, 0x22 if self.answer == "of another version" else 2, 0, epoch, answered, 0, len(self.input), 0) + self.input
        status += struct.pack("<H", wire.crc(status) ^ (1 if self.answer == "damaged" else 0))
        if self.path:
            peer = self.path + ".subsystem"
        with contextlib.suppress(OSError):
            self.socket.sendto(status, peer)

    def close(self):
        self.socket.close()
        if self.path:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(self.path)


def link_octets(agreement):
    payload = agreement.payload()
    if agreement.kind == 1:
        return wire.up(96 + wire.up(payload, 8), 64)
    if agreement.kind == 2:
        return 128 + (agreement.depth + 1) * wire.up(24 + payload, 64)
    return 384 + 4 * wire.up(payload, 64)


class PlayedProducer:
    """Makes the memory of a link, and samples of zeros at the agreed period."""

    def __init__(self, agreement, epoch):
        self.agreement, self.epoch = agreement, epoch
        self.size = link_octets(agreement)
        self.memory = sealed_memory("conform-link", self.size)
        self.page = Page(self.memory, self.size)
        self.count = self.sequence = 0
        self.next, self.running, self.status = 0.0, True, VALID
        self.period_s = agreement.producer_ns / 1e9
        self.payload = bytes(wire.up(agreement.payload(), 8))
        magic, version = MAGICS[agreement.kind]
        words = {8: version << 32 | epoch, 16: agreement.payload(), 24: agreement.layout_hash(), 32: agreement.producer_ns}
        if agreement.kind == 2:
            words |= {40: agreement.depth, 72: status_word(NONE)}
        words |= {{1: 72, 2: 72, 3: 136}[agreement.kind]: status_word(NONE), 0: magic}
        for at, value in words.items():
            self.page.set64(at, value)

    def seal(self):
        fcntl.fcntl(self.memory, ADD_SEALS, SEAL_FUTURE_WRITE)
        fcntl.fcntl(self.memory, ADD_SEALS, SEAL_SEAL)
        return self

    def fileno(self):
        return None

    def step(self, now):
        if self.running and now >= self.next:
            self.write(self.payload)
            self.next = now + self.period_s if now - self.next > self.period_s else self.next + self.period_s
        return self.next if self.running else now + 1

    def write(self, payload):
        stamp = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
        self.count += 1
        put = self.page.set64
        words = [word for (word,) in struct.iter_unpack("=Q", payload)]
        if self.agreement.kind == 1:
            put(64, self.sequence + 1)
            for at, value in enumerate([status_word(self.status), self.count, stamp, *words]):
                put(72 + 8 * at, value)
            self.sequence += 2
            put(64, self.sequence)
            return
        if self.agreement.kind == 2:
            slot = 128 + self.count % (self.agreement.depth + 1) * wire.up(24 + self.agreement.payload(), 64)
            place, end = slot + 24, ((slot + 8, status_word(self.status)), (slot + 16, stamp), (slot, 2 * self.count),
                                     (72, status_word(self.status)), (80, stamp), (64, self.count))
        else:
            slot = 128 + 64 * (self.count % 4)
            place = 384 + self.count % 4 * wire.up(self.agreement.payload(), 64)
            end = ((slot + 8, status_word(self.status)), (slot + 16, stamp), (slot, 2 * self.count), (64, self.count))
        put(slot, 2 * self.count - 1)
        for at, value in enumerate(words):
            put(place + 8 * at, value)
        for at, value in end:
            put(at, value)

    def tell(self, status):
        """Changes the status without a sample."""
        self.status = status
        put = self.page.set64
        if self.agreement.kind == 1:
            put(64, self.sequence + 1)
            put(72, status_word(status))
            self.sequence += 2
            put(64, self.sequence)
        else:
            put(72 if self.agreement.kind == 2 else 136 + 64 * (self.count % 4), status_word(status))

    def close(self):
        if self.memory is not None:
            os.close(self.memory)
            self.memory = None


class PlayedConsumer:
    """Looks at the memory of a link as hard as it can, and says what is wrong with it."""

    def __init__(self, agreement, epoch):
        self.agreement, self.epoch = agreement, epoch
        self.size = link_octets(agreement)
        self.memory = sealed_memory("conform-link", self.size)
        self.page = Page(self.memory, self.size, readonly=True)
        self.samples, self.problems, self.last = [], [], 0
        self.looks = self.odd = 0

    def header(self):
        magic, version = MAGICS[self.agreement.kind]
        wanted = {"magic": (0, magic), "version and epoch": (8, version << 32 | self.epoch), "payload octets": (16, self.agreement.payload()),
                  "layout hash": (24, self.agreement.layout_hash()), "period": (32, self.agreement.producer_ns)}
        if self.agreement.kind == 2:
            wanted["depth"] = 40, self.agreement.depth
        return [f"{name} is 0x{self.page.u64(at):X}, not 0x{value:X}" for name, (at, value) in wanted.items() if self.page.u64(at) != value]

    def seals(self):
        return fcntl.fcntl(self.memory, 1034)

    def _place(self, count):
        payload = self.agreement.payload()
        if self.agreement.kind == 1:
            return 64, 72, 88, 96
        if self.agreement.kind == 2:
            slot = 128 + count % (self.agreement.depth + 1) * wire.up(24 + payload, 64)
            return slot, slot + 8, slot + 16, slot + 24
        return (*(at + 64 * (count % 4) for at in (128, 136, 144)), 384 + count % 4 * wire.up(payload, 64))

    def look(self):
        """One look at the newest sample, twice over: what changes under one even sequence is torn."""
        get = self.page.u64
        words = range(wire.up(self.agreement.payload(), 8) // 8)
        if self.agreement.kind == 1:
            sequence = get(64)
            self.looks, self.odd = self.looks + 1, self.odd + sequence % 2
            if sequence % 2 or sequence == 0:
                return
            status, count, stamp = get(72), get(80), get(88)
            expected = sequence
        else:
            count = get(64)
            if count == 0:
                return
            expected = 2 * count
            sequence = get(self._place(count)[0])
            if sequence != expected:
                if get(64) == count:
                    self.problems.append(f"newest is {count}, the sequence of its place {sequence}")
                return
            status, stamp = get(self._place(count)[1]), get(self._place(count)[2])
        at, _, _, place = self._place(count)
        first = [get(place + 8 * i) for i in words]
        again = [get(place + 8 * i) for i in words]
        if self.agreement.kind == 1 and get(80) != count:
            again = None
        if get(at) != expected:
            return
        if first != again:
            self.problems.append(f"sample {count} changed under an even sequence: torn")
        if count == self.last:
            return
        if count < self.last:
            self.problems.append(f"count goes back from {self.last} to {count}")
        for earlier in self.samples[-1:]:
            if stamp <= earlier[2]:
                self.problems.append(f"stamp of sample {count} is not behind that of {earlier[0]}")
        if status not in map(status_word, range(5)):
            self.problems.append(f"status word 0x{status:X}")
        self.last = count
        self.samples.append((count, status_of(status), stamp, struct.pack(f"={len(first)}Q", *first)[:self.agreement.payload()],
                             time.clock_gettime_ns(time.CLOCK_MONOTONIC)))

    def status(self):
        if self.agreement.kind == 3:
            return status_of(self.page.u64(136 + 64 * (self.page.u64(64) % 4)))
        return status_of(self.page.u64(72))

    def fileno(self):
        return None

    def step(self, now):
        for _ in range(20):
            self.look()
        return now + 0.0005

    def close(self):
        if self.memory is not None:
            os.close(self.memory)
            self.memory = None


class Sleeper(threading.Thread):
    """A consumer that sleeps on the word of its link (docs/interfaces/memory.md, Waking), until so many samples have woken it or one has not."""
    times = 10

    def __init__(self, consumer, patience_s):
        super().__init__(daemon=True)
        self.woken, self.patience_s, self.size = 0, patience_s, consumer.size
        self.system = ctypes.CDLL(None, use_errno=True)
        self.system.mmap.restype = ctypes.c_void_p
        self.system.mmap.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int, ctypes.c_int, ctypes.c_int, ctypes.c_long]
        self.base = self.system.mmap(None, self.size, 1, 1, consumer.memory, 0)             # PROT_READ, MAP_SHARED
        self.word = self.base + 64 + (0 if sys.byteorder == "little" else 4)
        self.start()

    def run(self):
        number = {"x86_64": 202, "aarch64": 98, "riscv64": 98}[platform.machine()]          # SYS_futex
        patience = (ctypes.c_long * 2)(int(self.patience_s), 0)
        while self.woken < self.times:
            seen = ctypes.c_uint32.from_address(self.word).value
            ended = self.system.syscall(ctypes.c_long(number), ctypes.c_void_p(self.word), ctypes.c_int(0), ctypes.c_uint32(seen), patience,
                                        None, ctypes.c_int(0))                              # FUTEX_WAIT
            if ended == 0 and ctypes.c_uint32.from_address(self.word).value != seen:
                self.woken += 1
            elif ended != 0 and ctypes.get_errno() == 110:                                  # ETIMEDOUT
                break
        self.system.munmap(ctypes.c_void_p(self.base), ctypes.c_size_t(self.size))
