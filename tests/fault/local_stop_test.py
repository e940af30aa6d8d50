#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco safe`: everything that moves is stopped from beside the flight, whatever else of it stands still."""
import ctypes
import os
import pathlib
import resource
import signal
import threading
import time
import unittest

import flight

ANSWER_S = 0.5
MOVERS = ("MANIPULATOR", "JOYSTICK")
COMES_BACK = {"60": '1" pause_ms="20" to="commanded'}    # who dies, to what it was commanded to be


def hold_still(thread):
    """This thread alone, its process goes on. Whoever ends that ends it all the same, but its parent hears of it after see_end() only."""
    seize, interrupt = 0x4206, 0x4207
    for request in (seize, interrupt):
        if ctypes.CDLL(None, use_errno=True).ptrace(request, thread, None, None) != 0:
            raise OSError(ctypes.get_errno(), "ptrace")


def see_end(thread):
    every_child = 0x40000000                             # __WALL
    while os.WIFSTOPPED(os.waitpid(thread, every_child)[1]):
        pass


class LocalStop(unittest.TestCase):
    def stops(self, rokviss):
        asked = time.monotonic()
        done = rokviss.hirosco("safe")
        took = time.monotonic() - asked
        print(done.stdout, done.stderr)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertLessEqual(took, ANSWER_S)
        flight.measure(f"hirosco safe answered after {1e3 * took:.0f} ms")
        return done.stdout.splitlines()

    def nothing_moves(self, rokviss):
        def withdrawn(status):
            members = {member["name"]: member for member in status["subsystems"]}
            return all(members[name]["state"] in ("Offline", "not running") or members[name]["inhibited"] for name in MOVERS)
        self.assertIsNotNone(rokviss.wait_status(withdrawn, 5.0), "every permission is withdrawn")
        truth = rokviss.truth("robot")
        self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))

    def test_everything_is_stopped_while_the_ground_link_is_frozen(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            rokviss.kill("hirosco-telepresence-relay", signal.SIGSTOP)
            lines = self.stops(rokviss)
            self.assertEqual(len(lines), 2, "one for each device")
            for line in lines:
                self.assertIn("says the device", line)
            self.nothing_moves(rokviss)

    def test_what_the_guard_alone_knew_holds_for_who_dies_before_the_supervisor_hears_of_it_though_the_ground_link_is_dead(self):
        with flight.MissionCopy(COMES_BACK) as mission, flight.Flight(mission) as rokviss:
            rokviss.wait_commissioned()
            self.assertEqual(rokviss.hirosco("mode", "standalone", "--mission", mission).returncode, 0)    # the manipulator needs nobody else
            begin = rokviss.count()
            loop = rokviss.pid_of("hirosco-supervisor")
            rokviss.kill("hirosco-telepresence-relay")
            hold_still(loop)
            self.stops(rokviss)
            rokviss.kill("hirosco-manipulator")
            see_end(loop)                                # by the keeper
            rokviss.wait_told("MANIPULATOR died", 5.0, begin)      # says the next supervisor
            time.sleep(2.0)
            self.assertFalse([line.told for line in rokviss.told(begin) if line.told.endswith(": as commanded")])
            self.nothing_moves(rokviss)

    def test_the_keeper_is_signalled_where_nobody_answers(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            rokviss.process.send_signal(signal.SIGSTOP)       # or another supervisor would answer
            rokviss.kill("hirosco-supervisor")
            done = rokviss.hirosco("safe")
            self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
            self.assertIn("its keeper was signalled", done.stderr)
            rokviss.process.send_signal(signal.SIGCONT)
            rokviss.wait_told("this supervisor goes on for one that died", 5.0, begin)
            rokviss.wait_told("everything has stopped", 5.0, begin)
            self.nothing_moves(rokviss)

    def test_who_knocks_where_no_descriptor_is_left_costs_no_processor_and_is_answered_when_there_is_one(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            pid = rokviss.pid_of("hirosco-supervisor")

            def used_s():
                words = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
                return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")

            def used_in(seconds):
                before = used_s()
                time.sleep(seconds)
                return used_s() - before

            answers = []
            usual_s = used_in(0.5)
            taken = {int(entry.name) for entry in pathlib.Path(f"/proc/{pid}/fd").iterdir()}
            first_free = next(number for number in range(len(taken) + 1) if number not in taken)
            before = resource.prlimit(pid, resource.RLIMIT_NOFILE)
            resource.prlimit(pid, resource.RLIMIT_NOFILE, (first_free, before[1]))
            asking = threading.Thread(target=lambda: answers.append(rokviss.hirosco("safe")))
            asking.start()
            time.sleep(0.2)
            knocked_s = used_in(0.5)
            flight.measure(f"supervisor in half a second: {usual_s:.2f} s of a processor, {knocked_s:.2f} s while somebody knocks")
            self.assertEqual(answers, [], "nobody can be let in")
            resource.prlimit(pid, resource.RLIMIT_NOFILE, before)
            asking.join()
            self.assertLess(knocked_s, usual_s + 0.2)
            self.assertEqual(answers[0].returncode, 0, answers[0].stdout + answers[0].stderr)
            self.nothing_moves(rokviss)

    def test_where_nothing_flies_it_says_so(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
            done = rokviss.hirosco("safe")
            self.assertEqual((done.returncode, done.stderr.strip()), (3, "hirosco safe: nothing flies here"))


if __name__ == "__main__":
    flight.main()
