#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Devices on a network of the craft's own: the reference device in C by UDP and in Python by TCP in one network namespace, the flight in another. Refused
until the mission names the network, reached by its interface alone then; the cable is cut and mended, and the device says what became of it. A
descriptor that is read again in flight (docs/adr/0095) is held to the same networks."""
import contextlib
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

import flight as flights
import reference
import wire
from flight import BINARIES, Flight

HERE = pathlib.Path(__file__).resolve().parent
INSTANCE = "far-axes"
WATCHDOG_S, SLACK_S = 0.25, 0.15
FAR = wire.ADDRESSES[1]
BESIDE = "198.18.0.3"                            # at the far end, too
TCP_AXIS = 71
OFFLINE, SAFE_OPERATIONAL = 0, 4
NAMED = '<DeviceNetwork address="198.18.0.0/24" interface="end"/>'


def mission_in(folder, networks):
    """Both axes at the far end, TCP at port 5000 and UDP at 5001; `networks` are elements of the mission."""
    serial, tcp = (HERE / "axis_serial.xml").read_text(), (HERE / "axis_tcp.xml").read_text()
    (folder / "axis_serial.xml").write_text(serial.replace('transfer="serial" address="axis@115200"', f'transfer="udp" address="{FAR}:5001"'))
    (folder / "axis_tcp.xml").write_text(tcp.replace("127.0.0.1:10071", f"{FAR}:5000"))
    text = (HERE / "mission.xml").read_text().replace("../../", "@hirosco/").replace("  <Modes", f"  {networks}\n  <Modes", 1)
    (folder / "mission.xml").write_text(text)
    return folder / "mission.xml"


class Network(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="hirosco-network-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def hirosco(self, *words):
        done = subprocess.run([BINARIES / "hirosco", *words], cwd=self.folder, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_nothing_leaves_this_computer_unless_the_mission_names_its_network(self):
        for networks in ("", '<DeviceNetwork address="198.18.1.0/24"/>'):
            code, told = self.hirosco("check", mission_in(self.folder, networks))
            self.assertEqual(code, 1, told)
            line = 1 + (self.folder / "axis_tcp.xml").read_text().split("<Endnode")[0].count("\n")
            self.assertRegex(told, rf"axis_tcp\.xml:{line}:\d+: error: E0313: '{FAR}:5000' leaves this computer")
            self.assertNotEqual(self.hirosco("run", str(self.folder / "mission.xml"), "--for", "1s", "--plain", "--no-ground")[0], 0)
        code, told = self.hirosco("check", mission_in(self.folder, '<DeviceNetwork address="198.18.0.0/24"/>'))
        self.assertEqual(code, 0, told)

    def test_devices_at_the_far_end_of_a_cable_that_is_cut_and_mended(self):
        if not wire.possible():
            flights.skip("no-network-namespace")
        with contextlib.ExitStack() as until_end:
            cable = until_end.enter_context(wire.Wire())
            far = cable.inside(1)
            by_tcp = until_end.enter_context(reference.Device(*far, reference.PYTHON, "-B", reference.FOLDER / "device.py", f"{FAR}:5000"))
            by_udp = until_end.enter_context(reference.Device(*far, reference.built(self.folder), "udp", f"{FAR}:5001"))
            mission = mission_in(self.folder, NAMED)
            flight = until_end.enter_context(Flight(mission, folder=self.folder, instance=INSTANCE, prefix=cable.inside(0)))
            flight.wait_told("commissioned: mode operation", 30)
            for device in (by_tcp, by_udp):
                device.wait("active", 10)
            before, told = [device.count() for device in (by_tcp, by_udp)], flight.count()
            since = cable.cut()
            for device, start in zip((by_tcp, by_udp), before):
                line = device.wait("stopping", 5, start)
                device.wait("holding", 5, start)
                self.assertLess(line["at"] - since, WATCHDOG_S + SLACK_S)
                flights.measure(f"cut: stopping {1000 * (line['at'] - since):.0f} ms after it")
            for name in ("SERIAL_AXIS", "TCP_AXIS"):
                lost = flight.wait_told(f"{name} high AXIS_LOST", 5, told)
                flights.measure(f"cut: {name} told {1000 * (lost.received - since):.0f} ms after it")
            time.sleep(1.0)                          # so long that what was under way by TCP is given up
            self.assertFalse([line for device, start in zip((by_tcp, by_udp), before) for line in device.lines[start:] if line["output"] == "active"])
            cable.mend()
            environment = {**flight.environment, flights.MARK: ""}
            end = time.monotonic() + 20
            while subprocess.run([*cable.inside(0), BINARIES / "hirosco", "mode", "operation", "--instance", INSTANCE], cwd=self.folder,
                                 env=environment, capture_output=True, check=False).returncode != 0:
                self.assertLess(time.monotonic(), end)
            for device, start in zip((by_tcp, by_udp), before):
                device.wait("active", 10, start)
            flight.end()

    def test_a_device_moves_within_the_network_by_a_descriptor_that_is_read_again_and_no_further(self):
        if not wire.possible():
            flights.skip("no-network-namespace")
        with contextlib.ExitStack() as until_end:
            cable = until_end.enter_context(wire.Wire())
            far = cable.inside(1)
            subprocess.run([*far, "ip", "address", "add", f"{BESIDE}/24", "dev", "end"], check=True)
            here, there = (until_end.enter_context(reference.Device(*far, reference.PYTHON, "-B", reference.FOLDER / "device.py", f"{host}:5000"))
                           for host in (FAR, BESIDE))
            until_end.enter_context(reference.Device(*far, reference.built(self.folder), "udp", f"{FAR}:5001"))
            mission = mission_in(self.folder, NAMED)
            mission.write_text(mission.read_text().replace('<Permit subsystem="*" functions="*"/>',
                                                           '<Permit subsystem="*" functions="*"/><Permit subsystem="SUPERVISOR" functions="REREAD"/>'))
            # The ground's own copy: what refuses is the craft.
            ground = pathlib.Path(until_end.enter_context(tempfile.TemporaryDirectory(prefix="hirosco-network-ground-")))
            for file in self.folder.glob("*.xml"):
                shutil.copy(file, ground)
            descriptor = self.folder / "axis_tcp.xml"
            first = descriptor.read_text()
            flight = until_end.enter_context(Flight(mission, folder=self.folder, instance=INSTANCE, prefix=cable.inside(0)))

            def hirosco(*words):
                done = subprocess.run([*cable.inside(0), BINARIES / "hirosco", *map(str, words), "--mission", ground / "mission.xml",
                                       "--instance", INSTANCE], cwd=self.folder, env={**flight.environment, flights.MARK: ""}, capture_output=True, text=True, check=False)
                return done.returncode, done.stdout + done.stderr

            def reread(address):
                descriptor.write_text(first.replace(f"{FAR}:5000", address))
                return hirosco("tc", "supervisor", "REREAD", TCP_AXIS)

            def comes_up():
                end = time.monotonic() + 20
                while (done := hirosco("mode", "operation"))[0] != 0:
                    self.assertLess(time.monotonic(), end, done[1])

            flight.wait_told("commissioned: mode operation", 30)
            here.wait("active", 10)
            for state in (SAFE_OPERATIONAL, OFFLINE):
                code, told = hirosco("tc", "TCP_AXIS", "SET_STATE", state)
                self.assertEqual(code, 0, told)
            line = 1 + first.split("<Endnode")[0].count("\n")
            code, told = reread("198.18.1.2:5000")
            self.assertEqual(code, 1, told)
            self.assertRegex(told, rf"axis_tcp\.xml:{line}:\d+: error: E0313: '198\.18\.1\.2:5000' leaves this computer")
            before = here.count()
            comes_up()                                                # by what was in force
            here.wait("active", 10, before)
            for state in (SAFE_OPERATIONAL, OFFLINE):
                hirosco("tc", "TCP_AXIS", "SET_STATE", state)
            self.assertFalse([each for each in there.lines if each["output"] == "active"])
            code, told = reread(f"{FAR}:5002")
            self.assertEqual(code, 1, told)
            self.assertIn("TCP_AXIS cannot reach TCP port 5002", told)    # docs/adr/0150
            code, told = reread(f"{BESIDE}:5000")
            self.assertEqual(code, 0, told)
            before = here.count()
            comes_up()
            there.wait("active", 10)
            self.assertFalse([each for each in here.lines[before:] if each["output"] == "active"])
            flight.end()


if __name__ == "__main__":
    flights.main()
