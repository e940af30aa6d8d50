#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""README's first command builds what flies, which it compiles in other pieces than `./check` does: what a compiler says of one it does
not say of the other. Nothing is flown here."""
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class FirstCommand(unittest.TestCase):
    def test_it_builds_and_knows_its_options(self):
        # What the processors have left over: flights come before.
        done = subprocess.run(["chrt", "--idle", "0", ROOT / "run", "--help"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-8000:])
        self.assertIn("--for", done.stdout)


if __name__ == "__main__":
    unittest.main()
