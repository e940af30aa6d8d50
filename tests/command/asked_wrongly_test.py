# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who asks `hirosco` wrongly is told what there is, and which name is near."""
import json
import os
import pathlib
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
