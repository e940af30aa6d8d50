# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a descriptor declares, as far as the suite judges it. It takes descriptors that `hirosco check` finds good."""
import dataclasses
import pathlib
import sys
import xml.etree.ElementTree

from wire import BOOL, STRUCT, TEXT, TYPES, LinkField, lowest, octets_of

STATES = ["Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational", "ErrorOperational",
          "PostOperational", "HardwareDeinit", "SoftwareDeinit"]
SEVERITIES = {"info": 1, "low": 2, "medium": 3, "high": 4}
METHODS = {"shared_memory": 1, "udp": 2, "tcp": 3, "unix": 4, "dds": 5, "tipc": 6}
KINDS = {"latest": 1, "queued": 2, "loaned": 3}
NATIVE = 1 if sys.byteorder == "little" else 2
# Structures that every subsystem has where its descriptor names them: members are name, id, type, count.
FRAMEWORK = {"CYCLE_STATS": [("OVERRUNS", 244, 5, 1), ("MAX_US", 240, 9, 1), ("AVG_US", 241, 9, 1)],
             "CYCLE_TIMES": [("EXECUTION", 240, 5, 16), ("LATENCY", 241, 5, 16)],
             "CYCLE_BUDGET": [("BUDGET_US", 242, 9, 1), ("LONGEST_US", 243, 9, 1), ("EXCEEDED", 245, 5, 1)],
             "CYCLE_SPIN": [("SPIN_US", 244, 9, 1), ("LONGEST_US", 245, 9, 1), ("EXCEEDED", 240, 7, 1)],
             "LOOP_STATS": [("BUDGET_US", 246, 9, 8), ("LONGEST_US", 247, 9, 8), ("EXCEEDED", 241, 7, 8), ("MISSED", 242, 7, 8)],
             "RESOURCE_STATS": [("MEMORY", 246, 5, 1), ("MEMORY_HIGH", 247, 5, 1), ("DESCRIPTORS", 248, 5, 1), ("DESCRIPTORS_HIGH", 249, 5, 1),
                                ("THREADS", 250, 5, 1), ("THREADS_HIGH", 251, 5, 1), ("POOL_USED", 252, 5, 8), ("POOL_HIGH", 253, 5, 8),
                                ("POOL_REFUSED", 254, 5, 1), ("PORTS", 250, 3, 1), ("PORTS_HIGH", 251, 3, 1), ("FILES", 252, 3, 1),
                                ("FILES_HIGH", 253, 3, 1), ("HELD_REFUSED", 254, 3, 1),
                                ("SHARED_MEMORY", 243, 7, 1), ("SHARED_MEMORY_HIGH", 244, 7, 1), ("PROCESSOR", 241, 3, 1), ("PROCESSOR_HIGH", 242, 3, 1),
                                ("WAITING", 243, 3, 3), ("WAITING_HIGH", 244, 3, 3), ("QUEUES", 254, 1, 7), ("QUEUES_HIGH", 255, 1, 7),
                                ("CORE", 245, 3, 1)],
             "HEAP_USES": [("CYCLE", 255, 7, 1), ("SERVICE", 254, 7, 1), ("COUNTED", 255, 33, 1)],
             "DESCRIPTOR": [("HASH", 255, 5, 1), ("CHANGES", 240, 3, 1)],
             "LINK_STATS": [("RECEIVED", 242, 5, 1), ("LOST", 243, 5, 1)]}


@dataclasses.dataclass
class Value:
    """A parameter, member, argument or field."""
    name: str
    type: int
    count: int = 1
    id: int = 0
    minimum: float = None
    maximum: float = None
    texts: dict = None                            # of an enumeration: {name: number}
    octets: int = 0                               # of TEXT
    default: str = None
    init: str = None
    writable: tuple = ()
    protection: bool = False
    members: list = dataclasses.field(default_factory=list)
    parts: list = dataclasses.field(default_factory=list)  # structures within
    safe: list = dataclasses.field(default_factory=list)

    def size(self):
        if self.type == STRUCT:
            return sum(member.size() for member in self.members)
        return self.octets if self.type == TEXT else octets_of(self.type) * self.count


@dataclasses.dataclass
class Function:
    name: str
    states: list
    arguments: list


@dataclasses.dataclass
class Structure:
    id: int
    interval: int
    enabled: bool
    once: list                                    # names
    sets: list                                    # (repetitions, names)


def number(text):
    return float(text) if any(c in text for c in ".eEnN") and not text.lower().startswith("0x") else int(text, 0)


class Descriptor:
    def __init__(self, file):
        self.file = pathlib.Path(file).resolve()
        self.root = xml.etree.ElementTree.parse(self.file).getroot()
        self.name, self.apid = self.root.get("name"), int(self.root.get("id"))
        self.enumerations = {"STATES": {state: i for i, state in enumerate(STATES)}}
        for each in self.root.iter("Enumeration"):
            self.enumerations[each.get("name")] = {text.text: int(text.get("value")) for text in each.iter("Text")}
        self.parameters = [self._parameter(each) for each in self.root.findall("Parameters/*") if each.tag in ("ParamRef", "StructRef")]
        # Those that it has without declaring them; a foreign one may leave them out.
        ids = {"CYCLE_STATS": 39, "CYCLE_TIMES": 40, "LINK_STATS": 41, "CYCLE_BUDGET": 38, "CYCLE_SPIN": 35, "LOOP_STATS": 34, "RESOURCE_STATS": 37, "HEAP_USES": 33, "DESCRIPTOR": 36}
        self.framework = [Value(name, STRUCT, id=ids[name], members=[Value(word, kind, count, place) for word, place, kind, count in members])
                          for name, members in FRAMEWORK.items()] + self._outputs()
        self.functions = [Function(each.get("name"), self._states(each.get("states", "Operational")),
                                   [self._argument(i, argument) for i, argument in enumerate(each.iter("Argument"), 1)])
                          for each in self.root.iter("Function")]
        self.events = {int(each.get("id"), 0): (each.get("name"), SEVERITIES[each.get("severity")],
                                                sum(self._value(argument).size() for argument in each.iter("Argument")))
                       for each in self.root.iter("Event") if each.get("id")}
        self.configurations = {int(each.get("id")): each for each in self.root.findall("Configuration")}
        self.services = {int(each.get("type"), 0) for each in self.root.iter("CustomService")}
        self.devices = {each.get("name"): each for each in self.root.findall("Device")}

    def _outputs(self):
        """What is put out to each actuator, or would be: NAME_OUTPUT with the fields of its output; ids as the framework gives them."""
        found, used = [], {}
        for device in self.root.findall("Device"):
            fields = [self._value(each) for each in device.findall("Output/Field")]
            if device.get("actuator") != "yes" or not fields:
                continue
            for field in fields:
                field.id = 239 - used.get(field.type, 0)
                used[field.type] = used.get(field.type, 0) + 1
            found.append(Value(device.get("name").replace("-", "_").replace(".", "_") + "_OUTPUT", STRUCT, id=42 + len(found), members=fields))
        return found

    def _states(self, words):
        return [STATES.index(word) for word in words.split()]

    def _value(self, element, base=None):
        value = dataclasses.replace(base, default=None) if base else Value(element.get("name"), TYPES[element.get("type", "DOUBLE")])
        value.name = element.get("name")
        if base is None:
            value.count = int(element.get("count", 1))
            value.octets = int(element.get("octets", 0))
            value.texts = self.enumerations.get(element.get("enumeration")) if element.get("enumeration") else None
        for end in ("minimum", "maximum"):
            if element.get(end):
                setattr(value, end, number(element.get(end)))
        return value

    def _parameter(self, element):
        members = FRAMEWORK.get(element.get("name")) if element.tag == "StructRef" and len(element) == 0 else None
        if element.tag == "StructRef":
            value = Value(element.get("name"), STRUCT)
            if members:
                value.members = [Value(name, kind, count, number) for name, number, kind, count in members]
            else:
                value.members, value.parts = self._inside(element)
        else:
            value = self._value(element)
        value.id = int(element.get("id"))
        value.init = element.get("init")
        value.writable = tuple(self._states(element.get("writable", "")))
        value.protection = element.get("protection") == "yes"
        return value

    def _inside(self, element):
        """Members and parts of a structure by their way; ids of the elements of an array go on behind those of the one before."""
        members, parts = [], []
        for each in element:
            if each.tag == "ParamRef":
                members.append(self._parameter(each))
            if each.tag != "StructRef":
                continue
            inner, within = self._inside(each)
            own = Value("", STRUCT, id=int(each.get("id")), members=inner)
            ids = {}
            for value in [own, *inner, *within]:
                ids.setdefault(value.type, set()).add(value.id)
            count = int(each.get("count", 1))
            for i in range(count):
                way = each.get("name") + (f"[{i}]" if count > 1 else "")
                moved = {id(value): dataclasses.replace(value, name=f"{way}.{value.name}".rstrip("."),
                                                        id=value.id + i * (max(ids[value.type]) - min(ids[value.type]) + 1))
                         for value in [own, *inner, *within]}
                for part in [own, *within]:
                    parts.append(dataclasses.replace(moved[id(part)], members=[moved[id(member)] for member in part.members]))
                members += [moved[id(member)] for member in inner]
        return members, parts

    def _argument(self, place, element):
        value = self._value(element, self.find(element.get("of")) if element.get("of") else None)
        value.id, value.default = place, element.get("default")
        return value

    def find(self, name):
        """By name, `A.B` of a member; a member's bare name where it is unambiguous."""
        head, _, tail = name.partition(".")
        for parameter in self.parameters + self.framework:
            if parameter.name == head:
                return next(inside for inside in parameter.members + parameter.parts if inside.name == tail) if tail else parameter
        return next(inside for parameter in self.parameters for inside in parameter.members + parameter.parts if inside.name == name)

    def wire(self, value):
        return self.apid << 16 | value.type << 8 | value.id

    def readable(self):
        """[(id on the wire, Value)] of every parameter and what is in it."""
        return [(self.wire(value), value) for parameter in self.parameters for value in (parameter, *parameter.members, *parameter.parts)]

    def richest(self):
        """The configuration that has most to judge."""
        return max(self.configurations, key=lambda number: len(list(self.configurations[number].iter("Device")))
                   + len(list(self.configurations[number].iter("Provides"))) + len(list(self.configurations[number].iter("Requires"))), default=None)

    def required_sets(self):
        names = []
        for each in self.configurations.values():
            names += [wanted.get("name") for wanted in each.iter("Requires") if wanted.get("name") not in names]
        return names


class Configuration:
    def __init__(self, descriptor, number_):
        element = descriptor.configurations[number_]
        self.descriptor, self.id, self.element = descriptor, number_, element
        self.period_s = int(element.get("sampling_us")) / 1e6
        self.self_test = element.get("self_test") == "required"
        self.started_by = element.get("started_by")
        self.provides = [each for each in element.iter("Provides")]
        self.requires = [each for each in element.iter("Requires")]
        self.devices = [each for each in element.findall("Device")]

    @property
    def period_ns(self):
        return int(self.element.get("sampling_us")) * 1000

    def settings(self):
        """{parameter name: text} that this configuration sets."""
        return {each.get("parameter"): each.get("value") for each in self.element.iter("Set")}

    @staticmethod
    def terms(element):
        orders = element.get("byte_order", "native").split()
        return ([METHODS[word] for word in element.get("methods", "shared_memory").split()],
                [{"little": 1, "big": 2, "native": NATIVE}[word] for word in orders],
                [KINDS[word] for word in element.get("kind", "latest").split()])

    def fields(self, element):
        """Of a set: required ones are declared, provided ones are parameters or, lent, declared, too."""
        fields = [LinkField(each.get("name"), TYPES[each.get("type")], int(each.get("count", 1))) for each in element.findall("Field")]
        for each in element.findall("ParamRef"):
            value = self.descriptor.find(each.get("name"))
            for part in value.members or [value]:
                fields.append(LinkField(part.name, part.type, part.count))
        return fields

    def structures(self):
        found = {}
        for place in (self.descriptor.root, self.element):
            for each in place.findall("HKService"):
                names = lambda element: [ref.get("name") for ref in element.findall("ParamRef")]
                found[int(each.get("id"))] = Structure(
                    int(each.get("id")), int(each.get("interval")), each.get("enabled", "yes") == "yes",
                    [name for once in each.findall("SampledOnce") for name in names(once)],
                    [(int(group.get("nrep")), names(group)) for group in each.findall("SampledNREPTimes")])
        return found

    def report_octets(self, structure):
        """Of the source data of TM[3,25]."""
        size = lambda names: sum(self.descriptor.find(name).size() for name in names)
        return 2 + size(structure.once) + sum(count * size(names) for count, names in structure.sets)


def good_octets(value, texts_of=None):
    """Octets of a value that is permitted, as an argument has them."""
    if value.type == TEXT:
        return b"\0\1a"
    from wire import put
    if value.texts:
        chosen = next(iter(value.texts.values()))
    else:
        chosen = 0
        if value.minimum is not None and chosen < value.minimum or value.maximum is not None and chosen > value.maximum:
            chosen = value.minimum if value.minimum is not None else value.maximum
    if value.type not in (9, 10):
        chosen = int(chosen)
    return put(value.type, [chosen] * value.count)


def bad_octets(value):
    """Octets of a value of its type that is not permitted; None where everything is."""
    from wire import highest, put
    if value.type in (9, 10):
        return put(value.type, [float("nan")] * value.count)
    if value.type == TEXT:
        return b"\0\2\xff\xff"
    if value.type == BOOL:
        return put(1, [2] * value.count)
    if value.texts:
        free = next((n for n in range(highest(value.type) + 1) if n not in value.texts.values()), None)
        return None if free is None else put(value.type, [free] * value.count)
    if value.maximum is not None and value.maximum < highest(value.type):
        return put(value.type, [highest(value.type)] * value.count)
    if value.minimum is not None and value.minimum > lowest(value.type):
        return put(value.type, [lowest(value.type)] * value.count)
    return None
