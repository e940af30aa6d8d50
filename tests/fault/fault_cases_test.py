#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The fault cases that need no plug pulled, once each on the real processes: FC2, FC6 to FC9, FC13. Their deadlines over
many seeds are judged in simulation (`hirosco report rokviss --faults`); here they count in the cycles that the processes
keep in their vital pages."""
import math
import os
import pathlib
import signal
import time
import unittest

import flight

ACTUATORS = 5       # most cycles of the member itself from detection to actuators safe
BOTH = ("MANIPULATOR", "JOYSTICK")
REMOTE = {'commissioning" start="telepresence': 'commissioning" start="remote'}
class FaultCases(unittest.TestCase):
    def members(self, craft):
        return {member["name"]: member for member in craft.wait_status(lambda s: True, 3.0)["subsystems"]}

    def assert_states(self, craft, **wanted):
        states = {name: member["state"] for name, member in self.members(craft).items()}
        self.assertEqual({name: states[name] for name in wanted}, wanted)

    def assert_inhibited_in_time(self, craft, case, names=BOTH):
        members = self.members(craft)
        late = {name: members[name]["inhibited_at_cycle"] - members[name]["stopped_at_cycle"] for name in names}
        flight.measure(f"{case}: actuators inhibited {late} own cycles after the supervisor's detection")
        self.assertLessEqual(max(late.values()), ACTUATORS)

    def assert_offline(self, craft, names, begin, seconds=2.0):
        for name in names:
            craft.wait_told(f"{name} is Offline", seconds, begin)

    def assert_robot_to_safe(self, craft, case, cause, begin):
        """The reaction of severity medium, and no more than it."""
        event = craft.wait_told(f"MANIPULATOR medium {cause}", 2.0, begin)
        safe = craft.wait_told("MANIPULATOR info STATE_CHANGED STATE=SafeOperational", 2.0, begin)
        flight.measure(f"{case}: {event.told}; SafeOperational {1e3 * (safe.at_s - event.at_s):.1f} ms later")
        craft.wait_at_rest("robot", safe.received)
        self.assert_states(craft, MANIPULATOR="SafeOperational", JOYSTICK="Operational")
        self.assertEqual(self.plans_since(craft, begin), [f"plan to-safe: MANIPULATOR to SafeOperational because of {cause}"])

    def plans_since(self, craft, begin):
        return [line.told for line in craft.told(begin) if line.told.startswith("plan ")]

    def test_fc13_fc2_what_is_low_is_told_then_heat_stops_the_robot_then_both(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            self.assertNotEqual(rokviss.tc("manipulator", "HOOK_SPRING", 1)[0], 0)
            rokviss.wait_told("MANIPULATOR low SPRING_OUT_OF_REACH", 2.0, begin)
            rokviss.fault("robot", "temperature", 2, 56)
            rokviss.wait_told("MANIPULATOR low TEMPERATURE_WARNING", 2.0, begin)
            self.assert_states(rokviss, MANIPULATOR="Operational", JOYSTICK="Operational")
            self.assertEqual(self.plans_since(rokviss, begin), [])

            rokviss.fault("robot", "temperature", 2, 72)
            self.assert_robot_to_safe(rokviss, "FC2 critical", "TEMPERATURE_CRITICAL", begin)

            rokviss.fault("robot", "temperature", 2, 81)
            rokviss.wait_told("MANIPULATOR high TEMPERATURE_MAXIMUM", 2.0, begin)
            self.assert_offline(rokviss, BOTH, begin)
            self.assert_inhibited_in_time(rokviss, "FC2 maximum", ("JOYSTICK",))
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def test_fc7_a_link_that_is_stale_for_a_moment_brings_the_robot_to_safe_operational_only(self):
        # A busy computer may hold this program up between stop and go; that is another fault.
        for _ in range(5):
            with flight.Flight() as rokviss:
                if self.stale_for_a_moment(rokviss):
                    return
        self.fail("the joystick never stood still for as short as wanted")

    def stale_for_a_moment(self, rokviss):
        rokviss.wait_commissioned()
        rokviss.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        time.sleep(1.0)
        begin = rokviss.count()
        # Longer than the age limit, shorter than the watchdog of the joystick's device.
        stop_s, watchdog_s = (0.004, 0.010) if self.members(rokviss)["JOYSTICK"]["realtime"] else (0.030, 0.050)
        joystick = rokviss.pid_of("hirosco-joystick")
        before = time.monotonic()
        os.kill(joystick, signal.SIGSTOP)
        time.sleep(stop_s)
        os.kill(joystick, signal.SIGCONT)
        if time.monotonic() - before > watchdog_s - 0.002:
            return False
        # A host that stopped the manipulator in that moment, too, has kept the link from being stale; once in five it must be.
        if not rokviss.wait_line(lambda line: "JOYSTICK_STATE_STALE" in line.told, 2.0, begin):
            return False
        self.assert_robot_to_safe(rokviss, "FC7", "JOYSTICK_STATE_STALE", begin)
        self.assertEqual(rokviss.end(), 0, rokviss.errors)
        return True

    def test_fc6_a_hung_joystick_that_goes_on_finds_itself_fenced(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            rokviss.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
            time.sleep(2.5)     # longer after the hand than what it moves could be the effect of it
            begin = rokviss.count()
            rokviss.kill("hirosco-joystick", signal.SIGSTOP)
            rokviss.wait_told("JOYSTICK hangs: its cycle stands still", 5.0, begin)
            self.assert_offline(rokviss, ("MANIPULATOR",), begin)
            # Within the second of grace: who stands still for longer is ended (adr 0018).
            continued = rokviss.kill("hirosco-joystick", signal.SIGCONT)
            self.assert_offline(rokviss, ("JOYSTICK",), begin)
            for device in ("robot", "joystick"):
                rokviss.wait_at_rest(device, continued)
            # The guard read the count of a cycle that stood still: it is the last before the continuation.
            self.assert_inhibited_in_time(rokviss, "FC6, continued")
            self.assertNotIn("JOYSTICK info STATE_CHANGED STATE=Operational",
                             [line.told for line in rokviss.told(begin)])
            self.assertEqual(rokviss.end(), 5, "nobody of this flight had caused it")

    def test_fc6_overruns_in_a_row_bring_a_subsystem_to_safe_operational(self):
        with flight.MissionCopy({"hirosco-hello": "hirosco-overrunning", "../../subsystems/hello/hello.xml": "hello.xml"},
                                flight.HELLO) as mission:
            text = (flight.REPOSITORY / "subsystems/hello/hello.xml").read_text()
            pathlib.Path(mission).with_name("hello.xml").write_text(text)
            with flight.Flight(mission) as hello:
                hello.wait_told("commissioned: mode operation")
                limit = 3 if self.members(hello)["HELLO"]["realtime"] else 20
                begin = hello.count()
                self.assertEqual(hello.tc("hello", "MOVE_TO", limit - 1)[0], 0)
                time.sleep(0.5)
                self.assertFalse([line.told for line in hello.told(begin) if "CYCLE_OVERRUNS" in line.told])
                self.assertEqual(hello.tc("hello", "MOVE_TO", limit)[0], 0)
                over = hello.wait_told(f"HELLO medium CYCLE_OVERRUNS IN_A_ROW={limit}", 2.0, begin)
                safe = hello.wait_told("HELLO info STATE_CHANGED STATE=SafeOperational", 2.0, begin)
                flight.measure(f"FC6 overruns: {over.told}, SafeOperational {1e3 * (safe.at_s - over.at_s):.1f} ms later")
                self.assertEqual(hello.end(), 0, hello.errors)

    def test_fc8_a_lost_ground_link_holds_the_robot_and_is_told_after_two_seconds(self):
        with flight.MissionCopy(REMOTE) as mission, flight.Flight(mission) as rokviss:
            rokviss.wait_told("commissioned: mode remote")
            rokviss.fault("joystick", "hand", "sine", 1, 0.1, 0.5)
            time.sleep(1.0)
            begin = rokviss.count()
            self.assertEqual(rokviss.tc("communication", "SET_DELAY", 20, 1)[0], 0)
            time.sleep(0.5)
            held = rokviss.truth("robot")
            # Once for the samples, once for the client that sent the telecommand and went away.
            lost = rokviss.wait_told("COMMUNICATION medium GROUND_LINK_LOST", 4.0, begin)
            rokviss.wait_line(lambda line: line is not lost and line.told == lost.told, 4.0, begin)
            time.sleep(0.5)
            now = rokviss.truth("robot")
            way_m = math.dist([held["tip_x"], held["tip_y"]], [now["tip_x"], now["tip_y"]])
            flight.measure(f"FC8: {lost.told}; the tip moved {1e3 * way_m:.3f} mm meanwhile")
            self.assertLess(way_m, 1e-3)
            self.assertEqual([line.told for line in rokviss.told(begin)].count(lost.told), 2)
            self.assert_states(rokviss, MANIPULATOR="Operational", JOYSTICK="Operational", COMMUNICATION="Operational")
            self.assertEqual(self.plans_since(rokviss, begin), [])
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def test_fc9_short_of_power_both_stop_then_go_and_the_robot_is_refused(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            self.assertEqual(rokviss.tc("supervisor", "SET_POWER_BUDGET", 110)[0], 0)
            rokviss.wait_told("SUPERVISOR medium POWER_LOW BUDGET=110 W RESERVED=105 W", 2.0, begin)
            safe = [rokviss.wait_told(f"{name} info STATE_CHANGED STATE=SafeOperational", 2.0, begin) for name in BOTH]
            rokviss.wait_at_rest("robot", safe[0].received)

            self.assertEqual(rokviss.tc("supervisor", "SET_POWER_BUDGET", 70)[0], 0)
            rokviss.wait_told("SUPERVISOR high LOAD_SHED BUDGET=70 W RESERVED=105 W", 2.0, begin)
            self.assert_offline(rokviss, BOTH, begin)
            self.assert_inhibited_in_time(rokviss, "FC9")

            self.assertEqual(rokviss.tc("supervisor", "SET_MODE", "commissioning")[0], 0)
            self.assertEqual(rokviss.tc("manipulator", "SET_STATE", "PreOperational")[0], 0)
            self.assertEqual(rokviss.tc("manipulator", "CONFIGURE", "STANDALONE")[0], 0)
            code, reports = rokviss.tc("manipulator", "SET_STATE", "SafeOperational")
            self.assertEqual((code, reports), (1, ["1,2"]))
            rokviss.wait_told("power short: MANIPULATOR asks for 60 W, 20 W of 70 W are reserved", 2.0, begin)
            rokviss.wait_told("SUPERVISOR low POWER_REFUSED APID=10 BUDGET=70 W RESERVED=20 W REQUESTED=60 W", 2.0, begin)
            self.assertEqual(rokviss.tc("supervisor", "SET_POWER_BUDGET", 80)[0], 0)
            self.assertEqual(rokviss.tc("manipulator", "SET_STATE", "SafeOperational")[0], 0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)


if __name__ == "__main__":
    flight.main()
