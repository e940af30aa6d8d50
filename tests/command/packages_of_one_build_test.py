# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Packages are made of one build: `tools/packages/build --from` refuses a folder that was built again in part, by the interface marks of what it
installs, and says which files have which. No package is made here."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
OLD, NEW = "0.1.0 interface 0123456789ab", "0.1.0 interface ba9876543210"
USED = ("awk", "bash", "cmake", "dirname", "grep", "mktemp", "paste", "rm", "sed", "sort", "wc")


class OneBuild(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="hirosco-one-build-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        self.built, self.path = self.folder / "built", self.folder / "path"
        # Whoever gets as far as to making packages ends there: there is no dpkg-buildpackage.
        self.path.mkdir()
        for name in USED:
            (self.path / name).symlink_to(shutil.which(name))

    def plant(self, program, library, module, beside=OLD):
        """A build folder whose parts have these marks; `beside` is of a test that nobody installs."""
        shutil.rmtree(self.built, ignore_errors=True)
        self.built.mkdir()
        rules = []
        for name, where, component, mark in (("hirosco", "bin", "Unspecified", program), ("libhirosco_utilities.a", "lib/hirosco", "Unspecified", library),
                                             ("hirosco-sim-mujoco.so", "lib/hirosco", "mujoco", module), ("lamp_test", None, None, beside)):
            (self.built / name).write_bytes(b"\x7fELF\0" + mark.encode() + b"\0")
            if where:
                rules.append(f'if(CMAKE_INSTALL_COMPONENT STREQUAL "{component}")\n'
                             f'  file(INSTALL DESTINATION "${{CMAKE_INSTALL_PREFIX}}/{where}" TYPE FILE FILES "{self.built / name}")\nendif()\n')
        (self.built / "cmake_install.cmake").write_text("".join(rules))

    def build(self):
        done = subprocess.run([REPOSITORY / "tools/packages/build", "--from", self.built, "--to", self.folder / "packages"], capture_output=True,
                              text=True, check=False, env={"PATH": str(self.path)})
        return done.returncode, done.stdout + done.stderr

    def test_a_folder_that_was_built_again_in_part_is_refused_and_its_parts_are_named(self):
        for marks, old, new in (((OLD, NEW, OLD), "hirosco hirosco-sim-mujoco.so", "libhirosco_utilities.a"),
                                ((OLD, OLD, NEW), "hirosco libhirosco_utilities.a", "hirosco-sim-mujoco.so")):
            self.plant(*marks)
            code, told = self.build()
            self.assertEqual(code, 1, told)
            self.assertIn(f"  {OLD}: {old}\n  {NEW}: {new}\n", told)
            self.assertIn(f"build it whole: cmake --build {self.built} --target flown", told)
        self.assertFalse((self.folder / "packages").exists())

    def test_one_that_was_built_whole_is_taken_whatever_its_tests_are_of(self):
        self.plant(NEW, NEW, NEW)
        code, told = self.build()
        self.assertEqual(code, 3, told)
        self.assertIn("packages: no dpkg-buildpackage", told)

    def test_one_that_lacks_a_part_is_refused(self):
        self.plant(NEW, NEW, NEW)
        (self.built / "libhirosco_utilities.a").unlink()
        code, told = self.build()
        self.assertEqual(code, 1, told)
        self.assertIn("build it whole", told)

    def test_the_mark_is_what_the_packages_are_named_by(self):
        self.plant(NEW, NEW, NEW, beside=NEW)
        asked = [REPOSITORY / "tools/packages/interface_mark", self.built]
        self.assertEqual(subprocess.run(asked, capture_output=True, text=True, check=True).stdout, NEW.split()[-1] + "\n")
        shutil.rmtree(self.built)
        self.built.mkdir()
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("has an interface mark", done.stderr)


if __name__ == "__main__":
    unittest.main()
