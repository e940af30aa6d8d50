# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""In some flights the supervisor dies or hangs, and another one goes on (docs/adr/0183). By a dice of its own, and drawn last of all: other flights
stay as they are."""
import random

from descriptors import OPERATIONAL

LOSSES = 0.5               # of flights, but for those that end with an unplug that ground silenced
# What is under way then: nothing, for a moment or for longer than a subsystem goes on alone, the change of a mode, a plan, a stop, or anything.
LOST_IN = ["nothing", "nothing", "nothing", "nothing for long", "nothing for long", "mode", "plan", "stop", "anything", "anything"]
SHORT = ["kill {} 300"] * 3 + ["kill {} 50", "kill {} 1000", "hang {} 50", "hang {} 300", "hang {} 700", "hang {} 5000"]  # milliseconds
LONG = ["kill {} 2300", "kill {} 3000", "kill {} 4000"]
NEXT_ONE_S = 0.3           # after one that dies, mostly
BEGINS_S = 1.0             # from the end of all faults: who died is back by then
ALONE_S = 1.1              # from there on the craft is left alone before it loses its supervisor
EPISODE_S = 9.0            # of which all else is taken out


def dice_of(flight_seed):
    return random.Random(f"losses of the supervisor {flight_seed}")


def loses(flight_seed):
    return dice_of(flight_seed).random() < LOSSES


def lose_supervisor(plan, flight_seed, begin_s, finale_s):
    dice = dice_of(flight_seed)
    dice.random()
    what = dice.choice(LOST_IN)
    if what == "anything":
        crossed = [time for time, _ in plan.lines if begin_s + 0.4 < time < finale_s - 2]
        for _ in range(dice.choice([1, 1, 2, 3]) if crossed else 0):
            lose(plan, dice, dice.choice(crossed) + dice.choice([0.0, 0.0002, 0.001, 0.002, 0.005, 0.02, 0.1]))
        return
    time = left_alone(plan, dice.uniform(begin_s + 0.4, finale_s - EPISODE_S - 0.5)) + ALONE_S + dice.uniform(0, 0.02)
    after = dice.choice([0.0, 0.0005, dice.uniform(0, 0.02), dice.uniform(0, 0.2), dice.uniform(0, 0.6)])
    if what == "nothing for long":
        return lose(plan, dice, time, LONG)
    begin_what(plan, dice, what, time)
    lose(plan, dice, time + after)
    if dice.random() < 0.3:  # and the next one, too, as it goes on or soon after
        lose(plan, dice, time + after + NEXT_ONE_S + dice.choice([0.0001, dice.uniform(0, 0.03), dice.uniform(0, 0.3)]))


def lose(plan, dice, time, ways=SHORT):
    plan.add(time, dice.choice(ways).format(plan.mission.supervisor.name))


def left_alone(plan, begin):
    """Nothing else happens for the time of an episode: the faults end, what the mission itself moves rests, what ground silenced is heard again, so that a
    member that stops for a reason of its own says so, and all who act are brought up. When they are."""
    plan.lines = [line for line in plan.lines if not begin <= line[0] < begin + EPISODE_S]
    plan.struck = {"LOG", *(member.name for member in plan.mission.members)}
    plan.calm(begin)
    for device in plan.mission.devices:  # who has nothing of that kind refuses it
        for line in plan.its.rests:
            plan.add(begin + 0.02, f"fault {device} {line}")
    for member in plan.acting:
        plan.hear(begin + 0.03, member)
    return plan.drive(begin + BEGINS_S, OPERATIONAL, plan.its.usual)


def begin_what(plan, dice, what, time):
    mission = plan.mission
    if what == "mode":
        mode = dice.choice([mode for mode in mission.modes if mode == mission.initial_mode or mode in plan.its.flown])
        plan.function(time, mission.supervisor, "SET_MODE", mission.mode_ids[mode])
    elif what == "stop":
        plan.function(time, mission.supervisor, "SAFE_ALL")
    elif what == "plan" and not mission.devices:
        plan.add(time, f"kill {dice.choice(plan.acting).name}")
    elif what == "plan":
        device, (owner, _) = dice.choice(sorted(mission.devices.items()))
        plan.add(time, dice.choice([f"kill {owner}", f"fault {device} unplug"]))
        plan.add(time + 4, f"fault {device} plug")
