#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A real Yamcs, started headless on the loopback with the exported project, beside a real flight of rokviss: what an operator there
sees and commands, read back through its API; and every packet of the flight, read by Yamcs' own extractor and by a foreign decoder.

    yamcs_test.py FOLDER      (where Yamcs' jars are kept; Maven brings them the first time)"""
import contextlib
import datetime
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

JARS = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "endtoend"))
import flight  # noqa: E402

sys.argv[1:] = [str(flight.BINARIES / "hirosco"), str(flight.BINARIES / "packets_probe")]
import xtce_test  # noqa: E402
from yamcs.client import YamcsClient, YamcsError  # noqa: E402

START_S = 60.0
SUBSYSTEMS = ("SUPERVISOR", "COMMUNICATION", "MANIPULATOR", "JOYSTICK")


def jars(project):
    """The class path of Yamcs, of the version that the exported project names."""
    if shutil.which("java") is None:
        flight.skip("no-yamcs", "no java")
    if not any(JARS.glob("yamcs-core-*.jar")):
        try:
            done = subprocess.run(["mvn", "-q", "-B", "-f", str(project / "pom.xml"), "dependency:copy-dependencies",
                                   f"-DoutputDirectory={JARS}"], capture_output=True, text=True, timeout=600, check=False)
        except OSError as error:
            flight.skip("no-yamcs", error)
        if done.returncode != 0:
            flight.skip("no-yamcs", done.stdout[-300:])
    return f"{JARS}/*"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Yamcs:
    """The server, in the folder of the project."""

    def __init__(self, project):
        self.port = free_port()
        path = project / "etc/yamcs.yaml"
        path.write_text(path.read_text().replace("port: 8090", f"port: {self.port}"))
        (project / "yamcs-data").mkdir()
        self.log = (project / "server.log").open("w+")
        self.began = time.monotonic()
        self.process = subprocess.Popen(["java", "-Xmx256m", "-cp", jars(project), "org.yamcs.YamcsServer", "--etc-dir", "etc",
                                         "--data-dir", "yamcs-data", "--no-color"], cwd=project, stdout=self.log,
                                        stderr=subprocess.STDOUT, start_new_session=True)
        self.client = self._wait()

    def _wait(self):
        while time.monotonic() - self.began < START_S:
            if self.process.poll() is not None:
                break
            with contextlib.suppress(YamcsError, OSError):
                client = YamcsClient(f"127.0.0.1:{self.port}")
                if any((one.name, one.state) == ("rokviss", "RUNNING") for one in client.list_instances()):
                    return client
            time.sleep(0.2)
        self.close()
        raise AssertionError(f"Yamcs did not start: {self.told[-3000:]}")

    def close(self):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGTERM)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
        if not self.log.closed:
            self.log.seek(0)
            self.told = self.log.read()
            self.log.close()


class Recorder:
    """Another ground station: every packet of the telemetry port."""

    def __init__(self):
        self.packets, self.socket = [], socket.create_connection(("127.0.0.1", flight.PORT), 5)
        self.thread = threading.Thread(target=self._read)
        self.thread.start()

    def _read(self):
        stream = bytearray()
        with contextlib.suppress(OSError):
            while octets := self.socket.recv(65536):
                stream += octets
                while len(stream) >= 6 and len(stream) >= 7 + int.from_bytes(stream[4:6], "big"):
                    size = 7 + int.from_bytes(stream[4:6], "big")
                    self.packets.append(bytes(stream[:size]))
                    del stream[:size]

    def close(self):
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self.thread.join()
        self.socket.close()


class OnAFlight(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        xtce_test.export("yamcs", flight.ROKVISS, folder.name)
        cls.project = pathlib.Path(folder.name, "rokviss-yamcs")
        jars(cls.project)

    @contextlib.contextmanager
    def commissioned(self):
        """A flight in telepresence. Where the host was late while it came up, another one."""
        for last in (False, False, True):
            with flight.Flight(quiet=True) as craft:
                try:
                    craft.wait_commissioned()
                except AssertionError:
                    if last:
                        raise
                    flight.measure("a flight that was not commissioned was given up")
                    continue
                yield craft
                return

    def test_an_operator_of_yamcs_sees_and_commands_the_craft(self):
        with self.commissioned():
            recorder = Recorder()
            self.addCleanup(recorder.close)
            yamcs = Yamcs(self.project)
            self.addCleanup(yamcs.close)
            flight.measure(f"Yamcs up in {time.monotonic() - yamcs.began:.1f} s")
            self.client = yamcs.client
            self.processor = yamcs.client.get_processor("rokviss", "realtime")
            self.archive = yamcs.client.get_archive("rokviss")
            for finding in (self.housekeeping_is_live, self.everybody_answers_a_ping, self.what_is_refused_says_why,
                            self.a_stack_brings_the_craft_into_a_mode, self.a_motion_is_flown_through_all_verifiers,
                            self.parameters_are_asked_for_and_set, self.a_report_is_asked_for, self.events_are_words,
                            self.it_stands_in_the_archive, self.a_stack_commissions):
                with self.subTest(finding.__name__):
                    finding()
            recorder.close()
            yamcs.close()
            problems = [line for line in yamcs.told.splitlines() if re.search(r"Exception processing packet|No template|CRC.* error|SEVERE", line)]
            self.assertEqual(problems, [], "\n".join(problems))
        with self.subTest("every packet"):
            self.every_packet_is_read_alike(recorder.packets)

    # What is found, in this order.
    def value(self, path, **since):
        return self.processor.get_parameter_value(path, from_cache=True, **since)

    def until(self, condition, what, seconds=20.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = condition()
            if found:
                return found
            time.sleep(0.1)
        raise AssertionError(f"not in {seconds} s: {what}")

    def command(self, path, **arguments):
        """Sends it and waits for its end."""
        command = self.connection.issue(path, args=arguments)
        command.await_complete(timeout=30.0)
        return command

    def housekeeping_is_live(self):
        position = self.until(lambda: self.value("/ROKVISS/MANIPULATOR/CUR_VALUES/POSITION"), "a report of the manipulator")
        self.assertEqual(len(position.eng_value), 2)
        later = self.until(lambda: (now := self.value("/ROKVISS/MANIPULATOR/CUR_VALUES/POSITION")).generation_time >
                           position.generation_time and now, "another one")
        age = datetime.datetime.now(datetime.timezone.utc) - later.generation_time
        self.assertLess(abs(age.total_seconds()), 5.0, "the epoch is another one")
        state = self.until(lambda: self.value("/ROKVISS/MANIPULATOR/CUR_VALUES/STATE"), "its state")
        self.assertEqual(state.eng_value, "Operational")
        mode = self.until(lambda: self.value("/ROKVISS/SUPERVISOR/MODE"), "the mode")
        self.assertEqual(mode.eng_value, 3)
        self.connection = self.processor.create_command_connection()

    def everybody_answers_a_ping(self):
        for name in SUBSYSTEMS:
            with self.subTest(name):
                command = self.command(f"/ROKVISS/{name}/PING")
                self.assertTrue(command.is_complete() and command.is_success(), command.error)

    def what_is_refused_says_why(self):
        command = self.command("/ROKVISS/MANIPULATOR/MOVE_TO", Q1=0.1, Q2=1.2, DURATION=2.0)
        self.assertFalse(command.is_success())
        self.assertIn("not permitted in this mode", command.error)
        # The verdict and the fields of its report reach Yamcs' clients each on its own way.
        mode = self.until(lambda: self.value("/ROKVISS/failure_mode"), "the mode that the refusal tells")
        self.assertEqual(mode.eng_value, "telepresence")

    def a_stack_brings_the_craft_into_a_mode(self):
        self.run_stack("mode_standalone.ycs", 2)

    def run_stack(self, name, mode):
        stack = {"type": "STACK", "args": {"processor": "realtime", "bucket": "stacks", "stack": name}}
        started = self.client.ctx.request("post", "/activities/rokviss/activities", json=stack).json()
        ended = self.until(lambda: (one := self.client.ctx.request("get", f"/activities/rokviss/activities/{started['id']}").json())
                           ["status"] not in ("RUNNING", "SCHEDULED") and one, name, 90.0)
        self.assertEqual(ended["status"], "SUCCESSFUL", ended)
        self.assertEqual(self.value("/ROKVISS/SUPERVISOR/MODE").eng_value, mode)

    def a_motion_is_flown_through_all_verifiers(self):
        command = self.command("/ROKVISS/MANIPULATOR/MOVE_TO", Q1=-0.9, Q2=1.5, DURATION=2.0)
        self.assertTrue(command.is_success(), command.error)
        stages = {name: one.status for name, one in command.acknowledgments.items() if name.startswith("Verifier_")}
        self.assertEqual(stages, {f"Verifier_{name}": "OK" for name in ("Accepted", "Started", "Progress", "Complete")})
        done = datetime.datetime.now(datetime.timezone.utc)
        there = self.until(lambda: (now := self.value("/ROKVISS/MANIPULATOR/CUR_VALUES/POSITION")).generation_time > done and now,
                           "a report after the motion")
        for measured, wanted in zip(there.eng_value, (-0.9, 1.5)):
            self.assertLess(abs(measured - wanted), 0.02)
        fast = self.command("/ROKVISS/MANIPULATOR/MOVE_TO", Q1=0.9, Q2=0.5, DURATION=0.1)
        self.assertIn("TOO_FAST", fast.error)

    def parameters_are_asked_for_and_set(self):
        asked = self.command("/ROKVISS/MANIPULATOR/REPORT_VALUES", NUMBER_OF_PARAMETERS=2, PARAMETERS=["KP", "TEMP_LIMITS"])
        self.assertTrue(asked.is_success(), asked.error)
        self.assertEqual(self.until(lambda: self.value("/ROKVISS/MANIPULATOR/KP"), "KP").eng_value, 300.0)
        self.assertEqual(list(self.value("/ROKVISS/MANIPULATOR/TEMP_LIMITS").eng_value), [55.0, 70.0, 80.0])
        self.assertIn("not permitted now", self.command("/ROKVISS/MANIPULATOR/WRITE_POS_SCALE", VALUE=0.5).error)
        safe = self.command("/ROKVISS/MANIPULATOR/SET_STATE", STATE="SafeOperational")
        self.assertTrue(safe.is_success(), safe.error)
        written = self.command("/ROKVISS/MANIPULATOR/WRITE_POS_SCALE", VALUE=0.5)
        self.assertTrue(written.is_success(), written.error)
        self.command("/ROKVISS/MANIPULATOR/REPORT_VALUES", NUMBER_OF_PARAMETERS=1, PARAMETERS=["POS_SCALE"])
        self.assertEqual(self.until(lambda: self.value("/ROKVISS/MANIPULATOR/POS_SCALE"), "POS_SCALE").eng_value, 0.5)
        back = self.command("/ROKVISS/MANIPULATOR/WRITE_POS_SCALE", VALUE=1.0)
        self.assertTrue(back.is_success(), back.error)

    def a_report_is_asked_for(self):
        command = self.command("/ROKVISS/MANIPULATOR/ONE_SHOT", NUMBER_OF_STRUCTURES=1, STRUCTURES=[4712])
        self.assertTrue(command.is_success(), command.error)
        self.assertTrue(self.value("/ROKVISS/MANIPULATOR/TIP"))

    def events_are_words(self):
        told = [event.message for event in self.archive.list_events(text_filter="MANIPULATOR")]
        self.assertIn("MANIPULATOR MOTION_DONE", told)
        self.assertIn("MANIPULATOR STATE_CHANGED STATE=SafeOperational", told)

    def it_stands_in_the_archive(self):
        names = list(self.archive.list_packet_names())
        self.assertIn("/ROKVISS/MANIPULATOR/HK_4711", names)
        self.assertGreater(len(list(self.archive.list_packets(name="/ROKVISS/MANIPULATOR/HK_4711"))), 5)
        sent = [entry.name for entry in self.archive.list_command_history()]
        self.assertIn("/ROKVISS/MANIPULATOR/MOVE_TO", sent)

    def a_stack_commissions(self):
        self.run_stack("mode_commissioning.ycs", 1)
        self.run_stack("commission_telepresence.ycs", 3)

    # Two foreign decoders.
    def every_packet_is_read_alike(self, packets):
        self.assertGreater(len(packets), 300)
        document = self.project / "mdb/ROKVISS.xml"
        decoder = xtce_test.Decoder(document)
        done = subprocess.run(["java", "-cp", jars(self.project), str(HERE / "DecodePackets.java"), str(document)],
                              input="\n".join(packet.hex() for packet in packets), capture_output=True, text=True, timeout=120,
                              check=True)
        read = done.stdout.split("packet\n")[1:]
        self.assertEqual(len(read), len(packets))
        for packet, text in zip(packets, read):
            ours = [value for name, value in decoder.decode(packet).items() if not name.endswith(":length")]
            theirs, covered = [], 0
            for line in text.splitlines():
                _, first, size, value = line.split("\t")
                if int(first) < covered:
                    continue               # read a second time, for verifiers
                self.assertEqual(int(first), covered, line)
                covered += int(size)
                theirs += value.split(" ")
            self.assertEqual(covered, 8 * len(packet), packet.hex())
            self.assertEqual(len(ours), len(theirs), packet.hex())
            for one, other in zip(ours, theirs):
                self.assertEqual(same_form(one, other), other, packet.hex())
        flight.measure(f"{len(packets)} packets of the flight read alike by Yamcs and by space_packet_parser")


def same_form(value, like):
    """A value of the one decoder as the other prints it."""
    if like[:1] == "f":
        return f"f{struct.unpack('>I', struct.pack('>f', value))[0]:x}"
    if like[:1] == "d":
        return f"d{struct.unpack('>Q', struct.pack('>d', value))[0]:x}"
    if like[:1] == "x":
        octets = value if isinstance(value, bytes) else value.encode()
        return "x" + (octets if len(octets) * 2 + 1 == len(like) else octets.split(b"\0")[0]).hex()
    return str(int(value))


if __name__ == "__main__":
    sys.argv[1:] = []
    flight.main()
