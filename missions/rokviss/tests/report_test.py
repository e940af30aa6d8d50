#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco report rokviss`: what a reviewer is given, and that an error of one percent in the model makes it fail."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml

HIROSCO = str(pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco")
MISSION = str(pathlib.Path(__file__).resolve().parents[1])
RUNS = "RO1,RO2,RO3"


def report(*arguments):
    done = subprocess.run([HIROSCO, "report", MISSION, *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def failing_rows(text):
    return set(re.findall(r"^  (\S+) .*FAILS$", text, re.M))


class Report(unittest.TestCase):
    def planted(self, error):
        code, text, _ = report("--only", RUNS, "--plant", error)
        self.assertEqual(code, 1, text)
        names = failing_rows(text)
        for name in names:
            self.assertIn(" " + name, text.splitlines()[-1])
        return names

    def test_holds_without_a_planted_error(self):
        code, text, _ = report("--only", RUNS)
        self.assertEqual(code, 0, text)
        self.assertEqual(failing_rows(text), set())
        self.assertRegex(text, r"\n(\d\d) of \1 figures hold\n")

    def test_one_percent_of_stiffness_fails_the_wind_up_of_the_joint(self):
        names = self.planted("stiffness=1.01")
        self.assertTrue({"RO2-17.6mm-windup2", "RO2-22.6mm-windup2", "RO2-27.6mm-windup2"} <= names, names)

    def test_one_percent_of_mass_fails_the_inertia_of_the_arm(self):
        names = self.planted("mass=1.01")
        self.assertTrue({"RO1-inertia-11", "RO1-inertia-12", "RO1-inertia-22"} <= names, names)

    def test_one_percent_of_force_scale_fails_what_the_hand_feels(self):
        self.assertIn("RO3-display-ratio", self.planted("force_scale=1.01"))

    def test_one_percent_of_the_hands_time_fails_when_the_torque_limit_trips(self):
        code, text, _ = report("--only", "RO8", "--plant", "hand_clock=1.01")
        self.assertEqual(code, 1, text)
        self.assertIn("RO8-trip-time", failing_rows(text))

    def test_two_milliseconds_of_delay_fail_when_the_torque_limit_trips(self):
        code, text, _ = report("--only", "RO8", "--plant", "delay_ms=2")
        self.assertEqual(code, 1, text)
        self.assertIn("RO8-trip-time", failing_rows(text))

    def test_writes_a_page_whose_plots_are_there_and_well_formed(self):
        with tempfile.TemporaryDirectory() as folder:
            code, text, _ = report("--only", "RO3,RO8", "--out", folder + "/new")
            self.assertEqual(code, 0, text)
            page = pathlib.Path(folder, "new", "index.html").read_text(encoding="utf-8")
            plots = re.findall(r'<img src="([^"]+)"', page)
            self.assertEqual(plots, ["ro3-display.svg", "ro8-torque.svg", "ro8-force.svg"])
            for name in plots:
                drawing = xml.parse(pathlib.Path(folder, "new", name)).getroot()
                words = [each.text for each in drawing.iter("{http://www.w3.org/2000/svg}text")]
                self.assertTrue(any("/ N" in word for word in words), f"{name} has an axis with a unit: {words}")
                curves = [each.get("d") for each in drawing.iter("{http://www.w3.org/2000/svg}path")]
                self.assertTrue(curves and all(curve.count(" L") > 100 for curve in curves), name)
            self.assertIn("RO8-trip-time", page)

    def test_the_same_seed_gives_the_same_report(self):
        self.assertEqual(report("--only", "RO8", "--seed", "7"), report("--only", "RO8", "--seed", "7"))

    def test_what_it_does_not_know_is_refused_with_a_word(self):
        for arguments, word in ((("--only", "RO99"), "no run 'RO99'"), (("--plant", "mass"), "NAME=FACTOR")):
            code, _, errors = report(*arguments)
            self.assertEqual(code, 2)
            self.assertIn(word, errors)

    def test_what_it_would_leave_out_is_refused(self):
        for arguments in (("--real", "--plant", "mass=1.01"), ("--real", "--seed", "2"), ("--real", "--only", "RO8"),
                          ("--real", "--corners"), ("--corners", "--out", "nowhere"), ("--corners", "--only", "RO8"),
                          ("--corners", "--faults", "1"), ("--corners", "--convergence"),
                          ("--faults", "1", "--only", "RO8")):
            code, _, errors = report(*arguments)
            self.assertEqual(code, 2, arguments)
            self.assertIn("excludes", errors)
        code, _, errors = report("--for", "1s")
        self.assertEqual(code, 2)
        self.assertIn("--real", errors)

    def test_an_unreadable_table_is_named_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            mission = pathlib.Path(MISSION, "mission.xml").read_text(encoding="utf-8")
            pathlib.Path(folder, "mission.xml").write_text(mission.replace("../../", "@hirosco/"), encoding="utf-8")
            pathlib.Path(folder, "expected.csv").write_text(
                "name,quantity,bound,value,tolerance,unit,source\nRO2-x,force,near,one,0,N,me\n", encoding="utf-8")
            done = subprocess.run([HIROSCO, "report", folder], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("expected.csv:2: value 'one' is no number", done.stderr)


if __name__ == "__main__":
    unittest.main()
