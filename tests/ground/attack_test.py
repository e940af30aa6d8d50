# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Hostile neighbours of a running ground station: clients that hold connections, send what is no request, or would
command without being allowed to, and a spacecraft that sends anything in valid packets. Python's standard library only."""
import contextlib
import http.client
import json
import os
import random
import socket
import struct
import tempfile
import time
import unittest
import urllib.error
import urllib.request

import flight
from ground_test import TOKEN, Gateway, Listener, WebSocket, crc16, event_packet

OBSERVER = "an-observer-s-token"
EPOCH_S = 378_691_237       # on-board time of 1970-01-01


def anything(noise, count, now):
    """A valid packet with whatever in it, of known and unknown subsystems, services, structures and events."""
    service = noise.choice([1, 3, 3, 5, 5, 17, 129, 200])
    subtype = {3: 25, 5: noise.randint(0, 5), 129: noise.randint(1, 3)}.get(service, noise.randint(0, 11))
    data = noise.randbytes(noise.choice([0, 1, 2, 3, 8, 30, 66, 200, 900]))
    if service in (3, 5):
        data = struct.pack(">H", noise.choice([*range(1, 30), 1000, 1010, 4712, 4713, 65535])) + data
    source = struct.pack(">BBBHH", 0x20, service, subtype, count & 0xFFFF, noise.choice([0, 1, 777, 0x2000])) + \
        struct.pack(">I", noise.choice([0, now, now, 0xFFFFFFFF])) + noise.randbytes(3) + data
    apid = noise.choice([1, 10, 11, 12, 500])
    head = struct.pack(">HHH", 0x0800 | apid, 0xC000 | noise.getrandbits(14), len(source) + 1)
    return head + source + struct.pack(">H", crc16(head + source))


class Attack(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        os.environ["HIROSCO_GROUND_OBSERVER_TOKEN"] = OBSERVER
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.server = cls.enterClassContext(socket.create_server(("127.0.0.1", 0)))
        cls.gateway = cls.enterClassContext(Gateway(cls.folder, telemetry=f"127.0.0.1:{cls.server.getsockname()[1]}"))
        cls.craft = cls.enterClassContext(cls.server.accept()[0])

    def answer_to(self, octets):
        """The first line that comes back."""
        with socket.create_connection(("127.0.0.1", self.gateway.port)) as client:
            client.settimeout(10.0)
            client.sendall(octets)
            return client.recv(4096).split(b"\r\n")[0].decode()

    def head(self, method, path, **headers):
        headers = {"Host": f"127.0.0.1:{self.gateway.port}", "Authorization": f"Bearer {TOKEN}", **headers}
        lines = [f"{method} {path} HTTP/1.1", *(f"{name}: {text}" for name, text in headers.items()), "", ""]
        return "\r\n".join(lines).encode()

    def test_connections_that_ask_nothing_make_room_for_one_that_does(self):
        idle = [socket.create_connection(("127.0.0.1", self.gateway.port)) for _ in range(100)]
        for one in idle[::2]:
            one.sendall(b"GET /api/sta")
        for _ in range(5):
            self.assertIn("link", self.gateway.request("/api/status"))
        for one in idle:
            one.close()

    def test_pages_that_only_look_leave_room_for_a_telecommand(self):
        pages = [WebSocket(self.gateway) for _ in range(48)]
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
                   "Sec-WebSocket-Version": "13"}
        self.assertIn(" 503 ", self.answer_to(self.head("GET", f"/ws?token={TOKEN}", **upgrade)))
        self.assertIn("link", self.gateway.request("/api/status"))
        for one in pages:
            one.close()

    def test_what_is_no_request_is_told_so(self):
        self.assertIn(" 431 ", self.answer_to(self.head("GET", "/api/status", **{"X-Long": "a" * 20_000})))
        self.assertIn(" 400 ", self.answer_to(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"))
        self.assertIn(" 413 ", self.answer_to(self.head("POST", "/api/commands", **{"Content-Length": "70000"})))
        deep = b'{"subsystem":"JOYSTICK","function":"PING","arguments":' + b"[" * 32_000 + b"]" * 1000
        head = self.head("POST", "/api/commands", **{"Content-Length": str(len(deep))})
        self.assertIn(" 400 ", self.answer_to(head + deep))

    def answers_to(self, octets):
        """Everything that comes back until the gateway closes."""
        with socket.create_connection(("127.0.0.1", self.gateway.port)) as client:
            client.settimeout(10.0)
            client.sendall(octets)
            answer = b""
            try:
                while part := client.recv(65536):
                    answer += part
            except ConnectionResetError:
                pass  # it closed on what it had not read
            return answer

    def test_a_body_never_becomes_the_next_request(self):
        hidden = self.head("POST", "/api/commands", **{"Content-Length": "2"}) + b"{}"
        chunked = b"%x\r\n" % len(hidden) + hidden + b"\r\n0\r\n\r\n"
        length = str(len(hidden))
        cases = (({"Transfer-Encoding": "identity"}, hidden, 501), ({"Transfer-Encoding": "gzip"}, hidden, 501),
                 ({"Transfer-Encoding": "xchunked"}, chunked, 501), ({"Transfer-Encoding": "gzip, chunked"}, chunked, 501),
                 ({"Transfer-Encoding": "chunked, identity"}, chunked, 501),
                 ({"Transfer-Encoding": "chunked\r\nTransfer-Encoding: identity"}, chunked, 400),
                 ({"Transfer-Encoding": "chunked", "Content-Length": length}, chunked, 400),
                 ({"Content-Length": length, "Transfer-Encoding": "chunked"}, chunked, 400),
                 ({"Content-Length": f"{length}\r\nContent-Length: 0"}, hidden, 400),
                 ({"Content-Length": "+2"}, hidden, 400),
                 ({"Content-Length": "-1"}, hidden, 400), ({"Content-Length": "0x10"}, hidden, 400),
                 ({"Content-Length": "18446744073709551617"}, hidden, 400),
                 ({"Transfer-Encoding": "chunked"}, b"-1\r\n" + hidden, 400))
        for headers, body, status in cases:
            with self.subTest(**headers):
                answer = self.answers_to(self.head("POST", "/api/commands", **headers) + body)
                self.assertEqual(answer.count(b"HTTP/1.1 "), 1, answer)
                self.assertIn(f" {status} ".encode(), answer.split(b"\r\n")[0])
        self.assertEqual(self.gateway.request("/api/status")["link"]["tx"], 0)

    def test_who_asks_whether_the_body_may_come_is_answered(self):
        body = b'{"subsystem":"NOBODY","function":"PING"}'
        with socket.create_connection(("127.0.0.1", self.gateway.port)) as client:
            client.settimeout(10.0)
            client.sendall(self.head("POST", "/api/commands", Expect="100-continue", **{"Content-Length": str(len(body))}))
            self.assertTrue(client.recv(4096).startswith(b"HTTP/1.1 100 "))
            client.sendall(body)
            self.assertIn(b" 400 ", client.recv(4096).split(b"\r\n")[0])
        self.assertIn(" 417 ", self.answer_to(self.head("POST", "/api/commands", Expect="tea", **{"Content-Length": "2"})))
        self.assertIn(" 413 ", self.answer_to(self.head("POST", "/api/commands", Expect="100-continue",
                                                        **{"Content-Length": "70000"})))

    def test_no_socket_is_opened_for_a_foreign_page(self):
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
                   "Sec-WebSocket-Version": "13"}
        right = f"/ws?token={TOKEN}"
        for path, headers, status in ((right, {"Origin": "http://evil.example"}, 403), (right, {"Origin": "null"}, 403),
                                      (right, {"Host": f"evil.example:{self.gateway.port}"}, 403),
                                      (f"/other?token={TOKEN}", {}, 404), ("/ws", {"Authorization": "Bearer wrong"}, 401),
                                      (right, {"Authorization": "Bearer wrong"}, 401)):
            with self.subTest(path=path, **headers):
                self.assertIn(f" {status} ", self.answer_to(self.head("GET", path, **upgrade, **headers)))

    def test_who_may_not_command_does_not_by_any_door(self):
        command = b'{"subsystem":"JOYSTICK","function":"PING"}'
        for token, status in ((OBSERVER, 403), ("wrong", 401)):
            for path in ("/api/commands", "/api/commands/preview", "/api/faults"):
                headers = {"Authorization": f"Bearer {token}"}
                request = urllib.request.Request(self.gateway.base + path, command, headers)
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    urllib.request.urlopen(request, timeout=10)
                self.assertEqual(refused.exception.code, status)
                refused.exception.close()
        page = WebSocket(self.gateway)
        text = json.dumps({"type": "command", "subsystem": "JOYSTICK", "function": "PING"}).encode()
        mask = os.urandom(4)
        page.socket.sendall(bytes([0x81, 0x80 | len(text)]) + mask + bytes(c ^ mask[i % 4] for i, c in enumerate(text)))
        while (message := page.receive())["type"] != "error":
            pass
        self.assertIn("understood are", message["error"])
        page.close()
        self.assertEqual(self.gateway.request("/api/status")["link"]["tx"], 0)

    def test_no_valid_packet_ends_it_or_the_pages(self):
        noise, now = random.Random(7), int(time.time()) + EPOCH_S
        page = Listener(self.gateway)
        before = self.gateway.request("/api/status")["link"]["rx"]
        packets = 5000
        for count in range(packets):
            self.craft.sendall(anything(noise, count, now))
        self.craft.sendall(event_packet(10, 0, now, 1010, 2, struct.pack(">Bf", 1, 60.0)))
        status = self.gateway.until(lambda status: status["link"]["rx"] == before + packets + 1)
        self.assertAlmostEqual(status["t"], now, delta=60.0)
        for path in ("timeline?from=0&to=9e9", "why", "events?limit=10000", "commands?limit=10000", "export.csv"):
            with self.subTest(path):
                try:
                    self.gateway.request("/api/" + path)
                except urllib.error.HTTPError as refused:
                    self.assertEqual((path, refused.code), ("export.csv", 400))
                    refused.close()
        self.assertTrue(page.is_alive())
        page.socket.socket.shutdown(socket.SHUT_RDWR)
        page.join()


class JammedLink(unittest.TestCase):
    """A spacecraft whose link takes nothing: what is essential leaves at once, and what does not leave is told."""

    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.link, self.essential = self.ports_of_a_mission()
        self.gateway = self.enterContext(Gateway(folder, telemetry=f"127.0.0.1:{self.link.getsockname()[1]}"))
        self.craft = self.enterContext(self.link.accept()[0])
        self.gateway.until(lambda status: status["link"]["connected"])

    def ports_of_a_mission(self):
        """Listening sockets: one for everything, and ten ports above it one for telecommands alone."""
        while True:
            link = socket.socket()
            link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)      # of those that it accepts, too
            link.bind(("127.0.0.1", 0))
            try:
                essential = socket.create_server(("127.0.0.1", link.getsockname()[1] + 10))
            except OSError:
                link.close()
                continue
            link.listen()
            essential.settimeout(10.0)
            return self.enterContext(link), self.enterContext(essential)

    def command(self, subsystem, function):
        return self.gateway.request("/api/commands", {"subsystem": subsystem, "function": function, "arguments": {}})

    def jam(self):
        """More than the two kernels take; the id of the last, which waits in the gateway."""
        keep = self.enterContext(contextlib.closing(http.client.HTTPConnection("127.0.0.1", self.gateway.port, timeout=10)))
        for _ in range(1500):
            keep.request("POST", "/api/commands", '{"subsystem":"JOYSTICK","function":"PING"}',
                         {"Authorization": f"Bearer {TOKEN}"})
            answer = json.loads(keep.getresponse().read())
        return answer["id"]

    def test_past_a_link_that_takes_nothing_safe_all_leaves_at_once(self):
        self.jam()
        self.safe_all_arrives()

    def safe_all_arrives(self):
        stop = self.command("SUPERVISOR", "SAFE_ALL")
        connection = self.enterContext(self.essential.accept()[0])
        connection.settimeout(10.0)
        octets = b""
        while part := connection.recv(4096):
            octets += part
        self.assertEqual(octets.hex().upper(), stop["octets"])

    def lose_the_link(self):
        self.link.close()
        self.craft.close()
        self.gateway.until(lambda status: not status["link"]["connected"])

    def test_without_a_link_safe_all_leaves_and_nothing_else_does(self):
        self.lose_the_link()
        with self.assertRaises(urllib.error.HTTPError) as refused:
            self.command("JOYSTICK", "PING")
        self.assertEqual(refused.exception.code, 503)
        refused.exception.close()
        self.safe_all_arrives()

    def test_safe_all_that_reaches_nobody_is_told_as_not_sent(self):
        self.lose_the_link()
        self.essential.close()
        stop = self.command("SUPERVISOR", "SAFE_ALL")

        def told():
            return next(one for one in self.gateway.request("/api/commands?limit=1")["commands"] if one["id"] == stop["id"])
        self.gateway.until(lambda _: told()["stage"] == "failed")
        self.assertEqual(told()["reason"], "not sent: the link was lost")

    def test_telecommands_that_waited_for_a_link_that_is_lost_are_told_as_not_sent(self):
        last = self.jam()
        self.craft.close()
        self.enterContext(self.link.accept()[0])
        command = next(one for one in self.gateway.request("/api/commands?limit=1")["commands"] if one["id"] == last)
        self.assertEqual((command["stage"], command["reason"]), ("failed", "not sent: the link was lost"))


if __name__ == "__main__":
    flight.main()
