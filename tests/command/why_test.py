#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco why` where the newest flight has no archive (--no-ground): it says of which flight its story is, and that the mission has flown since. The log
is one that a flight wrote (log_of_0_1_0/), the archive that of another day."""
import os, pathlib, shutil, sqlite3, subprocess, tempfile, unittest

HERE = pathlib.Path(__file__).resolve().parent
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"
SECOND = 10**9


@unittest.skipUnless((HIROSCO.parent / "hirosco-ground").exists(), "this build has no ground station")
class Why(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="hirosco-why-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        (self.folder / "log").mkdir()
        self.log, self.archive = self.folder / "log/hello.db", self.folder / "log/hello-ground.db"
        shutil.copy(HERE / "log_of_0_1_0/database.sqlite", self.log)
        with sqlite3.connect(f"file:{self.log}?immutable=1", uri=True) as log:
            (self.began,) = log.execute("SELECT max(run) FROM log").fetchone()
        self.archive.touch()

    def why(self, *words):
        done = subprocess.run([HIROSCO, "why", "hello", *words], cwd=self.folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "NO_COLOR": "1", "XDG_RUNTIME_DIR": str(self.folder)})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, done.stderr

    def kept(self, table, **columns):
        with sqlite3.connect(self.archive) as archive:
            archive.execute(f"INSERT INTO {table}({','.join(columns)}) VALUES ({','.join('?' * len(columns))})", list(columns.values()))

    def packet(self, t):
        self.kept("packets", t=t, apid=1, service=17, subtype=2, sid=0, octets=b"")

    def test_an_older_story_says_so_first_and_one_of_the_newest_flight_says_its_beginning(self):
        since = "HELLO has flown since, from "
        told, _ = self.why()
        self.assertRegex(told, f"^{since}.* UTC on, and no ground station kept that flight: .*hirosco log --last 60.*\n\nnothing has stopped")
        # A flight an hour before it, which something stopped.
        hour = self.began - 3600 * SECOND
        self.kept("marks", t=hour, kind="flight", name="1", action="began", who="", note="", until=0)
        self.kept("events", t=hour + 60 * SECOND, apid=7, subsystem="HELLO", event=9, name="BROKEN", severity=3, text="", vals="{}")
        self.packet(hour + 60 * SECOND)
        told, _ = self.why()
        self.assertRegex(told, f"^{since}.*\n\nflight of HELLO that began .*:.* UTC\nHELLO, ")
        self.assertIn("HELLO: broken", told)
        told, errors = self.why("--json")
        self.assertTrue(told.startswith("{"), "programs read it")
        self.assertIn(since, errors)
        # And one of the newest flight, which its station kept.
        self.packet(self.began + SECOND)
        told, errors = self.why()
        self.assertRegex(told, "^flight of HELLO that began ")
        self.assertNotIn("since", told + errors)


if __name__ == "__main__":
    unittest.main()
