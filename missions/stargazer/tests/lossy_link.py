# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A ground link that loses packets and is cut: it stands between a client and the spacecraft. Python's standard library only."""
import contextlib
import socket
import threading


class LossyLink:
    """`with LossyLink(10015, loses) as link:` — connect to `link.port`. Telemetry packets for which `loses(packet)` do not arrive; `cut()` ends
    all connections, new ones are taken."""

    def __init__(self, craft_port, loses):
        self.craft_port, self.loses, self.lost = craft_port, loses, 0
        self._open, self._lock = [], threading.Lock()

    def __enter__(self):
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()
        return self

    def __exit__(self, *_):
        self._listener.close()
        self.cut()

    def cut(self):
        with self._lock:
            for connection in self._open:
                with contextlib.suppress(OSError):
                    connection.shutdown(socket.SHUT_RDWR)
                connection.close()
            self._open.clear()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                client = self._listener.accept()[0]
                craft = socket.create_connection(("127.0.0.1", self.craft_port), 5.0)
                craft.settimeout(None)
                with self._lock:
                    self._open += [client, craft]
                threading.Thread(target=self._up, args=(client, craft), daemon=True).start()
                threading.Thread(target=self._down, args=(craft, client), daemon=True).start()

    @staticmethod
    def _up(client, craft):
        with contextlib.suppress(OSError):
            while octets := client.recv(65536):
                craft.sendall(octets)

    def _down(self, craft, client):
        stream = bytearray()
        with contextlib.suppress(OSError):
            while octets := craft.recv(65536):
                stream += octets
                while len(stream) >= 6 and len(stream) >= (size := 7 + int.from_bytes(stream[4:6], "big")):
                    packet = bytes(stream[:size])
                    del stream[:size]
                    if self.loses(packet):
                        self.lost += 1
                    else:
                        client.sendall(packet)
