#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a process does not give back is seen, whatever it is: by one that takes and gives back as it is told."""
import subprocess
import sys
import time
import unittest

from holding import Holding, assert_gives_back, octets_in_use

TAKES = """
import ctypes, mmap, os, threading
libc = ctypes.CDLL(None)
libc.malloc.restype, libc.free.argtypes, libc.malloc.argtypes = ctypes.c_void_p, [ctypes.c_void_p], [ctypes.c_size_t]
held, over = [], threading.Event()
ways = {"heap": (lambda: libc.malloc(2000), libc.free), "descriptor": (lambda: os.open("/dev/null", os.O_RDONLY), os.close),
        "mapping": (lambda: mmap.mmap(-1, 4096), lambda it: it.close()), "thread": (lambda: (threading.Thread(target=over.wait, daemon=True).start()), None),
        "memory": (lambda: bytearray(b"x") * 1000000, lambda it: it.clear()), "nothing": (lambda: None, lambda it: None)}
while line := os.read(0, 64):
    way, what = line.decode().split()
    take, give = ways[what]
    held.append(take()) if way == "take" else give(held.pop())
    os.write(1, b"done\\n")
"""


class GivesBack(unittest.TestCase):
    def setUp(self):
        self.process = subprocess.Popen([sys.executable, "-c", TAKES], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.process.communicate)
        for _ in range(20):         # until the interpreter needs nothing for the first time
            for what in ("nothing", "heap", "descriptor", "mapping"):
                self.ask(f"take {what}", f"give {what}")
        self.before = Holding(self.process.pid)

    def ask(self, *lines):
        for line in lines:
            self.process.stdin.write(line.encode() + b"\n")
            self.process.stdin.flush()
            self.process.stdout.readline()

    def judge(self, what):
        time.sleep(0.05)
        assert_gives_back(self, self.before, Holding(self.process.pid), what)

    def test_what_is_given_back_is_not_missed(self):
        for what in ("heap", "descriptor", "mapping"):
            self.ask(f"take {what}", f"give {what}")
            self.judge(what)

    def test_what_is_kept_is_seen_the_first_time(self):
        self.assertIsNotNone(self.before.heap_octets, "the heap of a process of one's own may be looked at")
        for what in ("heap", "descriptor", "mapping", "thread", "memory"):
            with self.subTest(what):
                self.ask(f"take {what}")
                with self.assertRaises(AssertionError):
                    self.judge(what)
                if what != "thread":
                    self.ask(f"give {what}")


class Heap(unittest.TestCase):
    """Octets that are laid out as glibc would."""

    @staticmethod
    def piece(octets, before_in_use=True):
        return bytes(8) + (octets | before_in_use).to_bytes(8, "little") + bytes(octets - 16)

    def test_what_is_free_or_kept_for_the_next_time_is_not_in_use(self):
        cache = bytearray(self.piece(0x290))
        cache[16 + 2 * 3] = 1       # one piece of 80 octets
        heap = bytes(cache) + self.piece(80) + self.piece(160) + self.piece(320) + self.piece(4096, before_in_use=False)
        self.assertEqual(octets_in_use(heap), 0x290 + 160)

    def test_what_is_no_such_heap_is_not_looked_at(self):
        for heap in (b"", bytes(4096), self.piece(0x290)[:-16], self.piece(0x300) + self.piece(64)):
            self.assertIsNone(octets_in_use(heap))


if __name__ == "__main__":
    unittest.main()
