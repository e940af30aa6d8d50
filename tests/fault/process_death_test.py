#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of a subsystem that others depend on (fault case 5)."""
import pathlib
import time
import unittest

import flight


def in_order(texts, wanted):
    """Places at which `wanted` stand in `texts`, one behind the other; ValueError names the one that is missing."""
    places, start = [], 0
    for text in wanted:
        place = next((i for i in range(start, len(texts)) if text in texts[i]), None)
        if place is None:
            raise ValueError(f"not told, or out of order: {text!r}")
        places.append(place)
        start = place + 1
    return places


STORY = ("JOYSTICK died: signal 9", "plan died: network {", "MANIPULATOR info STATE_CHANGED STATE=PostOperational",
         "MANIPULATOR info STATE_CHANGED STATE=Offline", "MANIPULATOR is Offline")


class ProcessDeath(unittest.TestCase):
    def test_the_network_of_a_killed_joystick_goes_down_and_the_rest_lives(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            time.sleep(1.0)
            killed = rokviss.kill("hirosco-joystick")
            died = rokviss.wait_told("JOYSTICK died: signal 9")
            offline = rokviss.wait_told("MANIPULATOR is Offline")
            flight.measure(f"noticed {1e3 * (died.received - killed):.1f} ms after the signal, network Offline "
                           f"{1e3 * (offline.at_s - died.at_s):.1f} ms later")
            self.assertLess(offline.received - killed, 2.0)
            self.actuators_were_inhibited_in_time(rokviss)
            self.the_rest_is_alive(rokviss)
            self.the_log_tells_the_story(rokviss)
            self.assertEqual(rokviss.end(), 5, "nobody of this flight had caused it")
            self.assertIn("1 reaction of high severity", " ".join(rokviss.errors))

    def test_that_nobody_had_caused_it_is_known_to_the_supervisor_that_ends_the_flight(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            rokviss.kill("hirosco-joystick")
            rokviss.wait_told("MANIPULATOR is Offline")
            begin = rokviss.count()
            rokviss.kill("hirosco-supervisor")
            rokviss.wait_told("goes on for one that died", 5.0, begin)
            self.assertEqual(rokviss.end(), 5, rokviss.errors)

    def test_a_killed_device_leaves_neither_socket_nor_shared_memory_behind_its_flight(self):
        memory = pathlib.Path("/dev/shm")
        before = set(memory.rglob("*")) | {memory / "hirosco"}
        with flight.Flight(instance="bereaved") as rokviss:
            folder = pathlib.Path(rokviss.place()["folder"])
            rokviss.wait_commissioned()
            sockets = [file for file in folder.iterdir() if file.is_socket()]
            self.assertGreaterEqual(len(sockets), 2, "one for each device")
            rokviss.kill("hirosco-sim-robot")
            rokviss.wait_told("MANIPULATOR is Offline")
            rokviss.end()
            self.assertEqual([file for file in folder.iterdir() if file.is_socket()], [])
        self.assertEqual(set(memory.rglob("*")) - before, set())

    def actuators_were_inhibited_in_time(self, rokviss):
        status = rokviss.wait_status(lambda s: True, 3.0)
        self.assertIsNotNone(status)
        members = {member["name"]: member for member in status["subsystems"]}
        self.assertEqual(members["MANIPULATOR"]["state"], "Offline")
        self.assertIn(members["JOYSTICK"]["state"], ("not running", "Offline"), "its plan starts it again")
        inhibited, stopped = (members["MANIPULATOR"][name] for name in ("inhibited_at_cycle", "stopped_at_cycle"))
        self.assertGreater(stopped, 0, "the supervisor set the stop flag")
        self.assertGreater(inhibited, 0, "the actuators were inhibited")
        # Its own age limit may have been faster than the supervisor; then the difference is negative.
        flight.measure(f"actuators inhibited {inhibited - stopped:+d} own cycles after the supervisor's detection")
        self.assertLessEqual(inhibited - stopped, 5)
        truth = rokviss.truth("robot")
        self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))

    def the_rest_is_alive(self, rokviss):
        for subsystem in ("supervisor", "communication", "manipulator"):
            self.assertEqual(rokviss.tc(subsystem, "ping"), (0, ["1,1", "1,3", "1,7"]), subsystem)
        self.assertEqual([line.told for line in rokviss.told()].count("started JOYSTICK"), 2, "its plan started it again")

    def the_log_tells_the_story(self, rokviss):
        end = time.monotonic() + 5.0
        while True:
            texts = [record["text"] for record in rokviss.log()]
            try:
                return in_order(texts, STORY)
            except ValueError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.2)     # the log groups what it commits


if __name__ == "__main__":
    flight.main()
