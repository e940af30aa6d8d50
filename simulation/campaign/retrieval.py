# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Draws TC[129,11]: what was said before comes down again (docs/adr/0140)."""
import struct

from packets import crc16

ONBOARD_BEGIN_S = 2145916838    # where the craft's clock stands as a flight begins, since 1958
LAST_S = 2**32 - 1
OTHER_GROUNDS = [77, 300]       # source ids of clients beside the one that commands


def time(seconds):
    """A time of 7 octets, as near as they say it."""
    ticks = max(0, min(round(seconds * 2**24), 2**56 - 1))
    return ticks.to_bytes(7, "big")


def data(r, now=None):
    """From, to, and whether housekeeping is among it; mostly something that is there. `now`: seconds into the flight."""
    now = r.uniform(0, 26) if now is None else now
    here = ONBOARD_BEGIN_S
    ago = r.choice([0.001, 0.05, 0.3, 1, 3, 10])
    first, last = r.choice([
        (0, LAST_S), (here, here + now), (here + now - ago, here + now), (here + now - ago, here + now + ago), (here + now - ago, LAST_S),
        (here + now - 2 * ago, here + now - ago), (here + r.uniform(0, now), here + now), (0, here + r.uniform(0, now)),
        (here + now + 5, here + now + 6), (0, here - 3600), (0, 0), (here + now, here + now), (LAST_S, LAST_S),      # nothing
        (here + now, here + now - ago), (LAST_S, 0)])                                                                # no range
    wanted = time(first) + time(last) + bytes([r.choice([0, 1, 1, 1])])
    draw = r.random()
    if draw < 0.05:
        return wanted[:-1] + bytes([r.choice([2, 255])])
    return wanted[:r.choice([0, 7, 14])] if draw < 0.1 else wanted + b"\0" if draw < 0.12 else wanted


def packet(source, count, octets, ack=15):
    """The telecommand of another ground, whole."""
    body = struct.pack(">HHHBBBH", 0x1801, 0xC000 | count, 5 + len(octets) + 1, 0x20 | ack, 129, 11, source) + octets
    return body + struct.pack(">H", crc16(body))


def asked(r, mission, begin, end):
    """[(time, origin, words of the plan)]: alone, again before it has ended, and of several grounds."""
    found, count = [], 0
    for _ in range(r.choice([0, 1, 3, 8])):
        at = r.uniform(begin, end)
        for _ in range(r.choice([1, 1, 1, 2, 4])):
            draw, octets = r.random(), data(r, at)
            if draw < 0.7:
                origin, words = "ground", f"tc ground {mission.supervisor.apid} 129 11 {r.choice([15, 15, 15, 0, 9, 1])} {octets.hex()}"
            elif draw < 0.9:
                count += 1
                origin, words = "another ground", f"raw ground {packet(r.choice(OTHER_GROUNDS), count, octets).hex()}"
            else:
                origin = r.choice(mission.members).name
                words = f"tc {origin} {r.choice([mission.supervisor, *mission.members]).apid} 129 11 15 {octets.hex()}"
            found.append((at, origin, words))
            at += r.choice([0.0, 0.004, 0.05, 0.5, 2])
    return found
