#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The rest positions of RO2 and RO4 in missions/rokviss/expected.csv, solved here from the closed form alone.

At rest, without friction:  kh (phi_i - phi) = s_f tau,  kp (qd - theta) = tau = K (theta - q) = J(q)^T F(q),
qd = q_home + phi, and the hand intends phi_i = J(q_home)^-1 d. Shares no code with the model or the control laws.
"""
import csv
import math
import pathlib
import unittest

KP, K, KH, SF = 300.0, 4000.0, 4.3, 0.02
L1, L2, HOME = 0.25, 0.22, (-0.80, 1.60)
COMPLIANCE = SF / KH + 1 / KP + 1 / K


def tip(q):
    return (L1 * math.cos(q[0]) + L2 * math.cos(q[0] + q[1]), L1 * math.sin(q[0]) + L2 * math.sin(q[0] + q[1]))


def jacobian(q):
    (x, y), x2, y2 = tip(q), L2 * math.cos(q[0] + q[1]), L2 * math.sin(q[0] + q[1])
    return ((-y, -y2), (x, x2))


def at_rest(offset, force_on_surroundings):
    """Torques of the joints, the angles and the force when the hand intends `offset` from home."""
    (a, b), (c, d) = jacobian(HOME)
    det = a * d - b * c
    intended = ((d * offset[0] - b * offset[1]) / det, (-c * offset[0] + a * offset[1]) / det)
    tau = [0.0, 0.0]
    for _ in range(200_000):
        q = [HOME[i] + intended[i] - COMPLIANCE * tau[i] for i in (0, 1)]
        force, j = force_on_surroundings(q), jacobian(q)
        error = [j[0][i] * force[0] + j[1][i] * force[1] - tau[i] for i in (0, 1)]
        if max(map(abs, error)) < 1e-12:
            return tau, q, force
        tau = [tau[i] + 0.002 * error[i] for i in (0, 1)]
    raise ArithmeticError("no rest position")


def rail(q):
    return (5e4 * max(0.0, tip(q)[0] + 0.010 - 0.350), 0.0)


def spring(anchor):
    def force(q):
        x, y = tip(q)[0] - anchor[0], tip(q)[1] - anchor[1]
        length = math.hypot(x, y)
        pull = 400 * max(0.0, length - 0.05) / length
        return (pull * x, pull * y)
    return force


class Equilibria(unittest.TestCase):
    def setUp(self):
        file = pathlib.Path(__file__).resolve().parents[1] / "expected.csv"
        with file.open(encoding="utf-8") as lines:
            self.table = {row["name"]: row for row in csv.DictReader(lines)}

    def agrees(self, name, value):
        row = self.table[name]
        self.assertLessEqual(abs(float(row["value"]) - value), 0.05 * float(row["tolerance"]), f"{name}: {value}")

    def test_pressing_the_rail(self):
        for dx in (17.6, 22.6, 27.6):
            tau, _, force = at_rest((dx * 1e-3, 0), rail)
            self.agrees(f"RO2-{dx}mm-force", force[0])
            self.agrees(f"RO2-{dx}mm-penetration", force[0] / 5e4 * 1e3)
            self.agrees(f"RO2-{dx}mm-tau2", tau[1])
            self.agrees(f"RO2-{dx}mm-windup2", tau[1] / K * 1e3)

    def test_pulling_the_springs(self):
        for name, anchor, offset in (("vertical", (0.3275, 0.050), (0, -0.0085)),
                                     ("horizontal", (0.280, -0.0215), (0.008, -0.030))):
            tau, _, _ = at_rest(offset, spring(anchor))
            self.agrees(f"RO4-{name}-tau1", tau[0])
            self.agrees(f"RO4-{name}-tau2", tau[1])


if __name__ == "__main__":
    unittest.main()
