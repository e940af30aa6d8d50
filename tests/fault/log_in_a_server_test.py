#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A log in a PostgreSQL server that is frozen and killed: nothing of it is lost or there twice, and it holds up no stop."""
import os
import pathlib
import pwd
import signal
import subprocess
import tempfile
import time
import unittest

import flight
import floods

PROGRAMS = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"))


class Server:
    """`with Server() as server:` — a PostgreSQL server of its own, not root's, which it refuses."""

    def __enter__(self):
        self.programs = PROGRAMS[-1].parent
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-postgresql-"))
        self.user = "nobody" if os.geteuid() == 0 else None
        if self.user:
            os.chown(self.folder, pwd.getpwnam(self.user).pw_uid, -1)
        self._do("initdb", "--no-sync", "--auth=trust", "--username=hirosco", "--no-locale", "--encoding=UTF8",
                 f"--pgdata={self.folder}/data")
        self.start()
        return self

    def __exit__(self, *_):
        self.signal(signal.SIGCONT)
        self.process.send_signal(signal.SIGINT)
        self.process.wait(30.0)
        subprocess.run(["rm", "-rf", str(self.folder)], check=False)

    def connection(self):
        return f"host={self.folder} user=hirosco dbname=postgres"

    def start(self):
        self.process = subprocess.Popen(
            [self.programs / "postgres", "-D", self.folder / "data", "-k", self.folder, "-c", "listen_addresses="],
            user=self.user, group=None, extra_groups=[] if self.user else None, cwd=self.folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 30.0
        while subprocess.run([self.programs / "psql", "-X", "-d", self.connection(), "-c", "SELECT 1"], capture_output=True,
                             check=False).returncode != 0:
            if time.monotonic() > end:
                raise RuntimeError("the PostgreSQL server does not begin")
            time.sleep(0.1)

    def signal(self, number):
        """To every process of it: its first one is still before the others are looked for, or it might begin one meanwhile."""
        pid = self.process.pid
        os.kill(pid, signal.SIGSTOP)
        while pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "TZX":
            time.sleep(0.001)
        children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        for each in [pid, *map(int, children)]:
            os.kill(each, number)

    def kill(self):
        self.signal(signal.SIGKILL)
        self.process.wait(10.0)

    def _do(self, program, *words):
        subprocess.run([self.programs / program, *words], user=self.user, extra_groups=[] if self.user else None, cwd=self.folder,
                       check=True, capture_output=True)


class LogInAServer(unittest.TestCase):
    def test_a_server_that_freezes_and_dies_loses_nothing_and_holds_up_no_stop(self):
        with Server() as server, flight.MissionCopy({"log/rokviss.db": f'log/rokviss.db" server="{server.connection()}'}) as mission, \
             flight.Flight(mission) as craft:
            craft.wait_commissioned()
            self.assertEqual(craft.tc("supervisor", "SET_DATABASE", "postgresql")[0], 0)
            floods.flood(500)
            server.signal(signal.SIGSTOP)
            begin = craft.count()
            craft.wait_told("SUPERVISOR medium LOG_STORE", 10.0, begin)
            code, reports = craft.tc("supervisor", "SAFE_ALL")
            self.assertEqual((code, reports[-1:]), (0, ["1,7"]), reports)
            server.signal(signal.SIGCONT)
            craft.wait_told("log storage works", 20.0, begin)
            died = craft.count()
            server.kill()
            craft.wait_told("log storage fails", 10.0, died)
            # Out of a dead server, and back when it lives.
            again = craft.count()
            self.assertEqual(craft.tc("supervisor", "SET_DATABASE", "sqlite")[0], 0)
            craft.wait_told("log storage works", 20.0, again)
            server.start()
            self.assertEqual(craft.tc("supervisor", "SET_DATABASE", "postgresql")[0], 0)
            floods.flood(500)
            self.assertEqual(craft.tc("supervisor", "ping")[0], 0)
            self.assertEqual(craft.end(seconds=30.0), 0, craft.errors)
            floods.assert_continuous(self, craft.log(), 1)


if __name__ == "__main__":
    if not PROGRAMS:
        flight.skip("no-postgresql")
    flight.main()
