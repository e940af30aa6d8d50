# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco manifest` writes what sha256sum reads, and what is here is held against it before a flight (docs/adr/0089)."""

import hashlib
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ["HIROSCO_BIN"])
PROGRAMS = ("hirosco-communication", "hirosco-hello")


class Manifest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-manifest-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("missions/hello", "subsystems/hello", "subsystems/communication", "supervisor"):
            for file in (REPOSITORY / name).glob("*.xml"):
                copy = self.folder / file.relative_to(REPOSITORY)
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(file.read_text())
        self.mission = self.folder / "missions/hello/mission.xml"
        self.manifest = self.mission.parent / "manifest.sha256"

    def name_manifest(self):
        text = self.mission.read_text()
        self.mission.write_text(text.replace("<Modes", '<Manifest path="manifest.sha256"/>\n  <Modes', 1))

    def hirosco(self, *words):
        done = subprocess.run([BINARIES / "hirosco", *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                              check=False, env={**os.environ, "NO_COLOR": "1"})
        return done.returncode, done.stdout + done.stderr

    def lines(self):
        return dict(reversed(line.split("  ")) for line in self.manifest.read_text().splitlines())

    def test_it_prints_what_the_operators_tool_prints(self):
        code, told = self.hirosco("manifest", self.mission)
        self.assertEqual(code, 0, told)
        tool = subprocess.run(["sha256sum", *PROGRAMS], cwd=BINARIES, capture_output=True, text=True, check=True).stdout
        self.assertEqual(told, tool)
        code, told = self.hirosco("manifest", self.mission, "--write")
        self.assertEqual(code, 2, told)
        self.assertIn('put <Manifest path="manifest.sha256"/> into it', told)

    def test_what_it_writes_the_operators_tool_checks_and_a_flight_takes(self):
        self.name_manifest()
        code, told = self.hirosco("check", self.mission)
        self.assertEqual(code, 1, told)
        self.assertIn("does not exist", told)
        self.assertIn("E0360", self.hirosco("check", "--json", self.mission)[1])
        code, told = self.hirosco("manifest", self.mission, "--write")
        self.assertEqual((code, told), (0, f"{self.manifest}: 2 executables\n"))
        subprocess.run(["sha256sum", "--check", "--strict", self.manifest], cwd=BINARIES, capture_output=True, check=True)
        self.assertEqual(self.lines(), {name: hashlib.sha256((BINARIES / name).read_bytes()).hexdigest() for name in PROGRAMS})
        self.assertEqual(self.hirosco("check", "--fly", self.mission)[0], 0)
        self.assertIn(f"executable hirosco-hello: SHA-256 {self.lines()['hirosco-hello']}",
                      self.hirosco("check", "--show", self.mission)[1])

    def test_what_differs_or_is_not_listed_is_a_warning_until_it_is_to_fly(self):
        self.name_manifest()
        digest = hashlib.sha256((BINARIES / "hirosco-hello").read_bytes()).hexdigest()
        self.manifest.write_text("0" * 64 + "  hirosco-hello\n")
        code, told = self.hirosco("check", self.mission)
        self.assertEqual(code, 0, told)
        self.assertIn("2 warnings", told)
        code, told = self.hirosco("check", "--fly", self.mission)
        self.assertEqual(code, 1, told)
        self.assertIn("hirosco-communication of subsystem COMMUNICATION is not in the manifest", told)
        self.assertIn(f"has the SHA-256 {digest}, the manifest says {'0' * 64}", told)
        code, told = self.hirosco("run", self.mission, "--no-ground", "--for", "1s")
        self.assertEqual(code, 3, told)
        self.assertIn("E0365", self.hirosco("check", "--fly", "--json", self.mission)[1])
        self.assertEqual(self.hirosco("manifest", self.mission, "--write")[0], 0)
        self.assertEqual(self.hirosco("check", "--fly", self.mission)[0], 0)


if __name__ == "__main__":
    unittest.main()
