# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I4: what must not act, and who must go down (judge/rules.py)."""
import dataclasses

from judge_cases import case
from judge_flight import JOYSTICK, MISSION, MS, ROBOT, S, SUPERVISOR, call
from descriptors import OFFLINE, OPERATIONAL, SAFE

ACTS = "active robot 1"


# --- I4: outside Operational -------------------------------------------------------------------------------------------------
def left_operational(w, acts_until, state=SAFE):
    w.at(60 * MS, ACTS).at(1 * S, f"state MANIPULATOR {state}").at(acts_until, "active robot 0")


@case("i4_actuators_are_off_outside_operational", found="robot acts while MANIPULATOR is SafeOperational")
def acts_long_after_it_left_operational(w):
    left_operational(w, 1030 * MS)


@case("i4_actuators_are_off_outside_operational")
def acts_for_a_few_cycles_after_it_left_operational(w):
    left_operational(w, 1014 * MS)


@case("i4_actuators_are_off_outside_operational", found="ms after the death of MANIPULATOR")
def acts_long_after_a_death(w):
    w.at(60 * MS, ACTS).at(1 * S, "did kill MANIPULATOR", "alive MANIPULATOR 0").at(1020 * MS, "active robot 0")


@case("i4_actuators_are_off_outside_operational")
def acts_until_its_watchdog_after_a_death(w):
    w.at(60 * MS, ACTS).at(1 * S, "did kill MANIPULATOR", "alive MANIPULATOR 0").at(1012 * MS, "active robot 0")


# --- I4: SAFE_ALL --------------------------------------------------------------------------------------------------------------
SAFE_ALL_RULE = "i4_safe_all_stops_everything"


def safe_all(w, answered=100 * MS, subtype=7, stops=20 * MS, ack=15, logged=True, kind="received"):
    w.at(60 * MS, ACTS)
    request = w.sent(1 * S, SUPERVISOR, 8, 1, "SAFE_ALL", ack=ack)
    w.counts[("tc", 0)] -= 1
    if kind:
        w.command(1 * S, kind, SUPERVISOR, 8, 1, call("SAFE_ALL"), ack=ack)
    if answered is not None:
        w.down(1 * S + answered, SUPERVISOR, 1, subtype, request, logged=logged)
    if stops is not None:
        w.at(1 * S + stops, "active robot 0")
    return request


@case(SAFE_ALL_RULE)
def a_stop_that_is_reported(w):
    safe_all(w)


@case(SAFE_ALL_RULE)
def a_stop_that_ends_with_the_report_of_who_did_not(w):
    safe_all(w, subtype=8)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_without_an_answer(w):
    safe_all(w, answered=None)


@case(SAFE_ALL_RULE)
def a_stop_whose_report_nobody_asked_for_while_the_log_has_no_room(w):
    safe_all(w, answered=None, ack=7, kind=None, stops=5 * MS)


@case(SAFE_ALL_RULE)
def a_stop_whose_report_nobody_asked_for_has_as_long_as_any_other(w):
    safe_all(w, answered=None, ack=6, stops=400 * MS)


@case(SAFE_ALL_RULE, found="robot acts 500 ms after SAFE_ALL")
def a_stop_whose_report_nobody_asked_for_that_comes_too_late(w):
    safe_all(w, answered=None, ack=6, stops=600 * MS)


@case(SAFE_ALL_RULE)
def a_stop_that_is_answered_when_the_last_was_ended(w):
    safe_all(w, answered=940 * MS)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_that_is_answered_too_late(w):
    safe_all(w, answered=960 * MS)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_that_is_only_accepted(w):
    safe_all(w, subtype=1)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_that_is_only_accepted_as_ground_hears(w):
    safe_all(w, subtype=1, logged=False)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_beside_another_that_is_answered(w):
    safe_all(w, answered=None)
    w.verified(1100 * MS, 0x1801C3E7, 7).down(1100 * MS, SUPERVISOR, 1, 7, 0x1801C3E7, logged=False)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_beside_another_telecommand_that_is_refused(w):
    safe_all(w, answered=None)
    w.command(1050 * MS, "refused", ROBOT, 8, 1, call("HOLD"), count=901)


@case(SAFE_ALL_RULE)
def a_stop_that_its_addressee_does_not_know(w):
    w.sent(1 * S, ROBOT, 8, 1, "SAFE_ALL")


@case(SAFE_ALL_RULE)
def acts_until_the_time_for_the_inhibit_is_over(w):
    safe_all(w, answered=600 * MS, stops=490 * MS)


@case(SAFE_ALL_RULE, found="robot acts 500 ms after SAFE_ALL")
def acts_when_the_time_for_the_inhibit_is_over(w):
    safe_all(w, answered=600 * MS, stops=530 * MS)


@case(SAFE_ALL_RULE)
def a_stop_whose_answer_a_log_without_room_does_not_have(w):
    safe_all(w, logged=False)


@case(SAFE_ALL_RULE)
def a_stop_that_nobody_wants_reported(w):
    safe_all(w, answered=None, ack=1, stops=10 * MS)


@case(SAFE_ALL_RULE, found="SAFE_ALL was refused")
def a_stop_that_is_refused(w):
    safe_all(w, answered=None, kind="refused")


@case(SAFE_ALL_RULE, found="SAFE_ALL was refused")
def a_stop_that_is_refused_though_nobody_wants_its_report(w):
    safe_all(w, answered=None, kind="refused", ack=1)


@case(SAFE_ALL_RULE)
def a_stop_over_a_link_that_is_down(w):
    w.at(900 * MS, f"state COMMUNICATION {OFFLINE}")
    safe_all(w, answered=None)


@case(SAFE_ALL_RULE)
def a_stop_to_a_supervisor_that_is_stopped(w):
    w.at(990 * MS, "did stop SUPERVISOR").at(1200 * MS, "did go SUPERVISOR")
    safe_all(w, answered=None)


def after_a_stop_of_the_supervisor(w, until):
    w.at(until - 150 * MS, "did stop SUPERVISOR").at(until - 100 * MS, "did go SUPERVISOR")
    safe_all(w, answered=None)


@case(SAFE_ALL_RULE)
def a_stop_to_a_supervisor_that_has_just_gone_on(w):
    after_a_stop_of_the_supervisor(w, 950 * MS)


@case(SAFE_ALL_RULE, found="not answered in its time")
def a_stop_to_a_supervisor_that_goes_on_for_a_while(w):
    after_a_stop_of_the_supervisor(w, 850 * MS)


@case(SAFE_ALL_RULE)
def a_stop_at_the_end_of_the_flight(w):
    w.action(999 * MS, "shutdown asked for")
    safe_all(w, answered=None)


@case(SAFE_ALL_RULE)
def a_stop_asked_for_by_a_subsystem(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SAFE_ALL", origin="JOYSTICK", source=JOYSTICK)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_on_after_a_stop(w):
    safe_all(w, stops=None)


def goes_on(w, asked, forwarded, kind="forwarded", function="SET_STATE", argument=OPERATIONAL, to=ROBOT):
    """SET_STATE(Operational) to the robot; it acts again from 1.2 s to the end."""
    count = 900
    w.sent(asked, to, 8, 1, function, count=count)
    w.command(forwarded, kind, to, 8, 1, call(function, argument), count=count)
    w.at(1200 * MS, ACTS).at(1900 * MS, "active robot 0")


@case(SAFE_ALL_RULE)
def acts_again_once_it_was_told_to(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_though_it_was_told_to_stay_safe(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, argument=SAFE)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_because_of_another_function(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, function="CONFIGURE")


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_because_another_was_told_to(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, to=JOYSTICK)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_and_the_log_has_a_gap_where_something_else_was_asked(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, kind="refused", function="CONFIGURE")
    w.record(1170 * MS, "gap", lost=3)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_because_of_what_was_asked_before_the_stop(w):
    safe_all(w)
    goes_on(w, 950 * MS, 1160 * MS)


@case(SAFE_ALL_RULE, found="robot acts")
def acts_again_although_that_was_refused(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, kind="refused")


@case(SAFE_ALL_RULE)
def acts_again_and_the_log_has_a_gap_where_that_was_asked(w):
    safe_all(w)
    goes_on(w, 1150 * MS, 1160 * MS, kind="refused")
    w.record(1170 * MS, "gap", lost=3)


@case(SAFE_ALL_RULE)
def acts_again_because_the_supervisor_itself_says_so(w):
    safe_all(w)
    for kind in ("received", "forwarded"):
        w.command(1160 * MS, kind, ROBOT, 8, 1, call("SET_STATE", OPERATIONAL), source=SUPERVISOR, count=7)
    w.at(1200 * MS, ACTS).at(1900 * MS, "active robot 0")


# --- I4: who begins ---------------------------------------------------------------------------------------------------------
BEGINS_RULE = "i4_who_begins_is_let_go"


def reboot(w, acts_until=1 * S, again=None, what="reboot"):
    w.at(60 * MS, ACTS).at(1 * S, f"did fault robot {what}").at(acts_until, "active robot 0")
    if again is not None:
        w.at(again, ACTS)


@case(BEGINS_RULE, found="robot acts 0 ms after it rebooted")
def a_motion_goes_on_after_a_reboot(w):
    reboot(w, 2 * S)


@case(BEGINS_RULE)
def a_motion_ends_with_a_reboot(w):
    reboot(w)


@case(BEGINS_RULE, found="robot acts 200 ms after it rebooted")
def a_motion_begins_by_itself_after_a_reboot(w):
    reboot(w, again=1200 * MS)


@case(BEGINS_RULE)
def it_is_brought_up_after_a_reboot(w):
    w.at(1100 * MS, f"state MANIPULATOR {SAFE}").at(1200 * MS, f"state MANIPULATOR {OPERATIONAL}")
    reboot(w, again=1201 * MS)


@case(BEGINS_RULE)
def it_is_told_off_meanwhile(w):
    w.at(1002 * MS, "inhibited MANIPULATOR 4").at(1100 * MS, "inhibited MANIPULATOR 0")
    reboot(w, again=1101 * MS)


@case(BEGINS_RULE)
def its_member_is_another_one_by_then(w):
    w.at(1002 * MS, "alive MANIPULATOR 0").at(1100 * MS, "alive MANIPULATOR 1")
    reboot(w, again=1101 * MS)


@case(BEGINS_RULE)
def it_did_nothing_when_it_rebooted(w):
    reboot(w, acts_until=990 * MS, again=1100 * MS)


@case(BEGINS_RULE)
def it_was_being_inhibited_when_it_rebooted(w):
    w.at(1 * S, "inhibited MANIPULATOR 4").at(1100 * MS, "inhibited MANIPULATOR 0")
    reboot(w, again=1101 * MS)


@case(BEGINS_RULE)
def another_fault_is_no_reboot(w):
    reboot(w, 2 * S, what="stall 1")


NO_ACTUATOR = dataclasses.replace(MISSION, members=[dataclasses.replace(member, actuators=set()) for member in MISSION.members])


@case(BEGINS_RULE, mission=NO_ACTUATOR)
def a_sensor_goes_on_after_a_reboot(w):
    reboot(w, 2 * S)


# --- I4: networks --------------------------------------------------------------------------------------------------------------
NETWORK_RULE = "i4_a_network_goes_down_with_its_member"


def death(w, partner_offline=None, of="MANIPULATOR", time=1 * S):
    w.at(time, f"did kill {of}", f"alive {of} 0")
    if partner_offline is not None:
        w.at(partner_offline, f"state JOYSTICK {OFFLINE}")


@case(NETWORK_RULE, found="JOYSTICK is not Offline 2 s after kill MANIPULATOR")
def a_partner_goes_on_after_a_death(w):
    death(w)


@case(NETWORK_RULE)
def a_partner_is_offline_in_two_seconds(w):
    death(w, 2900 * MS)


@case(NETWORK_RULE, found="JOYSTICK is not Offline")
def a_partner_is_offline_later(w):
    death(w, 3100 * MS)


@case(NETWORK_RULE)
def who_was_no_partner_goes_on(w):
    w.at(900 * MS, "links")
    death(w)


@case(NETWORK_RULE)
def the_ground_link_goes_on_though_it_carries_sets(w):
    w.at(900 * MS, "links 3 5")
    death(w, 2900 * MS)


@case(NETWORK_RULE)
def a_partner_that_was_struck_itself(w):
    death(w)
    w.at(2 * S, "did stop JOYSTICK").at(2500 * MS, "did go JOYSTICK")


@case(NETWORK_RULE)
def a_partner_that_was_dead_already(w):
    w.at(100 * MS, "did kill JOYSTICK", "alive JOYSTICK 0")
    death(w)


@case(NETWORK_RULE)
def a_death_while_the_supervisor_is_stopped(w):
    death(w)
    w.at(1500 * MS, "did stop SUPERVISOR").at(1600 * MS, "did go SUPERVISOR")


def death_at_2_8(w, supervisor_stopped_until):
    death(w, time=2800 * MS)
    w.at(supervisor_stopped_until - 200 * MS, "did stop SUPERVISOR").at(supervisor_stopped_until - 100 * MS, "did go SUPERVISOR")


@case(NETWORK_RULE)
def a_death_soon_after_the_supervisor_was_stopped(w):
    death_at_2_8(w, 1000 * MS)


@case(NETWORK_RULE, found="JOYSTICK is not Offline")
def a_death_long_after_the_supervisor_was_stopped(w):
    death_at_2_8(w, 600 * MS)


@case(NETWORK_RULE, found="JOYSTICK is not Offline")
def a_death_long_before_the_supervisor_is_stopped(w):
    death(w)
    w.at(3200 * MS, "did stop SUPERVISOR").at(3300 * MS, "did go SUPERVISOR")


@case(NETWORK_RULE)
def a_death_some_time_before_the_supervisor_is_stopped(w):
    death(w)
    w.at(2900 * MS, "did stop SUPERVISOR").at(3300 * MS, "did go SUPERVISOR")


@case(NETWORK_RULE, found="JOYSTICK is not Offline")
def a_partner_that_is_struck_long_after(w):
    death(w)
    w.at(3200 * MS, "did stop JOYSTICK").at(3300 * MS, "did go JOYSTICK")


@case(NETWORK_RULE)
def a_death_less_than_two_seconds_before_all_is_brought_up_again(w):
    death(w)
    w.at(2500 * MS, "calm")


def unplug(w):
    w.at(1 * S, "did fault robot unplug")


@case(NETWORK_RULE, found="JOYSTICK is not Offline 2 s after fault robot unplug")
def a_partner_goes_on_after_an_unplug(w):
    unplug(w)


@case(NETWORK_RULE)
def an_unplug_that_nobody_can_tell_before_the_service_loop_goes_on(w):
    w.at(900 * MS, "did stick MANIPULATOR")
    unplug(w)
    w.at(2 * S, "did unstick MANIPULATOR").at(3900 * MS, f"state JOYSTICK {OFFLINE}")


@case(NETWORK_RULE, found="JOYSTICK is not Offline 2 s after fault robot unplug")
def an_unplug_that_nobody_told_though_the_service_loop_went_on(w):
    w.at(900 * MS, "did stick MANIPULATOR")
    unplug(w)
    w.at(2 * S, "did unstick MANIPULATOR").at(4100 * MS, f"state JOYSTICK {OFFLINE}")


@case(NETWORK_RULE, found="JOYSTICK is not Offline 2 s after fault robot unplug")
def an_unplug_long_after_the_service_loop_stood_still(w):
    w.at(100 * MS, "did stick MANIPULATOR").at(200 * MS, "did unstick MANIPULATOR")
    unplug(w)


@case(NETWORK_RULE)
def an_unplug_of_what_is_not_in_use(w):
    w.at(900 * MS, f"state MANIPULATOR {SAFE}")
    unplug(w)


@case(NETWORK_RULE, mission=dataclasses.replace(MISSION, high_plan={"set_state"}))
def an_unplug_where_the_mission_plans_something_milder(w):
    unplug(w)


@case(NETWORK_RULE)
def another_fault_is_no_unplug(w):
    w.at(1 * S, "did fault robot noise 2")
