# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Draws the plan of a flight from a seed: who is told what, and what breaks, at random instants."""
import pathlib, random, struct, sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent / "judge"), str(pathlib.Path(__file__).resolve().parent)]
import losses, retrieval  # noqa: E401, E402
from of_mission import OfMission  # noqa: E402
from descriptors import ERROR, OFFLINE, OPERATIONAL, POST, PRE, SAFE, STATES, TYPES  # noqa: E402

FINALE_S = 26.0
BEGIN_S = 0.1           # commissioned by then
COMMON = ["3.1", "3.3", "3.5", "3.6", "3.9", "3.27", "3.29", "3.31", "3.33", "5.5", "5.6", "5.7", "17.1", "20.1", "20.3",
          "128.1", "128.2", "128.3", "128.4", "129.1", "3.77", "99.1", "SET_STATE", "CONFIGURE", "unknown"]
RETRIEVAL = "129.11"    # what was said before comes down again (docs/adr/0140); the supervisor's alone to answer
DEVICE_FAULTS = ["unplug", "silent", "stall", "freeze", "corrupt", "delay"]
MEMBER_FAULTS = ["kill", "stop", "spin", "stick", "strain"]
LOG_FAULTS = ["slow", "failing", "full", "deleted", "frozen"]
# How long the craft is left alone with a fault that was aimed: what ends or stops a process takes longest.
LEFT_ALONE_S = {**dict.fromkeys(DEVICE_FAULTS, 0.7), **dict.fromkeys(MEMBER_FAULTS, 1.6)}
SILENCED_EVERY, SILENCED_AT = 5, 3   # flights that end with an unplug that ground silenced (hazard SF6)
SILENCED_S = 5.5        # of the end of such a flight, in which nothing else happens
REBOOTS = 0.25          # of flights
STOPS_BESIDE = 0.3      # of flights: somebody on board stops everything, beside ground and its telecommands
MOST_STRIKES = 2        # of a member in one flight by what may end it: who dies too often stays down
# Of every subsystem, beside those of its descriptor: states, failures, lost devices and stale sets.
FRAMEWORK_EVENTS = [*range(0xF000, 0xF006), *range(0xF100, 0xF103), *range(0xF200, 0xF204)]
# The states that last; the others are passed in one instant of virtual time. Down first, whatever state there is.
DOWN = [SAFE, OFFLINE]
WAY_TO = {OFFLINE: DOWN, PRE: [*DOWN, PRE], SAFE: [*DOWN, PRE, "CONFIGURE", "LINKS", SAFE],
          OPERATIONAL: [*DOWN, PRE, "CONFIGURE", "LINKS", SAFE, OPERATIONAL], ERROR: [*DOWN, PRE, "CONFIGURE", ERROR],
          POST: [*DOWN, PRE, "CONFIGURE", POST]}


def out_of_reach(mission):
    """{cell: why nothing can cover it}. A flight that covers one all the same is an error of this list."""
    return {f"Offline|{kind}|ground": f"ground's packets pass through {mission.ground}, which has no link to ground while it is Offline"
            for kind in mission.by_name(mission.ground).functions}


def commands_of(mission):
    """Cells: state of the addressee | kind | origin."""
    origins = ["ground", *(m.name for m in mission.members)]
    for state in WAY_TO:
        for origin in origins:
            for kind in COMMON + [f for m in mission.members for f in m.functions]:
                yield f"{STATES[state]}|{kind}|{origin}"
    for kind in [*mission.supervisor.functions, RETRIEVAL]:
        for origin in origins:
            yield f"Operational|{kind}|{origin}"


def faults_of(mission):
    """Cells: fault | state of the member | member."""
    members = [m.name for m in mission.members]
    acting = [m for m in members if m != mission.ground]
    its = OfMission.of(mission)
    for state in WAY_TO:
        for member in acting:
            for fault in MEMBER_FAULTS + [f"log {f}" for f in LOG_FAULTS] + ["flood valid", "flood damaged"]:
                yield f"{fault}|{STATES[state]}|{member}"
            for fault in DEVICE_FAULTS + its.faults.get(member, []) if member in its.with_device else []:
                yield f"fault {fault}|{STATES[state]}|{member}"
    for fault in MEMBER_FAULTS:
        yield f"{fault}|Operational|{mission.ground}"
    yield f"stop|Operational|{mission.supervisor.name}"


class Draw:
    def __init__(self, mission, seed, index, wanted_commands=(), wanted_faults=()):
        self.mission = mission
        self.random = random.Random(f"{seed}/{index}")
        self.index = index
        self.lines = []           # (time, words)
        self.struck = set()       # whom something was done to that may last
        self.wanted_commands, self.wanted_faults = list(wanted_commands), list(wanted_faults)
        self.acting = [m for m in mission.members if m.name != mission.ground]
        self.flight_seed = self.random.randrange(1, 1 << 32)
        self.its = OfMission.of(mission)
        self.mode = self.its.begins_in(self.random, self.wanted_faults)

    # --- values ------------------------------------------------------------------------------------------------------
    def argument(self, argument):
        """All values of one argument, as they stand on the wire."""
        return self.words(argument) if argument.type == "TEXT" else b"".join(self.value(argument) for _ in range(argument.count))

    def words(self, argument):
        """Mostly a text, of any length up to the declared one, then what is none."""
        r, most = self.random, argument.octets
        text = "".join(r.choice("ab \u20ac\U0001f680") for _ in range(r.choice([0, 1, most // 2, most]))).encode()[:most].decode(errors="ignore").encode()
        draw = r.random()
        if draw > 0.8:
            text = r.choice([b"x" * most, b"x" * (most + 1), text[:-1] + b"\xff", b"\0" + text[1:], b"\xed\xa0\x80", b"\xe2\x82"])
        octets = len(text) if draw < 0.97 else r.choice([0, len(text) + 1, 65535])
        return struct.pack(">H", octets) + text

    def stored_words(self, field):
        """A text as a parameter has it: as many octets as are declared, zeros behind the words. Mostly; then words behind the zeros, and what is no text."""
        return self.random.choice([b"a", b"a" * field.octets, "\u20ac".encode(), b"", b"", b"\0a", b"\xff"])[:field.octets].ljust(field.octets, b"\0")

    def value(self, argument):
        """Mostly in range, then its corners, just beside them, and what no honest sender sends."""
        if argument.values is not None:
            honest = self.random.random() < 0.8
            return pack(argument.type, self.random.choice(sorted(argument.values)) if honest else self.random.randrange(-3, 260))
        if argument.type in ("UINT64", "INT64"):
            return self.whole(argument)
        low = argument.minimum if argument.minimum is not None else {"D": -1e6, "F": -1e6}.get(argument.type[:1], 0)
        high = argument.maximum if argument.maximum is not None else {"D": 1e6, "F": 1e6}.get(argument.type[:1], 255)
        draw = self.random.random()
        if draw < 0.55:
            value = self.random.uniform(low, high)
        elif draw < 0.8:
            value = self.random.choice([low, high])
        elif draw < 0.9:
            value = self.random.choice([low - 1, high + 1, low - 1e-9, high + 1e-9, 0, -0.0])
        else:
            value = self.random.choice([float("nan"), float("inf"), -float("inf"), 1e300, 255, 1e-300])
        return pack(argument.type, value)

    def whole(self, argument):
        """Of 64 bits, where a double would lose digits."""
        r = self.random
        ends = (0, 2**64 - 1) if argument.type == "UINT64" else (-2**63, 2**63 - 1)
        low, high = (int(end if given is None else given) for given, end in zip((argument.minimum, argument.maximum), ends))
        near = r.choice([low, high, low - 1, high + 1, 2**53 + 1, -2**53 - 1, low + 1, high - 1])
        value = r.randint(low, high) if r.random() < 0.5 else min(max(near, ends[0]), ends[1])
        return struct.pack(">Q", value % 2**64)

    def call(self, name, arguments):
        data = name.encode()[:16].ljust(16, b"\0")
        number = len(arguments)
        if self.random.random() < 0.04:
            number = self.random.randrange(0, 9)
        data += bytes([number])
        for place, argument in enumerate(arguments[:number], 1):
            data += bytes([place if self.random.random() > 0.02 else self.random.randrange(256)]) + self.argument(argument)
        return data[:-1] if self.random.random() < 0.02 else data

    def parameter_write(self, subsystem):
        chosen = self.random.sample(subsystem.parameters, min(len(subsystem.parameters), self.random.choice([1, 1, 1, 2, 3])))
        data = bytes([len(chosen)])
        for parameter in chosen:
            data += struct.pack(">I", parameter.wire_id if self.random.random() > 0.03 else self.random.getrandbits(32))
            for field in parameter.fields:
                data += self.stored_words(field) if field.type == "TEXT" else b"".join(self.value(field) for _ in range(field.count))
        return data

    def data_of(self, kind, subsystem):
        """(service, subtype, application data)"""
        r = self.random
        structures = [h for c in subsystem.configurations.values() for h in c.housekeeping] or [1]
        ids = lambda values, width: bytes([len(values)]) + b"".join(v.to_bytes(width, "big") for v in values)
        some_ids = lambda: r.sample([p.wire_id for p in subsystem.parameters], min(len(subsystem.parameters), r.randrange(1, 5)))
        if "." in kind:
            service, subtype = map(int, kind.split("."))
            if r.random() < 0.1:
                return service, subtype, r.randbytes(r.randrange(0, 40))
            if (service, subtype) in ((3, 1), (3, 29)):
                return service, subtype, (struct.pack(">HI", r.choice([9000, 9001, structures[0]]), r.choice([1, 2, 100, 2000]))
                                          + ids(some_ids(), 4) + bytes([0]))
            if service == 3 and subtype == 31:
                return service, subtype, bytes([1]) + struct.pack(">HI", r.choice(structures), r.choice([1, 10, 1000]))
            if service == 3:
                return service, subtype, ids([r.choice([*structures, 9000])], 2)
            if service == 5 and subtype != 7:
                return service, subtype, ids([r.choice([*subsystem.events, *FRAMEWORK_EVENTS])], 2)
            if (service, subtype) == (20, 1):
                return service, subtype, ids(some_ids(), 4)
            if (service, subtype) == (20, 3):
                return service, subtype, self.parameter_write(subsystem)
            if service == 128:
                return service, subtype, r.randbytes(r.choice([1, 4, 20]))
            if kind == RETRIEVAL:
                return service, subtype, retrieval.data(r)
            return service, subtype, b""
        if kind == "SET_STATE":
            return 8, 1, b"SET_STATE".ljust(16, b"\0") + bytes([1, 1, r.choice([*range(10), OPERATIONAL, OFFLINE, PRE, 255])])
        if kind == "CONFIGURE":
            return 8, 1, b"CONFIGURE".ljust(16, b"\0") + bytes([1, 1, r.choice([*subsystem.configurations, 0, 99])])
        if kind == "unknown":
            return 8, 1, r.choice([b"NOBODY_HAS_IT".ljust(16, b"\0") + b"\0", r.randbytes(17), b"HOL"])
        return 8, 1, self.call(kind, subsystem.functions[kind].arguments)

    # --- actions -----------------------------------------------------------------------------------------------------
    def add(self, time, text):
        if BEGIN_S <= time < FINALE_S:
            self.lines.append((round(time, 6), text))

    def telecommand(self, time, origin, subsystem, kind, data=None):
        service, subtype, octets = self.data_of(kind, subsystem) if data is None else (8, 1, data)
        ack = 15 if self.random.random() < 0.8 else self.random.randrange(16)
        words = f"tc {origin} {subsystem.apid} {service} {subtype} {ack}" + (f" {octets.hex()}" if octets else "")
        self.add(time, f"{words}  # {subsystem.name} {kind}")

    def send_random(self, time, kind=None, origin=None, member=None):
        r, mission = self.random, self.mission
        origin = origin or r.choice(["ground"] * 3 + [m.name for m in mission.members])
        if member is None:
            member = r.choice([mission.supervisor, *mission.members * 2])
        if kind is None:
            kind = r.choice(COMMON + list(member.functions) * 2)
        if kind == "SHUTDOWN" and r.random() < 0.97:
            kind = "SAFE_ALL"
        owner = next((s for s in [mission.supervisor, *mission.members] if kind in s.functions), member)
        if r.random() < 0.02:
            octets = r.choice([r.randbytes(r.randrange(0, 60)), b"\x1f\xff" + r.randbytes(12)])
            return self.add(time, f"raw {origin} {octets.hex() or '00'}")
        return self.telecommand(time, origin, owner, kind)

    def function(self, time, subsystem, name, *arguments):
        """A telecommand of ground to a function with arguments of one octet."""
        data = name.encode().ljust(16, b"\0") + bytes([len(arguments), *(octet for pair in enumerate(arguments, 1) for octet in pair)])
        self.telecommand(time, "ground", subsystem, name, data)

    def drive(self, time, state, mode=None):
        """Ground brings all who act into a state, step by step, 30 ms each, as they are in `mode`. Where it has no links, those of the usual one are asked
        for: a configuration without them refuses them."""
        mission = self.mission
        mode = mode or self.random.choice(self.its.driven)
        self.function(time, mission.supervisor, "SET_MODE", mission.mode_ids[mission.initial_mode])
        if mission.budget_W is not None:
            full = b"SET_POWER_BUDGET" + bytes([1, 1]) + struct.pack(">f", mission.budget_W)
            self.telecommand(time + 0.01, "ground", mission.supervisor, "SET_POWER_BUDGET", full)
        for step in WAY_TO[state]:
            time += 0.03
            if step == "LINKS":
                for link in self.its.links_in(mode):
                    self.function(time, mission.supervisor, "LINK", link)
                continue
            for member in self.acting:
                if step == "CONFIGURE":
                    self.function(time, member, "CONFIGURE", self.its.configuration_in(mode, member))
                else:
                    self.function(time, member, "SET_STATE", step)
        return time + 0.05

    def drive_ground_link(self, time, state):
        """The member that carries the ground link into a state; from Offline it comes back by itself."""
        way = {PRE: [SAFE, POST, PRE], SAFE: [SAFE], ERROR: [ERROR], POST: [SAFE, POST], OFFLINE: [SAFE, POST, OFFLINE]}[state]
        mission = self.mission
        self.function(time, mission.supervisor, "SET_MODE", mission.mode_ids[mission.initial_mode])
        for step in way:
            time += 0.05
            self.function(time, mission.by_name(mission.ground), "SET_STATE", step)
        return time + 0.05

    def bring_up(self, time):
        """All who act, by ground, as an operator would."""
        mission = self.mission
        if self.random.random() < 0.5:
            self.function(time, mission.supervisor, "SAFE_ALL")
        return self.drive(time, OPERATIONAL, self.its.usual)

    def calm(self, time):
        """Ends what was injected so far."""
        for device, (owner, _) in self.mission.devices.items():
            if owner in self.struck:
                self.add(time, f"fault {device} heal")
                self.add(time, f"fault {device} plug")
        for member in self.mission.members:
            if member.name in self.struck:
                self.add(time, f"go {member.name}")
                self.add(time, f"unstick {member.name}")
        if "LOG" in self.struck:
            self.add(time, "log heal")
            self.function(time + 0.01, self.mission.supervisor, "SET_DATABASE", 1)
        self.struck.clear()

    def fault(self, time, fault, member, durations=(0.005, 0.05, 0.3, 1.0, 3.0)):
        """One fault, and mostly its end some time later."""
        r = self.random
        lasts = r.choice(durations)
        self.struck.add("LOG" if fault.startswith("log ") else member)
        if fault.startswith("fault "):
            device = next(d for d, (owner, _) in self.mission.devices.items() if owner == member)
            what = fault.split()[1]
            words = {"stall": f"stall {r.choice([1, 3, 50, 500])}", "freeze": f"freeze {r.choice([1, 3, 50, 5000])}",
                     "corrupt": f"corrupt {r.choice([1, 3, 50, 1000000])}", "delay": f"delay {r.choice([1, 5, 100])}",
                     **self.its.lines(r)}.get(what, what)
            self.add(time, f"fault {device} {words}")
            if what in DEVICE_FAULTS and r.random() < 0.8:
                self.add(time + lasts, f"fault {device} {'plug' if what == 'unplug' else 'heal'}")
        elif fault.startswith("log "):
            what = fault.split()[1]
            self.add(time, f"log {what}" + (f" {r.choice([5, 100, 1000, 3000])}" if what == "slow" else ""))
            if r.random() < 0.8:
                self.add(time + lasts, "log heal")
                if what in ("failing", "full", "deleted"):
                    self.telecommand(time + lasts + 0.05, "ground", self.mission.supervisor, "SET_DATABASE",
                                     b"SET_DATABASE".ljust(16, b"\0") + bytes([1, 1, 1]))
        elif fault.startswith("flood "):
            self.add(time, f"flood {r.choice(['ground', *(m.name for m in self.mission.members)])} {fault.split()[1]} {r.choice([20, 100, 400])}")
            if r.random() < 0.5:
                self.telecommand(time, "ground", self.mission.supervisor, "SAFE_ALL", b"SAFE_ALL".ljust(16, b"\0") + bytes([0]))
        else:
            self.add(time, f"{fault} {member}" + (f" {r.choice([1, 2, 3, 4, 10])} {r.choice([600, 2000, 30000])}" if fault == "strain" else ""))
            if fault == "stop" and r.random() < 0.8:
                self.add(time + lasts, f"go {member}")
            if fault == "stick" and r.random() < 0.8:
                self.add(time + lasts, f"unstick {member}")

    # --- a flight ----------------------------------------------------------------------------------------------------
    def aim(self):
        """At the emptiest cells: drives the craft into the state and does there what is wanting. When it is done."""
        r = self.random
        time = BEGIN_S + 0.3
        by_state = {}
        for cell in self.wanted_commands:
            state, kind, _ = cell.split("|")
            by_state.setdefault((state, kind in self.mission.by_name(self.mission.ground).functions), []).append(cell)
        ends = [cell for cell in self.wanted_commands if "|SHUTDOWN|ground" in cell]
        strikes = {}
        episodes = [(0.1 if state == "Operational" else r.random(), self.send_there, (state, of_ground_link, cells))
                    for (state, of_ground_link), cells in by_state.items()]
        for cell in self.wanted_faults:
            fault, state, member = cell.split("|")
            what = fault.split()[-1]
            strikes[member] = strikes.get(member, 0) + (what in MEMBER_FAULTS)
            # What may end a process comes last.
            rank = 0 if fault in self.its.first else r.uniform(2, 3) if what in MEMBER_FAULTS else r.uniform(0, 2)
            if what not in MEMBER_FAULTS or strikes[member] <= MOST_STRIKES:
                episodes.append((rank, self.strike_there, (fault, state, member)))
        for _, episode, what in sorted(episodes, key=lambda entry: entry[0]):
            if time > FINALE_S - 3:
                break
            if r.random() < 0.9:
                self.calm(time)
            time = episode(time + 0.03, *what)
        if ends:
            self.telecommand(FINALE_S - r.uniform(0.02, 0.5), "ground", self.mission.supervisor, "SHUTDOWN")
        return time

    def send_there(self, time, state, of_ground_link, cells):
        r, mission = self.random, self.mission
        drive = self.drive_ground_link if of_ground_link and state != "Operational" else self.drive
        time = drive(time, STATES.index(state))
        for cell in cells:
            _, kind, origin = cell.split("|")
            if kind == "SHUTDOWN" and origin == "ground":
                continue
            owner = next((s for s in [mission.supervisor, *mission.members] if kind in s.functions), r.choice(self.acting))
            self.telecommand(time, origin, mission.supervisor if kind == RETRIEVAL else owner, kind)
            time += r.choice([0.0, 0.001, 0.004])
            if kind in ("SET_STATE", "CONFIGURE"):
                time = drive(time + 0.01, STATES.index(state))
        if drive == self.drive_ground_link:
            if STATES.index(state) != OFFLINE:
                time = self.drive_ground_link(time + 0.05, OFFLINE)
            time += 1.3
        return time + r.uniform(0.05, 0.2)

    def strike_there(self, time, fault, state, member):
        time = self.drive(time, STATES.index(state))
        self.fault(time, fault, member, (0.005, 0.05, 0.3))
        return time + LEFT_ALONE_S.get(fault.split()[-1], 0.1) + self.random.uniform(0, 0.2)

    def roam(self, begin=0.3):
        """Whatever, whenever; faults come alone, in pairs, and into a recovery that is under way."""
        r, mission = self.random, self.mission
        for _ in range(r.choice([20, 80, 200])):
            self.send_random(r.uniform(BEGIN_S, FINALE_S))
        for _ in range(r.choice([1, 2, 4])):
            time = r.uniform(min(begin, FINALE_S - 5), FINALE_S - 2)
            for _ in range(r.choice([1, 1, 2, 3])):
                cell = r.choice(list(faults_of(mission)))
                fault, _, struck = cell.split("|")
                self.fault(time, fault, struck)
                time += r.choice([0.0, 0.0005, 0.002, 0.004, 0.05, 0.5])
            if r.random() < 0.6:
                self.bring_up(time + r.uniform(0.5, 3))

    def strike_in_use(self):
        """The craft is up, ground silences events or commands SAFE_ALL in a hurry, then something breaks."""
        r, mission = self.random, self.mission
        time = self.bring_up(r.uniform(0.5, FINALE_S - 4))
        victim = r.choice(self.acting)
        if r.random() < 0.5:
            self.silence(time + 0.05, victim)
        what = r.choice(["fault unplug", "kill", "stop", "strain", "SAFE_ALL", "SUPERVISOR", "late", "twice", "twice"])
        if what in ("fault unplug", "twice") and victim.name not in self.its.with_device:
            what = "kill"         # it has no device that could be lost
        safe_all = lambda at: self.function(at, mission.supervisor, "SAFE_ALL")
        if what == "SUPERVISOR":  # may anybody change the state of the supervisor itself?
            for state in (ERROR, POST):
                self.function(time, mission.supervisor, "SET_STATE", state)
                time += 0.04
            safe_all(time)
        elif what == "SAFE_ALL":
            safe_all(time + 0.02)
        elif what == "twice":     # who loses its device dies while the plan for that runs
            self.fault(time + 0.3, "fault unplug", victim.name)
            later = r.uniform(0.001, 0.004) if r.random() < 0.7 else r.uniform(0, 0.05)
            self.add(time + 0.3 + later, f"{r.choice(['kill', 'kill', 'kill', 'spin', 'stop'])} {victim.name}")
        elif what == "late":      # what waits for a slow disk is overtaken by SAFE_ALL, and asked for again after it
            self.add(time + 0.1, "log slow 1000")
            self.struck.add("LOG")
            self.function(time + 0.12, victim, "SET_STATE", SAFE)
            self.function(time + 0.15, victim, "SET_STATE", OPERATIONAL)
            safe_all(time + r.uniform(0.152, 0.25))
            self.function(time + r.uniform(0.4, 0.9), victim, "SET_STATE", OPERATIONAL)
            self.calm(time + 2)
        else:
            self.fault(time + 0.3, what, victim.name)

    def strike_silenced(self):
        """Nothing else happens: ground silences every event by which a recovery hears of a lost device, and it is unplugged."""
        begin = FINALE_S - SILENCED_S
        self.lines = [line for line in self.lines if line[0] < begin]
        self.struck = {"LOG", *(member.name for member in self.mission.members)}
        self.calm(begin)
        time = self.drive(begin + 1.0, OPERATIONAL, self.its.usual)  # who died is back by then
        with_device = [member for member in self.acting if member.name in self.its.with_device]
        if not with_device:
            return
        victim = with_device[self.index // SILENCED_EVERY % len(with_device)]
        self.silence(time + 0.05, victim)
        device = next(device for device, (owner, _) in self.mission.devices.items() if owner == victim.name)
        self.add(time + 0.3, f"fault {device} unplug")
        self.struck.add(victim.name)

    def silence(self, time, victim):
        for event in [*victim.events, *FRAMEWORK_EVENTS]:
            self.add(time, f"tc ground {victim.apid} 5 6 15 01{event:04x}  # {victim.name} no report of {event}")

    def hear(self, time, member):
        """What ground silenced before it hears again."""
        for event in [*member.events, *FRAMEWORK_EVENTS]:
            self.add(time, f"tc ground {member.apid} 5 5 15 01{event:04x}  # {member.name} report of {event}")

    def ask_again(self):
        """Some flights ask for what was said before. By a dice of its own: whatever else is drawn stays as it is."""
        dice = random.Random(f"retrieval of {self.flight_seed}")
        for time, origin, words in retrieval.asked(dice, self.mission, BEGIN_S, FINALE_S):
            self.add(time, f"{words}  # {origin} asks again")

    def reboot(self):
        """In some flights the craft is brought up and one of its devices reboots. By a dice of its own, too, and drawn last."""
        dice = random.Random(f"reboot of {self.flight_seed}")
        if dice.random() < REBOOTS and self.index % SILENCED_EVERY != SILENCED_AT and self.mission.devices:
            device = dice.choice(list(self.mission.devices))
            time = self.bring_up(dice.uniform(1, FINALE_S - 4)) + dice.uniform(0.1, 0.6)
            self.add(time, f"fault {device} reboot")
            self.add(time + 0.3, f"fault {device} heal")

    def stop_beside(self):
        """In some flights somebody presses the key, up to three times, mostly in the middle of something. By a dice of its own, drawn last."""
        dice = random.Random(f"stops beside {self.flight_seed}")
        if dice.random() >= STOPS_BESIDE or self.index % SILENCED_EVERY == SILENCED_AT:
            return
        crossed = [time for time, _ in self.lines if 0.5 < time < FINALE_S - 1]
        for _ in range(dice.choice([1, 1, 2, 3]) if crossed else 0):
            self.add(dice.choice(crossed) + dice.choice([0.0, 0.0002, 0.001, 0.002, 0.005, 0.02]), "safe")

    # --- all of it ---------------------------------------------------------------------------------------------------
    def text(self):
        aimed = self.aim() if self.wanted_commands or self.wanted_faults else 0.3
        self.roam(self.random.choice([0.3, aimed, aimed]))
        self.strike_in_use()
        self.ask_again()
        self.reboot()
        self.stop_beside()
        if self.index % SILENCED_EVERY == SILENCED_AT:
            self.strike_silenced()
        elif losses.loses(self):
            losses.lose_supervisor(self, BEGIN_S, FINALE_S)
        self.lines.sort(key=lambda line: line[0])
        head = [f"seed {self.flight_seed}", f"mode {self.mode}", f"finale {FINALE_S}", *([" ".join(["ends", *self.its.ends])] if self.its.ends else [])]
        return "\n".join(head + [f"{time:.6f} {words}" for time, words in self.lines]) + "\n"


def pack(kind, value):
    octets = 1 if kind == "BOOL" else TYPES[kind][1] if kind in TYPES and kind != "STRUCT" else 8
    if kind == "DOUBLE":
        return struct.pack(">d", value)
    if kind == "FLOAT":
        try:
            return struct.pack(">f", value)
        except OverflowError:
            return struct.pack(">f", float("inf"))
    if value != value or abs(value) == float("inf"):
        value = (1 << 8 * octets) - 1
    return (int(max(-2.0**63, min(value, 2.0**63))) & ((1 << 8 * octets) - 1)).to_bytes(octets, "big")
