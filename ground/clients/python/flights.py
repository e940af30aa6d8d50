# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Flights on this computer."""
from __future__ import annotations

import contextlib
import fcntl
import os
import pathlib
import struct
from typing import Dict, List, Optional

from .packets import LinkLost


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
