#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""transient_states_test.py: what docs/interfaces/subsystem.md says of the four states that pass by themselves, as an outside observer sees it: a
subsystem that stays in each of them until it is told (held.cpp), its process in /proc, its device at the device, what it says on the ground link. The
state is the supervisor's word. The other six are looked at by tests/endtoend/observer_test.py."""
import collections
import concurrent.futures
import pathlib
import signal
import time
import unittest

import flight
from holding import KEPT_KB, Holding, assert_gives_back, compared

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"
PROGRAM, HELD = "hirosco-held", 27
OFFLINE, PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL = 0, 3, 4, 5
ROUNDS = 3
TRANSIENT_S = 10.0     # a transient state that is not done by then has failed
POWER_S = 3.0          # a switch has answered by then, and what moved rests
QUIET_S = 0.5          # five times the interval of its housekeeping
TAKEN = "anon_inode:[eventfd]"
POOL_KB = 4 * 1024 + 16     # of held.xml: its blocks, and what stands beside each
SAME_KB = 256          # of the allocator of the heap, which keeps a page here and there
# What it has of these besides those of Offline, and whether its device has power. An init has done its part only behind it, a deinit has it still.
PROMISED = {"SoftwareInit": (0, 0.0), "HardwareInit": (1, 1.0), "HardwareDeinit": (2, 1.0), "SoftwareDeinit": (1, 0.0)}


class TransientStates(unittest.TestCase):
    def do(self, craft, function, *arguments, subsystem="held"):
        code, reports = craft.tc(subsystem, function, *arguments)
        self.assertEqual((code, reports[-1:]), (0, ["1,7"]), f"{subsystem} {function} {arguments}: {reports}")

    def wait_state(self, craft, state, seconds=5.0):
        seen = []

        def there(status):
            seen.append(next(member["state"] for member in status["subsystems"] if member["name"] == "HELD"))
            return seen[-1] == state
        self.assertIsNotNone(craft.wait_status(there, seconds), f"{state} was to come: {seen}")

    def wait_power(self, craft, wanted, state):
        end = time.monotonic() + POWER_S
        while craft.truth("axis")["powered"] != wanted:
            self.assertLess(time.monotonic(), end, f"{state}: power is to be {wanted}")
            time.sleep(0.02)

    def look(self, craft):
        return Holding(craft.pid_of(PROGRAM))

    def assert_pools(self, holding, offline, kb, state):
        """So much more than in Offline is mapped, and is in RAM; of who was never up before, with what its allocator then keeps."""
        room_kb = KEPT_KB if offline is self.never_up else SAME_KB
        self.assertAlmostEqual(holding.data_kb - offline.data_kb, kb, delta=room_kb, msg=state)
        self.assertAlmostEqual(holding.memory_kb - offline.memory_kb, kb, delta=room_kb, msg=state)

    def look_at_held(self, craft, telemetry, offline, state):
        """In a transient state: its pools, no device, no link, no more threads than ever; it says nothing by itself and its device hears nothing; it answers, and
        takes no other way."""
        more, power = PROMISED[state]
        self.wait_power(craft, power, state)
        holding, before = self.look(craft), craft.truth("axis")
        telemetry.forget()
        self.assertEqual((holding.devices(), holding.links()), ([], 0), state)
        self.assertEqual(holding.descriptors - offline.descriptors, collections.Counter({TAKEN: more} if more else {}), state)
        self.assertEqual(offline.descriptors - holding.descriptors, collections.Counter(), state)
        self.assertEqual((holding.mappings, holding.threads), (offline.mappings, offline.threads), state)
        self.assert_pools(holding, offline, POOL_KB, state)
        time.sleep(QUIET_S)
        after = craft.truth("axis")
        self.assertEqual((after["heard"], after["active"], after["angle"]), (before["heard"], 0.0, before["angle"]), f"{state}: its device hears nothing")
        self.assertEqual(after["powered"], power, state)
        said = [report for report in list(telemetry.reports) if report.apid == HELD and (report.service, report.subtype) == (3, 25)]
        self.assertEqual(said, [], f"{state}: no housekeeping")
        self.do(craft, "PING")
        code, reports = craft.tc("held", "SET_STATE", SAFE_OPERATIONAL)
        self.assertNotEqual(code, 0, f"{state}: another way is under way")
        self.assertNotIn("1,7", reports, state)
        return holding

    def pass_by(self, craft, telemetry, offline, target, states):
        """Ground commands `target`; what was held in each of the states on the way."""
        looks = {}
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            asked = pool.submit(craft.tc, "held", "SET_STATE", target)
            for state in states:
                self.wait_state(craft, state)
                looks[state] = self.look_at_held(craft, telemetry, offline, state)
                self.assertFalse(asked.done(), f"{state}: not there yet")
                craft.kill(PROGRAM, signal.SIGUSR2)
            code, reports = asked.result()
        self.assertEqual((code, reports[-1:]), (0, ["1,7"]), f"SET_STATE {target}: {reports}")
        return looks

    def begin(self, craft):
        """In Offline, and never up so far; from now on it stays in each transient state. What it holds."""
        craft.wait_told("commissioned: mode listening", 20.0)
        self.do(craft, "SET_MODE", 1, subsystem="supervisor")
        craft.kill(PROGRAM, signal.SIGUSR1)
        self.wait_power(craft, 0.0, "Offline")
        self.never_up = self.look(craft)
        return self.never_up

    def wait_moves(self, craft):
        """It wants to turn all the time, and in Operational alone it does: so what was not seen elsewhere could have been."""
        end, first = time.monotonic() + 5.0, craft.truth("axis")
        while (now := craft.truth("axis"))["angle"] <= first["angle"] or not now["active"] or now["heard"] <= first["heard"]:
            self.assertLess(time.monotonic(), end, f"{first} {now}")
            time.sleep(0.02)

    def end(self, craft):
        """It stays nowhere on the way down of the flight's end."""
        craft.kill(PROGRAM, signal.SIGUSR1)
        self.assertEqual(craft.end(), 0)

    def test_each_transient_state_holds_what_is_promised_and_each_deinit_gives_back_what_its_init_took(self):
        with flight.Flight(MISSION, more=("--no-ground", "--mode", "listening")) as craft:
            offline = self.begin(craft)
            with flight.Telemetry() as telemetry:
                for turn in range(ROUNDS):
                    up = self.pass_by(craft, telemetry, offline, PRE_OPERATIONAL, ("SoftwareInit", "HardwareInit"))
                    self.assertEqual(up["SoftwareInit"], offline, f"turn {turn + 1}: nothing but its pools is taken yet")
                    above = self.look(craft)
                    self.assertEqual((above.devices(), above.links()), ([], 0))
                    self.assert_pools(above, offline, POOL_KB, f"turn {turn + 1}: Pre-Operational")
                    self.do(craft, "CONFIGURE", 1)
                    self.assertEqual(len(self.look(craft).devices()), 1, "from here on it has its device")
                    self.do(craft, "SET_STATE", SAFE_OPERATIONAL)
                    self.do(craft, "SET_STATE", OPERATIONAL)
                    self.wait_moves(craft)
                    self.do(craft, "SET_STATE", SAFE_OPERATIONAL)
                    down = self.pass_by(craft, telemetry, offline, OFFLINE, ("HardwareDeinit", "SoftwareDeinit"))
                    self.assertEqual(down["HardwareDeinit"], above, f"turn {turn + 1}: what a configuration took is given back before")
                    self.assertEqual(down["SoftwareDeinit"], up["HardwareInit"], f"turn {turn + 1}: Hardware-Deinit gives back what Hardware-Init took")
                    rests = self.look(craft)
                    assert_gives_back(self, self.never_up, rests, f"turn {turn + 1}: Software-Deinit gives back what Software-Init took")
                    self.assert_pools(rests, offline, 0, f"turn {turn + 1}: Offline holds no pool")
                    flight.measure(f"in Offline behind way {turn + 1} up and down, against before it was up: {compared(self.never_up, rests)}")
                    offline = rests         # what the allocator keeps it has by now
            self.end(craft)

    def test_who_never_ends_its_hardware_init_goes_down_by_itself_with_nothing_left_and_no_power(self):
        with flight.Flight(MISSION, more=("--no-ground", "--mode", "listening")) as craft:
            offline = self.begin(craft)
            with concurrent.futures.ThreadPoolExecutor(1) as pool:
                asked = pool.submit(craft.tc, "held", "SET_STATE", PRE_OPERATIONAL)
                self.wait_state(craft, "SoftwareInit")
                craft.kill(PROGRAM, signal.SIGUSR2)
                self.wait_state(craft, "HardwareInit")
                self.wait_power(craft, 1.0, "HardwareInit")
                self.wait_state(craft, "HardwareDeinit", TRANSIENT_S + 5.0)
                held = self.look(craft)
                self.assertEqual((held.devices(), held.descriptors - offline.descriptors), ([], collections.Counter({TAKEN: 1})), "that of Software-Init")
                self.assertEqual(craft.truth("axis")["powered"], 1.0)
                craft.kill(PROGRAM, signal.SIGUSR2)
                self.wait_state(craft, "SoftwareDeinit")
                self.wait_power(craft, 0.0, "SoftwareDeinit")
                craft.kill(PROGRAM, signal.SIGUSR2)
                code, reports = asked.result()
            self.assertNotEqual(code, 0)
            self.assertEqual(reports[-1:], ["1,8"], reports)
            self.wait_state(craft, "Offline")
            rests = self.look(craft)
            assert_gives_back(self, offline, rests, "Offline")
            self.assert_pools(rests, offline, 0, "Offline")
            self.assertEqual(craft.truth("axis")["powered"], 0.0)
            self.end(craft)


if __name__ == "__main__":
    flight.main()
