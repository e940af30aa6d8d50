#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The second deployment in real time: rokviss with supervisor and subsystems as threads of one process (`hirosco run --threads`)."""
import os
import pathlib
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree as xml

import flight

# ThreadLauncher::patience, Guard::grace, the time to find that a cycle hangs, Shutdown's limit, and what the shell waits at most.
GONE_S = 2.0 + 1.0 + 1.0 + 5.0 + 6.0
NOT_ISOLATED = ("share their memory", "sealed against nobody", "crash of one", "cannot be ended", "sandbox", "limited for nobody",
                "supervisor cannot be lost alone")
# Of <Resources> of a subsystem: what the framework itself holds in every deployment. Processor time is that of the loops.
IN_FORCE = {"ports", "files", "warning_percent", "waiting_answers", "waiting_events", "waiting_housekeeping", "cycle_commands", "cycle_answers_kB",
            "cycle_events_kB", "cycle_housekeeping_kB", "loop_reports_kB", "channel_kB"}


def threads_of(pid):
    """{thread: name}"""
    return {int(task.name): (task / "comm").read_text().strip() for task in pathlib.Path(f"/proc/{pid}/task").iterdir()}


def declared_limits(mission):
    """Names of the limits in <Resources> of its subsystems."""
    descriptors = [mission.parent / each.get("descriptor") for each in xml.parse(mission).getroot().findall("Subsystem")]
    return {limit for each in descriptors for resources in xml.parse(each).getroot().findall("Resources") for limit in resources.attrib}


def run_once(mission):
    """Its flight of a second, ended or refused."""
    return subprocess.run([flight.BINARIES / "hirosco", "run", mission, "--threads", "--no-ground", "--for", "1s"], cwd=mission.parent,
                          env={**os.environ, "XDG_RUNTIME_DIR": str(mission.parent)}, capture_output=True, text=True, check=False, timeout=60)


class Threads(unittest.TestCase):
    def test_rokviss_flies_coupled_is_commanded_stopped_unplugged_and_brought_up_again(self):
        before = flight.segments()
        with flight.Flight(more=("--threads", "--no-ground")) as rokviss:
            rokviss.wait_commissioned()
            for words in NOT_ISOLATED:
                rokviss.wait_told(words, 0.1)
            self.it_is_one_process(rokviss)
            with flight.Telemetry() as telemetry:
                self.the_robot_follows_the_hand(rokviss, telemetry)
            self.it_moves_as_commanded(rokviss)
            self.an_unplugged_joystick_takes_both_down(rokviss)
            self.everything_stops_and_is_brought_up_again(rokviss)
            self.it_was_late(rokviss)
            self.it_is_one_process(rokviss)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
            self.assertEqual(rokviss.wait_until_gone(5.0), {})
        self.assertEqual(flight.segments(), before)

    def it_is_one_process(self, rokviss):
        self.assertEqual(sorted(rokviss.processes().values()),
                         ["hirosco", "hirosco-sim-joystick", "hirosco-sim-robot", "hirosco-threads"])
        pid = rokviss.pid_of("hirosco-threads")
        names = threads_of(pid)
        for name in ("COMMUNICATION", "MANIPULATOR", "JOYSTICK", "MANIPULATOR cyc", "JOYSTICK cycle", "guard"):
            self.assertIn(name, names.values())
        children = [(pathlib.Path(f"/proc/{pid}/task/{thread}/children")).read_text() for thread in names]
        self.assertEqual("".join(children), "", "it has started no process")
        open_files = [os.readlink(file) for file in pathlib.Path(f"/proc/{pid}/fd").iterdir()]
        # What the keeper holds comes from outside; its own memory is none that could be handed over.
        kept = ("hirosco-keeper", "hirosco-journal", "hirosco-texts")
        self.assertEqual([name for name in open_files if "memfd" in name and not any(one in name for one in kept)], [])

    def the_robot_follows_the_hand(self, rokviss, telemetry):
        rokviss.fault("joystick", "hand", "sine", 1, 0.05, 0.5, 0)
        time.sleep(1.0)
        telemetry.forget()
        time.sleep(3.0)
        felt = [values for _, values in telemetry.wait_housekeeping(4721, 8)]
        hand = [values["position"][0] for values in felt]
        robot = [values["peer_position"][0] for values in felt]
        coupled = flight.correlation(hand, robot)
        flight.measure(f"hand spans {max(hand) - min(hand):.3f} rad, correlation hand to robot {coupled:.4f}")
        self.assertGreater(max(hand) - min(hand), 0.05)
        self.assertGreater(coupled, 0.95)

    def it_moves_as_commanded(self, rokviss):
        done = rokviss.hirosco("mode", "standalone", "--mission", rokviss.mission)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        code, reports = rokviss.tc("manipulator", "MOVE_TO", -0.85, 1.70, 2.0)     # clear of the rail
        self.assertEqual((code, reports[0], reports[-1]), (0, "1,1", "1,7"), rokviss.log("--text", "MANIPULATOR", last=5))
        done = rokviss.hirosco("mode", "telepresence", "--mission", rokviss.mission)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def an_unplugged_joystick_takes_both_down(self, rokviss):
        begin = rokviss.count()
        unplugged = time.monotonic()
        rokviss.fault("joystick", "unplug")
        rokviss.wait_told("JOYSTICK high JOYSTICK_LOST", 5.0, begin)
        rokviss.wait_told("JOYSTICK is Offline", 5.0, begin)
        down = rokviss.wait_told("MANIPULATOR is Offline", 5.0, begin)
        rokviss.wait_at_rest("robot", down.received)
        flight.measure(f"both Offline {1e3 * (down.received - unplugged):.0f} ms after the unplugging, the tool's own time included")
        rokviss.fault("joystick", "plug")
        self.bring_up(rokviss)

    def everything_stops_and_is_brought_up_again(self, rokviss):
        code, reports = rokviss.tc("supervisor", "SAFE_ALL")
        self.assertEqual((code, reports[-1]), (0, "1,7"))
        rokviss.wait_at_rest("robot", time.monotonic())
        self.bring_up(rokviss)
        done = rokviss.hirosco("safe", "--mission", rokviss.mission)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("says the device", done.stdout)
        self.bring_up(rokviss)

    def bring_up(self, rokviss):
        done = rokviss.hirosco("mode", "telepresence", "--mission", rokviss.mission)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        status = rokviss.wait_status(lambda s: all(m["state"] == "Operational" for m in s["subsystems"]), 5.0)
        self.assertIsNotNone(status)

    def it_was_late(self, rokviss):
        status = rokviss.wait_status(lambda s: True, 3.0)
        for member in status["subsystems"]:
            flight.measure("{name}: late {0:.0f} us at most, {cycles} cycles, {missed} missed, {overruns} overruns"
                           .format(member["latency_max_ns"] / 1e3, **member))


class Hangs(unittest.TestCase):
    def test_a_spinning_cycle_is_fenced_and_as_nothing_can_end_it_the_whole_flight_ends(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-spinnable-", dir=flight.BINARIES) as programs:
            for program in flight.BINARIES.glob("hirosco*"):
                if program.is_file() and program.name != "hirosco-threads":
                    os.link(program, pathlib.Path(programs) / program.name)
            os.link(flight.BINARIES / "hirosco-spinnable-threads", pathlib.Path(programs) / "hirosco-threads")
            with flight.Flight(binaries=programs, more=("--threads", "--no-ground")) as rokviss:
                rokviss.wait_commissioned()
                self.push(rokviss)
                pid = rokviss.pid_of("hirosco-threads")
                cycle, = (thread for thread, name in threads_of(pid).items() if name == "MANIPULATOR cyc")
                begin = rokviss.count()
                spins = time.monotonic()
                flight.spin(pid, cycle)
                hangs = rokviss.wait_told("MANIPULATOR hangs: its cycle stands still", 5.0, begin)
                rokviss.wait_at_rest("robot", hangs.received)
                # The others have the processor again: the supervisor answers while the one still spins.
                self.assertEqual(rokviss.tc("joystick", "ping")[0], 0)
                ends = rokviss.wait_told("MANIPULATOR does not let go, and a thread cannot be ended", 6.0, begin)
                rokviss.wait_told("JOYSTICK info STATE_CHANGED STATE=Offline", 8.0, begin)
                self.assertEqual(rokviss.process.wait(GONE_S), 4, "ended from inside")
                flight.measure(f"hang told {1e3 * (hangs.received - spins):.0f} ms after it, the end of the flight "
                               f"{ends.received - spins:.2f} s, gone {time.monotonic() - spins:.2f} s")
                self.assertEqual(rokviss.wait_until_gone(5.0), {})
                self.assertIn("what cannot be ended is ended with this process", " ".join(rokviss.errors))

    def push(self, craft):
        """The robot pushes on the rail; that does not pass by itself."""
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")


class Told(unittest.TestCase):
    def test_each_limit_that_the_mission_declares_is_in_force_or_named_at_the_start(self):
        with flight.MissionCopy({}) as mission:
            text = mission.read_text()
            mission.write_text(text.replace("  <Power budget_W", '  <Isolation users="60600-60699"/>\n  <Power budget_W'))
            declared = declared_limits(mission)
            done = run_once(mission)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = [line for line in done.stdout.splitlines() if "not isolated as they should be" in line]
        words = {word.strip(",:") for line in told if "that a subsystem declares" in line for word in line.split()}
        self.assertIn("processor_percent", declared)
        self.assertLessEqual(declared - IN_FORCE, words, told)
        self.assertEqual(sum("users 60600-60699 that the mission names are nobody's" in line for line in told), 1, told)


class Refused(unittest.TestCase):
    def test_a_mission_that_wants_isolation_starts_nobody_as_a_thread(self):
        with flight.MissionCopy({}) as mission:
            text = mission.read_text()
            mission.write_text(text.replace("  <Power budget_W", '  <Isolation required="yes"/>\n  <Power budget_W'))
            done = run_once(mission)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("cannot start MANIPULATOR: the mission wants it isolated, and threads of one process share", done.stdout)

    def test_a_mission_with_a_manifest_does_not_fly_as_threads(self):
        with flight.MissionCopy({}) as mission:
            text = mission.read_text()
            (mission.parent / "manifest.sha256").write_text("")
            mission.write_text(text.replace("  <Power budget_W", '  <Manifest path="manifest.sha256"/>\n  <Power budget_W'))
            done = run_once(mission)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn("lists programs, and threads are none", done.stderr)


if __name__ == "__main__":
    flight.main()
