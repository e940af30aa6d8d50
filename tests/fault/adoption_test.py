#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The supervisor dies or hangs while the robot is coupled: cycles and links run on, the robot pushes on, and another supervisor
goes on within a second (docs/adr/0093)."""
import signal
import struct
import threading
import time
import unittest

import flight
import operators
import supervisors

ADOPTED_S = 1.0
PATIENCE_S = 0.8                  # supervisor/keeper/kept.hpp
# The structures of both machines come every so often, by their cycles' count.
SAMPLES_S = {4713: 0.05, 4721: 0.25}
# Of the supervisor itself: its structure of all subsystems, by its descriptor every 20 cycles, and an event that each begin raises.
ROWS, ROWS_INTERVAL = 4702, 50
STATE_CHANGED = 0xF000


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

    def ground_sets_the_supervisor(self, ground):
        self.assertEqual(ground.send(3, 31, struct.pack(">BHI", 1, ROWS, ROWS_INTERVAL)), 7)
        self.assertEqual(ground.send(5, 6, struct.pack(">BH", 1, STATE_CHANGED)), 7)
        ground.forget()

    def the_supervisor_is_as_ground_set_it(self, ground):
        """And was so before it said anything (docs/adr/0205)."""
        self.assertNotIn(STATE_CHANGED, ground.events())
        self.assertEqual(ground.send(3, 33, struct.pack(">BH", 1, ROWS)), 7)
        self.assertEqual(ground.newest(3, 35), struct.pack(">BHBI", 1, ROWS, 1, ROWS_INTERVAL))
        self.assertEqual(ground.send(5, 7, b""), 7)
        self.assertEqual(ground.newest(5, 8), struct.pack(">BH", 1, STATE_CHANGED))

    def test_kill_9_of_the_supervisor_while_coupled(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            with flight.Telemetry() as telemetry, operators.Operator(operators.SUPERVISOR) as ground:
                self.ground_sets_the_supervisor(ground)
                time.sleep(0.5)
                took = []
                for _ in range(2):
                    begin = rokviss.count()
                    took.append(self.is_adopted(rokviss, begin, rokviss.kill("hirosco-supervisor")))
                    self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
                    self.the_supervisor_is_as_ground_set_it(ground)
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
            # And whatever it then has to do it does.
            begin = rokviss.count()
            rokviss.fault("joystick", "unplug")
            rokviss.wait_told("MANIPULATOR info STATE_CHANGED STATE=Offline", 5.0, begin)
            rokviss.wait_told("JOYSTICK info STATE_CHANGED STATE=Offline", 5.0, begin)

    def test_a_stopped_one_is_replaced_at_once(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin = rokviss.count()
            took = self.is_adopted(rokviss, begin, rokviss.kill("hirosco-supervisor", signal.SIGSTOP))
            flight.measure(f"a stopped supervisor is replaced after {took:.3f} s")
            self.assertLess(took, ADOPTED_S)
            self.assertEqual(rokviss.tc("supervisor", "SAFE_ALL")[1], ["1,1", "1,3", "1,7"])
            rokviss.wait_at_rest("robot", time.monotonic())

    def test_one_that_spins_is_replaced_before_its_guard_gives_up(self):
        with supervisors.instead("spinnable") as programs, flight.Flight(binaries=programs) as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin = rokviss.count()
            # To the process: its first thread, which is the supervisor's loop, takes it.
            took = self.is_adopted(rokviss, begin, rokviss.kill("hirosco-supervisor", signal.SIGUSR2))
            flight.measure(f"a supervisor that spins is replaced after {took:.3f} s")
            self.assertLess(took, PATIENCE_S + ADOPTED_S)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)

    def test_a_stop_that_is_asked_for_while_nobody_is_there_holds(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin = rokviss.count()
            rokviss.kill("hirosco-supervisor")
            asked = time.monotonic()
            rokviss.process.send_signal(signal.SIGUSR1)      # as `hirosco safe` does where no guard answers
            rokviss.wait_at_rest("robot", asked)
            rokviss.wait_told("this supervisor goes on for one that died", 5.0, begin)
            rokviss.wait_told("everything has stopped", 5.0, begin)
            truth = rokviss.truth("robot")
            self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))

    def test_in_the_middle_of_a_mode_change_the_craft_ends_in_the_old_mode_the_new_one_or_safe(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            standalone = 2
            for after_s in (0.0, 0.02, 0.1):
                begin = rokviss.count()
                change = threading.Thread(target=rokviss.tc, args=("supervisor", "SET_MODE", standalone))
                change.start()
                rokviss.wait_told("change from mode", 10.0, begin)
                time.sleep(after_s)
                rokviss.kill("hirosco-supervisor")
                rokviss.wait_told("this supervisor goes on for one that died", 5.0, begin)
                change.join()
                time.sleep(1.0)
                status = rokviss.wait_status(lambda _: True, 5.0)
                flight.measure(f"killed {after_s:g} s after the begin of a change: mode {status['mode']}")
                self.assertIn(status["mode"], ("telepresence", "standalone", "commissioning"))
                self.assertEqual(rokviss.tc("supervisor", "SET_MODE", 3)[0], 0, "and it flies again")


if __name__ == "__main__":
    flight.main()
