# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I4: a stop stays (judge/rules.py)."""
from judge_cases import case
from judge_cases_stops import ACTS, safe_all
from judge_flight import JOYSTICK, MS, ROBOT, S, SUPERVISOR, call
from descriptors import OPERATIONAL, SAFE

STAYS_RULE = "i4_a_stop_stays"


def acts_again(w, at=2 * S):
    w.at(60 * MS, ACTS).at(1 * S, "did safe").at(1005 * MS, "active robot 0").at(at, "active robot 1").at(at + 1 * S, "active robot 0")


def leave(w, time, state=OPERATIONAL, apid=ROBOT, logged=True):
    request = w.sent(time, apid, 8, 1, "SET_STATE")
    w.counts[("tc", 0)] -= 1
    if logged:
        w.command(time, "received", apid, 8, 1, call("SET_STATE", state))
    return request


@case(STAYS_RULE, found="robot acts again 1000 ms after a stop, and nobody has let MANIPULATOR go")
def acts_again_by_itself(w):
    acts_again(w)


@case(STAYS_RULE, found="robot acts again")
def acts_again_on_the_word_of_before(w):
    leave(w, 990 * MS)
    acts_again(w)


@case(STAYS_RULE, found="robot acts again")
def acts_again_though_it_was_to_be_safe(w):
    leave(w, 1500 * MS, SAFE)
    acts_again(w)


@case(STAYS_RULE, found="robot acts again")
def acts_again_because_another_was_let_go(w):
    leave(w, 1500 * MS, apid=JOYSTICK)
    acts_again(w)


@case(STAYS_RULE)
def acts_again_as_it_was_let_go(w):
    leave(w, 1500 * MS)
    acts_again(w)


@case(STAYS_RULE)
def acts_again_by_what_no_log_has_kept(w):
    leave(w, 1500 * MS, logged=False)
    acts_again(w)


@case(STAYS_RULE)
def acts_again_in_another_mode(w):
    w.sent(1500 * MS, SUPERVISOR, 8, 1, "SET_MODE")
    acts_again(w)


@case(STAYS_RULE)
def acts_until_its_stop_has_reached_it(w):
    w.at(60 * MS, ACTS).at(1 * S, "did safe").at(1005 * MS, "active robot 0")
    w.at(1010 * MS, "active robot 1").at(1020 * MS, "active robot 0")


@case(STAYS_RULE, found="robot acts again 1000 ms after a stop")
def acts_again_behind_a_safe_all_of_ground(w):
    safe_all(w)
    w.at(2 * S, "active robot 1")


@case(STAYS_RULE)
def acts_on_behind_a_safe_all_that_nobody_carried_out(w):
    safe_all(w, answered=None, kind="refused")
    w.at(2 * S, "active robot 1")
