#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A log whose file system stands still: SAFE_ALL stops the actuators all the same, nothing that was logged is lost. Of a supervisor
that dies meanwhile the system keeps the thread that writes until the disk answers, so another one comes only then: what moves is at rest
long before (docs/adr/0192)."""
import contextlib
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import flight

SILENCE_S = 2.0                   # hirosco/subsystem/pages/supervisor_silence.hpp
MARGIN_S = 1.0


class FrozenDisk:
    """`with FrozenDisk(folder) as disk:` — an ext4 of its own at `folder/log`; freeze() lets nothing be written there."""

    def __init__(self, folder):
        self.image, self.mounted_at = pathlib.Path(folder) / "disk.img", pathlib.Path(folder) / "log"
        self.frozen = False

    def __enter__(self):
        with open(self.image, "wb") as image:
            image.truncate(64 << 20)
        self.mounted_at.mkdir()
        try:
            self._do("mkfs.ext4", "-q", str(self.image))
            self._do("mount", "-o", "loop", str(self.image), str(self.mounted_at))
        except (OSError, subprocess.CalledProcessError) as problem:
            flight.skip("no-loop-mount", problem)
        return self

    def __exit__(self, *_):
        if self.frozen:
            self.thaw()
        with contextlib.suppress(subprocess.CalledProcessError):
            self._do("umount", "-l", str(self.mounted_at))

    def freeze(self):
        self._do("fsfreeze", "-f", str(self.mounted_at))
        self.frozen = True

    def thaw(self):
        self._do("fsfreeze", "-u", str(self.mounted_at))
        self.frozen = False

    @staticmethod
    def _do(*words):
        subprocess.run(words, check=True, capture_output=True)


class FrozenLog(unittest.TestCase):
    def test_safe_all_stops_the_actuators_while_nothing_can_be_logged(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-frozen-") as folder, FrozenDisk(folder) as disk, \
             flight.Flight(folder=folder) as rokviss:
            rokviss.wait_commissioned()
            rokviss.fault("joystick", "hand", "sine", 2, 0.05, 0.5)
            time.sleep(1.0)
            disk.freeze()
            begin = rokviss.count()
            time.sleep(3.0)
            begun = time.monotonic()
            code, reports = rokviss.tc("supervisor", "SAFE_ALL")
            took = time.monotonic() - begun
            self.assertEqual((code, reports[-1:]), (0, ["1,7"]), reports)
            safe = rokviss.wait_told("SAFE_ALL: every actuator inhibited", 2.0, begin)
            flight.measure(f"SAFE_ALL answered {1e3 * took:.0f} ms after the command was started, told at {safe.at_s:.3f} s")
            self.actuators_were_inhibited(rokviss)
            disk.thaw()
            for name in ("MANIPULATOR", "JOYSTICK"):
                rokviss.wait_told(f"{name} info STATE_CHANGED STATE=SafeOperational", 20.0, begin)
            self.nothing_is_lost(rokviss)
            self.assertEqual(rokviss.end(seconds=30.0), 0, rokviss.errors)

    def test_where_a_supervisor_dies_over_a_frozen_log_all_comes_to_rest_and_another_goes_on_after_the_thaw(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-frozen-") as folder, FrozenDisk(folder) as disk, \
             flight.Flight(folder=folder) as rokviss:
            rokviss.wait_commissioned()
            rokviss.fault("joystick", "hand", "sine", 2, 0.05, 0.5)
            disk.freeze()
            time.sleep(1.0)
            self.assertNotEqual(self.motors(rokviss, "robot"), (0.0, 0.0), "it moves")
            begin = rokviss.count()
            killed = rokviss.kill("hirosco-supervisor")
            time.sleep(max(0.0, killed + SILENCE_S + MARGIN_S - time.monotonic()))
            for _ in range(20):
                for device in ("robot", "joystick"):
                    self.assertEqual(self.motors(rokviss, device), (0.0, 0.0), device)
                time.sleep(0.05)
            self.assertEqual([line.told for line in rokviss.told(begin) if "goes on with" in line.told], [],
                             "the system has not given back what the dead one held")
            disk.thaw()
            thawed = time.monotonic()
            next_one = rokviss.wait_line(lambda l: "goes on with" in l.told, 10.0, begin)
            self.assertIsNotNone(next_one, "another supervisor goes on")
            flight.measure(f"another supervisor {next_one.received - thawed:.3f} s after the thaw")
            self.is_brought_up(rokviss)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0, "what has to be durable goes on")

    def motors(self, rokviss, device):
        truth = rokviss.truth(device)
        return truth["motor_1"], truth["motor_2"]

    def is_brought_up(self, rokviss):
        """By an operator, who says again what is refused while members still come back."""
        def do(*words):
            code, reports = rokviss.tc(*words)
            self.assertEqual(code, 0, (words, reports))

        end = time.monotonic() + 30.0
        while True:
            try:
                return rokviss.bring_up(do)
            except AssertionError:
                if time.monotonic() > end:
                    raise
                time.sleep(1.0)

    def actuators_were_inhibited(self, rokviss):
        members = {m["name"]: m for m in rokviss.wait_status(lambda s: True, 3.0)["subsystems"]}
        late = {name: members[name]["inhibited_at_cycle"] - members[name]["stopped_at_cycle"]
                for name in ("MANIPULATOR", "JOYSTICK")}
        flight.measure(f"actuators inhibited {late} own cycles after SAFE_ALL")
        self.assertLessEqual(max(late.values()), 5)
        for device in ("robot", "joystick"):
            truth = rokviss.truth(device)
            self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0), device)

    def nothing_is_lost(self, rokviss):
        end = time.monotonic() + 10.0
        while not any("SAFE_ALL" in record["text"] for record in rokviss.log(last=2000)):
            self.assertLess(time.monotonic(), end, "the log never told of SAFE_ALL")
            time.sleep(0.2)


if __name__ == "__main__":
    if os.geteuid() != 0:
        flight.skip("no-loop-mount")
    flight.main()
