# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of the rules on packets, but for I8 (judge/packet_rules.py)."""
import struct

from judge_cases import case
from judge_flight import JOYSTICK, MS, ROBOT, S, SUPERVISOR, call
from descriptors import OFFLINE, SAFE

# --- I2 --------------------------------------------------------------------------------------------------------------------
FINAL_RULE = "i2_one_final_report"


def forwarded(w, time=1 * S, ack=15):
    return w.command(time, "forwarded", ROBOT, 8, 1, call("HOLD"), ack=ack)


@case(FINAL_RULE, found="TC[8,1] HOLD to MANIPULATOR has no final report")
def a_telecommand_without_an_end(w):
    w.verified(1010 * MS, forwarded(w), 1, ROBOT)


@case(FINAL_RULE)
def a_telecommand_that_is_completed(w):
    w.verified(1010 * MS, forwarded(w), 7, ROBOT)


@case(FINAL_RULE)
def a_telecommand_that_failed_to_start(w):
    w.verified(1010 * MS, forwarded(w), 4, ROBOT)


@case(FINAL_RULE)
def a_telecommand_whose_end_only_ground_has(w):
    w.down(1010 * MS, ROBOT, 1, 8, forwarded(w), logged=False)


@case(FINAL_RULE)
def a_telecommand_whose_end_nobody_wants(w):
    forwarded(w, ack=1)


@case(FINAL_RULE)
def a_telecommand_of_the_last_second(w):
    forwarded(w, time=4500 * MS)


@case(FINAL_RULE)
def a_telecommand_after_the_shutdown(w):
    w.action(900 * MS, "shutdown asked for")
    forwarded(w)


@case(FINAL_RULE, found="has 2 final reports")
def a_telecommand_with_two_ends(w):
    request = forwarded(w)
    w.verified(1010 * MS, request, 8, ROBOT).verified(1020 * MS, request, 7, ROBOT)


def stopped_twice(w, marks):
    """The supervisor dies as it tells, and the next one tells again."""
    request = w.command(1 * S, "forwarded", SUPERVISOR, 8, 1, call("SAFE_ALL"))
    w.verified(1010 * MS, request, 7)
    for time in range(marks):
        w.report((1500 + time) * MS, SUPERVISOR, 5, 1, struct.pack(">HIH", 153, request, 0))
    w.verified(1600 * MS, request, 7)


@case(FINAL_RULE)
def an_end_of_a_stop_that_was_marked_as_told_again(w):
    stopped_twice(w, marks=1)


@case(FINAL_RULE, found="has 2 final reports")
def an_end_of_a_stop_that_is_told_again_without_a_word(w):
    stopped_twice(w, marks=0)


@case(FINAL_RULE)
def a_damaged_packet_may_bear_any_request(w):
    w.verified(1010 * MS, 0x180AC7FF, 2).verified(1020 * MS, 0x180AC7FF, 2)


@case(FINAL_RULE)
def a_report_too_short_for_its_request(w):
    w.report(1 * S, ROBOT, 1, 7, b"\1")


@case(FINAL_RULE, found="has no final report")
def a_report_of_another_service_is_no_end(w):
    w.report(1010 * MS, ROBOT, 3, 7, struct.pack(">I", forwarded(w)))


def vanished(w, time=1 * S, **how):
    return w.sent(time, ROBOT, 17, 1, **how)


def unknown(w, code=0x0206, of=SUPERVISOR):
    w.report(2 * S, of, 1, 8, struct.pack(">IH", forwarded(w), code))


@case(FINAL_RULE, found="TC[8,1] to MANIPULATOR was given up though nothing was done to it")
def a_telecommand_to_who_lives_is_given_up(w):
    unknown(w)


@case(FINAL_RULE)
def a_telecommand_to_who_died_is_given_up(w):
    w.at(1500 * MS, "did kill MANIPULATOR")
    unknown(w)


@case(FINAL_RULE)
def a_telecommand_to_who_was_killed_as_it_left_is_given_up(w):
    w.at(900 * MS, "did kill MANIPULATOR")
    unknown(w)


@case(FINAL_RULE)
def a_telecommand_on_its_way_as_the_craft_shuts_down_is_given_up(w):
    w.action(1900 * MS, "shutdown asked for")
    unknown(w)


@case(FINAL_RULE)
def a_telecommand_that_comes_while_the_craft_shuts_down_is_given_up(w):
    w.action(900 * MS, "shutdown asked for")
    unknown(w)


@case(FINAL_RULE, found="TC[8,1] to MANIPULATOR was given up though nothing was done to it")
def a_telecommand_whose_end_was_lost_long_before_the_craft_shuts_down(w):
    w.action(2001 * MS, "shutdown asked for")
    w.report(2002 * MS, SUPERVISOR, 1, 8, struct.pack(">IH", forwarded(w), 0x0206))


@case(FINAL_RULE)
def a_telecommand_that_fails_for_another_reason(w):
    unknown(w, code=5)


@case(FINAL_RULE)
def a_telecommand_whose_addressee_says_so_itself(w):
    unknown(w, of=ROBOT)


@case(FINAL_RULE)
def a_request_that_nobody_forwarded_is_given_up(w):
    w.report(2 * S, SUPERVISOR, 1, 8, struct.pack(">IH", 0x180AC7FF, 0x0206))


@case(FINAL_RULE, found="TC[17,1] of ground vanished")
def a_telecommand_that_vanishes(w):
    vanished(w)


@case(FINAL_RULE)
def a_telecommand_that_is_logged(w):
    vanished(w, count=5)
    w.command(1 * S, "refused", ROBOT, 17, 1, count=5)


@case(FINAL_RULE)
def a_telecommand_that_only_ground_knows_the_fate_of(w):
    w.down(1010 * MS, SUPERVISOR, 1, 2, vanished(w), logged=False)


@case(FINAL_RULE)
def a_telecommand_that_vanishes_on_a_link_that_is_down(w):
    w.at(990 * MS, f"state COMMUNICATION {OFFLINE}")
    vanished(w)


@case(FINAL_RULE)
def a_telecommand_that_vanishes_with_the_ground_link(w):
    w.at(1150 * MS, "did kill COMMUNICATION")
    vanished(w)


@case(FINAL_RULE, found="TC[17,1] of ground vanished")
def a_telecommand_that_vanishes_long_before_the_ground_link(w):
    w.at(1500 * MS, "did kill COMMUNICATION")
    vanished(w)


@case(FINAL_RULE)
def a_telecommand_that_vanishes_in_the_last_second(w):
    vanished(w, time=4500 * MS)


@case(FINAL_RULE)
def a_telecommand_of_a_subsystem_that_vanishes(w):
    vanished(w, origin="JOYSTICK", source=JOYSTICK)


# --- I3 --------------------------------------------------------------------------------------------------------------------
LOG_RULE = "i3_everything_is_logged_once"


@case(LOG_RULE)
def a_log_of_two_records(w):
    w.action(1 * S, "one").action(1 * S, "two")


@case(LOG_RULE, found="record number 1 stands twice")
def a_number_that_stands_twice(w):
    w.action(1 * S, "one").record(1 * S, "action", number=1)


@case(LOG_RULE, found="a packet of MANIPULATOR stands twice")
def a_packet_that_stands_twice(w):
    for _ in range(2):
        w.report(1 * S, ROBOT, 17, 2, count=9, onboard=1)


@case(LOG_RULE, found="2 records and 0 lost are not the 7 that were numbered")
def a_log_with_a_hole(w):
    w.action(1 * S, "one").record(1 * S, "action", number=7)


@case(LOG_RULE)
def a_log_with_a_hole_that_is_counted(w):
    w.action(1 * S, "one").record(1 * S, "gap", lost=5).action(1 * S, "seven")


@case(LOG_RULE, found="was received 2 times")
def a_request_that_is_received_twice(w):
    for _ in range(2):
        w.command(1 * S, "received", ROBOT, 17, 1, count=3)


@case(LOG_RULE, found="1 reports came to ground and are not in the log, the first MANIPULATOR")
def a_report_that_is_not_logged(w):
    w.down(1 * S, ROBOT, 17, 2, logged=False)


@case(LOG_RULE)
def a_report_that_the_log_says_it_lost(w):
    w.record(1 * S, "gap", lost=1).down(1 * S, ROBOT, 17, 2, logged=False)


def ended_without_disk(w, *fault):
    w.at(800 * MS, *(f"did log {each}" for each in fault))
    w.down(1 * S, ROBOT, 17, 2, logged=False).down(1 * S, ROBOT, 1, 1, 0x180AC005, logged=False)


@case(LOG_RULE)
def a_flight_that_ends_while_the_disk_fails(w):
    ended_without_disk(w, "failing")


@case(LOG_RULE, found="2 reports came to ground and are not in the log")
def a_flight_that_ends_behind_a_disk_that_works_again(w):
    ended_without_disk(w, "full", "heal")


@case(LOG_RULE, found="2 reports came to ground and are not in the log")
def a_flight_that_was_calm_at_its_end(w):
    ended_without_disk(w, "failing")
    w.at(3 * S, "calm")


@case(LOG_RULE, found="2 reports came to ground and are not in the log")
def a_log_that_was_deleted_in_flight(w):
    ended_without_disk(w, "deleted")


@case(LOG_RULE)
def what_went_with_a_deleted_log_was_logged(w):
    w.down(700 * MS, ROBOT, 1, 1, w.command(600 * MS, "received", ROBOT, 17, 1))
    w.delete_log()
    w.action(900 * MS, "begun anew")


@case(LOG_RULE, found="1 records and 1 lost are not the")
def a_deleted_log_whose_gap_tells_of_less(w):
    w.down(700 * MS, ROBOT, 1, 1, w.command(600 * MS, "received", ROBOT, 17, 1))
    w.delete_log(told=1)
    w.action(900 * MS, "begun anew")


@case(LOG_RULE, found="1 reports came to ground and are not in the log")
def a_report_before_the_disk_failed(w):
    w.down(700 * MS, ROBOT, 17, 2, logged=False)
    ended_without_disk(w, "failing")


@case(LOG_RULE, found="was acknowledged and is not in the log")
def an_acknowledged_request_that_is_not_logged(w):
    w.down(1 * S, ROBOT, 1, 1, 0x180AC005)


@case(LOG_RULE)
def a_refused_request_that_is_not_logged(w):
    w.down(1 * S, ROBOT, 1, 2, 0x180AC005)


@case(LOG_RULE)
def an_acknowledged_request_that_is_logged(w):
    w.down(1 * S, ROBOT, 1, 1, w.command(1 * S, "received", ROBOT, 17, 1))


# --- I6 --------------------------------------------------------------------------------------------------------------------
PING_RULE = "i6_ping_is_answered"


def ping(w, answered=None, time=1 * S, subtype=7, **how):
    request = w.sent(time, SUPERVISOR, 17, 1, **how)
    if answered is not None:
        w.down(time + answered, SUPERVISOR, 1, subtype, request)


@case(PING_RULE)
def a_ping_that_is_answered(w):
    ping(w, 100 * MS)


@case(PING_RULE)
def a_ping_that_is_refused(w):
    ping(w, 100 * MS, subtype=2)


@case(PING_RULE, found="not answered within 200 ms")
def a_ping_that_is_answered_late(w):
    ping(w, 210 * MS)


@case(PING_RULE, found="not answered within 200 ms")
def a_ping_that_is_only_accepted(w):
    ping(w, 100 * MS, subtype=1)


@case(PING_RULE)
def a_ping_beside_a_flood_that_is_answered_late(w):
    w.at(900 * MS, "did flood ground valid 100")
    ping(w, 400 * MS)


@case(PING_RULE, found="not answered within 500 ms")
def a_ping_beside_a_flood_that_is_answered_too_late(w):
    w.at(900 * MS, "did flood ground valid 100")
    ping(w, 510 * MS)


@case(PING_RULE)
def a_ping_whose_end_nobody_wants(w):
    ping(w, ack=1)


@case(PING_RULE)
def a_ping_at_the_end(w):
    w.action(1100 * MS, "shutdown asked for")
    ping(w)


@case(PING_RULE)
def a_ping_over_a_link_that_goes_down(w):
    w.at(1100 * MS, f"state COMMUNICATION {SAFE}")
    ping(w)


@case(PING_RULE)
def a_ping_to_a_subsystem(w):
    w.sent(1 * S, ROBOT, 17, 1)


@case(PING_RULE)
def another_telecommand_of_that_service(w):
    w.sent(1 * S, SUPERVISOR, 17, 3)


@case(PING_RULE)
def a_ping_of_a_subsystem(w):
    ping(w, origin="JOYSTICK", source=JOYSTICK)


# --- I11 -------------------------------------------------------------------------------------------------------------------
BACK_RULE = "i11_nothing_goes_back"
HOUSEKEEPING, EVENT, ANSWER = (3, 25), (5, 1), (1, 7)


def told(w, *reports):
    """(count, kind[, on-board time]) of the robot, in the order of the log, 1 ms apart."""
    for place, (count, kind, *onboard) in enumerate(reports):
        w.report(1 * S + place * MS, ROBOT, *kind, bytes(4), count=count, onboard=onboard[0] if onboard else count)


@case(BACK_RULE)
def kinds_of_reports_overtake_one_another(w):
    told(w, (7, ANSWER), (9, EVENT), (3, HOUSEKEEPING), (4, HOUSEKEEPING), (10, ANSWER))


@case(BACK_RULE, found="sequence count of MANIPULATOR goes from 7 to 6 (housekeeping)")
def a_count_goes_back_within_its_kind(w):
    told(w, (7, HOUSEKEEPING), (9, ANSWER), (6, HOUSEKEEPING, 9))


@case(BACK_RULE)
def a_report_on_a_structure_is_no_housekeeping(w):
    told(w, (7, (3, 10)), (3, HOUSEKEEPING))


@case(BACK_RULE)
def counts_go_round(w):
    told(w, *((count % 16384, HOUSEKEEPING, count) for count in range(10, 40000, 4000)))


@case(BACK_RULE)
def more_than_half_a_round_went_into_a_gap_of_the_log(w):
    told(w, (0, HOUSEKEEPING, 0))
    w.record(1500 * MS, "gap", lost=12000)
    w.report(2 * S, ROBOT, *HOUSEKEEPING, bytes(4), count=12001, onboard=2).report(3 * S, ROBOT, *ANSWER, bytes(4), count=12002, onboard=3)


@case(BACK_RULE)
def an_event_long_after_the_last_one(w):
    told(w, (0, EVENT), *((count, HOUSEKEEPING) for count in range(1, 16000, 4000)), (15000, EVENT))


@case(BACK_RULE, found="times of MANIPULATOR go back (event)")
def a_time_goes_back_within_its_kind(w):
    told(w, (7, EVENT, 70), (8, ANSWER, 10), (9, EVENT, 69))


@case(BACK_RULE, found="the times of the log go back")
def the_times_of_the_log(w):
    w.action(1 * S, "later").action(999 * MS, "earlier")


@case(BACK_RULE, found="the times of the log go back")
def the_times_of_storing(w):
    w.record(1 * S, "action", stored=9).record(1 * S, "action", stored=8)


@case(BACK_RULE)
def a_gap_stands_where_it_was_noticed(w):
    w.action(1 * S, "later").record(999 * MS, "gap", lost=1)
