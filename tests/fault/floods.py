# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Telecommands in plenty, and whether each record of the log stands there once."""
import socket

import honest


def flood(pings):
    """Pings to the supervisor, some at a time, as fast as it takes them."""
    with socket.create_connection(("127.0.0.1", honest.TELECOMMAND_PORT), 5.0) as link:
        link.settimeout(60.0)
        for first in range(0, pings, 100):
            link.sendall(b"".join(honest.telecommand(honest.SUPERVISOR, count % 0x4000) for count in range(first, first + 100)))


def lost_in(record):
    return int(record["text"].split(" records lost")[0].split()[-1]) if record["kind"] == "gap" else 1


def assert_continuous(case, records, first):
    """Each number once, from `first` on, but for what gaps name."""
    numbers = [record["number"] for record in records]
    case.assertEqual(numbers, sorted(set(numbers)), "none twice, in order")
    case.assertEqual(numbers[0], first)
    case.assertEqual(sum(map(lost_in, records)), numbers[-1] - first + 1, "none missing")
