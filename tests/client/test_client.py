#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the foreign client itself: what it builds against published octets and against `spacepackets`, and that each
of its verdicts can be both good and bad. The spacecraft here is a rehearsal made of `spacepackets` alone, not the
product. Exit code 77: `spacepackets` is not installed."""
import concurrent.futures
import contextlib
import io
import pathlib
import socket
import struct
import sys
import tempfile
import threading
import time
import unittest

try:
    from spacepackets.ecss import PusTc, PusTm
    from spacepackets.ecss.req_id import RequestId
    from spacepackets.ecss.tc import InvalidTcCrc16Error
except ImportError:
    print("test_client: no spacepackets here (pip install -r tests/client/requirements.txt)", file=sys.stderr)
    sys.exit(1)

import ground_client
import hostile
import pus_link

MISSION = """<Mission name="R"><Supervisor descriptor="s.xml"/><Subsystem descriptor="m.xml"/>
<Links><Link id="1"/><Link id="2"/></Links>
<Modes initial="commissioning" start="telepresence"><Mode name="commissioning"/><Mode name="standalone"/>
<Mode name="telepresence" id="7"/></Modes></Mission>"""
SUPERVISOR = """<Subsystem name="SUPERVISOR" id="1"><Parameters><ParamRef name="MODE" id="0" type="UINT8"/>
<StructRef name="REJECTED" id="0" type="STRUCT"><ParamRef name="CHECKSUM" id="0" type="UINT32"/></StructRef>
</Parameters>
<HKService id="4701" interval="100"><SampledOnce><ParamRef name="MODE"/><ParamRef name="REJECTED"/></SampledOnce>
</HKService></Subsystem>"""
MANIPULATOR = """<Subsystem name="MANIPULATOR" id="10"><Parameters><StructRef name="CUR_VALUES" id="0" type="STRUCT">
<ParamRef name="STATE" id="0" type="INT32"/><ParamRef name="POSITION" id="1" type="DOUBLE" count="2"/></StructRef>
<ParamRef name="DES_POSITION" id="1" type="DOUBLE" count="2"/></Parameters><FunctionService><Function name="MOVE_TO">
<Argument name="Q1" type="DOUBLE"/><Argument name="Q2" type="DOUBLE"/><Argument name="DURATION" type="DOUBLE"/></Function>
</FunctionService><Configuration name="STANDALONE" id="1"><HKService id="4711" interval="500"><SampledOnce>
<ParamRef name="CUR_VALUES"/></SampledOnce><SampledNREPTimes nrep="5"><ParamRef name="DES_POSITION"/></SampledNREPTimes>
</HKService></Configuration></Subsystem>"""


class Rehearsal:
    """Answers as the product should, or with one fault on demand."""

    def __init__(self, fault=None):
        self.fault, self.mode, self.state, self.position = fault, 7, 5, (-0.8, 1.6)
        self.counts = {}
        self.lock = threading.Lock()
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            try:
                client, _ = self.server.accept()
            except OSError:
                return
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            threading.Thread(target=self.serve, args=(client,), daemon=True).start()
            threading.Thread(target=self.housekeeping, args=(client,), daemon=True).start()

    def send(self, client, apid, service, subtype, data=b"", destination=0):
        with self.lock:
            count = self.counts[apid] = (self.counts.get(apid, 0) + 1) % (1 << 14)
            if self.fault == "gap" and count == 3:
                count = self.counts[apid] = 5
            now = time.time() + 378691200 + (0 if self.fault == "utc" else 37) - (60 if self.fault == "late" else 0)
            stamp = int(now * 2**24).to_bytes(7, "big")
            octets = PusTm(service=service, message_subtype=subtype, timestamp=stamp, source_data=data, apid=apid,
                           seq_count=count, destination_id=destination).pack()
            if self.fault == "damaged" and service == 17:
                octets[-1] ^= 1
            with contextlib.suppress(OSError):
                client.sendall(octets)

    def housekeeping(self, client):
        while client.fileno() >= 0:
            body = struct.pack(">Hi2d10d", 4711, self.state, *self.position, *(self.position * 5))
            self.send(client, 10, 3, 25, body + (b"\0" if self.fault == "long" else b""))
            self.send(client, 1, 3, 25, struct.pack(">HBI", 4701, self.mode, 7))
            time.sleep(0.1)

    def serve(self, client):
        buffer = bytearray()
        with client:
            while octets := client.recv(65536):
                buffer += octets
                for packet in pus_link.cut(buffer):
                    self.take(client, packet)

    def take(self, client, octets):
        request = octets[:4]
        try:
            tc = PusTc.unpack(octets)
        except InvalidTcCrc16Error as error:
            return self.send(client, 1, 1, 2, request + struct.pack(">H", 5), error.tc.source_id)
        ack, to = tc.pus_tc_sec_header.ack_flags, tc.source_id

        def good(subtype, flag, data=b""):
            if ack & flag and not (self.fault == "no step" and subtype == 5):
                self.send(client, tc.apid, 1, subtype, request + data, to)

        def bad(subtype, code, data=b""):
            code = 9 if self.fault == "wrong code" else code
            self.send(client, 1, 1, subtype, request + struct.pack(">H", code) + data, to)

        if tc.apid not in pus_link.APIDS:
            return bad(10, 1)
        if tc.service == 17:
            if tc.app_data:
                return bad(2, 8)
            good(1, 1), good(3, 2)
            self.send(client, tc.apid, 17, 2, destination=to)
            return good(7, 8)
        name = bytes(tc.app_data[:16]).rstrip(b"\0").decode()
        if name == "MOVE_TO":
            if self.mode != 2:
                return bad(2, 13)
            if self.state != 5:
                return bad(2, 10, bytes([self.state]))
            if len(tc.app_data) != 17 + 27:
                return bad(2, 8)
            values = [struct.unpack(">d", tc.app_data[18 + 9 * i:26 + 9 * i])[0] for i in range(3)]
            good(1, 1)
            if not -2 <= values[0] <= 1:
                return bad(4, 0x0105)
            good(3, 2), good(5, 4, b"\0\1")
            time.sleep(1.6)
            self.position = tuple(values[:2])
        elif name in ("SET_MODE", "ENTER_MODE", "SET_STATE", "CONFIGURE"):
            good(1, 1), good(3, 2)
            if name in ("SET_MODE", "ENTER_MODE"):
                self.mode = tc.app_data[18]
            elif name == "SET_STATE" and tc.apid == 10:
                self.state = tc.app_data[18]
        else:
            good(1, 1)
            return bad(4, 0x0101)
        good(7, 8)


class Octets(unittest.TestCase):
    def test_telecommands_are_the_published_octets(self):
        """Vectors TC-01, TC-02, TC-04 of the reference, made by other ground systems."""
        for apid, count, ack, source, octets in ((115, 25, 15, 0, "1873c01900062f1101000073ab"),
                                                 (10, 0, 9, 0, "180ac00000062911010000201c"),
                                                 (2039, 1, 9, 0xFFFF, "1ff7c0010006291101ffffe0f3")):
            telecommand = PusTc(service=17, message_subtype=1, apid=apid, seq_count=count, ack_flags=ack,
                                source_id=source)
            self.assertEqual(telecommand.pack().hex(), octets)
            self.assertEqual(hostile.ping(apid, count, ack, source).hex(), octets)

    def test_a_call_is_name_count_and_numbered_values(self):
        call = pus_link.Call("MOVE_TO", (1, "DOUBLE", 1.0), (2, "UINT8", 7))
        self.assertEqual(call.pack().hex(), "4d4f56455f544f" + "00" * 9 + "02" + "013ff0000000000000" + "0207")

    def test_a_stream_is_cut_into_packets_at_any_boundary(self):
        whole = hostile.ping(10, 1) + hostile.ping(11, 2)
        for split in range(len(whole)):
            buffer = bytearray(whole[:split])
            found = pus_link.cut(buffer)
            buffer += whole[split:]
            found += pus_link.cut(buffer)
            self.assertEqual([len(p) for p in found], [13, 13])
            self.assertFalse(buffer)

    def test_time_counts_from_1958(self):
        self.assertEqual(pus_link.onboard_seconds(bytes.fromhex("00000001800000")), 1.5)

    def test_verification_reports_are_taken_apart(self):
        request = RequestId.from_pus_tc(PusTc(service=17, message_subtype=1, apid=10, seq_count=3))
        for subtype, rest, expected in ((1, "", (None, None, b"")), (5, "0001", (1, None, b"")),
                                        (2, "000a04", (None, 10, b"\4")), (6, "00020105", (2, 0x105, b"")),
                                        (8, "0203", (None, 0x203, b"")), (10, "0001", (None, 1, b""))):
            packet = PusTm(service=1, message_subtype=subtype, timestamp=bytes(7), apid=1,
                           source_data=request.pack() + bytes.fromhex(rest))
            report = pus_link.Report(PusTm.unpack(packet.pack(), 7), 0.0)
            found = pus_link.verification_of(report)
            self.assertEqual((found.subtype, found.request), (subtype, request.as_u32()))
            self.assertEqual((found.step, found.code, found.data), expected)


class Descriptors(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        for name, content in (("mission.xml", MISSION), ("s.xml", SUPERVISOR), ("m.xml", MANIPULATOR)):
            (self.path / name).write_text(content)
        self.mission = pus_link.Mission(self.path / "mission.xml")

    def test_housekeeping_is_decoded_in_declared_order(self):
        body = struct.pack(">Hi12d", 4711, 5, *range(12))
        values = self.mission.subsystems["manipulator"].decode(body)
        self.assertEqual(values["CUR_VALUES.STATE"], 5)
        self.assertEqual(values["CUR_VALUES.POSITION"], (0.0, 1.0))
        self.assertEqual(values["DES_POSITION#4"], (10.0, 11.0))
        for wrong in (body[:-1], body + b"\0"):
            with self.assertRaises(ValueError):
                self.mission.subsystems["manipulator"].decode(wrong)

    def test_modes_and_apids_come_from_the_mission(self):
        self.assertEqual(self.mission.modes, {"commissioning": 1, "standalone": 2, "telepresence": 7})
        self.assertEqual(self.mission.start, "telepresence")
        self.assertEqual(self.mission.subsystems["supervisor"].apid, 1)

    def run_client(self, fault=None):
        craft = Rehearsal(fault)
        out = io.StringIO()
        with pus_link.GroundLink("127.0.0.1", craft.port) as link:
            checks = ground_client.Checks(link, self.mission, pus_link.Table(out))
            checks.run()
            code = checks.end()
        craft.server.close()
        return code, out.getvalue()

    def test_a_good_spacecraft_passes_every_check(self):
        code, out = self.run_client()
        self.assertEqual(code, 0, out)
        self.assertNotIn("FAILED", out)

    def test_each_fault_of_a_spacecraft_is_found(self):
        faults = {"wrong code": "refused: unknown APID", "no step": "MOVE_TO with all four", "gap": "no gap",
                  "utc": "its time", "late": "its time", "long": "4711", "damaged": "none malformed"}
        with concurrent.futures.ThreadPoolExecutor(len(faults)) as pool:
            runs = dict(zip(faults, pool.map(self.run_client, faults)))
        for fault, (code, out) in runs.items():
            with self.subTest(fault):
                self.assertEqual(code, 1)
                failed = [line for line in out.splitlines() if line.startswith("FAILED")]
                self.assertTrue(any(faults[fault] in line for line in failed), out)


class Hostile(unittest.TestCase):
    def test_a_header_announces_the_length_asked_for(self):
        self.assertEqual(hostile.header(10, 0xFFFF).hex(), "180ac000ffff")
        self.assertEqual(hostile.ping(10, 0)[:6], hostile.header(10, 6))

    def test_every_bit_flip_differs_from_the_ping_in_one_bit(self):
        ping = hostile.ping(10, 0)
        flips = list(hostile.bit_flips(ping))
        self.assertEqual(len(set(flips)), 8 * len(ping))
        for flip in flips:
            self.assertEqual(sum((a ^ b).bit_count() for a, b in zip(ping, flip)), 1)


if __name__ == "__main__":
    unittest.main()
