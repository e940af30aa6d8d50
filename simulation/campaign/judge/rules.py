# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Invariants on what happened in the world: who died, what moved, which states and links there were, how time passed."""
from descriptors import EDGES, ERROR, OFFLINE, OPERATIONAL, STATES, reachable_unseen
from exchange_rules import is_exchanged
from record import AFTERMATH_US, meets

CYCLES_TO_SAFE = 5             # actuators of a network, in cycles of whoever acts
WATCHDOG_US = 2_000            # beyond what is declared, and two periods: of the device itself, when its member says nothing any more
# A device's world is ahead of the craft by less than a cycle, and behind by less than two where no command comes any more (WorldClock):
# a span that begins with one and ends with the other misses less than three.
DEVICE_CYCLES = 3
STATE_LAG_US = 12_000          # the vital page tells a state by the service loop, every 1 or 10 ms
SAFE_ALL_US = 500_000
STOP_BEGINS_US = 30_000        # from a stop that is asked for to the devices: a step of the supervisor where it takes that, and one of the guard
# The longest declared stop and the time to answer (450 ms), who has not stopped is ended then, and 500 ms after that.
SAFE_ALL_ENDS_US = 950_000
OFFLINE_US = 2_000_000
SERVICE_HANG_US = 3_100_000    # a service loop that stands still is found after 3 s


def i1_only_victims_die(flight, victims):
    for name in flight.members:
        for time, value in list(zip(flight.alive[name].times, flight.alive[name].values))[1:]:
            if value or time >= flight.finished():
                continue
            if not any(start <= time for start, _ in victims[name]) and not is_exchanged(flight, name, time):
                yield time, f"{name} died though nothing was done to it"


def watchdog_us(flight, name, time):
    """Of the devices of its configuration, the longest."""
    configuration = flight.mission.by_name(name).configurations.get(flight.configuration[name].at(time))
    return WATCHDOG_US + 1000 * max([milliseconds for _, milliseconds, _ in configuration.devices] if configuration else [], default=10)


def i4_actuators_are_off_outside_operational(flight, victims):
    for device, (member, _) in flight.mission.devices.items():
        for start, end in flight.active[device].spans(flight.end):
            period_us = max(flight.period_ns[member].at(start) // 1000, flight.device_period_ns[device] // 1000)
            late = STATE_LAG_US + CYCLES_TO_SAFE * period_us
            for first, last in flight.state[member].spans(flight.end, lambda state: state != OPERATIONAL):
                first, last = max(first + late, start + STATE_LAG_US), min(last, end)
                if last - first > STATE_LAG_US:
                    yield first, f"{device} acts while {member} is {STATES[flight.state[member].at(first)]}"
            for name in (member, device):
                for first, last in victims[name]:
                    longest = watchdog_us(flight, member, first) + 2 * period_us
                    if flight.alive[member].at(first + 1) == 0 and end > first + longest and start < first:
                        yield first, f"{device} acts {(end - first) // 1000} ms after the death of {member}"


def i4_safe_all_stops_everything(flight, victims):
    supervisor = flight.mission.supervisor
    for sent in flight.sent:
        if sent.function != "SAFE_ALL" or sent.apid != supervisor.apid or sent.origin != "ground":
            continue
        if not ground_link_works(flight, victims, sent.time, sent.time + SAFE_ALL_US) or flight.finished() <= sent.time:
            continue
        # Either way it ends with a report: all have stopped, or who has not.
        done = next((r.time for r in flight.log if r.report and r.report.service == 1 and r.report.subtype in (7, 8)
                     and r.report.request_key == sent.key), None)
        if done is None:  # not in a log that had no room: ground has it all the same
            done = next((d[0] for d in flight.down if d[3] == 1 and d[4] in (7, 8) and (d[5], d[6]) == sent.key), None)
        refused = any(r.kind == "telecommand-refused" and r.telecommand and r.telecommand.key == sent.key for r in flight.log)
        wanted = sent.ack & 8 or refused  # else nobody asked for its report
        if wanted and (done is None or done > sent.time + SAFE_ALL_ENDS_US):
            yield sent.time, "SAFE_ALL was " + ("refused" if refused else "not answered in its time")
        at = min(done or sent.time + SAFE_ALL_US, sent.time + SAFE_ALL_US)
        for device, (member, _) in flight.mission.devices.items():
            released = released_after(flight, sent.time, member)
            until = min(released, default=flight.end)
            for start, end in flight.active[device].spans(flight.end):
                if end > at + STATE_LAG_US and start < until and end > start and max(start, at + STATE_LAG_US) < min(end, until):
                    yield sent.time, f"{device} acts {(max(start, at) - sent.time) // 1000} ms after SAFE_ALL"
                    break


def released_after(flight, time, member):
    """When what was asked after this time let the member go again. What was asked before it and comes late does not count,
    nor what was asked after it and refused; where the log has gaps, whatever might have been it does."""
    apid = flight.mission.by_name(member).apid
    asked = {s.key for s in flight.sent if s.time >= time}
    asked |= {r.telecommand.key for r in flight.log if r.time >= time and r.kind == "telecommand-received" and r.telecommand
              and r.source == flight.mission.supervisor.apid}
    released = [r.time for r in flight.log if r.time >= time and r.kind == "telecommand-forwarded" and r.peer == apid
                and r.telecommand.function == "SET_STATE" and r.telecommand.first_argument == OPERATIONAL and r.telecommand.key in asked]
    if any(r.kind == "gap" for r in flight.log):
        released += [s.time for s in flight.sent if s.time >= time and s.function == "SET_STATE" and s.apid == apid]
    return released


def ground_link_works(flight, victims, start, end):
    ground = flight.mission.ground
    return (all(state == OPERATIONAL for state in flight.state[ground].during(start, end)) and
            not meets(victims[ground] + unattended(victims), start - 100_000, end))


def unattended(victims):
    """While the supervisor is stopped, dead or hangs."""
    return victims["SUPERVISOR"] + victims["SUCCESSION"]


def taken_down_with(flight, struck, time):
    """Whom links join to it at this instant. A consumer goes on where each of its links from who goes down says so (docs/adr/0077)."""
    up = [(*flight.mission.links[link][:2], flight.mission.losses[link][0]) for link in flight.links.at(time)]
    found = [struck]
    for lost in found:
        for producer, consumer, _ in up:
            other = consumer if producer == lost else producer if consumer == lost else lost
            words = {word for source, to, word in up if (source, to) == (lost, other)}
            if other not in found and (not words or "down" in words):
                found.append(other)
    return set(found)


def was_too_short(flight, name, device, time):
    """It was plugged again before its member could miss it, which takes as many of its cycles as its descriptor says."""
    again = next((at for at, words in flight.did if at >= time and words == ["fault", device, "plug"]), flight.end)
    configuration = flight.mission.by_name(name).configurations.get(flight.configuration[name].at(time))
    cycles = max([silence for _, _, silence in configuration.devices] if configuration else [], default=3)
    return again - time <= (cycles + 2) * flight.period_ns[name].at(time) // 1000


def told_at(flight, name, time):
    """When the others can hear of what its cycle has seen: at once, or when its service loop goes on or is found to stand still."""
    stuck = None
    for at, words in flight.did:
        if words == ["stick", name] and at <= time:
            stuck = at
        elif words in (["unstick", name], ["kill", name]) and stuck is not None:
            if at > time:
                return min(at, max(time, stuck + SERVICE_HANG_US))
            stuck = None
    return time if stuck is None else max(time, stuck + SERVICE_HANG_US)


def i4_a_network_goes_down_with_its_member(flight, victims):
    """Death, hang or unplugged device of a member: the others of its network are Offline within two seconds."""
    for time, words in flight.did:
        if words[0] == "kill" or (words[0] == "fault" and words[2] == "unplug"):
            struck = flight.mission.devices[words[1]][0] if words[0] == "fault" else words[1]
        else:
            continue
        if struck == flight.mission.supervisor.name:
            continue
        if words[0] == "fault" and (flight.state[struck].at(time) != OPERATIONAL or "shut_down_network" not in flight.mission.high_plan):
            continue
        if words[0] == "fault" and was_too_short(flight, struck, words[1], time):
            continue
        group = taken_down_with(flight, struck, time - 1)
        until = (told_at(flight, struck, time) if words[0] == "fault" else time) + OFFLINE_US
        if until > min(flight.finished(), flight.mark("calm") or flight.end):
            continue
        if meets(unattended(victims), time - OFFLINE_US, until):
            continue
        for name in group - {struck, flight.mission.ground}:
            if meets(victims[name], time - 1, until):
                continue
            if OFFLINE not in flight.state[name].during(time, until):
                yield time, (f"{name} is not Offline 2 s after {' '.join(words)}, but "
                             f"{STATES[flight.state[name].at(time + OFFLINE_US)]}")


def i4_who_begins_is_let_go(flight, victims):
    """An actuator that reboots while its member is Operational and nothing inhibits that is told Active first: it does nothing until it has
    been told something else."""
    for time, words in flight.did:
        if words[0] != "fault" or words[2] != "reboot":
            continue
        device, (member, name) = words[1], flight.mission.devices[words[1]]
        if name not in flight.mission.by_name(member).actuators or not flight.active[device].at(time - 1):
            continue
        commands = ((flight.state[member], lambda value: value == OPERATIONAL), (flight.inhibited[member], lambda value: not value),
                    (flight.alive[member], lambda value: value))
        if not all(holds(series.at(time)) for series, holds in commands):
            continue
        until = min([at for series, holds in commands for at, value in zip(series.times, series.values) if at > time and not holds(value)],
                    default=flight.end)
        for start, end in flight.active[device].spans(flight.end):
            if max(start, time + STATE_LAG_US) < min(end, until):
                yield time, f"{device} acts {(max(start, time) - time) // 1000} ms after it rebooted, though {member} has told it nothing else"


def i4_a_stop_stays(flight, victims):
    """Behind a stop nobody acts before ground has said so after it: a state for that member, or a mode."""
    asked = [(time, 0) for time, words in flight.did if words == ["safe"]]
    answered = {(down[5], down[6]) for down in flight.down if down[3] == 1 and down[4] == 7 and len(down) > 6}
    answered |= {r.report.request_key for r in flight.log if r.report and (r.report.service, r.report.subtype) == (1, 7)}
    asked += [(sent.time, AFTERMATH_US) for sent in flight.sent if sent.function == "SAFE_ALL" and sent.key in answered]
    # What nobody was there to carry out the next supervisor does, and what it has to read as soon as it listens.
    stops = [(time, max([time, *(back + listens for gone, back in flight.absences() if gone - STOP_BEGINS_US <= time <= back)]))
             for time, listens in asked]
    arguments = {r.telecommand.key: r.telecommand.first_argument for r in flight.log if r.telecommand}
    leaves = {name: [] for name in flight.members}
    for sent in flight.sent:
        addressee = flight.mission.by_apid(sent.apid)
        # What the log has not kept may have been one.
        if sent.function == "SET_STATE" and addressee is not None and addressee.name in leaves \
                and arguments.get(sent.key, OPERATIONAL) == OPERATIONAL:
            leaves[addressee.name].append(sent.time)
        elif sent.function == "SET_MODE":
            for times in leaves.values():
                times.append(sent.time)
    acting = [(device, member) for device, (member, name) in flight.mission.devices.items() if name in flight.mission.by_name(member).actuators]
    for device, member in acting:
        for start, _ in flight.active[device].spans(flight.end):
            stopped = max((time for time, read in stops if read + STOP_BEGINS_US < start), default=None)
            if stopped is not None and not any(stopped <= time <= start for time in leaves[member]):
                yield start, f"{device} acts again {(start - stopped) // 1000} ms after a stop, and nobody has let {member} go"


def i5_no_stale_sample_is_used(flight, victims):
    for member in flight.mission.members:
        devices = [device for device, (owner, _) in flight.mission.devices.items() if owner == member.name]
        for device in devices:
            for start, end in flight.active[device].spans(flight.end):
                configuration = member.configurations.get(flight.configuration[member.name].at(start + 1))
                for wanted in configuration.requires if configuration else []:
                    if not wanted.inhibits or wanted.source not in flight.still:
                        continue
                    period_us = max(flight.period_ns[member.name].at(start), flight.period_ns[wanted.source].at(start)) // 1000
                    limit_us = (wanted.age + CYCLES_TO_SAFE) * period_us
                    for first, last in flight.still[wanted.source].spans(flight.end):
                        stale = max(start, first) + limit_us
                        # Who stands still itself notices nothing: then its device lets go.
                        stood = [begun for begun, ended in flight.still[member.name].spans(flight.end) if begun <= stale and first <= ended]
                        stale = max([stale] + [begun + watchdog_us(flight, member.name, begun) + 2 * period_us for begun in stood])
                        if stale < min(end, last) and not meets(victims[member.name], first, stale):
                            yield stale, f"{device} acts on samples of {wanted.source}, which stands still since {first / 1e6:.4f}"


def i9_only_edges_of_the_table(flight, _):
    for name in flight.members:
        previous = OFFLINE
        states, alive = flight.state[name], flight.alive[name]
        for time, state in zip(states.times[1:], states.values[1:]):
            if not alive.at(time):
                previous = OFFLINE
                continue
            if state != previous and not reachable_unseen(previous, state):
                yield time, f"{name} went from {STATES[previous]} to {STATES[state]}"
            previous = state
    told = {}
    for record in flight.log:
        if record.kind == "action" and (" died" in record.note or record.note.startswith(("started", "restarted"))):
            told.pop(record.peer, None)
        subsystem = flight.mission.by_apid(record.source)
        if record.kind != "event" or subsystem is None or record.report is None or len(record.report.data) != 3:
            continue
        event = int.from_bytes(record.report.data[:2], "big")
        # One that fails on arrival is told of as failed.
        if event not in (0xF000, 0xF001):
            continue
        state, previous = record.report.data[2], told.get(record.source)
        if previous is not None and state != previous and (previous, state) not in EDGES and not muted(flight, record.source):
            yield record.time, f"{subsystem.name} told of {STATES[state]} after {STATES[previous]}"
        told[record.source] = state


def muted(flight, apid):
    """ST[05] was told to keep events of this subsystem to itself, or the log has gaps: a missing report is no jump."""
    return (any(r.kind == "gap" for r in flight.log) or
            any(r.kind == "telecommand-forwarded" and r.peer == apid and r.telecommand and r.telecommand.service == 5 for r in flight.log))


def i10_commandable_again(flight, victims):
    recovered, flown = flight.mark("recovered"), flight.mark("flown")
    # A supervisor that stood still finds ground's SHUTDOWN when it goes on, and one that goes on for another ends what that had begun to
    # end: then that is how this flight ends. So it is where it was still about it, as ground asked for it at the last moment.
    def is_the_end(sent):
        ends = flight.finished()
        at_the_last_moment = ends <= sent.time + STOP_BEGINS_US and recovered < ends + OFFLINE_US
        held_up = meets(victims["SUPERVISOR"], sent.time, ends) or meets(victims["SUCCESSION"], sent.time, recovered)
        return sent.function == "SHUTDOWN" and sent.time < ends < recovered and (at_the_last_moment or held_up)

    asked_to_end = recovered is not None and any(is_the_end(sent) for sent in flight.sent)
    if recovered is None or asked_to_end:
        return
    answered = {d[6] for d in flight.down if d[3] == 1 and d[4] == 7 and d[5] == 0}
    for sent in flight.sent:
        if recovered <= sent.time <= recovered + 1 and sent.service == 17 and sent.key[1] not in answered:
            yield sent.time, f"{flight.mission.by_apid(sent.apid).name} answers no ping 2 s after the last fault"
    if flown is None:
        yield recovered, "nothing could be brought up"
        return
    for up, (name,) in flight.marks["up"]:
        if any(state != OPERATIONAL for state in flight.state[name].during(up, flown)):
            states = [STATES[state] for state in flight.state[name].during(up, flown)]
            why = next((f"; {words[1]} of {words[0]} failed" for time, words in flight.called
                        if recovered < time < flown and words[3] == "failed"), "")
            yield up, f"{name} cannot be brought up again: {', '.join(states)}{why}"


def i12_no_operational_without_required_link(flight, victims):
    """None enters Operational without; who loses one later is inhibited, where its descriptor does not say that it holds."""
    lag = 2 * STATE_LAG_US
    for member in flight.mission.members:
        for start, end in flight.state[member.name].spans(flight.end, lambda state: state == OPERATIONAL):
            configuration = member.configurations.get(flight.configuration[member.name].at(start))
            for wanted in configuration.requires if configuration else []:
                link = next((i for i, (_, to, name) in flight.mission.links.items() if (to, name) == (member.name, wanted.name)), None)
                if not wanted.required or meets(unattended(victims), start - lag, start + lag):
                    continue
                if not any(link in up for up in flight.links.during(start - lag, start)):
                    yield start, f"{member.name} entered Operational without {wanted.name}"
                for first, last in flight.links.spans(flight.end, lambda up: link not in up) if wanted.inhibits else []:
                    first, last = max(first, start) + lag, min(last, end)
                    free = [bits for bits in flight.inhibited[member.name].during(first, last) if not bits]
                    struck = meets(victims[member.name], first - lag, last) or meets(victims["SUCCESSION"], first - lag, first)
                    if first < last and free and not struck:
                        yield first, f"{member.name} is Operational and not inhibited without {wanted.name}"


def i13_cycles_keep_time(flight, victims):
    """Over every span in which nothing was done to it, at the same period."""
    for name in [*flight.members, *flight.mission.devices]:
        is_device = name in flight.mission.devices
        begun = None
        for time, counts in flight.cycles:
            period_ns = flight.device_period_ns[name] if is_device else flight.period_ns[name].at(time)
            runs = (is_device or (flight.cycling[name].at(time) and not flight.still[name].at(time))) and period_ns
            disturbed = meets(victims[name], time - 20_000, time) or meets(victims["SUPERVISOR"], time - 20_000, time)
            if not runs or disturbed or time == 0 or time >= flight.finished():
                begun = None
                continue
            if begun is None or begun[2] != period_ns or (not is_device and not steady(flight, name, begun[0], time)):
                begun = time, counts[name], period_ns
                continue
            expected = (time - begun[0]) * 1000 / period_ns
            if not is_device and started_by_samples(flight, name, time):
                continue
            if abs(counts[name] - begun[1] - expected) > (DEVICE_CYCLES if is_device else 1) + 0.01:
                yield time, (f"{name} made {counts[name] - begun[1]} cycles in {(time - begun[0]) / 1000:.0f} ms, "
                             f"{expected:.0f} expected")
                break


def started_by_samples(flight, name, time):
    """As many cycles as samples come, of which the trace has none."""
    configuration = flight.mission.by_name(name).configurations.get(flight.configuration[name].at(time))
    return configuration is not None and configuration.least_us is not None


def steady(flight, name, start, end):
    return all(flight.cycling[name].during(start, end)) and not any(flight.still[name].during(start, end))


WORLD = {"I1": [i1_only_victims_die],
         "I4": [i4_actuators_are_off_outside_operational, i4_safe_all_stops_everything, i4_a_network_goes_down_with_its_member,
                i4_who_begins_is_let_go, i4_a_stop_stays],
         "I5": [i5_no_stale_sample_is_used], "I9": [i9_only_edges_of_the_table], "I10": [i10_commandable_again],
         "I12": [i12_no_operational_without_required_link], "I13": [i13_cycles_keep_time]}
