# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A spacecraft as a Python object: what every exported mission shares. Python 3.9 or later, standard library only.

The mission's own module beside this file has the classes; they stand on these. One thread keeps reading; every method
may be called from any thread. Octets follow docs/failure-codes.md and the PUS-C tailoring."""
from __future__ import annotations

import collections
import contextlib
import math
import random
import socket
import struct
import threading
import time
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from .descriptors import EventKind, Field, Function, Layout, MissionAbout, Parameter, ReportKind, SubsystemAbout
from .flights import find_flight, flights
from .links import EssentialWay, link_to, place_of
from .packets import ArgumentError, HiroscoError, LinkLost, NoAnswer, Telemetry, crc16, cuc_seconds, cut, telecommand
from .reports import (SEVERITIES, STAGES, CommandFailed, Event, Housekeeping, Report, Request, Verification, code_text,
                      failure_parameters, utc_of)
from .shapes import Part, ServiceRequest, report_of

__all__ = ["ArgumentError", "CommandFailed", "Craft", "Event", "EventKind", "Field", "Function", "HiroscoError", "Housekeeping",
           "Layout", "LinkLost", "MissionAbout", "NoAnswer", "Parameter", "Part", "Report", "ReportKind", "Request", "ServiceRequest", "Subsystem",
           "SubsystemAbout", "Telemetry", "Verification", "code_text", "crc16", "cuc_seconds", "cut", "failure_parameters", "find_flight", "flights",
           "telecommand", "utc_of"]

STATES = ("Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational",
          "ErrorOperational", "PostOperational", "HardwareDeinit", "SoftwareDeinit")
# Source ids of Python clients; reports find back to the one that asked.
FIRST_SOURCE, LAST_SOURCE = 0x8000, 0xBFFF
FIRST_OWN_SERVICE = 192           # of a subsystem's author; those below are the standard's and the framework's
RECONNECT_S = 1.0                 # from one attempt to the next


class Subsystem:
    """Base of the mission's subsystems; the exported classes add a method for every function, parameter and report."""
    _about: SubsystemAbout

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self._functions = {function.name: function for function in self._about.functions}
        self._parameters = {parameter.name: parameter for parameter in self._about.parameters}
        self._services = {request.name: request for request in self._about.requests}
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
        return self._craft._send(self, name, function.service, function.subtype, function.encode(values), wait, function.alone)

    def _ask(self, name: str, values: Sequence[Any], wait: Optional[float]) -> Request:
        """Of a service of the framework."""
        asked = self._services[name]
        return self._craft._send(self, name, asked.service, asked.subtype, asked.encode(values, self._about), wait, asked.alone)

    def _get(self, name: str, wait: float) -> Any:
        parameter = self._parameters[name]
        data = struct.pack(">BI", 1, parameter.wire)
        request = self._craft._send(self, f"get {name}", 20, 1, data, wait)
        self._craft._wait(lambda: request.reply, wait, f"{self._about.name}.{name}: no value came", request._link)
        return parameter.decode(request.reply.data, 5)[0]

    def _set(self, name: str, value: Any, wait: Optional[float]) -> Request:
        parameter = self._parameters[name]
        data = struct.pack(">BI", 1, parameter.wire) + parameter.encode(value)
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
                 instance: Optional[str] = None, reconnect: bool = False, telecommand_port: Optional[int] = None) -> None:
        """Connects: to the flight of this mission on this computer, to that of this name (`hirosco run --instance`), or
        to `host` and `port`. LinkLost: nobody answers there, or it is not clear which flight is meant. With `reconnect` a link
        that is lost later is looked for every second, wherever the mission then flies; what was asked on the old one is lost.
        Essential telecommands leave by `telecommand_port`; left out: as the flight says, else as far from `port` as in the mission."""
        self.source = random.randint(FIRST_SOURCE, LAST_SOURCE)
        self.events: "collections.deque[Event]" = collections.deque(maxlen=self.kept_events)
        self.received = self.damaged = 0
        self._watchers: List[Callable[[Event], None]] = []
        self._arrived = threading.Condition(threading.RLock())
        self._requests: Dict[int, Request] = {}
        self._count = random.randrange(1 << 14)
        self._lost: Optional[str] = None
        self._link = 0                    # how many were lost
        self._link_watchers: List[Callable[[bool], None]] = []
        self._closed = threading.Event()
        self._reconnects = reconnect
        self._wanted = (host, port, instance, telecommand_port)
        self._timeout = timeout
        self._in_turn = threading.Lock()  # of who sends by the link, which may take nothing; nobody else waits for that
        self._essential = EssentialWay()
        self._socket = self._connect()

    def _connect(self) -> socket.socket:
        place = place_of(self._about, *self._wanted)
        connection = link_to(place, self._timeout)
        self._essential.open(place)
        return connection

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
        with self._arrived, contextlib.suppress(OSError):
            self._closed.set()
            self._socket.shutdown(socket.SHUT_RDWR)
        self._essential.close()
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

    def on_link(self, watcher: Callable[[bool], None]) -> None:
        """`watcher(False)` when the link is lost, `watcher(True)` when there is one again; in the reading thread, too."""
        self._link_watchers = [*self._link_watchers, watcher]

    def _told(self, apid: int, what: str, newest: Tuple[float, Optional[int]] = (-math.inf, None)) -> Optional[int]:
        """What the supervisor's housekeeping says of a subsystem, unless `newest` (time, value) is newer."""
        with self._arrived:
            for report in self._supervisor._latest.values():
                apids, values = report.values.get("SUBSYSTEMS.APID", ()), report.values.get(f"SUBSYSTEMS.{what}", ())
                told = [(report.time_s, value) for known, value in zip(apids, values) if known == apid]
                newest = max([newest, *told], key=lambda one: one[0])
        return newest[1]

    def _send(self, subsystem: Subsystem, name: str, service: int, subtype: int, data: bytes,
              wait: Optional[float], alone: bool = False) -> Request:
        """`alone`: past what waits for the link, also without one; that port may take what the other does not."""
        def ask() -> Tuple[Request, bytes]:
            with self._arrived:
                if self._closed.is_set() or (self._lost is not None and not alone):
                    raise LinkLost(self._lost or "this client is closed")
                self._count = (self._count + 1) % (1 << 14)
                packet = telecommand(subsystem._about.apid, self._count, service, subtype, self.source, data)
                request = Request(self, subsystem._about.name, name, service)
                self._requests[int.from_bytes(packet[:4], "big")] = request
                return request, packet

        if alone:
            request, packet = ask()
            if not self._essential.send(packet):
                with self._in_turn:
                    self._send_by_link(packet)
        else:
            with self._in_turn:           # counts leave in their order
                request, packet = ask()
                self._send_by_link(packet)
        if wait is not None and self._lost is not None and not self._reconnects:
            raise LinkLost(f"{request.subsystem}.{name} was sent, but nobody hears what becomes of it: {self._lost}")
        return request if wait is None else request.result(wait)

    def _send_by_link(self, packet: bytes) -> None:
        why = self._lost
        try:
            if why is None:
                return self._socket.sendall(packet)
        except OSError as error:
            why = f"the link was closed: {error}"
        with self._arrived:
            self._requests.pop(int.from_bytes(packet[:4], "big"), None)
        raise LinkLost(why)

    def _wait(self, condition: Callable[[], Any], timeout: float, what: str, link: Optional[int] = None) -> None:
        """`link`: the one on which it was asked; any other brings no answer."""
        end = time.monotonic() + timeout
        with self._arrived:
            while not condition():
                if link not in (None, self._link):
                    raise LinkLost(f"{what}: the link on which it was asked is lost")
                if self._lost is not None and not (self._reconnects and not self._closed.is_set()):
                    raise LinkLost(self._lost)
                left = end - time.monotonic()
                if left <= 0:
                    raise NoAnswer(f"{what} within {timeout:g} s")
                self._arrived.wait(left)

    def _read(self) -> None:
        while True:
            why = self._read_link()
            with self._arrived:
                self._lost = why
                self._link += 1
                self._requests.clear()
                self._arrived.notify_all()
            self._tell_link(False)
            if not self._reconnects or not self._connect_again():
                return
            self._tell_link(True)

    def _tell_link(self, up: bool) -> None:
        for watcher in self._link_watchers:
            watcher(up)

    def _connect_again(self) -> bool:
        """False: this object is closed."""
        while not self._closed.wait(RECONNECT_S):
            try:
                connection = self._connect()
            except LinkLost:
                continue
            with self._arrived:
                if self._closed.is_set():
                    connection.close()
                    self._essential.close()
                    return False
                self._socket.close()
                self._socket, self._lost = connection, None
                self._arrived.notify_all()
            return True
        return False

    def _read_link(self) -> str:
        """Until it ends: why."""
        stream, why = bytearray(), "the spacecraft closed the link"
        try:
            while octets := self._socket.recv(65536):
                stream += octets
                for packet in cut(stream):
                    self._take(packet)
        except (OSError, LinkLost) as error:
            why = str(error)
        return why

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
            elif subsystem is None:
                pass
            elif (packet.service, packet.subtype) == (3, 25):
                subsystem._take_housekeeping(packet)
            elif packet.service == 5 and packet.subtype in SEVERITIES:
                event = subsystem._event_of(packet)
                self.events.append(event)
            elif packet.destination == self.source and not self._take_values(packet):
                self._take_report(subsystem, packet)
            self._arrived.notify_all()
        if event is not None:
            for watcher in self._watchers:
                watcher(event)
            with self._arrived:
                self._arrived.notify_all()

    def _take_report(self, subsystem: Subsystem, packet: Telemetry) -> None:
        """Names no request: it goes to the oldest open one of this service. What the framework says besides, as what is against a mode,
        goes to the oldest of this subsystem."""
        report = report_of(subsystem._about, packet)
        here = [request for request in self._requests.values() if request.subsystem == subsystem._about.name]
        asked = [request for request in here if request.service == packet.service]
        if not asked and packet.service < FIRST_OWN_SERVICE:
            asked = here
        if report is not None and asked:
            asked[0].reports.append(report)

    def _take_values(self, packet: Telemetry) -> bool:
        """TM[20,2] names no request: it goes to the oldest that wants this parameter alone. False: there is none."""
        if (packet.service, packet.subtype) != (20, 2):
            return False
        wire = int.from_bytes(packet.data[1:5], "big")
        subsystem = self._by_apid[packet.apid]
        for key, request in self._requests.items():
            parameter = subsystem._parameters.get(request.name[4:]) if request.name.startswith("get ") else None
            if (request.subsystem == subsystem._about.name and request.reply is None and parameter is not None and
                    parameter.wire == wire and
                    len(packet.data) == 5 + sum(field.octets for field in parameter.fields)):
                request.reply = packet
                if request.done:
                    del self._requests[key]
                return True
        return False

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
        if request.service == 20:
            names["identifier"] = {parameter.wire: parameter.name for parameter in subsystem._about.parameters}
        if function is not None and code == 0x105:
            arguments = {number: field.name for number, field in enumerate(function.arguments, 1)}
            names["identifier"] = arguments
        return {name: names.get(name, {}).get(value, value) for name, value in parameters.items()}
