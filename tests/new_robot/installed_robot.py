#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""installed_robot.py NAME FILE TIP [GRIPPER] | demonstrator: an ordinary user, with the packages alone, makes an arm of somebody's URDF file and flies it,
nothing edited: goals and lines by telecommands, a plug that is pulled, limits, the page, and worlds that differ from the file. `demonstrator`: how rokviss
reacts to a plug and a limit. Prints each figure beside what is required; ends with 1 where one is not as required. Inside a bare Debian
(tools/packages/five_robots); Python's standard library only, and tests/endtoend/flight.py."""
import contextlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

import flight
from installed_judge import Judge, Robot, beside, between, furthest

MOST_RAD, MOST_M, MOST_BESIDE_M, MOST_S = 1e-3, 1e-3, 2e-3, 300
# The declared stop of the drives, the time that an enable lasts without real-time rights, and what a loss is noticed in (newpart.xml).
REST_S = 0.5 + 0.1 + 0.1
LINE_M, LINE_M_S, LINE_RAD_S = 0.05, 0.05, 0.5
FAST = 0.05  # of a joint, rad/s or m/s: it moves
STANDS, MOST_JOGS = 1e-3, 30  # rad or m in a jog of a second: it goes no further
# What is pushed with until a limit says so: a share more each time.
FIRST_PUSH_N, MOST_PUSH_N, PUSHES_S = 10.0, 5000.0, 0.3


def hirosco(*words, seconds=120):
    done = subprocess.run(["hirosco", *map(str, words)], capture_output=True, timeout=seconds, check=False)
    if done.returncode != 0:
        raise AssertionError(f"hirosco {' '.join(map(str, words))}: {(done.stdout + done.stderr).decode(errors='replace')[-2000:]}")
    return done.stdout


def reacts(craft, judge, begin, subsystem, event, plan, state):
    """As every mission here does, whose plans have these names: the event with its severity, the plan, and where it leaves whom."""
    for told in (f"{subsystem} {event}", f"plan {plan}: ", f"{subsystem} {state}"):
        craft.wait_told(told, 5.0, begin)
        judge.said("  told", told)


def lost(craft, judge, begin, subsystem, device):
    reacts(craft, judge, begin, subsystem, f"high {device}_LOST", "network-down", "is Offline")


def limited(craft, judge, begin, subsystem):
    reacts(craft, judge, begin, subsystem, "medium TORQUE_LIMIT_EXCEEDED", "to-safe", "info STATE_CHANGED STATE=SafeOperational")


class Flown:
    """One flight, judged by telemetry and by its world."""

    def __init__(self, robot, craft, judge):
        self.robot, self.craft, self.judge = robot, craft, judge

    # What is told.

    def told(self):
        """Newest housekeeping of the arm."""
        done = self.craft.hirosco("status", self.robot.name, "--json", "--mission", self.craft.mission, "--instance", self.craft.instance)
        return next(found["values"] for found in map(json.loads, done.stdout.splitlines()) if found.get("subsystem") == self.robot.subsystem)

    def state(self):
        status = self.craft.wait_status(lambda told: True, 5.0)
        return next(member["state"] for member in status["subsystems"] if member["name"] == self.robot.subsystem)

    def positions(self, truth=None):
        truth = truth or self.craft.truth(self.robot.name)
        return [truth[f"q{place}"] for place in self.robot.in_world]

    def speeds(self, truth):
        return [truth[f"qd{place}"] for place in self.robot.in_world]

    def tip(self, truth=None):
        truth = truth or self.craft.truth(self.robot.name)
        return [truth[f"tip_{axis}"] for axis in "xyz"]

    # Hands.

    def tc(self, function, *arguments, subsystem=None):
        words = [",".join(f"{part:.9g}" for part in each) if isinstance(each, (list, tuple)) else each for each in arguments]
        code, _ = self.craft.tc(subsystem or self.robot.name, function, *words, seconds=90.0)
        return code

    def does(self, function, *arguments, subsystem=None):
        code = self.tc(function, *arguments, subsystem=subsystem)
        if code != 0:
            raise AssertionError(f"{function} {arguments}: ended with {code}: {self.craft.answers}")

    def reason(self):
        """In words, of the last telecommand: how it ended."""
        found = [json.loads(line) for line in self.craft.answers.splitlines() if line.startswith("{")]
        return found[-1]["text"] if found else ""

    # What is judged.

    def commissioned(self):
        line = self.craft.wait_told("commissioned: mode operation", 30.0)
        self.judge.at_most("commissioned", line.at_s, 30, "s", of="commissioned")

    def goal(self, what, goal, speed=0.5):
        """Joints to a goal, by telemetry and in the world."""
        self.does("MOVE_J", goal, speed)
        truth, told = self.craft.truth(self.robot.name), self.told()
        self.judge.at_most(f"{what}, in its world", furthest(self.positions(truth), goal), MOST_RAD, "mrad", 1e3, of="goals")
        self.judge.at_most(f"{what}, by telemetry", furthest(told["CUR_VALUES.POSITION"], goal), MOST_RAD, "mrad", 1e3, of="goals")
        self.judge.at_most("  tool, telemetry beside world", math.dist(told["TOOL.POSITION"], self.tip()), MOST_M, "mm", 1e3, of="tool")

    @contextlib.contextmanager
    def traced(self):
        """The tool's places in the world while something happens."""
        places, ended = [], threading.Event()

        def trace():
            while not ended.is_set():
                places.append(self.tip())
                time.sleep(0.002)
        thread = threading.Thread(target=trace)
        thread.start()
        try:
            yield places
        finally:
            ended.set()
            thread.join()

    def line(self, end, orientation):
        """(exit code, how far from the line it was on the way, how many looks)."""
        begin = self.tip()
        with self.traced() as places:
            code = self.tc("MOVE_L", end, orientation, LINE_M_S, LINE_RAD_S)
        return code, max(beside(place, begin, end) for place in places), len(places)

    def lines(self):
        """There and back from the README's goal; where to depends on where its joints have room."""
        begin, orientation = self.tip(), self.told()["TOOL.ORIENTATION"]
        for axis, step in ((2, LINE_M), (2, -LINE_M), (1, LINE_M), (1, -LINE_M), (0, LINE_M), (0, -LINE_M)):
            end = list(begin)
            end[axis] += step
            code, off, looks = self.line(end, orientation)
            if code == 0:
                break
            time.sleep(1)  # it brakes
            self.does("MOVE_J", self.robot.goal, 0.5)
        else:
            raise AssertionError("no line was gone to its end")
        self.judged_line(f"line of {1e3 * LINE_M:g} mm, {'-' if step < 0 else '+'}{'xyz'[axis]}", end, orientation, off, looks)
        code, off, looks = self.line(begin, orientation)
        if code != 0:
            raise AssertionError(f"the way back ended with {code}: {self.craft.answers}")
        self.judged_line("  and back", begin, orientation, off, looks)

    def judged_line(self, what, end, orientation, off, looks):
        place, told = self.tip(), self.told()
        self.judge.at_most(f"{what}: beside it, {looks} looks", off, MOST_BESIDE_M, "mm", 1e3, of="beside")
        self.judge.at_most("  its end, in its world", math.dist(place, end), MOST_M, "mm", 1e3, of="tool")
        self.judge.at_most("  its end, by telemetry", math.dist(told["TOOL.POSITION"], end), MOST_M, "mm", 1e3, of="tool")
        self.judge.at_most("  turned there, by telemetry", between(told["TOOL.ORIENTATION"], orientation), MOST_RAD, "mrad", 1e3, of="goals")

    def as_its_readme_says(self):
        """The lines of its README, as they stand there."""
        typed = 0
        for words in re.findall(rf"(?m)^    hirosco (tc {self.robot.name}.*?|fault {self.robot.name} .*?)(?: +#.*)?$", self.robot.readme):
            kind, who, *rest = words.split()
            typed += 1
            if kind == "fault":
                self.craft.fault(who, *rest)
                time.sleep(1)
                self.craft.fault(who, "push", 0, 0, 0)
                time.sleep(2)  # it swings back
            elif rest[0] == "GRIP":
                self.grips(who, rest[1:])
            else:
                self.does(*rest, subsystem=who)
        self.does("POSITION_CONTROL")
        self.does("MOVE_J", self.robot.goal, 0.5)
        self.judge.said("lines of its README typed", str(typed), "each is done")

    def grips(self, who, arguments):
        """Nothing, which is told; then a ball between its fingers."""
        force = float(arguments[0])
        begin = self.craft.count()
        code = self.tc("GRIP", *arguments, subsystem=who)
        self.craft.wait_told("NOTHING_MET", 5.0, begin)
        self.judge.row("gripped nothing", f"ended with {code}", "NOTHING_MET", code != 0)
        self.does("OPEN", arguments[1], subsystem=who)
        self.does("POSITION_CONTROL")
        self.craft.fault(self.robot.name, "obstacle_ball", "sphere", 0.015, ",".join(map(str, self.tip())), 0.5)
        self.does("GRIP", *arguments, subsystem=who)
        pressed = self.craft.truth(self.robot.name)["contact_n"] / 2
        self.judge.row("gripped a ball, each side in its world", f"{pressed:.1f} N", f"{force:g} N +- 10 %", abs(pressed - force) <= 0.1 * force)
        self.does("OPEN", arguments[1], subsystem=who)
        self.craft.fault(self.robot.name, "obstacle_ball", "none")

    def unplugged(self):
        """In motion. As in rokviss: the event of high severity, its network down, at rest before its stop is over."""
        begin = self.craft.count()
        motion = threading.Thread(target=self.tc, args=("MOVE_J", self.robot.posture, 0.5))
        motion.start()
        end = time.monotonic() + 10
        first = self.craft.truth(self.robot.name)
        while max(map(abs, self.speeds(first))) < FAST and time.monotonic() < end:
            first = self.craft.truth(self.robot.name)
        self.craft.ask(self.robot.name, "unplug")
        truth = self.craft.truth(self.robot.name)
        while max(map(abs, self.speeds(truth))) > 1e-3 and truth["world_s"] - first["world_s"] < 5:
            truth = self.craft.truth(self.robot.name)
        fastest = max(map(abs, self.speeds(first)))
        self.judge.row("unplugged in motion", f"{fastest:.2f} rad/s or m/s", f">= {FAST}", fastest >= FAST)
        self.judge.at_most("  at rest in its world after", truth["world_s"] - first["world_s"], REST_S, "s", digits=3, of="rest")
        lost(self.craft, self.judge, begin, self.robot.subsystem, "ARM")
        motion.join()
        rest = self.positions()
        time.sleep(0.5)
        self.judge.at_most("  moves then within half a second", furthest(self.positions(), rest), 1e-3, "mrad", 1e3)
        why = self.craft.hirosco("why", "--mission", self.craft.mission, "--instance", self.craft.instance).stdout
        cause = f"{self.robot.subsystem} lost its device ARM"
        self.judge.row("  hirosco why", cause if cause in why else why.strip()[:80], "the cause", cause in why)
        self.craft.fault(self.robot.name, "plug")
        self.up_again()

    def up_again(self):
        done = self.craft.hirosco("mode", "operation", "--mission", self.craft.mission, "--instance", self.craft.instance, seconds=90)
        if done.returncode != 0:
            raise AssertionError(f"hirosco mode operation: {done.stdout}{done.stderr}")
        self.judge.row("  up again by hirosco mode operation", self.state(), "Operational", self.state() == "Operational")

    def refuses(self, what, function, *arguments):
        before = self.positions()
        code = self.tc(function, *arguments)
        words = self.reason()
        self.judge.row(what, words, "it fails, with a reason", code != 0 and "code 0x" in words)
        self.judge.at_most("  moved by it", furthest(self.positions(), before), MOST_RAD, "mrad", 1e3)

    def limits(self):
        bounded = [i for i, its in enumerate(self.robot.ranges) if its is not None]
        narrowest = min(bounded, key=lambda i: self.robot.ranges[i][1])
        beyond = list(self.robot.goal)
        beyond[narrowest] = self.robot.ranges[narrowest][1] + 0.01
        self.refuses(f"goal beyond {self.robot.joints[narrowest]}", "MOVE_J", beyond, 0.5)
        far = [0, 0, 0.99 * self.robot.farthest]
        self.refuses("line out of reach", "MOVE_L", far, self.told()["TOOL.ORIENTATION"], LINE_M_S, LINE_RAD_S)
        self.jogs_to_an_end(bounded)
        self.leans()

    def jogs_to_an_end(self, bounded):
        """The last joint that has an end and a way there: led against it, it stands before it."""
        for joint in reversed(bounded):
            for end, inwards in ((self.robot.ranges[joint][1], -1), (self.robot.ranges[joint][0], 1)):
                near = list(self.robot.goal)
                near[joint] = end + inwards * 0.05 * (self.robot.ranges[joint][1] - self.robot.ranges[joint][0])
                if self.tc("MOVE_J", near, 0.5) == 0:
                    return self.jogs(joint, end, -inwards)
        raise AssertionError("no end of a range was reached")

    def jogs(self, joint, end, sign):
        speed = [0.0] * len(self.robot.joints)
        speed[joint] = sign * min(0.2, 0.5 * self.robot.speeds[joint])
        least = before = sign * (end - self.positions()[joint])
        stopped = ""
        for _ in range(MOST_JOGS):
            if self.tc("JOG_J", speed, 1) != 0:
                stopped = stopped or self.reason()
            left = sign * (end - self.positions()[joint])
            least, gone, before = min(least, left), before - left, left
            if gone < STANDS:
                break
        self.judge.row(f"jogged against the end of {self.robot.joints[joint]}", f"{1e3 * least:.2f} mrad or mm before it", "it stays before it", least >= 0 and gone < STANDS)
        if stopped:
            self.judge.said("  by something else before that", stopped)
        time.sleep(0.5)
        self.judge.row("  stands there", self.state(), "Operational", self.state() == "Operational")
        self.does("MOVE_J", self.robot.goal, 0.5)

    def leans(self):
        """Somebody, ever harder, until a limit has it in Safe-Operational."""
        begin, force = self.craft.count(), FIRST_PUSH_N
        self.does("SET_CONTACT", 0, 1)
        exceeded = False
        while not exceeded and force < MOST_PUSH_N:
            self.craft.fault(self.robot.name, "push", 0, 0, -force)
            with contextlib.suppress(AssertionError):
                exceeded = bool(self.craft.wait_told("_LIMIT_EXCEEDED", PUSHES_S, begin))
            force *= 1.12
        self.craft.fault(self.robot.name, "push", 0, 0, 0)
        self.judge.said("leant on, ever harder", f"{force / 1.12:.0f} N")
        limited(self.craft, self.judge, begin, self.robot.subsystem)
        time.sleep(1)
        rest = max(map(abs, self.speeds(self.craft.truth(self.robot.name))))
        self.judge.at_most("  its drives hold it", rest, 1e-3, "mrad/s", 1e3)
        self.up_again()

    def page(self):
        """What a browser fetches of it."""
        line = self.craft.wait_line(lambda told: "url" in told.content, 10.0)
        origin, token = line.content["url"].split("/#token=")

        def fetched(path):
            asked = urllib.request.Request(origin + path, headers={"Authorization": f"Bearer {token}"})
            with urllib.request.urlopen(asked, timeout=10) as answer:
                return answer.read()
        text = fetched("/").decode()
        self.judge.row("page", f"{len(text)} octets", "of HIROSCO", "HIROSCO" in text)
        described = json.loads(fetched("/api/mission"))
        arms = [each for each in described["subsystems"] if each["name"] == self.robot.subsystem]
        self.judge.row("  the mission has the robot", ", ".join(each["name"] for each in described["subsystems"]), self.robot.subsystem, len(arms) == 1)
        scene = json.loads(fetched("/mission/scene.json"))
        self.judge.row("  the scene has its joints", str(sum(len(each["joints"]) for each in scene["robots"])), f">= {len(self.robot.joints)}",
                       set(self.robot.joints) <= {joint for each in scene["robots"] for joint in each["joints"]})
        named = {parameter for each in scene["robots"] for parameter in each["joints"].values()}
        end = time.monotonic() + 5  # of its housekeeping
        while (silent := named - json.loads(fetched("/api/status"))["values"].keys()) and time.monotonic() < end:
            time.sleep(0.2)
        self.judge.row("  each of them is measured there", ", ".join(sorted(silent)) or "all", "all", not silent)
        files = [file for file in (self.robot.folder / "page").rglob("*") if file.is_file()]
        same = [file for file in files if fetched(f"/mission/{file.relative_to(self.robot.folder / 'page')}") == file.read_bytes()]
        meshes = [file for file in same if file.parent.name == "meshes"]
        self.judge.row("  files of it served, meshes among them", f"{len(same)}, {len(meshes)}", f"{len(files)}, octet for octet", len(same) == len(files) and bool(meshes))


def made(name, file, tip, gripper, judge):
    hirosco("new", "robot", name, "--urdf", file, "--tip", tip, *(["--gripper", gripper] if gripper else []))
    robot = Robot(name, pathlib.Path(name).resolve(), gripper)
    judge.said("made by hirosco new robot", f"{len(robot.octets())} files, {len(robot.joints)} joints")
    told = hirosco("check", "--fly", robot.mission).decode().strip()
    judge.row("hirosco check --fly", told.splitlines()[-1], "no problem", "no problem" in told)
    return robot


def flown(robot, gripper, judge):
    with flight.Flight(robot.mission, instance=f"five_{robot.name}", more=()) as craft:
        of_it = Flown(robot, craft, judge)
        of_it.commissioned()
        of_it.page()
        of_it.goal("goal of its README", robot.goal)
        of_it.goal("where it began", robot.posture)
        of_it.goal("goal of its README again", robot.goal)
        of_it.lines()
        of_it.as_its_readme_says()
        of_it.unplugged()
        of_it.goal("goal behind it", robot.goal)
        of_it.limits()
        of_it.goal("goal behind them", robot.goal)
        judge.row("the flight ended with", str(code := craft.end()), "0", code == 0)


def simulated(robot, judge):
    """The same seed, twice: pushed, and unplugged. What is said, and what its world was."""
    trace = pathlib.Path("trace.csv").resolve()

    def once():
        said = hirosco("simulate", robot.mission, "--for", "6s", "--seed", "7", "--octets", "--trace", trace,
                       "--at", f"2 {robot.name} push 10 0 5", "--at", f"4 {robot.name} unplug")
        return said, trace.read_bytes()
    (first, world), second = once(), once()
    judge.row("simulated twice", f"{len(first)} octets", "the same, ARM_LOST in them", first == second[0] and b"ARM_LOST" in first)
    judge.row("  its world's trace", f"{len(world)} octets", "the same", world == second[1] and world.count(b"\n") > 1000)


def cases(robot, judge):
    done = subprocess.run(["/usr/lib/hirosco/hirosco-robot-cases", robot.mission], capture_output=True, text=True, check=False)
    print("\n".join(f"  {line}" for line in (done.stdout + done.stderr).splitlines()), flush=True)
    found = re.findall(r" {2,}(\d+\.\d+) +(\d+\.\d+) +(\d+\.\d+)(?:  not as required)?$", done.stdout, re.M)
    judge.worst |= {f"{what} of the cases": 1e-3 * max(map(float, column)) for what, column in zip(("goals", "tool", "beside"), zip(*found))}
    judge.row("in worlds that differ from its file", f"ended with {done.returncode}", "0", done.returncode == 0)


def demonstrator():
    """What the robots' reactions are held against."""
    judge = Judge()
    print("demonstrator", flush=True)
    with flight.Flight("/usr/share/hirosco/missions/rokviss/mission.xml", instance="five_rokviss") as craft:
        def again():
            craft.fault("joystick", "hand", "wander")
            done = craft.hirosco("mode", "telepresence", "--mission", craft.mission, "--instance", craft.instance, seconds=90)
            judge.row("  up again by hirosco mode telepresence", f"ended with {done.returncode}", "0", done.returncode == 0)
        craft.wait_commissioned()
        begin = craft.count()
        craft.fault("robot", "unplug")
        judge.said("unplugged", "robot")
        lost(craft, judge, begin, "MANIPULATOR", "ROBOT")
        craft.fault("robot", "plug")
        again()
        begin = craft.count()
        if craft.tc("JOYSTICK", "SET_FORCE_SCALE", 0.08)[0] != 0:
            raise AssertionError(craft.answers)
        craft.fault("joystick", "hand", "cartesian", 0.0325, 0, 1)
        judge.said("pressed against the rail", "a limit of its torque")
        limited(craft, judge, begin, "MANIPULATOR")
        again()
        judge.row("the flight ended with", str(code := craft.end()), "0", code == 0)
    return 1 if judge.failed else 0


def main(name, file, tip, gripper=""):
    judge = Judge()
    print(name, flush=True)
    try:
        os.chdir(tempfile.mkdtemp(prefix="made-", dir=pathlib.Path.home()))
        robot = made(name, file, tip, gripper, judge)
        before = robot.octets()
        flown(robot, gripper, judge)
        simulated(robot, judge)
        cases(robot, judge)
        judge.row("files edited by anybody", str(len(before.items() ^ robot.octets().items())), "0", before == robot.octets())
    except Exception as error:  # whatever stopped it, the others are flown yet
        judge.row("not done", f"{type(error).__name__}: {error}", "", False)
    judge.at_most("all of it", time.monotonic() - judge.began, MOST_S, "s", digits=0, of="all")
    print(f"{name}: {'as required' if not judge.failed else f'{judge.failed} NOT AS REQUIRED'}; " + ", ".join(
        f"{what} {value:.2f} s" if what in ("commissioned", "rest", "all") else f"{what} {1e3 * value:.2f} {'mrad' if what.startswith('goals') else 'mm'}"
        for what, value in judge.worst.items()))
    return 1 if judge.failed else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["demonstrator"]:
        sys.exit(demonstrator())
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
