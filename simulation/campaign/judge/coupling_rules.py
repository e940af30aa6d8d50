# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What becomes of real-time links: who has lost a set that it needs does what the mission says of that link (docs/adr/0077), and a queue loses nothing
without counting it (docs/adr/0072)."""
import struct

from descriptors import FORMATS, OFFLINE, OPERATIONAL
from record import meets
from rules import CYCLES_TO_SAFE, OFFLINE_US, STATE_LAG_US, taken_down_with

BEFORE_US = 900_000        # in which nothing was done, so that nothing is under way
FALLEN_US = 2_000_000      # by way of Pre-Operational into the other configuration, and on
GOES_ON_US = 2_000_000     # for which it is looked at
COUNTED = ("UNCOUNTED", "TORN")  # what an author finds wrong of a queue: parts of a structure that it reports


def left_alone(flight, victims, consumer, start, end, but):
    """Nothing but that was done or asked for, and somebody supervised."""
    done = any(start <= time <= end and (time, words) != but and words[0] not in ("log", "tc", "raw") for time, words in flight.did)
    told = any(start <= sent.time <= end and sent.service != 17 for sent in flight.sent)
    struck = any(meets(victims[name], start, end) for name in (consumer, "SUPERVISOR", "SUCCESSION", "FLOOD"))
    return not (done or told or struck) and end < min(flight.finished(), flight.mark("calm") or flight.end)


def consumers_of(flight, producer, time):
    """(link, consumer, what it required) of those in Operational that are spared as the producer dies."""
    gone = taken_down_with(flight, producer, time - 1)
    for link in sorted(flight.links.at(time - 1)):
        source, consumer, name = flight.mission.links[link]
        if source != producer or consumer in gone or set(flight.state[consumer].during(time - BEFORE_US, time)) != {OPERATIONAL}:
            continue
        if any(flight.inhibited[consumer].during(time - BEFORE_US, time)):
            continue
        configuration = flight.mission.by_name(consumer).configurations.get(flight.configuration[consumer].at(time))
        wanted = next((each for each in configuration.requires if each.name == name and each.required), None) if configuration else None
        if wanted is not None:
            yield link, consumer, wanted


def i18_who_loses_a_set_does_what_the_mission_says(flight, victims):
    for time, words in flight.did:
        if words[0] != "kill" or words[1] not in flight.members:
            continue
        for link, consumer, wanted in consumers_of(flight, words[1], time):
            word, hold_us, fallback = flight.mission.losses[link]
            end = time + {"ignore": GOES_ON_US, "fallback": FALLEN_US, "hold": hold_us + OFFLINE_US}[word]
            if not left_alone(flight, victims, consumer, time - BEFORE_US, end, (time, words)):
                continue
            if word == "fallback":
                wrong = falls_back(flight, consumer, wanted, fallback, time, end)
            elif word == "ignore":
                wrong = "" if goes_on(flight, consumer, time, end) else "does not go on"
            else:
                wrong = holds(flight, link, consumer, time, time + hold_us, end)
            if wrong:
                yield time, f"{consumer} has lost {wanted.name} of {words[1]} ({word}), and {wrong}"


def goes_on(flight, name, start, end):
    return set(flight.state[name].during(start, end)) == {OPERATIONAL} and not any(flight.inhibited[name].during(start, end))


def holds(flight, link, consumer, start, until, end):
    """For its time; then it has the set again, or goes down."""
    if not goes_on(flight, consumer, start, until - STATE_LAG_US):
        return "does not hold on for its time"
    if link in flight.links.at(until):
        return "" if goes_on(flight, consumer, start, end) else "goes down though the set is back"
    back = any(link in up for up in flight.links.during(start, until))
    return "" if back or OFFLINE in flight.state[consumer].during(until - STATE_LAG_US, end) else "holds on for longer"


def falls_back(flight, consumer, wanted, fallback, start, end):
    """It never acts with what is lost, and is in the other configuration by then, in the state that it had."""
    member = flight.mission.by_name(consumer)
    lost = flight.configuration[consumer].at(start)
    late = start + STATE_LAG_US + (wanted.age + CYCLES_TO_SAFE) * flight.period_ns[consumer].at(start) // 1000
    for device, (owner, _) in flight.mission.devices.items():
        for first, last in flight.active[device].spans(flight.end) if owner == consumer else ():
            first, last = max(first, late), min(last, end)
            if first < last and flight.configuration[consumer].at(first) == lost:
                return f"{device} acts on in the configuration that waits for it"
    there = member.configurations.get(flight.configuration[consumer].at(end))
    if there is None or there.name != fallback or flight.state[consumer].at(end) != OPERATIONAL:
        return f"is not Operational in {fallback} after {FALLEN_US // 1000} ms"
    return ""


def i19_a_queue_counts_what_it_loses(flight, _):
    """By what an author says that reads it: what it took and what the link says that it lost are all there was, and each sample is whole."""
    for record in flight.log:
        member = flight.mission.by_apid(record.source)
        if record.report is None or (record.report.service, record.report.subtype) != (3, 25) or member is None:
            continue
        for name, value in reported(member, record.report.data):
            if name in COUNTED and value:
                yield record.time, f"{member.name} tells of {value} {name}"
                return


def reported(member, data):
    """(name, value) of each number in a housekeeping report of a structure that its descriptor has."""
    identity, at = int.from_bytes(data[:2], "big"), 2
    names = next((c.structures[identity] for c in member.configurations.values() if identity in c.structures), [])
    fields = {parameter.name: parameter.fields for parameter in member.parameters}
    for field in [field for name in names for field in fields.get(name, [])]:
        form = f">{field.count}{FORMATS[field.type]}" if field.type in FORMATS else None
        if form is None or at + struct.calcsize(form) > len(data):
            return
        values = struct.unpack_from(form, data, at)
        at += struct.calcsize(form)
        yield field.name, values[0]


COUPLINGS = {"I18": [i18_who_loses_a_set_does_what_the_mission_says], "I19": [i19_a_queue_counts_what_it_loses]}
