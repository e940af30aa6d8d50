# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""In most flights of a mission that has such: somebody is lost whom others follow and go on without, a descriptor is read again, another version of a
program is put in its place (docs/adr/0232). By a dice of its own: flights of other missions stay as they are."""
import random

from descriptors import OFFLINE, OPERATIONAL, PRE
from losses import ALONE_S, EPISODE_S, left_alone
from plan_lines import WAY_TO

EXCHANGES = 0.8            # of flights
EDITS = ["2", "2", "3", "5", "back", "faulty", "forbidden"]
VERSIONS = ["2", "2", "3", "9"]  # no program of the last is there
WITHIN_S = [1, 2, 3]       # a trial is over within its episode


def dice_of(flight_seed):
    return random.Random(f"exchanges of {flight_seed}")


def episodes_of(mission):
    """What the mission has: links whose consumers go on without, modes that permit the telecommands."""
    permitted = {function for permits in mission.modes.values() for permit in permits for function in permit[1]}
    found = [lose_producer] * 2 if producers(mission) else []
    found += [read_again] * 2 if "REREAD" in permitted else []
    return found + ([replace] * 2 if "REPLACE" in permitted else [])


def producers(mission):
    return sorted({mission.links[link][0] for link, (word, _, _) in mission.losses.items() if word != "down"})


def add(plan, flight_seed, begin_s, finale_s):
    dice, episodes = dice_of(flight_seed), episodes_of(plan.mission)
    if not episodes or dice.random() >= EXCHANGES:
        return
    begin = dice.uniform(begin_s + 0.4, begin_s + 2)
    while begin + EPISODE_S + 0.5 < finale_s:
        dice.choice(episodes)(plan, dice, begin)
        begin += EPISODE_S + dice.uniform(0.1, 3)


def lose_producer(plan, dice, begin):
    """All who follow it are up, and nothing else happens."""
    time = left_alone(plan, begin) + ALONE_S + dice.uniform(0, 0.02)
    victim = dice.choice(producers(plan.mission))
    plan.add(time, f"{dice.choice(['kill', 'kill', 'kill', 'kill', 'stop', 'spin'])} {victim}")
    plan.struck.add(victim)


def at_rest(plan, dice, begin, member, state):
    """The member is brought there from wherever it is. When it is."""
    time = left_alone(plan, begin) + 0.1
    plan.function(time, plan.mission.supervisor, "SET_MODE", plan.mission.mode_ids[plan.mission.initial_mode])
    for step in WAY_TO[state]:
        time += 0.1
        if step != "CONFIGURE":
            plan.function(time, member, "SET_STATE", step)
    return time + 0.3


def read_again(plan, dice, begin):
    """Once or several times, sound and not, where it may be and where not; some die in the midst of it."""
    member = dice.choice(plan.acting)
    time = at_rest(plan, dice, begin, member, dice.choice([OFFLINE, OFFLINE, PRE]))
    if dice.random() < 0.15:
        time = plan.drive(time, OPERATIONAL, plan.its.usual)  # it is refused there
    for _ in range(dice.choice([1, 2, 3])):
        plan.add(time, f"edit {member.name} {dice.choice(EDITS)}")
        plan.exchange(time + 0.01, member, "REREAD")
        struck = dice.random()
        if struck < 0.2:
            plan.add(time + 0.01 + dice.uniform(0, 0.01), f"kill {member.name}")
        elif struck < 0.3:
            plan.add(time + 0.01 + dice.uniform(0, 0.01), "log slow 100")
            plan.struck.add("LOG")
        time += dice.choice([0.005, 0.3, 0.8])
    if dice.random() < 0.3:
        plan.add(time, f"kill {member.name}")
    plan.calm(time + 0.5)
    plan.drive(time + 1.5, OPERATIONAL, plan.its.usual)


def replace(plan, dice, begin):
    """With its text as it is or another one; on trial it is brought up, confirmed or not, taken back, or dies."""
    member = dice.choice(plan.acting)
    time = at_rest(plan, dice, begin, member, OFFLINE)
    if dice.random() < 0.4:
        plan.add(time, f"edit {member.name} {dice.choice(EDITS)}")
    plan.exchange(time + 0.01, member, "REPLACE", dice.choice(VERSIONS), dice.choice(WITHIN_S))
    if dice.random() < 0.5:
        plan.drive(time + 0.2, OPERATIONAL, plan.its.usual)
    after = time + dice.choice([0.02, 0.5, 1.0, 1.5])
    what = dice.choice(["confirmed", "confirmed", "not", "dies", "taken back", "again"])
    if what == "confirmed":
        plan.exchange(after, member, "CONFIRM")
        if dice.random() < 0.4:
            plan.add(after + 0.3, f"kill {member.name}")
    elif what == "dies":
        plan.add(after, f"kill {member.name}")
    elif what == "taken back":
        plan.function(after, member, "SET_STATE", OFFLINE)
        plan.exchange(after + 0.4, member, "TAKE_BACK")
    elif what == "again":
        plan.exchange(after, member, "REPLACE", dice.choice(VERSIONS), dice.choice(WITHIN_S))
    if dice.random() < 0.3:  # what it brought is in its file no more
        plan.add(after + 0.5, f"edit {member.name} back")
