# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The exported Python client on a real flight: the worked example moves the robot, and what the spacecraft refuses is
told with its code and text. Python's standard library only."""
import importlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import flight

EXAMPLE = flight.REPOSITORY / "missions/rokviss/move_and_plot.py"


def export(mission, folder):
    """`hirosco export python`: what it printed."""
    done = subprocess.run([str(flight.BINARIES / "hirosco"), "export", "python", str(mission), "--to", str(folder)],
                          capture_output=True, text=True, timeout=20, check=True)
    return done.stdout


class Export(unittest.TestCase):
    def test_another_mission_has_its_own_classes_without_a_change_anywhere(self):
        with tempfile.TemporaryDirectory() as folder:
            told = export(flight.HELLO, folder)
            self.assertIn(f"PYTHONPATH={folder}", told)
            package = pathlib.Path(folder, "hirosco_hello")
            self.assertEqual({path.name for path in package.iterdir()}, {"__init__.py", "packets.py", "flights.py", "descriptors.py", "links.py", "reports.py", "runtime.py",
                                                                           "shapes.py"})
            for path in package.iterdir():
                compile(path.read_text(), path.name, "exec")
            self.assertIn("class Hello(_r.Subsystem):", (package / "__init__.py").read_text())

    def test_a_function_that_is_new_in_a_descriptor_is_a_method(self):
        text = (flight.REPOSITORY / "subsystems/hello/hello.xml").read_text()
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("supervisor", "subsystems/communication"):
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).symlink_to(flight.REPOSITORY / name)
            for path, content in (("subsystems/hello/hello.xml", text.replace(
                    "</FunctionService>", '<Function name="FLY_AWAY" states="Operational"><Argument name="HEIGHT" '
                    'type="FLOAT" unit="m" minimum="0" maximum="9"/></Function></FunctionService>')),
                                  ("missions/hello/mission.xml", flight.HELLO.read_text())):
                (root / path).parent.mkdir(parents=True)
                (root / path).write_text(content)
            export(root / "missions/hello/mission.xml", root)
            module = (root / "hirosco_hello/__init__.py").read_text()
            self.assertIn("def fly_away(self, height: float,", module)
            self.assertIn("height: FLOAT, m, 0 to 9", module)


class OnAFlight(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        export(flight.ROKVISS, cls.folder.name)
        sys.path.insert(0, cls.folder.name)
        cls.rokviss = importlib.import_module("hirosco_rokviss")

    @classmethod
    def tearDownClass(cls):
        sys.path.remove(cls.folder.name)
        cls.folder.cleanup()

    def test_the_example_moves_the_robot_and_the_client_tells_what_is_refused(self):
        with flight.Flight() as craft:
            craft.wait_commissioned()
            self.example(craft)
            with self.rokviss.Spacecraft() as client:
                client.wait_until(lambda: client.mode and client.manipulator.state)
                self.refusals(client)
                self.parameters_and_housekeeping(client)
                self.two_at_once(client)
                self.assertEqual(client.damaged, 0)
                self.end(craft, client)

    def test_a_client_goes_on_with_the_next_flight(self):
        links = []
        with flight.Flight() as craft:
            craft.wait_commissioned()
            client = self.rokviss.Spacecraft(reconnect=True)
            self.addCleanup(client.close)
            client.on_link(links.append)
            client.wait_until(lambda: client.mode)
        client.wait_until(lambda: not client.connected)
        with self.assertRaises(self.rokviss.LinkLost):
            client.manipulator.ping()
        with flight.Flight() as craft:
            craft.wait_commissioned()
            client.wait_until(lambda: client.connected)
            received = client.received
            client.manipulator.ping()
            client.manipulator.hk_4713()
            self.assertGreater(client.received, received)
            self.assertEqual(links, [False, True])
            self.assertEqual(client.supervisor.safe_all().verifications[-1].stage, "completed")
            self.assertEqual(client._essential._connection.getpeername()[1], 10025, "its own way, to this flight")

    def example(self, craft):
        plot = pathlib.Path(self.folder.name, "plot.svg")
        done = subprocess.run([sys.executable, "-B", str(EXAMPLE), str(plot)], capture_output=True, text=True,
                              timeout=40, env={**os.environ, "PYTHONPATH": self.folder.name}, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("not sent: MOVE_TO: Q1: 5 rad is above its maximum 1 rad", done.stdout)
        self.assertIn("not permitted in this mode (code 13), mode standalone", done.stdout)
        self.assertEqual(re.findall(r" ms  (\w+)", done.stdout), ["accepted", "started", "progress", "completed"])
        goal = [float(number) for number in re.search(r"for \((\S+), (\S+)\);", done.stdout).groups()]
        # Told by another decoder: where the robot stands afterwards.
        with flight.Telemetry() as telemetry:
            end = time.monotonic() + 5.0
            while not telemetry.housekeeping(4713) and time.monotonic() < end:
                time.sleep(0.02)
            position = telemetry.housekeeping(4713)[-1][1]["position"]
        for angle, wanted in zip(position, goal):
            self.assertAlmostEqual(angle, wanted, delta=0.02)
        self.assertRegex(plot.read_text(), "<polyline|<clipPath")  # its own, or matplotlib's
        flight.measure(re.search(r"\d+ reports; .*", done.stdout)[0])

    def refusals(self, client):
        arm, joystick = client.manipulator, client.joystick
        arm.set_state("SafeOperational")
        with self.assertRaises(self.rokviss.CommandFailed) as refused:
            arm.move_to(-0.8, 1.6, 1.0)
        self.assertEqual((refused.exception.code, refused.exception.text), (10, "not permitted in this state"))
        self.assertEqual(refused.exception.parameters, {"state": "SafeOperational"})
        with self.assertRaises(self.rokviss.CommandFailed) as refused:
            joystick.configure("STANDALONE")
        self.assertEqual((refused.exception.code, refused.exception.parameters), (13, {"mode": "standalone"}))
        with self.assertRaisesRegex(self.rokviss.ArgumentError, "'Flying' is none of Offline, SoftwareInit"):
            arm.set_state("Flying")
        with self.assertRaisesRegex(self.rokviss.ArgumentError, "POS_SCALE: 5 is above its maximum 2"):
            arm.set_pos_scale(5)
        arm.set_pos_scale(1.5)
        self.assertEqual(arm.get_pos_scale(), 1.5)
        arm.set_pos_scale(1)
        arm.set_state("Operational")

    def parameters_and_housekeeping(self, client):
        arm = client.manipulator
        with self.assertRaises(self.rokviss.CommandFailed) as refused:  # its descriptor: not in this state
            arm.set_pos_scale(1.5)
        self.assertEqual((refused.exception.code, arm.get_pos_scale()), (0x0107, 1.0))
        self.assertFalse(hasattr(arm, "set_kp"), "a protection has no setter")
        whole = arm.get_cur_values()
        self.assertEqual(set(whole), {"STATE", "POSITION", "VELOCITY", "TORQUE", "TEMPERATURE", "DEVICE_FLAGS"})
        report = arm.hk_4711()
        self.assertEqual(len(report["CUR_VALUES.POSITION"]), 2)
        for told, read in zip(report["CUR_VALUES.POSITION"], whole["POSITION"]):
            self.assertAlmostEqual(told, read, delta=0.01)
        self.assertEqual([v.stage for v in arm.ping().verifications], ["accepted", "started", "completed"])
        self.assertEqual([report.name for report in arm.ping().reports], ["ALIVE"])
        outcome, = arm.report_self_test().reports
        self.assertEqual((outcome.name, outcome["OUTCOME"]), ("SELF_TEST_OUTCOME", "never run"))
        arm.disable_housekeeping(4713)
        with self.assertRaises(self.rokviss.NoAnswer):
            arm.hk_4713(timeout=0.3)
        arm.enable_housekeeping(4713)
        arm.hk_4713()
        self.services_by_their_shapes(client)

    def services_by_their_shapes(self, client):
        arm = client.manipulator
        properties, = arm.report_properties([4713]).reports
        self.assertEqual(properties["STRUCTURES"], ({"STRUCTURE": 4713, "PERIODIC": 1, "INTERVAL": 100},))
        arm.create_structure(60000, 100, ["POS_SCALE"], [{"REPETITIONS": 5, "PARAMETERS": ["KP"]}])
        structure, = arm.report_structures([60000]).reports
        self.assertEqual((structure["PARAMETERS"], structure["SETS"]), (("POS_SCALE",), ({"REPETITIONS": 5, "PARAMETERS": ("KP",)},)))
        arm.delete_structures([60000])
        values, = arm.report_values(["KP", "POS_SCALE"]).reports
        self.assertEqual([one["PARAMETER"] for one in values["PARAMETERS"]], ["KP", "POS_SCALE"])
        self.assertEqual([one["VALUE"] for one in values["PARAMETERS"]], [arm.get_kp(), 1.0])
        arm.disable_events(["MOTION_DONE"])
        self.assertEqual(arm.report_disabled().reports[0]["EVENTS"], ("MOTION_DONE",))
        arm.enable_events(["MOTION_DONE"])
        preview, = client.supervisor.preview_mode(3).reports
        self.assertEqual((preview.name, preview["MODE"]), ("MODE_PREVIEW", 3))
        with self.assertRaises(self.rokviss.CommandFailed) as refused:
            arm.one_shot([60001])
        self.assertEqual(refused.exception.parameters["identifier"], 60001)

    def two_at_once(self, client):
        """Two clients command at the same time; each gets its own reports and no other."""
        chains = []

        def ping(one):
            for _ in range(20):
                chains.append([v.stage for v in one.joystick.ping().verifications])

        with self.rokviss.Spacecraft() as other:
            threads = [threading.Thread(target=ping, args=(one,)) for one in (client, other)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        self.assertEqual(chains, [["accepted", "started", "completed"]] * 40)

    def end(self, craft, client):
        """Whoever waits when the spacecraft ends learns it."""
        request = client.manipulator.move_to(-0.8, 1.6, 30.0, wait=None)
        client.wait_until(lambda: len(request.verifications) >= 2)
        craft.end()
        with self.assertRaises((self.rokviss.CommandFailed, self.rokviss.LinkLost)):
            request.result(10.0)
        with self.assertRaises(self.rokviss.LinkLost):
            client.wait_until(lambda: False, 10.0)
        self.assertFalse(client.connected)


if __name__ == "__main__":
    flight.main()
