#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""hostile_member_test.py [TURNS]: what a subsystem that turns on everybody does to the wake-ups of another one. Both cycle at 2 kHz, at
one priority, on the one processor of all cycles, and no link joins them. The hostile one allocates until it is refused, spins at its
priority, writes over all that it may write; in turns, each beside as long a time of the same flight before. Until the guard has
taken its priority or its life it does what it likes: that time is told apart. Prints p50, p99.9 and the greatest, in microseconds."""
import array
import contextlib
import pathlib
import re
import signal
import sys
import time
import unittest

import flight

TURNS = int(sys.argv.pop(1)) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 5
BLOCK_S = 4.0
MOST = 1.5                    # times the p99.9 of the same flight without it
MISSION = pathlib.Path(__file__).resolve().parent / "hostile.xml"
ROGUE, VICTIM = "hirosco-rogue-manipulator", "hirosco-recorded-hello"


class Wakes:
    """Lateness of the victim's wake-ups since it was looked at last, as counts in bins of 1 us."""

    def __init__(self, pid):
        folder = pathlib.Path(f"/proc/{pid}/fd")
        self.file = next(entry for entry in folder.iterdir() if "memfd:wake-record " in str(entry.readlink()))
        self.before = self.read()

    def read(self):
        return array.array("I", self.file.read_bytes())

    def taken(self):
        now = self.read()
        counts = [(after - before) & 0xFFFFFFFF for after, before in zip(now, self.before)]
        self.before = now
        return counts


def at(counts, share):
    """The bin below which this share of all lies, in us; 0 of none."""
    left = sum(counts) * share
    for place, count in enumerate(counts):
        left -= count
        if left <= 0:
            return place
    return 0


def text(counts):
    greatest = max((place for place, count in enumerate(counts) if count), default=0)
    return f"{sum(counts):7} wake-ups, p50 {at(counts, 0.5)} us, p99.9 {at(counts, 0.999)} us, greatest {greatest} us"


def thread_of(pid, name):
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() == name:
            return int(task.name)
    raise AssertionError(f"no thread {name}")


class HostileMember(unittest.TestCase):
    def come_back(self, craft):
        for function, argument in (("SET_STATE", 3), ("CONFIGURE", 1), ("SET_STATE", 4), ("SET_STATE", 5)):
            end = time.monotonic() + 15.0
            while craft.tc("manipulator", function, argument)[0] != 0:
                self.assertLess(time.monotonic(), end, f"{function} {argument}")
                time.sleep(0.1)

    def allocates(self, craft, pid):
        craft.kill(ROGUE, signal.SIGUSR1)

    def spins(self, craft, pid):
        flight.spin(pid, thread_of(pid, "cycle"))

    def writes_over_everything(self, craft, pid):
        craft.kill(ROGUE, signal.SIGRTMIN)

    def turn(self, craft, wakes, deed):
        """Wake-ups in a time without it, until the guard has taken its priority, and beside it from then to its end."""
        wakes.taken()
        time.sleep(BLOCK_S)
        without = wakes.taken()
        begin = craft.count()
        deed(craft, craft.pid_of(ROGUE))
        # Who allocates until it is refused may cycle on, and has its priority then.
        ended = deed != self.allocates
        if ended:
            craft.wait_told("MANIPULATOR hangs", 10.0, begin)
        until = wakes.taken() if ended else [0] * len(without)
        if not ended:
            time.sleep(BLOCK_S)
            beside = wakes.taken()
            with contextlib.suppress(ProcessLookupError, AssertionError):
                craft.kill(ROGUE)
        craft.wait_told("MANIPULATOR died", 15.0, begin)
        return without, until, wakes.taken() if ended else beside

    def tell(self, name, without, until, beside):
        ratio = at(beside, 0.999) / max(1, at(without, 0.999))
        flight.measure(f"{name}: without it     {text(without)}")
        if sum(until):
            flight.measure(f"{name}: until demoted  {text(until)}")
        flight.measure(f"{name}: beside it      {text(beside)}; p99.9 {ratio:.2f} times (expected: at most {MOST})")
        return ratio

    @contextlib.contextmanager
    def flown_with(self, resources):
        """The mission with these <Resources> of the hostile one in place of its own."""
        shipped = "../../subsystems/manipulator/manipulator.xml"
        with flight.MissionCopy({shipped: "manipulator.xml"}, MISSION) as mission:
            text, replaced = re.subn(r"<Resources [^>]*/>", resources, (MISSION.parent / shipped).read_text())
            self.assertEqual(replaced, 1)
            mission.with_name("manipulator.xml").write_text(text)
            with flight.Flight(mission) as craft:
                yield craft

    def test_who_takes_more_than_its_descriptor_says_is_ended_and_named(self):
        with self.flown_with('<Resources threads="2"/>') as craft:     # its own is the third
            craft.wait_told("MANIPULATOR has taken 3 of threads, its descriptor says 2 at most: it is ended", 20.0)

    def test_the_others_are_woken_as_before(self):
        # Without its limits, by which it would be gone before it has harmed anybody.
        with self.flown_with("") as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            wakes = Wakes(craft.pid_of(VICTIM))
            ratios = []
            # What it writes over its device's memory stays there: it does not come back from that.
            for deed, turns in ((self.allocates, TURNS), (self.spins, TURNS), (self.writes_over_everything, 1)):
                sums = [[0] * len(wakes.before) for _ in range(3)]
                for turn in range(turns):
                    begin = craft.count()
                    sums = [[a + b for a, b in zip(old, new)] for old, new in zip(sums, self.turn(craft, wakes, deed))]
                    if deed != self.writes_over_everything:
                        craft.wait_told("started MANIPULATOR", 15.0, begin)
                        self.come_back(craft)
                ratios.append(self.tell(deed.__name__.replace("_", " "), *sums))
            flies = craft.wait_status(lambda status: any(
                member["name"] == "HELLO" and member["state"] == "Operational" for member in status["subsystems"]), 5.0)
            self.assertIsNotNone(flies, "nobody else went down for it")
            self.assertLessEqual(max(ratios), MOST)


if __name__ == "__main__":
    flight.main()
