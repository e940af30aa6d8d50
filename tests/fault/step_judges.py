# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Judges of what becomes of a craft whose supervisor, keeper or both are lost in the midst of a step. They see times, states and words alone, and say
what is wrong, or HIT where a loss fell where it was aimed; step_judges_test.py has a fault for each. Times are time.monotonic()."""
import math

import honest
from kill_windows import HIT, first

# hirosco/subsystem/author/states.hpp, inhibition.hpp
SAFE_OPERATIONAL, OPERATIONAL, BY_LINK = 4, 5, 2
# supervisor/keeper/kept.hpp, and what a successor may take from then on.
PATIENCE_S, ADOPTED_S = 0.8, 1.0
# hirosco/subsystem/pages/supervisor_silence.hpp, and until the next look.
SAFE_AFTER_S, LOOK_S = 2.0, 0.1
PAUSE_S = 0.05


def in_a_step(reports, lost):
    """Of a loss behind which the same supervisor may go on: its telecommand was accepted before, and had no end. `reports`: [(subtype, when heard)]."""
    if first((1,), reports) > lost:
        return "TM[1,1] was not heard before the loss"
    return "its end was heard before the loss" if first(honest.ENDS, reports) < lost else HIT


def in_a_plan(begun, ended, lost):
    """`begun`: when the event was told that the plan answers; `ended`: when the last of whom it moves was told to be where it leads."""
    if begun > lost:
        return "the plan had not begun"
    return "the plan had ended" if ended < lost else HIT


def in_the_whole(reports, since, until):
    """Of what lasts: from before the telecommand was accepted until behind its end."""
    return HIT if since < first((1,), reports) and first(honest.ENDS, reports) < until else "it did not last for the whole step"


def gone_on_late(lost, gone_on, patience_s):
    """Complaints about who goes on for one that was lost. `patience_s`: until somebody sees that it is."""
    limit_s = patience_s + ADOPTED_S
    return [] if gone_on - lost < limit_s else [f"another supervisor goes on after {gone_on - lost:.3f} s, {limit_s:g} s at most"]


def state_from(looks, begin, end):
    """The one that was read all the time, or None."""
    before = [look for look in looks if look.at <= begin][-1:]
    states = {look.state for look in before + [look for look in looks if begin < look.at <= end]}
    return states.pop() if len(states) == 1 and before else None


def stood_still(watch, program, begin, end):
    """Complaints: who was Operational or Safe-Operational all the time made no cycle for PAUSE_S, or lost a link. `watch`: a pages.Watch, late itself by
    its worst_s."""
    state, told = state_from(watch.changes[program], begin, end), []
    if state not in (SAFE_OPERATIONAL, OPERATIONAL):
        return []
    pause_s = watch.longest_pause_s(program, begin, end)
    if pause_s > PAUSE_S + watch.worst_s:
        told.append(f"{program} made no cycle for {pause_s:.3f} s")
    if state == OPERATIONAL and any(begin < look.at <= end and look.inhibited & BY_LINK for look in watch.changes[program]):
        told.append(f"{program} lost a link")
    return told


def moves_still(watch, program, since, end):
    """Complaints: without anybody to go on it is not safe after its time."""
    safe = watch.first(program, lambda look: look.state != OPERATIONAL or look.inhibited, since)
    at = safe.at if safe else math.inf
    limit_s = SAFE_AFTER_S + LOOK_S + watch.worst_s
    return [] if min(at, end) - since < limit_s and at < end else [f"{program} is not safe {min(at, end) - since:.3f} s after the last supervisor"]


def ended_elsewhere(step, old, new, status):
    """Complaints about where a craft is when all that was begun has ended. `status`: {"mode", "subsystems": [{"name", "state"}]}; `new`: the mode that
    was to be entered."""
    states = {member["name"]: member["state"] for member in status["subsystems"] if member["name"] in ("MANIPULATOR", "JOYSTICK")}
    moving = [name for name, state in states.items() if state == "Operational"]
    if status["mode"] not in (old, new, "commissioning"):
        return [f"{step} ends in mode {status['mode']}"]
    if step in ("plan", "SAFE_ALL") and moving:
        return [f"behind a {step} these are Operational: {moving}"]
    if status["mode"] == "commissioning" and moving:
        return [f"in commissioning these are Operational: {moving}"]
    return []

