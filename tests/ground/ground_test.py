# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The ground station on a real flight with real sockets: killed and restarted, beside a stalled browser and beside 10,000
events in a burst. Python's standard library only; prints what it measured."""
import base64
import contextlib
import json
import os
import pathlib
import re
import signal
import socket
import sqlite3
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

import flight

TOKEN = "0123456789abcdef"


class Gateway:
    """`hirosco ground` on a port of its own; killed at the end."""

    def __init__(self, folder, telemetry=None, mission=flight.ROKVISS, archive="ground.db"):
        words = [str(flight.BINARIES / "hirosco"), "ground", str(mission), "--port", "0", "--json",
                 "--archive", str(pathlib.Path(folder) / archive)]
        if telemetry:
            words += ["--telemetry", telemetry]
        self.started = time.monotonic()
        self.process = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE,
                                        env={**os.environ, "HIROSCO_GROUND_TOKEN": TOKEN})
        url = json.loads(self.process.stdout.readline())["url"]
        self.base, self.port = url.split("/#")[0], int(re.search(r":(\d+)/", url)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end(signal.SIGTERM)

    def end(self, number):
        if self.process.poll() is None:
            self.process.send_signal(number)
        self.process.wait(10)
        self.process.stdout.close()

    def request(self, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Authorization": f"Bearer {TOKEN}"})
        with urllib.request.urlopen(request, timeout=10) as answer:
            return json.loads(answer.read())

    def until(self, condition, limit_s=15.0):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            status = self.request("/api/status")
            if condition(status):
                return status
            time.sleep(0.02)
        raise AssertionError(f"not within {limit_s} s: {status['mode']} {status['link']}")


class WebSocket:
    """As much of RFC 6455 as a client needs here."""

    def __init__(self, gateway, receive_octets=None):
        self.socket = socket.socket()
        if receive_octets:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_octets)
        self.socket.connect(("127.0.0.1", gateway.port))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /ws?token={TOKEN} HTTP/1.1\r\nHost: 127.0.0.1:{gateway.port}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                             "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        self.buffer = b""
        while b"\r\n\r\n" not in self.buffer:
            self.buffer += self.socket.recv(4096)
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        assert b" 101 " in head, head

    def _take(self, octets):
        while len(self.buffer) < octets:
            more = self.socket.recv(1 << 16)
            if not more:
                raise EOFError
            self.buffer += more
        taken, self.buffer = self.buffer[:octets], self.buffer[octets:]
        return taken

    def receive(self, limit_s=10.0):
        self.socket.settimeout(limit_s)
        while True:
            first, second = self._take(2)
            length = second & 127
            if length >= 126:
                length = int.from_bytes(self._take(2 if length == 126 else 8), "big")
            payload = self._take(length)
            if first & 15 == 1:
                return json.loads(payload)
            if first & 15 == 8:
                raise EOFError(int.from_bytes(payload[:2], "big"))

    def close(self):
        self.socket.close()


class Witness:
    """Another client of the telemetry port, which shares nothing with the station: the packets that it hears, but for what comes down
    for others a second time."""

    def __init__(self):
        self.packets, self.socket = set(), socket.create_connection(("127.0.0.1", flight.PORT), 5.0)
        self.thread = threading.Thread(target=self._hear, daemon=True)
        self.thread.start()

    def _hear(self):
        buffer = b""
        with contextlib.suppress(OSError):
            while octets := self.socket.recv(1 << 16):
                buffer += octets
                while len(buffer) >= 6 and len(buffer) >= (size := 7 + int.from_bytes(buffer[4:6], "big")):
                    if tuple(buffer[7:9]) not in ((129, 12), (129, 13)):
                        self.packets.add(buffer[:size])
                    buffer = buffer[size:]

    def close(self):
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self.thread.join(5.0)
        self.socket.close()
        return self.packets


class Listener(threading.Thread):
    """Counts what comes, until closed."""

    def __init__(self, gateway):
        super().__init__(daemon=True)
        self.socket, self.messages, self.times = WebSocket(gateway), [], []
        self.start()

    def run(self):
        try:
            while True:
                message = self.socket.receive(30.0)
                self.times.append(time.monotonic())
                self.messages.append(message)
        except (OSError, EOFError):
            self.socket.close()

    def times_of(self, kind, since=0.0):
        return [at for message, at in zip(list(self.messages), list(self.times)) if message["type"] == kind and at >= since]

    def count(self, kind):
        return len(self.times_of(kind))


def crc16(octets):
    value = 0xFFFF
    for octet in octets:
        value ^= octet << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021) & 0xFFFF if value & 0x8000 else value << 1
    return value


def event_packet(apid, count, seconds, event, severity=1, data=b""):
    """TM[5,severity]."""
    source = struct.pack(">BBBHH", 0x20, 5, severity, count & 0xFFFF, 0) + struct.pack(">I", int(seconds)) + \
        int((seconds % 1) * 2**24).to_bytes(3, "big") + struct.pack(">H", event) + data
    packet = struct.pack(">HHH", 0x0800 | apid, 0xC000 | count & 0x3FFF, len(source) + 1) + source
    return packet + struct.pack(">H", crc16(packet))


class OnAFlight(unittest.TestCase):
    """One flight for all: none of them harms it, and each has a gateway with an archive of its own."""

    @classmethod
    def setUpClass(cls):
        cls.rokviss = cls.enterClassContext(flight.Flight())
        try:
            cls.rokviss.wait_commissioned()
        except AssertionError as error:
            raise AssertionError(cls.rokviss.story()) from error

    def test_killed_and_restarted_it_loses_nothing_that_the_link_delivered(self):
        rokviss = self.rokviss
        first = Gateway(rokviss.folder, archive="killed.db")
        first.until(lambda status: status["link"]["rx"] > 100)
        history = "/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=600"
        before = first.request(history)["t"]
        witness = Witness()
        first.end(signal.SIGKILL)
        time.sleep(2.0)  # some 45 packets a second
        with Gateway(rokviss.folder, archive="killed.db") as second:
            second.until(lambda status: status["link"]["rx"] > 50 and all(one["memory_kb"] for one in status["subsystems"]))
            again = time.monotonic()
            heard = witness.close()
            flight.measure(f"telemetry again {again - second.started:.2f} s after the restart")
            after = second.request(history)
            subsystems = second.request("/api/status")["subsystems"]
            for one in subsystems:  # processes of their own: a few MB each, told by the supervisor
                self.assertTrue(1000 < one["memory_kb"] < 200000, one)
            self.assertLessEqual(set(before), set(after["t"]))
            self.assertGreater(len(after["t"]), len(before))
            # What was said while it was away stands in the log on board, and comes down.
            second.until(lambda _: not second.request(history)["gaps"])
            with contextlib.closing(sqlite3.connect(f"file:{rokviss.folder}/killed.db?mode=ro", uri=True)) as archive:
                kept = {octets for (octets,) in archive.execute("SELECT octets FROM packets")}
            self.assertGreater(len(heard), 50)
            flight.measure(f"{len(heard)} packets that another client heard meanwhile: {len(heard - kept)} are not in the archive")
            self.assertEqual(len(heard - kept), 0)

    def test_a_command_returns_its_report_and_pages_hear_of_each_other(self):
        rokviss = self.rokviss
        with Gateway(rokviss.folder, archive="pages.db") as gateway:
            gateway.until(lambda status: status["mode"] == "telepresence")
            one, other = Listener(gateway), Listener(gateway)
            delays = []
            for number in range(20):
                sent_at = time.monotonic()
                sent = gateway.request("/api/commands", {"subsystem": "MANIPULATOR", "function": "PING",
                                                         "sender": f"operator {number % 2}"})
                end = sent_at + 5.0
                done = []
                while not done and time.monotonic() < end:
                    done = [at for message, at in zip(list(other.messages), list(other.times))
                            if message["type"] == "command" and message["id"] == sent["id"] and
                            message["stage"] == "completed"]
                    time.sleep(0.001)
                delays.append((done[0] - sent_at) * 1000)
            flight.measure(f"from the click to its last report on another page: median {sorted(delays)[10]:.1f} ms, "
                           f"greatest {max(delays):.1f} ms")
            self.assertLess(sorted(delays)[10], 150.0)
            gateway.until(lambda status: one.count("command") == other.count("command"))
            self.others_are_named(rokviss, gateway)
            one.socket.close()
            other.socket.close()

    def others_are_named(self, rokviss, gateway):
        """What `hirosco tc` and another gateway send stands in the history with function, arguments and sender."""
        rokviss.tc("joystick", "SET_FORCE_SCALE", "0.05")
        rokviss.tc("manipulator", "MOVE_TO", "0.1", "1.2", "2")
        with Gateway(rokviss.folder, archive="second.db") as second:
            second.until(lambda status: status["mode"] == "telepresence")
            pings = [second.request("/api/commands", {"subsystem": name, "function": "PING"})
                     for name in ["COMMUNICATION", "JOYSTICK", "MANIPULATOR"] * 10]
            wanted = [("SET_FORCE_SCALE", {"SCALE": 0.05}), ("MOVE_TO", {"Q1": 0.1, "Q2": 1.2, "DURATION": 2})] + \
                     [("PING", {})] * len(pings)

            def newest():
                return gateway.request(f"/api/commands?limit={len(wanted)}")["commands"][::-1]
            gateway.until(lambda status: newest()[0]["function"] == "SET_FORCE_SCALE" and
                          all(one["stage"] in ("completed", "failed") for one in newest()))
            seen = newest()
        self.assertEqual([(one["function"], one["arguments"]) for one in seen], wanted)
        self.assertEqual([one["sender"].rsplit(" ", 1)[0] for one in seen],
                         ["hirosco tc"] * 2 + ["another ground station"] * len(pings))
        self.assertEqual([one["stage"] for one in seen], ["completed", "failed"] + ["completed"] * len(pings))

    def test_a_stalled_and_a_killed_browser_cost_the_others_nothing(self):
        rokviss = self.rokviss
        with Gateway(rokviss.folder, archive="stalled.db") as gateway:
            gateway.until(lambda status: status["mode"] == "telepresence")
            good = Listener(gateway)
            time.sleep(1.0)

            def rate():
                """The best of three windows: a cost is in each of them, a moment without processor in one. Batches that
                a moment has piled up come faster than they are made, which says nothing."""
                made = 20.0
                best = 0.0
                for _ in range(3):
                    since = time.monotonic()
                    time.sleep(1.0)
                    times = good.times_of("values", since)
                    best = max(best, (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 else 0.0)
                return min(best, made)

            alone = rate()
            stalled = [WebSocket(gateway, receive_octets=4096) for _ in range(5)]    # never read
            killed = WebSocket(gateway)
            killed.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            killed.close()
            beside = rate()
            flight.measure(f"batches a second: {alone:.2f} alone, {beside:.2f} beside 5 stalled and 1 killed browser")
            self.assertGreater(beside, alone * 0.95)
            self.assertGreater(alone, 15.0)
            for one in [*stalled, good.socket]:
                one.close()


class OnAStream(unittest.TestCase):
    """A spacecraft that sends what we want it to send."""

    def test_ten_thousand_events_in_a_burst_all_arrive_in_order_and_are_kept(self):
        burst = 10_000
        with socket.create_server(("127.0.0.1", 0)) as server:
            with tempfile.TemporaryDirectory() as folder, \
                    Gateway(folder, telemetry=f"127.0.0.1:{server.getsockname()[1]}") as gateway:
                craft, _ = server.accept()
                page = Listener(gateway)
                now = time.time() + 378_691_237
                packets = [event_packet(10, n, now + n * 1e-4, 1010, 2, struct.pack(">Bf", 1, float(n)))
                           for n in range(burst)]
                started = time.monotonic()
                for at in range(0, burst, 100):
                    craft.sendall(b"".join(packets[at:at + 100]))
                end = started + 20
                while page.count("event") < burst and time.monotonic() < end:
                    time.sleep(0.05)
                flight.measure(f"{burst} events on the page after {page.times[-1] - started:.2f} s")
                page.socket.close()
                values = [message["values"]["VALUE"] for message in page.messages if message["type"] == "event"]
                self.assertEqual(values, list(range(burst)))
                kept = gateway.request("/api/events?limit=10000")["events"]
                self.assertEqual(len(kept), burst)
                self.assertEqual(kept[0]["values"]["VALUE"], burst - 1)
                self.assertEqual(gateway.request("/api/status")["link"]["lost"], 0)
                craft.close()

    def test_rubbish_costs_the_connection_only(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            with tempfile.TemporaryDirectory() as folder, \
                    Gateway(folder, telemetry=f"127.0.0.1:{server.getsockname()[1]}") as gateway:
                for rubbish in (b"\xff" * 5000, b"\x18\x0a" + b"\x00" * 100, os.urandom(20_000)):
                    craft, _ = server.accept()
                    craft.sendall(rubbish)
                    craft.settimeout(5.0)
                    try:
                        self.assertEqual(craft.recv(1), b"")
                    except ConnectionResetError:
                        pass
                    craft.close()
                craft, _ = server.accept()
                craft.sendall(event_packet(10, 0, time.time() + 378_691_237, 1010, 2, struct.pack(">Bf", 1, 60.0)))
                gateway.until(lambda status: status["link"]["rx"] == 1)
                craft.close()


class TakenPort(unittest.TestCase):
    def test_the_page_goes_to_the_next_port_and_says_so(self):
        with socket.socket() as other, tempfile.TemporaryDirectory() as folder:
            other.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                other.bind(("127.0.0.1", 8080))
                other.listen()
            except OSError:
                pass  # Somebody else has it: as good.
            words = [str(flight.BINARIES / "hirosco"), "ground", str(flight.ROKVISS), "--json", "--archive", folder + "/ground.db"]
            with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as station:
                url = json.loads(station.stdout.readline())["url"]
                station.terminate()
                said = station.stderr.read()
        port = int(re.search(r":(\d+)/", url)[1])
        self.assertTrue(8080 < port < 8100, url)
        self.assertIn(f"port 8080 is taken, so the page is at {port}", said)

    def test_a_port_that_was_asked_for_and_is_taken_is_refused(self):
        with socket.socket() as other, tempfile.TemporaryDirectory() as folder:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            words = [str(flight.BINARIES / "hirosco"), "ground", str(flight.ROKVISS), "--port", str(port), "--archive", folder + "/ground.db"]
            ended = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=30)
        self.assertEqual(ended.returncode, 3)
        self.assertIn(f"port {port}: the port is taken", ended.stderr)


if __name__ == "__main__":
    flight.main()
