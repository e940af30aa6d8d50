#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the framework's services take and tell, against the test vectors of the packet library and against a peer."""
import dataclasses
import struct
import threading
import unittest

from runtime_test import Arm, Peer, vectors
from python import runtime, shapes
from python.runtime import (ArgumentError, Craft, EventKind, Field, MissionAbout, Parameter, Part, ReportKind,
                            ServiceRequest, SubsystemAbout, Telemetry)

STRUCTURE = Field("STRUCTURE", "UINT16")
INTERVAL = Field("INTERVAL", "UINT32")
PARAMETERS = Part("PARAMETERS", "LIST", (Part("PARAMETER", "PARAMETER"),))
SETS = Part("SETS", "LIST", (Field("REPETITIONS", "UINT16"), PARAMETERS))
VALUES = Part("PARAMETERS", "LIST", (Part("PARAMETER", "PARAMETER"), Part("VALUE", "VALUE")))
EVENTS = Part("EVENTS", "LIST", (Part("EVENT", "EVENT"),))
# The parameters of the vectors, of which 0x00010010 has no name here.
SAMPLES, LEVEL = Parameter("SAMPLES", 0x00010001, (Field("SAMPLES", "UINT16"),)), Parameter("LEVEL", 0x00010002, (Field("LEVEL", "FLOAT"),))
ABOUT = SubsystemAbout("ARM", 10, parameters=(SAMPLES, LEVEL), events=(EventKind(17, "BUMP"),),
                       reports=(ReportKind(3, 10, "STRUCTURE", (STRUCTURE, Field("PERIODIC", "UINT8"), INTERVAL, PARAMETERS, SETS)),
                                ReportKind(3, 35, "PROPERTIES", (Part("STRUCTURES", "LIST", (STRUCTURE, Field("PERIODIC", "UINT8"), INTERVAL)),)),
                                ReportKind(5, 8, "DISABLED", (EVENTS,)), ReportKind(20, 2, "VALUES", (VALUES,)),
                                ReportKind(129, 12, "RETRIEVED", (Field("NUMBER", "UINT64"), Part("REPORT", "REST")))))


def vector(name):
    found, = (one for group in ("st03", "st05", "st20") for one in vectors(group) if one["id"] == name)
    return found


class Requests(unittest.TestCase):
    def assert_is(self, name, subtype, parts, *values):
        fields = vector(name)["fields"]
        self.assertEqual(fields["subtype"], subtype)
        request = ServiceRequest("asked", fields["service"], subtype, parts)
        self.assertEqual(request.encode(values, ABOUT).hex(), fields["app_data"])

    def test_are_those_of_the_vectors(self):
        lists = Part("STRUCTURES", "LIST", (STRUCTURE,))
        self.assert_is("ST03-A", 1, (STRUCTURE, INTERVAL, PARAMETERS, SETS), 300, 10, ["SAMPLES", "level"],
                       [{"REPETITIONS": 3, "PARAMETERS": [0x00010010]}])
        self.assert_is("ST03-B", 5, (lists,), [300, 2])
        self.assert_is("ST03-C", 31, (Part("STRUCTURES", "LIST", (STRUCTURE, INTERVAL)),), [{"STRUCTURE": 300, "INTERVAL": 50}])
        self.assert_is("ST05-A", 6, (EVENTS,), ("BUMP", 18))
        self.assert_is("ST20-A", 1, (PARAMETERS,), ["SAMPLES", 0x00010002])
        self.assert_is("ST20-C", 3, (VALUES,), [{"PARAMETER": "LEVEL", "VALUE": 2.0}])

    def test_time_words_and_octets_are_sent_as_they_are_read(self):
        parts = (Part("FROM", "TIME"), Part("WHY", "WORD"), Field("KIND", "UINT8", texts=((0, "no"), (1, "yes"))), Part("DATA", "REST"))
        data = ServiceRequest("asked", 129, 11, parts).encode((2_000_000_000.5, "drift", "yes", b"\1\2"), ABOUT)
        self.assertEqual(data, struct.pack(">I3s", 2_000_000_000, b"\x80\0\0") + b"\5drift\1\1\2")
        self.assertEqual(shapes.take(parts, data, 0, ABOUT),
                         ({"FROM": 2_000_000_000.5, "WHY": "drift", "KIND": "yes", "DATA": b"\1\2"}, len(data)))

    def refused(self, parts, value, words):
        with self.assertRaisesRegex(ArgumentError, f"^TC: {words}"):
            ServiceRequest("TC", 3, 5, (parts,)).encode((value,), ABOUT)

    def test_what_does_not_fit_is_refused_in_words(self):
        self.refused(PARAMETERS, ["KP"], "PARAMETER: 'KP' is none of SAMPLES, LEVEL")
        self.refused(PARAMETERS, [1 << 32], "PARAMETER: a name or a number of 4 octets is wanted")
        self.refused(EVENTS, [1.5], "EVENT: a name or a number of 2 octets")
        self.refused(EVENTS, [-1], "EVENT: a name or a number of 2 octets")
        self.refused(PARAMETERS, "LEVEL", "PARAMETERS: a list of at most 255 is wanted, not 'LEVEL'")
        self.refused(PARAMETERS, [1] * 256, "PARAMETERS: a list of at most 255")
        self.refused(SETS, [3], "SETS: dictionaries with REPETITIONS, PARAMETERS are wanted, not 3")
        self.refused(SETS, [{"REPETITIONS": 3}], "SETS: dictionaries with")
        self.refused(SETS, [{"REPETITIONS": 65536, "PARAMETERS": []}], "REPETITIONS: 65536 does not fit into UINT16")
        self.refused(VALUES, [{"PARAMETER": "SAMPLES", "VALUE": 1.5}], "SAMPLES: a whole number is wanted")
        self.refused(VALUES, [{"PARAMETER": 7, "VALUE": 1.5}], "VALUE: octets are wanted")
        self.refused(Part("WHY", "WORD"), "a" * 256, "WHY: a text of at most 255 octets")
        for time in (-1, 1 << 33, float("nan"), float("inf"), "now"):
            self.refused(Part("FROM", "TIME"), time, "FROM: seconds TAI since 1958 are wanted")


class Reports(unittest.TestCase):
    def read(self, name, cut=0, more=b""):
        packet = Telemetry.parse(bytes.fromhex(vector(name)["hex"]))
        return shapes.report_of(ABOUT, dataclasses.replace(packet, data=packet.data[:len(packet.data) - cut] + more))

    def test_are_read_as_in_the_vectors(self):
        self.assertEqual(self.read("ST03-P1").values,
                         {"STRUCTURES": ({"STRUCTURE": 1, "PERIODIC": 1, "INTERVAL": 10}, {"STRUCTURE": 300, "PERIODIC": 0, "INTERVAL": 1000})})
        self.assertEqual(self.read("ST03-D").values,
                         {"STRUCTURE": 300, "PERIODIC": 1, "INTERVAL": 10, "PARAMETERS": ("SAMPLES", "LEVEL"),
                          "SETS": ({"REPETITIONS": 3, "PARAMETERS": (0x00010010,)},)})
        self.assertEqual(self.read("ST05-B").values, {"EVENTS": ("BUMP", 18)})
        self.assertEqual(self.read("ST20-B")["PARAMETERS"], ({"PARAMETER": "SAMPLES", "VALUE": 1000}, {"PARAMETER": "LEVEL", "VALUE": 1.5}))

    def test_cut_anywhere_or_too_long_are_none(self):
        for name in ("ST03-P1", "ST03-D", "ST05-B", "ST20-B"):
            whole = len(vector(name)["fields"]["source_data"]) // 2
            for cut in range(1, whole + 1):
                self.assertIsNone(self.read(name, cut), (name, cut))
            self.assertIsNone(self.read(name, more=b"\0"), name)

    def test_that_nobody_knows_are_handed_over_as_they_came(self):
        packet = Telemetry(10, 0, 21, 7, 0, 5.0, b"\1\2")
        report = shapes.report_of(ABOUT, packet)
        self.assertEqual((report.name, report.values, report.service, report.subtype, report.data), ("TM[21,7]", {}, 21, 7, b"\1\2"))
        unknown = shapes.report_of(ABOUT, dataclasses.replace(packet, service=20, subtype=2, data=b"\1\0\0\0\7\1"))
        self.assertEqual((unknown.name, unknown.data), ("TM[20,2]", b"\1\0\0\0\7\1"))


class Shaped(Arm):
    _about = dataclasses.replace(
        Arm._about, reports=(*Arm._about.reports, ReportKind(5, 8, "DISABLED", (EVENTS,)), ReportKind(20, 2, "VALUES", (VALUES,))),
        requests=(ServiceRequest("TC[5,7] REPORT_DISABLED", 5, 7), ServiceRequest("TC[20,1] REPORT_VALUES", 20, 1, (PARAMETERS,))))


class Asked(unittest.TestCase):
    """What comes of it."""

    def setUp(self):
        self.peer = Peer()
        self.craft = type("Small", (Craft,), {"_about": MissionAbout("SMALL", "127.0.0.1", self.peer.port, "ARM", (), (), ())})()
        self.craft.arm = Shaped(self.craft)
        self.craft._subsystems = (self.craft.arm,)
        self.craft._start()
        self.peer.accept()
        self.addCleanup(self.peer.socket.close)
        self.addCleanup(self.craft.close)

    def asked(self, ask, *reports):
        """What `ask` returns where each TM[service,subtype] comes before its completion."""
        seen = []

        def run():
            request = self.peer.telecommand()
            seen.append((request[7], request[8], request[11:-2]))
            for service, subtype, data in reports:
                self.peer.tell(service, subtype, data, self.craft.source)
            self.peer.verify(request, 7)
        thread = threading.Thread(target=run)
        thread.start()
        self.addCleanup(thread.join)
        return ask(), seen

    def test_a_request_has_the_reports_that_answer_it(self):
        request, seen = self.asked(lambda: self.craft.arm._ask("TC[5,7] REPORT_DISABLED", (), 5.0), (5, 8, b"\1\0\x11"))
        self.assertEqual(seen, [(5, 7, b"")])
        self.assertEqual([(one.name, one.values) for one in request.reports], [("DISABLED", {"EVENTS": ("BUMP",)})])
        self.assertFalse(self.craft.events, "it is no event")

    def test_values_that_were_asked_for_together_come_together(self):
        kp = struct.pack(">Id", 0x0A0A03, 300.0)
        request, seen = self.asked(lambda: self.craft.arm._ask("TC[20,1] REPORT_VALUES", (["KP"],), 5.0), (20, 2, b"\1" + kp))
        self.assertEqual(seen, [(20, 1, b"\1" + kp[:4])])
        self.assertEqual(request.reports[0]["PARAMETERS"], ({"PARAMETER": "KP", "VALUE": 300.0},))

    def test_a_value_still_goes_to_who_wants_it_alone(self):
        value, _ = self.asked(lambda: self.craft.arm._get("KP", 5.0), (20, 2, b"\1" + struct.pack(">Id", 0x0A0A03, 300.0)))
        self.assertEqual(value, 300.0)

    def test_each_report_goes_to_who_asked_for_it(self):
        values = self.craft.arm._ask("TC[20,1] REPORT_VALUES", (["KP"],), None)
        moving = self.craft.arm.move(3, wait=None)
        disabled = self.craft.arm._ask("TC[5,7] REPORT_DISABLED", (), None)
        for _ in range(3):
            self.peer.telecommand()
        value, _ = self.asked(lambda: self.craft.arm._get("KP", 5.0), (20, 2, b"\1" + struct.pack(">Id", 0x0A0A03, 300.0)),
                              (5, 8, b"\0"), (200, 2, b"\0\0" + bytes(10)))
        self.assertEqual((value, values.reports, moving.reports), (300.0, [], []), "nor does what an own service says go to others")
        self.assertEqual([one.name for one in disabled.reports], ["DISABLED"])

    def test_what_another_service_says_meanwhile_is_not_dropped(self):
        request, _ = self.asked(lambda: self.craft.arm.move(3), (129, 10, b"why"))
        self.assertEqual([(one.name, one.data) for one in request.reports], [("TM[129,10]", b"why")])


if __name__ == "__main__":
    unittest.main()
