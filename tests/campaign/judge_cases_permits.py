# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I8: what may run in which mode and state, and with which arguments (judge/packet_rules.py)."""
import copy, struct

from judge_cases import case
from judge_flight import JOYSTICK, MISSION, MS, ROBOT, S, SUPERVISOR, call
from descriptors import ERROR, OPERATIONAL, PRE, SAFE, Argument, Function

# --- I8 --------------------------------------------------------------------------------------------------------------------
PERMIT_RULE = "i8_nothing_unauthorised"


def runs(w, function=None, *arguments, to=ROBOT, mode="telepresence", source=0, service=8, subtype=1, data=None, time=1 * S):
    """Received and forwarded in a mode."""
    w.action(100 * MS, f"mode {mode}")
    data = call(function, *arguments) if data is None else data
    for kind in ("received", "forwarded"):
        w.command(time, kind, to, service, subtype, data, source=source, count=77)


def in_state(w, state, of="MANIPULATOR", time=500 * MS):
    w.at(time, f"state {of} {state}")


@case(PERMIT_RULE)
def what_the_mode_permits(w):
    runs(w, "HOLD")


@case(PERMIT_RULE, found="TC[8,1] MOVE_TO  of ground to MANIPULATOR ran in mode telepresence, Operational")
def what_the_mode_does_not_permit(w):
    runs(w, "MOVE_TO")


@case(PERMIT_RULE, found="HOLD")
def what_the_state_does_not_permit(w):
    in_state(w, SAFE)
    runs(w, "HOLD")


@case(PERMIT_RULE)
def what_the_state_permitted_when_it_was_judged(w):
    in_state(w, SAFE, time=990 * MS)
    runs(w, "HOLD")


@case(PERMIT_RULE, found="HOLD")
def what_the_state_had_permitted_a_while_before(w):
    in_state(w, SAFE, time=970 * MS)
    runs(w, "HOLD")


@case(PERMIT_RULE, found="SET_STATE 5 of ground to JOYSTICK")
def what_the_mode_permits_for_another_only(w):
    runs(w, "SET_STATE", OPERATIONAL, to=JOYSTICK, mode="automatic")


@case(PERMIT_RULE)
def a_question_to_the_supervisor_is_everybodys(w):
    runs(w, service=129, data=b"", to=SUPERVISOR, mode="safe")


@case(PERMIT_RULE)
def reading_parameters_needs_no_state(w):
    runs(w, service=20, subtype=1, data=b"\0")


@case(PERMIT_RULE)
def what_another_mode_permitted_in_the_same_instant(w):
    runs(w, "MOVE_TO", mode="standalone", time=1 * S)
    w.action(1000 * MS + 500, "mode telepresence")


@case(PERMIT_RULE)
def what_the_mode_permits_in_spite_of_one_that_was_impossible(w):
    w.action(200 * MS, "mode telepresence is impossible: MANIPULATOR is in a recovery")
    runs(w, "MOVE_TO", mode="standalone", time=1 * S)


@case(PERMIT_RULE)
def a_ping_is_everybodys(w):
    runs(w, service=17, data=b"", mode="safe", source=JOYSTICK)


@case(PERMIT_RULE, found="TC[128,1]")
def a_handshake_is_not_grounds(w):
    runs(w, service=128, data=b"\1")


@case(PERMIT_RULE)
def a_handshake_is_the_supervisors(w):
    runs(w, service=128, data=b"\1", source=SUPERVISOR)


@case(PERMIT_RULE)
def the_supervisor_may_what_no_mode_permits(w):
    runs(w, "MOVE_TO", source=SUPERVISOR)


@case(PERMIT_RULE, found="HOLD")
def who_claims_to_be_the_supervisor(w):
    w.action(100 * MS, "mode telepresence")
    packet = struct.pack(">IHBBBH", (0x1800 | ROBOT) << 16 | 0xC000 | 77, 0, 0x2F, 8, 1, SUPERVISOR) + call("HOLD") + b"\0\0"
    for kind in ("received", "forwarded"):  # it came from the joystick
        w.record(1 * S, f"telecommand-{kind}", source=JOYSTICK, peer=ROBOT, packet=packet)


@case(PERMIT_RULE, found="APID 99")
def an_addressee_that_nobody_is(w):
    runs(w, "HOLD", to=99)


@case(PERMIT_RULE, found="SET_STATE 6 of ground to SUPERVISOR")
def the_supervisors_own_state(w):
    runs(w, "SET_STATE", ERROR, to=SUPERVISOR)


@case(PERMIT_RULE)
def towards_safety_in_every_mode(w):
    runs(w, "SET_STATE", ERROR, mode="safe")


@case(PERMIT_RULE)
def down_to_safe_operational_in_every_mode(w):
    runs(w, "SET_STATE", SAFE, mode="safe")


@case(PERMIT_RULE, found="SET_STATE 4")
def up_to_safe_operational_is_not_towards_safety(w):
    in_state(w, PRE)
    runs(w, "SET_STATE", SAFE, mode="safe")


@case(PERMIT_RULE)
def a_function_that_nobody_has(w):
    runs(w, "NONE", mode="safe")


@case(PERMIT_RULE)
def an_essential_function(w):
    runs(w, "SAFE_ALL", to=SUPERVISOR, mode="safe")


def write(w, name, mode="telepresence", number=1, cut=0):
    robot = MISSION.by_name("MANIPULATOR")
    wire_id = next((p.wire_id for p in robot.parameters if p.name == name), 0xDEAD)
    data = bytes([number]) + (struct.pack(">I", wire_id) + bytes(8))[:12 - cut]
    runs(w, service=20, subtype=3, data=data, mode=mode)


@case(PERMIT_RULE)
def a_parameter_that_mode_and_state_open(w):
    in_state(w, SAFE)
    write(w, "POS_SCALE")


@case(PERMIT_RULE, found="TC[20,3]")
def a_parameter_outside_its_states(w):
    write(w, "POS_SCALE")


@case(PERMIT_RULE, found="TC[20,3]")
def a_parameter_that_the_mode_does_not_open(w):
    in_state(w, SAFE)
    write(w, "POS_SCALE", mode="automatic")


@case(PERMIT_RULE, found="TC[20,3]")
def a_parameter_that_protects(w):
    in_state(w, SAFE)
    write(w, "TORQUE_LIMIT")


@case(PERMIT_RULE)
def a_write_to_an_unknown_parameter_is_the_addressees_to_refuse(w):
    write(w, "NONE")


@case(PERMIT_RULE)
def a_write_that_is_cut_off_is_the_addressees_to_refuse(w):
    write(w, "NONE", number=2, cut=9)


@case(PERMIT_RULE)
def a_write_of_nothing_is_the_addressees_to_refuse(w):
    runs(w, service=20, subtype=3, data=b"")


# --- I8, who asks: what a permit says that names senders, and what a subsystem may ask the supervisor for -------------------
FROM = copy.deepcopy(MISSION)
FROM.modes["telepresence"] = [("SUPERVISOR", {"SET_MODE", "SHUTDOWN"}, {"3"}, set(), {"JOYSTICK"}), ("MANIPULATOR", {"HOLD"}, set(), set(), {"ground"}),
                              ("MANIPULATOR", set(), set(), {"POS_SCALE"}, {"JOYSTICK"})]


@case(PERMIT_RULE, mission=FROM)
def who_is_named(w):
    runs(w, "HOLD")


@case(PERMIT_RULE, found="HOLD", mission=FROM)
def who_is_not_named(w):
    runs(w, "HOLD", source=JOYSTICK)


@case(PERMIT_RULE, found="TC[20,3]", mission=FROM)
def a_parameter_that_is_opened_for_another_sender(w):
    in_state(w, SAFE)
    write(w, "POS_SCALE")


@case(PERMIT_RULE, mission=FROM)
def a_subsystem_that_is_named_asks_the_supervisor_for_a_mode(w):
    runs(w, "SET_MODE", 1, to=SUPERVISOR, source=JOYSTICK)


@case(PERMIT_RULE, found="SET_MODE 1 of JOYSTICK to SUPERVISOR", mission=FROM)
def one_that_is_not_in_this_mode(w):
    runs(w, "SET_MODE", 1, to=SUPERVISOR, source=JOYSTICK, mode="standalone")


@case(PERMIT_RULE, found="SHUTDOWN  of JOYSTICK to SUPERVISOR", mission=FROM)
def what_is_the_grounds_alone_whoever_is_named(w):
    runs(w, "SHUTDOWN", to=SUPERVISOR, source=JOYSTICK)


@case(PERMIT_RULE, mission=FROM)
def a_stop_of_all_is_everybodys(w):
    runs(w, "SAFE_ALL", to=SUPERVISOR, source=JOYSTICK)


# --- I8, the arguments of a function ---------------------------------------------------------------------------------------
VALUES_RULE = "i8_what_its_descriptor_permits"
RAN, REFUSED = "PROGRAM of MANIPULATOR ran", "PROGRAM of MANIPULATOR was refused, though"
# One of each kind: SERIAL UINT64 from 2^53 + 1, OFFSET INT64 up to 0, COLOUR, NOTE, STEPS FLOAT[2], ON with a default.
TYPED = copy.deepcopy(MISSION)
TYPED.by_name("MANIPULATOR").functions["PROGRAM"] = Function("PROGRAM", {OPERATIONAL}, False, [
    Argument("SERIAL", "UINT64", 2**53 + 1, 2**64 - 1), Argument("OFFSET", "INT64", -2**63, 0), Argument("COLOUR", "INT8", None, None, values={-1, 7}),
    Argument("NOTE", "TEXT", None, None, octets=4), Argument("STEPS", "FLOAT", 0.0, 0.5, count=2),
    Argument("ON", "BOOL", None, None, values={0, 1}, has_default=True)])
GOOD = {1: struct.pack(">Q", 2**53 + 1), 2: struct.pack(">q", -2**63), 3: b"\xff", 4: b"\0\3\xe2\x82\xac", 5: struct.pack(">ff", 0, 0.5), 6: b"\1"}


def programmed(w, subtype, code=b"", given=None, number=None, cut=0, **runs_with):
    data = b"PROGRAM".ljust(16, b"\0") + bytes([len(given or GOOD) if number is None else number])
    data += b"".join(bytes([place]) + octets for place, octets in (given or GOOD).items())
    runs(w, data=data[:len(data) - cut], **runs_with)
    w.verified(1100 * MS, 0x180AC000 | 77, 1, apid=ROBOT)
    w.report(1200 * MS, ROBOT, 1, subtype, struct.pack(">I", 0x180AC000 | 77) + code)


WITH = [
    ("a_number_below_its_range_that_a_double_would_not_tell_from_it", {1: struct.pack(">Q", 2**53)}),
    ("a_negative_number_above_its_range", {2: struct.pack(">q", 1)}),
    ("a_value_that_its_enumeration_does_not_have", {3: b"\0"}),
    ("a_text_that_is_longer_than_declared", {4: b"\0\5abcde"}),
    ("a_text_that_is_no_utf8", {4: b"\0\1\xff"}),
    ("a_text_with_a_zero", {4: b"\0\2a\0"}),
    ("one_element_of_an_array_outside_its_range", {5: struct.pack(">ff", 0, 0.6)}),
    ("what_is_no_number", {5: struct.pack(">ff", float("nan"), 0)}),
    ("what_is_neither_on_nor_off", {6: b"\2"}),
    ("an_argument_that_it_does_not_have", {7: b"\0"}),
]
for name, other in WITH:
    def ran(w, other=other):
        programmed(w, 3, given=GOOD | other)

    def refused(w, other=other):
        programmed(w, 4, b"\1\5\0" + bytes(4), given=GOOD | other)

    ran.__name__, refused.__name__ = f"{name}_ran", f"{name}_was_refused"
    case(VALUES_RULE, found=RAN, mission=TYPED)(ran)
    case(VALUES_RULE, mission=TYPED)(refused)


@case(VALUES_RULE, mission=TYPED)
def values_of_every_kind(w):
    programmed(w, 3)


@case(VALUES_RULE, mission=TYPED)
def one_that_has_a_default_is_left_out(w):
    programmed(w, 7, given={place: GOOD[place] for place in (5, 4, 3, 2, 1)})


@case(VALUES_RULE, found=RAN, mission=TYPED)
def one_without_a_default_is_left_out(w):
    programmed(w, 7, given={place: GOOD[place] for place in (1, 2, 3, 4, 6)})


@case(VALUES_RULE, found=RAN, mission=TYPED)
def one_is_given_twice(w):
    programmed(w, 7, given=GOOD | {6: b"\1\6\1"}, number=7)


@case(VALUES_RULE, found="its length are not", mission=TYPED)
def what_is_cut_off_in_a_number(w):
    programmed(w, 7, cut=1, given={1: GOOD[1]})


@case(VALUES_RULE, found="its length are not", mission=TYPED)
def what_is_cut_off_in_a_text(w):
    programmed(w, 7, cut=1, given={4: GOOD[4]})


@case(VALUES_RULE, found="its length are not", mission=TYPED)
def what_is_cut_off_before_an_argument(w):
    programmed(w, 7, number=7)


@case(VALUES_RULE, found="its length are not", mission=TYPED)
def what_goes_on_behind_the_last(w):
    programmed(w, 7, number=5)


@case(VALUES_RULE, found="its length are not", mission=TYPED)
def what_ends_behind_the_name(w):
    programmed(w, 7, given={6: b""}, cut=2)


@case(VALUES_RULE, found=REFUSED, mission=TYPED)
def good_values_are_refused(w):
    programmed(w, 4, b"\1\5\0" + bytes(4))


@case(VALUES_RULE, found=REFUSED, mission=TYPED)
def a_good_length_is_refused(w):
    programmed(w, 2, b"\0\x08")


@case(VALUES_RULE, mission=TYPED)
def what_its_author_refuses_has_a_reason(w):
    programmed(w, 4, b"\1\5\xff" + bytes(9) + b"why")


@case(VALUES_RULE, mission=TYPED)
def what_is_refused_for_another_reason(w):
    programmed(w, 2, b"\0\x0d\1")


@case(VALUES_RULE, mission=TYPED)
def who_says_so_is_another(w):
    programmed(w, 4, b"\0\0", given=GOOD | {3: b"\0"})
    w.report(1300 * MS, JOYSTICK, 1, 7, struct.pack(">I", 0x180AC000 | 77))
