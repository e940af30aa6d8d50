# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Invariants on packets: what was asked, permitted, logged and answered."""
import collections, struct

from descriptors import ERROR, OPERATIONAL, POST, SAFE, STATES
from exchange_rules import is_exchanged
from record import meets
from rules import ground_link_works

PING_US = 200_000
FLOODED_PING_US = 500_000
LAST_SECOND_US = 1_000_000
OUTCOME_UNKNOWN = bytes([2, 6])
VALUE_NOT_ACCEPTABLE, DATA_LENGTH = bytes([1, 5]), bytes([0, 8])


def lost_records(records):
    return sum(record.lost for record in records if record.kind == "gap")


def died_with_who_asked(flight, record):
    """What a supervisor asks of itself on its way up nobody else waits for."""
    own = record.source == record.peer == flight.mission.supervisor.apid
    return own and any(record.time <= gone <= record.time + LAST_SECOND_US for gone, _ in flight.absences())


def i2_one_final_report(flight, victims):
    """Each telecommand that was accepted ends in exactly one final report; none that was sent vanishes without a word."""
    finals, starts_failed, reported = collections.Counter(), set(), set()
    for record in flight.log:
        if record.report is None or record.report.service != 1 or len(record.report.data) < 4:
            continue
        key = record.report.request_key
        reported.add(key)
        if record.report.subtype in (2, 7, 8, 10):
            finals[key] += 1
        elif record.report.subtype == 4:
            starts_failed.add(key)
    reported |= {(down[5], down[6]) for down in flight.down if down[3] == 1}
    ended_below = {(down[5], down[6]) for down in flight.down if down[3] == 1 and down[4] in (2, 4, 7, 8, 10)}
    logged, late = set(), min(flight.finished(), flight.end - LAST_SECOND_US)
    for record in flight.log:
        if record.telecommand is None:
            continue
        key = record.telecommand.key
        logged.add(key)
        if record.kind != "telecommand-forwarded" or record.time >= late or died_with_who_asked(flight, record):
            continue
        wants_end = record.telecommand.ack & 8
        if wants_end and not finals[key] and key not in starts_failed and key not in ended_below:
            yield record.time, f"TC[{record.telecommand.service},{record.telecommand.subtype}] {record.telecommand.function or ''} to " \
                               f"{name_of(flight, record.peer)} has no final report"
    yield from given_up(flight, victims)
    # A damaged packet may bear any request id.
    whole = {sent.key for sent in flight.sent} | {r.telecommand.key for r in flight.log if r.kind == "telecommand-forwarded"}
    told_again = ends_told_again(flight)
    for key, number in finals.items():
        if number > 1 + told_again[key] and key in whole:
            yield 0, f"request {key[1]:08x} of source {key[0]} has {number} final reports"
    for sent in flight.sent:
        quiet = sent.origin == "ground" and ground_link_works(flight, victims, sent.time, sent.time + PING_US)
        if quiet and sent.time < late and sent.key not in logged | reported:
            yield sent.time, f"TC[{sent.service},{sent.subtype}] of ground vanished without a word"
            break


def ends_told_again(flight):
    """Of a SAFE_ALL, as a supervisor that goes on says ahead of each (docs/adr/0243): how often, by source and request."""
    mark = next((id for id, (name, _) in flight.mission.supervisor.events.items() if name == "END_TOLD_AGAIN"), None)
    said = [r.report.data for r in flight.log if r.kind == "event" and r.report is not None and r.source == flight.mission.supervisor.apid]
    return collections.Counter((int.from_bytes(data[6:8], "big"), int.from_bytes(data[2:6], "big"))
                               for data in said if len(data) >= 8 and int.from_bytes(data[:2], "big") == mark)


def given_up(flight, victims):
    """The supervisor ends a telecommand in the place of who is gone, or of one whose report may have gone with a supervisor, and of nobody else."""
    forwarded = {r.telecommand.key: r for r in flight.log if r.kind == "telecommand-forwarded" and r.telecommand}
    for record in flight.log:
        said = record.report
        if said is None or (said.apid, said.service, said.subtype) != (flight.mission.supervisor.apid, 1, 8):
            continue
        if said.data[4:6] != OUTCOME_UNKNOWN or said.request_key not in forwarded:
            continue
        asked = forwarded[said.request_key]
        name = name_of(flight, asked.peer)
        # Whoever shuts the craft down ends what was on its way just then, or comes meanwhile; what was asked long before had its end.
        on_its_way = flight.finished() <= min(record.time, asked.time + LAST_SECOND_US)
        gone = victims[name] + victims["SUCCESSION"]
        exchanged = asked.peer != flight.mission.supervisor.apid and is_exchanged(flight, name, record.time)
        if not on_its_way and not exchanged and not meets(gone, asked.time - LAST_SECOND_US, record.time):
            yield record.time, f"TC[{asked.telecommand.service},{asked.telecommand.subtype}] to {name} was given up though nothing was done to it"


def unstored_from(flight):
    """When the disk stopped taking what came until the end of the flight: whoever ends it then has that on ground only."""
    last = next((d for d in reversed(flight.did) if d[1][0] == "log"), None)
    return last[0] if last and last[1][1] in ("failing", "full", "slow") and flight.mark("calm") is None else flight.end + 1


def i3_everything_is_logged_once(flight, victims):
    numbers, packets, received = set(), set(), collections.Counter()
    for record in flight.log:
        if record.number in numbers:
            yield record.time, f"record number {record.number} stands twice"
        numbers.add(record.number)
        if record.report is not None:
            if record.packet in packets:
                yield record.time, f"a packet of {name_of(flight, record.source)} stands twice"
            packets.add(record.packet)
        if record.kind == "telecommand-received":
            received[record.telecommand.key] += 1
    last = max(numbers, default=0)
    for records in (flight.log, flight.standing):
        kept, lost = sum(record.kind != "gap" for record in records), lost_records(records)
        if kept + lost != last:
            yield flight.end, f"{kept} records and {lost} lost are not the {last} that were numbered"
    for key, number in received.items():
        if number > 1:
            yield 0, f"request {key[1]:08x} of source {key[0]} was received {number} times"
    in_log = {(r.report.apid, r.report.count) for r in flight.log if r.report is not None}
    unstored = unstored_from(flight)
    # What comes down again stands there already (adr 0140).
    missing = [down for down in flight.down if (down[1], down[2]) not in in_log and down[0] < unstored and down[3:5] != (129, 12)]
    if len(missing) > lost_records(flight.log):
        time, apid, count = missing[0][:3]
        yield time, f"{len(missing)} reports came to ground and are not in the log, the first {name_of(flight, apid)} {count}"
    accepted = {(down[5], down[6]) for down in flight.down if down[3] == 1 and down[4] == 1 and down[5] == 0 and down[0] < unstored}
    for key in accepted:
        if received[key] == 0:
            yield 0, f"request {key[1]:08x} was acknowledged and is not in the log"


def i6_ping_is_answered(flight, victims):
    answers = {}
    for down in flight.down:
        if down[3] == 1 and down[4] in (2, 4, 7, 8) and down[5] == 0:
            answers.setdefault(down[6], down[0])
    for sent in flight.sent:
        if sent.service != 17 or sent.subtype != 1 or sent.apid != flight.mission.supervisor.apid or sent.origin != "ground":
            continue
        if not sent.ack & 8:  # the end was not asked for
            continue
        limit = FLOODED_PING_US if meets(victims["FLOOD"], sent.time, sent.time) else PING_US
        if sent.time + limit >= flight.finished() or not ground_link_works(flight, victims, sent.time, sent.time + limit):
            continue
        if answers.get(sent.key[1], flight.end) > sent.time + limit:
            yield sent.time, f"a ping of ground to the supervisor was not answered within {limit // 1000} ms"
            break


def i8_nothing_unauthorised(flight, victims):
    mode = flight.mode()
    origin = {}
    for record in flight.log:
        if record.kind == "telecommand-received" and record.telecommand:
            origin.setdefault(record.telecommand.key, (record.source, record.time))
    for record in flight.log:
        if record.kind != "telecommand-forwarded" or record.telecommand is None:
            continue
        source, time = origin.get(record.telecommand.key, (record.telecommand.source, record.time))
        modes = mode.during(time - 1_000, time + 1_000)
        name = name_of(flight, record.peer)
        lag_us = 12_000
        states = flight.state[name].during(time - lag_us, record.time + lag_us) if name in flight.state else [OPERATIONAL]
        if not any(permitted(flight.mission, record, source, m, s) for m in modes for s in states):
            tc = record.telecommand
            yield record.time, (f"TC[{tc.service},{tc.subtype}] {tc.function or ''} {tc.first_argument if tc.first_argument is not None else ''}"
                                f" of {name_of(flight, source)} to {name} ran in mode {modes[-1]}, {STATES[states[-1]]}")


def i8_what_its_descriptor_permits(flight, _):
    """A function runs with arguments that its descriptor permits and no others, and is refused for none that it permits."""
    calls = collections.defaultdict(list)
    for record in flight.log:
        if record.kind == "telecommand-forwarded" and record.telecommand:
            calls[record.telecommand.key].append(record)
    for record in flight.log:
        said = record.report
        if said is None or said.service != 1 or len(said.data) < 4 or len(calls[said.request_key]) != 1:
            continue
        (call,) = calls[said.request_key]
        addressee = flight.mission.by_apid(call.telecommand.apid)
        function = addressee.functions.get(call.telecommand.function) if addressee is not None else None
        if function is None or said.apid != addressee.apid:
            continue
        why = function.refusal(call.telecommand.data)
        if why is not None and said.subtype in (3, 5, 7):
            yield record.time, f"{function.name} of {addressee.name} ran, though its {why} are not as its descriptor says"
        # What its author refuses has the author's reason behind the code.
        code, behind = said.data[4:6], said.data[6:]
        by_values = said.subtype == 4 and code == VALUE_NOT_ACCEPTABLE and len(behind) == 5
        if why is None and (by_values or (said.subtype == 2 and code == DATA_LENGTH)):
            yield record.time, f"{function.name} of {addressee.name} was refused, though its arguments are as its descriptor says"


def permitted(mission, record, source, mode, state):
    """May this source send this in that mode to an addressee in that state? Own words of the mission's rules."""
    tc, own = record.telecommand, source == mission.supervisor.apid
    addressee = mission.by_apid(tc.apid)
    if addressee is None or (tc.source == mission.supervisor.apid) != own:
        return False
    if tc.service in (17, 129):
        return True
    if own or tc.service == 128:
        return own
    function = addressee.functions.get(tc.function)
    is_state = tc.function in ("SET_STATE", "CONFIGURE")
    if is_state and addressee is mission.supervisor:
        return False
    if tc.function == "SET_STATE" and (tc.first_argument in (ERROR, POST) or (tc.first_argument == SAFE and state == OPERATIONAL)):
        return True
    if tc.function is not None and function is None and not is_state:
        return True  # nobody has it: the addressee says so
    sender = mission.by_apid(source) if source else None
    if sender is not None and addressee is mission.supervisor and tc.service == 8 and tc.function not in ("ENTER_MODE", "SAFE_ALL", "SET_MODE"):
        return False
    if function is not None and function.essential:
        return True
    for subject, functions, services, parameters, senders in mission.modes[mode]:
        if subject not in ("*", addressee.name) or not is_for(mission, senders, sender, addressee):
            continue
        writes = tc.service == 20 and tc.subtype == 3
        if str(tc.service) in services or (tc.service == 8 and functions & {"*", tc.function}) or (writes and parameters):
            if writes and not may_write(mission, addressee, tc, mode, state, sender):
                continue
            if function is None or state in function.states:
                return True
    return False


def is_for(mission, senders, sender, addressee):
    """Whether a permit is for this sender, None is the ground; what names nobody is for all, but of the supervisor for the ground alone."""
    if senders:
        return ("ground" if sender is None else sender.name) in senders
    return sender is None or addressee is not mission.supervisor


def may_write(mission, addressee, tc, mode, state, sender):
    """Of TC[20,3]."""
    declared = {p.wire_id: p for s in [mission.supervisor, *mission.members] for p in s.parameters}
    names = set().union(*(parameters for subject, _, _, parameters, senders in mission.modes[mode]
                          if subject in ("*", addressee.name) and is_for(mission, senders, sender, addressee)))
    known = [declared[i] for i in written(tc, declared) if i in declared]
    return all(p.writable is not None and state in p.writable and names & {"*", p.name} for p in known)


def written(tc, declared):
    """Ids of the parameters that TC[20,3] sets; what cannot be read is the addressee's to refuse."""
    data, ids = tc.data, []
    if not data:
        return ids
    number, at = data[0], 1
    for _ in range(number):
        if at + 4 > len(data):
            break
        wire_id = struct.unpack(">I", data[at:at + 4])[0]
        if wire_id not in declared:
            break
        ids.append(wire_id)
        at += 4 + sum(f.stored_octets() for f in declared[wire_id].fields)
    return ids


def kind_of(report):
    """Answers, events and housekeeping: between kinds the order may change while the supervisor is behind (adr 0022)."""
    if report.service == 3 and report.subtype == 25:
        return "housekeeping"
    return "event" if report.service == 5 and report.subtype <= 4 else "answer"


def i11_nothing_goes_back(flight, victims):
    newest, before, times, stored, monotonic = {}, {}, {}, 0, -10**9
    for record in flight.log:
        if record.kind == "gap":  # half the range of a count, or more, may lie in it
            newest.clear(), before.clear()
        elif record.time < monotonic or record.stored < stored:
            yield record.time, "the times of the log go back"
        monotonic, stored = max(record.time, monotonic), max(record.stored, stored)
        if record.report is None:
            continue
        apid, kind = record.report.apid, kind_of(record.report)
        key, last = (apid, kind), newest.get(apid, record.report.count)
        count = last + (record.report.count - last + 8192) % 16384 - 8192  # counts without their modulo
        if count <= before.get(key, -16384):
            yield record.time, f"sequence count of {name_of(flight, apid)} goes from {before[key]} to {count} ({kind})"
        if record.report.time < times.get(key, 0):
            yield record.time, f"times of {name_of(flight, apid)} go back ({kind})"
        newest[apid], before[key], times[key] = max(last, count), count, max(record.report.time, times.get(key, 0))


def name_of(flight, apid):
    subsystem = flight.mission.by_apid(apid)
    return subsystem.name if subsystem else "ground" if apid == 0 else f"APID {apid}"


PACKETS = {"I2": [i2_one_final_report], "I3": [i3_everything_is_logged_once], "I6": [i6_ping_is_answered],
           "I8": [i8_nothing_unauthorised, i8_what_its_descriptor_permits], "I11": [i11_nothing_goes_back]}
