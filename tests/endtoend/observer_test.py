#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""observer_test.py: the promises of the ten states (paper 4.2) as an outside observer sees them: what a subsystem's process holds stands in
/proc, what it says on the ground link, what its device gets at the device. Ten times up and down, compared with what it held before it was up for
the first time; nothing of a subsystem is asked. The states that pass by themselves are looked at by tests/held/transient_states_test.py."""
import binascii
import collections
import struct
import time
import unittest

import flight
from holding import Holding, assert_gives_back, compared

IMAGER = flight.REPOSITORY / "tests/endnodes/mission.xml"
OFFLINE, PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL, POST_OPERATIONAL = 0, 3, 4, 5, 7
ROUNDS = 10
# What may grow once the allocator keeps what it does is a page here and there; what a state takes is far more than that.
SAME_KB = 256
# A mode in which ground is heard, and nobody else was ever up.
LISTENING = {"safe": 'listening"><Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>'
                     '<Permit subsystem="SUPERVISOR" functions="SET_MODE"/></Mode><Mode name="safe'}


POS_SCALE = flight.MANIPULATOR << 16 | 10 << 8 | 8     # its id on the wire: subsystem, layout DOUBLE, number
DESCRIPTOR_VALUE = 1.0


class Operator(flight.Telemetry):
    """Sets and reads one parameter of the manipulator, on the same connection."""

    count = 0

    def send(self, subtype, data):
        """TC[20,subtype]; the data of TM[20,2] where one came, once it is completed."""
        self.count += 1
        body = struct.pack(">BBBH", 0x2F, 20, subtype, 0x4712) + data
        packet = struct.pack(">HHH", 0x1800 | flight.MANIPULATOR, 0xC000 | self.count, len(body) + 1) + body
        self._socket.sendall(packet + struct.pack(">H", binascii.crc_hqx(packet, 0xFFFF)))
        end = time.monotonic() + 10.0
        while time.monotonic() < end:
            with self._mutex:
                reports = list(self.reports)
            ends = [r.subtype for r in reports if r.service == 1 and r.subtype in (2, 4, 7, 8, 10) and r.data[:4] == packet[:4]]
            if ends:
                assert ends == [7], f"TC[20,{subtype}]: TM[1,{ends}]"
                values = [r.data for r in reports if (r.apid, r.service, r.subtype) == (flight.MANIPULATOR, 20, 2)]
                return values[-1] if values else None
            time.sleep(0.01)
        raise AssertionError(f"no end of TC[20,{subtype}]")

    def set_scale(self, value):
        self.send(3, struct.pack(">BId", 1, POS_SCALE, value))

    def scale(self):
        self.forget()
        return struct.unpack(">BId", self.send(1, struct.pack(">BI", 1, POS_SCALE)))[2]


class Observer(unittest.TestCase):
    def setUp(self):
        self.rests = {}             # {turn: what both held in Offline}
        self.second = {}            # {(state, name): what it held in the second turn}

    def do(self, craft, subsystem, function, *arguments):
        code, reports = craft.tc(subsystem, function, *arguments)
        self.assertEqual(code, 0, f"{subsystem} {function} {arguments}: {reports}")

    def both(self, craft, function, *arguments):
        for name in ("joystick", "manipulator"):
            self.do(craft, name, function, *arguments)

    def looks(self, craft):
        return {name: Holding(craft.pid_of(f"hirosco-{name}")) for name in ("joystick", "manipulator")}

    def assert_rests(self, looks, what):
        """No device, no link."""
        for name, holding in looks.items():
            self.assertEqual(holding.devices(), [], f"{what}: {name}")
            self.assertEqual(holding.links(), 0, f"{what}: {name}")

    def housekeeping_of(self, telemetry, apid, seconds):
        """How many reports of this subsystem came in this time, each kind."""
        telemetry.forget()
        time.sleep(seconds)
        found = collections.Counter()
        for report in list(telemetry.reports):
            if report.apid == apid and (report.service, report.subtype) == (3, 25):
                found[report.data[:2].hex()] += 1
        return found

    def test_each_state_holds_what_the_paper_promises_and_each_way_down_gives_back_what_the_way_up_took(self):
        with flight.MissionCopy(LISTENING) as mission, flight.Flight(mission, more=("--no-ground", "--mode", "listening")) as craft:
            craft.wait_told("commissioned: mode listening", 20.0)
            before = {"Offline": self.looks(craft)}
            self.assert_rests(before["Offline"], "never up")
            craft.bring_up(lambda *words: self.do(craft, *words))
            with Operator() as telemetry:
                self.go_up_and_down(craft, telemetry, before)

    def go_up_and_down(self, craft, telemetry, before):
        self.both(craft, "SET_STATE", SAFE_OPERATIONAL)
        telemetry.set_scale(0.5)
        self.assertEqual(telemetry.scale(), 0.5)
        self.both(craft, "SET_STATE", OPERATIONAL)
        self.do(craft, "supervisor", "SET_MODE", 1)
        for turn in range(ROUNDS):
            # Operational, with links and devices.
            looks = self.looks(craft)
            for name, holding in looks.items():
                self.assertEqual(len(holding.devices()), 1, f"{name} has its device")
                self.assertEqual(holding.links(), 2, f"{name} has its links")
            self.go(craft, before, "Operational", turn)
            self.both(craft, "SET_STATE", SAFE_OPERATIONAL)
            self.go(craft, before, "Safe-Operational", turn)
            if turn == 0:
                self.look_at_safe_operational(craft, telemetry)
            self.both(craft, "SET_STATE", POST_OPERATIONAL)
            self.assert_rests(self.go(craft, before, "Post-Operational", turn), "Post-Operational")
            self.both(craft, "SET_STATE", PRE_OPERATIONAL)
            self.assert_rests(self.go(craft, before, "Pre-Operational, no configuration", turn), "Pre-Operational")
            self.both(craft, "SET_STATE", OFFLINE)
            self.assert_rests(self.go(craft, before, "Offline", turn), "Offline")
            if turn == 0:
                self.look_at_offline(craft, telemetry)
            self.both(craft, "SET_STATE", PRE_OPERATIONAL)
            self.assert_rests(self.go(craft, before, "Pre-Operational, no configuration", turn), "Pre-Operational")
            if turn == 0:
                self.look_at_initial_values(telemetry)
            self.both(craft, "CONFIGURE", 2)
            for name, holding in self.go(craft, before, "Pre-Operational, configured", turn).items():
                self.assertEqual((len(holding.devices()), holding.links()), (1, 0), name)
            for link in (1, 2):
                self.do(craft, "supervisor", "LINK", link)
            self.go(craft, before, "Pre-Operational, linked", turn)
            if turn == 0:
                self.look_at_pre_operational(telemetry)
            self.both(craft, "SET_STATE", SAFE_OPERATIONAL)
            self.both(craft, "SET_STATE", OPERATIONAL)
        for state, looks in before.items():
            flight.measure(f"{state}: " + ", ".join(f"{name} {look.memory_kb} kB" for name, look in looks.items()))
        for behind, turn in (("the first", 0), ("the last", ROUNDS - 1)):
            for name, holding in self.rests[turn].items():
                flight.measure(f"{name} in Offline behind {behind} way up and down, against before it was up: {compared(before['Offline'][name], holding)}")

    def go(self, craft, before, state, turn):
        """What both hold in this state, in each turn what they held when they were in it first: in Offline, before they were ever up."""
        looks = self.looks(craft)
        for name, holding in looks.items():
            assert_gives_back(self, before.setdefault(state, looks)[name], holding, f"{name} in {state}, turn {turn + 1}")
            if turn >= 1:
                second = self.second.setdefault((state, name), holding)
                self.assertLess(holding.memory_kb, second.memory_kb + SAME_KB, f"{name} in {state}, turn {turn + 1}")
        if state == "Offline":
            self.rests[turn] = looks
        return looks

    def look_at_offline(self, craft, telemetry):
        for apid in (flight.MANIPULATOR, flight.JOYSTICK):
            self.assertEqual(self.housekeeping_of(telemetry, apid, 1.0), {}, "no housekeeping in Offline")
        self.assertEqual(craft.truth("robot")["motor_1"], 0.0)

    def look_at_initial_values(self, telemetry):
        """What was set before the way down is gone: Software-Init has the descriptor's values."""
        self.assertEqual(telemetry.scale(), DESCRIPTOR_VALUE)

    def look_at_pre_operational(self, telemetry):
        """Housekeeping comes, and the links deliver: the joystick's own housekeeping has the robot's set, and how old it is."""
        for apid in (flight.MANIPULATOR, flight.JOYSTICK):
            self.assertTrue(self.housekeeping_of(telemetry, apid, 1.5), "housekeeping from Pre-Operational on")
        telemetry.forget()
        self.assertLess(telemetry.wait_housekeeping(4721, 2)[-1][1]["peer_age"], 200)

    def look_at_safe_operational(self, craft, telemetry):
        """The cycle goes on, and no motor gives anything once the robot's controlled stop is over."""
        craft.wait_at_rest("robot", time.monotonic())
        self.assertTrue(self.housekeeping_of(telemetry, flight.MANIPULATOR, 1.5), "its cycle samples")
        truth = craft.truth("robot")
        self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))

    def test_error_operational_keeps_what_it_has_and_moves_nothing_and_is_left_downwards(self):
        """Where a plan leaves it there: the demonstrator's own goes on to Offline at once."""
        with flight.MissionCopy({'set_state" state="SafeOperational': 'set_state" state="ErrorOperational'}) as mission, flight.Flight(mission) as craft:
            craft.wait_commissioned()
            with Operator() as telemetry:
                before = self.looks(craft)
                self.do(craft, "manipulator", "SET_TORQUE_LIMIT", 3)
                begin = craft.count()
                craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
                told = craft.wait_told("MANIPULATOR info STATE_CHANGED STATE=ErrorOperational", 5.0, begin)
                craft.wait_at_rest("robot", told.received)
                holding = self.looks(craft)["manipulator"]
                self.assertEqual((holding.devices(), holding.links()), (before["manipulator"].devices(), 2), "device and links are kept")
                self.assertTrue(self.housekeeping_of(telemetry, flight.MANIPULATOR, 1.5), "its cycle samples")
                truth = craft.truth("robot")
                self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))
                self.do(craft, "supervisor", "SET_MODE", 1)
                self.do(craft, "manipulator", "SET_STATE", POST_OPERATIONAL)
                self.assert_rests({"manipulator": self.looks(craft)["manipulator"]}, "Post-Operational")
                self.do(craft, "manipulator", "SET_STATE", OFFLINE)
                self.assert_rests({"manipulator": self.looks(craft)["manipulator"]}, "Offline")

    def test_a_device_has_power_only_between_hardware_init_and_hardware_deinit(self):
        with flight.Flight(IMAGER) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.do(craft, "supervisor", "SET_MODE", 1)
            rests = None
            for _ in range(ROUNDS):
                self.assertEqual(craft.truth("imager")["powered"], 1.0)
                for state in (SAFE_OPERATIONAL, POST_OPERATIONAL, PRE_OPERATIONAL):
                    self.do(craft, "imager", "SET_STATE", state)
                    self.assertEqual(craft.truth("imager")["powered"], 1.0)
                self.do(craft, "imager", "SET_STATE", OFFLINE)
                self.assertEqual(craft.truth("imager")["powered"], 0.0)
                holding = Holding(craft.pid_of("hirosco-pointing-imager"))
                self.assertEqual(holding.devices(), [])
                rests = rests or holding
                self.assertEqual(holding, rests)
                self.do(craft, "imager", "SET_STATE", PRE_OPERATIONAL)
                self.assertEqual(craft.truth("imager")["powered"], 1.0)
                self.do(craft, "imager", "CONFIGURE", 1)
                self.do(craft, "imager", "SET_STATE", SAFE_OPERATIONAL)
                self.do(craft, "imager", "SET_STATE", OPERATIONAL)


if __name__ == "__main__":
    flight.main()
