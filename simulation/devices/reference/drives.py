# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What arm.py drives: 6 joints in the air, in the place of your vendor's library. Put its calls here, none of which may wait."""
JOINTS = 6

class Drives:
    def __init__(self):
        self.enabled = self.fault = False                      # what they report, not what they were told
        self.angle, self.speed, self.torque = ([0.0] * JOINTS for _ in range(3))
    def enable(self):                                          # brakes open; refused while there is a fault
        self.enabled = not self.fault
    def stop(self):                                            # brakes by themselves, then brakes fall in
        self.enabled, self.torque = False, [0.0] * JOINTS
    def clear(self):                                           # what still holds is there again by the next step
        self.fault = False
    def step(self, torque, cycle):                             # for a real one: write the torques, read the rest
        self.torque = torque if self.enabled else self.torque
        self.speed = [v + t * cycle / 0.5 if self.enabled else max(abs(v) - 20 * cycle, 0) * (1 if v > 0 else -1) for v, t in zip(self.speed, self.torque)]
        self.angle = [q + v * cycle for q, v in zip(self.angle, self.speed)]
        if max(map(abs, self.speed)) > 3:                      # too fast: they fault, and stop by themselves
            self.fault = True
            self.stop()
