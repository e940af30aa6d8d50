#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The demonstrator flies for real: commissioned in time, coupled, felt, and gone without a trace."""
import json
import subprocess
import time
import unittest

import flight


class Rokviss(unittest.TestCase):
    def test_it_flies_coupled_and_leaves_nothing_behind(self):
        before = flight.segments()
        with flight.Flight() as rokviss:
            commissioned = rokviss.wait_commissioned()
            took = commissioned.received - rokviss.started
            flight.measure(f"commissioned to telepresence {took:.3f} s after the start")
            self.assertLess(took, 3.0)
            with flight.Telemetry() as telemetry:
                self.the_robot_follows_the_hand(rokviss, telemetry)
                self.the_wall_is_felt(rokviss, telemetry)
            self.what_it_takes_now_stands_between(rokviss)
            code = rokviss.end()
            self.assertEqual(code, 0, rokviss.errors)
            self.assertEqual(rokviss.wait_until_gone(5.0), {})
            self.it_went_down_in_order(rokviss)
            self.what_it_took_stands_beside_what_it_declares(rokviss)
        self.assertEqual(flight.segments(), before)

    def the_robot_follows_the_hand(self, rokviss, telemetry):
        for axis, phase in ((1, 0.0), (2, 1.5708)):
            rokviss.fault("joystick", "hand", "sine", axis, 0.05, 0.5, phase)
        time.sleep(1.0)
        telemetry.forget()
        time.sleep(4.0)
        follows = [values for _, values in telemetry.wait_housekeeping(4713, 40)]
        felt = [values for _, values in telemetry.wait_housekeeping(4721, 10)]
        for axis in range(2):
            hand = [values["position"][axis] for values in felt]
            robot = [values["peer_position"][axis] for values in felt]
            coupled = flight.correlation(hand, robot)
            tracked = flight.correlation([v["desired"][axis] for v in follows], [v["position"][axis] for v in follows])
            span = max(hand) - min(hand)
            flight.measure(f"axis {axis + 1}: hand spans {span:.3f} rad, correlation hand to robot {coupled:.4f}, "
                           f"robot desired to measured {tracked:.4f}")
            self.assertGreater(span, 0.05)
            self.assertGreater(coupled, 0.95)
            self.assertGreater(tracked, 0.95)

    def the_wall_is_felt(self, rokviss, telemetry):
        # RO2's middle case, so there is a closed form; it knows no friction.
        rokviss.fault("robot", "friction", "off")
        rokviss.fault("joystick", "hand", "cartesian", 0.0226, 0, 2)
        time.sleep(3.0)
        telemetry.forget()
        time.sleep(1.0)
        force = rokviss.truth("robot")["force"]
        pressed = [values for _, values in telemetry.housekeeping(4713)][-1]
        felt = [values for _, values in telemetry.housekeeping(4721)][-1]
        flight.measure(f"wall: {force:.2f} N true (closed form 43.52), {pressed['tip_force'][0]:.2f} N from the joints, "
                       f"felt ({felt['torque'][0]:+.4f}, {felt['torque'][1]:+.4f}) N m")
        self.assertAlmostEqual(force, 43.52, delta=0.01 * 43.52)
        self.assertAlmostEqual(abs(pressed["tip_force"][0]), force, delta=0.02 * force)
        for axis in range(2):
            self.assertAlmostEqual(felt["torque"][axis], -0.02 * felt["peer_torque"][axis], delta=0.005)
        self.assertGreater(abs(felt["torque"][1]), 0.1)

    def it_went_down_in_order(self, rokviss):
        after = [line.told for line in rokviss.told()]
        after = after[next(at for at, text in enumerate(after) if text.startswith("shutdown")):]
        self.assertFalse([text for text in after if "no answer" in text or "time limit" in text], after)
        for name in ("MANIPULATOR", "JOYSTICK", "COMMUNICATION"):
            places = [after.index(f"{name} info STATE_CHANGED STATE={state}")
                      for state in ("SafeOperational", "PostOperational", "HardwareDeinit", "SoftwareDeinit", "Offline")]
            self.assertEqual(places, sorted(places), after)

    def what_it_takes_now_stands_between(self, rokviss):
        told = rokviss.hirosco("resources", rokviss.mission, "--json")
        rows = {(row["subsystem"], row["resource"]): row for row in map(json.loads, told.stdout.splitlines())}
        for name, watts in (("MANIPULATOR", 60), ("JOYSTICK", 25)):
            self.assertEqual({key: rows[name, "power_W"][key] for key in ("declared", "now", "high")}, dict.fromkeys(("declared", "now", "high"), watts))
            self.assertEqual((rows[name, "processes"]["declared"], rows[name, "processes"]["now"]), (1, 1))
            self.assertEqual((rows[name, "cycles_percent"]["declared"], rows[name, "cycles_percent"]["now"]), (20, 20), "100 of 500 us")
            memory = rows[name, "memory_kB"]
            self.assertGreater(memory["now"], 1000, told.stderr)
            self.assertGreaterEqual(memory["high"], memory["now"])
            self.assertLessEqual(rows[name, "descriptors"]["now"], rows[name, "descriptors"]["declared"])
        craft = rows["SUPERVISOR", "power_W"]
        self.assertEqual((craft["declared"], craft["now"]), (120, 105), "with the ground link and the supervisor itself")
        cycles = rows["SUPERVISOR", "cycles_percent"]
        self.assertEqual((cycles["declared"], cycles["now"]), (100, 45), "of both, and 5 of the ground link")
        self.assertIn("declared       now most used", rokviss.hirosco("resources", rokviss.mission).stdout.splitlines()[0])

    def what_it_took_stands_beside_what_it_declares(self, rokviss):
        told = rokviss.hirosco("resources", rokviss.mission, "--json")
        # Reports of the ground link are ten seconds apart: of a shorter flight it is told that there are none.
        self.assertLessEqual({line.split(":")[1].strip() for line in told.stderr.splitlines()}, {"COMMUNICATION"}, told.stderr)
        rows = {(row["subsystem"], row["resource"]): row for row in map(json.loads, told.stdout.splitlines())}
        for name in ("MANIPULATOR", "JOYSTICK"):
            memory, commands = rows[name, "memory_kB"], rows[name, "cycle_commands"]
            self.assertEqual((memory["declared"], commands["declared"]), (65536, 64))
            self.assertGreater(memory["high"], 1000)
            self.assertEqual(memory["percent"], -(-100 * memory["high"] // 65536))
            self.assertGreater(commands["high"], 0, "its changes of state went through it")
            self.assertGreater(rows[name, "cycle_housekeeping_kB"]["percent"], 0)
            flight.measure(f"{name}: " + ", ".join(f"{key[1]} {row['percent']} %" for key, row in rows.items()
                                                   if key[0] == name and row["percent"]))


class Modes(unittest.TestCase):
    MODES = ("standalone", "remote", "feel", "automatic", "telepresence")

    def test_one_telecommand_each_takes_the_craft_from_mode_to_mode_in_the_same_processes(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            before = rokviss.processes()
            longest_s = 0.0
            for mode in self.MODES * 2:
                started, told_before = time.monotonic(), rokviss.count()
                done = rokviss.hirosco("mode", mode, "--mission", rokviss.mission)
                self.assertEqual(done.returncode, 0, f"{mode}: {done.stdout}{done.stderr}")
                longest_s = max(longest_s, time.monotonic() - started)
                rokviss.wait_told("mode " + mode, 5.0, told_before)
            flight.measure(f"{2 * len(self.MODES)} changes of mode, {1e3 * longest_s:.0f} ms at most with the tool's own time")
            self.assertEqual(rokviss.processes(), before)
            preview = rokviss.hirosco("mode", "automatic", "--preview", "--mission", rokviss.mission)
            self.assertEqual(preview.returncode, 0, preview.stderr)
            self.assertIn("JOYSTICK Offline", preview.stdout)
            self.assertIn("MANIPULATOR configuration SCRIPT", preview.stdout)
            plan = rokviss.hirosco("plan", "manipulator:torque_hard_exceeded", "--mission", rokviss.mission, "--json")
            self.assertEqual(plan.returncode, 0, plan.stderr)
            told = json.loads(plan.stdout)
            self.assertEqual((told["event"], told["severity"], told["against"]), ("TORQUE_HARD_EXCEEDED", "high", []))
            self.assertEqual([(step["stage"], step["subsystem"], step["what"]) for step in told["steps"]],
                             [(1, "MANIPULATOR", "shut_down_network")])
            self.assertEqual(rokviss.hirosco("mode", "--mission", rokviss.mission).returncode, 0, "nothing was done")
            # What a stop left: the mode that holds brings it up again.
            self.assertEqual(rokviss.hirosco("safe", "--mission", rokviss.mission).returncode, 0)
            again = rokviss.hirosco("mode", "telepresence", "--mission", rokviss.mission)
            self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def test_a_flight_may_start_in_another_mode_and_not_in_one_that_is_not_there(self):
        with flight.Flight(more=("--mode", "standalone")) as rokviss:
            rokviss.wait_told("commissioned: mode standalone", 20.0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
        nowhere = subprocess.run([flight.BINARIES / "hirosco", "run", flight.ROKVISS, "--mode", "stand-alone"],
                                 capture_output=True, text=True, check=False)
        self.assertEqual(nowhere.returncode, 2)
        self.assertIn("no mode 'stand-alone': commissioning, standalone", nowhere.stderr)


class MissionOverride(unittest.TestCase):
    def test_a_value_that_the_mission_sets_is_the_one_that_the_subsystem_begins_with(self):
        with flight.MissionCopy({}) as mission:
            descriptor = 'descriptor="../../subsystems/manipulator/manipulator.xml"'
            text = mission.read_text()
            self.assertIn(descriptor + "/>", text)
            mission.write_text(text.replace(descriptor + "/>",
                                            f'{descriptor}><Set parameter="TORQUE_LIMIT" value="6"/></Subsystem>'))
            with flight.Flight(mission) as rokviss:
                rokviss.wait_told("MANIPULATOR begins with TORQUE_LIMIT=6")
                rokviss.wait_commissioned()
                begin = rokviss.count()
                rokviss.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)      # comes to 6.7 N m
                told = rokviss.wait_told("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED", 3.0, begin).told
                self.assertIn("LIMIT=6 N m", told)
                self.assertEqual(rokviss.end(), 0, rokviss.errors)


if __name__ == "__main__":
    flight.main()
