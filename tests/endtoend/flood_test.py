#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Beside any flood of telecommands, valid or damaged, an honest client's SAFE_ALL is carried out and reported, and every
telecommand that anybody sent is in a report or a counter.

    flood_test.py                          20 times SAFE_ALL beside each flood
    HIROSCO_SAFE_ALLS=1000 flood_test.py   the long form
"""
import collections
import os
import socket
import time
import unittest

import flight
from honest import (ENDS, FLOOD, SUPERVISOR, TELECOMMAND_PORT, Beside, Honest, busy, damaged_pings, flood,
                    one_octet_a_second, request_id, safe_all, telecommand, valid_pings)

SAFE_ALLS = int(os.environ.get("HIROSCO_SAFE_ALLS", "20"))
LIMIT_MS = 500.0


class Flood(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.flight = cls.enterClassContext(flight.Flight())
        cls.flight.wait_commissioned()
        cls.honest = Honest()
        cls.honest.socket.sendall(telecommand(SUPERVISOR, cls.honest.next()))     # a listener keeps its place by a ping
        cls.commander = socket.create_connection(("127.0.0.1", TELECOMMAND_PORT))

    def safe_alls(self, beside):
        times, missing = [], 0
        for _ in range(SAFE_ALLS):
            packet = safe_all(self.honest.next())
            self.honest.reports.pop(request_id(packet), None)
            begin, stolen = time.monotonic(), flight.stolen_s()
            self.commander.sendall(packet)
            found = self.honest.verdict(packet, 10.0)
            if found is None or 1 not in found or not ({7, 8} & set(found)):
                missing += 1
                continue
            times.append(max(0.0, (max(found.values()) - begin - (flight.stolen_s() - stolen)) * 1000))
        times.sort()
        flight.measure(f"SAFE_ALL beside {beside}: {len(times)} of {SAFE_ALLS} with their reports, "
                       + (f"median {times[len(times) // 2]:.1f} ms, largest {times[-1]:.1f} ms" if times else "none"))
        self.assertFalse(self.honest.closed, "the honest client was cut off")
        self.assertEqual(missing, 0, "SAFE_ALL without acceptance or final report")
        self.assertLessEqual(times[-1], LIMIT_MS)

    def test_beside_valid_pings_it_is_carried_out_and_each_ping_has_its_report(self):
        received, _ = self.honest.link()
        before = dict(self.honest.by_source)
        begin = time.monotonic()
        with Beside(flood, [valid_pings(a) for a in (1, 10, 11)], [TELECOMMAND_PORT] * 3) as sent:
            self.safe_alls("valid pings")
        took = time.monotonic() - begin
        rose = lambda subtype: self.honest.by_source[FLOOD, subtype] - before.get((FLOOD, subtype), 0)
        self.honest.wait(lambda: rose(1) + rose(2) + rose(10) >= sent.value, 20.0)
        accepted, refused = rose(1), rose(2) + rose(10)
        self.assertFalse(self.honest.closed)
        flight.measure(f"{sent.value} pings in {took:.1f} s, {sent.value / took:.0f}/s: {accepted} accepted, {refused} refused")
        self.assertEqual(accepted + refused, sent.value)
        self.assertEqual(self.honest.link()[0] - received, sent.value + SAFE_ALLS)

    def test_beside_damaged_packets_it_is_carried_out_and_each_of_them_is_counted(self):
        checksums, (_, clients) = self.honest.refused_for_checksum(), self.honest.link()
        with Beside(flood, [damaged_pings()] * 3, [TELECOMMAND_PORT] * 3) as sent:
            self.safe_alls("damaged packets")
        self.assertEqual(self.honest.link()[1]["damaged"] - clients["damaged"], sent.value)
        self.assertEqual(self.honest.refused_for_checksum() - checksums, sent.value)

    def test_beside_clients_of_one_octet_a_second_it_is_carried_out(self):
        with Beside(one_octet_a_second, 20):
            self.safe_alls("20 clients of one octet a second")

    def test_three_thousand_pings_in_one_send_have_three_thousand_reports(self):
        packets = [telecommand(10, self.honest.next()) for _ in range(3000)]
        for packet in packets:
            self.honest.reports.pop(request_id(packet), None)
        reports = lambda packet: [subtype for subtype, _ in self.honest.reports.get(request_id(packet), [])]
        # Who answers and who takes the answers get the processors at different times.
        with Beside(busy), Beside(busy):
            self.honest.socket.sendall(b"".join(packets))
            self.honest.wait(lambda: all(ENDS & set(reports(packet)) for packet in packets), 30.0)
        found = collections.Counter(tuple(reports(packet)) for packet in packets)
        flight.measure(f"3,000 pings in one send: {dict(found)}")
        self.assertEqual(found[1, 3, 7] + found[2,], 3000)

    def test_who_cuts_its_packet_off_is_counted_and_told(self):
        _, before = self.honest.link()
        start = self.flight.count()
        with socket.create_connection(("127.0.0.1", TELECOMMAND_PORT)) as link:
            link.sendall(telecommand(10, 0)[:9])
        self.flight.wait_told("CLIENT_CUT REASON=incomplete packet", 5.0, start)
        self.assertEqual(self.honest.link()[1]["incomplete"] - before["incomplete"], 1)

    def test_every_connection_is_counted_once(self):
        gaps = self.honest.gaps       # a flood before this may have dropped housekeeping (adr 0029)
        _, counted = self.honest.link()
        now = 2                       # the honest client's
        closed = sum(counted[name] for name in ("slow", "evicted", "bad_header", "bad_length", "incomplete", "left",
                                                "broken"))
        self.assertEqual(counted["accepted"], closed + now)
        self.assertEqual(self.honest.gaps, gaps, "telemetry was dropped on its way")


if __name__ == "__main__":
    flight.main()
