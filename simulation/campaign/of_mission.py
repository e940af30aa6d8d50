# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What random flights take from a mission: its modes with their configurations and links, who has a device, and what campaign.py of its folder says."""
import functools, importlib.util

# What campaign.py may say, each of it left out where the mission has nothing of the kind.
NOTHING_SAID = {
    "FAULTS": {},                # by member: faults of its own devices besides those that all take
    "lines": lambda random: {},  # the line of each of these, with numbers drawn
    "FIRST": [],                 # those that come before all else of a flight
    "HOOKED": None,              # the mode that a flight with one of these begins in
    "MOSTLY": None,              # the mode that most flights begin in
    "DRIVEN": [],                # modes as which ground brings the craft up by hand, each as often as it stands there, the usual one first
    "RESTS": [],                 # lines to each device by which what the mission itself moves comes to rest
    "ENDS": [],                  # in which modes a flight ends: the first whose members all live
}


def said_in(folder):
    file = folder / "campaign.py"
    if not file.exists():
        return NOTHING_SAID
    spec = importlib.util.spec_from_file_location("campaign_of_mission", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return NOTHING_SAID | vars(module)


class OfMission:
    def __init__(self, mission, said):
        self.mission = mission
        self.faults, self.lines, self.rests, self.ends = said["FAULTS"], said["lines"], said["RESTS"], said["ENDS"]
        self.first = {f"fault {what}" for what in said["FIRST"]}
        self._first_mode, self._mostly = said["HOOKED"], said["MOSTLY"]
        # Those in which somebody acts; a mission that has none flies in the one that it begins in.
        self.flown = [mode for mode in mission.modes if mode != mission.initial_mode and mission.commissions.get(mode)] or [mission.initial_mode]
        self.driven = said["DRIVEN"] or ([self._mostly] if self._mostly else []) + self.flown
        self.usual = self.driven[0]
        self.with_device = {member for member, _ in mission.devices.values()}
        if unknown := sorted({*self.driven, *self.ends, *filter(None, (self._mostly, self._first_mode))} - {*mission.modes}):
            raise SystemExit(f"{mission.folder / 'campaign.py'}: the mission has no mode {', '.join(unknown)}; it has {', '.join(mission.modes)}")

    @staticmethod
    def of(mission):
        return OfMission(mission, read_once(mission.folder))

    def begins_in(self, random, wanted_faults):
        """The mode of a flight."""
        if self._first_mode and any(cell.split("|")[0] in self.first for cell in wanted_faults):
            return self._first_mode
        return random.choice([self._mostly] * 3 + self.flown if self._mostly else self.flown)

    def configuration_in(self, mode, member):
        """Id of the one that the mode commissions, or, whom it leaves out, the first one that any mode does."""
        commissions = self.mission.commissions
        names = [commissions[each][member.name] for each in (mode, *commissions) if member.name in commissions.get(each, {})]
        return next((c.id for name in names for c in member.configurations.values() if c.name == name), min(member.configurations, default=1))

    def links_in(self, mode):
        """Those of the mode; of one without any those of the usual one, which configurations without links refuse."""
        return self.mission.establishes.get(mode) or self.mission.establishes.get(self.usual, [])


read_once = functools.cache(said_in)
