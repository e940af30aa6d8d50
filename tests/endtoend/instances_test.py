#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Several flights of one mission on one computer (docs/adr/0037): each with ports, log, lock, sockets and devices of its own,
each commanded apart, and none harmed by what becomes of another."""
import contextlib
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import flight


@contextlib.contextmanager
def two_flights(**options):
    """Two of one mission, started from one folder, with one runtime folder: only their names differ."""
    with tempfile.TemporaryDirectory(prefix="hirosco-flights-") as folder:
        with flight.Flight(folder=folder, instance="one", **options) as one:
            one.wait_commissioned()
            with flight.Flight(folder=folder, instance="two", **options) as two:
                two.wait_commissioned()
                yield one, two


def moving(craft):
    """The permission of both machines, as the newest status of this flight has it."""
    def permitted(status):
        members = {member["name"]: member for member in status["subsystems"]}
        return all(members[name]["state"] == "Operational" and not members[name].get("inhibited")
                   for name in ("MANIPULATOR", "JOYSTICK"))
    return craft.wait_status(permitted, 5.0)


def stopped(craft):
    def withdrawn(status):
        members = {member["name"]: member for member in status["subsystems"]}
        return all(members[name]["state"] in ("Offline", "not running") or members[name].get("inhibited")
                   for name in ("MANIPULATOR", "JOYSTICK"))
    return craft.wait_status(withdrawn, 5.0)


class Instances(unittest.TestCase):
    def refused(self, craft, *words):
        """A third flight from the same folder; what it says why not."""
        done = subprocess.run([str(flight.BINARIES / "hirosco"), "run", *words, "--no-ground"], cwd=craft.folder,
                              env=craft.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=20,
                              check=False)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        return done.stderr

    def test_each_has_what_is_its_own_and_is_commanded_apart(self):
        with two_flights() as (one, two):
            places = [one.place(), two.place()]
            for what in ("telemetry", "telecommand", "log", "folder"):
                self.assertNotEqual(places[0][what], places[1][what])
            for place in places:
                port = int(place["telemetry"].rpartition(":")[2])
                self.assertNotEqual(port, flight.PORT, "that is where a flight without a name of its own listens")
                self.assertTrue(flight.listens(port))
                self.assertTrue(flight.listens(int(place["telecommand"].rpartition(":")[2])))
                self.assertTrue(pathlib.Path(place["log"]).is_file())
                self.assertTrue((pathlib.Path(place["folder"]) / "lock").is_file())
            self.assertFalse(flight.listens(flight.PORT))
            # Each hears its own telecommand and its own device's fault, and the other does not.
            self.assertEqual(one.tc("manipulator", "SET_TORQUE_LIMIT", 11)[0], 0)
            one.fault("joystick", "unplug")
            one.wait_told("JOYSTICK_LOST")
            self.assertIsNotNone(moving(two), "the other flight goes on")
            for what in ("JOYSTICK_LOST", "SET_TORQUE_LIMIT"):
                self.assertTrue([record for record in one.log() if what in record["text"]], what)
                self.assertFalse([record for record in two.log() if what in record["text"]], what)
            self.assertEqual(two.tc("joystick", "ping")[0], 0)

    def test_who_does_not_say_which_is_told_and_who_says_a_name_that_does_not_fly_too(self):
        with two_flights() as (one, two):
            for words in (("tc", "manipulator", "ping"), ("status",), ("log",), ("fault", "robot", "truth")):
                done = one.hirosco(*words)
                self.assertEqual(done.returncode, 2, words)
                self.assertIn("2 flights are in the air; which one?", done.stderr)
                self.assertIn("--instance one", done.stderr)
                self.assertIn("--instance two", done.stderr)
                done = one.hirosco(*words, "--instance", "three")
                self.assertEqual(done.returncode, 2, words)
                self.assertIn("no instance 'three' flies; there are:", done.stderr)
            done = one.hirosco("safe", "--instance", "three")
            self.assertEqual(done.returncode, 3)
            self.assertIn("three does not fly; there are: one, two", done.stderr)
            self.assertIn("one flies already", self.refused(one, one.mission, "--instance", "one"))
            self.assertIn("'a/b' is no name of a flight", one.hirosco("run", one.mission, "--instance", "a/b").stderr)
            status = one.hirosco("status", "--json", "--instance", "two")
            *lines, verdict = map(json.loads, status.stdout.splitlines())
            heard = {line["subsystem"]: line["packets"] for line in lines}
            self.assertGreater(heard["MANIPULATOR"], 0, "status listens to the one that is named")
            self.assertEqual((verdict["mission"], verdict["verdict"], status.returncode), ("ROKVISS", "well", 0))
            self.assertRegex(verdict["line"], "^well: mode ")
            # Which one it is does not depend on where and with which runtime folder it is asked.
            with tempfile.TemporaryDirectory(prefix="hirosco-elsewhere-") as elsewhere:
                done = subprocess.run([str(flight.BINARIES / "hirosco"), "log", "--instance", "two", "--last", "1"],
                                      cwd=elsewhere, env={**one.environment, "XDG_RUNTIME_DIR": elsewhere},
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=20, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex(done.stderr, r"^\S*log/two/rokviss.db: number, time in UTC \(Z\), kind, what\n$")
                self.assertTrue(done.stdout)
            self.assertEqual(two.end(), 0, two.errors)
            self.assertEqual(one.hirosco("tc", "manipulator", "ping").returncode, 0, "the only one that is left is meant")
            self.assertTrue(one.hirosco("log", "--instance", "two").stdout, "what has flown from here has its log")

    def test_a_python_client_finds_the_one_that_is_named(self):
        with two_flights() as (one, two), tempfile.TemporaryDirectory(prefix="hirosco-python-") as out:
            done = one.hirosco("export", "python", one.mission, "--to", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(one.tc("supervisor", "SET_MODE", "standalone")[0], 0)
            one.wait_told("mode standalone")
            program = ("from hirosco_rokviss import LinkLost, Spacecraft\n"
                       "for name in ('one', 'two'):\n"
                       "    with Spacecraft(instance=name) as craft:\n"
                       "        craft.wait_until(lambda: craft.mode)\n"
                       "        print(name, craft.mode)\n"
                       "for name in (None, 'three'):\n"
                       "    try:\n"
                       "        Spacecraft(instance=name)\n"
                       "    except LinkLost as error:\n"
                       "        print(error)\n")
            done = subprocess.run([sys.executable, "-B", "-c", program], env={**one.environment, "PYTHONPATH": out},
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines()[:2], ["one standalone", "two telepresence"])
            self.assertIn("2 flights of ROKVISS are in the air", done.stdout)
            self.assertIn("no instance 'three' of ROKVISS flies", done.stdout)

    def test_what_becomes_of_one_does_not_harm_the_other(self):
        with two_flights() as (one, two):
            done = one.hirosco("safe", "--instance", "one")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertTrue(all(line.startswith("one: ") for line in done.stdout.splitlines()), done.stdout)
            self.assertIsNotNone(stopped(one))
            self.assertIsNotNone(moving(two), "only the one that was named is stopped")
            for pid in one.processes():
                flight.os.kill(pid, signal.SIGKILL)
            self.assertEqual(one.wait_until_gone(5.0), {})
            self.assertIsNotNone(moving(two))
            self.assertEqual(two.tc("manipulator", "ping")[0], 0)
            # Its name is free again at once, and so is all that went with it.
            with flight.Flight(folder=one.folder, instance="one") as again:
                again.wait_commissioned()
                done = again.hirosco("safe")
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertEqual({line.partition(":")[0] for line in done.stdout.splitlines()}, {"one", "two"},
                                 "without a name everybody is stopped")
                self.assertIsNotNone(stopped(two))
                self.assertEqual(again.end(), 0, again.errors)
            self.assertEqual(two.end(), 0, two.errors)

    def test_a_third_is_refused_when_the_budgets_of_all_do_not_fit(self):
        with two_flights() as (one, two):
            why = self.refused(one, str(flight.ROKVISS), "--instance", "three")
            self.assertIn("the cycles of all flights need 135 % of the processor that they share: this one 45 %, "
                          "one 45 %, two 45 %", why)
            self.assertFalse((pathlib.Path(one.folder) / "log/three/rokviss.db").exists(), "nothing of it was started")
            self.assertEqual(two.end(), 0, two.errors)
            with flight.Flight(folder=one.folder, instance="three") as three:
                three.wait_commissioned()
                self.assertEqual(three.end(), 0, three.errors)
            self.assertEqual(one.end(), 0, one.errors)

    def test_a_flight_listens_where_its_mission_says(self):
        with flight.MissionCopy({"127.0.0.1:10015": "127.0.0.1:11015", "127.0.0.1:10025": "127.0.0.1:11025"}) as mission, \
                flight.Flight(mission=mission) as craft:
            craft.wait_commissioned()
            self.assertTrue(flight.listens(11015))
            self.assertTrue(flight.listens(11025))
            self.assertFalse(flight.listens(flight.PORT))
            self.assertEqual(craft.tc("manipulator", "ping")[0], 0)
            # What one mission's name stands for is taken, what another name stands for is not.
            self.assertIn("flies already", self.refused(craft, str(mission)))
            self.assertEqual(craft.end(), 0, craft.errors)


if __name__ == "__main__":
    flight.main()
