# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What random flights (simulation/campaign) may do to this mission's devices besides what every device takes."""

MOSTLY = "telepresence"
DRIVEN = ["telepresence", "telepresence", "feel", "standalone"]
FIRST, HOOKED = ["hook"], "standalone"     # a spring can be hooked where the robot begins
RESTS = ["hand hold 0 0"]
ENDS = ["telepresence", "standalone"]
FAULTS = {"MANIPULATOR": ["temperature", "hook", "release", "friction", "noise", "thermal_accel"], "JOYSTICK": ["hand"]}


def lines(random):
    return {"temperature": f"temperature {random.choice([1, 2])} {random.choice([56, 72, 81, 20])}", "hook": f"hook {random.choice([1, 2, 2, 2])}",
            "friction": f"friction {random.choice(['on', 'off'])}", "noise": f"noise {random.choice([0, 0.1, 2])}",
            "thermal_accel": f"thermal_accel {random.choice([0, 10])}",
            "hand": random.choice(["hand wander", "hand cartesian 0.0226 0 0.2", "hand sine 1 0.3 2", "hand hold 0.1 0.1", "hand ramp 0.05 0 1"])}
