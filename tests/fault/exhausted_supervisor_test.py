#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A supervisor that gets no more memory, or no more descriptors, while the robot is coupled. It refuses what it cannot do, or it dies of it
and another one goes on (docs/adr/0093): either way what moves is stopped by whoever asks, nothing that was begun is left half done, and the
flight flies again. What leaks until nothing is left ends between two of its steps (docs/adr/0114): cycles and links run on, and nobody's
telecommand is lost."""
import contextlib
import os
import pathlib
import resource
import select
import signal
import time

import accounts
import flight
import honest
import supervisors
import witness

MODE = 3
SAFE_AFTER_S = 2.0          # supervisor_silence_limit of hirosco/subsystem/pages/supervisor_silence.hpp
ADOPTED_S = 1.0
# The structures of both machines come every so often, by their cycles' count.
SAMPLES_S = {4713: 0.05, 4721: 0.25}
# What tells that it lacks something. Where the log finds no memory first (7 is SQLite's word for that), it gives back what it had, and that may be
# enough for a start. Where its own step finds none it ends, and another one goes on that lacks nothing.
BITES = ("cannot start JOYSTICK", "failed (storing in the log database, 7)", "this supervisor goes on for one that died")
# With a heap for each thread what one of them lacks another one has.
ONE_HEAP = {"MALLOC_ARENA_MAX": "1"}


def held(pid):
    """How much address space and how many descriptors a process has now."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    octets = int(status.split("VmSize:")[1].split()[0]) * 1024
    return octets, len(os.listdir(f"/proc/{pid}/fd"))


class Exhausted(accounts.Accounts):
    def starve(self, craft, what):
        """From now on it gets nothing more; returns its pid."""
        pid = craft.pid_of("hirosco-supervisor")
        octets, descriptors = held(pid)
        limits = {"memory": (resource.RLIMIT_AS, octets), "descriptors": (resource.RLIMIT_NOFILE, descriptors)}
        which, limit = limits[what]
        # The soft limit bites; the hard one stays, or nobody could take it back.
        resource.prlimit(pid, which, (limit, resource.prlimit(pid, which)[1]))
        return pid

    def feed(self, pid):
        """Whoever was starved and lives may have everything again."""
        for which in (resource.RLIMIT_AS, resource.RLIMIT_NOFILE):
            with contextlib.suppress(ProcessLookupError):
                hard = resource.prlimit(pid, which)[1]
                resource.prlimit(pid, which, (hard, hard))

    def want_much(self, craft):
        """Whatever of its work wants memory and descriptors: packets, connections, processes, pages, links, files."""
        for _ in range(3):
            craft.tc("manipulator", "ping", seconds=60)
            craft.tc("supervisor", "SET_MODE", 2, seconds=60)
        begin = craft.count()
        craft.kill("hirosco-joystick")
        craft.wait_line(lambda l: "JOYSTICK" in l.told, 10.0, begin)
        craft.tc("joystick", "SET_STATE", 0, seconds=60)
        craft.tc("supervisor", "SET_MODE", MODE, seconds=90)
        craft.tc("supervisor", "SET_DATABASE", 1, seconds=60)

    def dies(self, pid):
        """It begins to leak; when it was gone."""
        process = os.pidfd_open(pid)
        try:
            os.kill(pid, signal.SIGUSR2)
            self.assertTrue(select.select([process], [], [], 20.0)[0], "it ends")
            return time.monotonic()
        finally:
            os.close(process)

    def leaks_until_nothing_is_left(self, craft):
        """While the robot pushes and a client commands without a pause."""
        self.push(craft)
        ground = honest.Honest()
        client = witness.Client(ground)
        with flight.Telemetry() as telemetry:
            time.sleep(0.5)
            begin = craft.count()
            pid = self.starve(craft, "memory")
            lost_at, told = self.dies(pid), None
            while told is None:
                self.assertLess(time.monotonic(), lost_at + 10.0, "another supervisor goes on")
                truth = craft.truth("robot")
                self.assertNotEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0), "the robot pushes on")
                told = craft.wait_line(lambda l: "goes on with MANIPULATOR" in l.told, 0.005, begin)
            flight.measure(f"a supervisor without memory is replaced after {told.received - lost_at:.3f} s")
            self.assertNotIn("stopped", told.told)
            self.assertLess(told.received - lost_at, ADOPTED_S)
            time.sleep(2.5)
            self.assertGreater(craft.truth("robot")["force"], 20.0, "it pushes on when nobody would any more without a supervisor")
            self.assertEqual([l.told for l in craft.told(begin) if "STATE_CHANGED" in l.told and "SUPERVISOR" not in l.told], [])
            self.assertTrue([each for each in craft.errors if "no memory left: the supervisor ends between two steps" in each], craft.errors)
            for structure, every in SAMPLES_S.items():
                times = [at for at, _ in telemetry.housekeeping(structure)]
                gaps = [b - a for a, b in zip(times, times[1:])]
                flight.measure(f"largest gap of structure {structure}: {max(gaps):.3f} s of {every} s")
                self.assertLess(max(gaps), 2 * every + 0.02, "its cycles and its reports went on")
        client.ending = True
        client.thread.join()
        for packet, _ in client.sent[-200:]:
            ground.verdict(packet, 5.0)
        client.socket.close()
        self.compare(craft, ground, client.sent, [(lost_at, told.received)])

    def starved_of(self, what):
        with contextlib.ExitStack() as until_end:
            programs = until_end.enter_context(supervisors.instead("leaking"))
            rokviss = until_end.enter_context(flight.Flight(binaries=programs, environment=ONE_HEAP))
            rokviss.wait_commissioned()
            if what == "memory":
                self.leaks_until_nothing_is_left(rokviss)
            begin = rokviss.count()
            pid = self.starve(rokviss, what)
            self.want_much(rokviss)
            # Who asks for a stop gets one, from this supervisor or from its successor.
            asked = time.monotonic()
            self.assertEqual(rokviss.hirosco("safe", "--mission", rokviss.mission).returncode, 0)
            truth = rokviss.truth("robot")
            self.assertEqual((truth["motor_1"], truth["motor_2"]), (0.0, 0.0))
            flight.measure(f"without {what}: stopped {time.monotonic() - asked:.2f} s after it was asked, "
                           f"{'the same supervisor' if rokviss.pid_of('hirosco-supervisor') == pid else 'another supervisor'}")
            self.assertIsNotNone(rokviss.wait_line(lambda l: any(words in l.told for words in BITES), 1.0, begin), "it bites")
            said = [line.told for line in rokviss.told(begin)] + rokviss.errors
            self.assertFalse([line for line in said if "terminate called" in line and "what()" not in "\n".join(said)], said)
            self.feed(rokviss.pid_of("hirosco-supervisor"))
            end = time.monotonic() + 60.0
            # One that died of it may have left a member down: the mode brings all of them up, as often as it takes to be heard.
            while rokviss.tc("supervisor", "SET_MODE", MODE, seconds=90)[0] != 0:
                self.assertLess(time.monotonic(), end, "it flies again")
                for name in ("manipulator", "joystick"):
                    rokviss.tc(name, "SET_STATE", 0, seconds=60)
            status = rokviss.wait_status(lambda s: s["mode"] == "telepresence", 10.0)
            self.assertIsNotNone(status)
            states = {member["name"]: member["state"] for member in status["subsystems"]}
            self.assertEqual((states["MANIPULATOR"], states["JOYSTICK"]), ("Operational", "Operational"))
            rokviss.end()

    def test_without_memory(self):
        self.starved_of("memory")

    def test_without_descriptors(self):
        self.starved_of("descriptors")

    def driven_until(self, craft, over):
        """When the robot's motors were last seen to do anything, looked at in its world until `over()` or its world has ended."""
        driven = time.monotonic()
        while not over():
            try:
                truth = craft.truth("robot")
            except (OSError, ValueError, AssertionError):      # its device has ended with the flight
                break
            if (truth["motor_1"], truth["motor_2"]) != (0.0, 0.0):
                driven = time.monotonic()
        return driven

    def test_a_supervisor_that_never_gets_enough_ends_the_flight_in_words_and_leaves_nobody_moving(self):
        """Limits that its successors inherit, as of the keeper, while the robot pushes."""
        before = flight.segments()
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            keeper = rokviss.process.pid
            resource.prlimit(keeper, resource.RLIMIT_AS, (held(keeper)[0],) * 2)
            begin = rokviss.count()
            rokviss.kill("hirosco-supervisor")
            killed = time.monotonic()
            end = killed + 60.0

            def goes_on():
                return rokviss.wait_line(lambda l: "goes on for one that died" in l.told, 0.005, begin) is not None
            driven = self.driven_until(rokviss, lambda: goes_on() or time.monotonic() > end)
            while rokviss.process.poll() is None and not goes_on():
                self.assertLess(time.monotonic(), end, "the flight goes on or ends")
            if rokviss.process.poll() is None:     # what the keeper has is enough for it
                flight.measure(f"another one had enough after {time.monotonic() - killed:.3f} s")
                self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
                self.assertEqual(rokviss.end(), 0, rokviss.errors)
            else:
                flight.measure(f"with nobody to go on the robot was driven for {driven - killed:.3f} s more, {SAFE_AFTER_S} s at most and its stop")
                self.assertLess(driven - killed, SAFE_AFTER_S + flight.STOP_S)
                self.assertNotEqual(rokviss.errors, [], "it says why")
                self.assertNotIn(rokviss.process.returncode, (0,))
        self.assertEqual(flight.segments(), before)


if __name__ == "__main__":
    flight.main()
