# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Pages of docs/guide that are typed: each block behind `<!-- typed -->` is typed as it stands, page by page in a folder of its own, by whoever has the
installed tree and nothing else. What is quoted of files in them tools/check_quotes.py holds to these files."""
import os
import re
import unittest

import flight
import outside

GUIDE = flight.REPOSITORY / "docs/guide"
TYPED = re.compile(r"^<!-- typed -->\n+```\n(.*?)^```$", re.M | re.S)


class Guide(outside.Installed, unittest.TestCase):
    def typed(self, page):
        blocks = TYPED.findall((GUIDE / page).read_text())
        self.assertTrue(blocks, f"{page} has nothing to type")
        at = self.folder / f"typed_{page.removesuffix('.md')}"
        at.mkdir()
        lines = "".join(blocks).replace("/usr/share/doc/hirosco", str(self.prefix / "share/doc/hirosco"))
        return self.said("bash", "-euo", "pipefail", "-c", lines, at=at, environment={
            "PATH": f"{self.prefix}/bin:{os.environ['PATH']}", "CMAKE_PREFIX_PATH": str(self.prefix), "CMAKE_GENERATOR": "Ninja"})

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
