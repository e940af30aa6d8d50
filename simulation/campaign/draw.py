# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Draws the plan of a flight from a seed: who is told what, and what breaks, at random instants."""
import pathlib, random, sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent / "judge"), str(pathlib.Path(__file__).resolve().parent)]
import exchanges, losses, retrieval  # noqa: E401, E402
from descriptors import ERROR, OFFLINE, OPERATIONAL, POST, SAFE, STATES  # noqa: E402
from of_mission import OfMission  # noqa: E402
from plan_lines import BEGIN_S, DEVICE_FAULTS, FINALE_S, WAY_TO, PlanLines  # noqa: E402
from telecommand_data import RETRIEVAL  # noqa: E402

COMMON = ["3.1", "3.3", "3.5", "3.6", "3.9", "3.27", "3.29", "3.31", "3.33", "5.5", "5.6", "5.7", "17.1", "20.1", "20.3",
          "128.1", "128.2", "128.3", "128.4", "129.1", "3.77", "99.1", "SET_STATE", "CONFIGURE", "unknown"]
MEMBER_FAULTS = ["kill", "stop", "spin", "stick", "strain"]
LOG_FAULTS = ["slow", "failing", "full", "deleted", "frozen"]
# How long the craft is left alone with a fault that was aimed: what ends or stops a process takes longest.
LEFT_ALONE_S = {**dict.fromkeys(DEVICE_FAULTS, 0.7), **dict.fromkeys(MEMBER_FAULTS, 1.6)}
SILENCED_EVERY, SILENCED_AT = 5, 3   # flights that end with an unplug that ground silenced (hazard SF6)
SILENCED_S = 5.5        # of the end of such a flight, in which nothing else happens
REBOOTS = 0.25          # of flights
STOPS_BESIDE = 0.3      # of flights: somebody on board stops everything, beside ground and its telecommands
MOST_STRIKES = 2        # of a member in one flight by what may end it: who dies too often stays down


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
        self.wanted_commands, self.wanted_faults = list(wanted_commands), list(wanted_faults)
        self.flight_seed = self.random.randrange(1, 1 << 32)
        self.plan = PlanLines(mission, self.random)
        self.mode = self.plan.its.begins_in(self.random, self.wanted_faults)

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
            return self.plan.add(time, f"raw {origin} {octets.hex() or '00'}")
        return self.plan.telecommand(time, origin, owner, kind)

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
            rank = 0 if fault in self.plan.its.first else r.uniform(2, 3) if what in MEMBER_FAULTS else r.uniform(0, 2)
            if what not in MEMBER_FAULTS or strikes[member] <= MOST_STRIKES:
                episodes.append((rank, self.strike_there, (fault, state, member)))
        for _, episode, what in sorted(episodes, key=lambda entry: entry[0]):
            if time > FINALE_S - 3:
                break
            if r.random() < 0.9:
                self.plan.calm(time)
            time = episode(time + 0.03, *what)
        if ends:
            self.plan.telecommand(FINALE_S - r.uniform(0.02, 0.5), "ground", self.mission.supervisor, "SHUTDOWN")
        return time

    def send_there(self, time, state, of_ground_link, cells):
        r, mission = self.random, self.mission
        drive = self.plan.drive_ground_link if of_ground_link and state != "Operational" else self.plan.drive
        time = drive(time, STATES.index(state))
        for cell in cells:
            _, kind, origin = cell.split("|")
            if kind == "SHUTDOWN" and origin == "ground":
                continue
            owner = next((s for s in [mission.supervisor, *mission.members] if kind in s.functions), r.choice(self.plan.acting))
            self.plan.telecommand(time, origin, mission.supervisor if kind == RETRIEVAL else owner, kind)
            time += r.choice([0.0, 0.001, 0.004])
            if kind in ("SET_STATE", "CONFIGURE"):
                time = drive(time + 0.01, STATES.index(state))
        if drive == self.plan.drive_ground_link:
            if STATES.index(state) != OFFLINE:
                time = self.plan.drive_ground_link(time + 0.05, OFFLINE)
            time += 1.3
        return time + r.uniform(0.05, 0.2)

    def strike_there(self, time, fault, state, member):
        time = self.plan.drive(time, STATES.index(state))
        self.plan.fault(time, fault, member, (0.005, 0.05, 0.3))
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
                self.plan.fault(time, fault, struck)
                time += r.choice([0.0, 0.0005, 0.002, 0.004, 0.05, 0.5])
            if r.random() < 0.6:
                self.plan.bring_up(time + r.uniform(0.5, 3))

    def strike_in_use(self):
        """The craft is up, ground silences events or commands SAFE_ALL in a hurry, then something breaks."""
        r, mission = self.random, self.mission
        time = self.plan.bring_up(r.uniform(0.5, FINALE_S - 4))
        victim = r.choice(self.plan.acting)
        if r.random() < 0.5:
            self.plan.silence(time + 0.05, victim)
        what = r.choice(["fault unplug", "kill", "stop", "strain", "SAFE_ALL", "SUPERVISOR", "late", "twice", "twice"])
        if what in ("fault unplug", "twice") and victim.name not in self.plan.its.with_device:
            what = "kill"         # it has no device that could be lost
        safe_all = lambda at: self.plan.function(at, mission.supervisor, "SAFE_ALL")
        if what == "SUPERVISOR":  # may anybody change the state of the supervisor itself?
            for state in (ERROR, POST):
                self.plan.function(time, mission.supervisor, "SET_STATE", state)
                time += 0.04
            safe_all(time)
        elif what == "SAFE_ALL":
            safe_all(time + 0.02)
        elif what == "twice":     # who loses its device dies while the plan for that runs
            self.plan.fault(time + 0.3, "fault unplug", victim.name)
            later = r.uniform(0.001, 0.004) if r.random() < 0.7 else r.uniform(0, 0.05)
            self.plan.add(time + 0.3 + later, f"{r.choice(['kill', 'kill', 'kill', 'spin', 'stop'])} {victim.name}")
        elif what == "late":      # what waits for a slow disk is overtaken by SAFE_ALL, and asked for again after it
            self.plan.add(time + 0.1, "log slow 1000")
            self.plan.struck.add("LOG")
            self.plan.function(time + 0.12, victim, "SET_STATE", SAFE)
            self.plan.function(time + 0.15, victim, "SET_STATE", OPERATIONAL)
            safe_all(time + r.uniform(0.152, 0.25))
            self.plan.function(time + r.uniform(0.4, 0.9), victim, "SET_STATE", OPERATIONAL)
            self.plan.calm(time + 2)
        else:
            self.plan.fault(time + 0.3, what, victim.name)

    def strike_silenced(self):
        """Nothing else happens: ground silences every event by which a recovery hears of a lost device, and it is unplugged."""
        begin = FINALE_S - SILENCED_S
        self.plan.lines = [line for line in self.plan.lines if line[0] < begin]
        self.plan.struck = {"LOG", *(member.name for member in self.mission.members)}
        self.plan.calm(begin)
        time = self.plan.drive(begin + 1.0, OPERATIONAL, self.plan.its.usual)  # who died is back by then
        with_device = [member for member in self.plan.acting if member.name in self.plan.its.with_device]
        if not with_device:
            return
        victim = with_device[self.index // SILENCED_EVERY % len(with_device)]
        self.plan.silence(time + 0.05, victim)
        device = next(device for device, (owner, _) in self.mission.devices.items() if owner == victim.name)
        self.plan.add(time + 0.3, f"fault {device} unplug")
        self.plan.struck.add(victim.name)

    def ask_again(self):
        """Some flights ask for what was said before. By a dice of its own: whatever else is drawn stays as it is."""
        dice = random.Random(f"retrieval of {self.flight_seed}")
        for time, origin, words in retrieval.asked(dice, self.mission, BEGIN_S, FINALE_S):
            self.plan.add(time, f"{words}  # {origin} asks again")

    def reboot(self):
        """In some flights the craft is brought up and one of its devices reboots. By a dice of its own, too, and drawn last."""
        dice = random.Random(f"reboot of {self.flight_seed}")
        if dice.random() < REBOOTS and self.index % SILENCED_EVERY != SILENCED_AT and self.mission.devices:
            device = dice.choice(list(self.mission.devices))
            time = self.plan.bring_up(dice.uniform(1, FINALE_S - 4)) + dice.uniform(0.1, 0.6)
            self.plan.add(time, f"fault {device} reboot")
            self.plan.add(time + 0.3, f"fault {device} heal")

    def stop_beside(self):
        """In some flights somebody presses the key, up to three times, mostly in the middle of something. By a dice of its own, drawn last."""
        dice = random.Random(f"stops beside {self.flight_seed}")
        if dice.random() >= STOPS_BESIDE or self.index % SILENCED_EVERY == SILENCED_AT:
            return
        crossed = [time for time, _ in self.plan.lines if 0.5 < time < FINALE_S - 1]
        for _ in range(dice.choice([1, 1, 2, 3]) if crossed else 0):
            self.plan.add(dice.choice(crossed) + dice.choice([0.0, 0.0002, 0.001, 0.002, 0.005, 0.02]), "safe")

    def text(self):
        aimed = self.aim() if self.wanted_commands or self.wanted_faults else 0.3
        self.roam(self.random.choice([0.3, aimed, aimed]))
        self.strike_in_use()
        self.ask_again()
        self.reboot()
        self.stop_beside()
        exchanges.add(self.plan, self.flight_seed, BEGIN_S, FINALE_S)
        if self.index % SILENCED_EVERY == SILENCED_AT:
            self.strike_silenced()
        elif losses.loses(self.flight_seed):
            losses.lose_supervisor(self.plan, self.flight_seed, BEGIN_S, FINALE_S)
        self.plan.lines.sort(key=lambda line: line[0])
        head = [f"seed {self.flight_seed}", f"mode {self.mode}", f"finale {FINALE_S}", *([" ".join(["ends", *self.plan.its.ends])] if self.plan.its.ends else [])]
        return "\n".join(head + [f"{time:.6f} {words}" for time, words in self.plan.lines]) + "\n"
