# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I15 to I17 (judge/succession_rules.py), and of what other rules say of a flight that loses its supervisor."""
import struct

from judge_cases import case
from judge_cases_stops import ACTS
from judge_flight import JOYSTICK, MS, ROBOT, S, SUPERVISOR, call
from descriptors import ERROR, OPERATIONAL, PRE, SAFE

GOES_ON, ALONE_TOO_LONG = "i15_what_runs_is_gone_on_with", "i16_nobody_moves_without_a_supervisor_for_long"
STOPS, NONE_LOST = "i17_a_stop_is_carried_out", "i17_no_telecommand_is_lost"


def lost(w, at=2 * S, span=300 * MS, by="kill"):
    w.at(at, f"did {by} SUPERVISOR {span // MS}", "supervised 0").at(at + span, "supervised 1")


# --- I15 -------------------------------------------------------------------------------------------------------------------
@case(GOES_ON)
def a_supervisor_dies_and_all_goes_on(w):
    lost(w)


@case(GOES_ON, found="MANIPULATOR does not go on as the supervisor is lost for 300 ms")
def a_member_leaves_operational_as_the_supervisor_dies(w):
    lost(w)
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON, found="JOYSTICK does not go on as the supervisor is lost for 300 ms")
def a_member_is_inhibited_as_the_supervisor_dies(w):
    lost(w)
    w.at(2001 * MS, "inhibited JOYSTICK 1")


@case(GOES_ON, found="link 2 does not go on")
def a_link_breaks_as_the_supervisor_hangs(w):
    lost(w, by="hang")
    w.at(2310 * MS, "links 1").at(2500 * MS, "links 1 2")


@case(GOES_ON, found="MANIPULATOR does not go on as the supervisor is lost for 610 ms")
def a_member_leaves_operational_as_the_next_supervisor_dies_too(w):
    lost(w)
    lost(w, 2310 * MS)
    w.at(2700 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_long_after_the_next_supervisor_has_come(w):
    lost(w, 1 * S)
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_that_was_not_operational_or_not_free_need_not_go_on(w):
    w.at(1 * S, f"state JOYSTICK {SAFE}", "inhibited MANIPULATOR 2")
    lost(w)
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}").at(2400 * MS, f"state JOYSTICK {PRE}")


@case(GOES_ON)
def a_member_leaves_as_the_supervisor_is_lost_for_too_long(w):
    lost(w, 1 * S, 2500 * MS)
    w.at(3100 * MS, f"state MANIPULATOR {ERROR}")


@case(GOES_ON)
def a_member_leaves_as_ground_has_told_it(w):
    lost(w)
    w.sent(2100 * MS, ROBOT, 8, 1, "SET_STATE")
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_as_somebody_stops_all(w):
    lost(w)
    w.at(2100 * MS, "did safe").at(2110 * MS, "inhibited MANIPULATOR 1")


@case(GOES_ON)
def a_member_leaves_as_something_is_still_done_to_its_device(w):
    w.at(500 * MS, "did fault robot silent")
    lost(w)
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_in_a_change_of_mode_that_was_under_way(w):
    lost(w)
    w.action(2310 * MS, "the change to mode standalone stopped: the supervisor died")
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_as_a_plan_that_was_under_way_counts_as_failed(w):
    lost(w)
    w.action(2310 * MS, "JOYSTICK: the supervisor died in the midst of a plan, which counts as failed")
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_in_what_the_supervisor_was_at(w):
    w.action(1900 * MS, "recovery of JOYSTICK")
    lost(w)
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON, found="MANIPULATOR does not go on")
def a_member_leaves_as_the_next_supervisor_says_so(w):
    lost(w)
    w.action(2310 * MS, "MANIPULATOR is stopped")
    w.at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON)
def a_member_leaves_for_a_reason_of_its_own(w):
    lost(w)
    w.report(2050 * MS, ROBOT, 5, 3, struct.pack(">H", 1001)).at(2400 * MS, f"state MANIPULATOR {SAFE}")


@case(GOES_ON, found="MANIPULATOR does not go on")
def a_member_leaves_as_its_set_is_stale(w):
    lost(w)
    w.report(2050 * MS, ROBOT, 5, 3, struct.pack(">H", 0xF200)).at(2400 * MS, f"state MANIPULATOR {SAFE}")


# --- I16 -------------------------------------------------------------------------------------------------------------------
def acts_alone(w, until, span=2500 * MS):
    w.at(60 * MS, ACTS)
    lost(w, 1 * S, span)
    w.at(until, "active robot 0")


@case(ALONE_TOO_LONG)
def acts_until_it_has_been_alone_for_its_time(w):
    acts_alone(w, 3050 * MS)


@case(ALONE_TOO_LONG, found="robot acts 2074 ms after the supervisor was lost")
def acts_on_longer_than_it_may_without_a_supervisor(w):
    acts_alone(w, 3200 * MS)


@case(ALONE_TOO_LONG, found="robot acts 2600 ms after the supervisor was lost")
def acts_again_as_the_next_supervisor_is_there(w):
    acts_alone(w, 3050 * MS)
    w.at(3600 * MS, "active robot 1")


@case(ALONE_TOO_LONG)
def acts_again_as_the_next_supervisor_has_let_it_go(w):
    acts_alone(w, 3050 * MS)
    w.counts[("tc", 0)] = 6
    w.sent(3600 * MS, ROBOT, 8, 1, "SET_STATE", count=7)
    w.command(3601 * MS, "forwarded", ROBOT, 8, 1, call("SET_STATE", OPERATIONAL), count=7)
    w.at(3610 * MS, "active robot 1")


@case(ALONE_TOO_LONG)
def acts_on_as_the_supervisor_is_lost_for_a_short_time(w):
    acts_alone(w, 4 * S, 300 * MS)


# --- I17 -------------------------------------------------------------------------------------------------------------------
def stop_meanwhile(w, acts_until, at=2100 * MS, **how):
    w.at(60 * MS, ACTS)
    lost(w)
    w.sent(at, how.get("apid", SUPERVISOR), 8, 1, how.get("function", "SAFE_ALL"))
    w.at(acts_until, "active robot 0")


@case(STOPS)
def a_stop_that_the_next_supervisor_carries_out(w):
    stop_meanwhile(w, 2400 * MS)


@case(STOPS, found="robot acts on though SAFE_ALL came as the supervisor was lost")
def a_stop_that_nobody_carries_out(w):
    stop_meanwhile(w, 4 * S)


@case(STOPS, found="robot acts on though SAFE_ALL came as the supervisor was lost")
def a_stop_that_died_with_its_supervisor(w):
    stop_meanwhile(w, 4 * S, at=1990 * MS)


@case(STOPS)
def a_stop_long_before(w):
    stop_meanwhile(w, 4 * S, at=1500 * MS)


@case(STOPS)
def another_telecommand_is_no_stop(w):
    stop_meanwhile(w, 4 * S, function="PING")


@case(STOPS)
def a_stop_over_a_ground_link_that_is_stopped_too(w):
    w.at(1 * S, "did stop COMMUNICATION")
    stop_meanwhile(w, 4 * S)


@case(STOPS)
def a_stop_over_a_ground_link_that_is_not_operational(w):
    w.at(1 * S, f"state COMMUNICATION {SAFE}")
    stop_meanwhile(w, 4 * S)


def ping(w, at=2100 * MS, answered=None, read=True, **how):
    lost(w)
    w.counts[("tc", 0)] += 1
    count = w.counts[("tc", 0)]
    request = w.sent(at, SUPERVISOR, 17, 1, count=count, **how)
    if read:
        w.command(at, "received", SUPERVISOR, 17, 1, count=count)
    if answered:
        w.down(answered, SUPERVISOR, 1, 7, request)
    return request


@case(NONE_LOST)
def a_ping_that_the_next_supervisor_answers(w):
    ping(w, answered=2320 * MS)


@case(NONE_LOST, found="TC[17,1] of ground to SUPERVISOR is lost with the supervisor")
def a_ping_that_is_lost(w):
    ping(w, read=False)


@case(NONE_LOST, found="TC[17,1] of ground to SUPERVISOR was read, and nobody has it any more")
def a_ping_that_died_with_its_supervisor(w):
    ping(w, at=1990 * MS)


@case(NONE_LOST)
def a_ping_whose_end_nobody_wants_died_with_its_supervisor(w):
    ping(w, at=1990 * MS, ack=1)


@case(NONE_LOST, found="TC[17,1] of ground to SUPERVISOR was not answered within 1000 ms of the next supervisor")
def a_ping_that_is_answered_late(w):
    ping(w, answered=3400 * MS)


@case(NONE_LOST)
def a_ping_that_is_refused(w):
    w.verified(2320 * MS, ping(w), 2)


@case(NONE_LOST)
def a_report_too_short_for_a_request_answers_none(w):
    w.report(2200 * MS, SUPERVISOR, 1, 7, b"\1")
    ping(w, answered=2320 * MS)


@case(NONE_LOST)
def a_ping_of_a_subsystem_or_of_another_time(w):
    ping(w, origin="JOYSTICK", read=False)
    w.sent(3 * S, SUPERVISOR, 17, 1)


@case(NONE_LOST)
def a_ping_that_stands_nowhere_as_the_log_was_in_trouble(w):
    w.at(1 * S, "did log full")
    w.at(1200 * MS, "did log slow 100")
    w.at(1500 * MS, "did log heal")
    ping(w, read=False)


@case(NONE_LOST)
def a_ping_that_was_deleted_with_the_log(w):
    ping(w, read=False)
    w.at(4 * S, "did log deleted")


@case(NONE_LOST, found="TC[17,1] of ground to SUPERVISOR is lost with the supervisor")
def a_ping_that_is_lost_long_after_the_log_was_healed(w):
    w.at(100 * MS, "did log heal")
    w.at(200 * MS, "did log full")
    w.at(400 * MS, "did log heal")
    ping(w, read=False)


@case(NONE_LOST)
def a_ping_as_the_flight_ends(w):
    w.action(2500 * MS, "shutdown asked for")
    ping(w, read=False)


@case(NONE_LOST)
def a_ping_to_a_disk_that_takes_nothing(w):
    w.at(1 * S, "did log full")
    ping(w, read=False)


# --- other rules -----------------------------------------------------------------------------------------------------------
@case("i13_cycles_keep_time", found="MANIPULATOR made")
def cycles_that_are_lost_as_the_supervisor_dies(w):
    lost(w)
    for time in range(100 * MS, 3 * S, 20 * MS):
        cycles = time * 2 // MS - (4 if time > 2100 * MS else 0)
        w.at(time, f"cycles COMMUNICATION={time // (10 * MS)} MANIPULATOR={cycles} JOYSTICK={time * 2 // MS} robot={time * 2 // MS} "
                   f"joystick={time * 2 // MS}")


@case("i2_one_final_report")
def a_telecommand_whose_report_went_with_a_supervisor_is_given_up(w):
    request = w.command(1900 * MS, "forwarded", ROBOT, 8, 1, call("HOLD"))
    lost(w)
    w.report(3200 * MS, SUPERVISOR, 1, 8, struct.pack(">IH", request, 0x0206))


@case("i6_ping_is_answered")
def a_ping_that_nobody_is_there_for(w):
    ping(w)


@case("i10_commandable_again")
def a_shutdown_that_the_next_supervisor_carries_out_ends_the_flight(w):
    w.sent(1 * S, SUPERVISOR, 8, 1, "SHUTDOWN")
    w.action(1010 * MS, "shutdown asked for")
    lost(w, 1200 * MS)
    w.at(2 * S, "calm", "recovered")


@case("i12_no_operational_without_required_link")
def a_link_that_the_next_supervisor_takes_down(w):
    w.without("state MANIPULATOR", "state JOYSTICK", "links")
    w.at(50 * MS, "links").at(60 * MS, f"state MANIPULATOR {SAFE}").at(900 * MS, "links 1 2").at(1 * S, f"state MANIPULATOR {OPERATIONAL}")
    lost(w)
    w.at(2310 * MS, "links").at(2400 * MS, "inhibited MANIPULATOR 4")


@case("i4_a_stop_stays")
def acts_again_before_the_next_supervisor_can_hear_of_a_stop(w):
    w.at(60 * MS, ACTS)
    lost(w)
    w.at(2010 * MS, "did safe").at(2050 * MS, "active robot 0").at(2060 * MS, "active robot 1").at(2310 * MS, "active robot 0")


@case("i4_a_stop_stays", found="robot acts again")
def acts_again_though_the_supervisor_before_had_heard_of_a_stop(w):
    w.at(60 * MS, ACTS).at(1 * S, "did safe").at(1005 * MS, "active robot 0")
    lost(w)
    w.at(2400 * MS, "active robot 1")


@case("i4_a_network_goes_down_with_its_member")
def a_supervisor_that_dies_takes_no_network_down(w):
    lost(w)
