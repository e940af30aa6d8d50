# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a process holds, as the system has it in /proc. Python's standard library only."""
import collections
import os
import pathlib
import re
import struct
import time


class Holding:
    """What a process holds now: descriptors, shared mappings, each by the name that the system has for it."""

    def __init__(self, pid):
        folder = pathlib.Path(f"/proc/{pid}")
        self.descriptors = collections.Counter()
        for entry in (folder / "fd").iterdir():
            try:
                self.descriptors[re.sub(r"\d{3,}", "N", os.readlink(entry))] += 1
            except FileNotFoundError:
                pass                       # closed while it was looked at
        self.mappings = collections.Counter()
        for line in (folder / "maps").read_text().splitlines():
            words = line.split(None, 5)
            if len(words) == 6 and words[1].endswith("s"):
                self.mappings[words[5].removesuffix(" (deleted)")] += 1
        status = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines() if ":" in line)
        self.memory_kb = int(status["RssAnon"].split()[0])
        self.data_kb = int(status["VmData"].split()[0])    # what it has mapped for itself alone, touched or not
        self.threads = int(status["Threads"])
        self.heap_octets = heap_in_use(pid)

    def devices(self):
        """Names of memory that it shares with devices."""
        named = [name for name in [*self.descriptors, *self.mappings] if name.startswith("/dev/shm/")]
        return sorted(set(named))

    def links(self):
        return sum(count for name, count in self.mappings.items() if name.startswith("/memfd:hirosco-link"))

    def __eq__(self, other):
        return (self.descriptors, self.mappings, self.threads) == (other.descriptors, other.mappings, other.threads)

    def __repr__(self):
        return f"{dict(self.descriptors)} {dict(self.mappings)} {self.threads} threads {self.memory_kb} kB"


# What may be more behind a way up and down than it was before: of what is in use, what the allocator keeps of the smallest freed pieces without a
# count that this can read (its fast bins; measured up to 256 octets, and nothing more in later rounds); of what is mapped, freed memory that it keeps
# because a piece above is in use (measured 300 to 340 kB behind the first way up, which later rounds use again).
SMALLEST_OCTETS, KEPT_KB = 1024, 512


def assert_gives_back(test, before, now, what):
    """Fails unless `now` a process holds what it held `before`: each descriptor, shared mapping and thread, and its memory."""
    test.assertEqual(now, before, what)
    if before.heap_octets is not None and now.heap_octets is not None:
        test.assertLess(now.heap_octets - before.heap_octets, SMALLEST_OCTETS, f"{what}: octets of the heap in use")
    test.assertLess(now.memory_kb - before.memory_kb, KEPT_KB, f"{what}: kB that it has for itself")
    test.assertLess(now.data_kb - before.data_kb, KEPT_KB, f"{what}: kB that it has mapped for itself")


def compared(before, now):
    """For the report: what is more than it was."""
    heap = "heap not looked at" if None in (before.heap_octets, now.heap_octets) else \
        f"{now.heap_octets - before.heap_octets:+d} octets of {before.heap_octets} of the heap in use"
    return f"{heap}, {now.memory_kb - before.memory_kb:+d} kB of {before.memory_kb} kept"


# Of glibc on 64 bits: the size of the first piece of a heap, in which its main thread notes what it has freed and keeps for the next time; where in
# it the counts of each size stand, and the least size.
CACHE_OCTETS, COUNTS, LEAST, GRAIN = 0x290, 64, 32, 16
LOOKS = 3


def heap_in_use(pid):
    """Octets of the heap of a process that are in use, and not only kept by its allocator for the next time. None: this may not be looked at,
    or it is the heap of another library."""
    with open(f"/proc/{pid}/maps", encoding="ascii") as maps:
        heap = next((line.split()[0] for line in maps if line.rstrip().endswith("[heap]")), None)
    if heap is None:
        return None
    begin, end = (int(place, 16) for place in heap.split("-"))
    for _ in range(LOOKS):
        try:
            with open(f"/proc/{pid}/mem", "rb", buffering=0) as memory:
                memory.seek(begin)
                used = octets_in_use(memory.read(end - begin))
        except OSError:
            return None
        if used is not None:
            return used
        time.sleep(0.01)            # it was just at it
    return None


def octets_in_use(heap):
    """As glibc lays it out: each piece has its size before it, whose lowest bit says whether the piece before is in use; the last one is free."""
    place, before, used = 0, 0, 0
    while place + GRAIN <= len(heap):
        word = int.from_bytes(heap[place + 8:place + 16], "little")
        size = word & ~7
        if size < LEAST or size % GRAIN or (place == 0 and size != CACHE_OCTETS):
            return None
        used += before if word & 1 else 0
        place, before = place + size, size
    if place == 0 or place != len(heap):
        return None
    kept = struct.unpack_from(f"={COUNTS}H", heap, GRAIN)
    return used - sum(count * (LEAST + GRAIN * size) for size, count in enumerate(kept))
