# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of the rules on what comes down again (judge/retrieval_rules.py). The clock of these flights says microseconds where others say nanoseconds."""
import struct, zlib

from judge_cases import case
from judge_flight import JOYSTICK, MS, ROBOT, S, SUPERVISOR

END_OF_TIME = 2**32 - 1
NONE, NOT_DECLARED, QUEUE_FULL, BUSY = 9, 18, 11, 0x0108
ANSWERED, ENDS, EARLY = "i14_who_may_ask_is_answered", "i14_what_is_begun_ends_once", "i14_it_ends_early_for_a_reason"
HELD, FIRST = "i14_it_is_what_the_log_has", "i14_what_is_said_now_goes_first"


def cuc(time):
    return (time * 2**24 // 10**9).to_bytes(7, "big")


def asks(w, time=1 * S, first=0, last=END_OF_TIME * 10**9, housekeeping=1, data=None, **how):
    data = cuc(first) + cuc(last) + bytes([housekeeping]) if data is None else data
    return w.sent(time, SUPERVISOR, 129, 11, data.hex() or "-", **how)


def verdict(w, request, subtype, code=None, source=0, time=1010 * MS):
    w.report(time, SUPERVISOR, 1, subtype, struct.pack(">I", request) + (b"" if code is None else struct.pack(">H", code)), destination=source)


def says(w, time=500 * MS, apid=ROBOT, service=17, subtype=2, data=b""):
    """A report in the log: its number and octets."""
    w.report(time, apid, service, subtype, data)
    return w.numbers, bytes.fromhex(w.log[-1][1].split(" ")[7])


def again(w, time, report, source=0, digest=None):
    number, packet = report
    w.at(time, f"down {SUPERVISOR} {w.next(SUPERVISOR)} 129 12 {source} {number} {zlib.crc32(packet) if digest is None else digest}")


def ends(w, time, request, reports=0, left_out=0, missing=0, damaged=0, why="-", source=0):
    w.at(time, f"down {SUPERVISOR} {w.next(SUPERVISOR)} 129 13 {source} {request} {reports} {left_out} {missing} {damaged} {why}")


# --- who may ask, and for what ---------------------------------------------------------------------------------------------
@case(ANSWERED, found="COMMUNICATION filled the downlink")
def a_subsystem_asks_and_is_heard(w):
    verdict(w, asks(w, origin="COMMUNICATION", source=2), 7, source=2)


@case(ANSWERED, found="COMMUNICATION filled the downlink")
def a_subsystem_asks_and_it_ends(w):
    ends(w, 1100 * MS, asks(w, origin="COMMUNICATION", source=2), source=2)


@case(ANSWERED)
def a_subsystem_asks_and_is_refused(w):
    verdict(w, asks(w, origin="COMMUNICATION", source=2), 2, NOT_DECLARED, source=2)


@case(ANSWERED, found="refused for another reason, 9")
def a_subsystem_asks_and_is_refused_as_if_it_might(w):
    verdict(w, asks(w, origin="COMMUNICATION", source=2), 2, NONE, source=2)


@case(ANSWERED)
def a_subsystem_asks_and_nobody_hears_it(w):
    asks(w, origin="COMMUNICATION", source=2)


@case(ANSWERED)
def who_is_not_the_supervisor_refuses_as_it_likes(w):
    verdict(w, w.sent(1 * S, ROBOT, 129, 11, "-"), 2, NONE)


@case(ANSWERED, found="what is no range of times was begun")
def times_that_go_back_are_begun(w):
    verdict(w, asks(w, first=2 * S, last=1 * S), 3)


@case(ANSWERED, found="what is no range of times was begun")
def nothing_at_all_is_begun(w):
    ends(w, 1100 * MS, asks(w, data=b""))


@case(ANSWERED)
def what_is_neither_yes_nor_no_is_refused(w):
    verdict(w, asks(w, housekeeping=2), 2, NONE)


@case(ANSWERED, found="a range of times was refused as none")
def a_range_is_refused(w):
    verdict(w, asks(w, first=1 * S, last=1 * S), 2, NONE)


@case(ANSWERED)
def a_range_is_begun(w):
    verdict(w, asks(w), 7)


@case(ANSWERED, found="what is no range of times was begun")
def what_only_ground_has_of_it_counts(w):
    w.down(1010 * MS, SUPERVISOR, 1, 7, asks(w, data=b""), logged=False)


@case(ANSWERED, found="a range of times was not begun, code 264")
def busy_with_nothing(w):
    verdict(w, asks(w), 4, BUSY)


@case(ANSWERED)
def busy_with_another_ground(w):
    asks(w, 900 * MS, source=77)
    verdict(w, asks(w), 4, BUSY)


@case(ANSWERED, found="code 264")
def busy_with_another_ground_that_has_ended(w):
    ends(w, 950 * MS, asks(w, 900 * MS, source=77), source=77)
    verdict(w, asks(w), 4, BUSY)


@case(ANSWERED, found="code 264")
def busy_with_the_same_ground(w):
    asks(w, 900 * MS)
    verdict(w, asks(w), 4, BUSY)


@case(ANSWERED)
def full_with_a_log_that_was_struck(w):
    w.at(500 * MS, "did log full")
    verdict(w, asks(w), 4, QUEUE_FULL)


@case(ANSWERED, found="code 11")
def full_with_a_log_that_was_not(w):
    verdict(w, asks(w), 4, QUEUE_FULL)


# --- it ends, once ---------------------------------------------------------------------------------------------------------
@case(ENDS, found="did not end in 3.2 s")
def it_never_ends(w):
    asks(w)


@case(ENDS)
def it_ends(w):
    ends(w, 1100 * MS, asks(w))


@case(ENDS, found="has 2 ends")
def it_ends_twice(w):
    request = asks(w)
    ends(w, 1100 * MS, request)
    ends(w, 1200 * MS, request)


@case(ENDS)
def what_was_refused_has_no_end(w):
    verdict(w, asks(w), 4, BUSY)


@case(ENDS)
def what_no_range_is_has_no_end(w):
    asks(w, data=b"\1")


@case(ENDS)
def what_a_subsystem_asks_has_no_end(w):
    asks(w, origin="COMMUNICATION", source=2)


@case(ENDS)
def with_a_ground_link_that_was_struck_it_may_be_lost(w):
    w.at(1100 * MS, "did stop COMMUNICATION")
    asks(w)


@case(ENDS)
def with_a_log_that_was_struck_it_waits(w):
    w.at(1100 * MS, "did log frozen")
    asks(w)


@case(ENDS)
def the_flight_is_over_before(w):
    asks(w, 4 * S)


# --- and early for a reason ------------------------------------------------------------------------------------------------
@case(EARLY)
def it_ends_by_itself(w):
    ends(w, 1100 * MS, asks(w))


@case(EARLY, found="which nobody has asked")
def an_end_of_nothing(w):
    ends(w, 1100 * MS, 1)


@case(EARLY, found="it ended as asked anew, and nobody did")
def asked_anew_by_nobody(w):
    request = asks(w)
    asks(w, 1050 * MS, source=77)
    asks(w, 1060 * MS, first=2 * S, last=1 * S)
    ends(w, 1100 * MS, request, why="asked_anew")


@case(EARLY)
def asked_anew(w):
    request = asks(w)
    asks(w, 1050 * MS)
    ends(w, 1100 * MS, request, why="asked_anew")


@case(EARLY, found="though nothing was done to the log: what_was_said_last")
def not_on_a_disk_that_works(w):
    ends(w, 4100 * MS, asks(w), why="what_was_said_last_is_not_on_the_disk_yet")


@case(EARLY)
def not_on_a_disk_that_stands_still(w):
    w.at(900 * MS, "did log frozen")
    ends(w, 4100 * MS, asks(w), why="what_was_said_last_is_not_on_the_disk_yet")


@case(EARLY, found="though nothing was done to the log: the_log_cannot")
def a_disk_that_works_cannot_be_read(w):
    ends(w, 1100 * MS, asks(w), why="the_log_cannot_be_read:_the_disk_fails")


@case(EARLY, found="for what nobody has written down: no_wish")
def for_a_reason_of_its_own(w):
    ends(w, 1100 * MS, asks(w), why="no_wish")


# --- what comes ------------------------------------------------------------------------------------------------------------
def all_of_it(w, wanted=lambda number: True, more=(), **end):
    """Three reports of which one is housekeeping, asked for whole; what of them comes."""
    reports = [says(w, 300 * MS), says(w, 400 * MS, service=3, subtype=25), says(w, 500 * MS, JOYSTICK, 5, 1, b"\xf0\0\3")]
    request = asks(w)
    came = [report for place, report in enumerate(reports, 1) if wanted(place)] + list(more)
    for report in came:
        again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, **{"reports": len(came), **end})
    return reports


@case(HELD)
def all_that_was_asked_for(w):
    all_of_it(w)
    w.down(1200 * MS, SUPERVISOR, 129, 2).down(1210 * MS, SUPERVISOR, 17, 2)


@case(HELD, found="1 reports that were asked for did not come, the first 2 of MANIPULATOR, and its end tells of 0 that are missing")
def one_does_not_come(w):
    all_of_it(w, lambda place: place != 2)


@case(HELD, found="2 reports that were asked for did not come")
def more_do_not_come_than_it_tells_of(w):
    w.at(200 * MS, "did log deleted")
    all_of_it(w, lambda place: place == 2, missing=1)


@case(HELD)
def what_went_with_a_deleted_log_is_missing(w):
    w.at(600 * MS, "did log deleted")
    for time in (300, 400):
        says(w, time * MS)
    w.delete_log()
    report = says(w, 700 * MS)
    request = asks(w)
    again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, 1, missing=2)


@case(HELD, found="1 are told to be missing though nothing was done to the log")
def missing_though_all_is_there(w):
    all_of_it(w, missing=1)


@case(HELD)
def housekeeping_that_is_not_wanted(w):
    says(w, service=3, subtype=25)
    ends(w, 1100 * MS, asks(w, housekeeping=0))


@case(HELD, found="1 reports came down again that were not asked for, the first number 1")
def housekeeping_that_comes_all_the_same(w):
    report = says(w, service=3, subtype=25)
    request = asks(w, housekeeping=0)
    again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, 1)


@case(HELD, found="not asked for")
def of_another_time(w):
    report = says(w, 500 * MS)
    request = asks(w, first=600 * MS, last=700 * MS)
    again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, 1)


@case(HELD)
def what_is_said_meanwhile_may_come(w):
    request = asks(w)
    again(w, 1050 * MS, says(w, 1020 * MS))
    ends(w, 1100 * MS, request, 1)


@case(HELD, found="number 1 of the log is not what stands there")
def in_other_words(w):
    report = says(w)
    again(w, 1050 * MS, report, digest=1)


@case(HELD, found="number 99 of the log is not what stands there")
def what_the_log_never_had(w):
    again(w, 1050 * MS, (99, b"x"))


@case(HELD, found="number 1 of the log is not what stands there")
def what_is_no_report(w):
    w.action(500 * MS, "of its own")
    again(w, 1050 * MS, (1, b""))


@case(HELD, found="did not come in order, each once")
def one_comes_twice(w):
    report = says(w)
    request = asks(w)
    for _ in range(2):
        again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, 2)


@case(HELD, found="3 reports came down again, and its end tells of 2")
def its_end_tells_of_fewer(w):
    all_of_it(w, reports=2)


@case(HELD)
def what_ended_early_is_not_whole(w):
    all_of_it(w, lambda place: place == 1, why="asked_anew")


@case(HELD)
def what_finds_no_room_is_left_out(w):
    says(w, data=bytes(5000))
    ends(w, 1100 * MS, asks(w), left_out=1)


@case(HELD, found="1 reports find no room, and its end tells of 0")
def what_finds_no_room_is_not_told(w):
    says(w, data=bytes(5000))
    ends(w, 1100 * MS, asks(w))


@case(HELD, found="0 reports find no room, and its end tells of 1")
def what_finds_room_is_left_out(w):
    all_of_it(w, left_out=1)


@case(HELD)
def a_ground_link_that_was_struck_may_lose_some(w):
    w.at(1020 * MS, "did stop COMMUNICATION")
    all_of_it(w, lambda place: place != 2, reports=3)


@case(HELD)
def what_came_of_one_whose_end_was_lost(w):
    report = says(w, 300 * MS)
    again(w, 900 * MS, report)
    request = asks(w)
    again(w, 1050 * MS, report)
    ends(w, 1100 * MS, request, 1)


# --- and what is said now goes first -----------------------------------------------------------------------------------------
def many(w, number, until):
    request = asks(w)
    for place in range(number):
        again(w, 1010 * MS + place * (until - 1010 * MS) // number, (place, b""))
    ends(w, until + 10 * MS, request, number)


@case(FIRST, found="more than 88 reports came down again within 100 ms")
def too_many_at_once(w):
    many(w, 89, 1100 * MS)


@case(FIRST)
def as_many_as_may_be(w):
    many(w, 400, 1510 * MS)


@case(FIRST)
def too_many_at_once_from_a_ground_link_that_stood_still(w):
    w.at(900 * MS, "did stop COMMUNICATION").at(1010 * MS, "did go COMMUNICATION")
    many(w, 89, 1100 * MS)


@case(FIRST, found="a report of MANIPULATOR did not come down within 100 ms")
def what_is_said_now_waits(w):
    says(w, 1050 * MS)
    many(w, 40, 1300 * MS)


@case(FIRST)
def what_is_said_now_comes(w):
    w.down(1050 * MS, ROBOT, 17, 2).action(1060 * MS, "no report")
    many(w, 40, 1300 * MS)


@case(FIRST)
def what_is_said_now_waits_in_a_flood(w):
    w.at(900 * MS, "did flood ground valid 400")
    says(w, 1050 * MS)
    many(w, 40, 1300 * MS)


def told_lost(w, housekeeping, reports, time):
    w.report(time, SUPERVISOR, 5, 2, struct.pack(">HII", 111, housekeeping, reports))


@case(FIRST)
def what_is_told_as_lost_need_not_come(w):
    says(w, 1050 * MS)
    told_lost(w, 0, 1, 2 * S)
    many(w, 40, 1300 * MS)


@case(FIRST, found="a report of MANIPULATOR did not come down within 100 ms")
def more_is_lost_than_is_told(w):
    says(w, 1050 * MS)
    says(w, 1060 * MS)
    told_lost(w, 7, 1, 2 * S)
    many(w, 40, 1300 * MS)


@case(FIRST)
def what_is_said_at_the_end_need_not_come(w):
    w.action(1200 * MS, "shutdown asked for")
    says(w, 1150 * MS)
    many(w, 40, 1300 * MS)
