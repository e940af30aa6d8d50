# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the judge must know of mission and descriptors. An own reading: nothing here comes from the code it judges."""
import dataclasses, math, pathlib, struct
import xml.etree.ElementTree as xml

STATES = ["Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational",
          "ErrorOperational", "PostOperational", "HardwareDeinit", "SoftwareDeinit"]
OFFLINE, SOFTWARE_INIT, HARDWARE_INIT, PRE, SAFE, OPERATIONAL, ERROR, POST, HARDWARE_DEINIT, SOFTWARE_DEINIT = range(10)
TRANSIENT = {SOFTWARE_INIT, HARDWARE_INIT, HARDWARE_DEINIT, SOFTWARE_DEINIT}
# Figure 4 of the paper.
EDGES = {(OFFLINE, SOFTWARE_INIT), (SOFTWARE_INIT, HARDWARE_INIT), (SOFTWARE_INIT, SOFTWARE_DEINIT), (HARDWARE_INIT, PRE),
         (HARDWARE_INIT, HARDWARE_DEINIT), (PRE, SAFE), (PRE, POST), (PRE, ERROR), (SAFE, OPERATIONAL), (SAFE, POST),
         (SAFE, ERROR), (OPERATIONAL, SAFE), (OPERATIONAL, ERROR), (ERROR, POST), (POST, PRE), (POST, HARDWARE_DEINIT),
         (HARDWARE_DEINIT, SOFTWARE_DEINIT), (SOFTWARE_DEINIT, OFFLINE)}


def reachable_unseen(start, goal):
    """Whether `goal` follows `start` by edges that pass only through states that last no time of their own."""
    seen, front = set(), [start]
    while front:
        state = front.pop()
        for source, target in EDGES:
            if source != state or target in seen:
                continue
            if target == goal:
                return True
            seen.add(target)
            if target in TRANSIENT or target == POST:
                front.append(target)
    return False


FORMATS = {"UINT8": "B", "INT8": "b", "UINT16": "H", "INT16": "h", "UINT32": "I", "INT32": "i", "UINT64": "Q", "INT64": "q",
           "FLOAT": "f", "DOUBLE": "d", "BOOL": "B"}


@dataclasses.dataclass
class Argument:
    name: str
    type: str
    minimum: float | None
    maximum: float | None
    count: int = 1
    values: set | None = None  # of BOOL and of an enumeration: there are no others
    octets: int = 0            # of TEXT
    has_default: bool = False

    def stored_octets(self):
        """Of it as a parameter: a TEXT has zeros behind its words there."""
        return (self.octets if self.type == "TEXT" else TYPES[self.type][1]) * self.count

    def read(self, data, at):
        """(where the next one stands, whether this one is permitted); None instead of a place: the data end before."""
        if self.type == "TEXT":
            end = at + 2 + int.from_bytes(data[at:at + 2], "big")
            return (None, False) if at + 2 > len(data) or end > len(data) else (end, self.permits_text(data[at + 2:end]))
        form = f">{self.count}{FORMATS[self.type]}"
        end = at + struct.calcsize(form)
        return (None, False) if end > len(data) else (end, all(map(self.permits, struct.unpack(form, data[at:end]))))

    def permits(self, number):
        """Python compares integers and floats without rounding."""
        return (math.isfinite(number) and not (self.minimum is not None and number < self.minimum) and
                not (self.maximum is not None and number > self.maximum) and (self.values is None or number in self.values))

    def permits_text(self, words):
        try:
            return len(words) <= self.octets and "\0" not in words.decode()
        except UnicodeDecodeError:
            return False


@dataclasses.dataclass
class Function:
    name: str
    states: set
    essential: bool
    arguments: list

    def refusal(self, data):
        """Why the data of TC[8,1] are none that its descriptor permits: "length", "values", or None when they are."""
        if len(data) < 17:
            return "length"
        at, seen, good = 17, set(), True
        for _ in range(data[16]):
            if at >= len(data):
                return "length"
            place = data[at]
            if not 1 <= place <= len(self.arguments):
                return "values"  # how long it is nobody knows
            at, permitted = self.arguments[place - 1].read(data, at + 1)
            if at is None:
                return "length"
            good = good and permitted and place not in seen
            seen.add(place)
        if at != len(data):
            return "length"
        given = all(place in seen or each.has_default for place, each in enumerate(self.arguments, 1))
        return None if good and given else "values"


@dataclasses.dataclass
class Parameter:
    name: str
    wire_id: int
    fields: list
    writable: set | None
    protection: bool


@dataclasses.dataclass
class Required:
    name: str
    source: str
    required: bool
    age: int
    inhibits: bool


@dataclasses.dataclass
class Configuration:
    id: int
    name: str
    sampling_us: int
    requires: list
    devices: list
    housekeeping: list
    structures: dict   # id of a housekeeping report: names of what it has, of one sample each
    least_us: int | None  # of two cycles, where a sample starts one


@dataclasses.dataclass
class Subsystem:
    name: str
    apid: int
    functions: dict
    parameters: list
    events: dict       # id: (name, severity)
    configurations: dict
    actuators: set


@dataclasses.dataclass
class Mission:
    supervisor: Subsystem
    members: list
    ground: str
    modes: dict        # name: [(subsystem, functions, services, parameters)]
    mode_ids: dict
    initial_mode: str
    links: dict        # id: (from, to, required set)
    devices: dict      # simulated device: (member, device)
    high_plan: set     # what its recovery does about events of high severity
    folder: pathlib.Path = None
    commissions: dict = dataclasses.field(default_factory=dict)  # mode: {subsystem: configuration}
    establishes: dict = dataclasses.field(default_factory=dict)  # mode: ids of links
    budget_W: float | None = None
    losses: dict = dataclasses.field(default_factory=dict)  # id of a link: (what its loss does, for how long us, in which configuration)

    def by_apid(self, apid):
        if apid == self.supervisor.apid:
            return self.supervisor
        return next((member for member in self.members if member.apid == apid), None)

    def by_name(self, name):
        return next((s for s in [self.supervisor, *self.members] if s.name == name), None)


TYPES = {"UINT8": (1, 1), "INT8": (2, 1), "UINT16": (3, 2), "INT16": (4, 2), "UINT32": (5, 4), "INT32": (6, 4),
         "UINT64": (7, 8), "INT64": (8, 8), "FLOAT": (9, 4), "DOUBLE": (10, 8), "STRUCT": (32, 0), "BOOL": (33, 1), "TEXT": (34, 0)}


def number(element, name):
    text = element.get(name)
    if text is None:
        return None
    return int(text) if text.lstrip("+-").isdigit() else float(text)


def argument(element, enumerations):
    kind = element.get("type") or ""
    values = {0, 1} if kind == "BOOL" else enumerations.get(element.get("enumeration"))
    return Argument(element.get("name"), kind, number(element, "minimum"), number(element, "maximum"), int(element.get("count", 1)),
                    values, int(element.get("octets", 0)), element.get("default") is not None)


def states(text):
    return {STATES.index(name) for name in (text or "").split()}


# What every subsystem has (docs/adr/0056): its id, and type and count of each of its numbers.
BUILT_IN = {"CYCLE_STATS": (39, [("UINT32", 1), ("FLOAT", 1), ("FLOAT", 1)]),
            "CYCLE_TIMES": (40, [("UINT32", 16), ("UINT32", 16)]),
            "CYCLE_BUDGET": (38, [("FLOAT", 1), ("FLOAT", 1), ("UINT32", 1)]),
            "CYCLE_SPIN": (35, [("FLOAT", 1), ("FLOAT", 1), ("UINT64", 1)]),
            "LOOP_STATS": (34, [("FLOAT", 8), ("FLOAT", 8), ("UINT64", 8), ("UINT64", 8)]),
            "RESOURCE_STATS": (37, [("UINT32", n) for n in (1, 1, 1, 1, 1, 1, 8, 8, 1)] + [("UINT16", 1)] * 5 + [("UINT64", 1)] * 2 + [("UINT16", n) for n in (1, 1, 3, 3)] + [("UINT8", 7)] * 2 + [("UINT16", 1)]),
            "HEAP_USES": (33, [("UINT64", 1), ("UINT64", 1), ("BOOL", 1)]),
            "DESCRIPTOR": (36, [("UINT32", 1), ("UINT16", 1)]),
            "LINK_STATS": (41, [("UINT32", 1), ("UINT32", 1)])}


def read_parameters(root, apid, enumerations):
    def wire_id(kind, number):
        return apid << 16 | TYPES[kind][0] << 8 | int(number)

    parameters, ids = [], {name: number for name, (number, _) in BUILT_IN.items()}
    for element in root.find("Parameters") if root.find("Parameters") is not None else []:
        kind, name = element.get("type"), element.get("name")
        if name in BUILT_IN:
            ids[name] = element.get("id")
            continue
        fields = [argument(child, enumerations) for child in (element if kind == "STRUCT" else [element])]
        writable = element.get("writable")
        parameters.append(Parameter(name, wire_id(kind, element.get("id")), fields,
                                    states(writable) if writable is not None else None, element.get("protection") == "yes"))
    for name, (_, numbers) in BUILT_IN.items():
        fields = [Argument(name, kind, None, None, count) for kind, count in numbers]
        parameters.append(Parameter(name, wire_id("STRUCT", ids[name]), fields, None, False))
    return parameters


def read_configuration(element):
    requires = [Required(r.get("name"), r.get("from", ""), r.get("required", "yes") != "no", int(r.get("age", 3)),
                         r.get("missing", "inhibit") == "inhibit") for r in element.iter("Requires")]
    devices = [(d.get("name"), int(d.get("watchdog_ms", 10)), int(d.get("silence", 3))) for d in element.findall("Device")]
    structures = {int(h.get("id")): [p.get("name") for once in h.findall("SampledOnce") for p in once] for h in element.findall("HKService")}
    least_us = int(element.get("least_us", 0)) if element.get("started_by") else None
    return Configuration(int(element.get("id")), element.get("name"), int(element.get("sampling_us")), requires, devices, list(structures),
                         structures, least_us)


def read_subsystem(path, instance=None):
    """`instance`: the element of the mission, which may give another name and id."""
    root = xml.parse(path).getroot()
    said = root.attrib | ({key: instance.get(key) for key in ("name", "id") if instance.get(key)} if instance is not None else {})
    apid = int(said["id"])
    enumerations = {e.get("name"): {int(text.get("value"), 0) for text in e.findall("Text")} for e in root.iter("Enumeration")}
    parameters = read_parameters(root, apid, enumerations)
    ranges = {p.name: p.fields[0] for p in parameters}
    ranges |= {f"{p.name}.{f.name}": f for p in parameters for f in p.fields}
    ranges |= {f.name: f for p in parameters for f in p.fields if f.name not in ranges}
    functions = {}
    for element in root.iter("Function"):
        arguments = []
        for child in element.findall("Argument"):
            given = argument(child, enumerations)
            if child.get("of") is not None:
                same = ranges[child.get("of")]
                given = dataclasses.replace(same, name=given.name, count=1, has_default=given.has_default)
            arguments.append(given)
        functions[element.get("name")] = Function(element.get("name"), states(element.get("states")),
                                                  element.get("essential") == "yes", arguments)
    events = {int(e.get("id"), 0): (e.get("name"), e.get("severity")) for e in root.iter("Event") if e.get("id")}
    configurations = {c.id: c for c in map(read_configuration, root.findall("Configuration"))}
    actuators = {d.get("name") for d in root.findall("Device") if d.get("actuator") == "yes"}
    return Subsystem(said["name"], apid, functions, parameters, events, configurations, actuators)


def file_of(mission, named):
    """Where a descriptor is: beside the mission, or what comes with HIROSCO, which lies here as it is installed."""
    shipped = "@hirosco/"
    return pathlib.Path(__file__).resolve().parents[3] / named.removeprefix(shipped) if named.startswith(shipped) else mission.parent / named


def read_mission(path):
    path = pathlib.Path(path)
    path = path / "mission.xml" if path.is_dir() else path
    root = xml.parse(path).getroot()
    supervisor = read_subsystem(file_of(path, root.find("Supervisor").get("descriptor")))
    members = [read_subsystem(file_of(path, s.get("descriptor")), s) for s in root.findall("Subsystem")]
    modes, mode_ids = {}, {}
    for place, mode in enumerate(root.find("Modes"), 1):
        permits = [(p.get("subsystem"), set((p.get("functions") or "").split()), set((p.get("services") or "").split()),
                    set((p.get("parameters") or "").split()), set((p.get("from") or "").split())) for p in mode.findall("Permit")]
        modes[mode.get("name")] = permits
        mode_ids[mode.get("name")] = int(mode.get("id", place))
    commissions = {mode.get("name"): {c.get("subsystem"): c.get("configuration") for c in mode.findall("Commission")} for mode in root.find("Modes")}
    establishes = {mode.get("name"): [int(link.get("link")) for link in mode.findall("Establish")] for mode in root.find("Modes")}
    power = root.find("Power")
    links = {int(link.get("id")): (link.get("from").split(".")[0], *link.get("to").split("."))
             for link in root.findall("Links/Link")}
    losses = {int(link.get("id")): (link.get("on_loss", "down"), 1000 * int(link.get("hold_ms", 0)), link.get("fallback"))
              for link in root.findall("Links/Link")}
    devices = {d.get("name"): (d.get("subsystem"), d.get("device")) for d in root.findall("SimulatedDevice")}
    ground = root.find("Supervisor/Ground").get("subsystem")
    high = next(({step.get("action") for step in plan.findall("Do")} for plan in root.findall("Recovery/Plan")
                 if "high" in (plan.find("When").get("severity") or "").split()), set())
    return Mission(supervisor, members, ground, modes, mode_ids, root.find("Modes").get("initial"), links, devices, high,
                   path.resolve().parent, commissions, establishes, float(power.get("budget_W")) if power is not None else None,
                   losses)
