# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco doctor` on the computer that it stands on: what it says is what the system says to somebody else, what it gives to type
mends what it found, and its exit code is that of its rows."""
import functools
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import unittest

import ordinary_user

HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"
NOBODY = 65534
AS_NOBODY = ("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", "--bounding-set=-all", "--inh-caps=-all")


class Doctor(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hirosco-doctor-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.folder.chmod(0o777)

    def looked(self, *words, before=(), program=HIROSCO, **environment):
        """The rows by their names, and the exit code."""
        done = subprocess.run([*before, program, "doctor", *words, "--json"], cwd=self.folder, capture_output=True, text=True,
                              check=False, env={**os.environ, "XDG_RUNTIME_DIR": str(self.folder), **environment})
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertGreater(len(rows), 10, done.stderr)
        self.assertEqual(done.returncode, 1 if "missing" in [row["verdict"] for row in rows] else 0)
        return {row["row"]: row for row in rows}

    def test_what_is_free_and_what_is_taken(self):
        free = self.looked("rokviss")["ground link"]
        with socket.socket() as taken:
            taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                taken.bind(("127.0.0.1", 10025))
                taken.listen()
            except OSError:
                pass  # somebody flies, so it is taken as well
            else:
                self.assertEqual(free["verdict"], "ok")
            told = self.looked("rokviss")["ground link"]
            self.assertEqual(told["verdict"], "missing")
            self.assertIn("127.0.0.1:10025", told["found"])

    def test_of_the_kernel_it_says_what_the_kernel_says(self):
        told = self.looked("rokviss")
        self.assertIn(os.uname().release, told["kernel"]["found"])
        self.assertIn(pathlib.Path("/sys/devices/system/clocksource/clocksource0/current_clocksource").read_text().strip(),
                      told["clock"]["found"])
        self.assertIn(f"{len(os.sched_getaffinity(0))}" if len(os.sched_getaffinity(0)) > 1 else "one", told["processors"]["found"])
        self.assertIn("200 sleeps", told["wake-up"]["found"])

    def test_what_it_is_made_of_is_told_and_a_module_that_is_none_is_seen(self):
        told = self.looked("rokviss")
        self.assertIn("interface", told["versions"]["found"])
        self.assertRegex(told["libraries"]["found"], r"libc\.so")
        self.assertRegex(told["python"]["found"], r"^python3")
        source = pathlib.Path(__file__).resolve().parents[2] / "missions/hello/mission.xml"
        mission = self.folder / "mission.xml"
        mission.write_text(source.read_text().replace('descriptor="../../', 'descriptor="@hirosco/').replace('"hirosco-hello"', '"old-hello"'))
        for name in ("old-hello", "old-hello.so"):
            (self.folder / name).write_text("#!/bin/sh\n")
            (self.folder / name).chmod(0o755)
        told = self.looked(str(mission), PATH=f"{self.folder}:{os.environ['PATH']}")["versions"]
        self.assertEqual(told["verdict"], "missing")
        self.assertIn("old-hello.so: it is no shared object", told["found"])
        self.assertIn("cmake --build", told["mends"])

    def test_a_development_library_of_another_build_is_seen(self):
        version = subprocess.run([HIROSCO, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
        mission = pathlib.Path(__file__).resolve().parents[2] / "missions/hello/mission.xml"
        for place in ("bin", "lib/hirosco"):
            (self.folder / place).mkdir(parents=True)
        shutil.copy2(HIROSCO, self.folder / "bin")
        own = re.search(rb"[0-9.]+ interface [0-9a-f]{12}", HIROSCO.read_bytes())[0]
        for place in ("bin", "lib/hirosco"):
            library = self.folder / place / "libhirosco_utilities.a"
            for mark, verdict in ((own, "ok"), (f"{version} interface 0123456789ab".encode(), "worth knowing")):
                library.write_bytes(b"!<arch>\nan interface of \0" + mark + b"\0")
                told = self.looked(str(mission), program=self.folder / "bin/hirosco")["versions"]
                self.assertEqual(told["verdict"], verdict, told)
                if mark != own:
                    self.assertIn(f"{library} is of another build, {mark.decode()}", told["found"])
                    self.assertIn("sudo apt install ./*hirosco*.deb", told["mends"])
            library.unlink()

    def test_a_sandbox_that_is_off_is_seen(self):
        self.assertIn("HIROSCO_SANDBOX is off", self.looked("rokviss", HIROSCO_SANDBOX="off")["isolation"]["found"])

    def test_a_folder_that_nobody_may_write_is_seen(self):
        # Root may write everywhere: a file system may not.
        told = self.looked("rokviss", XDG_RUNTIME_DIR="/proc")["folders"]
        self.assertEqual(told["verdict"], "missing")
        self.assertIn("/proc: ", told["found"])

    def test_a_mission_whose_programs_are_not_here(self):
        source = pathlib.Path(__file__).resolve().parents[2] / "missions/hello/mission.xml"
        text = re.sub(r'<Subsystem executable="(?!hirosco-communication)[^"]*"', '<Subsystem executable="nowhere-to-be-found"', source.read_text())
        text = text.replace('descriptor="../../', 'descriptor="@hirosco/')
        mission = self.folder / "mission.xml"
        mission.write_text(text)
        told = self.looked(str(mission))["programs"]
        self.assertEqual(told["verdict"], "missing")
        self.assertIn("E0401 no program nowhere-to-be-found", told["found"])

    @unittest.skipUnless(os.getuid() == 0, "needs root, to become somebody else")
    def test_without_rights_it_names_the_limits_and_with_them_it_is_content(self):
        # Where root's home holds the repository nobody can read it.
        user = self.enterContext(ordinary_user.ordinary_user())
        asked = functools.partial(self.looked, str(user["mission"]), program=user["binaries"] / "hirosco")
        told = asked(before=("prlimit", "--rtprio=0", "--memlock=65536", *AS_NOBODY))
        line = told["real-time rights"]["mends"]
        self.assertEqual(told["real-time rights"]["verdict"], "missing")
        self.assertRegex(line, r"nobody - rtprio \d+")
        self.assertEqual(told["locked memory"]["verdict"], "missing")
        self.assertRegex(told["locked memory"]["mends"], "nobody - memlock unlimited")
        # What pam_limits would do of these lines at the next login; a root that may raise no limit gives the rights themselves.
        wanted = re.search(r"rtprio (\d+)", line)[1]
        limits = ("prlimit", f"--rtprio={wanted}", "--memlock=unlimited", *AS_NOBODY)
        if subprocess.run([*limits, "true"], capture_output=True, check=False).returncode != 0:
            rights = "+sys_nice,+ipc_lock"
            limits = (*AS_NOBODY[:4], f"--inh-caps={rights}", f"--ambient-caps={rights}")
        told = asked(before=limits)
        self.assertEqual((told["real-time rights"]["verdict"], told["locked memory"]["verdict"]), ("ok", "ok"), told)

    def test_in_words_it_gives_the_line_to_type_below_what_it_found(self):
        done = subprocess.run([HIROSCO, "doctor", "rokviss"], cwd=self.folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "XDG_RUNTIME_DIR": "/proc"})
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r"(?m)^missing +folders +/proc: .*\n +for: .*\n +\$ sudo install -d")
        self.assertRegex(done.stdout.splitlines()[-1], r"^hirosco \S+: \d+ missing: ROKVISS does not fly here with its figures$")

    @unittest.skipUnless(os.getuid() == 0, "needs root, to become somebody else")
    def test_who_lacks_rights_alone_flies_and_where_no_mission_was_named_it_is_said_whose_is_judged(self):
        def last(*words):
            done = subprocess.run(["prlimit", "--rtprio=0", "--memlock=65536", *AS_NOBODY, HIROSCO, "doctor", *words], cwd=self.folder, capture_output=True,
                                  text=True, check=False, env={**os.environ, "XDG_RUNTIME_DIR": str(self.folder)})
            return [line[15:31].strip() for line in done.stdout.splitlines() if line.startswith("missing")], done.stdout.splitlines()[-1]
        missing, named = last("hello")
        self.assertIn("real-time rights", missing)
        if sorted(missing) == ["locked memory", "real-time rights"]:  # where somebody flies a port is taken, too
            self.assertRegex(named, r"^hirosco \S+: 2 missing: HELLO flies here, with cycles later than its figures say$")
        else:
            self.assertRegex(named, r": HELLO does not fly here with its figures$")
        self.assertRegex(last()[1], r": ROKVISS .*; no mission was named, of yours says it: hirosco doctor FILE$")


if __name__ == "__main__":
    unittest.main()
