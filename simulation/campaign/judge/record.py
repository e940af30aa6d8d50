# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A flight as it was written down: packet log and world trace, and nothing else."""
import bisect, collections, dataclasses, pathlib

from packets import report, telecommand

START_NS = 1_000_000_000  # of the craft's clock
AFTERMATH_US = 1_000_000   # what an end of a fault or a new process may still bring about
SHUTDOWN_US = 6_000_000    # who has not gone by then is ended
DELETED = "the log was deleted or moved away with these"  # of a gap
NO_FAULTS = ("hook", "release", "hand")  # of the world, which the craft has to live with


class Series:
    """A value that changes at instants."""

    def __init__(self, first=0):
        self.times, self.values = [-1], [first]

    def set(self, time, value):
        self.times.append(time)
        self.values.append(value)

    def at(self, time):
        return self.values[bisect.bisect_right(self.times, time) - 1]

    def during(self, start, end):
        """All values that held at some instant of [start, end]."""
        first, last = max(bisect.bisect_right(self.times, start) - 1, 0), bisect.bisect_right(self.times, end)
        return self.values[first:last]

    def spans(self, end, wanted=lambda value: bool(value)):
        """[(start, end)] of the spans in which the value is wanted."""
        found, begun = [], None
        for time, value in zip(self.times, self.values):
            if wanted(value) and begun is None:
                begun = max(time, 0)
            elif not wanted(value) and begun is not None:
                found.append((begun, time))
                begun = None
        return found + ([(begun, end)] if begun is not None else [])


@dataclasses.dataclass
class Logged:
    number: int
    stored: int
    time: int          # us since the start
    kind: str
    source: int
    peer: int
    lost: int
    note: str
    packet: bytes
    telecommand: object
    report: object


@dataclasses.dataclass
class Sent:
    time: int
    origin: str
    apid: int
    count: int
    source: int
    ack: int
    service: int
    subtype: int
    function: str

    @property
    def key(self):
        return (self.source, (0x1800 | self.apid) << 16 | 0xC000 | self.count)


@dataclasses.dataclass
class Asked:
    """A TC[129,11], and what was said of it."""
    sent: object
    range: tuple | None    # (first ns, last ns, whether with housekeeping); None: it is none
    verdicts: dict         # subtype of TM[1,x]: failure code, None where only ground has it

    @property
    def time(self):
        return self.sent.time

    @property
    def refused(self):
        return 2 in self.verdicts or 4 in self.verdicts or 10 in self.verdicts


@dataclasses.dataclass
class End:
    """TM[129,13] as ground has it."""
    time: int
    destination: int
    request: int
    reports: int
    left_out: int
    missing: int
    damaged: int
    why: str

    @property
    def key(self):
        return self.destination, self.request


class Record:
    def __init__(self, mission, folder):
        self.mission = mission
        folder = pathlib.Path(folder)
        self.members = [member.name for member in mission.members]
        names = self.members + list(mission.devices)
        table = lambda: {name: Series() for name in names}
        self.alive, self.state, self.configuration, self.cycling = table(), table(), table(), table()
        self.active, self.torque, self.still = table(), table(), table()
        self.inhibited, self.period_ns = table(), table()
        self.device_period_ns = {}
        self.version, self.text = {name: Series("-") for name in self.members}, {name: Series(None) for name in self.members}
        self.wrote = []    # (time, member, CRC-32, whether it is sound) of each edit of a descriptor
        self.links = Series(frozenset())
        self.supervised = Series(1)
        self.cycles = []   # (time, {name: cycles})
        self.sent, self.lost_sends, self.down = [], 0, []
        self.damaged_sent = 0
        self.did = []      # (time, words)
        self.called = []
        self.marks = collections.defaultdict(list)
        self.end = 0
        for line in (folder / "trace.txt").read_text().splitlines():
            self.take(line.split())
        self.standing = self.read_log(folder / "log.txt")
        # What the flight itself has no more, because its log was deleted, still happened.
        self.log = self.read_log(folder / "deleted.txt") + [record for record in self.standing if record.note != DELETED]
        # A disk that takes nothing does not tell of it: then it began with the request that the flight's end followed.
        asked = [sent.time for sent in self.sent if sent.function == "SHUTDOWN" and sent.time > self.end - SHUTDOWN_US]
        self.ending = next((r.time for r in self.log if r.kind == "action" and r.note.startswith("shutdown")), min(asked, default=self.end))

    def take(self, words):
        time, what, rest = int(words[0]), words[1], words[2:]
        self.end = max(self.end, time)
        series = {"alive": self.alive, "state": self.state, "configuration": self.configuration, "cycling": self.cycling,
                  "inhibited": self.inhibited, "active": self.active, "torque": self.torque, "period": self.period_ns}
        if what in series:
            series[what][rest[0]].set(time, int(rest[1]))
            if what == "alive" and rest[1] == "0":
                for other in (self.state, self.cycling):
                    other[rest[0]].set(time, 0)
        elif what in ("version", "text"):
            getattr(self, what)[rest[0]].set(time, rest[1])
        elif what == "wrote":
            self.wrote.append((time, rest[0], rest[1], rest[2] == "sound"))
        elif what == "device":
            self.device_period_ns[rest[0]] = int(rest[2].split("=")[1])
        elif what == "links":
            self.links.set(time, frozenset(map(int, rest)))
        elif what == "supervised":
            self.supervised.set(time, int(rest[0]))
        elif what == "still":
            self.still[rest[0]].set(int(rest[1].split("=")[1]), 1)
        elif what == "moves":
            self.still[rest[0]].set(time, 0)
        elif what == "cycles":
            self.cycles.append((time, {name: int(n) for name, n in (word.split("=") for word in rest)}))
        elif what == "sent" and rest[1] != "damaged":
            self.sent.append(Sent(time, rest[0], *map(int, rest[1:7]), rest[7]))
        elif what == "sent":
            self.damaged_sent += 1
        elif what == "down":
            self.down.append((time, *(int(word) if word.isdigit() else word for word in rest)))
        elif what == "did":
            self.did.append((time, rest))
        elif what == "called":
            self.called.append((time, rest))
        elif what in ("calm", "recovered", "up", "flown", "end"):
            self.marks[what].append((time, rest))

    def read_log(self, path):
        return [self.logged(line) for line in path.read_text().splitlines()]

    def logged(self, line):
        number, stored, time, kind, source, peer, lost, packet, note = line.split(" ", 8)
        octets = b"" if packet == "-" else bytes.fromhex(packet)
        is_command = kind.startswith("telecommand")
        return Logged(int(number), int(stored), (int(time) - START_NS) // 1000, kind, int(source), int(peer), int(lost), note,
                      octets, telecommand(octets) if is_command else None, None if is_command else report(octets))

    def mark(self, name):
        return self.marks[name][0][0] if self.marks[name] else None

    def finished(self):
        """When the supervisor began to end the flight."""
        return self.ending

    def absences(self):
        """[(from, to)]: in these no supervisor made a step, as it had died or hung."""
        return self.supervised.spans(self.end, lambda there: not there)

    def mode(self):
        series = Series(self.mission.initial_mode)
        for record in self.log:
            # Another line tells of a mode that is impossible, and why.
            if record.kind == "action" and record.note.startswith("mode ") and record.note[5:] in self.mission.modes:
                series.set(record.time, record.note[5:])
        return series

    def strained_until(self, name, time, number, calm):
        """When the member has made this many cycles more, those aside that it made before it was looked at again. They may begin long
        after they were strained, and their count anew."""
        made, last = 0, None
        for at, each in self.cycles:
            count = each.get(name)
            if at <= time or count is None:
                continue
            if last is not None:
                made += count - last if count >= last else count
            last = count
            if made >= number:
                return at
        return calm

    # --- whom something was done to ------------------------------------------------------------------------------------
    def victims(self):
        """{name: [(start, end)]}: members, devices and SUPERVISOR while something is done to them; 'LOG' too. SUCCESSION: while none
        supervises, and as another one begins to."""
        spans = collections.defaultdict(list)
        spans["SUCCESSION"] = [(gone, back + AFTERMATH_US) for gone, back in self.absences()]
        calm = self.mark("calm") or self.end
        forever = self.end + 1
        opened = {}
        for time, words in self.did:
            verb, subject = words[0], words[1] if len(words) > 1 else ""
            if subject == self.mission.supervisor.name and verb in ("kill", "hang"):
                continue
            if verb in ("kill", "spin"):
                back = next((t for t, v in zip(self.alive[subject].times, self.alive[subject].values) if t > time and v), forever)
                spans[subject].append((time, min(back + AFTERMATH_US, forever)))
                if verb == "spin":  # one processor for all cycles: all stand until the culprit is gone
                    gone = next((t for t, v in zip(self.alive[subject].times, self.alive[subject].values) if t >= time and not v),
                                forever)
                    for name in self.members:
                        spans[name].append((time, gone + 100_000))
            elif verb in ("stop", "stick"):
                opened.setdefault((subject, verb), time)  # one that died of it does not go on
            elif verb in ("go", "unstick"):
                key = subject, {"go": "stop", "unstick": "stick"}[verb]
                if key in opened:
                    spans[subject].append((opened.pop(key), time + 100_000))
            elif verb == "strain":
                spans[subject].append((time, self.strained_until(subject, time, int(words[2]), calm) + int(words[2]) * int(words[3])
                                       + AFTERMATH_US))
            elif verb == "fault" and words[2] in ("heal", "plug"):
                begun = opened.pop((subject, words[2]), None)
                for name in (subject, self.mission.devices[subject][0]) if begun is not None else ():
                    spans[name].append((begun, time + AFTERMATH_US))
            elif verb == "fault" and words[2] not in NO_FAULTS:
                opened.setdefault((subject, "plug" if words[2] == "unplug" else "heal"), time)
            elif verb == "log":
                spans["LOG"].append((time, calm + 300_000))
            elif verb == "flood":
                spans["FLOOD"].append((time, time + 1_000_000))
        for (subject, _), time in opened.items():
            for name in {subject, self.mission.devices.get(subject, (subject,))[0]}:
                spans[name].append((time, calm + AFTERMATH_US if subject in self.mission.devices else calm + 100_000))
        return spans


def meets(spans, start, end):
    return any(first <= end and start <= last for first, last in spans)
