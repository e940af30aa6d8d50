#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The cycle threads of a coupled flight never use the heap, lock or print; one that does is found out, and told."""
import re
import sys
import time
import unittest

import flight

CYCLES = 30_000
ROKVISS_HZ = 2000


def heap_uses(errors, program):
    """(uses, cycles) as the executable told at its end."""
    for line in errors:
        if found := re.search(rf"{program}: (\d+) uses of the heap in (\d+) cycles", line):
            return int(found[1]), int(found[2])
    raise AssertionError(f"{program} told nothing: {errors}")


class Allocations(unittest.TestCase):
    def test_a_coupled_flight_takes_nothing_from_the_heap_in_its_cycles(self):
        # A virtual machine may stand still for long enough to lose the devices. That ends a flight, not what is shown here.
        for _ in range(3):
            if self.cycles_flown_without_the_heap() >= CYCLES:
                return
        self.fail(f"no flight of {CYCLES} cycles in three")

    def cycles_flown_without_the_heap(self):
        with flight.MissionCopy({"hirosco-manipulator": "hirosco-hooked-manipulator",
                                 "hirosco-joystick": "hirosco-hooked-joystick"}) as mission, \
             flight.Flight(mission) as rokviss:
            rokviss.wait_commissioned()
            # Some of what makes a cycle leave its trodden path: contact, telecommands, refusals, reports.
            for _ in range(5):
                rokviss.tc("joystick", "SET_FORCE_SCALE", 0.02)
                self.assertEqual(rokviss.tc("manipulator", "HOME")[0], 1)
            rokviss.fault("joystick", "hand", "cartesian", 0.0226, 0, 2)
            time.sleep(5.0)
            rokviss.fault("joystick", "hand", "wander")
            coupled = ("MANIPULATOR", "JOYSTICK")
            rokviss.wait_status(lambda s: any(m["state"] != "Operational" for m in s["subsystems"])
                                or min(m["cycles"] for m in s["subsystems"] if m["name"] in coupled) > CYCLES + 100,
                                CYCLES / ROKVISS_HZ + 30)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
            flown = []
            for program in ("hirosco-hooked-manipulator", "hirosco-hooked-joystick"):
                uses, cycles = heap_uses(rokviss.errors, program)
                flight.measure(f"{program}: {uses} uses of the heap in {cycles} cycles")
                self.assertEqual(uses, 0)
                flown.append(cycles)
            self.assertFalse([line.told for line in rokviss.told(0) if "CYCLE_NOT_REALTIME" in line.told])
            return min(flown)

    def test_a_planted_use_of_heap_lock_and_output_is_found_and_told(self):
        with flight.MissionCopy({"hirosco-hello": "hirosco-planted"}, flight.HELLO) as mission, \
             flight.Flight(mission) as hello:
            hello.wait_told("commissioned: mode operation")
            hello.wait_told("HELLO low CYCLE_NOT_REALTIME HEAP=1 LOCKS=0 OUTPUTS=0", 10.0)
            hello.wait_told("HELLO low CYCLE_NOT_REALTIME HEAP=2 LOCKS=1 OUTPUTS=1", 10.0)
            self.assertEqual(hello.end(), 0, hello.errors)
            uses, cycles = heap_uses(hello.errors, "hirosco-planted")
            flight.measure(f"planted: {uses} uses of the heap in {cycles} cycles")
            self.assertEqual(uses, 2)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        CYCLES = int(sys.argv.pop(1))
    flight.main()
