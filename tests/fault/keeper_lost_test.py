#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The keeper is killed while the robot is coupled: the flight goes on and says so, every stop works, and who then dies or stands still leaves a
robot that stops (docs/adr/0217, hazard R61)."""
import os
import signal
import threading
import time
import unittest

import flight
import supervisors

ORPHANS_GONE_S = 10.0
TOLD_S = 1.0                      # that it is gone
STILL_S, PACE_S = 3.0, 0.5        # after so long a keeper that is there would be told to stand still
SAFE_S = 2.0                      # without a supervisor
# supervisor/guard/supervisor_watch.hpp, and how often a guard looks; supervisor/keeper/kept.hpp: until one that stands still alone ends.
GUARDED_S, LOOK_S, ALONE_S = 1.0, 0.01, 10.0
STANDALONE, TELEPRESENCE = 2, 3


class KeeperLost(unittest.TestCase):
    def push(self, craft):
        """The robot pushes on the rail; that does not pass by itself."""
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")

    def loses_its_keeper(self, craft):
        begin = craft.count()
        killed = craft.kill("hirosco")
        told = craft.wait_told("the keeper is gone", TOLD_S, begin)
        flight.measure(f"a killed keeper is told of after {told.received - killed:.3f} s")
        craft.wait_told("SUPERVISOR high KEEPER_LOST", 1.0, begin)
        return begin

    def test_a_killed_keeper_is_told_of_and_the_robot_pushes_on_and_stops_when_asked(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin = self.loses_its_keeper(rokviss)
            end = time.monotonic() + SAFE_S + STILL_S + PACE_S
            while time.monotonic() < end:
                self.assertGreater(rokviss.truth("robot")["force"], 20.0, "it pushes on when nobody would any more without a supervisor")
            said = [line.told for line in rokviss.told(begin)]
            self.assertEqual([text for text in said if "STATE_CHANGED" in text or "KEEPER_STILL" in text], [])
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            asked = time.monotonic()
            done = rokviss.hirosco("safe")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            rokviss.wait_at_rest("robot", asked)
            self.assertEqual(rokviss.tc("supervisor", "SAFE_ALL")[1], ["1,1", "1,3", "1,7"])
            # Up again, and down in order.
            rokviss.fault("joystick", "hand", "cartesian", 0, 0, 0.5)
            time.sleep(1.0)
            self.assertEqual(rokviss.tc("supervisor", "SET_MODE", TELEPRESENCE)[0], 0)
            self.ends(rokviss)

    def test_who_dies_in_a_flight_without_a_keeper_is_told_of_and_brought_up_again(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = self.loses_its_keeper(rokviss)
            rokviss.kill("hirosco-joystick")
            rokviss.wait_told("JOYSTICK died: signal 9", 2.0, begin)
            rokviss.wait_told("started JOYSTICK", 5.0, begin)
            rokviss.wait_told("JOYSTICK ends with this supervisor, should that die", 1.0, begin)
            self.ends(rokviss)

    def test_where_the_keeper_is_gone_a_supervisor_that_stands_still_leaves_a_robot_that_stops_and_is_ended_by_hirosco_safe(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            self.loses_its_keeper(rokviss)
            # Its world lives as long as the process does: by it the robot is looked at.
            stopped = rokviss.kill("hirosco-supervisor", signal.SIGSTOP)
            rokviss.wait_at_rest("robot", stopped)
            time.sleep(max(0.0, stopped + SAFE_S + PACE_S - time.monotonic()))
            truth = rokviss.truth("robot")
            self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))
            done = rokviss.hirosco("safe")
            self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
            self.assertIn("its keeper is gone, and its supervisor was ended", done.stderr)
            self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
            self.assertIn("nothing flies here", rokviss.hirosco("safe").stderr)

    def test_where_the_keeper_is_gone_a_supervisor_that_spins_leaves_a_robot_that_stops_and_ends_by_itself(self):
        with supervisors.instead("spinnable") as programs, flight.Flight(binaries=programs) as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            self.loses_its_keeper(rokviss)
            # To the process: its first thread, which is the supervisor's loop, takes it.
            spins = rokviss.kill("hirosco-supervisor", signal.SIGUSR2)
            rokviss.wait_at_rest("robot", spins + GUARDED_S + LOOK_S)
            self.assertIn("hirosco-supervisor", rokviss.processes().values(), "its guard has stopped the robot, and it has not ended yet")
            self.assertEqual(rokviss.wait_until_gone(ALONE_S + ORPHANS_GONE_S), {})
            flight.measure(f"without a keeper a supervisor that spins, and all else, gone after {time.monotonic() - spins:.1f} s")

    def test_a_keeper_that_is_killed_as_another_supervisor_begins_leaves_one_that_says_so_or_nobody(self):
        for after_s in (0.0, 0.01):
            with self.subTest(after_s), flight.Flight() as rokviss:
                rokviss.wait_commissioned()
                self.push(rokviss)
                keeper, begin = rokviss.pid_of("hirosco"), rokviss.count()
                rokviss.kill("hirosco-supervisor")
                time.sleep(after_s)
                os.kill(keeper, signal.SIGKILL)
                told = rokviss.wait_line(lambda l: "the keeper is gone" in l.told, 5.0, begin)
                flight.measure(f"keeper killed {after_s:g} s behind its supervisor: {'another one goes on' if told else 'nobody goes on'}")
                if told:
                    self.assertEqual(rokviss.tc("supervisor", "SAFE_ALL")[1], ["1,1", "1,3", "1,7"])
                    rokviss.kill("hirosco-supervisor", signal.SIGTERM)
                self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})

    def ends(self, craft):
        """In order, asked by a signal to the supervisor, which is all that is left to ask."""
        craft.kill("hirosco-supervisor", signal.SIGTERM)
        self.assertEqual(craft.wait_until_gone(ORPHANS_GONE_S), {})

    def test_in_the_midst_of_a_change_of_mode_it_is_missed_by_nobody(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin, changed = rokviss.count(), []
            change = threading.Thread(target=lambda: changed.append(rokviss.tc("supervisor", "SET_MODE", STANDALONE)))
            change.start()
            rokviss.wait_told("change from mode", 10.0, begin)
            self.loses_its_keeper(rokviss)
            change.join()
            self.assertEqual(changed[0][0], 0, changed)
            self.assertIsNotNone(rokviss.wait_status(lambda status: status["mode"] == "standalone", 5.0))
            self.ends(rokviss)

    def test_in_the_midst_of_a_plan_it_is_missed_by_nobody(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            rokviss.ask("joystick", "unplug")
            self.loses_its_keeper(rokviss)
            rokviss.wait_told("MANIPULATOR info STATE_CHANGED STATE=Offline", 5.0, begin)
            rokviss.wait_told("JOYSTICK info STATE_CHANGED STATE=Offline", 5.0, begin)
            self.ends(rokviss)

    def test_in_the_midst_of_a_stop_it_is_missed_by_nobody(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            begin, keeper = rokviss.count(), rokviss.pid_of("hirosco")
            asked = time.monotonic()
            # Whether it has counted the stop and not handed it on, or not heard of it, is a matter of microseconds: another one is asked for besides.
            os.kill(keeper, signal.SIGUSR1)
            os.kill(keeper, signal.SIGKILL)
            done = rokviss.hirosco("safe")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            rokviss.wait_at_rest("robot", asked)
            rokviss.wait_told("SUPERVISOR high KEEPER_LOST", TOLD_S, begin)
            rokviss.wait_told("everything has stopped", 5.0, begin)
            self.ends(rokviss)

    def test_both_killed_in_the_midst_of_a_change_of_mode_or_a_stop_leave_nobody(self):
        for ask in (("SET_MODE", STANDALONE), ("SAFE_ALL",)):
            with self.subTest(ask), flight.Flight() as rokviss:
                rokviss.wait_commissioned()
                self.push(rokviss)
                keeper, supervisor = rokviss.pid_of("hirosco"), rokviss.pid_of("hirosco-supervisor")
                begin = rokviss.count()
                asks = threading.Thread(target=rokviss.tc, args=("supervisor", *ask))
                asks.start()
                rokviss.wait_told("change from mode" if ask[0] == "SET_MODE" else "SAFE_ALL", 10.0, begin)
                os.kill(keeper, signal.SIGKILL)
                os.kill(supervisor, signal.SIGKILL)
                self.assertEqual(rokviss.wait_until_gone(ORPHANS_GONE_S), {})
                asks.join()


if __name__ == "__main__":
    flight.main()
