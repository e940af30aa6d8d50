# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What arm.py drives: 6 joints in the air, in the place of your vendor's library. Put its calls here, none of which may wait."""
JOINTS = 6
MOST = 150.0                                                   # N m, the greatest `maximum` of TORQUE in <Output>: a command with more is answered, and not done
ROTOR = 0.5                                                    # kg m2, behind the gear; the links of this stand-in carry nothing

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
        before = self.speed
        self.speed = [v + t * cycle / ROTOR if self.enabled else max(abs(v) - 20 * cycle, 0) * (1 if v > 0 else -1) for v, t in zip(before, torque)]
        # What a joint gives to its link, as a sensor there tells it: what turns the rotor is not in it.
        self.torque = [t - ROTOR * (after - v) / cycle if self.enabled else 0.0 for t, v, after in zip(torque, before, self.speed)]
        self.angle = [q + v * cycle for q, v in zip(self.angle, self.speed)]
        if max(map(abs, self.speed)) > 3:                      # too fast: they fault, and stop by themselves
            self.fault = True
            self.stop()
