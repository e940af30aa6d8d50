#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The runtime of exported clients against the test vectors of the packet library, and against a peer that answers by a
script; against a spacecraft it flies in tests/ground/python_client_test.py."""
import fcntl
import json
import math
import pathlib
import re
import socket
import struct
import sys
import tempfile
import threading
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))            # the files of an exported package know each other by their package

from python import links, runtime  # noqa: E402
from python.runtime import (ArgumentError, CommandFailed, Craft, EventKind, Field, Function, Layout, LinkLost, MissionAbout,
                            NoAnswer, Parameter, Part, ReportKind, Subsystem, SubsystemAbout, Telemetry)

VECTORS = json.loads((HERE.parents[2] / "hirosco/pus/testing/test_vectors.json").read_text())


def vectors(group):
    return [vector for vector in VECTORS if vector["group"] == group]


class Packets(unittest.TestCase):
    def test_error_control_is_that_of_the_vectors(self):
        for vector in vectors("crc16"):
            octets = bytes.fromhex(vector["fields"]["input"])
            self.assertEqual(runtime.crc16(octets), int(vector["hex"], 16), vector["id"])

    def test_telecommands_are_those_of_the_vectors(self):
        checked = 0
        for vector in [v for v in VECTORS if v["group"] in ("tc", "st03", "st05", "st08", "st17", "st20")]:
            fields = vector["fields"]
            if "ack" not in fields or "app_data" not in fields:
                continue
            packet = runtime.telecommand(fields["apid"], fields["seq"], fields["service"], fields["subtype"],
                                         fields["source"], bytes.fromhex(fields["app_data"]),
                                         int(fields["ack"].split()[0], 16))
            self.assertEqual(packet.hex(), vector["hex"], vector["id"])
            checked += 1
        self.assertGreaterEqual(checked, 12)

    def test_telemetry_is_read_as_in_the_vectors(self):
        for vector in [*vectors("tm"), *vectors("st01")]:
            fields, octets = vector["fields"], bytes.fromhex(vector["hex"])
            packet = Telemetry.parse(octets)
            self.assertIsNotNone(packet, vector["id"])
            self.assertEqual((packet.apid, packet.count, packet.destination), (fields["apid"], fields["seq"],
                                                                             fields["destination"]), vector["id"])
            self.assertEqual(packet.time_s, runtime.cuc_seconds(bytes.fromhex(fields["time"])))
            if "source_data" in fields:
                self.assertEqual(packet.data.hex(), fields["source_data"], vector["id"])

    def test_a_changed_octet_anywhere_is_seen(self):
        octets = bytes.fromhex(vectors("tm")[0]["hex"])
        for place in range(len(octets)):
            damaged = bytearray(octets)
            damaged[place] ^= 0x10
            self.assertIsNone(Telemetry.parse(bytes(damaged)), place)

    def test_a_stream_is_cut_whatever_the_pieces_are(self):
        whole = b"".join(bytes.fromhex(v["hex"]) for v in vectors("tm"))
        for size in (1, 5, 7, 64, len(whole)):
            stream, found = bytearray(), []
            for start in range(0, len(whole), size):
                stream += whole[start:start + size]
                found += runtime.cut(stream)
            self.assertEqual((b"".join(found), len(stream)), (whole, 0))

    def test_what_is_no_telemetry_ends_the_link(self):
        for octets in (b"HTTP/1.1 400 Bad Request\r\n", b"\x18" * 8, b"\x08\x0a\xc0\x00\xff\xff"):
            with self.assertRaises(LinkLost):
                runtime.cut(bytearray(octets))


class Fields(unittest.TestCase):
    ANGLE = Field("Q1", "DOUBLE", unit="rad", minimum=-2.0, maximum=1.0)
    STATE = Field("STATE", "UINT8", texts=((0, "Offline"), (5, "Operational")))

    def refused(self, field, value, words):
        with self.assertRaisesRegex(ArgumentError, re.escape(words)):
            field.encode(value)

    def test_a_value_outside_its_range_is_refused_in_words(self):
        self.refused(self.ANGLE, 5, "Q1: 5 rad is above its maximum 1 rad")
        self.refused(self.ANGLE, -2.5, "Q1: -2.5 rad is below its minimum -2 rad")
        self.assertEqual(self.ANGLE.encode(1), struct.pack(">d", 1.0))

    def test_names_of_values_are_known_in_any_case(self):
        self.assertEqual(self.STATE.encode("operational"), b"\x05")
        self.refused(self.STATE, "flying", "'flying' is none of Offline, Operational")
        self.refused(self.ANGLE, "far", "a number is wanted")

    def test_what_the_type_cannot_hold_is_refused(self):
        self.refused(Field("N", "UINT8"), 256, "does not fit into UINT8")
        self.refused(Field("N", "UINT8"), -1, "does not fit into UINT8")
        self.refused(Field("N", "UINT8"), 1.5, "a whole number is wanted")
        self.refused(Field("N", "FLOAT"), 1e39, "does not fit into FLOAT")
        self.refused(Field("N", "UINT64"), 2**64, "does not fit into UINT64")
        self.refused(Field("N", "INT64"), -2**63 - 1, "does not fit into INT64")
        self.refused(Field("N", "BOOL"), 2, "does not fit into BOOL")
        self.refused(Field("N", "UINT64", maximum=2**63), 2**63 + 1, "9223372036854775809 is above its maximum 9223372036854775808")
        for value in (math.nan, math.inf, None, [1], object()):
            self.refused(Field("N", "DOUBLE"), value, "a finite number is wanted")

    def test_integers_of_64_bits_and_both_words_of_a_bool_are_sent_exactly(self):
        self.assertEqual(Field("N", "UINT64").encode(2**64 - 1), b"\xff" * 8)
        self.assertEqual(Field("N", "INT64").encode(-2**63), b"\x80" + b"\0" * 7)
        self.assertEqual(Field("N", "UINT64").encode(2**53 + 1), bytes.fromhex("0020000000000001"))
        on = Field("ON", "BOOL", count=3, texts=((0, "off"), (1, "on")))
        self.assertEqual(on.encode((True, 0, "on")), b"\1\0\1")

    def test_a_text_is_sent_with_its_length(self):
        note = Field("NOTE", "TEXT", most=4)
        self.assertEqual(note.encode("€"), b"\0\3\xe2\x82\xac")
        self.assertEqual(note.encode(""), b"\0\0")
        self.assertEqual(note.encode("abcd"), b"\0\4abcd")
        for value in ("abcde", "€€", "a\0", 5, None, b"ab"):
            self.refused(note, value, "a text of at most 4 octets is wanted")

    def test_a_text_of_a_parameter_fills_its_octets(self):
        title = Field("TITLE", "TEXT", most=6, fixed=True)
        self.assertEqual(title.octets, 6)
        self.assertEqual(title.encode("café"), b"caf\xc3\xa9\0")
        self.assertEqual(title.encode(""), b"\0" * 6)
        for words in ("café", "", "six666"):
            self.assertEqual(title.decode(b"\1" + title.encode(words) + b"\1", 1), words)
        self.assertEqual(title.decode(b"a\0b\0\0\0", 0), "a")
        self.refused(title, "seven77", "a text of at most 6 octets is wanted")

    def test_a_switch_is_true_or_false(self):
        self.assertIs(Field("ON", "BOOL").decode(b"\0\1", 1), True)
        self.assertEqual(Field("ON", "BOOL", count=2).decode(b"\0\1", 0), (False, True))

    def test_an_array_takes_as_many_values_as_it_has(self):
        pair = Field("P", "INT16", count=2)
        self.assertEqual(pair.encode((1, -1)), b"\x00\x01\xff\xff")
        for value in (1, (1,), (1, 2, 3), "ab"):
            self.refused(pair, value, "2 values are wanted")

    def test_a_function_call_is_that_of_the_vectors(self):
        vector = vectors("st08")[0]["fields"]
        function = Function("GRIPPER_OPEN", arguments=(Field("WIDTH", "FLOAT"), Field("SPEED", "UINT8", default=3)))
        self.assertEqual(function.encode((0.25, None)).hex(), vector["app_data"])
        with self.assertRaisesRegex(ArgumentError, "WIDTH is missing"):
            function.encode((None, 3))


class Arm(Subsystem):
    _about = SubsystemAbout("ARM", 10, functions=(Function("MOVE", arguments=(Field("Q", "UINT8"),)),
                                                  Function("REPORT_SELF_TEST", 17, 130),
                                                  Function("LABEL", 200, 1, (Field("OWNER", "TEXT", most=8), Field("LENT", "BOOL")))),
                            reports=(ReportKind(200, 2, "LABELLED", (Field("OWNER", "TEXT", most=8), Field("SERIAL", "UINT64"),
                                                                     Field("LENT", "BOOL", count=2))),
                                     ReportKind(17, 129, "SELF_TEST_OUTCOME",
                                                (Field("OUTCOME", "UINT8", texts=((0, "never run"), (1, "passed"), (2, "failed"))),
                                                 Field("CONFIGURATION", "UINT8"), Part("TIME", "TIME"), Field("CODE", "UINT16"),
                                                 Field("NUMBER", "INT64"), Part("REASON", "WORD")))),
                            parameters=(Parameter("KP", 0x0A0A03, (Field("KP", "DOUBLE"),)),
                                        Parameter("LAMP", 0x0A2004, (Field("ON", "BOOL"), Field("TITLE", "TEXT", most=6, fixed=True)), structure=True),
                                        Parameter("TITLE", 0x0A2205, (Field("TITLE", "TEXT", most=6, fixed=True),))),
                            layouts=(Layout(7, 4, (Field("A", "UINT8", offset=2), Field("B", "INT8", offset=3))),
                                     Layout(9, 8, (Field("SUBSYSTEMS.APID", "UINT16", count=2, offset=2),
                                                   Field("SUBSYSTEMS.STATE", "UINT8", count=2, offset=6)))),
                            events=(EventKind(17, "BUMP", (Field("JOINT", "UINT8"), Field("FORCE", "FLOAT"))),
                                    EventKind(19, "STATE_CHANGED", (Field("STATE", "UINT8"),))))

    def move(self, q, *, wait=2.0):
        return self._call("MOVE", (q,), wait)


class Peer:
    """The other end of one connection: reads telecommands, sends telemetry."""

    def __init__(self):
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._listener.settimeout(5.0)
        self.port = self._listener.getsockname()[1]
        self._count = 0

    def accept(self, last=True):
        self.socket = self._listener.accept()[0]
        self.socket.settimeout(5.0)
        if last:
            self._listener.close()

    def telecommand(self):
        data = self.socket.recv(6, socket.MSG_WAITALL)
        return data + self.socket.recv(1 + int.from_bytes(data[4:6], "big"), socket.MSG_WAITALL)

    def tell(self, service, subtype, data, destination=0, time_s=0):
        self._count += 1
        packet = struct.pack(">HHHBBBHH", 0x080A, 0xC000 | self._count, len(data) + 15, 0x20, service, subtype, 0,
                             destination)
        packet += struct.pack(">I3x", time_s) + data
        self.socket.sendall(packet + struct.pack(">H", runtime.crc16(packet)))

    def verify(self, request, subtype, data=b""):
        self.tell(1, subtype, request[:4] + data, int.from_bytes(request[9:11], "big"))


class Registry(unittest.TestCase):
    """The flights of this computer, as `hirosco run` enters them (docs/adr/0037)."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hirosco-flights-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fly(self, instance, mission="SMALL", telemetry="127.0.0.1:31115"):
        path = self.folder / instance
        path.write_text(f"instance={instance}\nmission={mission}\ntelemetry={telemetry}\nlog=/l/a=b.db\n")
        lock = path.open("r+")
        self.addCleanup(lock.close)
        fcntl.fcntl(lock, fcntl.F_OFD_SETLK, struct.pack("hhqqi4x", fcntl.F_WRLCK, 0, 0, 0, 0))
        return lock

    def test_who_has_its_entry_locked_flies(self):
        self.assertEqual(runtime.flights(str(self.folder / "none")), [])
        lock = self.fly("one")
        (self.folder / "over").write_text("instance=over\nmission=SMALL\ntelemetry=127.0.0.1:1\n")
        (self.folder / "binary").write_bytes(b"\xff\0")
        for _ in range(2):
            self.assertEqual([flight["instance"] for flight in runtime.flights(str(self.folder))], ["one"])
        self.assertEqual(runtime.flights(str(self.folder))[0]["log"], "/l/a=b.db")
        lock.close()
        self.assertEqual(runtime.flights(str(self.folder)), [])

    def test_the_only_flight_of_the_mission_is_meant_else_a_name_is_asked_for(self):
        find = lambda **which: runtime.find_flight("SMALL", folder=str(self.folder), **which)
        self.assertIsNone(find())
        self.fly("hello", mission="OTHER")
        self.assertIsNone(find())
        self.fly("one")
        self.assertEqual(find()["instance"], "one")
        self.fly("two", telemetry="127.0.0.1:31215")
        with self.assertRaisesRegex(LinkLost, "2 flights of SMALL are in the air: say instance"):
            find()
        self.assertEqual(find(instance="two")["telemetry"], "127.0.0.1:31215")
        for unknown in ("three", "hello"):
            with self.assertRaisesRegex(LinkLost, f"no instance '{unknown}' of SMALL flies; on this computer: hello"):
                find(instance=unknown)

    def test_a_client_connects_to_the_flight_that_is_meant(self):
        peer = Peer()
        flight = {"instance": "two", "telemetry": f"127.0.0.1:{peer.port}"}
        about = MissionAbout("SMALL", "127.0.0.1", 1, "ARM", (), (), ())
        small = type("Small", (Craft,), {"_about": about})
        with unittest.mock.patch.object(links, "find_flight", lambda mission, instance: flight):
            craft = small(instance="two")
        self.addCleanup(craft._socket.close)
        peer.accept()                           # the other port is closed, so it was this one
        self.addCleanup(peer.socket.close)


class Client(unittest.TestCase):
    def setUp(self):
        self.peer = Peer()

        class Small(Craft):
            _about = MissionAbout("SMALL", "127.0.0.1", self.peer.port, "ARM", ((4, "safe"),), (),
                                  ((10, "not permitted in this state"), (13, "not permitted in this mode")))

        self.craft = self.started(Small())
        self.peer.accept()
        self.addCleanup(self.peer.socket.close)

    def started(self, craft):
        craft.arm = Arm(craft)
        craft._subsystems = (craft.arm,)
        craft._start()
        self.addCleanup(craft.close)
        return craft

    def answer(self, *reports):
        """Answers the next telecommand by reports [(subtype, data)]."""
        def run():
            request = self.peer.telecommand()
            for subtype, data in reports:
                self.peer.verify(request, subtype, data)
        thread = threading.Thread(target=run)
        thread.start()
        self.addCleanup(thread.join)

    def test_a_request_returns_with_its_whole_chain(self):
        self.answer((1, b""), (3, b""), (5, b"\x00\x01"), (7, b""))
        request = self.craft.arm.move(3)
        self.assertEqual([v.stage for v in request.verifications], ["accepted", "started", "progress", "completed"])
        self.assertEqual(request.verifications[2].step, 1)

    def test_a_refusal_names_code_text_and_numbers(self):
        for data, words, parameters in ((b"\x00\x0a\x04", "not permitted in this state", {"state": "SafeOperational"}),
                                        (b"\x00\x0d\x04", "not permitted in this mode", {"mode": "safe"}),
                                        (b"\x80\x01\xab", "not documented", {"data": "ab"})):
            self.answer((2, data))
            with self.assertRaisesRegex(CommandFailed, words) as caught:
                self.craft.arm.move(3)
            self.assertEqual(caught.exception.parameters, parameters)

    def test_an_argument_is_named_by_its_name(self):
        self.answer((1, b""), (4, b"\x01\x05\x00" + b"\x00\x00\x00\x01"))
        with self.assertRaises(CommandFailed) as caught:
            self.craft.arm.move(3)
        self.assertEqual(caught.exception.parameters, {"index": 0, "identifier": "Q"})

    def test_a_failed_step_is_no_failed_request(self):
        self.answer((1, b""), (6, b"\x00\x01\x02\x05"), (7, b""))
        self.assertEqual(len(self.craft.arm.move(3).verifications), 3)

    def test_reports_of_others_are_not_ours(self):
        request = self.craft.arm.move(3, wait=None)
        packet = self.peer.telecommand()
        self.peer.tell(1, 7, packet[:4], self.craft.source ^ 1)
        self.peer.tell(1, 7, struct.pack(">I", int.from_bytes(packet[:4], "big") ^ 1), self.craft.source)
        self.peer.verify(packet, 1)
        self.craft.wait_until(lambda: request.verifications)
        self.assertFalse(request.done)
        with self.assertRaises(NoAnswer):
            request.result(0.01)

    def test_words_and_switches_of_an_own_service_are_asked_and_told(self):
        asked = []
        serial = struct.pack(">Q", 2**64 - 1)

        def run():
            request = self.peer.telecommand()
            asked.append(request[11:-2])
            for data in (b"\0\3\xe2\x82\xac" + serial + b"\1", b"\0\4\xe2\x82\xac" + serial + b"\1\0", b"\0",
                         b"\0\3\xe2\x82\xac" + serial + b"\1\0"):
                self.peer.tell(200, 2, data, self.craft.source)
            self.peer.verify(request, 7)
        thread = threading.Thread(target=run)
        thread.start()
        self.addCleanup(thread.join)
        request = self.craft.arm._call("LABEL", ("\u20ac", True), 2.0)
        self.assertEqual(asked, [b"\0\3\xe2\x82\xac\1"])
        self.assertEqual([report.values for report in request.reports],
                         [{"OWNER": "\u20ac", "SERIAL": 2**64 - 1, "LENT": (True, False)}], "what is cut off is none")
        self.assertEqual(request.reports[0]["OWNER"], "\u20ac")

    def test_a_report_of_a_standard_service_has_time_words_and_names_of_values(self):
        told = b"\2\1" + struct.pack(">I3s", 2_000_000_000, b"\x80\0\0") + struct.pack(">Hq", 0x0203, -7) + b"\5drift"

        def run():
            request = self.peer.telecommand()
            for data in (told[:-1], told + b"x", told):
                self.peer.tell(17, 129, data, self.craft.source)
            self.peer.verify(request, 7)
        thread = threading.Thread(target=run)
        thread.start()
        self.addCleanup(thread.join)
        request = self.craft.arm._call("REPORT_SELF_TEST", (), 2.0)
        self.assertEqual([report.values for report in request.reports],
                         [{"OUTCOME": "failed", "CONFIGURATION": 1, "TIME": 2_000_000_000.5, "CODE": 0x0203, "NUMBER": -7,
                           "REASON": "drift"}])

    def test_a_parameter_is_asked_for(self):
        def run():
            request = self.peer.telecommand()
            self.peer.verify(request, 7)
            self.peer.tell(20, 2, b"\x01" + struct.pack(">Id", 0x0A0A03, 300.0), self.craft.source)
        thread = threading.Thread(target=run)
        thread.start()
        self.assertEqual(self.craft.arm._get("KP", 2.0), 300.0)
        thread.join()
        self.assertEqual(self.craft._requests, {})

    def test_switches_and_words_of_a_parameter_come_and_go(self):
        asked = []

        def run():
            request = self.peer.telecommand()
            self.peer.verify(request, 7)
            self.peer.tell(20, 2, b"\x01" + struct.pack(">I", 0x0A2004) + b"\1caf\xc3\xa9\0", self.craft.source)
            request = self.peer.telecommand()
            asked.append(request[11:-2])
            self.peer.verify(request, 7)
        thread = threading.Thread(target=run)
        thread.start()
        self.assertEqual(self.craft.arm._get("LAMP", 2.0), {"ON": True, "TITLE": "café"})
        whole = self.craft.arm._about.parameters[1]
        self.assertEqual(whole.encode({"TITLE": "on", "ON": False}), b"\0on\0\0\0\0")
        for wrong in ({"ON": True}, {"ON": True, "TITLE": "", "LEVEL": 1}, True):
            with self.assertRaisesRegex(runtime.ArgumentError, "ON, TITLE"):
                whole.encode(wrong)
        self.craft.arm._set("TITLE", "dusk", 2.0)
        thread.join()
        self.assertEqual(asked, [b"\x01" + struct.pack(">I", 0x0A2205) + b"dusk\0\0"])

    def test_housekeeping_is_decoded_recorded_and_kept(self):
        with self.craft.arm.record(7) as reports:
            for octets in (b"\x00\x07\x01\xff", b"\x00\x07\x02\xfe", b"\x00\x07\x02", b"\x00\x08\x02\x02"):
                self.peer.tell(3, 25, octets)
            self.craft.wait_until(lambda: self.craft.received == 4)
        self.assertEqual([report.values for report in reports], [{"A": 1, "B": -1}, {"A": 2, "B": -2}])
        self.assertEqual(self.craft.arm.latest(7)["B"], -2)
        with self.assertRaisesRegex(ArgumentError, "has no report 8; it has 7, 9"):
            self.craft.arm.record(8).__enter__()

    def test_events_are_named_even_when_unknown_or_too_short(self):
        for octets in (b"\x00\x11\x02\x40\x00\x00\x00", b"\x00\x12\x01", b"\x00\x11\x02"):
            self.peer.tell(5, 3, octets)
        self.craft.wait_until(lambda: len(self.craft.events) == 3)
        self.assertEqual([(e.name, e.severity, e.values) for e in self.craft.events],
                         [("BUMP", "medium", {"JOINT": 2, "FORCE": 2.0}), ("18", "medium", {}),
                          ("BUMP", "medium", {"JOINT": 2})])

    def test_a_state_is_the_newest_that_was_told(self):
        self.assertIsNone(self.craft.arm.state)
        for time_s, state in ((10, 5), (12, 4), (11, 6)):
            self.peer.tell(5, 1, b"\x00\x13" + bytes([state]), time_s=time_s)
            overview = b"\x00\x09" + struct.pack(">HHBB", 1, 10, 9, 3)
            self.peer.tell(3, 25, overview, time_s=time_s - 1)
        self.craft.wait_until(lambda: self.craft.received == 6)
        self.assertEqual(self.craft.arm.state, "SafeOperational")
        self.peer.tell(3, 25, overview, time_s=13)
        self.craft.wait_until(lambda: self.craft.received == 7)
        self.assertEqual(self.craft.arm.state, "PreOperational")

    def test_damaged_packets_are_counted_and_the_next_is_read(self):
        self.peer.socket.sendall(bytes.fromhex("0800c000000f") + bytes(16))
        self.peer.tell(3, 25, b"\x00\x07\x01\xff")
        self.craft.wait_until(lambda: self.craft.received == 1)
        self.assertEqual(self.craft.damaged, 1)

    def test_whoever_waits_learns_that_the_link_is_lost(self):
        request = self.craft.arm.move(3, wait=None)
        self.peer.socket.close()
        with self.assertRaises(LinkLost):
            request.result(5.0)
        with self.assertRaises(LinkLost):
            self.craft.arm.move(3)
        self.assertFalse(self.craft.connected)

    def test_a_link_that_is_lost_is_made_again_where_that_is_wanted(self):
        peer, told = Peer(), []
        with unittest.mock.patch.object(runtime, "RECONNECT_S", 0.01):
            craft = self.started(type(self.craft)("127.0.0.1", peer.port, reconnect=True))
            craft.on_link(told.append)
            peer.accept(last=False)
            asked = craft.arm.move(3, wait=None)
            request = peer.telecommand()
            peer.tell(3, 25, b"\x00\x07\x01\xff")
            craft.wait_until(lambda: craft.received == 1)
            peer.socket.close()
            with self.assertRaises(LinkLost):
                asked.result(5.0)
            peer.accept()
            # An answer to what was asked before means nothing any more; reports, recordings and requests go on.
            with craft.arm.record(7) as reports:
                peer.verify(request, 7)
                peer.tell(3, 25, b"\x00\x07\x02\xfe")
                craft.wait_until(lambda: reports)
            self.assertFalse(asked.done)
            self.assertTrue(craft.connected)
            again = craft.arm.move(4, wait=None)
            peer.verify(peer.telecommand(), 7)
            self.assertTrue(again.result(5.0).done)
            self.assertEqual(told, [False, True])
            craft.close()
            self.assertFalse(craft.connected)
        peer.socket.close()

    def test_who_closes_while_it_is_down_waits_for_nobody(self):
        peer = Peer()
        craft = self.started(type(self.craft)("127.0.0.1", peer.port, reconnect=True))
        peer.accept()
        peer.socket.close()
        craft.wait_until(lambda: not craft.connected)
        craft.close()
        self.assertFalse(craft._reader.is_alive())

    def test_nobody_there_is_said_at_once(self):
        with self.assertRaisesRegex(LinkLost, "does the mission fly"):
            type(self.craft)(port=1)

    def test_no_exported_name_can_hide_a_public_name_of_the_runtime(self):
        text = (HERE / "python_package.cpp").read_text()
        for one, variable in ((self.craft.arm, "subsystem_names"), (self.craft, "craft_names")):
            taken = set(re.findall(r'"(\w+)"', re.search(variable + r"\{(.*?)\};", text, re.S)[1]))
            self.assertEqual({name for name in dir(one) if not name.startswith("_")} - {"arm", "move"}, taken)


if __name__ == "__main__":
    unittest.main()
