# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco simulate` loads what a mission names from the modules beside it, and says of one that it does not take why."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ["HIROSCO_BIN"])
MODULE = "hirosco-hello.so"
GROUND_LINK = "hirosco-communication.so"


class Modules(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-modules-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("bin", "lib/hirosco", "elsewhere"):
            (self.folder / name).mkdir(parents=True)
        for name in ("hirosco", GROUND_LINK):
            shutil.copy2(BINARIES / name, self.folder / "bin")
        self.module = self.folder / "bin" / MODULE
        shutil.copy2(BINARIES / MODULE, self.module)

    def simulate(self, path="", mission=REPOSITORY / "missions/hello"):
        done = subprocess.run([self.folder / "bin/hirosco", "simulate", mission, "--for", "1s", "--summary"],
                              capture_output=True, text=True, check=False,
                              env={**os.environ, "NO_COLOR": "1", "PATH": f"{path}:{os.environ['PATH']}"})
        return done.returncode, done.stdout + done.stderr

    def checked(self, *words):
        done = subprocess.run([self.folder / "bin/hirosco", "check", *words, REPOSITORY / "missions/hello"], capture_output=True, text=True,
                              check=False, env={**os.environ, "NO_COLOR": "1"})
        return done.returncode, done.stdout + done.stderr

    def refused(self, *texts, **settings):
        code, told = self.simulate(**settings)
        self.assertEqual(code, 3, told)
        for text in ("no module hirosco-hello for subsystem HELLO", "mission.xml:10:3", *texts):
            self.assertIn(text, told)

    def test_it_is_found_beside_the_program_in_its_installation_and_in_path(self):
        self.assertEqual(self.simulate()[0], 0)
        for place in ("lib/hirosco", "elsewhere"):
            self.module = self.module.rename(self.folder / place / MODULE)
            code, told = self.simulate(self.folder / "elsewhere")
            self.assertEqual(code, 0, told)
        self.refused("there is no hirosco-hello.so")

    def test_the_ground_link_is_a_module_like_the_others(self):
        (self.folder / "bin" / GROUND_LINK).unlink()
        code, told = self.simulate()
        self.assertEqual(code, 3, told)
        self.assertIn("no module hirosco-communication for subsystem COMMUNICATION", told)

    def test_whoever_is_to_hold_the_ground_link_has_to_be_made_on_a_simulated_one(self):
        text = (REPOSITORY / "missions/hello/mission.xml").read_text()
        mission = self.folder / "mission.xml"
        mission.write_text(text.replace('<Ground subsystem="COMMUNICATION"', '<Ground subsystem="HELLO"').replace("../..", os.path.relpath(REPOSITORY, self.folder)))
        self.refused("it cannot hold a simulated ground link", "make_on_transport", mission=mission)

    def test_one_of_another_version_is_refused_and_both_versions_are_named(self):
        octets = self.module.read_bytes()
        told = subprocess.run([BINARIES / "hirosco", "--version"], capture_output=True, check=True).stdout
        version = told.split()[1]
        other = b"9" * len(version)
        self.assertEqual(octets.count(version + b" interface "), 1)
        self.module.write_bytes(octets.replace(version + b" interface ", other + b" interface "))
        self.refused(str(self.module), f"it was built against hirosco {other.decode()} interface ",
                     f"this is {version.decode()} interface ", "build it again; where that does not help",
                     "install hirosco and libhirosco-dev of one build")

    def test_one_built_against_other_headers_of_the_same_version_is_refused(self):
        octets = self.module.read_bytes()
        version = subprocess.run([BINARIES / "hirosco", "--version"], capture_output=True, check=True).stdout.split()[1]
        at = octets.index(version + b" interface ") + len(version + b" interface ")
        self.module.write_bytes(octets[:at] + b"0123456789ab" + octets[at + 12:])
        self.refused("interface 0123456789ab, this is ")
        # Before it is to fly it is told, too; a program that has no module flies without one.
        for name in ("hirosco-hello", "hirosco-communication", "hirosco-supervisor"):
            shutil.copy2(BINARIES / name, self.folder / "bin")
        for fly, expected in ((("--fly",), 1), ((), 0)):
            code, told = self.checked(*fly)
            self.assertEqual(code, expected, told)
            self.assertEqual("error: E0404: no module hirosco-hello for subsystem HELLO" in told and "0123456789ab, this is " in told, bool(fly), told)
        self.module.unlink()
        code, told = self.checked("--fly")
        self.assertEqual(code, 0, told)

    def test_what_is_no_module_of_a_subsystem_says_what_it_is(self):
        shutil.copy2(BINARIES / "hirosco-sim-robot.so", self.module)
        self.refused("it is no subsystem")
        whole = self.module.read_bytes()
        for octets in (1000, len(whole) - 1):
            self.module.write_bytes(whole[:octets])
            self.refused("it is no shared object, or was cut short")
        self.module.write_text("text")
        self.refused("it is no shared object, or was cut short")
        self.module.write_bytes(whole.replace(b"hirosco_module\0", b"hirosco_nodule\0"))
        self.refused("it has no hirosco_module()")


if __name__ == "__main__":
    unittest.main()
