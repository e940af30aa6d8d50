# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Connections to a flight: the link, which brings telemetry and takes telecommands in turn, and beside it one for essential
telecommands alone, to a port that the spacecraft reads whoever fills the other (docs/adr/0028, docs/adr/0225)."""
from __future__ import annotations

import dataclasses
import socket
import threading
from typing import Optional

from .descriptors import MissionAbout
from .flights import find_flight
from .packets import LinkLost

ESSENTIAL_LIMIT_S = 2.0           # for the telecommand port to answer; then the link has to do
# A quiet connection that no longer leads anywhere is noticed after so many seconds, and these more.
QUIET_S, PROBES, PROBE_EVERY_S = 5, 3, 1


@dataclasses.dataclass(frozen=True)
class Place:
    """Where a flight listens. `telecommand_port` 0: nobody knows of one."""
    host: str
    port: int
    telecommand_port: int = 0


def place_of(about: MissionAbout, host: Optional[str] = None, port: Optional[int] = None, instance: Optional[str] = None,
             telecommand_port: Optional[int] = None) -> Place:
    """That of the flight which is meant, with whatever was said of it; else as the mission has it. Of ports that somebody moved, the one
    for telecommands is as far from the other as in the mission. LinkLost: it is not clear which flight is meant."""
    told_port = told_telecommand = None
    if instance is not None or (host is None and port is None):
        flight = find_flight(about.name, instance) or {}
        there, _, number = flight.get("telemetry", "").rpartition(":")
        if number:
            host, told_port = host or there, int(number)
            told_telecommand = int(flight.get("telecommand", "").rpartition(":")[2] or 0)
    known = port or told_port or about.port
    if telecommand_port is None and told_telecommand and known == told_port:
        telecommand_port = told_telecommand
    if telecommand_port is None and about.telecommand_port:
        telecommand_port = known + about.telecommand_port - about.port
    return Place(host or about.host, known, telecommand_port if telecommand_port and 0 < telecommand_port < 1 << 16 else 0)


def link_to(place: Place, timeout: float) -> socket.socket:
    """LinkLost: nobody answers there."""
    try:
        connection = socket.create_connection((place.host, place.port), timeout)
    except OSError as error:
        raise LinkLost(f"{place.host}:{place.port}: {error}; does the mission fly?") from None
    connection.settimeout(None)
    # What is said leaves at once and does not wait here for the answer to what was said before.
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


class EssentialWay:
    """The connection for essential telecommands alone. From any thread; nobody else waits for who uses it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._place: Optional[Place] = None
        self._connection: Optional[socket.socket] = None

    def open(self, place: Place) -> None:
        """Makes it. A port that does not answer is no failure: it is asked again when there is something to say."""
        with self._lock:
            self._drop()
            self._place = place
            self._make()

    def send(self, packet: bytes) -> bool:
        """Made again if it was lost. False: it left the client by no such way, and the link has to do."""
        with self._lock:
            # The spacecraft may have given the place of who is quiet to a newcomer, just now, too.
            for _ in range(2):
                if self._connection is not None and has_ended(self._connection):
                    self._drop()
                if self._connection is None and not self._make():
                    return False
                try:
                    self._connection.sendall(packet)
                    return True
                except OSError:
                    self._drop()          # a packet that came in part is none on board
        return False

    def close(self) -> None:
        with self._lock:
            self._drop()
            self._place = None

    def _make(self) -> bool:
        if self._place is None or not self._place.telecommand_port:
            return False
        try:
            made = socket.create_connection((self._place.host, self._place.telecommand_port), ESSENTIAL_LIMIT_S)
        except OSError:
            return False
        for level, option, value in ((socket.IPPROTO_TCP, socket.TCP_NODELAY, 1), (socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1),
                                     (socket.IPPROTO_TCP, socket.TCP_KEEPIDLE, QUIET_S),
                                     (socket.IPPROTO_TCP, socket.TCP_KEEPINTVL, PROBE_EVERY_S),
                                     (socket.IPPROTO_TCP, socket.TCP_KEEPCNT, PROBES)):
            made.setsockopt(level, option, value)
        self._connection = made
        return True

    def _drop(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None


def has_ended(connection: socket.socket) -> bool:
    """Nothing ever comes by a connection for telecommands but its end."""
    limit = connection.gettimeout()
    connection.settimeout(0.0)
    try:
        return not connection.recv(4096)
    except BlockingIOError:
        return False
    except OSError:
        return True
    finally:
        connection.settimeout(limit)
