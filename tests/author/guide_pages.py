# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Pages of docs/guide that are typed: each block behind `<!-- typed -->` is typed as it stands, page by page in a folder of its own, by whoever has the
installed tree and nothing else; one behind `<!-- edit: FILE behind LINE -->` is put into that file. What is quoted of files in them tools/check_quotes.py
holds to these files."""
import os
import re
import unittest

import flight
import outside

GUIDE = flight.REPOSITORY / "docs/guide"
TYPED = re.compile(r"^<!-- typed -->\n+```\n(.*?)^```$", re.M | re.S)
STEP = re.compile(r"^<!-- (typed|edit: (\S+) (?:at its end|behind ([^\n]*))) -->\n```\w*\n(.*?)^```$", re.M | re.S)


class Guide(outside.Installed, unittest.TestCase):
    def typed(self, page):
        blocks = TYPED.findall((GUIDE / page).read_text())
        self.assertTrue(blocks, f"{page} has nothing to type")
        at = self.folder / f"typed_{page.removesuffix('.md')}"
        at.mkdir()
        lines = "".join(blocks).replace("/usr/share/doc/hirosco", str(self.prefix / "share/doc/hirosco"))
        return self.bash(lines, at)

    def bash(self, lines, at):
        return self.said("bash", "-euo", "pipefail", "-c", lines, at=at, environment={
            "PATH": f"{self.prefix}/bin:{os.environ['PATH']}", "CMAKE_PREFIX_PATH": str(self.prefix), "CMAKE_GENERATOR": "Ninja"})

    def edit(self, file, behind, block):
        """As a reader does: behind the one line that has this, or at the end."""
        lines = file.read_text().splitlines(keepends=True)
        places = [i for i, line in enumerate(lines) if behind in line] if behind else [len(lines) - 1]
        self.assertEqual(len(places), 1, f"{file.name}: one line has {behind}")
        file.write_text("".join([*lines[:places[0] + 1], block if behind else f"\n{block}", *lines[places[0] + 1:]]))

    def test_the_subsystem_of_ten_minutes_is_made_step_by_step_and_passes_its_tests(self):
        page = (GUIDE / "first_subsystem.md").read_text()
        self.assertLessEqual(len(page.splitlines()), 80, "it is read in ten minutes")
        steps = STEP.findall(page)
        self.assertEqual(2 * len(steps), len(re.findall(r"^```", page, re.M)), "each block is a step of it")
        at, told = self.folder / "ten_minutes", ""
        at.mkdir()
        for kind, file, behind, block in steps:
            if kind == "typed":
                told = self.bash(block, at)
                at = at / "heater" if (at / "heater").is_dir() else at
            else:
                self.edit(at / file, behind, block)
        self.assertIn("100% tests passed, 0 tests failed out of 3", told)
        tests = self.said(at / "build/heater_test", at=at)
        self.assertRegex(tests, r"\[  PASSED  \] 2 tests")

    def test_the_mission_of_your_mission_is_checked_tested_and_simulated_as_its_page_types(self):
        told = self.typed("your_mission.md")
        self.assertIn("no problem", told)
        self.assertIn("100% tests passed, 0 tests failed out of 4", told)
        self.assertRegex(told, r"plan network-down: network \{")
        self.assertIn("mode alone", told)

    def test_the_project_of_your_project_passes_its_own_check(self):
        told = self.typed("your_project.md")
        self.assertIn("100% tests passed, 0 tests failed out of 3", told)
        self.assertEqual(told.count("no problem"), 3, "each of its missions")
