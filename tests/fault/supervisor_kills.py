#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""kill -9 of the supervisor, N times (`--kills N`), while the robot pushes on the rail and a client commands without a pause
(docs/adr/0093). Each time another one goes on with both machines as they are. Every sixth kill falls between TM[1,1] and TM[1,7] of a
SAFE_ALL. In the end what the client sent and received is compared with each other and with the log."""
import math
import os
import random
import signal
import struct
import sys
import threading
import time
import unittest

import flight
import honest

KILLS = int(sys.argv.pop(sys.argv.index("--kills") + 1)) if "--kills" in sys.argv else 6
if "--kills" in sys.argv:
    sys.argv.remove("--kills")
SEED = 20261124
ADOPTED_S = 1.0
# A supervisor that lives for 2 s is no part of a crash loop (supervisor/keeper/kept.hpp).
LIVES_S = 2.2
PUSHES_N = 10.0
FREE_MM = 22                     # the robot, at its home, is so far from the rail
POS_SCALE = flight.MANIPULATOR << 16 | 10 << 8 | 8
TELEPRESENCE = 3


class Client:
    """Asks both machines in turn: a ping, which waits for nothing, and the value of a parameter, which waits for the log."""

    def __init__(self, ground, port=honest.TELECOMMAND_PORT):
        import socket
        self.ground, self.sent, self.ending = ground, [], False
        self.mutex = threading.Lock()
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.ending:
            apid = (flight.MANIPULATOR, flight.JOYSTICK)[len(self.sent) // 2 % 2]
            if len(self.sent) % 2 or apid == flight.JOYSTICK:
                self.send(honest.telecommand(apid, self.ground.next()))
            else:
                self.send(honest.telecommand(apid, self.ground.next(), 20, struct.pack(">BI", 1, POS_SCALE)))
            time.sleep(0.005)

    def send(self, packet):
        with self.mutex:
            self.sent.append((packet, time.monotonic()))
            self.socket.sendall(packet)
        return packet


class Accounts(unittest.TestCase):
    """What a client sent and received, compared with each other and with the log."""

    def push(self, craft, from_mm=FREE_MM):
        """Until the robot leans on the rail: the hand goes so far, and farther. What is felt in the blow alone is over after a second."""
        for reach_mm in range(from_mm, from_mm + 30, 4):
            craft.fault("joystick", "hand", "cartesian", reach_mm / 1e3, 0, 0.5)
            time.sleep(1.0)
            if craft.truth("robot")["force"] > 2 * PUSHES_N:
                return
        self.fail("the robot does not push")

    def compare(self, rokviss, ground, sent, most_silent=0):
        silent, several, accepted_only, unknown = [], [], [], 0
        for request, times in self.sent_at(sent).items():
            reports = ground.reports.get(request, [])
            # A sequence count comes again after 16384: what is told until then is about the telecommand before.
            for at, until in zip(times, [*times[1:], math.inf]):
                subtypes = [subtype for subtype, told_at in reports if at <= told_at < until]
                ends = [subtype for subtype in subtypes if subtype in honest.ENDS]
                if not subtypes:
                    silent.append((request.hex(), at))
                elif not ends:
                    accepted_only.append((request.hex(), subtypes))
                if len(ends) > 1:
                    several.append((request.hex(), subtypes))
                unknown += 8 in subtypes
        flight.measure(f"ended as unknown: {unknown}, without any report: {len(silent)}")
        self.is_continuous(rokviss)
        self.assertEqual(several, [], "one end each")
        self.assertEqual(accepted_only, [], "what was accepted has an end")
        self.assertLessEqual(len(silent), most_silent, f"between reading and noting: {silent[:5]}")

    @staticmethod
    def sent_at(sent):
        """{request id: when it was sent, first of all first}."""
        times = {}
        for packet, at in sent:
            times.setdefault(packet[:4], []).append(at)
        return times

    def is_continuous(self, rokviss):
        """Each number of the log once, in a record or in a gap that says so."""
        expected, missing = None, 0
        for record in rokviss.log():
            number = record["number"]
            if expected is not None:
                self.assertEqual(number, expected, record)
            expected = number + 1
            if record["kind"] == "gap":
                missing += int(record["text"].rsplit("number ", 1)[1].split('"')[0]) - number + 1
                expected = int(record["text"].rsplit("number ", 1)[1].split('"')[0]) + 1
        flight.measure(f"numbers of the log that stand in gaps: {missing}")


class SupervisorKills(Accounts):
    def test_nothing_is_lost_and_the_robot_stays_coupled(self):
        draw = random.Random(SEED)
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.push(rokviss)
            ground = honest.Honest()
            client = Client(ground)
            took = []
            for kill in range(1, KILLS + 1):
                time.sleep(LIVES_S + draw.uniform(0.0, 0.3))
                begin = rokviss.count()
                stopped = kill % 6 == 0
                if stopped:
                    packet = client.send(honest.safe_all(ground.next()))
                    self.assertTrue(ground.wait(lambda: ground.reports.get(packet[:4]), 2.0), "it is accepted")
                killed = rokviss.kill("hirosco-supervisor")
                told = rokviss.wait_told("goes on with MANIPULATOR", 5.0, begin)
                took.append(told.received - killed)
                self.assertLess(took[-1], ADOPTED_S, f"kill {kill}")
                if stopped:
                    rokviss.wait_at_rest("robot", time.monotonic())
                    self.assertIsNotNone(ground.verdict(packet, 5.0), "SAFE_ALL has an end")
                    # The robot stands at the rail; the hand comes back before they are coupled again where they are.
                    rokviss.fault("joystick", "hand", "cartesian", 0, 0, 0.5)
                    time.sleep(1.0)
                    self.assertEqual(rokviss.tc("supervisor", "SET_MODE", TELEPRESENCE)[0], 0, f"kill {kill}: up again")
                    self.push(rokviss, 4)
                    continue
                self.assertNotIn("stopped", told.told, f"kill {kill}")
                self.assertGreater(rokviss.truth("robot")["force"], PUSHES_N, f"kill {kill}: the robot goes on")
            time.sleep(LIVES_S)
            client.ending = True
            client.thread.join()
            sent = list(client.sent)
            for packet, _ in sent[-200:]:
                ground.verdict(packet, 5.0)
            self.compare(rokviss, ground, sent, KILLS // 50)
            took.sort()
            flight.measure(f"{KILLS} kills of the supervisor, {len(sent)} telecommands, another one went on after "
                           f"{took[len(took) // 2]:.3f} s, {took[-1]:.3f} s at most")


if __name__ == "__main__":
    flight.main()
