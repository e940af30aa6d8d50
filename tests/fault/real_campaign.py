#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Seeded flights on real processes: a cycle that spins, a process that is stopped or killed, a device that is unplugged, a
stop of everything by three ways; then the craft must be whole again by one bring-up.

Judged from outside: only the victim dies (I1), the supervisor answers throughout (I6), what was taken is given back (I7),
the robot in the world puts out nothing after a stop, everybody else cycles on (findings SF2, SF14, SF15, SF18).

    real_campaign.py [--flights N] [--seed S] [--only K]
"""
import argparse
import ctypes
import os
import pathlib
import random
import signal
import sys
import time

import flight

SYS_TGKILL = {"x86_64": 234, "aarch64": 131}[os.uname().machine]
SPINNABLE = {"hirosco-joystick": "hirosco-spinnable-joystick", "hirosco-manipulator": "hirosco-spinnable-manipulator"}
RESTARTS = {"60": "1"}              # three deaths in a minute are many for a mission, few for a campaign
ROBOT, JOYSTICK, GROUND = "hirosco-spinnable-manipulator", "hirosco-spinnable-joystick", "hirosco-communication"
# What the supervisor may take to answer, and what `hirosco tc` itself takes to start on a busy computer.
ANSWER_S, TOOL_S = 0.2, 0.3
# The declared stop of the robot, and what `hirosco fault` takes; DeviceOutput off and holding.
STOP_S, AT_REST = 0.2 + TOOL_S, (0, 3)


class Violation(Exception):
    pass


def cycle_thread(pid):
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() == "cycle":
            return int(task.name)
    raise Violation(f"process {pid} has no cycle thread")


def spin(craft, program):
    pid = craft.pid_of(program)
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.syscall(SYS_TGKILL, pid, cycle_thread(pid), signal.SIGUSR2) != 0:
        raise OSError(ctypes.get_errno(), "tgkill")


def expect(good, what):
    if not good:
        raise Violation(what)


class Trial:
    """One flight: some faults, what they must lead to, and a bring-up after each."""

    def __init__(self, seed, number):
        self.random = random.Random(f"{seed}/{number}")
        self.number = number
        kinds = [self.spinning, self.stopped, self.killed, self.unplugged, self.ground_killed, self.safe_by_signal,
                 self.safe_by_telecommand, self.killed_while_it_recovers]
        self.random.shuffle(kinds)
        self.steps = kinds[:3]
        self.reach = 0.01           # of the hand, to and fro

    def fly(self, craft):
        self.craft = craft
        craft.wait_commissioned()
        craft.fault("joystick", "hand", "cartesian", 0.015, 0, 0.5)
        time.sleep(self.random.uniform(0.6, 1.2))
        self.baseline = self.taken()
        for step in self.steps:
            self.begin = craft.count()
            step()
            self.bring_up()
        held = self.taken()
        expect(held <= self.baseline + 2, f"I7: {held} descriptors where {self.baseline} were")
        expect(craft.end() in (0, 1, 5), f"exit code, {craft.errors}")

    def taken(self):
        return len(list(pathlib.Path(f"/proc/{self.craft.pid_of('hirosco-supervisor')}/fd").iterdir()))

    # What happens.

    def victim(self):
        return self.random.choice((ROBOT, JOYSTICK))

    def name(self, program):
        return "MANIPULATOR" if program == ROBOT else "JOYSTICK"

    def spinning(self):
        victim = self.victim()
        spin(self.craft, victim)
        self.hangs_and_dies(victim)

    def stopped(self):
        victim = self.victim()
        self.craft.kill(victim, signal.SIGSTOP)
        self.hangs_and_dies(victim)

    def hangs_and_dies(self, victim):
        name = self.name(victim)
        hang = self.craft.wait_told(f"{name} hangs", 3.0, self.begin)
        time.sleep(0.05)
        self.robot_is_still()
        other = "JOYSTICK" if name == "MANIPULATOR" else "MANIPULATOR"
        expect(not [line for line in self.craft.told(self.begin) if f"{other} hangs" in line.told],
               f"{other} was blamed for what {name} did")
        self.answers()
        died = self.craft.wait_told(f"{name} died: signal 9", 4.0, self.begin)
        expect(0.9 < died.at_s - hang.at_s < 1.5, f"grace was {died.at_s - hang.at_s:.2f} s")
        self.only_died(name)

    def killed(self):
        victim = self.victim()
        self.craft.kill(victim)
        self.craft.wait_told(f"{self.name(victim)} died: signal 9", 2.0, self.begin)
        time.sleep(0.05)
        self.robot_is_still()
        self.answers()
        self.only_died(self.name(victim))

    def killed_while_it_recovers(self):
        self.craft.fault("joystick", "unplug")
        self.craft.kill(JOYSTICK)
        self.craft.wait_told("JOYSTICK died: signal 9", 2.0, self.begin)
        time.sleep(0.1)
        self.robot_is_still()
        self.answers()
        self.craft.fault("joystick", "plug")
        self.only_died("JOYSTICK")

    def unplugged(self):
        device = self.random.choice(("joystick", "robot"))
        self.craft.fault(device, "unplug")
        self.craft.wait_told("MANIPULATOR is Offline", 2.0, self.begin)
        if device == "joystick":
            self.robot_is_still()
        self.answers()
        self.craft.fault(device, "plug")
        self.only_died()

    def ground_killed(self):
        self.craft.kill(GROUND)
        self.craft.wait_told("the ground link is back", 4.0, self.begin)
        time.sleep(0.3)
        self.answers()
        self.only_died("COMMUNICATION")

    def safe_by_signal(self):
        self.craft.process.send_signal(signal.SIGUSR1)
        self.craft.wait_told("stop by signal or local socket", 0.5, self.begin)
        self.craft.wait_told("everything has stopped", 1.0, self.begin)
        self.robot_is_still()
        self.only_died()

    def safe_by_telecommand(self):
        code, reports = self.craft.tc("supervisor", "SAFE_ALL")
        expect(code == 0 and reports[-1] == "1,7", f"SAFE_ALL was answered {reports}")
        self.robot_is_still()
        self.only_died()

    # What must hold.

    def robot_is_still(self):
        """Its declared stop takes 200 ms; then it is off or held by its own brake, whatever anybody commands."""
        end = time.monotonic() + STOP_S
        while (truth := self.craft.truth("robot"))["output"] not in AT_REST and time.monotonic() < end:
            pass
        expect(truth["output"] in AT_REST, f"the robot has not stopped: {truth}")

    def answers(self):
        begin = time.monotonic()
        code, reports = self.craft.tc("supervisor", "ping")
        took = time.monotonic() - begin
        expect(code == 0, f"I6: ping was answered {reports}")
        expect(took < ANSWER_S + TOOL_S, f"I6: ping took {took:.2f} s")

    def only_died(self, *victims):
        words = [line.told.split() for line in self.craft.told(self.begin)]
        died = {told[0] for told in words if told[1:2] == ["died:"] and told[0] != "plan"}
        expect(died <= set(victims), f"I1: {died} died where {victims} were to")

    def bring_up(self):
        """The one bring-up of an operator; whoever died must be back within 2 s. Who is further on already refuses a step:
        the states in the end decide."""
        craft = self.craft
        for line in craft.told(self.begin):
            if line.told.split()[1:2] == ["died:"] and line.told.split()[0] != "plan":
                back = craft.wait_told(f"started {line.told.split()[0]}", 2.0, self.begin)
                expect(back.at_s - line.at_s < 2.0, f"{line.told.split()[0]} was back after 2 s only")
        time.sleep(0.5)
        craft.bring_up(self.do)
        self.reach = -self.reach
        craft.fault("joystick", "hand", "cartesian", 0, self.reach, 0.5)
        pushed = 0
        end = time.monotonic() + 1.0
        while time.monotonic() < end and not pushed:
            truth = craft.truth("robot")
            pushed = abs(truth["motor_1"]) + abs(truth["motor_2"])
        for name in ("MANIPULATOR", "JOYSTICK"):
            expect(self.state(name) == "Operational", f"{name} is {self.state(name)} after the bring-up")
        expect(pushed, f"the robot does not follow after the bring-up: {truth}")

    def do(self, subsystem, function, *arguments):
        code, reports = self.craft.tc(subsystem, function, *arguments)
        expect(code == 0, f"{subsystem} {function} {arguments}: {reports}")

    def state(self, name):
        status = self.craft.wait_status(lambda s: True, 3.0)
        return {member["name"]: member for member in status["subsystems"]}[name]["state"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--flights", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    options = parser.parse_args()
    numbers = [options.only] if options.only is not None else range(options.flights)
    failed = 0
    with flight.MissionCopy({**SPINNABLE, **RESTARTS}) as mission:
        for number in numbers:
            trial = Trial(options.seed, number)
            names = " ".join(step.__name__ for step in trial.steps)
            before = flight.segments()
            try:
                with flight.Flight(mission) as craft:
                    trial.fly(craft)
                expect(flight.segments() == before, "I7: shared memory was left behind")
                print(f"flight {number}: {names}", flush=True)
            except (Violation, AssertionError) as problem:
                failed += 1
                print(f"flight {number}: {names}\n  VIOLATION {problem}\n"
                      f"  again: real_campaign.py --seed {options.seed} --only {number}", flush=True)
    print(f"{len(numbers) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
