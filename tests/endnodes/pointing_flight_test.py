#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The imager with real processes: a fall-back in flight, both dead, flown again; power in Offline and after a kill, asked of the device."""
import pathlib
import signal
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"


class Imager(unittest.TestCase):
    def wait_truth(self, imager, wanted, seconds):
        end = time.monotonic() + seconds
        while not wanted(truth := imager.truth("imager")):
            self.assertLess(time.monotonic(), end, truth)
            time.sleep(0.005)
        return truth

    def points_to(self, imager, angle):
        imager.tc("IMAGER", "POINT", angle)
        self.wait_truth(imager, lambda truth: abs(truth["angle"] - angle) < 0.001, 15.0)

    def test_a_fall_back_in_flight_then_both_dead_then_it_flies_again(self):
        with flight.Flight(MISSION) as imager:
            imager.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(imager.truth("imager")["powered"], 1.0)
            self.points_to(imager, 0.1)
            begin = imager.count()
            imager.fault("imager", "endnode", "POINTING", 0, "silent")
            imager.wait_told("IMAGER low IMAGER_POINTING_FALL_BACK", 5.0, begin)
            self.points_to(imager, 0.2)
            imager.fault("imager", "endnode", "IMAGE", 0, "corrupt", 1_000_000)
            imager.wait_told("IMAGER low IMAGER_IMAGE_FALL_BACK", 5.0, begin)
            self.points_to(imager, 0.1)
            self.assertFalse([line.told for line in imager.told(begin) if "_LOST" in line.told])
            imager.fault("imager", "endnode", "POINTING", 1, "unplug")
            imager.wait_told("IMAGER high IMAGER_POINTING_LOST", 5.0, begin)
            imager.wait_told("IMAGER is Offline", 5.0, begin)
            self.assertEqual(imager.truth("imager")["powered"], 0.0)
            imager.fault("imager", "heal")
            imager.fault("imager", "endnode", "POINTING", 1, "plug")
            imager.hirosco("mode", "operation")
            self.points_to(imager, 0.2)
            imager.end()

    def test_a_way_to_the_second_inhibit_that_is_unplugged_in_motion_stops_the_device_and_the_other_is_for_who_is_let_go_again(self):
        with flight.Flight(MISSION) as imager:
            imager.wait_told("commissioned: mode operation", 20.0)
            imager.tc("IMAGER", "POINT", 1)
            self.wait_truth(imager, lambda truth: truth["moves"] == 1.0, 5.0)
            begin = imager.count()
            imager.fault("imager", "enable", 0, "unplug")
            cut = time.monotonic()
            self.wait_truth(imager, lambda truth: truth["moves"] == 0.0, 2.0)
            flight.measure(f"at rest {time.monotonic() - cut:.3f} s after its second inhibit was unplugged")
            imager.wait_told("SUPERVISOR medium INHIBIT_LOST", 5.0, begin)
            imager.wait_told("IMAGER to SafeOperational because of INHIBIT_LOST", 5.0, begin)
            self.assertEqual(imager.truth("imager")["moves"], 0.0)
            imager.tc("IMAGER", "SET_STATE", "Operational")
            imager.wait_told("SUPERVISOR low INHIBIT_FALL_BACK", 5.0, begin)
            self.points_to(imager, 0.3)
            imager.fault("imager", "power", 0, "unplug")
            imager.wait_told("SUPERVISOR low POWER_FALL_BACK", 5.0, begin)
            self.assertEqual(imager.truth("imager")["powered"], 1.0)
            imager.end()
            self.assertEqual(sum("SUPERVISOR medium INHIBIT_LOST" in line.told for line in imager.told(begin)), 1)

    def test_who_is_killed_at_speed_leaves_a_device_at_rest_and_then_without_power(self):
        with flight.Flight(MISSION) as imager:
            imager.wait_told("commissioned: mode operation", 20.0)
            imager.tc("IMAGER", "POINT", 1)
            self.wait_truth(imager, lambda truth: truth["moves"] == 1.0, 5.0)
            imager.kill("hirosco-pointing-imager")
            killed = time.monotonic()
            self.wait_truth(imager, lambda truth: truth["moves"] == 0.0, 2.0)
            self.wait_truth(imager, lambda truth: truth["powered"] == 0.0, 5.0)
            flight.measure(f"without power {time.monotonic() - killed:.3f} s after the kill")
            imager.end()

    def test_a_killed_supervisor_leaves_a_device_without_power_too(self):
        with flight.Flight(MISSION) as imager:
            imager.wait_told("commissioned: mode operation", 20.0)
            imager.process.send_signal(signal.SIGSTOP)  # or another supervisor would go on, and the power stay
            imager.kill("hirosco-supervisor")
            self.wait_truth(imager, lambda truth: truth["powered"] == 0.0, 10.0)
            imager.process.kill()


if __name__ == "__main__":
    flight.main()
