#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `hirosco check` says of the scripts of a mission: each line with its file, line and column."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
HIROSCO = pathlib.Path(os.environ.get("HIROSCO_BIN", REPOSITORY / "build/release/bin")) / "hirosco"


class Checked(unittest.TestCase):
    def check(self, script, file="subsystems/script_player/tests/mission.xml"):
        """Of the test mission with another script."""
        with tempfile.TemporaryDirectory() as folder:
            for name in ("supervisor", "subsystems"):
                shutil.copytree(REPOSITORY / name, pathlib.Path(folder) / name, ignore=shutil.ignore_patterns("*.cpp", "*.hpp"))
            if script is not None:
                (pathlib.Path(folder) / "subsystems/script_player/too_far.script").write_text(script)
            else:
                (pathlib.Path(folder) / "subsystems/script_player/too_far.script").unlink()
            found = subprocess.run([HIROSCO, "check", pathlib.Path(folder) / file], capture_output=True, text=True,
                                   env={**os.environ, "NO_COLOR": "1"}, check=False)
        return found.returncode, found.stdout + found.stderr

    def test_a_script_that_is_right_is_no_problem(self):
        self.assertEqual(self.check("HELLO MOVE_TO 0.5\n")[0], 0)

    def test_each_mistake_is_told_with_its_place(self):
        code, said = self.check("# first\nHELLO MOVE_TO 0.5\nHELLO MOVE_TOO 0.5\n  HELLO MOVE_TO far\nwaits 5 6\nuntil HELLO SPEED > 1 within 2\n")
        self.assertNotEqual(code, 0)
        for place in ("too_far.script:3:7: error: E0421: 'PLAYER' may not ask HELLO for 'MOVE_TOO'", "did you mean 'MOVE_TO'?",
                      "too_far.script:4:17: error: E0421: 'far' is no GOAL, which may be -3.2..3.2 rad", "MOVE_TO GOAL[-3.2..3.2 rad]",
                      "too_far.script:5:1: error: E0421: 'PLAYER' commands no subsystem 'waits'",
                      "too_far.script:6:13: error: E0421: 'PLAYER' may not read 'SPEED' of HELLO"):
            self.assertIn(place, said)

    def test_a_line_that_is_none_and_a_file_that_is_not_there(self):
        code, said = self.check("wait long\n")
        self.assertNotEqual(code, 0)
        self.assertIn("too_far.script:1:6: error: E0420: 'long' are no seconds", said)
        code, said = self.check(None)
        self.assertNotEqual(code, 0)
        self.assertIn("E0422: script 'TOO_FAR'", said)

    def test_a_descriptor_alone_is_checked_by_names(self):
        code, said = self.check("HELLO MOVE_TO far\n", "subsystems/script_player/script_player.xml")
        self.assertEqual(code, 0, said)
        code, said = self.check("HELLO MOVE_TOO 1\n", "subsystems/script_player/script_player.xml")
        self.assertIn("too_far.script:1:7: error: E0421", said)
        self.assertNotEqual(code, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
