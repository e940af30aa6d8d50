# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of the rules on what happened in the world, but for I4 (judge/rules.py)."""
import copy

from judge_cases import case
from judge_flight import JOYSTICK, MISSION, MS, ROBOT, S, SUPERVISOR
from descriptors import OPERATIONAL, PRE, SAFE


# --- I1 --------------------------------------------------------------------------------------------------------------------
@case("i1_only_victims_die", found="JOYSTICK died")
def a_death_that_nobody_caused(w):
    w.at(1 * S, "alive JOYSTICK 0")


@case("i1_only_victims_die")
def a_death_by_the_plan(w):
    w.at(1 * S, "did kill JOYSTICK", "alive JOYSTICK 0")


@case("i1_only_victims_die", found="JOYSTICK died")
def a_death_before_it_was_struck(w):
    w.at(1 * S, "alive JOYSTICK 0").at(2 * S, "did kill JOYSTICK")


@case("i1_only_victims_die")
def a_death_at_the_end(w):
    w.action(1 * S, "shutdown asked for").at(1 * S, "alive JOYSTICK 0")


@case("i1_only_victims_die")
def a_death_at_an_end_that_the_disk_did_not_take(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SHUTDOWN")
    w.at(1010 * MS, "alive JOYSTICK 0")


@case("i1_only_victims_die", found="JOYSTICK died")
def a_death_long_after_a_shutdown_that_was_refused(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SHUTDOWN")
    w.at(2 * S, "alive JOYSTICK 0").at(8 * S, "end")


# --- I5 --------------------------------------------------------------------------------------------------------------------
STALE_RULE = "i5_no_stale_sample_is_used"


def stands_still(w, acts_until, of="JOYSTICK", acting="robot"):
    w.at(60 * MS, f"active {acting} 1").at(1001 * MS, f"still {of} since={1 * S}").at(acts_until, f"active {acting} 0")


@case(STALE_RULE, found="robot acts on samples of JOYSTICK")
def acts_on_old_samples(w):
    stands_still(w, 1020 * MS)


@case(STALE_RULE)
def acts_on_samples_within_their_age(w):
    stands_still(w, 1003 * MS)


@case(STALE_RULE)
def acts_when_the_source_moves_again(w):
    w.at(1003 * MS, "moves JOYSTICK 1")
    stands_still(w, 1020 * MS)


@case(STALE_RULE)
def acts_on_old_samples_while_it_is_stopped_itself(w):
    w.at(1 * S, "did stop MANIPULATOR").at(1010 * MS, "did go MANIPULATOR")
    stands_still(w, 1020 * MS)


@case(STALE_RULE)
def acts_until_its_watchdog_while_its_own_subsystem_stands_still(w):
    w.at(1001 * MS, f"still MANIPULATOR since={1 * S}").at(1040 * MS, "moves MANIPULATOR 1")
    stands_still(w, 1012 * MS)


@case(STALE_RULE, found="robot acts on samples of JOYSTICK")
def acts_longer_than_its_watchdog_while_its_own_subsystem_stands_still(w):
    w.at(1001 * MS, f"still MANIPULATOR since={1 * S}").at(1040 * MS, "moves MANIPULATOR 1")
    stands_still(w, 1020 * MS)


def holding():
    """The mission with a robot that goes on without its joystick."""
    mission = copy.deepcopy(MISSION)
    for configuration in mission.by_name("MANIPULATOR").configurations.values():
        for wanted in configuration.requires:
            wanted.inhibits = False
    return mission


@case(STALE_RULE, mission=holding())
def acts_on_old_samples_that_its_descriptor_holds(w):
    stands_still(w, 1020 * MS)


@case(STALE_RULE)
def acts_without_a_configuration(w):
    w.at(55 * MS, "configuration MANIPULATOR 0")
    stands_still(w, 1020 * MS)


# --- I9 --------------------------------------------------------------------------------------------------------------------
EDGE_RULE = "i9_only_edges_of_the_table"


@case(EDGE_RULE, found="MANIPULATOR went from Operational to PreOperational")
def a_jump_of_states(w):
    w.at(1 * S, f"state MANIPULATOR {PRE}")


@case(EDGE_RULE)
def a_jump_by_states_that_last_no_time(w):
    w.at(1 * S, f"state MANIPULATOR {SAFE}").at(1100 * MS, f"state MANIPULATOR {PRE}")


@case(EDGE_RULE)
def who_was_started_again_begins_anew(w):
    w.at(1 * S, "did kill MANIPULATOR", "alive MANIPULATOR 0").at(1001 * MS, "state MANIPULATOR 9")
    w.at(1500 * MS, "alive MANIPULATOR 1", f"state MANIPULATOR {PRE}")


@case(EDGE_RULE, found="MANIPULATOR told of PreOperational after Operational")
def a_jump_in_what_it_told(w):
    w.told(1 * S, ROBOT, OPERATIONAL).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE)
def an_edge_in_what_it_told(w):
    w.told(1 * S, ROBOT, OPERATIONAL).told(1100 * MS, ROBOT, SAFE)


@case(EDGE_RULE)
def a_jump_in_what_it_told_over_its_death(w):
    w.told(1 * S, ROBOT, OPERATIONAL).action(1050 * MS, "MANIPULATOR died: signal 9", peer=ROBOT).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE)
def a_jump_in_what_it_told_over_its_start(w):
    w.told(1 * S, ROBOT, OPERATIONAL).action(1050 * MS, "restarted MANIPULATOR", peer=ROBOT).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE)
def a_jump_where_ground_silenced_events(w):
    w.command(500 * MS, "forwarded", ROBOT, 5, 6, bytes([1, 0xF0, 0]))
    w.told(1 * S, ROBOT, OPERATIONAL).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE)
def a_jump_where_the_log_has_a_gap(w):
    w.told(1 * S, ROBOT, OPERATIONAL).record(1050 * MS, "gap", lost=1).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE, found="MANIPULATOR told of PreOperational after Operational")
def a_jump_where_ground_silenced_events_of_another(w):
    w.command(500 * MS, "forwarded", JOYSTICK, 5, 6, bytes([1, 0xF0, 0]))
    w.told(1 * S, ROBOT, OPERATIONAL).told(1100 * MS, ROBOT, PRE)


@case(EDGE_RULE)
def the_same_state_told_twice(w):
    w.told(1 * S, ROBOT, OPERATIONAL).told(1100 * MS, ROBOT, OPERATIONAL)


@case(EDGE_RULE)
def another_event_with_three_octets(w):
    w.told(1 * S, ROBOT, OPERATIONAL).report(1100 * MS, ROBOT, 5, 1, bytes([3, 0xE9, PRE]))


# --- I10 -------------------------------------------------------------------------------------------------------------------
AGAIN_RULE = "i10_commandable_again"


def brought_up(w, flown=True, up=True, ping=True, answered=True):
    w.at(2 * S, "calm", "recovered")
    if ping:
        request = w.sent(2 * S, ROBOT, 17, 1)
        if answered:
            w.down(2010 * MS, ROBOT, 1, 7, request)
    if up:
        w.at(3 * S, "up MANIPULATOR")
    if flown:
        w.at(4 * S, "flown")


@case(AGAIN_RULE)
def a_craft_that_comes_back(w):
    brought_up(w)


@case(AGAIN_RULE)
def a_craft_that_was_never_to_come_back(w):
    w.sent(2 * S, ROBOT, 17, 1)


@case(AGAIN_RULE, found="MANIPULATOR answers no ping")
def a_craft_that_answers_no_ping(w):
    brought_up(w, answered=False)


@case(AGAIN_RULE, found="MANIPULATOR answers no ping")
def a_craft_that_only_accepts_pings(w):
    brought_up(w, ping=False)
    w.down(2010 * MS, ROBOT, 1, 1, w.sent(2 * S, ROBOT, 17, 1))


@case(AGAIN_RULE)
def another_telecommand_at_the_end_needs_no_answer(w):
    brought_up(w)
    w.sent(2 * S, ROBOT, 20, 1)


@case(AGAIN_RULE, found="nothing could be brought up")
def a_craft_that_is_not_flown_again(w):
    brought_up(w, flown=False)


def ended_before_the_end(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SHUTDOWN")
    w.action(1500 * MS, "shutdown asked for")
    brought_up(w, flown=False)


@case(AGAIN_RULE)
def a_stopped_supervisor_that_finds_a_shutdown_when_it_goes_on_ends_the_flight(w):
    w.at(900 * MS, "did stop SUPERVISOR").at(1400 * MS, "did go SUPERVISOR")
    ended_before_the_end(w)


@case(AGAIN_RULE)
def a_shutdown_at_the_last_moment_before_it_is_to_be_brought_up_ends_the_flight(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SHUTDOWN")
    w.action(1003 * MS, "shutdown asked for")
    brought_up(w, flown=False)


@case(AGAIN_RULE, found="nothing could be brought up")
def a_craft_that_is_not_flown_again_after_a_shutdown_that_nothing_held_up(w):
    ended_before_the_end(w)


@case(AGAIN_RULE, found="MANIPULATOR cannot be brought up again: Operational, SafeOperational; SET_STATE of MANIPULATOR failed")
def a_craft_that_does_not_stay_up(w):
    brought_up(w)
    w.at(2500 * MS, "called MANIPULATOR SET_STATE 5 failed").at(3500 * MS, f"state MANIPULATOR {SAFE}")


# --- I12 -------------------------------------------------------------------------------------------------------------------
LINK_RULE = "i12_no_operational_without_required_link"


def enters(w, links, lost_at=None, inhibited=0):
    """The robot enters Operational at 1 s."""
    w.without("links").at(50 * MS, "links")
    w.at(60 * MS, f"state MANIPULATOR {SAFE}").at(900 * MS, links).at(1 * S, f"state MANIPULATOR {OPERATIONAL}")
    if lost_at:
        w.at(lost_at, "links").at(lost_at + 1 * MS, f"inhibited MANIPULATOR {inhibited}")


@case(LINK_RULE)
def enters_with_its_links(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    enters(w, "links 1 2")


@case(LINK_RULE, found="MANIPULATOR entered Operational without JOYSTICK_STATE")
def enters_without_a_required_link(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    enters(w, "links 1")


@case(LINK_RULE)
def enters_without_a_link_while_the_supervisor_is_stopped(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    w.at(990 * MS, "did stop SUPERVISOR").at(1020 * MS, "did go SUPERVISOR")
    enters(w, "links 1")


@case(LINK_RULE)
def enters_where_its_configuration_requires_none(w):
    w.without("state MANIPULATOR", "state JOYSTICK", "configuration MANIPULATOR").at(50 * MS, "configuration MANIPULATOR 1")
    enters(w, "links")


@case(LINK_RULE, found="MANIPULATOR is Operational and not inhibited without JOYSTICK_STATE")
def acts_on_when_a_required_link_is_gone(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    enters(w, "links 1 2", lost_at=2 * S)


@case(LINK_RULE)
def is_inhibited_when_a_required_link_is_gone(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    enters(w, "links 1 2", lost_at=2 * S, inhibited=4)


@case(LINK_RULE)
def acts_on_without_a_link_while_it_is_stopped_itself(w):
    w.without("state MANIPULATOR", "state JOYSTICK")
    w.at(2 * S, "did stop MANIPULATOR")
    enters(w, "links 1 2", lost_at=2 * S)


# --- I13 -------------------------------------------------------------------------------------------------------------------
TIME_RULE = "i13_cycles_keep_time"


def counted(w, robot=40, device=40, until=3 * S, slow_from=2 * S):
    """Counts of every 20 ms: 40 cycles of 500 us, from `slow_from` on as told."""
    member, world = 0, 0
    for time in range(100 * MS, until, 20 * MS):
        w.at(time, f"cycles COMMUNICATION={time // (10 * MS)} MANIPULATOR={member} JOYSTICK={time * 2 // MS} robot={world} "
                   f"joystick={time * 2 // MS}")
        member += robot if time >= slow_from else 40
        world += device if time >= slow_from else 40


@case(TIME_RULE)
def cycles_that_keep_time(w):
    counted(w)


@case(TIME_RULE, found="MANIPULATOR made")
def a_member_that_loses_cycles(w):
    counted(w, robot=38)


@case(TIME_RULE, found="robot made")
def a_device_whose_time_runs_too_fast(w):
    counted(w, device=50)


@case(TIME_RULE)
def a_device_that_waits_for_commands_that_come_no_more(w):
    counted(w, device=38, until=2021 * MS)


@case(TIME_RULE, found="robot made")
def a_device_that_loses_more_than_it_may_wait(w):
    counted(w, device=36, until=2021 * MS)


@case(TIME_RULE)
def one_cycle_more_or_less(w):
    counted(w, robot=41, until=2021 * MS)


@case(TIME_RULE)
def a_member_that_loses_cycles_because_it_is_stopped(w):
    w.at(1990 * MS, "did stop MANIPULATOR")
    counted(w, robot=0)


@case(TIME_RULE)
def a_member_that_loses_cycles_because_the_supervisor_is_stopped(w):
    w.at(1990 * MS, "did stop SUPERVISOR")
    counted(w, robot=38)


def rested(w, strained):
    """Its cycle rests from 2 s to 4 s and then loses four."""
    w.at(1999 * MS, f"did strain MANIPULATOR {strained} 600").at(2 * S, "cycling MANIPULATOR 0").at(4 * S, "cycling MANIPULATOR 1")
    for time in range(100 * MS, 5 * S, 20 * MS):
        cycles = min(time, 2 * S) * 2 // MS + max(time - 4 * S, 0) * 2 // MS - (4 if time > 4030 * MS else 0)
        w.at(time, f"cycles COMMUNICATION={time // (10 * MS)} MANIPULATOR={cycles} JOYSTICK={time * 2 // MS} robot={time * 2 // MS} "
                   f"joystick={time * 2 // MS}")


@case(TIME_RULE)
def a_member_that_was_strained_and_rested_before_it_felt_it(w):
    rested(w, 30)


@case(TIME_RULE, found="MANIPULATOR made 76 cycles")
def a_member_that_felt_its_strain_long_before(w):
    w.at(500 * MS, "did strain MANIPULATOR 30 600")
    rested(w, 0)


@case(TIME_RULE)
def a_member_whose_cycle_rests(w):
    w.at(1990 * MS, "cycling MANIPULATOR 0")
    counted(w, robot=0)


@case(TIME_RULE)
def a_member_without_a_period(w):
    w.at(1990 * MS, "period MANIPULATOR 0")
    counted(w, robot=0)


@case(TIME_RULE)
def a_member_whose_cycle_rested_between_two_counts(w):
    w.at(2001 * MS, "cycling MANIPULATOR 0").at(2005 * MS, "cycling MANIPULATOR 1")
    counted(w, robot=30, until=2040 * MS)


@case(TIME_RULE)
def a_member_that_stands_still(w):
    w.at(2001 * MS, f"still MANIPULATOR since={2000 * MS}")
    counted(w, robot=0)


@case(TIME_RULE)
def a_member_with_another_period(w):
    w.at(2000 * MS, "period MANIPULATOR 1000000")
    counted(w, robot=20)


@case(TIME_RULE)
def cycles_at_the_end_of_the_flight(w):
    w.action(1990 * MS, "shutdown asked for")
    counted(w, robot=0)
