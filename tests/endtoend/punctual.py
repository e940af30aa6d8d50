#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""punctual.py SECONDS PROGRAM [WORD...]: runs a test of real processes, each attempt for SECONDS at most. One that fails is run again
only if the host was late meanwhile: if a thread above all others did not run for longer than the shortest watchdog of a device. Then
processors were taken from the machine as a whole, and no flight on it keeps its times. On a punctual host a failure is a failure."""
import collections
import os
import subprocess
import sys
import threading
import time

WATCHDOG_S = 0.010            # the shortest `watchdog_ms` of the shipped descriptors
ATTEMPTS = 5
SKIPPED = 77
ABOVE_ALL = 98                # the guard has 90, devices 85, cycles at most 80
PERIOD_S = 0.001
NOTABLE_S = 0.002             # what stood still for less is in the bounds of whoever judges


class Lateness:
    """The longest time for which a thread that wakes each millisecond did not run, on whichever processor, in seconds. The host
    stood still for that long or up to a millisecond less; counted from when the thread was due it would be up to a
    millisecond too little, and a device that let go would have had no reason. None: there is no right to stand above the
    others, and what is late may be our own doing."""

    def __init__(self):
        self.worst_s = 0.0
        self._stood_still = collections.defaultdict(lambda: collections.deque(maxlen=10_000))
        self._over = threading.Event()
        self._threads = [threading.Thread(target=self._watch, args=(processor,)) for processor in os.sched_getaffinity(0)]

    def __enter__(self):
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        for thread in self._threads:
            thread.join()

    def stood_still_s(self, begin, end):
        """How long the host stood still between these two of time.monotonic(), in seconds: of all processors the one that did for longest.
        What is to happen there takes as much longer. 0 where nobody could see it."""
        return max((sum(max(0.0, min(till, end) - max(since, begin)) for since, till in list(times))
                    for times in list(self._stood_still.values())), default=0.0)

    def _note(self, processor, begin, end):
        if self.worst_s is not None:
            self.worst_s = max(self.worst_s, end - begin)
            if end - begin > NOTABLE_S:
                self._stood_still[processor].append((begin, end))

    def _watch(self, processor):
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(ABOVE_ALL))
            os.sched_setaffinity(0, {processor})
        except OSError:
            self.worst_s = None
            return
        while not self._over.is_set():
            begin = time.monotonic()
            time.sleep(PERIOD_S)
            self._note(processor, begin, time.monotonic())


def waits_for_memory():
    """How often a process has slept until the host had a page of this machine's memory, since it runs: the interrupts by which KVM tells
    that such a page is there. No thread above all others sees these waits, as its own pages are there; 0 where nobody counts them."""
    with open("/proc/interrupts", encoding="ascii") as interrupts:
        counts = next((line.split()[1:] for line in interrupts if line.lstrip().startswith("HYP:")), [])
    return sum(int(count) for count in counts if count.isdigit())


def attempt(command, limit_s):
    """(exit code, how late the host was at worst)."""
    waits = waits_for_memory()
    try:
        return attempted(command, limit_s)
    finally:
        if (waited := waits_for_memory() - waits) > 0:
            print(f"processes slept {waited} times until the host had their memory", flush=True)


def attempted(command, limit_s):
    with Lateness() as lateness:
        try:
            code = subprocess.run(command, timeout=limit_s, check=False).returncode
        except subprocess.TimeoutExpired:
            print(f"no end after {limit_s:.0f} s", flush=True)
            return 1, None  # that is longer than any host is late
    return code, lateness.worst_s


def last_of(attempts, say=print):
    """The exit code of the first attempt that counts: it passed, was skipped, or failed on a punctual host."""
    for number, (code, worst_s) in enumerate(attempts, 1):
        if code in (0, SKIPPED):
            return code
        if worst_s is None or worst_s <= WATCHDOG_S:
            say(f"the host {'may have been late' if worst_s is None else f'was late by {1e3 * worst_s:.1f} ms at most'}: a failure is a failure")
            return code
        say(f"attempt {number} failed on a host that was late by {1e3 * worst_s:.1f} ms; a device waits {1e3 * WATCHDOG_S:.0f} ms")
    return code


def main():
    limit_s, command = float(sys.argv[1]), [sys.executable, "-B", *sys.argv[2:]]
    sys.exit(last_of((attempt(command, limit_s) for _ in range(ATTEMPTS)), lambda text: print(text, flush=True)))


if __name__ == "__main__":
    main()
