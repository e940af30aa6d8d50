#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco dynamics`: what it tells is Pinocchio's, its motion that of a Runge-Kutta written here, a tumble keeps its momentum, and whatever is
wrong is told.

    command_test.py HIROSCO"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import pinocchio

import compare_test
import robots

LIMIT = 1e-9
ROBOTS = {"ur5_robot": "tool0", "panda": "panda_hand_tcp", "xarm7": "link_eef", "kinova": "j2s6s200_link_finger_1", "tiago_no_hand": "wrist_ft_tool_link",
          "ur3_robot": "ee_link", "z1": "gripperMover"}
failures = []


def expect(holds, what):
    print(("ok      " if holds else "FAILED  ") + what, flush=True)
    if not holds:
        failures.append(what)


def path_of(name):
    return next(path for path in robots.files() if path.stem == name)


def tip_of(path, wanted):
    links = robots.Described(path).links
    return wanted if wanted in links else robots.Described(path).ends[-1]


def run(hirosco, path, lines, tip=None):
    text = "".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in lines)
    done = subprocess.run([hirosco, "dynamics", str(path), *(["--tip", tip] if tip else [])], input=text, capture_output=True, text=True, check=False)
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()], done.stderr


def question(state, free, **others):
    return {"fixed_base": not free, "gravity_m_s2": list(state["gravity"]), "base_position_m": list(state["position"]),
            "base_orientation_wxyz": list(state["wxyz"]), "base_twist": list(state["twist"]), "q": list(state["q"]), "qd": list(state["qd"]),
            "torque": list(state["force"][-len(state["q"]):]), "step_s": 0.001, "end_s": 0, "output_s": [0], **others}


def error(ours, theirs):
    ours, theirs = numpy.asarray(ours, dtype=float), numpy.asarray(theirs, dtype=float)
    return numpy.abs(ours - theirs).max() / max(numpy.abs(theirs).max(), 1e-3)


def damping_of(judge):
    """Of our coordinates."""
    return numpy.diag(judge.spread.T @ numpy.diag(judge.model.damping) @ judge.spread)


def told_as_pinocchio_has_it(hirosco, name, tip):
    path = path_of(name)
    described, random, worst = robots.Described(path), numpy.random.default_rng(5), {}
    judge = compare_test.Judge(path, described, tip)
    for free in (False, True):
        states = [compare_test.any_state(random, len(described.own), free) for _ in range(20)]
        code, answers, _ = run(hirosco, path, [question(state, free) for state in states], tip)
        expect(code == 0 and len(answers) == len(states), f"{name}: each line is answered")
        for state, told in zip(states, answers):
            # Only the joints are driven; the damping of the file is in force.
            if free:
                state["force"][:6] = 0
            state["force"] = state["force"] - (damping_of(judge) if free else damping_of(judge)[6:]) * numpy.concatenate([state["twist"] if free else [], state["qd"]])
            says = judge.says(state, free)
            own = {"mass_matrix": says["mass_matrix"], "jacobian": says["jacobian"], "generalised_jacobian": says["generalised_jacobian"],
                   "momentum_linear": says["linear"], "momentum_angular_com": says["angular"], "energy_j": says["kinetic"] + says["potential"]}
            for what, theirs in own.items():
                worst[what] = max(worst.get(what, 0), error(told[what], theirs))
            wanted = says["forward"][-len(described.own):]
            if numpy.linalg.cond(says["mass_matrix"]) < compare_test.WORST_CONDITION:
                worst["qdd"] = max(worst.get("qdd", 0), error(told["qdd"], wanted))
    expect(max(worst.values()) <= LIMIT, f"{name}: all that is told is Pinocchio's to {max(worst.values()):.1e} ({max(worst, key=worst.get)})")


def slope(judge, free, wrench_of, t, y, count):
    """y: position, quaternion xyzw, twist, q, qd."""
    quaternion = y[3:7] / numpy.linalg.norm(y[3:7])
    state = {"gravity": judge.gravity, "position": y[:3], "wxyz": quaternion[[3, 0, 1, 2]], "twist": y[7:13], "q": y[13:13 + count], "qd": y[13 + count:]}
    force = numpy.concatenate([numpy.zeros(6), wrench_of(t)]) - damping_of(judge) * numpy.concatenate([y[7:13], state["qd"]])
    state["force"] = force if free else force[6:]
    state["acceleration"] = 0 * state["force"]
    acceleration = judge.says(state, free)["forward"]
    rate = numpy.zeros_like(y)
    if free:
        rotation = pinocchio.Quaternion(*state["wxyz"]).toRotationMatrix()
        w, v = y[7:10], y[3:7]
        rate[:3] = rotation @ y[10:13]
        rate[3:6] = 0.5 * (v[3] * w + numpy.cross(v[:3], w))
        rate[6] = -0.5 * v[:3] @ w
        rate[7:13] = acceleration[:6]
    rate[13:13 + count] = state["qd"]
    rate[13 + count:] = acceleration[-count:]
    return rate


def stepped(f, t, h, y):
    a = f(t, y)
    b = f(t + h / 2, y + h / 2 * a)
    c = f(t + h / 2, y + h / 2 * b)
    d = f(t + h, y + h * c)
    y = y + h / 6 * (a + 2 * b + 2 * c + d)
    y[3:7] /= numpy.linalg.norm(y[3:7])
    return y


def moves_as_a_runge_kutta_of_ours(hirosco, name, tip, free):
    path = path_of(name)
    described = robots.Described(path)
    count = len(described.own)
    judge = compare_test.Judge(path, described, tip)
    random = numpy.random.default_rng(9)
    state = compare_test.any_state(random, count, free)
    state["qd"] *= 0.3
    table = [[0.02, *(0.2 * random.uniform(-1, 1, count))], [0.06, *(0.2 * random.uniform(-1, 1, count))]]
    step, outputs = 0.01, [0, 0.034, 0.1]
    code, told, _ = run(hirosco, path, [question(state, free, step_s=step, end_s=0.1, output_s=outputs, torque_table=table) | {"torque": None}], tip)
    expect(code == 1 and "error" in told[0], f"{name}: torque and torque_table together are refused")
    asked = question(state, free, step_s=step, end_s=0.1, output_s=outputs, torque_table=table)
    del asked["torque"]
    code, told, _ = run(hirosco, path, [asked], tip)
    judge.gravity = state["gravity"]
    y = numpy.concatenate([state["position"], state["wxyz"][[1, 2, 3, 0]], state["twist"], state["q"], state["qd"]])

    def torque(t):
        return numpy.array([numpy.interp(t, [row[0] for row in table], [row[1 + i] for row in table]) for i in range(count)])

    def f(t, at):
        return slope(judge, free, torque, t, at, count)
    worst, steps = 0, {0: y}
    for i in range(10):
        steps[i + 1] = stepped(f, i * step, step, steps[i])
    wanted = [y, stepped(f, 3 * step, 0.034 - 3 * step, steps[3]), steps[10]]
    for answer, theirs in zip(told, wanted):
        ours = numpy.concatenate([answer["base_position_m"], numpy.array(answer["base_orientation_wxyz"])[[1, 2, 3, 0]], answer["base_twist"], answer["q"], answer["qd"]])
        worst = max(worst, error(ours, theirs))
    expect(code == 0 and len(told) == 3 and worst <= LIMIT, f"{name}, {'free' if free else 'fixed'}: moves as Pinocchio under a Runge-Kutta written here, to {worst:.1e}, also between steps")


def keeps_momentum(hirosco, name, tip, step_s, end_s):
    path = path_of(name)
    count = len(robots.Described(path).own)
    random = numpy.random.default_rng(3)
    state = compare_test.any_state(random, count, True) | {"gravity": numpy.zeros(3), "force": numpy.zeros(6 + count)}
    state["twist"] *= 0.2
    state["qd"] *= 0.1
    asked = question(state, True, step_s=step_s, end_s=end_s, output_s=[end_s * i / 12 for i in range(13)])
    code, told, _ = run(hirosco, path, [asked], tip)
    worst = max(max(error(each[what], told[0][what]) for what in ("momentum_linear", "momentum_angular_com")) for each in told)
    # The joints, or the base where they are damped so hard that they stand.
    turned = max(numpy.abs(numpy.array(each[what]) - told[0][what]).max() for what in ("q", "base_orientation_wxyz") for each in told)
    expect(code == 0 and len(told) == 13 and worst <= LIMIT and turned > min(0.5, 0.1 * end_s), f"{name}: a tumble of {end_s} s in steps of {step_s} s keeps its momentum to {worst:.1e} (turned by up to {turned:.1f})")


def told_which_step_it_bears(hirosco, name, tip):
    count = len(robots.Described(path_of(name)).own)
    asked = question(compare_test.any_state(numpy.random.default_rng(3), count, True), True, step_s=0.001, end_s=1, output_s=[0, 1])
    code, told, _ = run(hirosco, path_of(name), [asked], tip)
    expect(code == 1 and "bears steps up to about" in told[-1]["error"], f"{name}, damped hard, in steps that are too long: {told[-1]['error']}")


def tells_what_is_wrong(hirosco, name, tip):
    path = path_of(name)
    count = len(robots.Described(path).own)
    state = compare_test.any_state(numpy.random.default_rng(1), count, False)
    good = question(state, False)
    bad = dict(good, q=[0])
    code, told, _ = run(hirosco, path, [good, "no json", "", bad, good], tip)
    expect(code == 1 and [list(each) for each in told if "error" in each] == [["error", "line"]] * 2, "a bad line is answered with error and line, exit code 1")
    expect([each["line"] for each in told if "error" in each] == [2, 4] and len(told) == 4, "lines are counted from 1, the good ones are answered")
    code, told, said = run(hirosco, path_of("kinova"), [])
    expect(code == 0 and "--tip" in said and "the tip is " in said and "finger" in said, "where there are several tips the one that most joints move is taken, which is told")
    code, _, said = run(hirosco, path_of("kinova"), [], "nobody")
    expect(code == 2 and "nobody" in said, "a tip that is no link is refused")
    code, _, said = run(hirosco, path_of("ur3"), [])
    expect(code == 1 and "ur3.urdf:" in said and "U0204" not in told, "a file without links is refused with its place")
    code, _, said = run(hirosco, path_of("romeo"), [])
    expect(code == 1 and "at most 16" in said, "a robot that is too large is refused with the numbers")
    with tempfile.TemporaryDirectory() as folder:
        template = pathlib.Path(folder) / "a.xacro"
        template.write_text('<robot name="a" xmlns:xacro="x"><xacro:property name="m" value="1"/></robot>')
        code, _, said = run(hirosco, template, [])
        expect(code == 1 and "xacro" in said and "expand it first" in said, "a template of xacro is refused in words")
    helped = subprocess.run([hirosco, "dynamics", "--help"], capture_output=True, text=True, check=False)
    expect(helped.returncode == 0 and "friction is ignored" in helped.stdout and "straight lines" in helped.stdout, "--help says the conventions")


def reads_no_more_than_it_says(hirosco, name, tip):
    path = path_of(name)
    good = json.dumps(question(compare_test.any_state(numpy.random.default_rng(2), len(robots.Described(path).own), False), False)).encode() + b"\n"
    command = [hirosco, "dynamics", str(path), "--tip", tip]
    asked = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    for _ in range(257):
        asked.stdin.write(b"1" * 2**20)
    told, _ = asked.communicate(b"\n" + good)
    told = [json.loads(line) for line in told.splitlines()]
    expect(asked.returncode == 1 and told[:1] == [{"error": "the line is longer than 256 MiB", "line": 1}], "a line that is too long is refused for that")
    expect(len(told) == 2 and "q" in told[1], "and the line behind it is answered")
    with tempfile.TemporaryDirectory() as folder:
        unreadable = os.open(folder, os.O_RDONLY)
        done = subprocess.run(command, stdin=unreadable, capture_output=True, text=True, check=False)
        os.close(unreadable)
    expect(done.returncode == 3 and "standard input cannot be read: Is a directory" in done.stderr and done.stdout == "", "what cannot be read is told, exit code 3")


def main():
    hirosco = sys.argv[1]
    for name, wanted in ROBOTS.items():
        told_as_pinocchio_has_it(hirosco, name, tip_of(path_of(name), wanted))
    # Of those whose damping a step of 1 ms can bear.
    for name in ("ur5_robot", "panda"):
        for free in (False, True):
            moves_as_a_runge_kutta_of_ours(hirosco, name, tip_of(path_of(name), ROBOTS[name]), free)
    # xarm7 and tiago are damped harder; with the steps that the latter needs a minute takes one.
    for name, step_s, end_s in (("ur5_robot", 1e-3, 60), ("ur3_robot", 1e-3, 60), ("panda", 1e-3, 60), ("kinova", 1e-3, 60), ("xarm7", 5e-5, 60), ("tiago_no_hand", 1e-5, 2)):
        keeps_momentum(hirosco, name, tip_of(path_of(name), ROBOTS[name]), step_s, end_s)
    told_which_step_it_bears(hirosco, "tiago_no_hand", tip_of(path_of("tiago_no_hand"), ROBOTS["tiago_no_hand"]))
    tells_what_is_wrong(hirosco, "xarm7", tip_of(path_of("xarm7"), ROBOTS["xarm7"]))
    reads_no_more_than_it_says(hirosco, "xarm7", tip_of(path_of("xarm7"), ROBOTS["xarm7"]))
    print(f"{len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
