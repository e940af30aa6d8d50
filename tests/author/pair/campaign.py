# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What random flights may do to this mission's devices besides what every device takes, and the modes that they begin and end in."""

MOSTLY = "coupled"
DRIVEN = ["coupled", "coupled", "coupled", "alone"]
RESTS = ["hand hold 0 0"]
ENDS = ["coupled", "alone"]
FAULTS = {"MANIPULATOR": ["temperature"], "JOYSTICK": ["hand"]}


def lines(random):
    return {"temperature": f"temperature {random.choice([1, 2])} {random.choice([56, 72, 81, 20])}",
            "hand": random.choice(["hand wander", "hand hold 0.1 0.1", "hand sine 1 0.3 2"])}
