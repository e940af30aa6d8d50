# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A descriptor that is read again in flight, and another version of a program (docs/adr/0089, 0095, 0214): whole or not at all, and what flies is what
was asked for."""
import collections

from descriptors import OFFLINE, PRE
from record import meets

READING_US = 3_000_000     # no file is read, and no process of another version begins, longer than that behind who asked
TAKEN_US = 100_000         # from the report of its end: by then each process of that file has the text
WAY_DOWN_US = 12_000_000   # of a version that was not confirmed: into Offline, its end, and the one before
ASKED = ("REREAD", "REPLACE", "TAKE_BACK")


# A telecommand of these, as it came to the supervisor.
Asked = collections.namedtuple("Asked", "time key function apid version within_us")


def asked_of(flight, *functions):
    return [read(record) for record in flight.log
            if record.kind == "telecommand-received" and record.telecommand and record.telecommand.function in functions]


def read(record):
    data = record.telecommand.data
    octets = int.from_bytes(data[21:23], "big")
    return Asked(record.time, record.telecommand.key, record.telecommand.function, int.from_bytes(data[18:20], "big"),
                 data[23:23 + octets].decode(errors="replace"), 1_000_000 * int.from_bytes(data[24 + octets:26 + octets], "big"))


def ends(flight):
    """{request: (time, whether it was carried out)}"""
    found = {}
    for record in flight.log:
        if record.report is not None and record.report.service == 1 and record.report.subtype in (2, 4, 7, 8) and len(record.report.data) >= 4:
            found.setdefault(record.report.request_key, (record.time, record.report.subtype == 7))
    return found


def is_exchanged(flight, name, time):
    """Its process ends for that of another version, or was to."""
    apid, versions = flight.mission.by_name(name).apid, flight.version[name]
    begun = next((at for at, there in zip(flight.alive[name].times, flight.alive[name].values) if at >= time and there), time)
    asked = any(each.apid == apid and each.time <= time <= each.time + READING_US for each in asked_of(flight, "REPLACE", "TAKE_BACK"))
    return asked or versions.at(begun) != versions.at(time - 1)


def has_gaps(flight):
    """What was asked may stand nowhere."""
    return any(record.kind == "gap" for record in flight.log)


def i20_what_flies_is_a_text_that_was_taken(flight, _):
    """Of a file that is edited in flight: none flies by what is not sound, nor by another text that nobody has asked for, nor takes one elsewhere than in
    Offline and Pre-Operational."""
    if has_gaps(flight):
        return
    telecommands = asked_of(flight, *ASKED)
    for name in flight.members:
        texts, apid = flight.text[name], flight.mission.by_name(name).apid
        edits = [(time, crc, sound) for time, member, crc, sound in flight.wrote if member == name]
        known = {texts.values[1]} if len(texts.values) > 1 else set()
        faulty = {crc for _, crc, sound in edits if not sound}
        for time, crc, before in list(zip(texts.times, texts.values, [None, *texts.values]))[2:]:
            if crc == before:
                continue
            if crc in faulty:
                yield time, f"{name} flies by a text that is none, {crc}"
            elif crc not in known | {each for at, each, _ in edits if at <= time}:
                yield time, f"{name} flies by a text that nobody wrote, {crc}"
            # Who was not there begins with what has been taken by then.
            runs = flight.alive[name].at(time - 1) and flight.alive[name].during(time - 1, time) == [1]
            near = READING_US if runs else time
            if not any(each.apid == apid and time - near <= each.time <= time for each in telecommands) and not was_on_trial(flight, apid, time):
                yield time, f"{name} flies by another text, and nobody has asked for that"
            if runs and flight.state[name].at(time) not in (OFFLINE, PRE):
                yield time, f"{name} took another text beyond Pre-Operational"


def was_on_trial(flight, apid, time):
    """What another version brought goes with it."""
    return any(each.apid == apid and each.time <= time <= each.time + each.within_us + WAY_DOWN_US for each in asked_of(flight, "REPLACE"))


def i20_a_text_is_taken_whole_or_not_at_all(flight, victims):
    """Who says that it was read again has it; who says that it was refused flies by the one before."""
    finished = ends(flight)
    for asked in asked_of(flight, "REREAD"):
        member = flight.mission.by_apid(asked.apid)
        done, success = finished.get(asked.key, (None, False))
        if member is None or done is None or member is flight.mission.supervisor or has_gaps(flight):
            continue
        name, until = member.name, done + TAKEN_US
        if meets(victims["SUCCESSION"] + victims["SUPERVISOR"] + victims["LOG"] + victims["FLOOD"], asked.time - TAKEN_US, until):
            continue
        now = flight.text[name].at(until)
        others = [each for each in asked_of(flight, *ASKED) if each.apid == asked.apid and each.key != asked.key
                  and asked.time - READING_US <= each.time <= until]
        edited = any(member == name and asked.time <= time <= done for time, member, _, _ in flight.wrote)
        if others or edited or was_on_trial(flight, asked.apid, done) or not flight.alive[name].at(until):
            continue
        if success and now != written(flight, name, asked.time):
            yield done, f"{name} was read again, and flies by {now} in place of {written(flight, name, asked.time)}"
        elif not success and now != flight.text[name].at(asked.time) and flight.alive[name].at(asked.time):
            yield done, f"{name} was not read again, and flies by another text"


def written(flight, name, time):
    """CRC-32 of what its file says then; what it says at the start flies at the start."""
    edits = [crc for at, member, crc, _ in flight.wrote if member == name and at <= time]
    return edits[-1] if edits else flight.text[name].values[1]


def i21_the_version_that_runs_was_asked_for(flight, victims):
    """Of each process that begins: the one before it, the one that was asked for, or, from one that nobody has confirmed, the one before that."""
    if has_gaps(flight):
        return
    finished = ends(flight)
    for name in flight.members:
        apid = flight.mission.by_name(name).apid
        asked = [each for each in asked_of(flight, "REPLACE", "TAKE_BACK") if each.apid == apid]
        versions = flight.version[name]
        for time, version, before in list(zip(versions.times, versions.values, ["-", *versions.values]))[1:]:
            near = [each for each in asked if each.time <= time <= each.time + READING_US and not ended_before(finished, each, time)]
            wanted = {each.version for each in near if each.function == "REPLACE"}
            back = any(each.function == "TAKE_BACK" for each in near) or trials(flight, name, time)
            earlier = {each for at, each in zip(versions.times, versions.values) if at < time} | {"-"}
            if version not in wanted and not (back and version in earlier):
                yield time, f"{name} runs {version} behind {before}, which nobody has asked for"


def ended_before(finished, asked, time):
    done, success = finished.get(asked.key, (None, False))
    return done is not None and not success and done < time


def trials(flight, name, time):
    """Until when the version that ran then was on trial; none: it was confirmed, or is the mission's own."""
    apid, versions = flight.mission.by_name(name).apid, flight.version[name]
    begun = max((at for at in versions.times[1:] if at < time), default=None)
    if begun is None or versions.at(time - 1) == "-":
        return []
    asked = [each for each in asked_of(flight, "REPLACE") if each.apid == apid and each.version == versions.at(begun)
             and each.time <= begun <= each.time + READING_US]
    finished = ends(flight)
    over = any(each.apid == apid and begun <= each.time <= time and finished.get(each.key, (0, False))[1]
               for each in asked_of(flight, "CONFIRM", "TAKE_BACK"))
    return [begun + asked[-1].within_us] if asked and not over else []


def i21_who_is_not_confirmed_goes_back(flight, victims):
    """In its time, and a process that ends on trial is followed by the version before."""
    if has_gaps(flight):
        return
    for name in flight.members:
        versions, last = flight.version[name], min(flight.finished(), flight.end)
        for number, (begun, version) in enumerate(zip(versions.times[1:], versions.values[1:]), 1):
            gone = versions.times[number + 1] if number + 1 < len(versions.times) else flight.end + 1
            limit = trials(flight, name, begun + 1)
            late = limit[0] + WAY_DOWN_US if limit else 0
            if limit and late < min(gone, last) and trials(flight, name, late) and not meets(victims["SUCCESSION"] + victims["SUPERVISOR"], begun, late):
                yield begun, f"{name} runs {version} long after its trial, and nobody has confirmed it"
            for at, alive in zip(flight.alive[name].times, flight.alive[name].values):
                if alive and begun < at < min(gone, last) and trials(flight, name, at) and not meets(victims["SUCCESSION"], begun, at):
                    yield at, f"{name} begins again as {version}, which was on trial as it ended"


EXCHANGES = {"I20": [i20_what_flies_is_a_text_that_was_taken, i20_a_text_is_taken_whole_or_not_at_all],
             "I21": [i21_the_version_that_runs_was_asked_for, i21_who_is_not_confirmed_goes_back]}
