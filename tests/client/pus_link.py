# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A PUS-C ground link on the library `spacepackets`: none of the project's own code is in it, so that a mistake which
both of our ends share cannot hide. Headers, checksums and verification reports are the library's; what the product
leaves to its own tailoring (function arguments, housekeeping layout, CUC 4+3 time) is written here from the PUS-C
tailoring sheet."""
import dataclasses
import pathlib
import random
import socket
import struct
import sys
import threading
import time
import xml.etree.ElementTree as xml

from spacepackets.ccsds import SpacePacketHeader
from spacepackets.ecss import PusTc, PusTm
from spacepackets.ecss.pus_1_verification import FailureNotice, ManagedParamsVerification, Service1Tm
from spacepackets.ecss.req_id import RequestId

SUPERVISOR, COMMUNICATION, MANIPULATOR, JOYSTICK = 1, 2, 10, 11
APIDS = {SUPERVISOR: "supervisor", COMMUNICATION: "communication", MANIPULATOR: "manipulator", JOYSTICK: "joystick"}
ACCEPTANCE, START, PROGRESS, COMPLETION = 1, 2, 4, 8
ALL = ACCEPTANCE | START | PROGRESS | COMPLETION
TIME_OCTETS = 7
STATES = ["Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational",
          "ErrorOperational", "PostOperational", "HardwareDeinit", "SoftwareDeinit"]
FORMATS = {"UINT8": "B", "INT8": "b", "UINT16": "H", "INT16": "h", "UINT32": "I", "INT32": "i", "UINT64": "Q",
           "INT64": "q", "FLOAT": "f", "DOUBLE": "d"}


@dataclasses.dataclass
class Verification:
    """One report of ST[01]."""
    subtype: int
    request: int                 # packet id and sequence control of the telecommand, u32
    step: int | None = None
    code: int | None = None
    data: bytes = b""


@dataclasses.dataclass
class Report:
    packet: PusTm
    received: float              # time.monotonic()

    @property
    def kind(self):
        return self.packet.service, self.packet.message_subtype

    @property
    def destination(self):
        return self.packet.pus_tm_sec_header.dest_id


def verification_of(report):
    """The verification in a report of ST[01], or None."""
    service, subtype = report.kind
    if service != 1:
        return None
    data = report.packet.tm_data
    if subtype == 10:            # failed routing is not known to the library's Service1Tm
        notice = FailureNotice.unpack(data[4:], 2)
        return Verification(10, RequestId.unpack(data).as_u32(), None, notice.code.val, notice.data)
    parsed = Service1Tm.from_tm(report.packet, ManagedParamsVerification(bytes_step_id=2, bytes_err_code=2))
    notice = parsed.failure_notice
    return Verification(subtype, parsed.tc_req_id.as_u32(), parsed.step_id.val if parsed.step_id else None,
                        notice.code.val if notice else None, notice.data if notice else b"")


def onboard_seconds(timestamp):
    """CUC 4+3 without P-field: seconds of TAI since 1958-01-01."""
    return int.from_bytes(timestamp[:4], "big") + int.from_bytes(timestamp[4:7], "big") / 2**24


def cut(buffer):
    """Takes the whole space packets off the front of a bytearray."""
    packets = []
    while len(buffer) >= 6:
        size = SpacePacketHeader.unpack(buffer[:6]).packet_len
        if len(buffer) < size:
            break
        packets.append(bytes(buffer[:size]))
        del buffer[:size]
    return packets


class Call:
    """Application data of TC[8,1]: function id, N, N x (argument id, value)."""

    def __init__(self, name, *arguments):
        self.name, self.arguments = name, arguments      # arguments: (id, type, value)

    def pack(self):
        data = self.name.encode("ascii").ljust(16, b"\0") + bytes([len(self.arguments)])
        for number, kind, value in self.arguments:
            data += bytes([number]) + struct.pack(">" + FORMATS[kind], value)
        return data


def set_state(name):
    return Call("SET_STATE", (1, "UINT8", STATES.index(name)))


class GroundLink:
    """One connection. A thread of its own receives; every packet must be a well-formed PUS-C telemetry packet."""

    def __init__(self, host, port, source=None, timeout=5.0):
        self.source = source if source is not None else random.randrange(1, 0xFFFF)
        self.malformed, self.gaps, self.received = [], [], 0
        self._count = random.randrange(1 << 14)
        self._last_count = {}
        self._reports = []
        self._arrived = threading.Condition()
        self._closed = False
        self._socket = socket.create_connection((host, port), timeout)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.settimeout(None)
        threading.Thread(target=self._receive, daemon=True).start()

    def close(self):
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        self._socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # Sending.

    def telecommand(self, apid, service, subtype, data=b"", ack=ALL):
        self._count = (self._count + 1) % (1 << 14)
        return PusTc(service=service, message_subtype=subtype, apid=apid, app_data=bytes(data),
                     seq_count=self._count, source_id=self.source, ack_flags=ack)

    def send(self, telecommand):
        """Sends and returns the request id under which the reports will come."""
        self.send_raw(telecommand.pack())
        return RequestId.from_pus_tc(telecommand).as_u32()

    def send_raw(self, octets):
        self._socket.sendall(bytes(octets))

    def call(self, apid, call, ack=ALL, timeout=10.0):
        """Performs a function and returns its verification reports, up to the final one."""
        return self.verify(self.send(self.telecommand(apid, 8, 1, call.pack(), ack)), timeout)

    # Receiving.

    def _receive(self):
        buffer = bytearray()
        while True:
            try:
                octets = self._socket.recv(65536)
            except OSError:
                octets = b""
            if not octets:
                break
            buffer += octets
            for packet in cut(buffer):
                self._take(packet)
        with self._arrived:
            self._closed = True
            self._arrived.notify_all()

    def _take(self, octets):
        now = time.monotonic()
        try:
            packet = PusTm.unpack(octets, TIME_OCTETS)   # checks the PUS version and the checksum
            if packet.sp_header.packet_type != 0 or not packet.sp_header.sec_header_flag:
                raise ValueError("not telemetry with a secondary header")
            report = Report(packet, now)
            verification_of(report)
        except Exception as error:  # the library raises several kinds; each of them is a finding
            with self._arrived:
                self.malformed.append(f"{error!r}: {octets.hex()}")
                self._arrived.notify_all()
            return
        with self._arrived:
            self.received += 1
            last = self._last_count.get(packet.apid)
            if last is not None and packet.seq_count != (last + 1) % (1 << 14):
                self.gaps.append((packet.apid, last, packet.seq_count))
            self._last_count[packet.apid] = packet.seq_count
            self._reports.append(report)
            if len(self._reports) > 20000:
                del self._reports[:10000]
            self._arrived.notify_all()

    def wait(self, wanted, timeout):
        """Takes the first report, past or future, for which `wanted` is true; None after `timeout` seconds."""
        end = time.monotonic() + timeout
        looked = 0
        with self._arrived:
            while True:
                for place in range(min(looked, len(self._reports)), len(self._reports)):
                    if wanted(self._reports[place]):
                        return self._reports.pop(place)
                looked = len(self._reports)
                left = end - time.monotonic()
                if left <= 0 or self._closed:
                    return None
                self._arrived.wait(left)

    def forget(self):
        """Drops what was received so far."""
        with self._arrived:
            self._reports.clear()

    @property
    def closed(self):
        return self._closed

    def verify(self, request, timeout=10.0):
        """Verification reports of a request until the one that ends it: 1,2 1,4 1,7 1,8 or 1,10."""
        found = []
        end = time.monotonic() + timeout
        while not found or found[-1].subtype not in (2, 4, 7, 8, 10):
            report = self.wait(lambda r: r.kind[0] == 1 and verification_of(r).request == request,
                               end - time.monotonic())
            if report is None:
                break
            found.append(verification_of(report))
        return found


# What the descriptors say.

# What every subsystem has without declaring it; members are known by their full names only (docs/adr/0056).
BUILT_IN = {"CYCLE_STATS": (("OVERRUNS", "UINT32", 1), ("MAX_US", "FLOAT", 1), ("AVG_US", "FLOAT", 1)),
            "CYCLE_BUDGET": (("BUDGET_US", "FLOAT", 1), ("LONGEST_US", "FLOAT", 1), ("EXCEEDED", "UINT32", 1)),
            "CYCLE_SPIN": (("SPIN_US", "FLOAT", 1), ("LONGEST_US", "FLOAT", 1), ("EXCEEDED", "UINT64", 1)),
            "LOOP_STATS": (("BUDGET_US", "FLOAT", 8), ("LONGEST_US", "FLOAT", 8), ("EXCEEDED", "UINT64", 8), ("MISSED", "UINT64", 8)),
            "CYCLE_TIMES": (("EXECUTION", "UINT32", 16), ("LATENCY", "UINT32", 16)),
            "RESOURCE_STATS": tuple((name, "UINT32", 8 if name in ("POOL_USED", "POOL_HIGH") else 1) for name in
                                    ("MEMORY", "MEMORY_HIGH", "DESCRIPTORS", "DESCRIPTORS_HIGH", "THREADS", "THREADS_HIGH", "POOL_USED",
                                     "POOL_HIGH", "POOL_REFUSED")) +
                              tuple((name, "UINT16", 1) for name in ("PORTS", "PORTS_HIGH", "FILES", "FILES_HIGH", "HELD_REFUSED")) +
                              (("SHARED_MEMORY", "UINT64", 1), ("SHARED_MEMORY_HIGH", "UINT64", 1), ("PROCESSOR", "UINT16", 1), ("PROCESSOR_HIGH", "UINT16", 1),
                               ("WAITING", "UINT16", 3), ("WAITING_HIGH", "UINT16", 3), ("QUEUES", "UINT8", 7), ("QUEUES_HIGH", "UINT8", 7), ("CORE", "UINT16", 1)),
            "HEAP_USES": (("CYCLE", "UINT64", 1), ("SERVICE", "UINT64", 1), ("COUNTED", "BOOL", 1)),
            "DESCRIPTOR": (("HASH", "UINT32", 1), ("CHANGES", "UINT16", 1)),
            "LINK_STATS": (("RECEIVED", "UINT32", 1), ("LOST", "UINT32", 1))}


class Descriptor:
    """Parameters, housekeeping structures and functions of one subsystem, read from its XML."""

    def __init__(self, path, instance=None):
        """`instance`: the element of a mission, which may give another name and id."""
        self.root = xml.parse(path).getroot()
        given = {**self.root.attrib, **{key: instance.get(key) for key in ("name", "id") if instance is not None and instance.get(key)}}
        self.name = given["name"]
        self.apid = int(given["id"])
        self.parameters = {}                              # name -> [(field name, type, count)]
        for element in self.root.iterfind("Parameters/*"):
            name = element.get("name")
            if element.tag == "StructRef":
                self.parameters[name] = [(f"{name}.{m.get('name')}", m.get("type"), int(m.get("count", "1")))
                                         for m in element.iterfind("ParamRef")]
            else:
                self.parameters[name] = [(name, element.get("type"), int(element.get("count", "1")))]
        for name, members in BUILT_IN.items():
            self.parameters[name] = [(f"{name}.{member}", kind, count) for member, kind, count in members]

    def fields(self, reference):
        """Fields of `CUR_VALUES`, `CUR_VALUES.POSITION` or an unambiguous member name."""
        if reference in self.parameters:
            return self.parameters[reference]
        found = [field for fields in self.parameters.values() for field in fields
                 if field[0] == reference or
                 field[0].endswith("." + reference) and field[0].split(".")[0] not in BUILT_IN]
        if len(found) != 1:
            raise KeyError(f"{self.name}: {reference} names {len(found)} fields")
        return found

    def structures(self, identifier):
        """All declarations of a housekeeping structure: the subsystem's own and those of its configurations."""
        return [s for s in self.root.iter("HKService") if int(s.get("id")) == identifier]

    def layout(self, structure):
        """[(name, type, count)] in wire order: sampled once, then for each repetition one value of each parameter."""
        fields = [field for part in structure.iterfind("SampledOnce") for ref in part.iterfind("ParamRef")
                  for field in self.fields(ref.get("name"))]
        for part in structure.iterfind("SampledNREPTimes"):
            group = [field for ref in part.iterfind("ParamRef") for field in self.fields(ref.get("name"))]
            for repetition in range(int(part.get("nrep"))):
                fields += [(f"{name}#{repetition}", kind, count) for name, kind, count in group]
        return fields

    def decode(self, data):
        """Source data of TM[3,25] -> {name: value or tuple}; ValueError when the length is not the declared one."""
        identifier = int.from_bytes(data[:2], "big")
        lengths = []
        for structure in self.structures(identifier):
            layout = self.layout(structure)
            form = ">" + "".join(f"{count}{FORMATS[kind]}" for _, kind, count in layout)
            lengths.append(2 + struct.calcsize(form))
            if lengths[-1] != len(data):
                continue
            numbers = list(struct.unpack(form, data[2:]))
            values = {}
            for name, _, count in layout:
                taken, numbers = numbers[:count], numbers[count:]
                values[name] = taken[0] if count == 1 else tuple(taken)
            return values
        raise ValueError(f"{self.name} structure {identifier}: {len(data)} octets, declared are {lengths}")

    def kind_of(self, reference):
        """The type of a parameter, or of one member as STRUCTURE.MEMBER: an argument may be of it."""
        *above, name = reference.split(".")
        inside = self.root if not above else next(s for s in self.root.iter("StructRef") if s.get("name") == above[0])
        return next(p.get("type") for p in inside.iter("ParamRef") if p.get("name") == name and p.get("type"))

    def call(self, name, *values):
        """A call of a declared function with its arguments in declared order."""
        function = next(f for f in self.root.iter("Function") if f.get("name") == name)
        kinds = [a.get("type") or self.kind_of(a.get("of")) for a in function.iterfind("Argument")]
        if len(values) > len(kinds):
            raise ValueError(f"{name} takes {len(kinds)} arguments")
        return Call(name, *((i + 1, kinds[i], value) for i, value in enumerate(values)))


class Mission:
    """The descriptors that a mission names, by subsystem name in lower case, and the ids of its modes."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        root = xml.parse(path).getroot()
        self.modes = {m.get("name"): int(m.get("id", str(n))) for n, m in enumerate(root.iter("Mode"), 1)}
        modes = root.find("Modes")
        self.start = modes.get("start") or modes.get("initial")
        self.links = [int(link.get("id")) for link in root.iterfind("Links/Link")]
        self.subsystems = {}
        for element in [*root.iterfind("Supervisor"), *root.iterfind("Subsystem")]:
            if element.get("descriptor"):
                descriptor = Descriptor(self._find(element.get("descriptor")), element if element.tag == "Subsystem" else None)
                self.subsystems[descriptor.name.lower()] = descriptor

    def _find(self, name):
        beside = self.path.parent / name
        if beside.exists():
            return beside
        repository = pathlib.Path(__file__).resolve().parents[2]
        for folder in ("missions", "subsystems", "supervisor"):
            for path in sorted((repository / folder).rglob(pathlib.Path(name).name)):
                return path
        raise FileNotFoundError(name)


def add_arguments(parser):
    repository = pathlib.Path(__file__).resolve().parents[2]
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=10015, help="telemetry and telecommands")
    parser.add_argument("--mission", default=str(repository / "missions/rokviss/mission.xml"))


class Table:
    """Rows of checks as they are made, and the exit code."""

    def __init__(self, out=sys.stdout):
        self.failed, self.out = 0, out
        print(f"{'':6} {'check':57} {'ms':>8}  found", file=out)

    def row(self, good, check, found="", milliseconds=None):
        self.failed += not good
        took = f"{milliseconds:8.1f}" if milliseconds is not None else " " * 8
        print(f"{'ok' if good else 'FAILED':6} {check:57.57} {took}  {found}".rstrip(), file=self.out, flush=True)
        return good

    def end(self):
        print(f"\n{self.failed} checks failed" if self.failed else "\nall checks passed", file=self.out)
        return 1 if self.failed else 0
