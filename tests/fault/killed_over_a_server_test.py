#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of a supervisor whose log is in a PostgreSQL server, while a client commands both machines without a pause: at any moment, in a change of the
log's strategy into the server, and while the server stands still with a statement under way. What is promised of telecommands and of the log is what it is
with files (docs/adr/0217, accounts.py). `--kills N`: so many in all, in turn."""
import os
import random
import signal
import subprocess
import sys
import time

import flight
import honest
import stored_log
import witness
from accounts import ADOPTED_S, Accounts
from log_in_a_server_test import PROGRAMS, Server

KILLS = int(sys.argv.pop(sys.argv.index("--kills") + 1)) if "--kills" in sys.argv else 3
if "--kills" in sys.argv:
    sys.argv.remove("--kills")
SEED = 20261130
LIVES_S = 2.2                    # no part of a crash loop (supervisor/keeper/kept.hpp)
SQLITE, POSTGRESQL = 0, 2
# Behind the acceptance of a change of strategy; and of a server, which is long enough for a statement to be under way.
SWITCH_S, STANDS_S = 0.03, 0.3
ROWS = ("COPY (SELECT number, monotonic, kind, lost, CASE kind WHEN 'gap' THEN note ELSE '' END, encode(packet, 'hex') FROM hirosco_log "
        "ORDER BY run, number) TO STDOUT")


class KilledOverAServer(Accounts):
    def test_nothing_that_is_promised_is_lost(self):
        self.draw, self.deaths, self.took = random.Random(SEED), [], []
        strokes = (self.while_the_server_stands_still, self.at_any_moment, self.in_a_change_into_the_server)
        with Server() as self.server, flight.MissionCopy({"log/rokviss.db": f'log/rokviss.db" server="{self.server.connection()}'}) as mission, \
             flight.Flight(mission) as self.craft:
            self.craft.wait_commissioned()
            before = self.craft.log(last=1)[-1]["number"]
            self.ground = witness.Witness()
            self.client = witness.Client(self.ground)
            self.into(POSTGRESQL)
            try:
                for number in range(KILLS):
                    time.sleep(LIVES_S + self.draw.uniform(0.0, 0.3))
                    strokes[number % len(strokes)]()
                time.sleep(LIVES_S)
            finally:
                self.client.ending = True
                self.client.thread.join()
            sent = list(self.client.sent)
            for packet, _ in sent[-200:]:
                self.ground.verdict(packet, 5.0)
            flight.measure(f"{len(self.deaths)} kills over a server, {len(sent)} telecommands, another one went on after {max(self.took):.3f} s at most")
            self.compare(self.craft, self.ground, sent, self.deaths, len(self.deaths) // 50 + 1, before)
            self.assertEqual(self.craft.end(seconds=30.0), 0, self.craft.errors)

    def stored(self, craft):
        """What is in the server beside what is in files, each number where it was stored first."""
        return sorted([*super().stored(craft), *self.in_the_server()], key=lambda record: record.number)

    def in_the_server(self):
        asked = [self.server.programs / "psql", "-X", "-q", "-d", self.server.connection(), "-c", ROWS]
        done = subprocess.run(asked, capture_output=True, check=True, text=True)
        for line in done.stdout.splitlines():
            number, at, kind, lost, note, packet = line.split("\t")
            yield stored_log.Record(int(number), int(at) / 1e9, kind, int(lost), note, bytes.fromhex(packet))

    def struck(self):
        begin = self.craft.count()
        lost = self.craft.kill("hirosco-supervisor")
        told = self.craft.wait_told("goes on with MANIPULATOR", 5.0, begin)
        self.deaths.append((lost, told.received))
        self.took.append(told.received - lost)
        self.assertLess(self.took[-1], ADOPTED_S, f"kill {len(self.deaths)}")

    at_any_moment = struck

    def while_the_server_stands_still(self):
        """What is in its sockets then it carries out when it goes on, for a client that is gone."""
        self.server.signal(signal.SIGSTOP)
        try:
            time.sleep(self.draw.uniform(0.0, STANDS_S))
            self.struck()
            time.sleep(STANDS_S)
        finally:
            self.server.signal(signal.SIGCONT)

    def in_a_change_into_the_server(self):
        self.into(SQLITE)
        pid = self.craft.pid_of("hirosco-supervisor")
        self.asked(POSTGRESQL, (1,))
        time.sleep(self.draw.uniform(0.0, SWITCH_S))
        begin, lost = self.craft.count(), time.monotonic()
        os.kill(pid, signal.SIGKILL)
        told = self.craft.wait_told("goes on with MANIPULATOR", 5.0, begin)
        self.deaths.append((lost, told.received))
        self.took.append(told.received - lost)
        # Its end may be unknown: said again, it is in force.
        time.sleep(LIVES_S)
        self.into(POSTGRESQL)

    def into(self, strategy):
        self.assertIn(7, self.asked(strategy, honest.ENDS), "SET_DATABASE is executed")

    def asked(self, strategy, until):
        packet = self.client.send(honest.call(self.ground.next(), "SET_DATABASE", bytes([strategy])))
        reports = lambda: [subtype for subtype, _ in self.ground.reports.get(packet[:4], [])]
        self.assertTrue(self.ground.wait(lambda: any(subtype in until for subtype in reports()), 10.0), "SET_DATABASE is answered")
        return reports()


if __name__ == "__main__":
    if not PROGRAMS:
        flight.skip("no-postgresql")
    flight.main()
