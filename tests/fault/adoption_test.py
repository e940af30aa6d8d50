#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The supervisor dies or hangs while the robot is coupled: cycles and links run on, the robot pushes on, and another supervisor
goes on within a second (docs/adr/0093)."""
import os
import pathlib
import signal
import tempfile
import time
import unittest

import flight

ADOPTED_S = 1.0
# The structures of both machines come every so often, by their cycles' count.
SAMPLES_S = {4713: 0.05, 4721: 0.05}


class Adoption(unittest.TestCase):
    def push(self, craft):
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")

    def is_adopted(self, craft, begin, lost_at):
        """Another supervisor goes on; the robot's motors never rested meanwhile. Returns how long it took."""
        end = time.monotonic() + 10.0
        adopted = None
        while adopted is None:
            self.assertLess(time.monotonic(), end, "another supervisor goes on")
            truth = craft.truth("robot")
            self.assertNotEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0), "the robot pushes on")
            adopted = craft.wait_line(lambda l: "goes on with MANIPULATOR" in l.told, 0.005, begin)
        self.assertNotIn("stopped", adopted.told)
        return adopted.received - lost_at

    def test_kill_9_of_the_supervisor_while_coupled(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            with flight.Telemetry() as telemetry:
                time.sleep(0.5)
                took = []
                for _ in range(2):
                    begin = rokviss.count()
                    took.append(self.is_adopted(rokviss, begin, rokviss.kill("hirosco-supervisor")))
                    self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
                    time.sleep(2.5)
                    truth = rokviss.truth("robot")
                    self.assertGreater(truth["force"], 20.0, "it pushes on when nobody would any more without a supervisor")
                    self.assertEqual([l.told for l in rokviss.told(begin) if "STATE_CHANGED" in l.told and "SUPERVISOR" not in l.told], [])
                flight.measure("a killed supervisor is replaced after " + ", ".join(f"{s:.3f} s" for s in took))
                self.assertLess(max(took), ADOPTED_S)
                for structure, every in SAMPLES_S.items():
                    times = [at for at, _ in telemetry.housekeeping(structure)]
                    gaps = [b - a for a, b in zip(times, times[1:])]
                    flight.measure(f"largest gap of structure {structure}: {max(gaps):.3f} s of {every} s")
                    self.assertLess(max(gaps), 2 * every + 0.02, "its cycles and its reports went on")
                ages = [values["peer_age"] for _, values in telemetry.housekeeping(4721)]
                flight.measure(f"oldest sample of the link into the joystick: {max(ages)} cycles")
            begin = rokviss.count()
            rokviss.fault("joystick", "unplug")
            rokviss.wait_told("MANIPULATOR info STATE_CHANGED STATE=Offline", 5.0, begin)
            rokviss.wait_told("JOYSTICK info STATE_CHANGED STATE=Offline", 5.0, begin)


if __name__ == "__main__":
    flight.main()
