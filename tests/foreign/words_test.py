# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What docs/interfaces/memory.md says of Python: an item of a memoryview is stored and loaded as a whole. One process turns a word over, another
looks at it as hard as it can. That such a look can see a torn word a writer octet by octet shows, which is the control of this test."""
import mmap
import multiprocessing
import platform
import sys
import time
import unittest

ALL = (1 << 64) - 1


def whole(mapping, stop):
    view = memoryview(mapping).cast("Q")
    while not stop.value:
        for _ in range(1000):
            view[8] = ALL
            view[8] = 0


def octet_by_octet(mapping, stop):
    while not stop.value:
        for octet in (255, 0):
            for at in range(64, 72):
                mapping[at] = octet


def torn_words(writer, seconds):
    """(torn, looks)"""
    mapping, stop = mmap.mmap(-1, 4096), multiprocessing.get_context("fork").Value("i", 0)
    process = multiprocessing.get_context("fork").Process(target=writer, args=(mapping, stop))
    process.start()
    view, torn, looks, end = memoryview(mapping).cast("Q"), 0, 0, time.monotonic() + seconds
    seen = set()
    while time.monotonic() < end:
        for _ in range(1000):
            word = view[8]
            torn += word not in (0, ALL)
            seen.add(word)
        looks += 1000
    stop.value = 1
    process.join()
    return torn, looks, seen


@unittest.skipUnless(platform.machine() in ("x86_64", "AMD64"), "other processors need more than plain stores")
class Words(unittest.TestCase):
    def test_of_a_memoryview_are_never_torn(self):
        torn, looks, seen = torn_words(whole, 3.0)
        print(f"measured: {torn} torn words in {looks} looks, {sys.implementation.name} {platform.python_version()}")
        self.assertEqual(torn, 0)
        self.assertEqual(seen, {0, ALL}, "the writer did not run beside the reader")

    def test_octet_by_octet_are_seen_as_torn(self):
        for _ in range(10):
            torn, _, _ = torn_words(octet_by_octet, 1.0)
            if torn:
                return
        self.fail("a look that cannot see a torn word proves nothing")


if __name__ == "__main__":
    unittest.main()
