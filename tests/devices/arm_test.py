#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The driver of an arm in Python that the guide has copied (simulation/devices/reference/arm.py): what it says of its drives is what they do, in every
order of enabling, stopping and clearing. Time is the test's."""
import itertools
import pathlib
import re
import struct
import sys
import unittest

from reference import ACTIVE, FOLDER, OFF, STOP, TRIPPED, crc

sys.dont_write_bytecode = True
sys.path.insert(0, str(FOLDER))
import arm  # noqa: E402

MOVES, BRAKES, HOLDS = 1, 2, 3


class Flown:
    """The arm, commanded each 4 ms by frames and by its second inhibit."""

    def __init__(self):
        self.arm, self.now, self.sequence = arm.Arm(arm.Drives()), 100.0, 0

    def tell(self, epoch, mode, torque=0.0, on=True, second=None, seconds=0.004):
        """Flags and what it says that its drives do, after so long."""
        for _ in range(round(seconds / 0.004)):
            self.sequence += 1
            payload = struct.pack("<6d", *6 * [torque])
            frame = struct.pack("<HBBIIHHI", 0x4844, 1, mode, epoch, self.sequence, 0, len(payload), 20_000) + payload
            answer = self.arm.take(frame + crc(frame), self.now)
            inhibit = struct.pack("<HBBHII", 0x4845, 0x33, on, 0, epoch if second is None else second, self.sequence)
            said = self.arm.inhibit(inhibit + crc(inhibit), self.now)
            self.wait(0.004)
        return struct.unpack_from("<H", answer, 12)[0], said[3]

    def wait(self, seconds):
        for _ in range(round(seconds / arm.CYCLE)):
            self.now += arm.CYCLE
            self.arm.step(self.now)


class Driver(unittest.TestCase):
    def test_it_moves_where_mode_epoch_and_second_inhibit_all_say_so_and_says_what_the_drives_do(self):
        for mode, on, second in itertools.product((OFF, ACTIVE, STOP), (False, True), (1, 2, 3)):
            with self.subTest(mode=mode, on=on, second=second):
                flown = Flown()
                flown.tell(1, OFF)
                flags, does = flown.tell(2, mode, on=on, second=second, seconds=0.1)
                moves = mode == ACTIVE and on and second == 2
                self.assertEqual((flags, does), (0, MOVES if moves else HOLDS))
                self.assertEqual(flown.arm.drives.enabled, moves)

    def test_a_drive_that_faults_is_told_and_is_cleared_by_a_higher_epoch_alone(self):
        flown = Flown()
        flown.tell(1, OFF)
        self.assertEqual(flown.tell(2, ACTIVE, torque=1.0, seconds=0.1), (0, MOVES))
        flags, _ = flown.tell(2, ACTIVE, torque=80.0, seconds=0.1)
        self.assertTrue(flags & TRIPPED and flown.arm.drives.fault and not flown.arm.drives.enabled)
        self.assertEqual(flown.tell(2, ACTIVE)[1], BRAKES, "it has not come to rest yet, whatever it was told")
        for mode in (ACTIVE, OFF, STOP, ACTIVE):
            self.assertEqual(flown.tell(2, mode, seconds=0.3), (TRIPPED, HOLDS), "the same epoch clears nothing")
        self.assertEqual(flown.tell(3, OFF, seconds=0.1), (0, HOLDS))
        self.assertEqual(flown.tell(3, ACTIVE, torque=1.0, seconds=0.02), (0, MOVES))

    def test_a_fault_that_cannot_be_cleared_stays_told(self):
        flown = Flown()
        flown.arm.drives.clear = lambda: None
        flown.arm.drives.fault = True
        for epoch in (1, 2, 3):
            flown.tell(epoch, OFF)
            self.assertEqual(flown.tell(epoch, ACTIVE, seconds=0.1), (TRIPPED, HOLDS))

    def test_it_stops_without_commands_without_its_second_inhibit_and_for_who_begins(self):
        flown = Flown()
        self.assertEqual(flown.tell(7, ACTIVE, seconds=0.1), (TRIPPED, HOLDS), "who begins is let go")
        self.assertEqual(flown.tell(8, ACTIVE, seconds=0.1), (0, MOVES))
        flown.wait(0.03)
        self.assertFalse(flown.arm.drives.enabled, "its watchdog of 20 ms")
        self.assertEqual(flown.tell(8, ACTIVE), (TRIPPED, HOLDS))
        self.assertEqual(flown.tell(9, ACTIVE, seconds=0.1), (0, MOVES))
        self.assertEqual(flown.tell(9, ACTIVE, on=False), (0, MOVES), "the answer goes before the step that stops it")
        self.assertEqual(flown.tell(9, ACTIVE, on=False), (0, HOLDS))

    def test_values_that_are_no_numbers_or_too_large_are_not_done(self):
        flown = Flown()
        flown.tell(1, OFF)
        flown.tell(2, ACTIVE, torque=1.0, seconds=0.02)
        for wrong in (float("nan"), float("inf"), arm.MOST + 1, -arm.MOST - 1):
            flown.tell(2, ACTIVE, torque=wrong)
            self.assertEqual(flown.arm.wanted, 6 * [1.0])
        flown.tell(2, ACTIVE, torque=arm.MOST)
        self.assertEqual(flown.arm.wanted, 6 * [arm.MOST], "what it may have it does")

    def test_it_does_what_an_arm_of_hirosco_new_robot_may_ask_for(self):
        import drives  # where somebody who copies it puts his own number
        text = (pathlib.Path(__file__).resolve().parents[2] / "subsystems/robot_arm/robot_arm.urdf").read_text()
        self.assertEqual(drives.MOST, max(map(float, re.findall(r' effort="([^"]+)"', text))))
        self.assertNotIn("MOST =", (FOLDER / "arm.py").read_text())

    def test_it_is_as_small_as_it_is_said_to_be(self):
        self.assertLessEqual(len((FOLDER / "arm.py").read_text().splitlines()), 86)


if __name__ == "__main__":
    unittest.main()
