#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The exported XTCE: the published schema takes it, and a foreign decoder reads every packet that a flight of rokviss on virtual time
tells, to its last bit, as the exported Python client does.

    xtce_test.py HIROSCO PACKETS_PROBE"""
import collections
import importlib
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree as ET

import xtce_lib
from space_packet_parser.xtce.definitions import XtcePacketDefinition

import flat

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
ROKVISS = REPOSITORY / "missions/rokviss/mission.xml"
# Missions of every kind: arrays, words and switches, own services, images, loops of services.
MISSIONS = ["missions/rokviss", "missions/hello", "tests/typed", "tests/endnodes", "tests/loops", "tests/author/lamp"]
# What the flight has to tell, or it proves little: services with subtypes.
KINDS = {(1, 1), (1, 2), (1, 3), (1, 4), (1, 5), (1, 7), (1, 8), (1, 10), (3, 10), (3, 25), (3, 35), (5, 1), (5, 2), (5, 4), (5, 8),
         (17, 2), (17, 129), (20, 2), (129, 2), (129, 5), (129, 7)}
HIROSCO, PROBE = [*sys.argv[1:3], "", ""][:2]


def export(what, mission, folder):
    subprocess.run([HIROSCO, "export", what, str(mission), "--to", str(folder)], capture_output=True, timeout=60, check=True)


def recorded(mission):
    """Packets of a flight."""
    done = subprocess.run([PROBE, str(mission)], capture_output=True, text=True, timeout=600, check=True)
    return [bytes.fromhex(line) for line in done.stdout.split()]


class Decoder:
    """`space_packet_parser` over the database without what it does not know."""

    def __init__(self, path):
        self.flat = flat.Flat(ET.parse(path).getroot())
        self.definition = self._definition()

    def _definition(self):
        with tempfile.NamedTemporaryFile(suffix=".xml") as file:
            file.write(self.flat.document())
            file.flush()
            return XtcePacketDefinition.from_xtce(file.name, root_container_name=self.flat.root)

    def decode(self, packet):
        """{path: value as it stands in the packet}. Whatever is not read to the last bit raises."""
        while True:
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                values = {name: value.raw_value for name, value in self.definition.parse_bytes(packet).items()}
            if not told:
                return values
            name = next(reversed(values))          # the last that it could read
            unanswered = [one for one in self.flat.asked.get(name, ()) if values[name] not in self.flat.choices.get(one, ())]
            if not unanswered:
                raise AssertionError(f"{packet.hex()}: {told[0].message}; the last was {name}")
            for container in unanswered:
                self.flat.choices.setdefault(container, set()).add(values[name])
            self.definition = self._definition()


class TheDocument(unittest.TestCase):
    def test_the_published_schema_takes_it(self):
        for mission in MISSIONS:
            with self.subTest(mission), tempfile.TemporaryDirectory() as folder:
                export("xtce", REPOSITORY / mission / "mission.xml", folder)
                (path,) = pathlib.Path(folder).glob("*.xml")
                file = xtce_lib.XtceFile(path)
                self.assertEqual(file.version, "1.2")
                self.assertTrue(file.validate().is_valid, file.validate().summary()[:2000])


    def test_every_packet_of_every_mission_is_read_to_its_last_bit(self):
        for mission in ("missions/hello", "tests/typed", "tests/endnodes", "tests/loops"):
            with self.subTest(mission), tempfile.TemporaryDirectory() as folder:
                export("xtce", REPOSITORY / mission / "mission.xml", folder)
                (path,) = pathlib.Path(folder).glob("*.xml")
                decoder, packets = Decoder(path), recorded(REPOSITORY / mission / "mission.xml")
                for packet in packets:
                    decoder.decode(packet)
                kinds = collections.Counter((packet[7], packet[8]) for packet in packets)
                print(f"{mission}: {len(packets)} packets: {dict(kinds)}")
                self.assertGreater(len(packets), 30)


class EveryPacket(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        export("xtce", ROKVISS, folder.name)
        export("python", ROKVISS, folder.name)
        sys.path.insert(0, folder.name)
        cls.client = importlib.import_module("hirosco_rokviss")
        cls.packets = recorded(ROKVISS)
        cls.document = pathlib.Path(folder.name, "ROKVISS.xml")
        cls.decoder = Decoder(cls.document)
        cls.abouts = {part._about.apid: part._about for part in vars(cls.client).values()
                      if isinstance(part, type) and hasattr(part, "_about") and hasattr(part._about, "apid")}

    def test_of_every_kind_there_is_one(self):
        kinds = collections.Counter((packet[7], packet[8]) for packet in self.packets)
        self.assertEqual(KINDS - set(kinds), set(), kinds)
        self.assertGreater(len(self.packets), 1000)

    def test_is_read_to_its_last_bit_as_the_client_reads_it(self):
        compared = collections.Counter()
        for packet in self.packets:
            values = self.decoder.decode(packet)
            told = self.client._r.Telemetry.parse(packet)
            self.header(told, values)
            about = self.abouts.get(told.apid)
            if (told.service, told.subtype) == (3, 25):
                self.housekeeping(about, told, values)
            elif told.service == 5 and told.subtype <= 4:
                self.event(about, told, values)
            elif told.service == 1:
                self.verification(told, values)
            elif told.service == 17 and told.subtype == 129:
                self.self_test(about, told, values)
            elif (told.service, told.subtype) == (20, 2):
                self.parameters(about, told, values)
            elif (told.service, told.subtype) == (129, 2):
                self.permission(told, values)
            else:
                continue
            compared[(told.service, told.subtype)] += 1
        print(f"{len(self.packets)} packets, {sum(compared.values())} of them value by value: {dict(compared)}")
        self.assertLessEqual({(1, 2), (1, 7), (3, 25), (5, 1), (17, 129), (20, 2), (129, 2)}, set(compared))

    def test_a_database_of_another_layout_is_noticed(self):
        report = next(packet for packet in self.packets if packet[7:9] == b"\x03\x19" and packet[20:22] == b"\x12\x69")
        self.decoder.decode(report)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "other.xml")
            text = self.document.read_text()
            entry = '<ParameterRefEntry parameterRef="/ROKVISS/MANIPULATOR/TIP_FORCE"/>'
            self.assertIn(entry, text)
            path.write_text(text.replace(entry, ""))
            with self.assertRaises(AssertionError):
                Decoder(path).decode(report)

    def of(self, values, path):
        """A value by its path, of an array all elements; of what stands there repeatedly the newest."""
        found = [name for name in values if name == path or name.startswith((path + "#", path + "["))]
        self.assertTrue(found, path)
        newest = max((name.partition("#")[2] for name in found), key=lambda one: [int(part) for part in one.split("#") if part])
        chosen = [values[name] for name in found if name.partition("#")[2] == newest]
        return chosen[0] if len(chosen) == 1 else tuple(chosen)

    def same(self, field, ours, theirs):
        if field.type == "TEXT" or field.words:
            theirs = theirs.split(b"\0")[0].decode() if isinstance(theirs, bytes) else theirs.split("\0")[0]
        self.assertEqual(repr(ours), repr(bool(theirs) if field.type == "BOOL" else theirs), field.name)

    def header(self, told, values):
        for name, value in (("apid", told.apid), ("sequence_count", told.count), ("service", told.service),
                            ("subtype", told.subtype), ("destination", told.destination)):
            self.assertEqual(values[f"/ROKVISS/{name}"], value)
        self.assertEqual(values["/ROKVISS/time"] / 2**24, told.time_s)

    def housekeeping(self, about, told, values):
        sid = int.from_bytes(told.data[:2], "big")
        layout = next(one for one in about.layouts if (one.sid, one.octets) == (sid, len(told.data)))
        for column in layout.columns:
            path = f"/ROKVISS/{about.name}/{column.name.replace('.', '/')}"
            self.same(column, column.decode(told.data, column.offset), self.of(values, path))

    def event(self, about, told, values):
        number = int.from_bytes(told.data[:2], "big")
        self.assertEqual(values["/ROKVISS/event_id"], number)
        kind, offset = next(one for one in about.events if one.id == number), 2
        for field in kind.arguments:
            self.same(field, field.decode(told.data, offset), self.of(values, f"/ROKVISS/{about.name}/{kind.name}/{field.name}"))
            offset += field.octets
        self.assertEqual(offset, len(told.data))

    def verification(self, told, values):
        request = int.from_bytes(told.data[:4], "big")
        self.assertEqual((values["/ROKVISS/request_apid"], values["/ROKVISS/request_count"]),
                         (request >> 16 & 0x7FF, request & 0x3FFF))
        rest = told.data[4:]
        if told.subtype in (5, 6):
            self.assertEqual(values["/ROKVISS/request_step"], int.from_bytes(rest[:2], "big"))
            rest = rest[2:]
        if told.subtype % 2 == 0:
            code = int.from_bytes(rest[:2], "big")
            self.assertEqual(values["/ROKVISS/failure_code"], code)
            self.failure(code, rest[2:], values)

    def failure(self, code, data, values):
        ours = self.client._r.failure_parameters(code, data)
        if "state" in ours:
            self.assertEqual(values["/ROKVISS/failure_state"], ours["state"])
        elif "mode" in ours:
            self.assertEqual(values["/ROKVISS/failure_mode"], ours["mode"])
        elif "reason" in ours:
            self.assertEqual(values["/ROKVISS/failure_number"], ours["number"])
            if ours["reason"]:
                words = values["/ROKVISS/failure_words"]
                self.assertEqual(words.decode() if isinstance(words, bytes) else words, ours["reason"])
        elif data:
            theirs = bytes([values["/ROKVISS/failure_first_octet"]]) + values.get("/ROKVISS/failure_data", b"")
            self.assertEqual(theirs, data)

    def self_test(self, about, told, values):
        kind = next(one for one in about.reports if (one.service, one.subtype) == (17, 129))
        ours = self.client._r.report_of(about, told)
        for field in kind.fields:
            theirs = values[f"/ROKVISS/ST17/SELF_TEST_OUTCOME/{field.name}"]
            if field.type == "TIME":
                theirs /= 2**24
            if isinstance(theirs, bytes):
                theirs = theirs.decode()
            self.assertEqual(ours[field.name], dict(getattr(field, "texts", ())).get(theirs, theirs))

    def permission(self, told, values):
        for name, value in zip(("REQUEST", "PERMITTED", "CODE"), struct.unpack(">IBH", told.data), strict=True):
            self.assertEqual(values[f"/ROKVISS/ST129/PERMISSION/{name}"], value)

    def parameters(self, about, told, values):
        offset = 1
        for _ in range(told.data[0]):
            wire = int.from_bytes(told.data[offset:offset + 4], "big")
            offset += 4
            parameter = next(one for one in about.parameters if one.wire == wire)
            structure = f"/ROKVISS/{about.name}/{parameter.name.replace('.', '/')}"
            for field in parameter.fields:
                path = f"{structure}/WHOLE.{field.name}" if len(parameter.fields) > 1 else structure
                self.same(field, field.decode(told.data, offset), self.of(values, path))
                offset += field.octets


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2, warnings="ignore")
