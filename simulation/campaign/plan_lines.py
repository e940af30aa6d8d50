# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The lines of a plan: what ground says and what breaks, each at its time. Some of them are several, for what takes steps."""
import struct

from descriptors import ERROR, OFFLINE, OPERATIONAL, POST, PRE, SAFE
from of_mission import OfMission
from telecommand_data import FRAMEWORK_EVENTS, TelecommandData

FINALE_S = 26.0
BEGIN_S = 0.1           # commissioned by then
DEVICE_FAULTS = ["unplug", "silent", "stall", "freeze", "corrupt", "delay"]
# The states that last; the others are passed in one instant of virtual time. Down first, whatever state there is.
DOWN = [SAFE, OFFLINE]
WAY_TO = {OFFLINE: DOWN, PRE: [*DOWN, PRE], SAFE: [*DOWN, PRE, "CONFIGURE", "LINKS", SAFE],
          OPERATIONAL: [*DOWN, PRE, "CONFIGURE", "LINKS", SAFE, OPERATIONAL], ERROR: [*DOWN, PRE, "CONFIGURE", ERROR],
          POST: [*DOWN, PRE, "CONFIGURE", POST]}


class PlanLines:
    def __init__(self, mission, random):
        self.mission, self.random = mission, random
        self.lines = []           # (time, words)
        self.struck = set()       # whom something was done to that may last
        self.acting = [m for m in mission.members if m.name != mission.ground]
        self.its = OfMission.of(mission)
        self.data = TelecommandData(random)

    def add(self, time, text):
        if BEGIN_S <= time < FINALE_S:
            self.lines.append((round(time, 6), text))

    def telecommand(self, time, origin, subsystem, kind, data=None):
        service, subtype, octets = self.data.of(kind, subsystem) if data is None else (8, 1, data)
        ack = 15 if self.random.random() < 0.8 else self.random.randrange(16)
        words = f"tc {origin} {subsystem.apid} {service} {subtype} {ack}" + (f" {octets.hex()}" if octets else "")
        self.add(time, f"{words}  # {subsystem.name} {kind}")

    def function(self, time, subsystem, name, *arguments):
        """A telecommand of ground to a function with arguments of one octet."""
        data = name.encode().ljust(16, b"\0") + bytes([len(arguments), *(octet for pair in enumerate(arguments, 1) for octet in pair)])
        self.telecommand(time, "ground", subsystem, name, data)

    def exchange(self, time, member, name, *arguments):
        """REREAD, REPLACE, CONFIRM or TAKE_BACK of a member."""
        data = name.encode().ljust(16, b"\0") + bytes([1 + len(arguments), 1]) + struct.pack(">H", member.apid)
        for place, given in enumerate(arguments, 2):
            words = given.encode() if isinstance(given, str) else b""
            data += bytes([place]) + struct.pack(">H", len(words) if isinstance(given, str) else given) + words
        self.add(time, f"tc ground {self.mission.supervisor.apid} 8 1 15 {data.hex()}  # {member.name} {name} {' '.join(map(str, arguments))}".rstrip())

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

    def silence(self, time, victim):
        for event in [*victim.events, *FRAMEWORK_EVENTS]:
            self.add(time, f"tc ground {victim.apid} 5 6 15 01{event:04x}  # {victim.name} no report of {event}")

    def hear(self, time, member):
        """What ground silenced before it hears again."""
        for event in [*member.events, *FRAMEWORK_EVENTS]:
            self.add(time, f"tc ground {member.apid} 5 5 15 01{event:04x}  # {member.name} report of {event}")
