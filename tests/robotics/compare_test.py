#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The on-board model beside Pinocchio and MuJoCo: robots that none of us wrote, random states, fixed and free.

    compare_test.py PROBE [--states N] [--only PART]

Every robot of example-robot-data with at most 16 joints is compared; every other one must be refused by a named reason. Ends with a
table of the largest relative errors."""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy
import pinocchio

import mujoco_side
import robots

LIMIT = 1e-9
# A mass matrix this badly conditioned leaves fewer digits in any acceleration: then the residual is what is judged.
WORST_CONDITION = 1e6
# No link, and no joint or more than there is room for; everything else must be taken.
REFUSED = {"U0204", "U0309"}


class Judge:
    def __init__(self, path, described, tip):
        self.described = described
        # Every mimic joint as one that moves by itself.
        self.model = pinocchio.buildModelFromUrdf(str(path), pinocchio.JointModelFreeFlyer())
        self.data = self.model.createData()
        self.tip = self.model.getFrameId(tip, pinocchio.FrameType.BODY)
        count = len(described.own)
        # From our velocities (base [w; v], own joints) to Pinocchio's (base [v; w], all joints).
        self.spread = numpy.zeros((self.model.nv, 6 + count))
        self.spread[0:3, 3:6] = self.spread[3:6, 0:3] = numpy.eye(3)
        for name in described.moving:
            joint = self.model.joints[self.model.getJointId(name)]
            own, ratio, _ = self.follows(name)
            self.spread[joint.idx_v, 6 + described.own.index(own)] = ratio

    def follows(self, name):
        ratio, offset = 1.0, 0.0
        while name in self.described.mimic:
            name, factor, shift = self.described.mimic[name]
            offset += ratio * shift
            ratio *= factor
        return name, ratio, offset

    def positions(self, state):
        q = pinocchio.neutral(self.model)
        w, x, y, z = state["wxyz"]
        q[0:7] = [*state["position"], x, y, z, w]
        for name in self.described.moving:
            joint = self.model.joints[self.model.getJointId(name)]
            own, ratio, offset = self.follows(name)
            value = ratio * state["q"][self.described.own.index(own)] + offset
            if joint.nq == 2:
                q[joint.idx_q:joint.idx_q + 2] = [numpy.cos(value), numpy.sin(value)]
            else:
                q[joint.idx_q] = value
        return q

    def says(self, state, free):
        """All that the probe says, with first six coordinates left out of a fixed base."""
        model, data, spread = self.model, self.data, self.spread
        model.gravity.linear = state["gravity"]
        q = self.positions(state)
        v = spread @ numpy.concatenate([state["twist"] if free else numpy.zeros(6), state["qd"]])
        keep = slice(None) if free else slice(6, None)
        mass = pinocchio.crba(model, data, q)
        mass = numpy.triu(mass) + numpy.triu(mass, 1).T
        mass = (spread.T @ mass @ spread)[keep, keep]
        bias = (spread.T @ pinocchio.nonLinearEffects(model, data, q, v))[keep]
        a = spread[:, keep] @ state["acceleration"]
        inverse = (spread.T @ pinocchio.rnea(model, data, q, v, a))[keep]
        if free and not self.described.mimic:
            torque = numpy.linalg.solve(spread.T, state["force"])
            forward = numpy.linalg.solve(spread, pinocchio.aba(model, data, q, v, torque))
        else:
            forward = numpy.linalg.solve(mass, state["force"] - bias)
        pinocchio.forwardKinematics(model, data, q, v, numpy.zeros(model.nv))
        frame = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        swap = [3, 4, 5, 0, 1, 2]
        whole = (pinocchio.computeFrameJacobian(model, data, q, self.tip, frame) @ spread)[swap, :]
        full_mass = spread.T @ (lambda m: numpy.triu(m) + numpy.triu(m, 1).T)(pinocchio.crba(model, data, q)) @ spread
        generalised = whole[:, 6:] - whole[:, :6] @ numpy.linalg.solve(full_mass[:6, :6], full_mass[:6, 6:]) if free else whole[:, 6:]
        pinocchio.forwardKinematics(model, data, q, v, numpy.zeros(model.nv))
        pinocchio.updateFramePlacements(model, data)
        twist = pinocchio.getFrameVelocity(model, data, self.tip, frame).vector[swap]
        drift = pinocchio.getFrameClassicalAcceleration(model, data, self.tip, frame).vector[swap]
        pose = data.oMf[self.tip]
        position, rotation = pose.translation.copy(), pose.rotation.copy()
        momentum = pinocchio.computeCentroidalMomentum(model, data, q, v)
        linear, angular = momentum.linear.copy(), momentum.angular.copy()
        centre = pinocchio.centerOfMass(model, data, q).copy()
        return {"mass_matrix": mass, "bias": bias, "inverse": inverse, "forward": forward, "jacobian": whole[:, keep],
                "generalised_jacobian": generalised, "position": position, "rotation": rotation, "twist": twist, "drift": drift,
                "centre_of_mass": centre, "linear": linear, "angular": angular,
                "kinetic": pinocchio.computeKineticEnergy(model, data, q, v), "potential": pinocchio.computePotentialEnergy(model, data, q)}


def any_state(random, count, free):
    quaternion = random.normal(size=4)
    size = count + (6 if free else 0)
    return {"gravity": random.uniform(-10, 10, 3), "position": random.uniform(-3, 3, 3), "wxyz": quaternion / numpy.linalg.norm(quaternion),
            "twist": random.uniform(-2, 2, 6) if free else numpy.zeros(6), "q": random.uniform(-3, 3, count),
            "qd": random.uniform(-3, 3, count), "force": random.uniform(-20, 20, size), "acceleration": random.uniform(-5, 5, size)}


def line_of(state, free):
    return " ".join(["1" if free else "0", *(repr(float(value)) for name in ("gravity", "position", "wxyz", "twist", "q", "qd", "force", "acceleration") for value in state[name])])


def refused(probe, path, tip):
    done = subprocess.run([probe, path, tip], capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    return (done.returncode != 0) and done.stderr


def asked(probe, path, tip, lines):
    """What was read, and an answer for each line."""
    done = subprocess.run([probe, path, tip], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    head, _, rest = done.stdout.partition("read\n")
    answers = [{(words := row.split())[0]: numpy.array([float(word) for word in words[1:]]) for row in block.splitlines()}
               for block in rest.split("end\n") if block]
    return head.splitlines(), answers


def read_as(head, judge, path):
    """Where our reading differs from Pinocchio's, which is urdfdom's."""
    model, wrong = judge.model, []
    for words in (row.split() for row in head if row.startswith("joint ")):
        name, (damping, friction, lower, upper, velocity, effort) = words[1], map(float, words[2:])
        joint = model.joints[model.getJointId(name)]
        theirs = [model.damping[joint.idx_v], model.friction[joint.idx_v], model.lowerPositionLimit[joint.idx_q],
                  model.upperPositionLimit[joint.idx_q], model.velocityLimit[joint.idx_v], model.effortLimit[joint.idx_v]]
        ours = [damping, friction, lower, upper, velocity, effort]
        if joint.nq == 2:  # turns on and on
            ours[2:4] = theirs[2:4] = [0, 0]
        if any(other == name for other, _, _ in judge.described.mimic.values()):
            ours[0:5] = theirs[0:5]  # what mimics it counts in ours
        if not numpy.allclose(ours, theirs, rtol=1e-12, atol=0):
            wrong.append(f"{path.name}: {name}: {ours} instead of {theirs}")
    mass = float(head[-1].split()[1])
    if abs(mass - pinocchio.computeTotalMass(model)) > 1e-12 * mass:
        wrong.append(f"{path.name}: {mass} kg instead of {pinocchio.computeTotalMass(model)}")
    if (names := [row.split()[1] for row in head if row.startswith("joint ")]) != judge.described.own:
        wrong.append(f"{path.name}: joints are {names}")
    return wrong


def error_of(name, ours, theirs, says):
    theirs = numpy.asarray(theirs, dtype=float)
    difference = ours - theirs.reshape(-1)
    if name == "forward" and numpy.linalg.cond(says["mass_matrix"]) > WORST_CONDITION:
        theirs = says["mass_matrix"] @ theirs
        difference = says["mass_matrix"] @ difference
    # Of matrices and vectors the largest entry is the measure; what is all zero is measured against 1.
    return float(numpy.abs(difference).max() / max(numpy.abs(theirs).max(), 1e-3))


def compare(probe, path, states, seed):
    described = robots.Described(path)
    tip = described.ends[-1]
    judge = Judge(path, described, tip)
    random = numpy.random.default_rng(seed)
    wanted = [(any_state(random, len(described.own), free), free) for free in (False, True) for _ in range(states)]
    head, answers = asked(probe, path, tip, [line_of(state, free) for state, free in wanted])
    problems = read_as(head, judge, path)
    if len(answers) != len(wanted):
        problems.append(f"{path.name}: {len(answers)} answers to {len(wanted)} states")
    worst = {}
    for (state, free), answer in zip(wanted, answers):
        says = judge.says(state, free)
        for name, theirs in says.items():
            error = error_of(name, answer[name], theirs, says)
            worst[name] = max(worst.get(name, 0), error)
    engine = mujoco_side.compare(path, described, wanted, answers, head)
    problems += [f"{path.name}: {name} differs from Pinocchio's by {error:.1e}" for name, error in worst.items() if not error <= LIMIT]
    problems += [f"{path.name}: {name} differs from MuJoCo's by {error:.1e}" for name, error in engine.errors.items() if not error <= LIMIT]
    problems += engine.wrong
    print(f"{path.stem:32s} {len(described.own):2d} joints, {len(described.mimic)} mimic, {len(wanted)} states: largest error to Pinocchio {max(worst.values()):.1e} "
          f"({max(worst, key=worst.get)}), to MuJoCo {engine.text()}", flush=True)
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("probe")
    parser.add_argument("--states", type=int, default=50)
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    given.probe = str(pathlib.Path(given.probe).resolve())
    os.chdir(tempfile.mkdtemp())  # MuJoCo writes a log where it is
    problems, taken, left = [], 0, 0
    for number, path in enumerate(robots.files()):
        if given.only not in path.as_posix():
            continue
        described = robots.Described(path)
        said = refused(given.probe, path, described.ends[-1] if described.ends else "none")
        if said:
            codes = set(re.findall(r"^U\d{4}", said, re.M))
            large = len(described.own) > robots.MOST_JOINTS or not described.own
            if not large or not codes & REFUSED:
                problems.append(f"{path.name} is refused: {said.strip()}")
            left += 1
            print(f"{path.stem:32s} refused: {next((row for row in said.splitlines() if row[:5] in REFUSED), said)}")
            continue
        taken += 1
        problems += compare(given.probe, path, given.states, number)
    print(f"{taken} robots compared, {left} refused by name")
    if not given.only and (taken < 30 or taken + left != 69):
        problems.append("not all of the 69 were tried")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
