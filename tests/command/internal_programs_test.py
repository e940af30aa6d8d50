# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A program that other programs start refuses what it does not know, in one line: its name, what, what there is, who starts it. A simulated
device, which may be begun by hand, too, has --help for that."""
import os
import pathlib
import subprocess
import tempfile
import unittest

BINARIES = pathlib.Path(os.environ["HIROSCO_BIN"])
FLIGHT = "--mission FILE, --log FILE, --runtime FOLDER, --mode NAME, --json, --quiet, --own-users, --screen DESCRIPTOR (started by 'hirosco run MISSION')"
# Of each: an option with a value, one that is nearly an option of it and which, what there is and who starts it.
PROGRAMS = {
    "hirosco-supervisor": ("--mission", "FILE", "--quite", "--quiet", FLIGHT),
    "hirosco-threads": ("--screen", "DESCRIPTOR", "--runtme", "--runtime", FLIGHT),
    "hirosco-ground": ("--archive", "FILE", "--jsn", "--json",
                       "--mission FILE, --archive FILE, --telemetry ADDRESS:PORT, --devices FOLDER, --port N, --page FOLDER, --child, --json, --quiet, --tour, --why, --flown NANOSECONDS, --md, --openapi "
                       "(started by 'hirosco ground', 'hirosco why' and 'hirosco run')"),
    "hirosco-screen": ("--log", "FILE", "--keper", "--keeper", "--keeper PID, --log FILE (started by 'hirosco run MISSION' on a terminal)"),
    "hirosco-hello": ("--set", "PARAMETER=VALUES", "--adress", "--address",
                      "--descriptor FILE, --channel FD, --vital FD, --permit FD, --text FD, --core NUMBER, --as NAME:ID, --set PARAMETER=VALUES, --address DEVICE=ADDRESS, "
                      "--enable DEVICE=ADDRESS, --power DEVICE=ADDRESS, --fall-back DEVICE=ADDRESS=ADDRESS, --setting DEVICE:NAME=VALUE, --commands NAME=ID:FILE, --subscribes NAME=ID:FILE (the supervisor passes them: hirosco run MISSION)"),
}


# All that this build has: those of tests, too.
DEVICES = sorted(file.name for file in BINARIES.glob("hirosco-sim-*") if file.suffix != ".so")


class InternalPrograms(unittest.TestCase):
    def told_by(self, program, *words):
        """Its exit code and what it told, of which its name is in front; it has begun nothing."""
        with tempfile.TemporaryDirectory(prefix="hirosco-internal-") as folder:
            done = subprocess.run([BINARIES / program, *words], cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                                  env={**os.environ, "XDG_RUNTIME_DIR": folder})
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [], "who is refused begins nothing")
        self.assertEqual(done.stdout, "", (program, words))
        name, _, told = done.stderr.partition(": ")
        self.assertEqual(pathlib.Path(name).name, program, (words, done.stderr))
        return done.returncode, told

    def refused(self, program, what, there_are, *words):
        self.assertEqual(self.told_by(program, *words), (2, f"{what}; there are: {there_are}\n"), (program, words))

    def test_no_simulated_device_begins_with_what_it_does_not_know(self):
        self.assertTrue(DEVICES)
        address = ("--address", "nowhere", "--transfer", "unix")
        for device in DEVICES:
            for words, names in (((*address, "--bogus"), "--bogus"), ((*address, "--adress", "x"), "--adress"), ((*address, "more"), "more"),
                                 ((*address, "--control"), "--control"), ((*address, "--seed", "x"), "--seed"), ((), "--address"),
                                 ((*address, "--beside", *address, "--bogus"), "--bogus")):
                with self.subTest(device, words=words):
                    code, told = self.told_by(device, *words)
                    self.assertGreater(code, 2, told)
                    self.assertIn(names, told)
                    self.assertTrue(told.endswith("; --help tells what there is\n") and told.count("\n") == 1, told)

    def test_what_they_do_not_know_is_refused(self):
        for program, (option, value, near, meant, there_are) in PROGRAMS.items():
            if not (BINARIES / program).exists():
                self.assertEqual(program, "hirosco-ground", "it alone may be left out of a build")
                continue
            with self.subTest(program):
                self.refused(program, "no option '--bogus'", there_are, "--bogus")
                self.refused(program, "no option '--bogus'", there_are, option, "something", "--bogus", "x")
                self.refused(program, f"no option '{near}'; did you mean '{meant}'?", there_are, near)
                self.refused(program, f"{option} without its {value}", there_are, option)
                self.refused(program, f"{option} without its {value}", there_are, option, option, "something")
                self.refused(program, "'more' belongs to no option", there_are, option, "something", "more")


if __name__ == "__main__":
    unittest.main()
