# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who asks `hirosco` wrongly is told what there is, and which name is near."""
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
        self.refused(["tc"], "of which subsystem? the mission has SUPERVISOR, ", "MANIPULATOR")
        self.refused(["tc", "manipulater", "ping"], "no subsystem 'manipulater'; did you mean 'MANIPULATOR'?")
        self.refused(["tc", "manipulator"], "which function? MANIPULATOR has", "MOVE_TO Q1")
        self.refused(["tc", "manipulator", "moveto"], "no function 'moveto'; did you mean 'MOVE_TO'?", "SET_STATE")

    def test_devices_and_faults(self):
        done = self.hirosco("fault")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("joystick takes:", done.stdout)
        self.assertIn("robot takes:", done.stdout)
        self.assertIn("unplug", done.stdout)
        self.assertIn("hand wander", self.hirosco("fault", "joystick").stdout)
        self.refused(["fault", "joistick", "unplug"], "no simulated device 'joistick'; did you mean 'joystick'?", "there are: ", "robot")

    def test_status_of_nobody_is_no_answer(self):
        done = self.hirosco("status", "--port", "9")
        self.assertEqual(done.returncode, 3)
        self.assertIn("does the mission run?", done.stderr)


if __name__ == "__main__":
    unittest.main()
