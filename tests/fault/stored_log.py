# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The pieces of a log as they lie on the disk, read by nothing of HIROSCO's: each record with its octets, so that what a client heard is
found in it again octet by octet. The formats are those of supervisor/platform/README.md."""
import contextlib
import dataclasses
import pathlib
import re
import sqlite3
import zlib

RECEIVED, FORWARDED, TELEMETRY, EVENT, SWITCHED, GAP = (
    "telecommand-received", "telecommand-forwarded", "telemetry", "event", "switched", "gap")
SUFFIXES = {"sqlite": ".db", "ascii": ".log"}


@dataclasses.dataclass(slots=True)
class Record:
    number: int
    at: float                     # time.monotonic() as it was noted
    kind: str
    lost: int
    note: str
    packet: bytes

    def last_missing(self):
        """Of a gap: the last number that stands in it."""
        return int(self.note.rsplit("number ", 1)[1])


def pieces(folder):
    """[(number, path)], oldest first."""
    found = []
    for path in pathlib.Path(folder).iterdir():
        name = re.fullmatch(r"[^.]+(?:\.(\d+))?(\.db|\.log)", path.name)
        if name:
            found.append((int(name[1] or 1), path))
    return sorted(found)


def records_of(path):
    """Those of one piece. A line that was torn, and a piece that was only just begun, have none."""
    return _of_sqlite(path) if path.suffix == ".db" else _of_ascii(path)


def _of_sqlite(path):
    # One that has no table yet, or not even a page, was killed in its opening.
    with contextlib.closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=10.0)) as store:
        if not store.execute("SELECT 1 FROM sqlite_master WHERE name = 'log'").fetchall():
            return
        for number, at, kind, lost, note, packet in store.execute(
                "SELECT number, monotonic, kind, lost, note, packet FROM log ORDER BY position"):
            yield Record(number, at / 1e9, kind, lost, note, packet)


def _of_ascii(path):
    with open(path, "rb") as lines:
        next(lines, None)                     # the version
        for line in lines:
            text, mark, checksum = line.rstrip(b"\n").rpartition(b" #")
            if not mark or not line.endswith(b"\n") or b"%08x" % zlib.crc32(text) != checksum:
                continue
            number, _, _, at, kind, _, _, lost, packet, note = text.split(b" ", 9)
            yield Record(int(number), int(at) / 1e9, kind.decode(), int(lost), note.decode(), b"" if packet == b"-" else bytes.fromhex(packet.decode()))


def records(folder):
    """All of them, oldest first; what was written again into a later piece comes again."""
    for _, path in pieces(folder):
        yield from records_of(path)
