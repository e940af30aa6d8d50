# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the framework's services take and tell, by the shapes in which they describe it themselves: the exporter writes those down as they
stand in the framework (docs/adr/0225)."""
from __future__ import annotations

import contextlib
import dataclasses
import numbers
import struct
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

from .descriptors import Field, Parameter, SubsystemAbout
from .packets import CUC_OCTETS, ArgumentError, Telemetry, cuc_octets, cuc_seconds
from .reports import Report

MOST_ITEMS = MOST_WORD_OCTETS = 255          # a count and a length have one octet each


@dataclasses.dataclass(frozen=True)
class Part:
    """What is no plain value. WORD: text behind its length; TIME: on board, seconds TAI since 1958; REST: all octets that are left; LIST: any
    number of `each`, of which one alone is a list of values and several are a list of dictionaries; PARAMETER, EVENT: an id of the
    subsystem's, by its name, too; VALUE: of the parameter before it."""
    name: str
    type: str
    each: Tuple[Union[Field, "Part"], ...] = ()


Parts = Sequence[Union[Field, Part]]


@dataclasses.dataclass(frozen=True)
class ServiceRequest:
    """A request of a service of the framework, called as in the log: "TC[3,5] ENABLE_PERIODIC"."""
    name: str
    service: int
    subtype: int
    parts: Tuple[Union[Field, Part], ...] = ()
    alone: bool = False           # essential: goes past what waits for the link

    def encode(self, values: Sequence[Any], about: SubsystemAbout) -> bytes:
        try:
            return encoded(self.parts, values, about)
        except ArgumentError as error:
            raise ArgumentError(f"{self.name}: {error}") from None


def encoded(parts: Parts, values: Sequence[Any], about: SubsystemAbout) -> bytes:
    """ArgumentError says in words what does not fit."""
    data, parameter = b"", None
    for part, value in zip(parts, values):
        if part.type == "PARAMETER":
            wire = _id_of(part, value, {one.name: one.wire for one in about.parameters}, 4)
            parameter = _parameter(about, wire)
            data += wire.to_bytes(4, "big")
        elif part.type == "EVENT":
            data += _id_of(part, value, {one.name: one.id for one in about.events}, 2).to_bytes(2, "big")
        elif part.type == "VALUE":
            data += parameter.encode(value) if parameter is not None else _octets(part, value)
        elif part.type == "LIST":
            data += _list(part, value, about)
        elif part.type == "WORD":
            data += _word(part, value)
        elif part.type == "TIME":
            data += _time(part, value)
        elif part.type == "REST":
            data += _octets(part, value)
        else:
            data += part.encode(value)
    return data


def take(parts: Parts, data: bytes, offset: int, about: SubsystemAbout) -> Tuple[Dict[str, Any], int]:
    """The values, and where they end. struct.error: they are cut off. KeyError: a value of a parameter that nobody knows."""
    values, parameter = {}, None
    for part in parts:
        if part.type == "PARAMETER":
            wire, = struct.unpack_from(">I", data, offset)
            parameter = _parameter(about, wire)
            value, offset = parameter.name if parameter is not None else wire, offset + 4
        elif part.type == "EVENT":
            number, = struct.unpack_from(">H", data, offset)
            value, offset = next((one.name for one in about.events if one.id == number), number), offset + 2
        elif part.type == "VALUE":
            if parameter is None:
                raise KeyError(part.name)
            value, offset = parameter.decode(data, offset)
        elif part.type == "LIST":
            count, = struct.unpack_from(">B", data, offset)
            offset, items = offset + 1, []
            for _ in range(count):
                item, offset = take(part.each, data, offset, about)
                items.append(item if len(part.each) > 1 else next(iter(item.values())))
            value = tuple(items)
        elif part.type in ("WORD", "TIME"):
            word = part.type == "WORD"
            begin = offset + (1 if word else 0)
            offset = begin + (struct.unpack_from(">B", data, offset)[0] if word else CUC_OCTETS)
            if offset > len(data):
                raise struct.error(f"{part.name} is cut off")
            value = data[begin:offset].decode("utf-8", "replace") if word else cuc_seconds(data[begin:offset])
        elif part.type == "REST":
            value, offset = data[offset:], len(data)
        else:
            value, offset = part.take(data, offset)
        values[part.name] = value
    return values, offset


def report_of(about: SubsystemAbout, packet: Telemetry) -> Optional[Report]:
    """By its kind; what nobody knows has its octets and no values. None: it is cut off, or longer than its kind."""
    told = (packet.service, packet.subtype, packet.data)
    raw = Report(about.name, f"TM[{packet.service},{packet.subtype}]", packet.time_s, {}, *told)
    kind = next((one for one in about.reports if (one.service, one.subtype) == told[:2]), None)
    if kind is None:
        return raw
    try:
        values, offset = take(kind.fields, packet.data, 0, about)
    except struct.error:
        return None
    except KeyError:
        return raw
    return Report(about.name, kind.name, packet.time_s, values, *told) if offset == len(packet.data) else None


def _parameter(about: SubsystemAbout, wire: int) -> Optional[Parameter]:
    return next((one for one in about.parameters if one.wire == wire), None)


def _id_of(part: Part, value: Any, known: Mapping[str, int], octets: int) -> int:
    if isinstance(value, str):
        for name, number in known.items():
            if name.lower() == value.lower():
                return number
        raise ArgumentError(f"{part.name}: {value!r} is none of {', '.join(known) or 'none, for it has none'}")
    if not isinstance(value, numbers.Integral) or not 0 <= value < 1 << 8 * octets:
        raise ArgumentError(f"{part.name}: a name or a number of {octets} octets is wanted, not {value!r}")
    return int(value)


def _list(part: Part, value: Any, about: SubsystemAbout) -> bytes:
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__len__") or len(value) > MOST_ITEMS:
        raise ArgumentError(f"{part.name}: a list of at most {MOST_ITEMS} is wanted, not {value!r}")
    data, names = bytes([len(value)]), [one.name for one in part.each]
    for item in value:
        if len(names) == 1:
            item = {names[0]: item}
        if not isinstance(item, Mapping) or set(item) != set(names):
            raise ArgumentError(f"{part.name}: dictionaries with {', '.join(names)} are wanted, not {item!r}")
        data += encoded(part.each, [item[name] for name in names], about)
    return data


def _word(part: Part, value: Any) -> bytes:
    octets = value.encode() if isinstance(value, str) else b""
    if not isinstance(value, str) or len(octets) > MOST_WORD_OCTETS:
        raise ArgumentError(f"{part.name}: a text of at most {MOST_WORD_OCTETS} octets is wanted, not {value!r}")
    return bytes([len(octets)]) + octets


def _time(part: Part, value: Any) -> bytes:
    if isinstance(value, numbers.Real):
        with contextlib.suppress(OverflowError, ValueError):
            return cuc_octets(value)
    raise ArgumentError(f"{part.name}: seconds TAI since 1958 are wanted, not {value!r}")


def _octets(part: Part, value: Any) -> bytes:
    if not isinstance(value, (bytes, bytearray)):
        raise ArgumentError(f"{part.name}: octets are wanted, not {value!r}")
    return bytes(value)
