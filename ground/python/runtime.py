# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A spacecraft as a Python object: what every exported mission shares. Python 3.9 or later, standard library only.

The mission's own module beside this file has the classes; they stand on these. One thread keeps reading; every method
may be called from any thread. Octets follow docs/failure-codes.md and the PUS-C tailoring: CRC-16 of the whole packet,
CUC 4+3 time of TAI since 1958, numbers big-endian."""
from __future__ import annotations

import binascii
import collections
import contextlib
import dataclasses
import datetime
import fcntl
import math
import numbers
import os
import pathlib
import random
import socket
import struct
import threading
import time
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

STATES = ("Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational",
          "ErrorOperational", "PostOperational", "HardwareDeinit", "SoftwareDeinit")
ACK_ALL = 15                      # acceptance, start, progress, completion
FORMATS = {"UINT8": "B", "INT8": "b", "UINT16": "H", "INT16": "h", "UINT32": "I", "INT32": "i", "UINT64": "Q",
           "INT64": "q", "FLOAT": "f", "DOUBLE": "d"}
LARGEST_PACKET = 4096
FUNCTION_NAME_OCTETS = 16
EXACT_INTEGERS = 2**53            # on board an argument travels as a double
EPOCH = datetime.datetime(1958, 1, 1, tzinfo=datetime.timezone.utc)
TAI_MINUS_UTC_S = 37
# Source ids of Python clients; reports find back to the one that asked.
FIRST_SOURCE, LAST_SOURCE = 0x8000, 0xBFFF


# --- what can go wrong -----------------------------------------------------------------------------------------------

class HiroscoError(Exception):
    """Whatever this client raises."""


class ArgumentError(HiroscoError, ValueError):
    """Not sent: a value outside its range, of another kind, or a name nobody knows."""


class LinkLost(HiroscoError, ConnectionError):
    """The spacecraft's end of the link is gone."""


class NoAnswer(HiroscoError, TimeoutError):
    """What was waited for did not come in time. It may still come, and the request may still be executed."""


def code_text(code: int) -> str:
    """As docs/failure-codes.md writes it."""
    return str(code) if code < 0x100 else f"{code:#06x}"


class CommandFailed(HiroscoError):
    """The spacecraft refused a request or did not complete it. `verification` is the report that says so."""

    def __init__(self, request: Request, verification: Verification) -> None:
        super().__init__(f"{request.subsystem}.{request.name} {verification.stage}: {verification.text} "
                         f"(code {code_text(verification.code)}){verification.detail}")
        self.request, self.verification = request, verification

    @property
    def code(self) -> int:
        return self.verification.code or 0

    @property
    def text(self) -> str:
        return self.verification.text

    @property
    def parameters(self) -> Dict[str, Any]:
        return self.verification.parameters


# --- flights on this computer ----------------------------------------------------------------------------------------

def flights(folder: Optional[str] = None) -> List[Dict[str, str]]:
    """Your flights on this computer: instance, mission, telemetry ("HOST:PORT"), log and more (docs/adr/0037)."""
    found = []
    with contextlib.suppress(OSError):
        for path in sorted(pathlib.Path(folder or f"/tmp/hirosco-flights-{os.getuid()}").iterdir()):
            with contextlib.suppress(OSError, UnicodeDecodeError), path.open(encoding="utf-8") as file:
                # Who flies has the file locked; looking takes no lock.
                query = struct.pack("hhqqi4x", fcntl.F_WRLCK, os.SEEK_SET, 0, 0, 0)
                if struct.unpack("hhqqi4x", fcntl.fcntl(file, fcntl.F_OFD_GETLK, query))[0] == fcntl.F_UNLCK:
                    continue
                entry = dict(line.split("=", 1) for line in file.read().splitlines() if "=" in line)
                if entry.get("instance") == path.name:
                    found.append(entry)
    return found


def find_flight(mission: str, instance: Optional[str] = None,
                folder: Optional[str] = None) -> Optional[Dict[str, str]]:
    """The flight of this mission; None when none is in the air. LinkLost: the instance does not fly, or several do."""
    known = flights(folder)
    of_mission = [flight for flight in known if flight.get("mission") == mission]
    meant = [flight for flight in of_mission if instance in (None, flight["instance"])]
    if len(meant) == 1:
        return meant[0]
    names = ", ".join(f"{flight['instance']} ({flight.get('mission')})" for flight in known) or "nothing"
    if instance is not None:
        raise LinkLost(f"no instance {instance!r} of {mission} flies; on this computer: {names}")
    if meant:
        raise LinkLost(f"{len(meant)} flights of {mission} are in the air: say instance=...; on this computer: {names}")
    return None


# --- packets ---------------------------------------------------------------------------------------------------------

def crc16(octets: bytes) -> int:
    """CCSDS error control: polynomial 0x1021, preset 0xFFFF. 0 over a whole undamaged packet."""
    return binascii.crc_hqx(octets, 0xFFFF)


def telecommand(apid: int, count: int, service: int, subtype: int, source: int, data: bytes = b"",
                ack: int = ACK_ALL) -> bytes:
    """A whole telecommand packet with PUS-C header."""
    header = struct.pack(">HHHBBBH", 0x1800 | apid, 0xC000 | count, len(data) + 6, 0x20 | ack, service, subtype, source)
    packet = header + data
    if len(packet) + 2 > LARGEST_PACKET:
        raise ArgumentError(f"a telecommand has at most {LARGEST_PACKET} octets, this one {len(packet) + 2}")
    return packet + struct.pack(">H", crc16(packet))


@dataclasses.dataclass(frozen=True)
class Telemetry:
    """A telemetry packet with PUS-C header."""
    apid: int
    count: int
    service: int
    subtype: int
    destination: int
    time_s: float                 # TAI since 1958
    data: bytes

    @classmethod
    def parse(cls, packet: bytes) -> Optional[Telemetry]:
        """None for what is damaged or is no PUS-C telemetry."""
        if not 22 <= len(packet) <= LARGEST_PACKET or packet[0] >> 3 != 1 or packet[6] >> 4 != 2 or crc16(packet) != 0:
            return None
        first, second, length = struct.unpack(">HHH", packet[:6])
        if length + 7 != len(packet):
            return None
        service, subtype, _, destination = struct.unpack(">BBHH", packet[7:13])
        return cls(first & 0x7FF, second & 0x3FFF, service, subtype, destination, cuc_seconds(packet[13:20]),
                   packet[20:-2])


def cuc_seconds(octets: bytes) -> float:
    return int.from_bytes(octets[:4], "big") + int.from_bytes(octets[4:7], "big") / 2**24


def cut(stream: bytearray) -> List[bytes]:
    """Takes the whole packets off the front of a stream. LinkLost: this is no telemetry, so nothing has an end."""
    packets = []
    while len(stream) >= 6:
        size = 7 + int.from_bytes(stream[4:6], "big")
        if stream[0] >> 4 != 0 or size > LARGEST_PACKET:
            raise LinkLost("what comes from there is no telemetry")
        if len(stream) < size:
            break
        packets.append(bytes(stream[:size]))
        del stream[:size]
    return packets


# --- what the descriptors say ----------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True)
class Field:
    """A typed, named, ranged value. `texts` are the names of its values, when it has such."""
    name: str
    type: str
    count: int = 1
    unit: str = ""
    minimum: Optional[float] = None
    maximum: Optional[float] = None
    default: Optional[float] = None
    texts: Tuple[Tuple[int, str], ...] = ()
    offset: int = 0               # of a column: in the source data of its report
    words: bool = False           # the octets are text up to the first zero

    @property
    def octets(self) -> int:
        return self.count * struct.calcsize(">" + FORMATS[self.type])

    def encode(self, value: Any) -> bytes:
        """ArgumentError says in words what does not fit."""
        values = [value] if self.count == 1 else value
        if isinstance(values, (str, bytes)) or not hasattr(values, "__len__") or len(values) != self.count:
            raise ArgumentError(f"{self.name}: {self.count} values are wanted, not {value!r}")
        return struct.pack(f">{self.count}{FORMATS[self.type]}", *(self._checked(one) for one in values))

    def decode(self, data: bytes, offset: int) -> Any:
        if self.words:
            return data[offset:offset + self.octets].split(b"\0")[0].decode("ascii", "replace")
        values = struct.unpack_from(f">{self.count}{FORMATS[self.type]}", data, offset)
        return values[0] if self.count == 1 else values

    def text_of(self, value: float) -> Optional[str]:
        return next((text for known, text in self.texts if known == value), None)

    def _checked(self, value: Any) -> Union[int, float]:
        if isinstance(value, str):
            value = self._named(value)
        if not isinstance(value, numbers.Real) or not math.isfinite(value):
            raise ArgumentError(f"{self.name}: a finite number is wanted, not {value!r}")
        unit = f" {self.unit}" if self.unit else ""
        if self.minimum is not None and value < self.minimum:
            raise ArgumentError(f"{self.name}: {value:g}{unit} is below its minimum {self.minimum:g}{unit}")
        if self.maximum is not None and value > self.maximum:
            raise ArgumentError(f"{self.name}: {value:g}{unit} is above its maximum {self.maximum:g}{unit}")
        if self.type == "DOUBLE":
            return float(value)
        if self.type != "FLOAT" and value != int(value):
            raise ArgumentError(f"{self.name}: a whole number is wanted, not {value!r}")
        try:
            number = float(value) if self.type == "FLOAT" else int(value)
            struct.pack(">" + FORMATS[self.type], number)
        except (struct.error, OverflowError):
            raise ArgumentError(f"{self.name}: {value!r} does not fit into {self.type}") from None
        if self.type != "FLOAT" and abs(number) > EXACT_INTEGERS:
            raise ArgumentError(f"{self.name}: {value!r} is above 2^53")
        return number

    def _named(self, text: str) -> int:
        for known, name in self.texts:
            if name.lower() == text.lower():
                return known
        names = ", ".join(name for _, name in self.texts)
        raise ArgumentError(f"{self.name}: {text!r} is none of {names}" if names else
                            f"{self.name}: a number is wanted, not {text!r}")


@dataclasses.dataclass(frozen=True)
class Function:
    name: str
    service: int = 8
    arguments: Tuple[Field, ...] = ()

    def encode(self, values: Sequence[Any]) -> bytes:
        """Application data of TC[8,1]; None stands for the declared value."""
        if self.service != 8:
            return b""
        data = self.name.encode().ljust(FUNCTION_NAME_OCTETS, b"\0") + bytes([len(self.arguments)])
        for number, (field, value) in enumerate(zip(self.arguments, values), 1):
            if value is None:
                value = field.default if field.count == 1 or field.default is None else [field.default] * field.count
            if value is None:
                raise ArgumentError(f"{self.name}: {field.name} is missing")
            try:
                data += bytes([number]) + field.encode(value)
            except ArgumentError as error:
                raise ArgumentError(f"{self.name}: {error}") from None
        return data


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A parameter or a member of one, by its id on the wire. A structure as a whole has several fields."""
    name: str
    wire: int
    fields: Tuple[Field, ...]


@dataclasses.dataclass(frozen=True)
class Layout:
    """A housekeeping report as it comes; of values that are sampled repeatedly, the newest sample."""
    sid: int
    octets: int
    columns: Tuple[Field, ...]


@dataclasses.dataclass(frozen=True)
class EventKind:
    id: int
    name: str
    arguments: Tuple[Field, ...] = ()


@dataclasses.dataclass(frozen=True)
class SubsystemAbout:
    """A subsystem's descriptor, as far as a client needs it."""
    name: str
    apid: int
    configurations: Tuple[Tuple[int, str], ...] = ()
    functions: Tuple[Function, ...] = ()
    parameters: Tuple[Parameter, ...] = ()
    layouts: Tuple[Layout, ...] = ()
    events: Tuple[EventKind, ...] = ()


@dataclasses.dataclass(frozen=True)
class MissionAbout:
    name: str
    host: str
    port: int
    supervisor: str
    modes: Tuple[Tuple[int, str], ...]
    links: Tuple[Tuple[int, str], ...]
    failures: Tuple[Tuple[int, str], ...]


# --- what is heard ---------------------------------------------------------------------------------------------------

def utc_of(time_s: float) -> datetime.datetime:
    return EPOCH + datetime.timedelta(seconds=time_s - TAI_MINUS_UTC_S)


@dataclasses.dataclass(frozen=True)
class Housekeeping:
    """One report TM[3,25]. `report["CUR_VALUES.POSITION"]` is a number, or a tuple for an array."""
    subsystem: str
    sid: int
    time_s: float                 # on board: TAI since 1958
    values: Dict[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.values[name]

    @property
    def utc(self) -> datetime.datetime:
        return utc_of(self.time_s)


@dataclasses.dataclass(frozen=True)
class Event:
    """One report TM[5,1] to TM[5,4]."""
    subsystem: str
    id: int
    name: str                     # the number as text when the descriptor has no such event
    severity: str
    time_s: float
    values: Dict[str, Any]

    @property
    def utc(self) -> datetime.datetime:
        return utc_of(self.time_s)


SEVERITIES = {1: "info", 2: "low", 3: "medium", 4: "high"}
STAGES = {1: "accepted", 2: "refused", 3: "started", 4: "start failed", 5: "progress", 6: "progress failed",
          7: "completed", 8: "failed", 10: "not routed"}
# docs/failure-codes.md: what stands behind a code.
FAILURE_DATA = {0x02: (("length", "H"),), 0x06: (("service", "B"),), 0x07: (("service", "B"), ("subtype", "B")),
                0x09: (("offset", "H"),), 0x0A: (("state", "B"),), 0x0D: (("mode", "B"),), 0x0E: (("link", "B"),),
                0x0F: (("link", "B"),), 0x101: (("index", "B"), ("identifier", "I")),
                0x102: (("index", "B"), ("identifier", "I")), 0x103: (("index", "B"), ("identifier", "I")),
                0x104: (("index", "B"),), 0x105: (("index", "B"), ("identifier", "I")), 0x106: (("index", "B"),),
                0x107: (("index", "B"),), 0x109: (("index", "B"), ("checksum", "H")),
                0x201: (("executed", "B"), ("rejected", "B"))}


@dataclasses.dataclass(frozen=True)
class Verification:
    """One report of ST[01] about a request."""
    subtype: int
    after_s: float                # since the request was sent
    step: Optional[int] = None
    code: Optional[int] = None
    text: str = ""                # of the code
    data: bytes = b""             # behind the code
    parameters: Dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def stage(self) -> str:
        return STAGES.get(self.subtype, "?")

    @property
    def detail(self) -> str:
        return "".join(f", {name} {value}" for name, value in self.parameters.items())

    @property
    def is_failure(self) -> bool:
        return self.code is not None

    @property
    def is_last(self) -> bool:
        return self.subtype == 7 or (self.is_failure and self.subtype != 6)


def failure_parameters(code: int, data: bytes) -> Dict[str, Any]:
    """The numbers behind a failure code by name; what is not documented stays octets, in hexadecimal."""
    shape = FAILURE_DATA.get(code, ())
    form = ">" + "".join(letter for _, letter in shape)
    if code == 0x101 and len(data) == 1 + FUNCTION_NAME_OCTETS:
        return {"index": data[0], "name": data[1:].rstrip(b"\0").decode("ascii", "replace")}
    if len(data) >= 10 and data[0] == 0xFF:
        return {"reason": data[10:].decode("ascii", "replace"), "number": int.from_bytes(data[2:10], "big", signed=True)}
    if len(data) != struct.calcsize(form):
        return {"data": data.hex()}
    return dict(zip((name for name, _ in shape), struct.unpack(form, data)))


class Request:
    """A telecommand that was sent, and what became of it."""

    def __init__(self, craft: Craft, subsystem: str, name: str) -> None:
        self.subsystem, self.name = subsystem, name
        self.verifications: List[Verification] = []
        self.reply: Optional[Telemetry] = None
        self._craft = craft
        self._sent = time.monotonic()

    def __repr__(self) -> str:
        return f"<{self.subsystem}.{self.name}: {', '.join(v.stage for v in self.verifications) or 'sent'}>"

    @property
    def done(self) -> bool:
        return any(v.is_last for v in self.verifications)

    def result(self, timeout: float = 70.0) -> Request:
        """Waits for the last report. CommandFailed, NoAnswer, LinkLost."""
        self._craft._wait(lambda: self.done, timeout, f"{self.subsystem}.{self.name}: no final report")
        for verification in self.verifications:
            if verification.is_failure and (verification.is_last or self.verifications[-1].subtype != 7):
                raise CommandFailed(self, verification)
        return self


# --- the spacecraft --------------------------------------------------------------------------------------------------

class Subsystem:
    """Base of the mission's subsystems; the exported classes add a method for every function, parameter and report."""
    _about: SubsystemAbout

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self._functions = {function.name: function for function in self._about.functions}
        self._parameters = {parameter.name: parameter for parameter in self._about.parameters}
        self._latest: Dict[int, Housekeeping] = {}
        self._recordings: List[Tuple[int, List[Housekeeping]]] = []
        self._changed: Tuple[float, Optional[int]] = (-math.inf, None)  # state by its newest STATE_CHANGED, and when

    # Names here are taken: the exporter calls a function of the same name NAME_2.
    def latest(self, sid: int) -> Optional[Housekeeping]:
        """The newest report of this structure, None before the first."""
        return self._latest.get(sid)

    @contextlib.contextmanager
    def record(self, sid: int):
        """`with craft.arm.record(4711) as reports:` - a list that grows with every report of this structure."""
        self._known(sid)
        entry: Tuple[int, List[Housekeeping]] = (sid, [])
        with self._craft._arrived:
            self._recordings.append(entry)
        try:
            yield entry[1]
        finally:
            with self._craft._arrived:
                self._recordings = [one for one in self._recordings if one is not entry]

    def enable_housekeeping(self, *sids: int, wait: Optional[float] = 10.0) -> Request:
        return self._housekeeping(5, sids, wait)

    def disable_housekeeping(self, *sids: int, wait: Optional[float] = 10.0) -> Request:
        return self._housekeeping(6, sids, wait)

    @property
    def state(self) -> Optional[str]:
        """"Operational" and so on, by its own or the supervisor's newest word; None: it does not run, or is unknown."""
        number = self._craft._told(self._about.apid, "STATE", self._changed)
        return STATES[number] if number is not None and number < len(STATES) else None

    @property
    def configuration(self) -> Optional[str]:
        """By the supervisor's newest word."""
        number = self._craft._told(self._about.apid, "CONFIGURATION")
        return dict(self._about.configurations).get(number)

    # The exported methods end here.
    def _call(self, name: str, values: Sequence[Any], wait: Optional[float]) -> Request:
        function = self._functions[name]
        return self._craft._send(self, name, function.service, 1, function.encode(values), wait)

    def _get(self, name: str, wait: float) -> Any:
        parameter = self._parameters[name]
        data = struct.pack(">BI", 1, parameter.wire)
        request = self._craft._send(self, f"get {name}", 20, 1, data, wait)
        self._craft._wait(lambda: request.reply, wait, f"{self._about.name}.{name}: no value came")
        values, offset = {}, 5
        for field in parameter.fields:
            values[field.name] = field.decode(request.reply.data, offset)
            offset += field.octets
        return values if len(parameter.fields) > 1 else next(iter(values.values()))

    def _set(self, name: str, value: Any, wait: Optional[float]) -> Request:
        parameter = self._parameters[name]
        data = struct.pack(">BI", 1, parameter.wire) + parameter.fields[0].encode(value)
        return self._craft._send(self, f"set {name}", 20, 3, data, wait)

    def _next(self, sid: int, timeout: float) -> Housekeeping:
        before = self._latest.get(sid)
        self._craft._wait(lambda: self._latest.get(sid) is not before, timeout,
                          f"{self._about.name}: no report {sid}; is it enabled in this configuration?")
        return self._latest[sid]

    def _known(self, sid: int) -> None:
        if all(layout.sid != sid for layout in self._about.layouts):
            known = ", ".join(str(sid) for sid in sorted({layout.sid for layout in self._about.layouts}))
            raise ArgumentError(f"{self._about.name} has no report {sid}; it has {known or 'none'}")

    def _housekeeping(self, subtype: int, sids: Sequence[int], wait: Optional[float]) -> Request:
        for sid in sids:
            self._known(sid)
        data = bytes([len(sids)]) + b"".join(struct.pack(">H", sid) for sid in sids)
        return self._craft._send(self, f"housekeeping {sids}", 3, subtype, data, wait)

    def _take_housekeeping(self, packet: Telemetry) -> None:
        """With the craft's mutex held."""
        sid = int.from_bytes(packet.data[:2], "big")
        for layout in self._about.layouts:
            if layout.sid == sid and layout.octets == len(packet.data):
                values = {column.name: column.decode(packet.data, column.offset) for column in layout.columns}
                report = Housekeeping(self._about.name, sid, packet.time_s, values)
                self._latest[sid] = report
                for wanted, reports in self._recordings:
                    if wanted == sid:
                        reports.append(report)
                return

    def _event_of(self, packet: Telemetry) -> Event:
        number = int.from_bytes(packet.data[:2], "big")
        kind = next((one for one in self._about.events if one.id == number), EventKind(number, str(number)))
        values, offset = {}, 2
        for field in kind.arguments:
            if offset + field.octets > len(packet.data):
                break
            value = field.decode(packet.data, offset)
            if (kind.name, field.name) == ("STATE_CHANGED", "STATE"):
                self._changed = max(self._changed, (packet.time_s, value), key=lambda told: told[0])
            values[field.name] = field.text_of(value) or value if field.count == 1 else value
            offset += field.octets
        return Event(self._about.name, number, kind.name, SEVERITIES[packet.subtype], packet.time_s, values)


class Craft:
    """The link to a flying mission; the exported class `Spacecraft` adds its subsystems."""
    _about: MissionAbout
    _subsystems: Tuple[Subsystem, ...] = ()
    kept_events = 10_000

    def __init__(self, host: Optional[str] = None, port: Optional[int] = None, timeout: float = 5.0,
                 instance: Optional[str] = None) -> None:
        """Connects: to the flight of this mission on this computer, to that of this name (`hirosco run --instance`), or
        to `host` and `port`. LinkLost: nobody answers there, or it is not clear which flight is meant."""
        self.source = random.randint(FIRST_SOURCE, LAST_SOURCE)
        self.events: "collections.deque[Event]" = collections.deque(maxlen=self.kept_events)
        self.received = self.damaged = 0
        self._watchers: List[Callable[[Event], None]] = []
        self._arrived = threading.Condition(threading.RLock())
        self._requests: Dict[int, Request] = {}
        self._count = random.randrange(1 << 14)
        self._lost: Optional[str] = None
        where = (host or self._about.host, port or self._about.port)
        if instance is not None or (host is None and port is None):
            flight = find_flight(self._about.name, instance)
            if flight and flight.get("telemetry"):
                there, _, number = flight["telemetry"].rpartition(":")
                where = (host or there, port or int(number))
        try:
            self._socket = socket.create_connection(where, timeout)
        except OSError as error:
            raise LinkLost(f"{where[0]}:{where[1]}: {error}; does the mission fly?") from None
        self._socket.settimeout(None)

    def _start(self) -> None:
        """Once the subsystems are there."""
        self._by_apid = {subsystem._about.apid: subsystem for subsystem in self._subsystems}
        self._supervisor = next(one for one in self._subsystems if one._about.name == self._about.supervisor)
        self._reader = threading.Thread(target=self._read, name="hirosco telemetry", daemon=True)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        if threading.current_thread() is not self._reader:
            self._reader.join(5.0)
        self._socket.close()

    @property
    def connected(self) -> bool:
        return self._lost is None

    @property
    def mode(self) -> Optional[str]:
        """The mission's mode by the supervisor's newest word; None before the first."""
        with self._arrived:
            told = [report for report in self._supervisor._latest.values() if "MODE" in report.values]
        return dict(self._about.modes).get(max(told, key=lambda report: report.time_s)["MODE"]) if told else None

    def wait_until(self, condition: Callable[[], Any], timeout: float = 10.0, what: str = "it did not happen") -> None:
        """Looks whenever a packet came: `craft.wait_until(lambda: craft.mode == "safe")`."""
        self._wait(condition, timeout, what)

    def wait_event(self, name: str, timeout: float = 10.0) -> Event:
        """The next event of this name from now on."""
        found: List[Event] = []
        self.on_event(watch := lambda event: found.append(event) if event.name == name else None)
        try:
            self._wait(lambda: found, timeout, f"no event {name}")
        finally:
            self._watchers.remove(watch)
        return found[0]

    def on_event(self, watcher: Callable[[Event], None]) -> None:
        """`watcher(event)` in the reading thread: it may not wait for anything of this object."""
        self._watchers = [*self._watchers, watcher]

    def _told(self, apid: int, what: str, newest: Tuple[float, Optional[int]] = (-math.inf, None)) -> Optional[int]:
        """What the supervisor's housekeeping says of a subsystem, unless `newest` (time, value) is newer."""
        with self._arrived:
            for report in self._supervisor._latest.values():
                apids, values = report.values.get("SUBSYSTEMS.APID", ()), report.values.get(f"SUBSYSTEMS.{what}", ())
                told = [(report.time_s, value) for known, value in zip(apids, values) if known == apid]
                newest = max([newest, *told], key=lambda one: one[0])
        return newest[1]

    def _send(self, subsystem: Subsystem, name: str, service: int, subtype: int, data: bytes,
              wait: Optional[float]) -> Request:
        with self._arrived:
            self._count = (self._count + 1) % (1 << 14)
            packet = telecommand(subsystem._about.apid, self._count, service, subtype, self.source, data)
            request = Request(self, subsystem._about.name, name)
            if self._lost is not None:
                raise LinkLost(self._lost)
            self._requests[int.from_bytes(packet[:4], "big")] = request
            try:
                self._socket.sendall(packet)
            except OSError as error:
                raise LinkLost(f"the link was closed: {error}") from None
        return request if wait is None else request.result(wait)

    def _wait(self, condition: Callable[[], Any], timeout: float, what: str) -> None:
        end = time.monotonic() + timeout
        with self._arrived:
            while not condition():
                if self._lost is not None:
                    raise LinkLost(self._lost)
                left = end - time.monotonic()
                if left <= 0:
                    raise NoAnswer(f"{what} within {timeout:g} s")
                self._arrived.wait(left)

    def _read(self) -> None:
        stream, why = bytearray(), "the spacecraft closed the link"
        try:
            while octets := self._socket.recv(65536):
                stream += octets
                for packet in cut(stream):
                    self._take(packet)
        except (OSError, LinkLost) as error:
            why = str(error)
        with self._arrived:
            self._lost = why
            self._arrived.notify_all()

    def _take(self, octets: bytes) -> None:
        packet = Telemetry.parse(octets)
        event = None
        with self._arrived:
            if packet is None:
                self.damaged += 1
                return
            self.received += 1
            subsystem = self._by_apid.get(packet.apid)
            if packet.service == 1:
                self._take_verification(packet)
            elif subsystem is None or len(packet.data) < 2:
                pass
            elif (packet.service, packet.subtype) == (3, 25):
                subsystem._take_housekeeping(packet)
            elif packet.service == 5 and packet.subtype in SEVERITIES:
                event = subsystem._event_of(packet)
                self.events.append(event)
            elif (packet.service, packet.subtype) == (20, 2):
                self._take_values(packet)
            self._arrived.notify_all()
        if event is not None:
            for watcher in self._watchers:
                watcher(event)
            with self._arrived:
                self._arrived.notify_all()

    def _take_values(self, packet: Telemetry) -> None:
        """TM[20,2] names no request: it goes to the oldest that asked for this parameter."""
        wire = int.from_bytes(packet.data[1:5], "big")
        subsystem = self._by_apid[packet.apid]
        for key, request in self._requests.items():
            parameter = subsystem._parameters.get(request.name[4:]) if request.name.startswith("get ") else None
            if (request.subsystem == subsystem._about.name and request.reply is None and parameter is not None and
                    packet.destination == self.source and parameter.wire == wire and
                    len(packet.data) == 5 + sum(field.octets for field in parameter.fields)):
                request.reply = packet
                if request.done:
                    del self._requests[key]
                return

    def _take_verification(self, packet: Telemetry) -> None:
        if packet.destination != self.source or packet.subtype not in STAGES or len(packet.data) < 4:
            return
        request = self._requests.get(int.from_bytes(packet.data[:4], "big"))
        if request is None:
            return
        rest, step, code = packet.data[4:], None, None
        if packet.subtype in (5, 6):
            step, rest = int.from_bytes(rest[:2], "big"), rest[2:]
        if packet.subtype % 2 == 0:
            code, rest = int.from_bytes(rest[:2], "big"), rest[2:]
        parameters = {} if code is None else self._named(request, code, failure_parameters(code, rest))
        text = "" if code is None else dict(self._about.failures).get(code, "not documented")
        after_s = time.monotonic() - request._sent
        request.verifications.append(Verification(packet.subtype, after_s, step, code, text, rest, parameters))
        if request.done and (request.reply is not None or not request.name.startswith("get ") or
                             request.verifications[-1].is_failure):
            del self._requests[int.from_bytes(packet.data[:4], "big")]

    def _named(self, request: Request, code: int, parameters: Dict[str, Any]) -> Dict[str, Any]:
        """Numbers as the names that they have in this mission."""
        names = {"state": dict(enumerate(STATES)), "mode": dict(self._about.modes), "link": dict(self._about.links)}
        subsystem = next(one for one in self._subsystems if one._about.name == request.subsystem)
        function = subsystem._functions.get(request.name)
        if function is not None and code == 0x105:
            arguments = {number: field.name for number, field in enumerate(function.arguments, 1)}
            names["identifier"] = arguments
        return {name: names.get(name, {}).get(value, value) for name, value in parameters.items()}
