# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The Debian packages of this build: made by the one command, which ends with lintian; what is in which, and what they depend on.
`tools/packages/try` installs, uses, upgrades and purges them on a bare Debian."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["HIROSCO_BIN"]).parent
NAMES = {"hirosco", "hirosco-ground", "hirosco-world", "hirosco-world-mujoco", "libhirosco-dev", "hirosco-doc"}


def said(*words):
    return subprocess.run([*map(str, words)], capture_output=True, text=True, check=True).stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-packages-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        done = subprocess.run([REPOSITORY / "tools/packages/build", "--from", BUILD, "--to", cls.folder], capture_output=True, text=True,
                              check=False)
        cls.told = done.stdout + done.stderr
        assert done.returncode == 0, cls.told[-4000:]
        cls.packages = {said("dpkg-deb", "-f", file, "Package").strip(): file for file in cls.folder.glob("*.deb")}

    def test_lintian_has_nothing_against_them(self):
        self.assertIn("lintian: no error, no warning", self.told)
        self.assertEqual(set(self.packages), NAMES)

    def test_they_have_the_version_of_the_project(self):
        version = re.search(r"project\(hirosco VERSION (\S+)", (REPOSITORY / "CMakeLists.txt").read_text())[1]
        for name, file in self.packages.items():
            self.assertEqual(said("dpkg-deb", "-f", file, "Version").strip(), version, name)

    def test_each_file_is_in_one_of_them_and_where_it_belongs(self):
        owners = {}
        for name, file in self.packages.items():
            for line in said("dpkg-deb", "-c", file).splitlines():
                path = line.split()[5]
                if not path.endswith("/"):
                    owners.setdefault(path.removeprefix("./"), []).append(name)
        self.assertEqual({path: names for path, names in owners.items() if len(names) > 1}, {})
        for path, name in (("usr/bin/hirosco", "hirosco"), ("usr/lib/hirosco/hirosco-supervisor", "hirosco"),
                           ("usr/share/hirosco/missions/rokviss/mission.xml", "hirosco"), ("usr/share/man/man1/hirosco.1.gz", "hirosco"),
                           ("usr/lib/hirosco/hirosco-ground", "hirosco-ground"), ("usr/share/hirosco/page/index.html", "hirosco-ground"),
                           ("usr/lib/hirosco/hirosco-sim-robot.so", "hirosco-world"), ("usr/lib/hirosco/hirosco-mission-rokviss", "hirosco-world"),
                           ("usr/lib/hirosco/hirosco-sim-mujoco.so", "hirosco-world-mujoco"), ("usr/lib/hirosco/hirosco-robot-cases", "hirosco-world-mujoco"),
                           ("usr/share/hirosco/missions/six_joints/mission.xml", "hirosco-world-mujoco"),
                           ("usr/lib/cmake/hirosco/hirosco-config.cmake", "libhirosco-dev"),
                           ("usr/share/hirosco/templates/robot/mission.xml", "hirosco")):
            self.assertEqual(owners.get(path), [name], path)
        self.assertEqual([path for path in owners if "libmujoco" in path], [], "it is fetched")
        # That nothing which is installed is in none of them dh_missing sees.

    def test_what_they_depend_on_is_what_they_are_linked_with(self):
        depends = said("dpkg-deb", "-f", self.packages["hirosco"], "Depends")
        # With a least version or without one.
        names = {each.split()[0] for each in depends.split(", ")}
        self.assertLessEqual({"libc6", "libstdc++6", "libexpat1", "libfmt9", "libsqlite3-0", "libnettle8"}, names)
        self.assertNotIn("libpq", depends, "loaded only where a mission names a server")
        self.assertNotRegex(depends, r"\$\{")

    def test_those_of_two_builds_are_not_installed_beside_each_other(self):
        mark = re.search(rb" interface ([0-9a-f]{12})", (BUILD / "bin/hirosco").read_bytes())[1].decode()
        for field in ("Provides", "Conflicts"):
            self.assertEqual(said("dpkg-deb", "-f", self.packages["hirosco"], field).strip(), f"hirosco-interface-{mark}", field)
        for name in NAMES - {"hirosco", "hirosco-doc"}:
            depends = said("dpkg-deb", "-f", self.packages[name], "Depends").strip().split(", ")
            self.assertEqual([each for each in depends if "interface" in each], [f"hirosco-interface-{mark}"], name)

    def test_what_needs_the_library_of_mujoco_looks_where_it_is_fetched_to(self):
        unpacked = self.folder / "unpacked_world"
        said("dpkg-deb", "-x", self.packages["hirosco-world-mujoco"], unpacked)
        needing = {file.name: said("objdump", "-p", file) for file in (unpacked / "usr/lib/hirosco").glob("hirosco-*")}
        needing = {name: told for name, told in needing.items() if "NEEDED               libmujoco" in told}
        self.assertGreater(len(needing), 2)
        self.assertEqual([name for name, told in needing.items() if "$ORIGIN/mujoco/lib" not in told], [])

    def test_the_unit_is_one(self):
        unpacked = self.folder / "unpacked"
        said("dpkg-deb", "-x", self.packages["hirosco"], unpacked)
        (unit,) = unpacked.rglob("hirosco@.service")
        if not shutil.which("systemd-analyze"):
            reason = subprocess.run([REPOSITORY / "tools/skip_reason", "no-systemd-analyze"], capture_output=True, text=True, check=False)
            self.assertEqual(reason.returncode, 77, reason.stderr)
            self.skipTest(reason.stdout)
        # It looks for the program where it will be installed.
        tried = self.folder / "hirosco@rokviss.service"
        tried.write_text(unit.read_text().replace("/usr/bin/hirosco", str(BUILD / "bin/hirosco")))
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", tried], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))


if __name__ == "__main__":
    for tool, reason in (("dh", "no-debhelper"), ("lintian", "no-lintian")):
        if not shutil.which(tool):
            sys.exit(subprocess.run([REPOSITORY / "tools/skip_reason", reason], check=False).returncode)
    if not (BUILD / "bin/hirosco-sim-mujoco").exists():
        sys.exit(subprocess.run([REPOSITORY / "tools/skip_reason", "no-mujoco", REPOSITORY / "build/mujoco"], check=False).returncode)
    unittest.main()
