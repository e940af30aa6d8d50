#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The service loops of a flight share the processor: each of them takes its turn (SCHED_RR) at one priority below the supervisor's loop,
and passes none of that on to what it starts. That a thread which never rests leaves others of its priority theirs: thread_test.cpp."""
import os
import unittest

import flight

SERVICE_PRIORITY = 20         # hirosco/subsystem/process/run.cpp


class ServiceLoops(unittest.TestCase):
    def test_each_takes_turns_with_the_others(self):
        with flight.Flight(mission=flight.HELLO) as hello:
            hello.wait_told("commissioned: mode operation")
            loops = {name: pid for pid, name in hello.processes().items()
                     if name in ("hirosco-hello", "hirosco-communication")}
            self.assertEqual(len(loops), 2, hello.processes())
            if any("no real-time scheduling" in line.told for line in hello.told()):
                self.assertEqual({os.sched_getscheduler(pid) for pid in loops.values()}, {os.SCHED_OTHER})
                return
            for name, pid in loops.items():
                self.assertEqual(os.sched_getscheduler(pid), os.SCHED_RR | os.SCHED_RESET_ON_FORK, name)
                self.assertEqual(os.sched_getparam(pid).sched_priority, SERVICE_PRIORITY, name)


if __name__ == "__main__":
    flight.main()
