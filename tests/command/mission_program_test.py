# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a mission does by a program of its own, `hirosco` finds by the mission's name; and which mission is meant where none is named."""

import os
import pathlib
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"
HELLO = REPOSITORY / "missions/hello"


class MissionProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hirosco-program-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def hirosco(self, *words, folder=REPOSITORY):
        done = subprocess.run([HIROSCO, *words], capture_output=True, text=True, check=False, cwd=folder,
                              env={**os.environ, "NO_COLOR": "1", "PATH": f"{self.folder}:{os.environ['PATH']}"})
        return done.returncode, done.stdout, done.stderr

    def write_program(self, name, text):
        program = self.folder / name
        program.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        program.chmod(0o755)

    def test_a_mission_without_one_says_so_in_words(self):
        code, told, errors = self.hirosco("report", "hello")
        self.assertEqual((code, told), (1, ""))
        self.assertIn("mission HELLO has nothing of this kind: no program hirosco-mission-hello", errors)

    def test_it_gets_the_command_the_mission_and_the_rest_of_the_line_as_it_is(self):
        self.write_program("hirosco-mission-hello", 'for word; do echo "[$word]"; done; exit 7')
        code, told, errors = self.hirosco("report", str(HELLO), "--only", "A B", "--help", "", "-x=-1")
        self.assertEqual((code, errors), (7, ""))
        self.assertEqual(told.splitlines(), ["[report]", f"[{HELLO / 'mission.xml'}]", "[--only]", "[A B]", "[--help]", "[]", "[-x=-1]"])

    def test_its_name_is_the_missions_in_small_letters(self):
        text = (HELLO / "mission.xml").read_text(encoding="utf-8").replace('name="HELLO"', 'name="FIRST_LIGHT"')
        (self.folder / "mission.xml").write_text(text.replace("../../", "@hirosco/"), encoding="utf-8")
        self.write_program("hirosco-mission-first-light", "echo found")
        self.assertEqual(self.hirosco("report", str(self.folder))[:2], (0, "found\n"))

    def test_one_that_cannot_be_started_is_said(self):
        self.write_program("hirosco-mission-hello", "")
        (self.folder / "hirosco-mission-hello").write_bytes(b"\x7fELF nothing")
        code, _, errors = self.hirosco("report", "hello")
        self.assertEqual(code, 3)
        self.assertIn("hirosco-mission-hello", errors)

    def test_what_is_no_mission_and_no_mission_at_all_are_refused(self):
        self.assertEqual(self.hirosco("report", "nowhere")[0], 1)
        self.assertEqual(self.hirosco("report")[0], 2)
        self.assertEqual(self.hirosco("report", "--only", "RO1", "rokviss")[0], 2)

    def test_the_usual_mission_is_the_one_that_missions_say(self):
        missions = self.folder / "missions"
        missions.mkdir()
        (missions / "usual").write_text("# a remark\nnobody\n", encoding="utf-8")
        self.assertIn("no mission 'nobody'", self.hirosco("why", "--archive", "none", folder=self.folder)[2])


if __name__ == "__main__":
    unittest.main()
