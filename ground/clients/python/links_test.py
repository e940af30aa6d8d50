#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Which way a telecommand of an exported client leaves: a peer with both ports of a spacecraft, on this computer."""
import contextlib
import dataclasses
import select
import socket
import struct
import threading
import unittest
import unittest.mock

from runtime_test import Arm, Peer
from python import links, runtime
from python.runtime import Craft, Function, LinkLost, MissionAbout

ABOUT = MissionAbout("SMALL", "127.0.0.1", 10015, "ARM", (), (), (), telecommand_port=10025)


class Places(unittest.TestCase):
    """Where a flight listens."""

    def place(self, about=ABOUT, flight=None, **wanted):
        with unittest.mock.patch.object(links, "find_flight", lambda mission, instance: flight):
            place = links.place_of(about, **wanted)
        return place.host, place.port, place.telecommand_port

    def test_nobody_says_otherwise_than_the_mission(self):
        self.assertEqual(self.place(), ("127.0.0.1", 10015, 10025))

    def test_ports_that_were_moved_together_are_as_far_from_each_other(self):
        self.assertEqual(self.place(host="craft", port=20015), ("craft", 20015, 20025))
        self.assertEqual(self.place(host="craft"), ("craft", 10015, 10025))

    def test_a_flight_on_this_computer_says_both(self):
        flight = {"telemetry": "127.0.0.1:10115", "telecommand": "127.0.0.1:10777"}
        self.assertEqual(self.place(flight=flight), ("127.0.0.1", 10115, 10777))
        self.assertEqual(self.place(flight=flight, instance="two", port=10215), ("127.0.0.1", 10215, 10225))
        self.assertEqual(self.place(flight={"telemetry": "127.0.0.1:10115"}), ("127.0.0.1", 10115, 10125))

    def test_who_knows_better_says_so(self):
        self.assertEqual(self.place(host="craft", port=20015, telecommand_port=7), ("craft", 20015, 7))
        self.assertEqual(self.place(host="craft", telecommand_port=0), ("craft", 10015, 0))

    def test_what_is_no_port_is_none(self):
        self.assertEqual(self.place(host="craft", port=65530)[2], 0)
        self.assertEqual(self.place(about=dataclasses.replace(ABOUT, telecommand_port=0), host="craft")[2], 0)


class Switch(Arm):
    _about = dataclasses.replace(Arm._about, functions=(*Arm._about.functions, Function("STOP", alone=True)))

    def stop(self, wait=5.0):
        return self._call("STOP", (), wait)


class TwoWays(unittest.TestCase):
    def setUp(self):
        self.peer, self.port = Peer(), Peer()
        about = dataclasses.replace(ABOUT, port=self.peer.port, telecommand_port=self.port.port)
        self.small = type("Small", (Craft,), {"_about": about})
        self.sockets = []
        self.craft = self.started(self.small())
        self.accept(self.peer, self.port)
        self.addCleanup(self.close)

    def accept(self, *peers):
        for peer in peers:
            peer.accept(last=False)
            self.sockets.append(peer.socket)

    def close(self):
        for one in [*self.sockets, self.peer._listener, self.port._listener]:
            one.close()

    def started(self, craft):
        craft.arm = Switch(craft)
        craft._subsystems = (craft.arm,)
        craft._start()
        self.addCleanup(craft.close)
        return craft

    def in_thread(self, what):
        """Whatever waits for ever there ends the test all the same; its result."""
        told = []
        thread = threading.Thread(target=lambda: told.append(what()), daemon=True)
        thread.start()
        return thread, told

    def fill(self, octets):
        with contextlib.suppress(BlockingIOError):
            while True:
                self.craft._socket.send(bytes(octets), socket.MSG_DONTWAIT)

    def assert_nothing_came(self, peer):
        peer.socket.settimeout(0.0)
        with self.assertRaises(BlockingIOError):
            peer.socket.recv(1)

    def test_what_is_essential_has_a_connection_of_its_own_and_reports_come_by_the_link(self):
        thread, told = self.in_thread(self.craft.arm.stop)
        request = self.port.telecommand()
        self.assertEqual(request[11:15], b"STOP")
        self.peer.verify(request, 1)
        self.peer.verify(request, 7)
        thread.join(5.0)
        self.assertEqual([one.stage for one in told[0].verifications], ["accepted", "completed"])
        self.assert_nothing_came(self.peer)

    def test_all_else_leaves_by_the_link(self):
        self.craft.arm.move(3, wait=None)
        self.assertEqual(self.peer.telecommand()[11:15], b"MOVE")
        self.assert_nothing_came(self.port)

    def test_a_link_that_takes_nothing_holds_it_up_no_more_than_who_waits_for_that_link(self):
        def move():
            with contextlib.suppress(LinkLost):
                self.craft.arm.move(3, wait=None)

        # Until neither end has room for an octet, and keeps having none: this peer reads nothing.
        while select.select([], [self.craft._socket], [], 0.2)[1]:
            self.fill(65536)
        self.fill(1)
        moving, _ = self.in_thread(move)
        while not self.craft._in_turn.locked():
            moving.join(0.01)
        stopping, told = self.in_thread(self.craft.arm.stop)
        request = self.port.telecommand()
        self.peer.verify(request, 7)
        stopping.join(5.0)
        self.assertTrue(told and told[0].done)
        self.assertTrue(moving.is_alive(), "it still waits")
        self.peer.socket.close()
        moving.join(5.0)
        self.assertFalse(moving.is_alive())

    def test_a_connection_that_was_lost_is_made_again(self):
        for end in (lambda one: None, lambda one: one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))):
            end(self.port.socket)
            self.port.socket.close()
            self.craft.arm.stop(wait=None)
            self.accept(self.port)
            self.assertEqual(self.port.telecommand()[11:15], b"STOP")
        self.assert_nothing_came(self.peer)

    def test_without_that_port_the_link_has_to_do(self):
        self.port.socket.close()
        self.port._listener.close()
        self.craft.arm.stop(wait=None)
        self.assertEqual(self.peer.telecommand()[11:15], b"STOP")
        later = self.started(self.small())
        self.accept(self.peer)
        later.arm.stop(wait=None)
        self.assertEqual(self.peer.telecommand()[11:15], b"STOP", "it was not there at first either")

    def test_without_a_link_it_is_sent_and_nobody_is_told_that_it_was_done(self):
        self.peer.socket.close()
        self.craft.wait_until(lambda: not self.craft.connected)
        with self.assertRaisesRegex(LinkLost, "ARM.STOP was sent, but nobody hears what becomes of it"):
            self.craft.arm.stop()
        self.assertEqual(self.port.telecommand()[11:15], b"STOP")
        with self.assertRaises(LinkLost):
            self.craft.arm.move(3)

    def test_it_is_looked_for_where_the_mission_flies_next(self):
        with unittest.mock.patch.object(runtime, "RECONNECT_S", 0.01):
            craft = self.started(self.small(reconnect=True))
            self.accept(self.peer, self.port)
            first = self.port.socket
            self.peer.socket.close()
            self.accept(self.peer, self.port)
            self.assertEqual(first.recv(1), b"", "the old one has ended")
            craft.wait_until(lambda: craft.connected)
            craft.arm.stop(wait=None)
            self.assertEqual(self.port.telecommand()[11:15], b"STOP")

    def test_a_client_that_is_closed_says_nothing_any_more(self):
        self.craft.close()
        self.assertEqual(self.port.socket.recv(1), b"")
        with self.assertRaises(LinkLost):
            self.craft.arm.stop()


if __name__ == "__main__":
    unittest.main()
