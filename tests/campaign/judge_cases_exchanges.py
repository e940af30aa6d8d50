# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I20 and I21 (judge/exchange_rules.py): descriptors that are read again, and versions of programs."""
import struct

from judge_cases import case
from judge_cases_couplings import COUPLINGS
from judge_flight import MS, S, SUPERVISOR
from descriptors import OFFLINE

TEXTS, WHOLE = "i20_what_flies_is_a_text_that_was_taken", "i20_a_text_is_taken_whole_or_not_at_all"
ASKED_FOR, CONFIRMED = "i21_the_version_that_runs_was_asked_for", "i21_who_is_not_confirmed_goes_back"
DIED, FINAL = "i1_only_victims_die", "i2_one_final_report"
LED = 21


def exchanging(rule, found=""):
    return case(rule, found, COUPLINGS)


def asks(w, at, function, *arguments, ends=None, success=True, apid=LED):
    """The telecommand in the log, and its end."""
    data = function.encode().ljust(16, b"\0") + bytes([1 + len(arguments), 1]) + struct.pack(">H", apid)
    for place, given in enumerate(arguments, 2):
        words = given.encode() if isinstance(given, str) else b""
        data += bytes([place]) + struct.pack(">H", len(words) if isinstance(given, str) else given) + words
    request = w.command(at, "received", SUPERVISOR, 8, 1, data)
    if ends is not None:
        w.verified(ends, request, 7 if success else 8)


def rests(w, at=500 * MS):
    """LED is Offline, and its file says something else."""
    w.at(0, "text LED aaaa0001").at(at, f"state LED {OFFLINE}").at(600 * MS, "wrote LED bbbb0002 sound")


# --- I20 -------------------------------------------------------------------------------------------------------------------
@exchanging(TEXTS)
def a_text_that_was_asked_for(w):
    rests(w)
    asks(w, 1 * S, "REREAD", ends=1020 * MS)
    w.at(1010 * MS, "text LED bbbb0002").at(1500 * MS, "text LED bbbb0002")


@exchanging(TEXTS, found="LED flies by another text, and nobody has asked for that")
def a_text_that_nobody_asked_for(w):
    rests(w)
    asks(w, 1 * S, "REREAD", apid=22)
    w.at(1010 * MS, "text LED bbbb0002")


@exchanging(TEXTS, found="LED flies by a text that nobody wrote, cccc0003")
def a_text_that_nobody_wrote(w):
    rests(w)
    asks(w, 1 * S, "REREAD")
    w.at(1010 * MS, "text LED cccc0003")


@exchanging(TEXTS, found="LED flies by a text that is none, dddd0004")
def a_text_that_is_none(w):
    rests(w)
    w.at(700 * MS, "wrote LED dddd0004 faulty").at(1010 * MS, "text LED dddd0004")
    asks(w, 1 * S, "REREAD")


@exchanging(TEXTS, found="LED took another text beyond Pre-Operational")
def a_text_in_operational(w):
    rests(w, 4 * S)
    asks(w, 1 * S, "REREAD")
    w.at(1010 * MS, "text LED bbbb0002")


@exchanging(TEXTS)
def whoever_was_down_begins_with_what_was_taken(w):
    rests(w)
    w.at(700 * MS, "did kill LED", "alive LED 0").at(5 * S, "alive LED 1", "text LED bbbb0002")
    asks(w, 1 * S, "REREAD")


@exchanging(TEXTS)
def what_a_version_brought_goes_with_it(w):
    rests(w)
    asks(w, 700 * MS, "REPLACE", "2", 1)
    w.at(710 * MS, "alive LED 0").at(720 * MS, "alive LED 1", "text LED bbbb0002", "version LED 2")
    w.at(4 * S, "text LED aaaa0001").at(4900 * MS, "end")


@exchanging(TEXTS)
def what_was_asked_may_stand_in_a_gap(w):
    rests(w)
    w.record(1 * S, "gap", lost=3).at(1010 * MS, "text LED bbbb0002")


@exchanging(WHOLE)
def a_text_that_was_taken_and_one_that_was_refused(w):
    rests(w)
    asks(w, 1 * S, "REREAD", ends=1020 * MS)
    w.at(1010 * MS, "text LED bbbb0002").at(1500 * MS, "wrote LED dddd0004 faulty")
    asks(w, 4200 * MS, "REREAD", ends=4210 * MS, success=False)


@exchanging(WHOLE, found="LED was read again, and flies by aaaa0001 in place of bbbb0002")
def a_text_that_was_said_to_be_taken(w):
    rests(w)
    asks(w, 1 * S, "REREAD", ends=1020 * MS)


@exchanging(WHOLE, found="LED was read again, and flies by bbbb0002 in place of aaaa0001")
def a_text_that_stands_in_no_file(w):
    w.at(0, "text LED aaaa0001").at(1010 * MS, "text LED bbbb0002")
    asks(w, 1 * S, "REREAD", ends=1020 * MS)


@exchanging(WHOLE, found="LED was not read again, and flies by another text")
def a_text_that_was_said_to_be_refused(w):
    rests(w)
    asks(w, 1 * S, "REREAD", ends=1020 * MS, success=False)
    w.at(1010 * MS, "text LED bbbb0002")


@exchanging(WHOLE)
def what_was_asked_of_nobody_or_twice_or_has_no_end(w):
    rests(w)
    asks(w, 1 * S, "REREAD", apid=99, ends=1020 * MS)
    asks(w, 2 * S, "REREAD", ends=2020 * MS)
    asks(w, 2010 * MS, "REREAD", ends=2030 * MS)
    asks(w, 4 * S, "REREAD")


@exchanging(WHOLE)
def what_was_read_while_another_supervisor_began(w):
    rests(w)
    w.at(990 * MS, "did kill SUPERVISOR 300", "supervised 0").at(1300 * MS, "supervised 1")
    asks(w, 1 * S, "REREAD", ends=1400 * MS)


# --- I21 -------------------------------------------------------------------------------------------------------------------
def replaced(w, version="2", within=1, at=1 * S):
    rests(w)
    asks(w, at, "REPLACE", version, within, ends=at + 20 * MS)
    w.at(at + 10 * MS, "alive LED 0").at(at + 15 * MS, "alive LED 1", f"version LED {version}")


@exchanging(ASKED_FOR)
def a_version_that_was_asked_for_and_goes_again(w):
    replaced(w)
    w.at(2100 * MS, "alive LED 0").at(2110 * MS, "alive LED 1", "version LED -")


@exchanging(ASKED_FOR, found="LED runs 3 behind -, which nobody has asked for")
def a_version_that_nobody_asked_for(w):
    replaced(w)
    w.without("version LED 2").at(1015 * MS, "version LED 3")


@exchanging(ASKED_FOR, found="LED runs 2 behind -, which nobody has asked for")
def a_version_that_was_refused(w):
    asks(w, 1 * S, "REPLACE", "2", 1, ends=1010 * MS, success=False)
    w.at(1015 * MS, "alive LED 0", "alive LED 1", "version LED 2")


@exchanging(ASKED_FOR, found="LED runs - behind 2, which nobody has asked for")
def a_version_that_was_confirmed_and_goes(w):
    replaced(w)
    asks(w, 1500 * MS, "CONFIRM", ends=1510 * MS)
    w.at(3 * S, "alive LED 0").at(3010 * MS, "alive LED 1", "version LED -")


@exchanging(ASKED_FOR)
def a_version_that_was_confirmed_and_is_taken_back(w):
    replaced(w)
    asks(w, 1500 * MS, "CONFIRM", ends=1510 * MS)
    asks(w, 3 * S, "TAKE_BACK", ends=3020 * MS)
    w.at(3 * S, "alive LED 0").at(3010 * MS, "alive LED 1", "version LED -").at(4 * S, "alive LED 0", "alive LED 1")


@exchanging(ASKED_FOR)
def a_version_whose_request_may_stand_in_a_gap(w):
    w.record(1 * S, "gap", lost=3).at(1015 * MS, "version LED 2")


@exchanging(CONFIRMED, found="LED runs 2 long after its trial, and nobody has confirmed it")
def a_trial_without_an_end(w):
    replaced(w)
    w.at(20 * S, "end")


@exchanging(CONFIRMED)
def a_trial_that_was_confirmed(w):
    replaced(w)
    asks(w, 1500 * MS, "CONFIRM", ends=1510 * MS)
    w.at(3 * S, "did kill LED", "alive LED 0", "alive LED 1").at(20 * S, "end")


@exchanging(CONFIRMED)
def a_trial_that_ended_by_itself(w):
    replaced(w)
    w.at(2100 * MS, "alive LED 0").at(2110 * MS, "alive LED 1", "version LED -").at(20 * S, "end")


@exchanging(CONFIRMED, found="LED begins again as 2, which was on trial as it ended")
def a_process_that_dies_on_trial_and_begins_again(w):
    replaced(w)
    w.at(1500 * MS, "did kill LED", "alive LED 0").at(1600 * MS, "alive LED 1")


@exchanging(CONFIRMED)
def what_was_confirmed_may_stand_in_a_gap(w):
    replaced(w)
    w.record(1500 * MS, "gap", lost=3).at(20 * S, "end")


# --- what other rules say of it ---------------------------------------------------------------------------------------------
@exchanging(DIED)
def a_process_that_ends_for_another_version(w):
    replaced(w)
    w.at(4 * S, "alive LED 0").at(4010 * MS, "alive LED 1", "version LED -")


@exchanging(DIED, found="LED died though nothing was done to it")
def a_process_that_ends_long_after_it_was_confirmed(w):
    replaced(w)
    w.at(4500 * MS, "alive LED 0").at(4600 * MS, "alive LED 1")


def given_up(w, at):
    request = w.command(at, "forwarded", LED, 8, 1, b"SET_STATE".ljust(16, b"\0") + bytes([1, 1, 0]))
    w.report(at + 5 * MS, SUPERVISOR, 1, 8, struct.pack(">IH", request, 0x0206))


@exchanging(FINAL)
def a_telecommand_to_a_process_that_ends_for_another_version_is_given_up(w):
    replaced(w)
    given_up(w, 1005 * MS)


@exchanging(FINAL, found="TC[8,1] to LED was given up though nothing was done to it")
def a_telecommand_to_another_version_is_given_up(w):
    replaced(w)
    given_up(w, 4500 * MS)
