# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A flight as it would have been written down, for tests of the judge: log and trace are put together line by line."""
import collections, pathlib, struct, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "simulation" / "campaign" / "judge"))
from descriptors import OPERATIONAL, PRE, SAFE, read_mission  # noqa: E402
from record import DELETED, START_NS, Record  # noqa: E402

MISSION = read_mission(HERE.parents[1] / "missions" / "rokviss")
SUPERVISOR, COMMUNICATION, ROBOT, JOYSTICK = 1, 2, 10, 11
NAMES = {COMMUNICATION: "COMMUNICATION", ROBOT: "MANIPULATOR", JOYSTICK: "JOYSTICK"}
COUPLED = ("telepresence", "quick")  # modes
MS, S = 1000, 1_000_000


def call(function, *arguments):
    """Data of TC[8,1] with arguments of one octet."""
    return (function.encode().ljust(16, b"\0") + bytes([len(arguments)]) +
            bytes(octet for pair in enumerate(arguments, 1) for octet in pair))


class Written:
    """A craft as its mission couples it, in Operational from 50 ms on, to 5 s; what is added decides what the judge says of it."""

    def __init__(self, mission=MISSION):
        self.mission = mission
        self.trace, self.log, self.gone, self.numbers, self.counts = [], [], [], 0, collections.Counter()
        mode = next(mode for mode in COUPLED if mode in mission.modes)
        for device, (owner, _) in mission.devices.items():
            self.at(0, f"device {device} {owner} period_ns=500000")
        for member in mission.members:
            name = member.name
            configuration = next((c for c in member.configurations.values() if c.name == mission.commissions[mode].get(name)), None)
            if configuration is None:
                continue
            self.at(0, f"alive {name} 1")
            self.at(40 * MS, f"state {name} {PRE}").at(45 * MS, f"state {name} {SAFE}")
            self.at(50 * MS, f"state {name} {OPERATIONAL}", f"configuration {name} {configuration.id}", f"cycling {name} 1",
                    f"period {name} {1000 * configuration.sampling_us}")
        self.at(50 * MS, " ".join(["links", *map(str, mission.establishes[mode])]))
        self.at(5 * S, "end")

    # --- the trace ---------------------------------------------------------------------------------------------------
    def at(self, time, *lines):
        self.trace += [(time, line) for line in lines]
        return self

    def without(self, *words):
        """Takes the lines of the trace out that begin so."""
        self.trace = [line for line in self.trace if not line[1].startswith(words)]
        return self

    def sent(self, time, apid, service, subtype, function="-", origin="ground", ack=15, source=0, count=None):
        """Returns the request, as reports on it say."""
        count = self.next(("tc", source)) if count is None else count
        self.at(time, f"sent {origin} {apid} {count} {source} {ack} {service} {subtype} {function}")
        return (0x1800 | apid) << 16 | 0xC000 | count

    def down(self, time, apid, service, subtype, *request, count=None, logged=True):
        """A report that ground received; with `logged` in the log, too."""
        count = self.next(apid) if count is None else count
        destination = [0, *request] if request else []
        self.at(time, " ".join(map(str, ["down", apid, count, service, subtype, *destination])))
        if logged:
            self.report(time, apid, service, subtype, struct.pack(">I", request[0]) if request else b"", count=count)
        return self

    # --- the log -----------------------------------------------------------------------------------------------------
    def next(self, who):
        self.counts[who] += 1
        return self.counts[who]

    def record(self, time, kind, source=SUPERVISOR, peer=SUPERVISOR, lost=0, packet=b"", note="", stored=None, number=None):
        self.numbers += max(lost, 1)
        number = self.numbers if number is None else number
        self.log.append((time, f"{number} {stored or time} {START_NS + time * 1000} {kind} {source} {peer} {lost} "
                               f"{packet.hex() or '-'} {note}"))
        return self

    def delete_log(self, told=None):
        """What is in the log by now goes; the gap that the store leaves tells of all of it, or of so many."""
        self.gone, first = self.log, self.log[0]
        words = first[1].split(" ", 8)
        self.log = [(first[0], " ".join([*words[:3], "gap", "0", "0", str(told or self.numbers), "-", DELETED]))]

    def action(self, time, note, peer=SUPERVISOR):
        return self.record(time, "action", peer=peer, note=note)

    def command(self, time, kind, apid, service, subtype, data=b"", ack=15, source=0, count=None):
        """A telecommand as the log has it: 'received', 'forwarded', 'refused'. Returns its request."""
        count = self.next(("tc", source)) if count is None else count
        request = (0x1800 | apid) << 16 | 0xC000 | count
        packet = struct.pack(">IHBBBH", request, 0, 0x20 | ack, service, subtype, source) + data + b"\0\0"
        self.record(time, "telecommand-" + kind, source=source if kind == "received" else SUPERVISOR, peer=apid, packet=packet)
        return request

    def report(self, time, apid, service, subtype, data=b"", destination=0, kind=None, count=None, onboard=None, stored=None):
        count = self.next(apid) if count is None else count
        packet = (struct.pack(">IHBBBHH", (0x0800 | apid) << 16 | 0xC000 | count, 0, 0x20, service, subtype, 0, destination) +
                  (time if onboard is None else onboard).to_bytes(7, "big") + data + b"\0\0")
        kind = kind or ("event" if service == 5 and subtype <= 4 else "telemetry")
        return self.record(time, kind, source=apid, packet=packet, stored=stored)

    def verified(self, time, request, subtype, apid=SUPERVISOR, destination=0, count=None):
        """TM[1,subtype] in the log."""
        return self.report(time, apid, 1, subtype, struct.pack(">I", request), destination, count=count)

    def told(self, time, apid, state):
        """STATE_CHANGED in the log."""
        return self.report(time, apid, 5, 1, struct.pack(">HB", 0xF000, state))

    # --- its judge ---------------------------------------------------------------------------------------------------
    def write(self, folder):
        lines = lambda entries: "".join(f"{line}\n" for line in entries)
        (pathlib.Path(folder) / "trace.txt").write_text(lines(f"{time} {text}" for time, text in sorted(self.trace, key=lambda e: e[0])))
        (pathlib.Path(folder) / "log.txt").write_text(lines(text for _, text in self.log))
        (pathlib.Path(folder) / "deleted.txt").write_text(lines(text for _, text in self.gone))

    def read(self):
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder)
            return Record(self.mission, folder)
