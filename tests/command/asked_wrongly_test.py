# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who asks `hirosco` wrongly is told what there is, and which name is near."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"


class AskedWrongly(unittest.TestCase):
    def hirosco(self, *words):
        with tempfile.TemporaryDirectory(prefix="hirosco-asked-") as folder:
            return subprocess.run([HIROSCO, *words], cwd=folder, capture_output=True, text=True, check=False,
                                  env={**os.environ, "NO_COLOR": "1", "XDG_RUNTIME_DIR": folder})

    def refused(self, words, *parts, code=2):
        done = self.hirosco(*words)
        self.assertEqual(done.returncode, code, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_commands_and_missions(self):
        self.refused(["stauts"], "no command 'stauts'; did you mean 'status'?", "there are: ", "fault")
        self.refused(["run"], "which mission? there are: ", "rokviss")
        self.refused(["run", "rokvis"], "no mission 'rokvis'", "did you mean 'rokviss'?", "there are: ", "hello", code=1)

    def test_subsystems_and_functions(self):
        self.refused(["tc", "--mission", "rokviss"], "of which subsystem? the mission has SUPERVISOR, ", "MANIPULATOR")
        self.refused(["tc", "manipulater", "ping", "--mission", "rokviss"], "no subsystem 'manipulater'; did you mean 'MANIPULATOR'?; mission ROKVISS has SUPERVISOR, ")
        self.refused(["tc", "manipulator", "--mission", "rokviss"], "which function? MANIPULATOR has", "MOVE_TO Q1")
        self.refused(["tc", "manipulator", "moveto", "--mission", "rokviss"], "no function 'moveto'; did you mean 'MOVE_TO'?", "SET_STATE")

    def test_devices_and_faults(self):
        done = self.hirosco("fault", "--mission", "rokviss")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("joystick takes:", done.stdout)
        self.assertIn("robot takes:", done.stdout)
        self.assertIn("unplug", done.stdout)
        self.assertIn("hand wander", self.hirosco("fault", "joystick", "--mission", "rokviss").stdout)
        self.refused(["fault", "joistick", "unplug", "--mission", "rokviss"], "no simulated device 'joistick'; did you mean 'joystick'?", "there are: ", "robot")

    def test_where_nothing_flies_nobody_is_taken_for_another_mission(self):
        for words in (["tc", "manipulator", "ping"], ["fault"], ["status"], ["mode"], ["log"], ["why"], ["ground"]):
            self.refused(words, f"hirosco {words[0]}: nothing flies here", "--mission NAME or FILE", code=3)
        self.refused(["fault", "robot", "unplug", "--mission", "rokviss"], "ROKVISS does not fly here", code=3)

    def test_in_the_folder_of_a_mission_or_of_its_only_log_that_one_is_meant(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-own-") as folder:
            here = pathlib.Path(folder)

            def told(*words, where=folder):
                done = subprocess.run([HIROSCO, *words], cwd=where, capture_output=True, text=True, check=False,
                                      env={**os.environ, "NO_COLOR": "1", "XDG_RUNTIME_DIR": folder})
                return done.returncode, done.stdout + done.stderr

            (here / "log").mkdir()
            (here / "log/hello.db").touch()
            self.assertIn("no archive log/hello-ground.db", told("why")[1])
            self.assertIn("mission HELLO has SUPERVISOR", told("tc", "arm", "ping")[1])
            (here / "log/rokviss.db").touch()
            self.assertIn("nothing flies here", told("tc", "arm", "ping")[1], "of two nobody knows which")
            self.assertIn("mission STARGAZER has SUPERVISOR", told("tc", "arm", "ping", where=REPOSITORY / "missions/stargazer")[1])
            for words in (("why",), ("why", "hello"), ("why", "--mission", "hello"), ("log",)):
                self.assertEqual(told(*words)[0], 3, words)
            self.assertEqual(sorted(path.name for path in (here / "log").iterdir()), ["hello.db", "rokviss.db"],
                             "who asks why makes no file")

    def test_what_has_flown_as_an_instance_is_found_without_its_mission_where_only_one_has(self):
        hello = (REPOSITORY / "missions/hello/mission.xml").read_text().replace("../../", "@hirosco/")
        stored = REPOSITORY / "tests/command/log_of_0_1_0/database.sqlite"
        with tempfile.TemporaryDirectory(prefix="hirosco-flown-") as folder:
            here = pathlib.Path(folder)

            def told(*words):
                done = subprocess.run([HIROSCO, *words], cwd=here, capture_output=True, text=True, check=False,
                                      env={**os.environ, "NO_COLOR": "1", "XDG_RUNTIME_DIR": folder})
                return done.returncode, done.stdout + done.stderr

            def flown(log):
                (here / log).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(stored, here / log)

            (here / "real.xml").write_text(hello.replace("log/hello.db", "log/real.db"))
            (here / "broken.xml").write_text(hello.replace("<Modes", "<Moods"))
            for words in (("log", "--last", "1"), ("why",), ("resources",)):
                code, text = told(*words, "--instance", "night")
                self.assertEqual(code, 2, text)
                self.assertIn("no instance 'night' flies", text)
                self.assertIn("nor has it flown from this folder: no log/night/NAME.db", text)
            # Beside a mission.xml that has not flown, and without one.
            for usual in (False, True):
                if usual:
                    (here / "mission.xml").write_text(hello)
                    self.assertIn("no log/night/hello.db", told("log", "--instance", "night")[1].splitlines()[-1])
                flown("log/night/real.db")
                code, text = told("log", "--instance", "night", "--last", "1")
                self.assertEqual((code, len(text.splitlines())), (0, 2), text)
                self.assertIn("log/night/real.db: number, time", text)
                self.assertIn("no archive log/night/real-ground.db", told("why", "--instance", "night")[1])
                shutil.rmtree(here / "log")
            flown("log/night/real.db")
            flown("log/night/hello.db")
            for command in ("log", "why", "resources"):
                code, text = told(command, "--instance", "night")
                self.assertEqual(code, 2, text)
                self.assertIn("instance 'night' has flown from here with 2 missions; which one?", text)
                lines = [line.split(": ")[0].split() for line in text.splitlines() if line.startswith("  hirosco")]
                self.assertEqual([line[2] for line in lines], ["mission.xml", "real.xml"], text)
                if command == "log":
                    for line, log in zip(lines, ("hello", "real")):
                        self.assertIn(f"log/night/{log}.db: number", told(*line[1:], "--last", "1")[1], "what is printed is typed")
            # Two files of one log, as a copy for a trial is: its mission.xml is meant. And where it has no file here its name is known.
            (here / "real.xml").write_text(hello)
            self.assertIn("log/night/hello.db: number", told("log", "--instance", "night", "--last", "1")[1])
            for file in ("real.xml", "mission.xml"):
                (here / file).unlink()
            self.assertIn("log/night/hello.db: number", told("log", "--instance", "night", "--last", "1")[1])

    def test_who_asks_for_json_gets_nothing_else(self):
        done = self.hirosco("mode", "--mission", "rokviss", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        modes = {line["mode"]: line for line in map(json.loads, done.stdout.splitlines())}
        self.assertEqual(set(modes), {"commissioning", "standalone", "remote", "feel", "automatic", "telepresence", "safe"})
        self.assertIn({"subsystem": "MANIPULATOR", "configuration": "SCRIPT", "state": "Operational"}, modes["automatic"]["commission"])
        done = self.hirosco("plan", "manipulator:torque_hard_exceeded", "--descriptors", "--mission", "rokviss", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({each["severity"] for each in json.loads(done.stdout)}, {"high"})
        for what in ("--show", "--recovery"):
            self.refused(["check", "rokviss", "--json", what], " excludes ", what, "--json")

    def test_status_of_nobody_is_no_answer(self):
        done = self.hirosco("status", "--port", "9")
        self.assertEqual(done.returncode, 3)
        self.assertIn("does the mission run?", done.stderr)


if __name__ == "__main__":
    unittest.main()
