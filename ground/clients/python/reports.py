# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a spacecraft tells: housekeeping, events, and what became of a request."""
from __future__ import annotations

import dataclasses
import datetime
import struct
import time
from typing import TYPE_CHECKING, Any, Dict, List, Optional

from .descriptors import FUNCTION_NAME_OCTETS
from .packets import HiroscoError, Telemetry

if TYPE_CHECKING:
    from .runtime import Craft

EPOCH = datetime.datetime(1958, 1, 1, tzinfo=datetime.timezone.utc)
TAI_MINUS_UTC_S = 37


def utc_of(time_s: float) -> datetime.datetime:
    return EPOCH + datetime.timedelta(seconds=time_s - TAI_MINUS_UTC_S)


class Told:
    """What every report of named values has: `report["CUR_VALUES.POSITION"]` is a number, a tuple for an array, a text."""
    time_s: float                 # on board: TAI since 1958
    values: Dict[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.values[name]

    @property
    def utc(self) -> datetime.datetime:
        return utc_of(self.time_s)


@dataclasses.dataclass(frozen=True)
class Housekeeping(Told):
    """One report TM[3,25]."""
    subsystem: str
    sid: int
    time_s: float
    values: Dict[str, Any]


@dataclasses.dataclass(frozen=True)
class Report(Told):
    """One report of a subsystem's own service, or of the framework's: SELF_TEST_OUTCOME. What nobody has a name for is called
    "TM[3,35]" and has no values."""
    subsystem: str
    name: str
    time_s: float
    values: Dict[str, Any]
    service: int = 0
    subtype: int = 0
    data: bytes = b""             # as it came


@dataclasses.dataclass(frozen=True)
class Event(Told):
    """One report TM[5,1] to TM[5,4]."""
    subsystem: str
    id: int
    name: str                     # the number as text when the descriptor has no such event
    severity: str
    time_s: float
    values: Dict[str, Any]


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
    if code == 0x107 and len(data) == 5:             # of a parameter
        return dict(zip(("index", "identifier"), struct.unpack(">BI", data)))
    if len(data) != struct.calcsize(form):
        return {"data": data.hex()}
    return dict(zip((name for name, _ in shape), struct.unpack(form, data)))


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


class Request:
    """A telecommand that was sent, and what became of it."""

    def __init__(self, craft: Craft, subsystem: str, name: str, service: int) -> None:
        self.subsystem, self.name, self.service = subsystem, name, service
        self.verifications: List[Verification] = []
        self.reports: List[Report] = []       # that answer it, while it is open
        self.reply: Optional[Telemetry] = None
        self._craft = craft
        self._link = craft._link          # another link knows nothing of it
        self._sent = time.monotonic()

    def __repr__(self) -> str:
        return f"<{self.subsystem}.{self.name}: {', '.join(v.stage for v in self.verifications) or 'sent'}>"

    @property
    def done(self) -> bool:
        return any(v.is_last for v in self.verifications)

    def result(self, timeout: float = 70.0) -> Request:
        """Waits for the last report. CommandFailed, NoAnswer, LinkLost."""
        self._craft._wait(lambda: self.done, timeout, f"{self.subsystem}.{self.name}: no final report", self._link)
        for verification in self.verifications:
            if verification.is_failure and (verification.is_last or self.verifications[-1].subtype != 7):
                raise CommandFailed(self, verification)
        return self
