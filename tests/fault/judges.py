# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Judges of what a client sent and heard, and of what the log has, around kills of the supervisor. They see numbers and times alone and say what
is wrong; judges_test.py shows each of them a fault that it has to see. Times are time.monotonic(), which is the log's clock, too."""
import bisect
import collections
import math

import honest
import witness

# How long what was said may be on its way to the disk: an event of severity medium or high, and whatever else is telemetry, reports of telecommands
# among it. That a telecommand itself is there before it is accepted is judged for itself (accounts.py).
EVENT_S, TELEMETRY_S = 0.010, 1.0
EVENTS, VERIFICATION, HOUSEKEEPING, OTHERS = "events of severity medium and high", "reports of telecommands", "housekeeping", "all else"
BOUNDS_S = {EVENTS: EVENT_S, VERIFICATION: TELEMETRY_S, HOUSEKEEPING: TELEMETRY_S, OTHERS: TELEMETRY_S}


def class_of(report):
    if report.kind in (witness.MEDIUM, witness.HIGH):
        return EVENTS
    if report.kind >> 8 == 1:
        return VERIFICATION
    return HOUSEKEEPING if report.kind == witness.HOUSEKEEPING else OTHERS


def before_kill_s(at, deaths):
    """How long before the end of who had it this was heard. Infinite: nobody died since."""
    place = bisect.bisect_right([gone_on for _, gone_on in deaths], at)
    return deaths[place][0] - at if place < len(deaths) else math.inf


def not_in_the_log(heard, stored, deaths, until=math.inf):
    """Of all that was heard before `until`: [(report, how long before a kill)] of those whose octets are not among `stored`."""
    return [(report, before_kill_s(report.at, deaths)) for report in heard if report.key not in stored and report.at < until]


def lost(absent):
    """Complaints: heard for longer than its bound when the supervisor was killed, and not in the log."""
    late = [(class_of(report), report, before_s) for report, before_s in absent if before_s > BOUNDS_S[class_of(report)]]
    return [f"{name}, TM[{report.kind >> 8},{report.kind & 0xFF}] of {report.apid}: heard {before_s:.4f} s before a kill, is not in the log"
            for name, report, before_s in late]


def longest_s(absent):
    """{class: how long before a kill what is not in the log was heard, at most}."""
    found = {}
    for report, before_s in absent:
        found[class_of(report)] = max(before_s, found.get(class_of(report), -math.inf))
    return found


def united(*parts):
    """Each report once, whoever has it, in the order of the addressees' time: of one that two have, the time of the first."""
    seen, found = set(), []
    for reports in parts:
        for report in reports:
            if report.key not in seen:
                seen.add(report.key)
                found.append(report)
    return sorted(found, key=lambda report: report.at)


def executions(sent, reports):
    """{(request, how many of that number were sent before, addressee): how often it says that it has accepted it and begun it}. `sent`: {request: times}.
    A request's number comes again after 16384: a report is about the newest that was sent before it."""
    found = collections.defaultdict(collections.Counter)
    for report in reports:
        of_ours = report.destination == honest.HONEST and report.apid != honest.SUPERVISOR and report.request in sent
        if not of_ours or report.kind not in (witness.ACCEPTED, witness.STARTED):
            continue            # the supervisor numbers what it asks of its members itself
        nth = bisect.bisect_right(sent[report.request], report.at)
        found[report.request, nth, report.apid][report.kind] += 1
    return found


def carried_out_twice(sent, reports):
    """Complaints, by what the addressees themselves say and number: two of one telecommand that say "started"."""
    return [f"request {request:08x}, the {nth}. of that number, was carried out {max(said.values())} times by {apid}"
            for (request, nth, apid), said in executions(sent, reports).items() if max(said.values()) > 1 or nth == 0]


def answered_more_often(asked, reports):
    """Complaints. `asked`: {(addressee, kind of its answer): how often}. An answer for each execution, whatever is said of the telecommand."""
    answers = collections.Counter((report.apid, report.kind) for report in reports if report.destination == honest.HONEST)
    return [f"{apid} gave {answers[apid, kind]} answers {kind >> 8},{kind & 0xFF} to {times} requests"
            for (apid, kind), times in asked.items() if answers[apid, kind] > times]


def missing_runs(reports, apid):
    """How many numbers in a row of this addressee's own count stand in no report: [length of each run]."""
    whole, newest, seen = 0, None, set()
    for report in reports:
        if report.apid != apid:
            continue
        step = 0 if newest is None else (report.count - newest + 0x2000 & 0x3FFF) - 0x2000
        whole += step
        newest = report.count
        seen.add(whole)
    ordered = sorted(seen)
    return [later - earlier - 1 for earlier, later in zip(ordered, ordered[1:]) if later - earlier > 1]
