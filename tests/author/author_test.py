# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""An author outside: the folder `lamp` beside this file, copied to where nothing else is, is built against an installed
tree, checked, tested and simulated (Built), and flown with real processes, where ground commands it and sees what it does
(Flown), in the page, too (Seen). Python's standard library only. HIROSCO_BUILD names the build folder that is installed, HIROSCO_BIN its programs."""
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

import flight
import outside
from guide_pages import Guide  # run by their names, with the same installed tree
from new_kinds import New, NewFlown
from outside import BUILD

HERE = pathlib.Path(__file__).resolve().parent


METER = """
from hirosco_lamp import Spacecraft
with Spacecraft() as craft:
    (report,) = craft.lamp.read_meter().reports
    print(report.name, report["DIMMED"], report["CURRENT"])
    (report,) = craft.lamp.label("K. Tsiolkovsky \u20ac", 2**64 - 1, True).reports
    print(report.name, ascii(report["OWNER"]), report["SERIAL"], report["LENT"])
"""


PROGRAM = """
from hirosco_lamp import Spacecraft, ArgumentError
with Spacecraft() as craft:
    craft.lamp.program(2**64 - 3, "amber", "from Python", (0.25, 0.5, 1.0))
    for wrong in ((2**64, "amber", "", (0, 0, 0)), (1, "blue", "", (0, 0, 0)), (1, 1, 25 * "x", (0, 0, 0)), (1, 1, "", (0, 0))):
        try:
            craft.lamp.program(*wrong)
        except ArgumentError as error:
            print(error)
"""


class Outside(outside.Installed):
    """The author's folder, built against the installed tree."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lamp, cls.built = cls.folder / "lamp", cls.folder / "built"
        if not cls.lamp.exists():
            shutil.copytree(HERE / "lamp", cls.lamp)
            cls.said("cmake", "-S", cls.lamp, "-B", cls.built, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                     f"-DCMAKE_PREFIX_PATH={cls.prefix}")
            cls.said("cmake", "--build", cls.built)
        cls.environment = {"PATH": f"{cls.built}:{os.environ['PATH']}"}
        cls.mission = cls.lamp / "mission.xml"

    def logged(self, service, *lines):
        """What was told a moment ago comes into the log when it is written."""
        end = time.monotonic() + 10.0
        while any(line not in (log := self.hirosco("log", "--service", service)) for line in lines):
            self.assertLess(time.monotonic(), end, f"{lines} in\n{log}")

    def logged_by(self, craft, words, *which):
        """The same of one flight."""
        end = time.monotonic() + 10.0
        while words not in (log := str(craft.log(*which))):
            self.assertLess(time.monotonic(), end, f"{words} in\n{log}")


class Built(Outside, unittest.TestCase):
    def test_its_tests_pass(self):
        told = self.said("ctest", "--test-dir", self.built, "--output-on-failure", environment=self.environment)
        self.assertIn("100% tests passed, 0 tests failed out of 3", told)

    def test_a_cycle_that_waits_fails_its_test_in_a_release_build_and_whose_it_is_stands_there(self):
        """Planted in a copy of the lamp (docs/adr/0230): the heap in a function's handler, a lock and a print in a node."""
        careless, built = self.folder / "careless", self.folder / "careless_built"
        shutil.copytree(HERE / "lamp", careless)
        source = careless / "lamp.cpp"
        text = "#include <cstdio>\n#include <mutex>\n#include <string>\n" + source.read_text()
        for place, planted in (("                  raise(programmed_,", "static std::string kept;\nkept = std::string(note.size() + 64, 'x');\n"),
                               ("    const double step = fade_per_s", "static std::mutex mutex;\nif (goal_ == 0.1) {\n"
                                "  const std::lock_guard held{mutex};\n  std::printf(\"dim\\n\");\n}\n")):
            self.assertEqual(text.count(place), 1, place)
            text = text.replace(place, planted + place)
        source.write_text(text)

        def tested(*options, code):
            self.said("cmake", "-S", careless, "-B", built, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                      f"-DCMAKE_PREFIX_PATH={self.prefix}", *options)
            self.said("cmake", "--build", built, "--target", "lamp_test")
            return self.said(built / "lamp_test", at=careless, code=code)

        told = tested(code=1)
        forbidden = "of LAMP does in the cycle what real time forbids:"
        self.assertRegex(told, rf"Rig::cycle: the handler of PROGRAM {forbidden} [1-9] uses? of the heap, 0 locks, 0 outputs")
        self.assertIn(f"Rig::cycle: operational() {forbidden} 0 uses of the heap, 1 lock, 1 output", told)
        self.assertIn("[       OK ] Lamp.IsNotConfiguredByABrightestThatIsNone", told)
        self.assertNotIn("real time forbids", tested("-DHIROSCO_WATCH_CYCLES=OFF", code=0))

    def test_its_mission_is_checked_with_what_the_installed_tree_brings(self):
        self.assertIn("4 files, no problem", self.hirosco("check", "--fly", self.mission))

    def test_another_version_is_refused_by_both_their_names(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(later LANGUAGES NONE)\n"
                                                                 "find_package(hirosco 0.99 REQUIRED)\n")
            done = subprocess.run(["cmake", "-S", folder, "-B", f"{folder}/build", f"-DCMAKE_PREFIX_PATH={self.prefix}"], capture_output=True,
                                  text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('compatible with requested version "0.99"', " ".join(done.stderr.split()))
        self.assertRegex(done.stderr, r"version: \d+\.\d+\.\d+")

    def test_its_headers_are_what_an_author_includes_and_nothing_of_service_loop_or_cycle(self):
        sys.path.append(str(flight.REPOSITORY / "tools"))
        import check_author_headers
        there = self.prefix / "include/hirosco"
        headers = {file.relative_to(there).as_posix() for file in there.rglob("*") if file.is_file()}
        self.assertEqual(headers, check_author_headers.installed(check_author_headers.files()))
        self.assertEqual([header for header in headers if header.startswith(check_author_headers.ENGINE)], [])

    def test_its_modules_have_one_entry_point(self):
        for module in (*self.built.glob("*.so"), *(self.prefix / "lib/hirosco").glob("*.so")):
            with self.subTest(module=module.name):
                names = self.said("nm", "--dynamic", "--defined-only", "--format=posix", module).split("\n")
                self.assertEqual([name.split()[0] for name in names if name], ["hirosco_module"])

    def test_the_same_seed_simulates_the_same_octets(self):
        first, second = (self.hirosco("simulate", self.mission, "--for", "3s", "--seed", "5", "--octets") for _ in range(2))
        self.assertEqual(first, second)
        self.assertIn("commissioned", first)
        told = self.hirosco("simulate", self.mission, "--for", "3s", "--at", "2 lamp old 0.5", "--summary")
        self.assertIn("mode operation", told)
        self.hirosco("simulate", self.mission, "--for", "1s", "--at", "0.5 lamp new", code=1)

    def test_two_instances_of_one_subsystem_are_simulated_side_by_side(self):
        two = self.lamp / "two_lamps.xml"
        self.assertIn("no problem", self.hirosco("check", "--fly", two))
        told = self.hirosco("simulate", two, "--for", "3s", "--at", "2 desk-lamp old 0.5", "--summary")
        self.assertIn("mode operation", told)

    def test_each_configuration_and_each_instance_is_simulated_with_its_own_setting(self):
        """A lamp begins at 0.2, or as bright as its setting has it at most: the instance's own, which is that of all its configurations."""
        two = self.lamp / "two_lamps.xml"
        for mode, lamp, desk_lamp in (("operation", 0.2, 0.15), ("night", 0.1, 0.15)):
            with self.subTest(mode=mode):
                bright = self.brightness_of_world(two, mode)
                self.assertAlmostEqual(bright["lamp.brightness"], lamp, 3)
                self.assertAlmostEqual(bright["desk-lamp.brightness"], desk_lamp, 3)
        without = self.lamp / "alike.xml"
        own = '<Setting name="BRIGHTEST" value="0.15"/>'
        text = two.read_text()
        self.assertIn(own, text)
        without.write_text(re.sub(rf'(<Device name="LAMP" [^>]*)>\s*{own}\s*</Device>', r"\1/>", text))
        self.assertAlmostEqual(self.brightness_of_world(without, "night")["desk-lamp.brightness"], 0.1, 3)

    def brightness_of_world(self, mission, mode):
        """{column: number} of the world's truth after some seconds on virtual time."""
        trace = self.folder / "trace.csv"
        self.hirosco("simulate", mission, "--mode", mode, "--for", "4s", "--trace", trace, "--summary")
        _, names, *_, last = trace.read_text().splitlines()
        return dict(zip(names.split(","), map(float, last.split(","))))

    def test_a_setting_that_no_configuration_gives_or_nobody_reads_is_told_before_a_flight(self):
        wrong = self.lamp / "unread.xml"
        wrong.write_text((self.lamp / "two_lamps.xml").read_text().replace('"BRIGHTEST"', '"BRIGHTNESS"'))
        told = self.hirosco("check", wrong, code=1)
        self.assertIn("E0351", told)
        self.assertIn("gives 'LAMP' a setting 'BRIGHTNESS'", told)
        described = self.lamp / "dimmed.xml"
        described.write_text((self.lamp / "lamp.xml").read_text().replace('"BRIGHTEST"', '"WARMEST"'))
        mission = self.lamp / "misread.xml"
        mission.write_text(self.mission.read_text().replace('"lamp.xml"', '"dimmed.xml"'))
        told = self.hirosco("check", "--fly", mission, code=1)
        self.assertIn("E0405", told)
        self.assertIn("nobody reads setting 'WARMEST' of 'LAMP'", told)

    def test_one_subsystem_commands_another_and_hears_how_it_ended(self):
        switched = self.lamp / "switched.xml"
        self.assertIn("no problem", self.hirosco("check", "--fly", switched))
        blinking = self.lamp / "blinking.xml"
        commands = '<Commands subsystem="LAMP" to="DESK_LAMP"/>'
        text = switched.read_text()
        self.assertIn(commands, text)
        blinking.write_text(text.replace(commands, commands + '<Set parameter="BLINK_S" value="1"/>'))
        told = self.hirosco("simulate", blinking, "--for", "6s", "--at", "4 lamp unplug").split("\n")
        of_lamp = [line for line in told if "DESK_LAMP -> SWITCH" in line]
        self.assertGreaterEqual(sum("TM[1,7]" in line for line in of_lamp), 3)
        refused = [line for line in told if "SUPERVISOR -> SWITCH" in line and "TM[1,2]" in line]
        self.assertGreaterEqual(len(refused), 1)
        self.assertTrue(any("not permitted in this state" in line for line in refused), refused)
        heard = [line for line in told if "SWITCH -> SUPERVISOR" in line and "SUBSCRIBE" in line]
        self.assertGreaterEqual(len(heard), 2, "it hears the lamp's housekeeping and its event")
        # A bulb that never gets as bright, and a lamp that dies before it has ended what it had begun.
        told = self.hirosco("simulate", blinking, "--for", "8s", "--at", "3 lamp old 0.1", "--at", "4.3 kill DESK_LAMP",
                            code=None).split("\n")
        unknown = [line for line in told if "SUPERVISOR -> SWITCH" in line and "TM[1,8]" in line]
        self.assertEqual(len(unknown), 1, unknown)
        self.assertIn("outcome unknown", unknown[0])
        self.assertTrue(any("7." in line.split()[0] for line in told if "SWITCH -> ground" in line), "it flies on")

    def test_whom_the_mission_does_not_have_nobody_commands(self):
        wrong = self.lamp / "wrong.xml"
        text = (self.lamp / "switched.xml").read_text()
        for element, does in (("Commands", "commands"), ("Subscribes", "hears")):
            wrong.write_text(text.replace(f'<{element} subsystem="LAMP" to="DESK_LAMP"/>', ""))
            told = self.hirosco("check", wrong, code=1)
            self.assertIn(f"'SWITCH' {does} 'LAMP', which is not in the mission", told)

    def test_what_comes_with_the_installed_tree_is_simulated_from_anywhere(self):
        for mission in ("hello", "rokviss"):
            self.assertIn("s simulated", self.hirosco("simulate", mission, "--for", "2s", "--summary"))

    def test_nothing_in_the_installed_tree_names_the_place_where_it_was_built_or_put(self):
        for file in self.prefix.rglob("*"):
            if file.is_file():
                octets = file.read_bytes()
                for place in (self.folder / "first", BUILD, flight.REPOSITORY):
                    self.assertNotIn(str(place).encode(), octets, file)


class Flown(Outside, unittest.TestCase):
    def test_it_flies_and_ground_sees_it(self):
        with flight.Flight(self.mission, binaries=self.prefix / "bin", environment=self.environment, more=()) as lamp:
            lamp.wait_told("commissioned: mode operation", 20.0)
            url = lamp.wait_line(lambda line: "url" in line.content, 10.0).content["url"]
            base, token = url.split("/#token=")

            def ask(path, body=None):
                request = urllib.request.Request(base + path, json.dumps(body).encode() if body else None,
                                                 {"Authorization": f"Bearer {token}"})
                with urllib.request.urlopen(request, timeout=10) as answer:
                    return json.loads(answer.read())

            mission = ask("/api/mission")
            self.assertIn("LAMP", [one["name"] for one in mission["subsystems"]])
            (device,) = mission["devices"]
            self.assertIn({"line": "old 0.5", "text": "an old bulb, half as bright"}, device["faults"])
            self.assertIn("unplug", [fault["line"] for fault in device["faults"]])
            code, reports = lamp.tc("LAMP", "DIM", 0.9)
            self.assertEqual((code, reports[-1]), (0, "1,7"))
            self.assertAlmostEqual(self.brightness(lamp, 0.9), 0.9, 2)
            self.own_service(lamp, ask)
            self.typed_arguments(lamp, ask)
            self.assertEqual(ask("/mission/index.json"), ["tour.js"])
            with urllib.request.urlopen(base + "/mission/tour.js", timeout=10) as answer:
                self.assertEqual(answer.read(), (self.lamp / "page/tour.js").read_bytes())
            with self.assertRaises(urllib.error.HTTPError):
                ask("/mission/../mission.xml")
            lamp.fault("lamp", "old", "0.5")
            self.assertAlmostEqual(self.brightness(lamp, 0.45), 0.45, 2)
            values = ask("/api/status")["values"]
            self.assertIn("LAMP.CUR_VALUES.BRIGHTNESS", values)
            self.other_configuration(lamp)
            self.assertEqual(lamp.end(), 0)

    def test_two_instances_of_one_subsystem_fly_side_by_side(self):
        two = self.lamp / "two_lamps.xml"
        with flight.Flight(two, binaries=self.prefix / "bin", environment=self.environment, more=()) as lamps:
            lamps.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(lamps.tc("LAMP", "DIM", 0.9)[1][-1], "1,7")
            self.assertEqual(lamps.tc("DESK_LAMP", "DIM", 0.12)[1][-1], "1,7")
            self.assertAlmostEqual(self.brightness(lamps, 0.9), 0.9, 2)
            self.assertAlmostEqual(self.brightness(lamps, 0.12, "desk-lamp"), 0.12, 2)
            # Its own setting, in whatever configuration.
            self.assertEqual(lamps.tc("DESK_LAMP", "DIM", 0.16)[1], ["1,1", "1,4"])
            night = 3
            self.assertEqual(lamps.tc("SUPERVISOR", "SET_MODE", night)[1][-1], "1,7")
            self.assertAlmostEqual(self.brightness(lamps, 0.1), 0.1, 2)
            self.assertEqual(lamps.tc("LAMP", "DIM", 0.14)[1], ["1,1", "1,4"])
            self.assertEqual(lamps.tc("DESK_LAMP", "DIM", 0.14)[1][-1], "1,7")
            self.assertAlmostEqual(self.brightness(lamps, 0.14, "desk-lamp"), 0.14, 2)
            lamps.fault("desk-lamp", "unplug")
            lamps.wait_told("plan default: network {DESK_LAMP}", 5.0)
            self.assertAlmostEqual(self.brightness(lamps, 0.1), 0.1, 2)
            self.assertEqual(lamps.end(), 0)

    def test_one_subsystem_commands_another(self):
        with flight.Flight(self.lamp / "switched.xml", binaries=self.prefix / "bin", environment=self.environment,
                           more=()) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.assertEqual(craft.tc("SWITCH", "PRESS", 0.7), (0, ["1,1", "1,3", "1,7"]))
            self.assertAlmostEqual(craft.truth("lamp")["brightness"], 0.7, 1)
            self.forged(craft)
            self.assertEqual(craft.tc("DESK_LAMP", "SET_STATE", 4)[1][-1], "1,7")
            self.assertEqual(craft.tc("SWITCH", "PRESS", 0.5)[1], ["1,1", "1,3", "1,8"])
            self.logged_by(craft, "not permitted in this state", "--service", "1")
            self.assertEqual(craft.tc("DESK_LAMP", "SET_STATE", 5)[1][-1], "1,7")
            # It never gets as bright, and dies before it has ended what it had begun.
            craft.fault("lamp", "old", "0.1")
            ended = []
            pressing = threading.Thread(target=lambda: ended.append(craft.tc("SWITCH", "PRESS", 0.9)))
            pressing.start()
            craft.wait_line(lambda line: False, 1.0)
            self.assertEqual(ended, [], "nothing has ended it yet")
            craft.kill("lamp")
            pressing.join(30.0)
            self.assertEqual(ended[0][1], ["1,1", "1,3", "1,8"])
            self.logged_by(craft, "outcome unknown", "--service", "1")
            self.assertEqual(craft.tc("SWITCH", "PING")[1][-1], "1,7", "it flies on")
            craft.end()

    def test_one_subsystem_asks_the_supervisor_for_a_mode_and_hears_which_there_is(self):
        switched = self.lamp / "switched.xml"
        commissioning, operation, dark = 1, 2, 3
        with flight.Flight(switched, binaries=self.prefix / "bin", environment=self.environment, more=()) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            self.assertTrue(self.switch_knows(craft, operation))
            # What lets somebody move is the ground's to ask for, whatever the mode permits the switch.
            self.assertEqual(craft.tc("DESK_LAMP", "SET_STATE", 4)[1][-1], "1,7")
            self.assertEqual(craft.tc("SWITCH", "CHANGE_MODE", operation)[1], ["1,1", "1,3", "1,8"])
            self.logged_by(craft, "it lets DESK_LAMP move, which the ground may ask for and no subsystem", "--text", "is impossible")
            self.assertEqual(craft.tc("DESK_LAMP", "SET_STATE", 5)[1][-1], "1,7")
            self.assertEqual(craft.tc("SWITCH", "CHANGE_MODE", dark), (0, ["1,1", "1,3", "1,7"]))
            craft.wait_told("mode dark", 5.0)
            self.assertTrue(self.switch_knows(craft, dark))
            # No row of this mode names it: default deny.
            self.assertEqual(craft.tc("SWITCH", "CHANGE_MODE", commissioning)[1], ["1,1", "1,3", "1,8"])
            self.logged_by(craft, "not permitted in this mode", "--service", "1")
            self.assertEqual(craft.tc("SUPERVISOR", "SET_MODE", operation)[1][-1], "1,7", "the ground may")
            self.assertTrue(self.switch_knows(craft, operation))
            self.assertEqual(craft.end(), 0)

    @staticmethod
    def switch_knows(craft, mode):
        """By its own parameter, which has the value of the supervisor's, in its own housekeeping: within some seconds."""
        for _ in range(5):
            told = craft.hirosco("status", "SWITCH", "--mission", craft.mission).stdout
            if re.search(rf"^\s*MODE\s+{mode}\s*$", told, re.M):
                return True
        return False

    def forged(self, craft):
        """The ground speaks under the id of the switch: refused, and reported to the ground."""
        address = ("127.0.0.1", flight.PORT)
        ping = struct.pack(">HHHBBBH", 0x1808, 0xC000, 6, 0x29, 17, 1, 9)
        crc = 0xFFFF
        for octet in ping:
            crc ^= octet << 8
            for _ in range(8):
                crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
        with socket.create_connection(address, 5.0) as ground:
            ground.sendall(ping + struct.pack(">H", crc))
            told = ""
            for _ in range(100):
                told = str(craft.log("--text", "source id of somebody else"))
                if "client" in told:
                    break
                craft.wait_line(lambda line: False, 0.1)
        self.assertIn("source id of somebody else, client", told)

    def other_configuration(self, lamp):
        """Into the second one and back: each has its own BRIGHTEST, by which a lamp is told what it refuses, and what it may be told."""
        operation, night = 2, 3
        lamp.fault("lamp", "heal")
        self.assertEqual(lamp.tc("SUPERVISOR", "SET_MODE", night)[1][-1], "1,7")
        self.assertAlmostEqual(self.brightness(lamp, 0.1), 0.1, 2)
        self.assertEqual(lamp.tc("LAMP", "DIM", 0.9)[1], ["1,1", "1,4"])
        self.logged("1", "brighter than BRIGHTEST of this configuration")
        self.assertEqual(lamp.tc("SUPERVISOR", "SET_MODE", operation)[1][-1], "1,7")
        self.assertEqual(lamp.tc("LAMP", "DIM", 0.9)[1][-1], "1,7")
        self.assertAlmostEqual(self.brightness(lamp, 0.9), 0.9, 2)

    def own_service(self, lamp, ask):
        """What its descriptor says of its own PUS service is enough for terminal, page, Python, permission and log."""
        lamp_about = next(one for one in ask("/api/mission")["subsystems"] if one["name"] == "LAMP")
        request = next(one for one in lamp_about["functions"] if one["name"] == "READ_METER")
        self.assertEqual((request["service"], request["subtype"]), (200, 1))
        self.assertEqual(lamp.tc("LAMP", "READ_METER")[1][-1], "1,7")
        asked = ask("/api/commands", {"subsystem": "LAMP", "function": "READ_METER", "arguments": {}})
        self.assertIn("id", asked)
        self.hirosco("export", "python", self.mission, "--to", self.folder)
        told = self.said("python3", "-B", "-c", METER, environment={"PYTHONPATH": str(self.folder)})
        self.assertEqual(told.splitlines(), ["METER 1 0.9", f"LABELLED 'K. Tsiolkovsky \\u20ac' {2**64 - 1} True"])
        self.assertEqual(lamp.tc("LAMP", "LABEL", "Ada", 2**64 - 2)[1][-1], "1,7")
        given = {"OWNER": "by JSON", "SERIAL": str(2**64 - 3), "LENT": "on"}
        self.assertIn("id", ask("/api/commands", {"subsystem": "LAMP", "function": "LABEL", "arguments": given}))
        for name, value in (("OWNER", 25 * "x"), ("SERIAL", str(2**64)), ("LENT", 2)):
            with self.assertRaises(urllib.error.HTTPError) as refused:
                ask("/api/commands", {"subsystem": "LAMP", "function": "LABEL", "arguments": {**given, name: value}})
            self.assertEqual(refused.exception.code, 400)
        self.logged("200", "LAMP METER DIMMED=1 CURRENT=0.9 A", f"LAMP LABELLED OWNER='Ada' SERIAL={2**64 - 2} LENT=off",
                    f"LAMP LABELLED OWNER='by JSON' SERIAL={2**64 - 3} LENT=on")
        # Its states are in force: LABEL is for Operational alone, READ_METER for any.
        self.assertEqual(lamp.tc("LAMP", "SET_STATE", "SafeOperational")[1][-1], "1,7")
        self.assertEqual(lamp.tc("LAMP", "LABEL", "Ada", 1)[1], ["1,2"])
        self.assertEqual(lamp.tc("LAMP", "READ_METER")[1][-1], "1,7")
        self.assertEqual(lamp.tc("LAMP", "SET_STATE", "Operational")[1][-1], "1,7")
        self.assertEqual(lamp.tc("LAMP", "LABEL", "Ada", 1)[1][-1], "1,7")
        self.assertEqual(lamp.tc("LAMP", "DIM", 0.9)[1][-1], "1,7")  # as it was

    def typed_arguments(self, lamp, ask):
        """A 64-bit integer, an enumeration, a text and an array, by terminal, API and Python: no digit and no octet is lost."""
        self.assertEqual(lamp.tc("LAMP", "PROGRAM", 2**64 - 1, "Amber", "from a terminal", "0.25,0.5,1")[1][-1], "1,7")
        for wrong in (("0", 1, "", "0,0,0"), (2**64, 1, "", "0,0,0"), (1, "blue", "", "0,0,0"), (1, 1, 25 * "x", "0,0,0"), (1, 1, "", "0,0")):
            self.hirosco("tc", "LAMP", "PROGRAM", *wrong, "--mission", self.mission, code=2)
        given = {"SERIAL": str(2**64 - 2), "COLOUR": "amber", "NOTE": "\u20ac from JSON", "STEPS": [0.25, 0.5, 1]}
        ask("/api/commands", {"subsystem": "LAMP", "function": "PROGRAM", "arguments": given})
        for name, value in (("SERIAL", 0), ("SERIAL", str(2**64)), ("SERIAL", "1e3x"), ("COLOUR", 3), ("COLOUR", "blue"), ("NOTE", 25 * "x"),
                            ("NOTE", 5), ("STEPS", [0, 0]), ("STEPS", [0, 0, 1.5]), ("STEPS", 1)):
            with self.assertRaises(urllib.error.HTTPError) as refused:
                ask("/api/commands", {"subsystem": "LAMP", "function": "PROGRAM", "arguments": {**given, name: value}})
            self.assertEqual(refused.exception.code, 400)
            self.assertIn(name, refused.exception.read().decode())
        told = self.said("python3", "-B", "-c", PROGRAM, environment={"PYTHONPATH": str(self.folder)}).splitlines()
        self.assertEqual(len(told), 4, told)
        numbers = [2**64 - 1, 2**64 - 2, 2**64 - 3]
        octets = {2**64 - 1: 15, 2**64 - 2: 13, 2**64 - 3: 11}
        self.logged("5", *(f"PROGRAMMED SERIAL={number} COLOUR=amber NOTE_OCTETS={octets[number]} STEPS=0.25,0.5,1" for number in numbers))
        sent = [one["arguments"] for one in ask("/api/commands?from=0&to=1e12&limit=200")["commands"] if one["function"] == "PROGRAM"]
        self.assertEqual(sorted(one["SERIAL"] for one in sent), sorted(map(str, numbers)))
        self.assertIn("\u20ac from JSON", [one["NOTE"] for one in sent])

    def brightness(self, lamp, wanted, device="lamp"):
        """Of the device's world, once it is about what is wanted."""
        for _ in range(200):
            bright = lamp.truth(device)["brightness"]
            if abs(bright - wanted) < 0.005:
                break
            lamp.wait_line(lambda line: False, 0.05)
        return bright


class Seen(Outside, unittest.TestCase):
    """In the page, by a browser; skipped where there is none."""

    @classmethod
    def setUpClass(cls):
        done = cls.browser()
        if done.returncode == 77:
            raise unittest.SkipTest((done.stdout + done.stderr)[-200:])
        super().setUpClass()

    @staticmethod
    def browser(*words):
        environment = {"HIROSCO_BROWSER_WORK": str(BUILD / "tests/browser"), "HIROSCO_PAGE": str(BUILD / "share/hirosco/page"),
                       "HIROSCO_PAGE_WORK": str(BUILD / "ground/web")}
        return subprocess.run(["python3", "-B", HERE.parent / "browser/with_browser.py", *words], env={**os.environ, **environment},
                              capture_output=True, text=True, check=False)

    def by_form(self, url, request, *fields):
        done = self.browser("fill_form.mjs", url, "LAMP", request, *fields)
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-3000:])
        return done.stdout

    def test_its_requests_are_forms_of_the_page(self):
        serial = 2**64 - 4
        with flight.Flight(self.mission, binaries=self.prefix / "bin", environment=self.environment, more=()) as lamp:
            lamp.wait_told("commissioned: mode operation", 20.0)
            url = lamp.wait_line(lambda line: "url" in line.content, 10.0).content["url"]
            told = self.by_form(url, "PROGRAM", f"SERIAL={serial}", "COLOUR=2", "NOTE=by the page", "STEPS=0.25 0.5 1")
            self.assertIn("COLOUR: a choice", told)
            self.logged("5", f"PROGRAMMED SERIAL={serial} COLOUR=amber NOTE_OCTETS=11 STEPS=0.25,0.5,1")
            self.assertIn("LENT: a switch", self.by_form(url, "LABEL", "OWNER=by the page", f"SERIAL={serial}", "LENT=1"))
            self.logged("200", f"LAMP LABELLED OWNER='by the page' SERIAL={serial} LENT=on")
            self.assertEqual(lamp.end(), 0)


if __name__ == "__main__":
    flight.main()
