# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What MuJoCo makes of a URDF file: its masses, joints, limits and damping, and the mass matrix and forces at a state.

MuJoCo welds the root link to the world unless it is given a free joint; it knows no mimic joints in URDF and refuses inertias that no body
has. Robots with either are left out by name."""
import re

import mujoco
import numpy

import robots

COMPILER = ('<mujoco><compiler fusestatic="false" discardvisual="true" balanceinertia="false" boundmass="0" boundinertia="0" '
            'strippath="false" autolimits="true"/></mujoco>')


class Found:
    def __init__(self):
        self.errors, self.wrong, self.why = {}, [], ""

    def text(self):
        return f"{max(self.errors.values()):.1e} ({max(self.errors, key=self.errors.get)})" if self.errors else f"not compared: {self.why}"


def load(path):
    text = robots.without_shapes(path)
    # A link of this name would be MuJoCo's own world, which has no joint.
    text = re.sub(r'(["\'])world\1', '"world_link"', text)
    at = text.index(">", text.index("<robot")) + 1
    spec = mujoco.MjSpec.from_string(text[:at] + COMPILER + text[at:])
    spec.worldbody.first_body().add_freejoint()
    return spec.compile()


def matrix(wxyz):
    result = numpy.zeros(9)
    mujoco.mju_quat2Mat(result, numpy.asarray(wxyz))
    return result.reshape(3, 3)


def read_as(head, model, path):
    """Where our reading differs from MuJoCo's."""
    wrong = []
    for words in (row.split() for row in head if row.startswith("joint ")):
        name, (damping, friction, lower, upper, _, _) = words[1], map(float, words[2:])
        joint = model.joint(name)
        theirs = [model.dof_damping[joint.dofadr[0]], model.dof_frictionloss[joint.dofadr[0]], *joint.range]
        ours = [damping, friction, lower, upper]
        if not model.jnt_limited[joint.id]:  # it turns on and on, or both limits are one
            ours[2:4] = theirs[2:4] = [0, 0] if not numpy.isfinite(upper) or lower == upper else [1, 0]
        if not numpy.allclose(ours, theirs, rtol=1e-12, atol=0):
            wrong.append(f"{path.name}: {name}: {ours} instead of MuJoCo's {theirs}")
    mass = float(head[-1].split()[1])
    if abs(mass - model.body_mass.sum()) > 1e-12 * mass:
        wrong.append(f"{path.name}: {mass} kg instead of MuJoCo's {model.body_mass.sum()}")
    return wrong


def compare(path, described, wanted, answers, head):
    found = Found()
    if described.mimic:
        found.why = "mimic joints"
        return found
    try:
        model = load(path)
    except ValueError as error:
        found.why = str(error).splitlines()[0][:80]
        return found
    found.wrong = read_as(head, model, path)
    data = mujoco.MjData(model)
    joints = [model.joint(name) for name in described.own]
    for (state, free), answer in zip(wanted, answers):
        rotation = matrix(state["wxyz"])
        model.opt.gravity[:] = state["gravity"]
        data.qpos[0:3], data.qpos[3:7] = state["position"], state["wxyz"]
        # Linear velocity in inertial axes first, then the angular one in the body's.
        data.qvel[0:3], data.qvel[3:6] = rotation @ state["twist"][3:], state["twist"][:3]
        spread = numpy.zeros((model.nv, 6 + len(joints)))
        spread[0:3, 3:6], spread[3:6, 0:3] = rotation, numpy.eye(3)
        for i, joint in enumerate(joints):
            data.qpos[joint.qposadr[0]], data.qvel[joint.dofadr[0]] = state["q"][i], state["qd"][i]
            spread[joint.dofadr[0], 6 + i] = 1
        mujoco.mj_forward(model, data)
        full = numpy.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        keep = slice(None) if free else slice(6, None)
        mass = (spread.T @ full @ spread)[keep, keep]
        # The base's own axes turn: their rate comes besides.
        turning = numpy.zeros(model.nv)
        turning[0:3] = rotation @ numpy.cross(state["twist"][:3], state["twist"][3:])
        bias = (spread.T @ (data.qfrc_bias + full @ turning))[keep]
        for name, theirs in (("mass_matrix", mass), ("bias", bias)):
            error = numpy.abs(answer[name] - theirs.reshape(-1)).max() / max(numpy.abs(theirs).max(), 1e-3)
            found.errors[name] = max(found.errors.get(name, 0), float(error))
    return found
