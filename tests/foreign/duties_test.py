# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The duties that docs/interfaces/subsystem.md names are those that the suite judges, and the other way round."""
import pathlib
import re
import subprocess
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


class Duties(unittest.TestCase):
    def test_the_page_and_the_suite_name_the_same(self):
        page = (REPOSITORY / "docs/interfaces/subsystem.md").read_text().partition("<!-- duties -->")[2]
        named = re.findall(r"^\| ([a-z]+\.[a-z]+) \|", page, re.M)
        listed = subprocess.run([REPOSITORY / "tools/conform/conform", "--list"], capture_output=True, text=True, check=True).stdout.split()
        self.assertTrue(named)
        self.assertEqual(sorted(named), sorted(listed))


if __name__ == "__main__":
    unittest.main()
