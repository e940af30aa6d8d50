# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What was said before comes down from the log as ground asks for it (docs/adr/0140): that, in order, each once, and nothing else."""
import collections, struct, zlib

from packet_rules import PING_US, name_of
from record import Asked, End, meets
from rules import ground_link_works

RETRIEVE, RETRIEVED, END = 11, 12, 13
ILLEGAL_FIELD, QUEUE_FULL, NOT_DECLARED, BUSY = 9, 11, 18, 0x0108
LONGEST = 4066             # octets of a report that finds room in another one
CUT_OFF_NS = 60            # 7 octets say 2^-24 s
MOST_AT_ONCE, WATCH_US = 8, 10_000
RATE_US = 100_000          # over which they are counted
LIVE_US = 100_000          # what is said now has come down by then
LOSS_TOLD_US, TELEMETRY_LOST = 1_100_000, 111  # the event that tells how much found no room on its way to the ground link
DISK_PATIENCE_US = 3_000_000
REPORT_US = 2_500          # half the rate that they can have, as what is said now goes first
ASKED_ANEW, NOT_ON_DISK, UNREADABLE = "asked_anew", "what_was_said_last_is_not_on_the_disk_yet", "the_log_cannot_be_read:"


def range_of(data):
    if len(data) != 15 or data[14] > 1:
        return None
    first, last = ((int.from_bytes(data[at:at + 7], "big") * 10**9 + 2**24 - 1) >> 24 for at in (0, 7))
    return (first, last, data[14] == 1) if first <= last else None


def all_asked(flight):
    verdicts = collections.defaultdict(dict)
    for down in flight.down:
        if down[3] == 1 and len(down) > 6:
            verdicts[down[5], down[6]][down[4]] = None
    for record in flight.log:
        if record.report is not None and record.report.service == 1 and len(record.report.data) >= 4:
            code = int.from_bytes(record.report.data[4:6], "big") if len(record.report.data) >= 6 else None
            verdicts[record.report.request_key][record.report.subtype] = code
    return [Asked(sent, range_of(b"" if sent.function == "-" else bytes.fromhex(sent.function)), verdicts[sent.key])
            for sent in flight.sent if (sent.apid, sent.service, sent.subtype) == (flight.mission.supervisor.apid, 129, RETRIEVE)]


def ends_of(flight):
    return [End(down[0], *down[5:]) for down in flight.down if down[3:5] == (129, END) and len(down) == 12]


def i14_who_may_ask_is_answered(flight, victims):
    """A range is refused for no reason but those that are documented, and what is none, or no ground's, is never begun."""
    asked = all_asked(flight)
    ended = {end.key: end.time for end in ends_of(flight)}
    for each in asked:
        if each.sent.origin != "ground":
            if {3, 5, 7} & each.verdicts.keys() or each.sent.key in ended:
                yield each.time, f"{each.sent.origin} filled the downlink with what was said before"
            elif each.verdicts.get(2, NOT_DECLARED) not in (NOT_DECLARED, None):
                yield each.time, f"{each.sent.origin} asked for what was said before and was refused for another reason, {each.verdicts[2]}"
            continue
        if each.range is None:
            if {3, 5, 7} & each.verdicts.keys() or each.sent.key in ended:
                yield each.time, "what is no range of times was begun"
            continue
        if each.verdicts.get(2) == ILLEGAL_FIELD:
            yield each.time, "a range of times was refused as none"
        code = each.verdicts.get(4)
        others = any(other.range and not other.refused and other.sent.source != each.sent.source and other.time <= each.time and
                     ended.get(other.sent.key, flight.end) >= each.time for other in asked if other.sent.origin == "ground")
        good = code is None or (code == BUSY and others) or (code == QUEUE_FULL and meets(victims["LOG"], 0, each.time))
        if not good:
            yield each.time, f"a range of times was not begun, code {code}"


def i14_what_is_begun_ends_once(flight, victims):
    number = collections.Counter(end.key for end in ends_of(flight))
    for key, times in number.items():
        if times > 1:
            yield 0, f"request {key[1]:08x} of source {key[0]} has {times} ends of what was said before"
    for each in all_asked(flight):
        if each.sent.origin != "ground" or each.range is None or each.refused or number[each.sent.key]:
            continue
        most = sum(within(record, each.range) for record in flight.log)
        until = each.time + DISK_PATIENCE_US + PING_US + most * REPORT_US
        if until < flight.finished() and quiet(flight, victims, each.time, until) and not meets(victims["LOG"], each.time, until):
            yield each.time, f"what was asked for of source {each.sent.source} did not end in {(until - each.time) / 1e6:.1f} s"


def i14_it_ends_early_for_a_reason(flight, victims):
    asked = {each.sent.key: each for each in all_asked(flight)}
    for end in ends_of(flight):
        each = asked.get(end.key)
        if each is None:
            yield end.time, f"an end came of request {end.request:08x}, which nobody has asked"
        elif end.why == ASKED_ANEW:
            if not any(each.time <= other.time <= end.time for other in asked.values()
                       if other is not each and other.sent.source == each.sent.source and other.range):
                yield end.time, "it ended as asked anew, and nobody did"
        elif end.why == NOT_ON_DISK or end.why.startswith(UNREADABLE):
            if not meets(victims["LOG"], each.time, end.time):
                yield end.time, f"it ended early though nothing was done to the log: {end.why}"
        elif end.why != "-":
            yield end.time, f"it ended early for what nobody has written down: {end.why}"


def within(record, span, cut_off_ns=CUT_OFF_NS):
    first, last, housekeeping = span
    is_report = record.kind in ("telemetry", "event") and record.report is not None
    wanted = is_report and (housekeeping or (record.report.service, record.report.subtype) != (3, 25))
    return wanted and first <= record.stored <= last + cut_off_ns


def quiet(flight, victims, start, end):
    return ground_link_works(flight, victims, start, end) and not meets(victims["FLOOD"], start, end)


def i14_it_is_what_the_log_has(flight, victims):
    asked = {each.sent.key: each for each in all_asked(flight)}
    records = {record.number: record for record in flight.log if record.kind != "gap"}
    running = collections.defaultdict(list)
    for down in flight.down:
        if down[3] != 129:
            continue
        if down[4] == RETRIEVED:
            time, destination, number, digest = down[0], *down[5:8]
            running[destination].append((time, number))
            same = records.get(number)
            if same is None or zlib.crc32(same.packet) != digest or same.kind not in ("telemetry", "event"):
                yield time, f"what came down as number {number} of the log is not what stands there"
        elif down[4] == END and len(down) == 12:
            end = End(down[0], *down[5:])
            came, each = running.pop(end.destination, []), asked.get(end.key)
            if each is not None and each.range is not None and ground_link_works(flight, victims, each.time, end.time):
                # What came before it was asked for is of one whose end was lost with the ground link.
                yield from whole(flight, victims, each, end, [number for time, number in came if time >= each.time])


def whole(flight, victims, each, end, came):
    """One that nothing hindered on its way: against what stands in the log."""
    if any(later <= before for before, later in zip(came, came[1:])):
        yield end.time, "what was said before did not come in order, each once"
    if end.reports != len(came):
        yield end.time, f"{len(came)} reports came down again, and its end tells of {end.reports}"
    may = {record.number: record for record in flight.log if within(record, each.range)}
    if other := [number for number in came if number not in may]:
        yield end.time, f"{len(other)} reports came down again that were not asked for, the first number {other[0]}"
    if end.why != "-":
        return
    must = [record for record in may.values() if within(record, each.range, 0) and record.time < each.time]
    lacking = [record for record in must if record.number not in set(came)]
    absent = [record for record in lacking if len(record.packet) <= LONGEST]
    if len(absent) > end.missing + end.damaged:
        yield end.time, (f"{len(absent)} reports that were asked for did not come, the first {absent[0].number} of {name_of(flight, absent[0].source)}, "
                         f"and its end tells of {end.missing} that are missing")
    if not len(lacking) - len(absent) <= end.left_out <= sum(len(record.packet) > LONGEST for record in may.values()):
        yield end.time, f"{len(lacking) - len(absent)} reports find no room, and its end tells of {end.left_out}"
    if (end.missing or end.damaged) and not meets(victims["LOG"], 0, end.time):
        yield end.time, f"{end.missing} are told to be missing though nothing was done to the log"


def told_losses(flight):
    """[[time, {housekeeping: number}]]: how much was told as lost on its way to the ground link since it was told last."""
    return [[r.time, dict(zip((True, False), struct.unpack_from(">II", r.report.data, 2)))] for r in flight.log
            if r.kind == "event" and r.report is not None and r.source == flight.mission.supervisor.apid
            and r.report.data[:2] == TELEMETRY_LOST.to_bytes(2, "big")]


def told_as_lost(losses, record):
    """Whether one of those that were told is this one; it is taken off."""
    housekeeping = (record.report.service, record.report.subtype) == (3, 25)
    for time, left in losses:
        if record.time <= time <= record.time + LOSS_TOLD_US and left[housekeeping]:
            left[housekeeping] -= 1
            return True
    return False


def i14_what_is_said_now_goes_first(flight, victims):
    again = [down[0] for down in flight.down if down[3:5] == (129, RETRIEVED)]
    most = MOST_AT_ONCE * (RATE_US // WATCH_US + 1)
    for first, last in zip(again, again[most:]):
        if last - first < RATE_US and ground_link_works(flight, victims, first - RATE_US, last):
            yield first, f"more than {most} reports came down again within {RATE_US // 1000} ms"
            break
    came = collections.defaultdict(list)
    for down in flight.down:
        came[down[1], down[2]].append(down[0])
    spans, losses = [], told_losses(flight)
    asked = {each.sent.key: each for each in all_asked(flight)}
    for end in ends_of(flight):
        if end.key in asked and end.reports:
            spans.append((asked[end.key].time, end.time))
    for record in flight.log if spans else ():
        if record.report is None or not meets(spans, record.time, record.time):
            continue
        until = record.time + LIVE_US
        if not quiet(flight, victims, record.time, until) or until >= flight.finished():
            continue
        here = any(record.time <= time <= until for time in came[record.report.apid, record.report.count])
        if not here and not told_as_lost(losses, record):
            yield record.time, f"a report of {name_of(flight, record.source)} did not come down within {LIVE_US // 1000} ms beside what was said before"
            break


RETRIEVALS = {"I14": [i14_who_may_ask_is_answered, i14_what_is_begun_ends_once, i14_it_ends_early_for_a_reason,
                      i14_it_is_what_the_log_has, i14_what_is_said_now_goes_first]}
