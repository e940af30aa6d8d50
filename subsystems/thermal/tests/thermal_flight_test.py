#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Zones with real processes: commissioned, a set point that is reached in the world and one that is refused with its reason, a sensor
that dies, a switch that does not open and is cut out, the control that dies while the unit goes on."""
import pathlib
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"
PROGRAM = "hirosco-thermal"


def until(what, seconds, wanted):
    """The first of `what()` for which `wanted`; the last one when none came in time."""
    end = time.monotonic() + seconds
    found = what()
    while not wanted(found) and time.monotonic() < end:
        time.sleep(0.05)
        found = what()
    return found


class Thermal(unittest.TestCase):
    def test_it_keeps_zones_warm_and_none_too_hot(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode warm", 20.0)
            commissioned = time.monotonic()

            self.assertEqual(craft.tc("THERMAL", "SET_POINT", 0, 20)[0], 0)
            asked = time.monotonic()
            world = until(lambda: craft.truth("thermal"), 10.0, lambda zones: abs(zones["t0"] - 20) < 0.5)
            self.assertLess(abs(world["t0"] - 20), 0.5, world)
            flight.measure(f"20 degC after {time.monotonic() - asked:.1f} s, {world['t0']:.2f} degC in the world")
            self.assertLess(abs(world["t1"] - 18), 2)

            said = craft.hirosco("tc", "THERMAL", "SET_POINT", "1", "60", "--mission", str(MISSION))
            self.assertNotEqual(said.returncode, 0)
            self.assertIn("10 K below the cut-out 35", said.stdout)

            begin = craft.count()
            craft.ask("thermal", "sensor 2 dead")
            craft.wait_told("SENSOR_DOUBTED", 3.0, begin)
            craft.ask("thermal", "heater 5 stuck_on")
            cycles = [craft.truth("thermal")["heats2"] for _ in range(40) if not time.sleep(0.05)]
            self.assertTrue(0.1 < sum(cycles) / len(cycles) < 0.5, cycles)
            flight.measure(f"its heater is on for {sum(cycles) / len(cycles):.2f} of the time, 0.30 is safe")

            craft.wait_told("HEATERS_DIFFER", 3.0, begin)
            craft.wait_told("OVER_TEMPERATURE", 10.0, begin)
            cut = until(lambda: craft.truth("thermal"), 2.0, lambda zones: zones["line5"] == 0)
            self.assertEqual((cut["line5"], cut["heats5"], cut["line4"]), (0, 0, 1))
            flight.measure(f"cut out at {cut['t5']:.1f} degC, 45 is the limit")
            said = craft.hirosco("tc", "THERMAL", "CLOSE_LINE", "5", "--mission", str(MISSION))
            self.assertNotEqual(said.returncode, 0)
            self.assertIn("colder than 40", said.stdout)

            begin = craft.count()
            craft.kill(PROGRAM)
            craft.wait_told("died", 3.0, begin)
            self.assertEqual(until(lambda: craft.truth("thermal"), 3.0, lambda zones: zones["own"] == 1)["own"], 1)
            back = until(lambda: craft.truth("thermal"), 10.0, lambda zones: zones["own"] == 0)
            self.assertEqual(back["own"], 0, "and it comes back as it was")
            flight.measure(f"{time.monotonic() - commissioned:.1f} s flown")
            craft.end()


if __name__ == "__main__":
    flight.main()
