# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The supervisor dies or hangs, and another one goes on (docs/adr/0093, 0183): what runs runs on, what nobody has looked after for too long is
safe, and no telecommand is lost."""
from descriptors import OPERATIONAL
from packet_rules import name_of
from record import meets
from rules import CYCLES_TO_SAFE, SAFE_ALL_US, STATE_LAG_US, released_after

BACK_US = 1_000_000        # from the next supervisor's first moment: by then it has what runs, and answers
ON_ITS_WAY_US = 200_000    # what was said so shortly before a death may not have had its end
ALONE_US = 900_000         # in which nothing was done, so that nothing is under way
SILENCE_US = 2_000_000     # longer than that a subsystem does not go on without a supervisor
HEALED_US = 1_000_000      # what waited for the log stands there by then
WITHDRAWN_US = 60_000      # the enable of a device that nobody tells any more
FRAMEWORK, DEVICE_LOST, STALE = 0xF000, 0xF100, 0xF200  # events: from here on those that are not of a descriptor


def losses(flight):
    """[(from, to)]: absences, those in one that follow each other too fast for anybody to have settled."""
    found = []
    for gone, back in flight.absences():
        if found and gone - found[-1][1] < BACK_US:
            found[-1] = (found[-1][0], back)
        else:
            found.append((gone, back))
    return [(gone, back) for gone, back in found if back + BACK_US < min(flight.finished(), flight.mark("calm") or flight.end)]


def left_alone(flight, victims, start, end):
    """Nothing else was done to anybody but the log, on which nobody waits to go on, nobody was told anything, and nothing of what was before was
    under way."""
    supervisor = flight.mission.supervisor.name
    done = any(start <= time <= end for time, words in flight.did if words[1:2] != [supervisor])
    told = any(start <= sent.time <= end and sent.service != 17 for sent in flight.sent)
    struck = any(meets(spans, start, end) for name, spans in victims.items() if name not in ("SUCCESSION", "LOG"))
    acts = any(record.kind == "action" and start <= record.time <= end and not before_itself(record, flight, start) for record in flight.log)
    return not (done or told or struck or acts)


def before_itself(record, flight, start):
    """What the next supervisor does itself is what is judged; what the one before was at is an excuse."""
    of_before = record.note.startswith("the change to mode ") or "the supervisor died in the midst of " in record.note
    return record.time >= min(gone for gone, _ in flight.absences() if gone >= start) and not of_before


def had_a_reason(flight, start, end):
    """A member told of something that happened to itself or to its device; that a set is stale may come of the death."""
    for record in flight.log:
        if record.kind != "event" or record.report is None or not start <= record.time <= end or record.report.subtype < 2:
            continue
        event = int.from_bytes(record.report.data[:2], "big")
        if record.source != flight.mission.supervisor.apid and (event < FRAMEWORK or DEVICE_LOST <= event < STALE):
            return True
    return False


def i15_what_runs_is_gone_on_with(flight, victims):
    """Who was Operational and free to act stays so, and each link stays up."""
    for gone, back in losses(flight):
        start, end = gone - ALONE_US, back + BACK_US
        if start < 0 or back - gone > SILENCE_US - BACK_US // 2 or not left_alone(flight, victims, start, end) or had_a_reason(flight, start, end):
            continue
        for name in flight.members:
            if set(flight.state[name].during(start, gone)) != {OPERATIONAL} or any(flight.inhibited[name].during(start, gone)):
                continue
            if set(flight.state[name].during(gone, end)) != {OPERATIONAL} or any(flight.inhibited[name].during(gone, end)):
                yield gone, f"{name} does not go on as the supervisor is lost for {(back - gone) // 1000} ms, and nothing else happens"
        up = frozenset.intersection(*flight.links.during(start, gone))
        for link in sorted(up - frozenset.intersection(*flight.links.during(gone, end))):
            yield gone, f"link {link} does not go on as the supervisor is lost for {(back - gone) // 1000} ms, and nothing else happens"


def i16_nobody_moves_without_a_supervisor_for_long(flight, victims):
    """Longer than a subsystem goes on by itself; and who has stopped for that waits until somebody lets it go."""
    acting = [(device, member) for device, (member, name) in flight.mission.devices.items() if name in flight.mission.by_name(member).actuators]
    for gone, back in flight.absences():
        for device, member in acting:
            late = gone + SILENCE_US + WITHDRAWN_US + STATE_LAG_US + CYCLES_TO_SAFE * flight.period_ns[member].at(gone) // 1000
            until = min(released_after(flight, gone, member), default=flight.end)
            for start, end in flight.active[device].spans(flight.end):
                if late < back and max(start, late) < min(end, until):
                    yield max(start, late), f"{device} acts {(max(start, late) - gone) // 1000} ms after the supervisor was lost, which was for longer than it may"
                    break


def i17_a_stop_is_carried_out(flight, victims):
    """A SAFE_ALL of ground that came as the supervisor was lost, or while none was there."""
    supervisor = flight.mission.supervisor.apid
    for gone, back in losses(flight):
        for sent in flight.sent:
            if sent.function != "SAFE_ALL" or sent.apid != supervisor or not asked_meanwhile(flight, victims, sent, gone, back):
                continue
            at = back + SAFE_ALL_US + STATE_LAG_US
            for device, (member, _) in flight.mission.devices.items():
                until = min(released_after(flight, sent.time, member), default=flight.end)
                if any(max(start, at) < min(end, until) for start, end in flight.active[device].spans(flight.end)):
                    yield sent.time, f"{device} acts on though SAFE_ALL came as the supervisor was lost"


def log_in_trouble(flight, start, end):
    """What came then may stand nowhere, or late: until the log is healed, and what was deleted later."""
    begun = None
    for time, words in flight.did:
        if words[0] != "log":
            continue
        if words[1] == "deleted" and time >= start:
            return True
        if words[1] != "heal":
            begun = time if begun is None else begun
        elif begun is not None:
            if begun <= end and start <= time + HEALED_US:
                return True
            begun = None
    return begun is not None and begun <= end


def asked_meanwhile(flight, victims, sent, gone, back):
    """By ground, as the supervisor was lost or while none was there, over a ground link that nothing was done to."""
    ground, end = flight.mission.ground, back + BACK_US
    return (sent.origin == "ground" and gone - ON_ITS_WAY_US <= sent.time <= back and
            all(state == OPERATIONAL for state in flight.state[ground].during(sent.time, end)) and
            not any(meets(victims[name], sent.time - 100_000, end) for name in (ground, "SUPERVISOR", "FLOOD")) and
            not log_in_trouble(flight, sent.time - 100_000, end))


def i17_no_telecommand_is_lost(flight, victims):
    """What ground said as the supervisor was lost is read, goes on or is refused, and a ping is answered as soon as another one is there."""
    known = {r.telecommand.key for r in flight.log if r.telecommand}
    decided = {r.telecommand.key for r in flight.log if r.telecommand and r.kind != "telecommand-received"}
    answered = {}
    for record in flight.log:
        if record.report is not None and record.report.service == 1 and len(record.report.data) >= 4:
            known.add(record.report.request_key)
            if record.report.subtype in (2, 4, 7, 8):
                answered.setdefault(record.report.request_key, record.time)
    for gone, back in losses(flight):
        for sent in flight.sent:
            if not asked_meanwhile(flight, victims, sent, gone, back):
                continue
            what = f"TC[{sent.service},{sent.subtype}] of ground to {name_of(flight, sent.apid)}"
            is_ping = (sent.service, sent.subtype, sent.apid) == (17, 1, flight.mission.supervisor.apid) and sent.ack & 8
            if sent.key not in known:
                yield sent.time, f"{what} is lost with the supervisor"
            elif sent.ack & 8 and sent.key not in decided | answered.keys():
                yield sent.time, f"{what} was read, and nobody has it any more"
            elif is_ping and answered.get(sent.key, flight.end) > back + BACK_US:
                yield sent.time, f"{what} was not answered within {BACK_US // 1000} ms of the next supervisor"


SUCCESSIONS = {"I15": [i15_what_runs_is_gone_on_with], "I16": [i16_nobody_moves_without_a_supervisor_for_long],
               "I17": [i17_a_stop_is_carried_out, i17_no_telecommand_is_lost]}
