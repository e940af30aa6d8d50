# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_campaign.py demands of a network that has lost one of its members, by death, hang or an unplugged device: actuators safe within 5
cycles, everybody else in Error-Operational within 10, whoever the plan takes down Offline within 2 s. Read from the pages of each, in cycles of
whoever acts."""
import re
import time

import pages
from demands import Demands, expect

CYCLE_S = 0.0005
GRID_S = 2 * pages.PERIOD_S         # what the watch's own grid adds
LOOK_S = 0.010                      # and a look at the world from outside
SAFE_CYCLES, ERROR_CYCLES, OFFLINE_S = 5, 10, 2.0
SAFE_S, ERROR_S = SAFE_CYCLES * CYCLE_S + GRID_S, ERROR_CYCLES * CYCLE_S + GRID_S
OFFLINE, SAFE_OPERATIONAL, OPERATIONAL, ERROR_OPERATIONAL = 0, 4, 5, 6
TOLD_S = 0.05                       # until what is told of stands on every page
NAMES = {"hirosco-spinnable-manipulator": "MANIPULATOR", "hirosco-spinnable-joystick": "JOYSTICK"}
# Behind each loss the same, each with its deadline. What the guard takes to be sure of a hang has its own.
DEATH, UNPLUGGING, HANG = "a death", "an unplugging", "a hang"
_SAFE = {"network fenced": SAFE_S, "others inhibited": SAFE_S, "robot obeys nobody": SAFE_CYCLES * CYCLE_S + LOOK_S}
_DOWN = {"others in error": ERROR_S, "all Offline": OFFLINE_S}
DEADLINES_S = {f"{what} behind {loss}": seconds for loss, all_of in ((DEATH, _SAFE | _DOWN), (UNPLUGGING, _SAFE | _DOWN), (HANG, _DOWN))
               for what, seconds in all_of.items()}


class Reactions(Demands):
    def held_to(self, what, loss, took, late):
        """`took`: seconds, what is counted in cycles too."""
        row = f"{what} behind {loss}"
        expect(took <= DEADLINES_S[row] + late, f"{row} only after {1e3 * took:.1f} ms")
        self.took(row, max(0.0, took))

    def is_safe(self, watch, loss, since, others):
        """`since`: when it could be known. The page of each member forbids what its actuators would do, and each of `others`, who live, has
        done so in its own cycle."""
        expect(set(watch.fenced) == set(NAMES), f"fenced behind {loss} were only {set(watch.fenced)}")
        fenced = max(watch.fenced.values()) - since
        self.held_to("network fenced", loss, fenced, self.late_s(watch, since, since + fenced))
        took = []
        for other in others:
            look = watch.first(other, lambda look: look.inhibited, since)
            expect(look is not None, f"the actuators of {NAMES[other]} were not inhibited behind {loss}")
            took.append((look.inhibited_at_cycle - watch.cycles_before(other, since)) * CYCLE_S)
        self.held_to("others inhibited", loss, max(took), self.late_s(watch, since, since + max(took)))

    def comes_down(self, watch, loss, since, others, ended=0.0):
        """Each of `others` by Error-Operational to Offline, and they are those whom the plan takes down with who was lost, which has `ended` by
        then."""
        taken = [line.told for line in self.craft.told(self.begin) if "to ErrorOperational and down" in line.told]
        expect(taken, f"no plan took the network down behind {loss}")
        network = set(re.search(r"network \{([^}]*)\}", taken[0])[1].split(", "))
        expect(network == set(NAMES.values()), f"behind {loss} the plan took down {network}")
        error, down = [], [ended - since]
        for other in others:
            name = NAMES[other]
            told = [line for line in self.craft.told(self.begin) if f"{name} info STATE_CHANGED STATE=ErrorOperational" in line.told]
            left = watch.first(other, lambda look: look.state not in (SAFE_OPERATIONAL, OPERATIONAL), since)
            expect(told and left is not None, f"{name} was not in Error-Operational behind {loss}")
            error.append((left.cycles - watch.cycles_before(other, since)) * CYCLE_S)
            offline = watch.first(other, lambda look: look.state == OFFLINE, since)
            expect(offline is not None, f"{name} was not Offline behind {loss}")
            down.append(offline.at - since)
        self.held_to("others in error", loss, max(error), self.late_s(watch, since, since + max(error)))
        self.held_to("all Offline", loss, max(down), self.late_s(watch, since, since + max(down)))

    def look_before(self):
        """What the world was at latest at this instant."""
        return self.craft.truth("robot")["world_s"], time.monotonic()

    def obeys_nobody(self, watch, loss, since, before):
        """In the time of its world, which leaves out how late the host was."""
        world_s, looked = before
        obeyed = self.craft.truth("robot")["obeyed_s"] - world_s - (since - looked)
        self.held_to("robot obeys nobody", loss, obeyed, self.late_s(watch, since, since + max(0.0, obeyed)))

    def until_offline(self, names):
        """As it is told, so that it stands on the pages, or for longer than it may take: whether and when it was so is judged there."""
        end = time.monotonic() + OFFLINE_S + LOOK_S
        for name in names:
            self.craft.wait_line(lambda line, name=name: f"{name} is Offline" in line.told, end - time.monotonic(), self.begin)
        time.sleep(TOLD_S)
