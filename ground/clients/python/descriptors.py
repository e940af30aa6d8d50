# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the descriptors of a mission say, as far as a client needs it: values that judge and encode themselves."""
from __future__ import annotations

import dataclasses
import math
import numbers
import struct
from typing import Any, Mapping, Optional, Sequence, Tuple, Union

from .packets import ArgumentError

FORMATS = {"UINT8": "B", "INT8": "b", "UINT16": "H", "INT16": "h", "UINT32": "I", "INT32": "i", "UINT64": "Q",
           "INT64": "q", "FLOAT": "f", "DOUBLE": "d", "BOOL": "?"}
FUNCTION_NAME_OCTETS = 16


def _shown(number: float) -> str:
    return str(number) if isinstance(number, int) else f"{number:g}"


@dataclasses.dataclass(frozen=True)
class Field:
    """A typed, named, ranged value. `texts` are the names of its values, when it has such."""
    name: str
    type: str
    count: int = 1
    unit: str = ""
    minimum: Optional[float] = None
    maximum: Optional[float] = None
    default: Union[float, str, None] = None
    texts: Tuple[Tuple[int, str], ...] = ()
    offset: int = 0               # of a column: in the source data of its report
    words: bool = False           # the octets are text up to the first zero
    most: int = 0                 # of TEXT: octets in UTF-8
    fixed: bool = False           # of TEXT: as many octets on the wire, zeros behind the words

    @property
    def octets(self) -> int:
        """On the wire; of TEXT with `fixed` only."""
        if self.type == "TEXT":
            return self.most
        return self.count * struct.calcsize(">" + FORMATS[self.type])

    def encode(self, value: Any) -> bytes:
        """ArgumentError says in words what does not fit."""
        if self.type == "TEXT":
            return self._text(value)
        values = [value] if self.count == 1 else value
        if isinstance(values, (str, bytes)) or not hasattr(values, "__len__") or len(values) != self.count:
            raise ArgumentError(f"{self.name}: {self.count} values are wanted, not {value!r}")
        return struct.pack(f">{self.count}{FORMATS[self.type]}", *(self._checked(one) for one in values))

    def decode(self, data: bytes, offset: int) -> Any:
        if self.words:
            return data[offset:offset + self.octets].split(b"\0")[0].decode("ascii", "replace")
        if self.type == "TEXT":
            return data[offset:offset + self.most].split(b"\0")[0].decode("utf-8", "replace")
        values = struct.unpack_from(f">{self.count}{FORMATS[self.type]}", data, offset)
        return values[0] if self.count == 1 else values

    def take(self, data: bytes, offset: int) -> Tuple[Any, int]:
        """A value of a report that answers a request, and where the next one stands: text where the value has a name.
        struct.error: it is cut off."""
        if self.type != "TEXT" or self.fixed:
            value = self.decode(data, offset)
            named = self.count == 1 and self.type not in ("BOOL", "TEXT")
            return self.text_of(value) or value if named else value, offset + self.octets
        begin = offset + 2
        end = begin + struct.unpack_from(">H", data, offset)[0]
        if end > len(data):
            raise struct.error(f"{self.name} is cut off")
        return data[begin:end].decode("utf-8", "replace"), end

    def text_of(self, value: float) -> Optional[str]:
        return next((text for known, text in self.texts if known == value), None)

    def _checked(self, value: Any) -> Union[int, float]:
        if isinstance(value, str):
            value = self._named(value)
        if not isinstance(value, numbers.Real) or not (isinstance(value, int) or math.isfinite(value)):
            raise ArgumentError(f"{self.name}: a finite number is wanted, not {value!r}")
        unit = f" {self.unit}" if self.unit else ""
        if self.minimum is not None and value < self.minimum:
            raise ArgumentError(f"{self.name}: {_shown(value)}{unit} is below its minimum {_shown(self.minimum)}{unit}")
        if self.maximum is not None and value > self.maximum:
            raise ArgumentError(f"{self.name}: {_shown(value)}{unit} is above its maximum {_shown(self.maximum)}{unit}")
        if self.type == "BOOL" and value in (0, 1):
            return bool(value)
        real = self.type in ("FLOAT", "DOUBLE")
        if not real and value != int(value):
            raise ArgumentError(f"{self.name}: a whole number is wanted, not {value!r}")
        try:
            if self.type == "BOOL":
                raise OverflowError
            number = float(value) if real else int(value)
            struct.pack(">" + FORMATS[self.type], number)
        except (struct.error, OverflowError):
            raise ArgumentError(f"{self.name}: {value!r} does not fit into {self.type}") from None
        return number

    def _text(self, value: Any) -> bytes:
        octets = value.encode() if isinstance(value, str) else b""
        if not isinstance(value, str) or len(octets) > self.most or b"\0" in octets:
            raise ArgumentError(f"{self.name}: a text of at most {self.most} octets is wanted, not {value!r}")
        return octets.ljust(self.most, b"\0") if self.fixed else struct.pack(">H", len(octets)) + octets

    def _named(self, text: str) -> int:
        for known, name in self.texts:
            if name.lower() == text.lower():
                return known
        names = ", ".join(name for _, name in self.texts)
        raise ArgumentError(f"{self.name}: {text!r} is none of {names}" if names else
                            f"{self.name}: a number is wanted, not {text!r}")


@dataclasses.dataclass(frozen=True)
class Function:
    """A request by name: a function of service 8, or a request of another service."""
    name: str
    service: int = 8
    subtype: int = 1
    arguments: Tuple[Field, ...] = ()
    alone: bool = False           # essential: goes past what waits for the link

    def encode(self, values: Sequence[Any]) -> bytes:
        """Application data: arguments in order, with name and ids for service 8; None stands for the declared value."""
        call = self.service == 8
        data = self.name.encode().ljust(FUNCTION_NAME_OCTETS, b"\0") + bytes([len(self.arguments)]) if call else b""
        for number, (field, value) in enumerate(zip(self.arguments, values), 1):
            if value is None:
                value = field.default if field.count == 1 or field.default is None else [field.default] * field.count
            if value is None:
                raise ArgumentError(f"{self.name}: {field.name} is missing")
            try:
                data += (bytes([number]) if call else b"") + field.encode(value)
            except ArgumentError as error:
                raise ArgumentError(f"{self.name}: {error}") from None
        return data


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A parameter or what is in it, by its id on the wire. A structure has the fields of those within by their way: GAINS.P."""
    name: str
    wire: int
    fields: Tuple[Field, ...]
    structure: bool = False

    def encode(self, value: Any) -> bytes:
        if not self.structure:
            return self.fields[0].encode(value)
        names = [field.name for field in self.fields]
        if not isinstance(value, Mapping) or set(value) != set(names):
            raise ArgumentError(f"{self.name}: a dictionary with {', '.join(names)} is wanted, not {value!r}")
        return b"".join(field.encode(value[field.name]) for field in self.fields)

    def decode(self, data: bytes, offset: int) -> Tuple[Any, int]:
        """The value, of a structure a dictionary, and where it ends. struct.error: it is cut off."""
        values = {}
        for field in self.fields:
            values[field.name], offset = field.decode(data, offset), offset + field.octets
        return values if self.structure else next(iter(values.values())), offset


@dataclasses.dataclass(frozen=True)
class Layout:
    """A housekeeping report as it comes; of values that are sampled repeatedly, the newest sample."""
    sid: int
    octets: int
    columns: Tuple[Field, ...]


@dataclasses.dataclass(frozen=True)
class ReportKind:
    """A report of a subsystem's own service, or of the framework's, in which parts stand that are no fields (shapes.Part)."""
    service: int
    subtype: int
    name: str
    fields: Tuple[Any, ...] = ()


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
    reports: Tuple[ReportKind, ...] = ()
    requests: Tuple[Any, ...] = ()    # of the framework's services by their shapes (shapes.ServiceRequest)


@dataclasses.dataclass(frozen=True)
class MissionAbout:
    name: str
    host: str
    port: int
    supervisor: str
    modes: Tuple[Tuple[int, str], ...]
    links: Tuple[Tuple[int, str], ...]
    failures: Tuple[Tuple[int, str], ...]
    telecommand_port: int = 0     # for telecommands alone; 0: it has none
