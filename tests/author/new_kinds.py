# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `hirosco new` makes, each kind of it, by an installed tree: the lines that it gives to type are typed as they stand (New), and
the mission is flown with real processes and shows in the page (NewFlown)."""
import functools
import json
import os
import pathlib
import re
import unittest
import urllib.request

import flight
import outside

KINDS = sorted(path.parent.name for path in (flight.REPOSITORY / "templates").glob("*/mission.xml"))
# What one types at each of them, and what it shows; the mission's subsystem has housekeeping of this name.
TYPED = {"subsystem": (("MY_SUBSYSTEM", "GO_TO", 0.5), "MY_SUBSYSTEM.CUR_VALUES.VALUE"),
         "device": (("MY_DEVICE", "SET:GOAL", 310), "MY_DEVICE.CUR_VALUES.TEMPERATURE"),
         "mission": (("HELLO", "MOVE_TO", 0.1), "HELLO.CUR_VALUES.POSITION"),
         "robot": (("MY_ROBOT", "MOVE_J", "0.1,0.1,0.1,0.1,0.1,0.1", 1), "MY_ROBOT.CUR_VALUES.POSITION[5]")}
WORLD = "hirosco-sim-mujoco"  # of a robot; a build without MuJoCo has none


def tried():
    """The kinds that this build can fly."""
    if (outside.BUILD / "bin" / WORLD).exists():
        return KINDS
    print(f"robot: not tried, there is no {WORLD} (tools/fetch_mujoco)")
    return [kind for kind in KINDS if kind != "robot"]


@functools.cache
def made(kind):
    """The folder of a new one, built, and what building, testing and simulating it said."""
    told = outside.Installed.said(outside.installed() / "bin/hirosco", "new", kind, f"My{kind.capitalize()}")
    lines = told.partition("\nNow:\n")[2].splitlines()
    assert lines[-1] == "  hirosco run mission.xml", told
    path = f"{outside.installed()}/bin:{os.environ['PATH']}"
    # ninja, as a computer of ours need not have make.
    said = outside.Installed.said("bash", "-euc", "\n".join(lines[:-1]), environment={"PATH": path, "CMAKE_GENERATOR": "Ninja"})
    return outside.place() / f"my_{kind}", said


class New(outside.Installed, unittest.TestCase):
    def test_every_kind_of_it_is_tried(self):
        self.assertEqual(sorted(TYPED), KINDS)
        told = self.hirosco("new", "--help")
        for kind in KINDS:
            self.assertIn(f"{kind}:", told)

    def test_the_lines_that_it_gives_build_test_and_simulate_it(self):
        for kind in tried():
            with self.subTest(kind=kind):
                folder, said = made(kind)
                self.assertRegex(said, r"100% tests passed, 0 tests failed out of [1-9]")
                self.assertIn("commissioned: mode operation", said)
                self.assertIn("no problem", self.here(folder, "check", "--fly", "mission.xml"))

    def test_the_same_seed_simulates_the_same_octets(self):
        for kind in tried():
            with self.subTest(kind=kind):
                folder, _ = made(kind)
                first, second = (self.here(folder, "simulate", "mission.xml", "--for", "2s", "--seed", "3", "--octets") for _ in range(2))
                self.assertEqual(first, second)

    def test_a_name_that_is_none_and_a_folder_that_is_there_are_refused(self):
        self.assertIn("is no name for it", self.hirosco("new", "subsystem", "2lamps", code=2))
        self.assertIn("is a name of the framework", self.hirosco("new", "subsystem", "Supervisor", code=2))
        self.assertIn("kind: ", self.hirosco("new", "house", "lamp", code=2))
        (self.folder / "there").mkdir()
        self.assertIn("is there already", self.hirosco("new", "mission", "there", code=3))
        self.assertEqual(list((self.folder / "there").iterdir()), [])

    def test_a_robot_that_cannot_be_flown_is_refused_with_its_place_and_leaves_no_folder(self):
        model = self.folder / "weak.urdf"
        house = (self.prefix / "share/hirosco/subsystems/robot_arm/robot_arm.urdf").read_text()
        model.write_text(house.replace('effort="120"', 'effort="0"').replace('name="tool"', 'name="hook"').replace('"tool"', '"hook"'))
        told = self.hirosco("new", "robot", "Weak", "--urdf", model, code=1)
        line = next(i + 1 for i, text in enumerate(model.read_text().splitlines()) if 'effort="0"' in text)
        self.assertIn(f"{model}:{line}:5: error: U0601: joint 'elbow' has no effort above 0", told)
        self.assertIn("from the drive's data sheet", told)
        self.assertIn("docs/urdf-errors.md", told)
        self.assertIn("U0001", self.hirosco("new", "robot", "Weak", "--urdf", "nowhere.urdf", code=1))
        model.write_text(house)
        self.assertIn("U0603", self.hirosco("new", "robot", "Weak", "--urdf", model, "--tip", "hook", code=1))
        self.assertFalse((self.folder / "weak").exists())
        self.hirosco("new", "robot", "Weak", "--urdf", model, "--tip", "flange")
        self.assertEqual((self.folder / "weak/page/weak.urdf").read_text(), house, "octet by octet")
        self.assertIn("are of a robot", self.hirosco("new", "mission", "weaker", "--urdf", model, code=2))
        self.assertIn("no problem", self.hirosco("check", self.folder / "weak/mission.xml"))

    def here(self, folder, *words):
        self.environment = {"PATH": f"{folder}/build:{os.environ['PATH']}"}
        return self.hirosco(*words, at=folder)


class NewFlown(outside.Installed, unittest.TestCase):
    def test_each_flies_and_shows_in_the_page(self):
        for kind in tried():
            with self.subTest(kind=kind):
                self.flies(kind)

    def flies(self, kind):
        folder, _ = made(kind)
        environment = {"PATH": f"{folder}/build:{os.environ['PATH']}"}
        with flight.Flight(folder / "mission.xml", binaries=self.prefix / "bin", environment=environment, more=()) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            url = craft.wait_line(lambda line: "url" in line.content, 10.0).content["url"]
            base, token = url.split("/#token=")

            def ask(path):
                request = urllib.request.Request(base + path, None, {"Authorization": f"Bearer {token}"})
                with urllib.request.urlopen(request, timeout=10) as answer:
                    return json.loads(answer.read())

            (subsystem, *command), value = TYPED[kind]
            self.assertIn(subsystem, [one["name"] for one in ask("/api/mission")["subsystems"]])
            code, reports = craft.tc(subsystem, *command)
            self.assertEqual((code, reports[-1]), (0, "1,7"))
            self.assertTrue(any(value in ask("/api/status")["values"] or craft.wait_line(lambda line: False, 0.1) for _ in range(50)), value)
            with urllib.request.urlopen(base, timeout=10) as page:
                self.assertRegex(page.read().decode(), r"<title>.*</title>")
            if (folder / "page").is_dir():
                self.assertEqual(sorted(ask("/mission/index.json")), sorted(one.name for one in (folder / "page").iterdir()))
            self.assertEqual(craft.end(), 0)
