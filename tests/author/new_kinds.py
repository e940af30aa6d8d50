# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `hirosco new` makes, each kind of it, by an installed tree: the lines that it gives to type are typed as they stand (New), and
the mission is flown with real processes and shows in the page (NewFlown)."""
import functools
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import unittest
import urllib.request

import flight
import outside

KINDS = sorted(path.parent.name for path in (flight.REPOSITORY / "templates").glob("*/mission.xml"))
# What one types at each of them, and what it shows; the mission's subsystem has housekeeping of this name.
TYPED = {"subsystem": (("HEAT_PIPE", "GO_TO", 0.5), "HEAT_PIPE.CUR_VALUES.VALUE"),
         "device": (("OVEN", "SET:GOAL", 310), "OVEN.CUR_VALUES.TEMPERATURE"),
         "mission": (("HELLO", "MOVE_TO", 0.1), "HELLO.CUR_VALUES.POSITION"),
         "robot": (("LAB_ARM", "MOVE_J", "0.1,0.1,0.1,0.1,0.1,0.1", 1), "LAB_ARM.CUR_VALUES.POSITION[5]")}
# What each is called: no word of its kind or of its template stands in it, as a test of the folder that looks for one would find it there.
NAMES = {"subsystem": "HeatPipe", "device": "Oven", "mission": "Survey", "robot": "LabArm"}
WORLD = "hirosco-sim-mujoco"  # of a robot; a build without MuJoCo has none


def tried():
    """The kinds that this build can fly."""
    if (outside.BUILD / "bin" / WORLD).exists():
        return KINDS
    print(f"robot: not tried, there is no {WORLD} (tools/fetch_mujoco)")
    return [kind for kind in KINDS if kind != "robot"]


def real_arm(here):
    """What your_robot.md has typed for the real arm, with a driver here or elsewhere, but for the flight itself; and how the driver here is started."""
    page = (flight.REPOSITORY / "docs/guide/your_robot.md").read_text()
    section = re.search(r"^## The real arm\n(.*?)^## ", page, re.M | re.S)[1]
    blocks = re.findall(r"^```\n(sed .*?)^```$", section, re.M | re.S)
    assert len(blocks) == 3, "the mission of the real arm, that of a driver on this computer, and a slower cycle"
    if not here:
        del blocks[1]
    (driver,) = re.findall(r"^```\npython3 /usr/share/doc/hirosco/examples/device/(.*)\n```$", section, re.M)
    return [line for line in "".join(blocks).splitlines() if not line.startswith("hirosco run")], driver.split()


# What drives.py is: six joints that carry next to nothing, behind rotors of 0.5 kg m2, which is what is assumed of 150 N m, its MOST.
OF_THE_DRIVER = "<robot name='light'><link name='base'/>" + "".join(f"""
<joint name='j{i}' type='revolute'><origin xyz='0 0 0.05'/><parent link='{'base' if i == 1 else f'l{i - 1}'}'/><child link='l{i}'/>
<axis xyz='{('1 0 0', '0 1 0', '0 0 1')[i % 3]}'/><limit lower='-2' upper='2' velocity='2' effort='150'/></joint>
<link name='l{i}'><inertial><mass value='0.05'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0' izz='1e-4'/></inertial></link>"""
                                                                    for i in range(1, 7)) + "</robot>\n"


@functools.cache
def made(kind):
    """The folder of a new one, built, and what building, testing and simulating it said."""
    told = outside.Installed.said(outside.installed() / "bin/hirosco", "new", kind, NAMES[kind])
    lines = told.partition("\nNow:\n")[2].splitlines()
    assert lines[-1] == "  hirosco run mission.xml", told
    path = f"{outside.installed()}/bin:{os.environ['PATH']}"
    # ninja, which builds with both processors.
    said = outside.Installed.said("bash", "-euc", "\n".join(lines[:-1]), environment={"PATH": path, "CMAKE_GENERATOR": "Ninja"})
    return outside.place() / lines[0].removeprefix("  cd "), said


class New(outside.Installed, unittest.TestCase):
    def test_every_kind_of_it_is_tried(self):
        self.assertEqual(sorted(TYPED), KINDS)
        told = self.hirosco("new", "--help")
        for kind in KINDS:
            self.assertIn(f"{kind}:", told)
            self.assertEqual("--urdf" in self.hirosco("new", kind, "--help"), kind == "robot")

    def test_the_lines_that_it_gives_build_test_and_simulate_it(self):
        for kind in tried():
            with self.subTest(kind=kind):
                folder, said = made(kind)
                self.assertRegex(said, r"100% tests passed, 0 tests failed out of [1-9]")
                self.assertIn("commissioned: mode operation", said)
                self.assertIn("no problem", self.here(folder, "check", "--fly", "mission.xml"))

    def test_where_nothing_is_compiled_no_compiler_is_needed(self):
        for kind in [kind for kind in tried() if kind in ("mission", "robot")]:
            with self.subTest(kind=kind):
                folder, _ = made(kind)
                told = self.said("cmake", "-S", folder, "-B", self.folder / f"{kind}-without", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                                 environment={"CC": "/nowhere/cc", "CXX": "/nowhere/c++"})
                self.assertIn("Build files have been written", told)

    def test_the_lines_of_the_guide_make_the_mission_of_the_real_arm(self):
        """Its descriptor and mission as your_robot.md has them typed; its folder's tests pass with them, and without the simulated device."""
        if "robot" not in tried():
            return
        folder, _ = made("robot")
        path = f"{self.prefix}/bin:{os.environ['PATH']}"
        for here, checks, enable, frames in ((True, 3, ("unix", "lab_arm-enable"), ("udp", "127.0.0.1:5001")),
                                             (False, 2, ("udp", "192.0.2.7:5002"), ("udp", "192.0.2.7:5001"))):
            with self.subTest(here=here):
                lines, driver = real_arm(here)
                real = self.folder / ("real_here" if here else "real") / folder.name
                shutil.copytree(folder, real, ignore=shutil.ignore_patterns("build"))
                # As it is written for an arm of many joints.
                slower = real / "lab_arm.xml"
                slower.write_text(slower.read_text().replace('sampling_us="1000"', 'sampling_us="2000"'))
                told = self.said("bash", "-euc", "\n".join(lines), environment={"PATH": path}, at=real)
                self.assertEqual(told.count("no problem"), checks, "as the arm's own cycle is, with its driver here, and slower")
                descriptor = (real / "lab_arm_real.xml").read_text()
                self.assertEqual(re.findall(r'transfer="(\w+)" address="([^"]*)"', descriptor), [enable, frames, frames])
                self.assertEqual(re.findall(r'sampling_us="(\d+)"', descriptor), ["4000", "4000"])
                self.assertEqual(re.findall(r'id="4711" interval="(\d+)"', descriptor), ["125", "125"], "each half a second")
                if here:
                    self.assertEqual(driver, ["arm.py", frames[1], enable[1]], "what is started is where they look for it")
        # Whoever takes the world out of the mission itself has tests that pass, too.
        (real / "mission.xml").write_text((real / "real.xml").read_text())
        told = self.said("bash", "-euc", f"cmake -B build -DCMAKE_PREFIX_PATH={self.prefix} && ctest --test-dir build", at=real)
        self.assertIn("100% tests passed, 0 tests failed out of 1", told)

    def test_the_same_seed_simulates_the_same_octets(self):
        for kind in tried():
            with self.subTest(kind=kind):
                folder, _ = made(kind)
                first, second = (self.here(folder, "simulate", "mission.xml", "--for", "2s", "--seed", "3", "--octets") for _ in range(2))
                self.assertEqual(first, second)

    def test_pages_and_templates_name_what_is_installed_with_them(self):
        self.said("python3", "-B", flight.REPOSITORY / "tools/packages/check_pages.py", self.prefix)

    def test_examples_are_whole(self):
        examples = self.prefix / "share/doc/hirosco/examples"
        self.assertEqual(sorted(one.name for one in examples.iterdir()), ["device", "hello", "lamp", "pair", "python"])
        # Built in a copy by tools/packages/installed_and_gone; what they include and name is looked for here.
        for file in (*examples.rglob("*.[ch]pp"), *examples.rglob("CMakeLists.txt")):
            text = file.read_text()
            for name in re.findall(r'#include "([^"]+)"|#include <((?:hirosco|simulation|robotics)/[^>]+)>|([\w/-]+\.cpp)\b', text):
                places = (file.parent, examples / "hello", examples / "device", self.prefix / "include/hirosco")
                name = "".join(name).removeprefix("tests/devices/")  # they lie in one folder
                self.assertTrue(any((place / name).exists() for place in places), f"{file}: {name}")
        self.assertIn("--enable", self.said("python3", "-B", examples / "device/duties_test.py", "--help"))

    def test_a_name_that_is_none_and_a_folder_that_is_there_are_refused(self):
        self.assertIn("is no name for it", self.hirosco("new", "subsystem", "2lamps", code=2))
        self.assertIn("is a name of the framework", self.hirosco("new", "subsystem", "Supervisor", code=2))
        self.assertIn("kind: ", self.hirosco("new", "house", "lamp", code=2))
        (self.folder / "there").mkdir()
        self.assertIn("is there already", self.hirosco("new", "mission", "there", code=3))
        self.assertEqual(list((self.folder / "there").iterdir()), [])

    def test_who_makes_what_there_is_already_is_told_where(self):
        told = self.hirosco("new", "device", "thermal")
        self.assertIn(f"comes with HIROSCO: {self.prefix}/share/hirosco/subsystems/thermal", told)

    def test_a_robot_that_cannot_be_flown_is_refused_with_its_place_and_leaves_no_folder(self):
        model = self.folder / "weak.urdf"
        house = (self.prefix / "share/hirosco/subsystems/robot_arm/robot_arm.urdf").read_text()
        model.write_text(house.replace('effort="120"', 'effort="0"').replace('name="tool"', 'name="hook"').replace('"tool"', '"hook"'))
        told = self.hirosco("new", "robot", "Weak", "--urdf", model, code=1)
        line = next(i + 1 for i, text in enumerate(model.read_text().splitlines()) if 'effort="0"' in text)
        self.assertIn(f"{model}:{line}:5: error: U0601: joint 'elbow' has no effort above 0", told)
        self.assertIn("from the drive's data sheet", told)
        self.assertIn(str(self.prefix / "share/doc/hirosco/urdf-errors.md"), told)
        self.assertIn("U0001", self.hirosco("new", "robot", "Weak", "--urdf", "nowhere.urdf", code=1))
        model.write_text(house)
        self.assertIn("U0603", self.hirosco("new", "robot", "Weak", "--urdf", model, "--tip", "hook", code=1))
        self.assertFalse((self.folder / "weak").exists())
        self.hirosco("new", "robot", "Weak", "--urdf", model, "--tip", "flange")
        self.assertEqual((self.folder / "weak/page/weak.urdf").read_text(), house, "octet by octet")
        self.assertIn("are of a robot", self.hirosco("new", "mission", "weaker", "--urdf", model, code=2))
        self.assertIn("no problem", self.hirosco("check", self.folder / "weak/mission.xml"))

    def test_a_robot_of_somebody_elses_file_has_its_meshes_and_its_fingers(self):
        """As tools/packages/installed_and_gone flies it with nothing but packages."""
        self.said("python3", "-B", flight.REPOSITORY / "tools/packages/foreign_robot.py", self.folder / "foreign")
        model = self.folder / "foreign/arm_description/urdf/arm.urdf"
        told = self.hirosco("new", "robot", "Strange", "--urdf", model, "--gripper", "left_slide")
        self.assertNotIn("U0706", told)
        folder = self.folder / "strange"
        self.assertEqual(sorted(path.name for path in (folder / "page/meshes").iterdir()), ["arm.stl", "base.stl", "finger.stl", "hand.stl"])
        descriptor = (folder / "strange.xml").read_text()
        self.assertRegex(descriptor, r'name="ACCELERATION"[^>]* init="3"')
        self.assertIn("no problem", self.hirosco("check", folder / "mission.xml"))
        if "robot" in tried():
            self.assertIn("commissioned: mode operation", self.here(folder, "simulate", "mission.xml", "--for", "5s"))
        refused = self.hirosco("new", "robot", "Stranger", "--urdf", model, "--tip", "hand", "--gripper", "left_slide,elbow", code=1)
        self.assertIn("U0608", refused)
        self.assertFalse((self.folder / "stranger").exists())

    def test_a_robot_that_homes_and_feels_is_tried_by_its_own_test(self):
        """Its joints find their zeros, it works, its wrist feels, and it is unplugged: as its folder has it, nothing edited."""
        self.assertIn("are of a robot", self.hirosco("new", "mission", "numb", "--wrist-sensor", code=2))
        self.hirosco("new", "robot", "OrbitArm", "--homing", "--wrist-sensor")
        folder = self.folder / "orbit_arm"
        self.assertIn("no problem", self.hirosco("check", folder / "mission.xml"))
        if "robot" in tried():
            told = self.said("bash", "-euc", f"cmake -B build -DCMAKE_PREFIX_PATH={self.prefix} && ctest --test-dir build --output-on-failure", at=folder)
            self.assertIn("100% tests passed, 0 tests failed out of 2", told)

    def here(self, folder, *words):
        self.environment = {"PATH": f"{folder}/build:{os.environ['PATH']}"}
        return self.hirosco(*words, at=folder)


def free_port():
    with socket.socket(type=socket.SOCK_DGRAM) as held:
        held.bind(("127.0.0.1", 0))
        return held.getsockname()[1]


class NewFlown(outside.Installed, unittest.TestCase):
    def test_a_driver_in_python_flies_as_the_guide_has_it(self):
        """arm.py at both addresses of a driver on this computer, and not one number changed but those that are typed."""
        place = self.folder / "by_python"
        place.mkdir()
        (place / "light.urdf").write_text(OF_THE_DRIVER)
        self.hirosco("new", "robot", "LabArm", "--urdf", place / "light.urdf", "--to", place)
        folder = place / "lab_arm"
        lines, (program, frames, enable) = real_arm(here=True)
        own = f"127.0.0.1:{free_port()}"  # 5001 may be somebody's
        lines = "\n".join(lines).replace(frames, own)
        self.said("bash", "-euc", lines, environment={"PATH": f"{self.prefix}/bin:{os.environ['PATH']}"}, at=folder)
        driver = self.prefix / "share/doc/hirosco/examples/device" / program
        arm = subprocess.Popen([sys.executable, "-B", driver, own, enable], cwd=folder)
        self.addCleanup(arm.wait)
        self.addCleanup(arm.kill)
        with flight.Flight(folder / "real.xml", binaries=self.prefix / "bin", folder=folder) as craft:
            craft.wait_told("commissioned: mode operation", 30.0)
            for goal in ("0.3,-0.3,0.3,0.3,-0.3,0.3", "0,0,0,0,0,0"):
                code, reports = craft.tc("LAB_ARM", "MOVE_J", goal, 0.5)
                self.assertEqual((code, reports[-1]), (0, "1,7"))
                told = craft.hirosco("status", "LAB_ARM", "--mission", craft.mission).stdout
                self.assertEqual(self.joints(told, "DES_POSITION"), list(map(float, goal.split(","))), told)
                for is_at, wanted in zip(self.joints(told, "CUR_VALUES.POSITION"), map(float, goal.split(","))):
                    self.assertAlmostEqual(is_at, wanted, 2)
            self.assertNotIn("_LIMIT_EXCEEDED", " ".join(line.told for line in craft.told()))
            self.assertEqual(craft.end(), 0)

    def joints(self, told, name):
        """The newest values that `hirosco status` shows of a parameter."""
        self.assertRegex(told, rf"(?m)^\s*{name}\s", "its housekeeping has come within what it listens for")
        return [float(word) for word in re.search(rf"(?m)^\s*{re.escape(name)}\s+(.*)$", told)[1].split()[:6]]

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
