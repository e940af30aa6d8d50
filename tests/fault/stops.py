#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""SAFE_ALL on real processes, again and again: the arm at full speed, pressing 40 N or with a spring hooked in turn, beside each
of the things that could keep a stop from getting through. Judged in the world and on the pages, not by what anybody says; after
each stop one bring-up, and the arm does the same again.

    stops.py [--stops N]        N stops in all, over all conditions in turn; prints a table, the tails of all times among it
"""
import argparse
import contextlib
import math
import os
import signal
import socket
import sys
import tempfile
import time

import flight
import frozen_log_test
import honest
import pages
import punctual

ROBOT, JOYSTICK, GROUND = "hirosco-spinnable-manipulator", "hirosco-spinnable-joystick", "hirosco-telepresence-relay"
CHANGES = {"hirosco-joystick": JOYSTICK, "hirosco-manipulator": ROBOT, "60": "1"}   # 60: deaths are counted over so many seconds
FENCED_S = ACCEPTED_S = 0.5
ENABLE_S = 0.05                     # an enable lasts so long (adr 0025); then the device begins its declared stop by itself
HOME_M, DEPTH_M, SPRING = (0.3275, -0.0215), 0.0217, 2         # of the tip; of the hand for 40 N on the rail; near home
HAND_M_S = 0.25                     # of a hand that brings the arm home
BESIDE = ("valid flood", "damaged flood", "frozen log", "spinning cycle", "ground link stopped", "ground link dead")


class Violation(Exception):
    pass


class Unready(Exception):
    """The arm did not come into the situation, or the bring-up failed: of a host that is late no stop is counted."""


def expect(good, what):
    if not good:
        raise Violation(what)


class Arm:
    """Brings the arm into the three situations in which it is stopped; each proves that it follows the hand."""

    def __init__(self, craft):
        self.craft = craft

    def go_home(self):
        """The tip to its home; returns the offset of the hand that is needed for that, which differs from bring-up to bring-up."""
        offset, way_s = (0.0, 0.0), 0.2
        for _ in range(10):
            self.hand(offset, way_s)
            time.sleep(way_s + 0.3)
            tip = self.craft.truth("robot")
            away = HOME_M[0] - tip["tip_x"], HOME_M[1] - tip["tip_y"]
            if max(map(abs, away)) < 0.002:
                return offset
            offset = offset[0] + away[0], offset[1] + away[1]
            # A hand that is there at once makes the robot limp on the way (RO8), and who is limp comes nowhere.
            way_s = max(0.2, math.hypot(*away) / HAND_M_S)
        raise Unready(f"the arm does not come home: {tip}")

    def hand(self, offset, seconds):
        try:
            self.craft.ask("joystick", "hand", "cartesian", *(f"{way:.5f}" for way in offset), seconds)
        except AssertionError as problem:
            raise Unready(f"the hand cannot go there: {problem}") from problem

    def wait(self, wanted, what, seconds=6.0):
        end, truth = time.monotonic() + seconds, self.craft.truth("robot")
        while not wanted(truth):
            if time.monotonic() > end:
                raise Unready(f"the arm does not come {what}: {truth}")
            time.sleep(0.005)
            truth = self.craft.truth("robot")
        return truth

    def at_full_speed(self):
        """1.38 rad/s is what the controller lets a joint do."""
        self.go_home()
        self.craft.ask("joystick", "hand", "sine", 1, 0.2, 2)
        end, last, speed = time.monotonic() + 6.0, self.craft.truth("robot"), 0.0
        while speed < 1.3:
            if time.monotonic() > end:
                raise Unready(f"the arm does not come to full speed: {speed:.2f} rad/s, {last}")
            time.sleep(0.004)
            truth = self.craft.truth("robot")
            if truth["world_s"] > last["world_s"]:
                speed = abs(truth["motor_angle_1"] - last["motor_angle_1"]) / (truth["world_s"] - last["world_s"])
            last = truth

    def pressing(self):
        x, y = self.go_home()
        self.hand((x + DEPTH_M, y), 0.5)
        self.wait(lambda truth: 35.0 < truth["force"] < 48.0, "to press 40 N")

    def with_a_spring(self):
        x, y = self.go_home()
        self.craft.ask("robot", "hook", SPRING)
        self.hand((x - 0.02, y), 0.3)
        self.wait(lambda truth: abs(truth["torque_1"]) + abs(truth["torque_2"]) > 0.5, "to pull at the spring")

    situations = (at_full_speed, pressing, with_a_spring)


class Stops:
    """All stops beside one thing, in one flight."""

    def __init__(self, beside, times):
        self.beside, self.times = beside, times
        self.accepted, self.fenced, self.answered, self.obeyed, self.done, self.late = [], [], [], [], 0, 0

    def fly(self):
        while self.done < self.times:
            with punctual.Lateness() as host:
                try:
                    self.fly_on()
                    continue
                except Unready as problem:
                    reason = problem
            if host.worst_s is None or host.worst_s <= punctual.WATCHDOG_S or self.late > self.times / 10:
                raise Violation(f"{reason}the host was late by {1e3 * (host.worst_s or 0):.0f} ms")
            self.late += 1
            print(f"beside {self.beside}: {reason}, on a host that was late by {1e3 * host.worst_s:.0f} ms: a new flight", flush=True)

    def fly_on(self):
        """One flight, with as many stops as it takes."""
        with flight.MissionCopy(CHANGES) as mission, tempfile.TemporaryDirectory(prefix="hirosco-stops-") as folder, \
             contextlib.ExitStack() as around:
            self.disk = around.enter_context(frozen_log_test.FrozenDisk(folder)) if self.beside == "frozen log" else None
            self.craft = around.enter_context(flight.Flight(mission, folder=folder, quiet=True))
            self.craft.wait_commissioned()
            self.arm, self.ground = Arm(self.craft), honest.Honest()
            while self.done < self.times:
                situation = Arm.situations[(self.done + BESIDE.index(self.beside)) % len(Arm.situations)]
                try:
                    self.once(situation)
                except (Violation, Unready, AssertionError) as problem:
                    kind = Unready if isinstance(problem, Unready) else Violation
                    raise kind(f"stop {self.done + 1} beside {self.beside}, {situation.__name__}: {problem}\n"
                               f"{self.craft.story()[-2000:]}\n") from problem

    def once(self, situation):
        self.begin = self.craft.count()
        for device in ("robot", "joystick"):
            self.craft.ask(device, "heal")
        situation(self.arm)
        with pages.Watch(self.craft, (ROBOT, JOYSTICK)) as watch, contextlib.ExitStack() as around:
            after = getattr(self, self.beside.replace(" ", "_"))(around)
        expect(set(watch.fenced) == {ROBOT, JOYSTICK}, f"fenced are only {set(watch.fenced)}")
        # Who hangs may have been fenced for that before.
        self.fenced.append(max(0.0, max(watch.fenced.values()) - self.asked))
        expect(self.fenced[-1] < FENCED_S, f"all fenced only {self.fenced[-1]:.3f} s after")
        expect(self.obeyed[-1] <= self.fenced[-1] + ENABLE_S, f"the robot obeyed for another {self.obeyed[-1]:.3f} s")
        after()
        self.done += 1
        self.craft.ask("robot", "release")
        self.craft.ask("joystick", "hand", "cartesian", 0, 0, 0.2)
        self.craft.bring_up(self.do)

    # What may keep it from getting through. Each stops, and returns what is to be waited for before the bring-up.

    def valid_flood(self, around):
        around.enter_context(honest.Beside(honest.flood, [honest.valid_pings(apid) for apid in (1, 10, 11)],
                                           [honest.TELECOMMAND_PORT] * 3))
        self.stop_by_telecommand()
        return lambda: None

    def damaged_flood(self, around):
        around.enter_context(honest.Beside(honest.flood, [honest.damaged_pings()] * 3, [honest.TELECOMMAND_PORT] * 3))
        self.stop_by_telecommand()
        return lambda: None

    def frozen_log(self, around):
        self.disk.freeze()
        around.callback(self.disk.thaw)
        time.sleep(0.3)
        self.stop_by_telecommand()
        return lambda: None

    def spinning_cycle(self, _):
        victim = (ROBOT, JOYSTICK)[self.done % 2]
        pid = self.craft.pid_of(victim)
        flight.spin(pid, pages.cycle_thread(pid))
        self.stop_by_telecommand()
        name = "MANIPULATOR" if victim == ROBOT else "JOYSTICK"
        return lambda: (self.craft.wait_told(f"{name} died: signal 9", 4.0, self.begin),
                        self.craft.wait_told(f"started {name}", 4.0, self.begin), time.sleep(0.5))

    def ground_link_stopped(self, _):
        self.craft.kill(GROUND, signal.SIGSTOP)
        time.sleep(0.05)
        self.stop_past_the_ground_link()
        return self.wait_for_ground

    def ground_link_dead(self, _):
        self.craft.kill(GROUND)
        self.stop_past_the_ground_link()
        return self.wait_for_ground

    def wait_for_ground(self):
        self.craft.wait_told("the ground link is back", 10.0, self.begin)
        time.sleep(0.3)
        self.ground = honest.Honest()

    # The stop, and what must hold.

    def stop_by_telecommand(self):
        packet = honest.safe_all(self.ground.next())
        self.ground.reports.pop(honest.request_id(packet), None)
        try:
            commander = socket.create_connection(("127.0.0.1", honest.TELECOMMAND_PORT))
        except OSError as problem:
            raise Unready(f"nobody is there to take the stop: {problem}") from problem
        with commander:
            looked, before = time.monotonic(), self.craft.truth("robot")
            self.asked = time.monotonic()
            commander.sendall(packet)
            found = self.ground.verdict(packet, 10.0)
            told, truth = time.monotonic(), self.craft.truth("robot")
        expect(found is not None, "no final report")
        expect(1 in found, f"no TM[1,1] but {found}")
        self.accepted.append(found[1] - self.asked)
        expect(self.accepted[-1] < ACCEPTED_S, f"TM[1,1] after {self.accepted[-1]:.3f} s")
        expect(7 in found, f"it failed: {found}")
        self.told(told, looked, before, truth)

    def stop_past_the_ground_link(self):
        looked, before = time.monotonic(), self.craft.truth("robot")
        self.asked = time.monotonic()
        done = self.craft.hirosco("safe")
        told, truth = time.monotonic(), self.craft.truth("robot")
        expect(done.returncode == 0 and "ROBOT stopped" in done.stdout, f"hirosco safe: {done.stdout}{done.stderr}")
        self.told(told, looked, before, truth)

    def told(self, told, looked, before, truth):
        """Who says that it has stopped says so when it has. When commands reached the motors last is told by the device, in the
        time of its world: looks from outside come too late beside a flood."""
        self.answered.append(told - self.asked)
        expect(self.still(truth), f"it says that all has stopped, and the robot moves: {truth}")
        # The look before is as old as it took: so much of this may lie before the asking.
        self.obeyed.append(max(0.0, truth["obeyed_s"] - before["world_s"] - (self.asked - looked)))

    @staticmethod
    def still(truth):
        return (truth["motor_1"], truth["motor_2"]) == (0.0, 0.0)

    def do(self, subsystem, function, *arguments):
        code, reports = self.craft.tc(subsystem, function, *arguments)
        if code != 0:
            raise Unready(f"{subsystem} {function} {arguments}: {reports}")

    def row(self):
        def times(found):
            found = sorted(found)
            return f"{1e3 * found[len(found) // 2]:7.1f} {1e3 * found[int(0.99 * len(found))]:7.1f} {1e3 * found[-1]:7.1f}" \
                if found else " " * 8 + "-" * 7 + " " * 8
        return f"{self.beside:20} {self.done:5}/{self.times:<5} {times(self.fenced)}   {times(self.accepted)}   " \
               f"{times(self.obeyed)}   {times(self.answered)}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--stops", type=int, default=1000)
    parser.add_argument("--beside", choices=BESIDE, action="append")
    options = parser.parse_args()
    conditions = options.beside or BESIDE
    if os.geteuid() != 0 and "frozen log" in conditions:
        flight.skip("no-loop-mount")
    rows, done, late, violations = [], 0, 0, 0
    for number, beside in enumerate(conditions):
        stops = Stops(beside, len(range(number, options.stops, len(conditions))))
        try:
            stops.fly()
        except Violation as problem:
            violations += 1
            print(f"VIOLATION {problem}", flush=True)
        rows.append(stops.row())
        done, late = done + stops.done, late + stops.late
        print(rows[-1], flush=True)
    print(f"\n{'ms after it was sent':20} {'stops':>11} {'all fenced: median, p99, worst':>23}   {'TM[1,1]':>23}   "
          f"{'robot obeyed last':>23}   {'end report':>23}")
    print("\n".join(rows))
    print(f"{done} of {options.stops} stops, {violations} violations; {late} new flights because the host was late")
    return 1 if violations or done < options.stops else 0


if __name__ == "__main__":
    sys.exit(main())
