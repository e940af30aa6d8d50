# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I8: what may run in which mode and state (judge/packet_rules.py)."""
import struct

from judge_cases import case
from judge_flight import JOYSTICK, MISSION, MS, ROBOT, S, SUPERVISOR, call
from descriptors import ERROR, OPERATIONAL, PRE, SAFE

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
