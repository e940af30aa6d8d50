# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the members of a mission were told by telecommand, and what ground can read back of it: state, configuration, a parameter, the interval of a
structure, an event that is not reported, links and how old their samples are."""
import dataclasses
import pathlib
import struct
import time
import xml.etree.ElementTree as xml

import flight
from operators import SUPERVISOR, Operator

OPERATIONAL, SAFE_OPERATIONAL = 5, 4
ROWS = 16                         # of the supervisor's tables in housekeeping
SUBSYSTEMS, LINK_QUALITY = 4702, 4703
ANY_NUMBER = 0


@dataclasses.dataclass(frozen=True)
class Settings:
    """Of one member, beside its state."""
    name: str
    apid: int
    structure: int
    interval: int                 # in cycles
    event: int
    parameter: int = ANY_NUMBER   # its id on the wire: subsystem, layout DOUBLE, number
    value: float = 0.0


def double(apid, number):
    return apid << 16 | 10 << 8 | number


def columns(data, form):
    """The columns of a table of the supervisor's, of one letter of `struct` each."""
    place, found = 0, []
    for letter in form:
        row = struct.Struct(f">{ROWS}{letter}")
        found.append(row.unpack_from(data, place))
        place += row.size
    return found


class Ground:
    """Asks; may be cut off and come again."""

    def __init__(self):
        self.come_again()

    def come_again(self):
        self.operator = Operator().__enter__()

    def leave(self):
        self.operator.__exit__()

    def send(self, apid, service, subtype, data=b""):
        self.operator.apid = apid
        return self.operator.send(service, subtype, data)

    def answer(self, apid, ask, answer, data=b""):
        """What a member says to a request of (service, subtype), which it carries out."""
        self.operator.forget()
        if (end := self.send(apid, *ask, data)) != 7:
            raise AssertionError(f"TC{ask} to {apid} ends with TM[1,{end}]")
        return self.operator.newest(*answer)

    def housekeeping(self, apid, structure, seconds=5.0):
        """The next report of a structure, without its id."""
        self.operator.apid = apid
        self.operator.forget()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := self.operator.sampled(structure):
                return found[-1]
            time.sleep(0.01)
        raise AssertionError(f"no housekeeping {structure} of {apid} in {seconds:g} s")

    # Settings.

    def make(self, settings):
        for service, subtype, data in ((3, 31, struct.pack(">BHI", 1, settings.structure, settings.interval)),
                                       (5, 6, struct.pack(">BH", 1, settings.event))):
            if self.send(settings.apid, service, subtype, data) != 7:
                raise AssertionError(f"{settings.name} refuses TC[{service},{subtype}]")

    def put(self, settings):
        """A parameter, which is set where nothing moves."""
        data = struct.pack(">BId", 1, settings.parameter, settings.value)
        if self.send(settings.apid, 20, 3, data) != 7:
            raise AssertionError(f"{settings.name} refuses a value")

    def read(self, settings):
        """{what: how it is} of one member and its settings."""
        found = {f"{settings.name}'s interval of {settings.structure}":
                     self.answer(settings.apid, (3, 33), (3, 35), struct.pack(">BH", 1, settings.structure)).hex(),
                 f"{settings.name}'s events that are off": self.answer(settings.apid, (5, 7), (5, 8)).hex()}
        if settings.parameter != ANY_NUMBER:
            found[f"{settings.name}'s parameter"] = self.answer(settings.apid, (20, 1), (20, 2), struct.pack(">BI", 1, settings.parameter)).hex()
        return found

    def overview(self):
        """The same of states, configurations and links, as the supervisor tells."""
        data = self.housekeeping(SUPERVISOR, SUBSYSTEMS)
        apids, states, configurations, inhibited, *_, links, up = columns(data[1:], "HBBBIIIIIIBB")
        found = {"mode": data[0]}
        for apid, *how in zip(apids, states, configurations, inhibited):
            if apid:
                found.update(zip((f"{apid}'s state", f"{apid}'s configuration", f"{apid}'s inhibition"), how))
        found.update({f"link {link}": "up" if is_up else "down" for link, is_up in zip(links, up) if link})
        return found

    def ages_us(self):
        """{link: from the newest sample to the newest cycle of its consumer, as that one tells}."""
        links, *_, ages = columns(self.housekeeping(SUPERVISOR, LINK_QUALITY), "BIIIII")
        return {link: age for link, age in zip(links, ages) if link}


def differences(before, after):
    """Complaints."""
    return [f"{what}: {before.get(what)} before, {after.get(what)} after" for what in sorted({*before, *after}) if before.get(what) != after.get(what)]


def stale(ages_us, limits_us):
    """Complaints: links that bring nothing, or nothing in time."""
    return [f"link {link}: {ages_us.get(link)} us old, at most {limit} us" for link, limit in limits_us.items()
            if ages_us.get(link) is None or ages_us[link] > limit]


def limits_us(mission, configurations, realtime):
    """{link: how old its newest sample may be at its consumer}, of links that are required in `configurations`, {member: name}. One that came in time
    for a cycle is up to a cycle old there."""
    tree, found = xml.parse(mission).getroot(), {}
    described = {}
    for member in tree.iter("Subsystem"):
        descriptor = xml.parse(pathlib.Path(mission).parent / member.get("descriptor")).getroot()
        described[member.get("name") or descriptor.get("name")] = descriptor
    for link in tree.find("Links"):
        consumer, port = link.get("to").split(".")
        for configuration in described[consumer].iter("Configuration"):
            wanted = configuration.find(f"RealTimeLinkService/Requires[@name='{port}']")
            if configuration.get("name") == configurations.get(consumer) and wanted is not None:
                cycles = int(wanted.get("age" if realtime[consumer] else "age_reduced"))
                found[int(link.get("id"))] = (cycles + 1) * int(configuration.get("sampling_us"))
    return found


MANIPULATOR = Settings("MANIPULATOR", flight.MANIPULATOR, 4711, 1000, 1006, double(flight.MANIPULATOR, 8), 0.9)
JOYSTICK = Settings("JOYSTICK", flight.JOYSTICK, 4721, 1000, 1103, double(flight.JOYSTICK, 2), 0.03)
COMMUNICATION = Settings("COMMUNICATION", 2, 4731, 200, 203)
