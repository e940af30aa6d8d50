#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""device.py HOST:PORT: the reference device again, over TCP, in Python's standard library (docs/guide/your_device.md), for 20 to 200 Hz."""
import binascii, select, socket, struct, sys, time

OFF, ACTIVE, TRIPPED, OLD_EPOCH, CYCLE, STOP, HEAD = 0, 1, 1, 2, 0.002, 0.1, struct.Struct("<HBBIIHHI")

def check(octets):
    return struct.pack("<H", binascii.crc_hqx(octets, 0xFFFF))

class Axis:
    epoch = sequence = flags = mode = heard = 0
    watchdog_at, stop_end, wanted, position, velocity, before_stop, output = 6 * (0.0,) + ("off",)
    def watch(self, now):                                        # duty 3: its own watchdog
        self.flags |= TRIPPED if self.mode != OFF and now >= self.watchdog_at else 0
    def take(self, frame, now):                                  # the answer to a command (duty 1); None: it was none
        if len(frame) != HEAD.size + 10 or check(frame[:-2]) != frame[-2:] or frame[:3] != b"DH\x01" or frame[3] > 2 or frame[14:16] != b"\x08\0":
            return None
        mode, epoch, sequence, _, _, watchdog_us = HEAD.unpack_from(frame)[2:]
        if epoch < self.epoch:                                   # duty 2: nobody from before a fence
            self.flags |= OLD_EPOCH
            return self.status()
        self.watch(now)                                          # before a late command can hide it
        begins = mode == ACTIVE and not self.heard               # duty 4: the latch, and who begins is let go
        self.flags = TRIPPED if begins or self.flags & TRIPPED and epoch == self.epoch else 0
        self.epoch, self.sequence, self.mode, self.heard = epoch, sequence, mode, 1
        self.wanted = next((v for v in struct.unpack_from("<d", frame, HEAD.size) if mode == ACTIVE and -10 <= v <= 10), self.wanted)
        self.watchdog_at = now + min(watchdog_us * 1e-6 or 0.01, 1.0)
        return self.status()
    def status(self):
        frame = HEAD.pack(0x4844, 2, 0, self.epoch, self.sequence, self.flags, 16, 0) + struct.pack("<dd", self.position, self.velocity)
        return frame + check(frame)
    def step(self, now):                                         # duty 5: the stop is its own
        self.watch(now)
        before = self.output
        if self.mode == ACTIVE and not self.flags & TRIPPED:
            self.output, self.velocity = "active", self.wanted
        elif before == "active":
            self.output, self.stop_end, self.before_stop = "stopping", now + STOP, self.velocity
        if self.output == "stopping":
            self.velocity = self.before_stop * max(self.stop_end - now, 0) / STOP
            self.output = "stopping" if now < self.stop_end else "holding"
        self.position += self.velocity * CYCLE
        if self.output != before:
            print(int(now * 1e9), f"{self.output} epoch {self.epoch} flags {self.flags} position {self.position:.4f} velocity {self.velocity:.4f}", flush=True)

def frames_of(stream):                                           # which loses them; duty 7: after damage it finds its place again
    while len(stream) >= 6:
        octets, head = int.from_bytes(stream[2:4], "little"), bytes(stream[:4])
        good = head[:2] == b"HS" and octets <= 1024 and check(head) == stream[4:6]
        if good and len(stream) < octets + 8:
            return
        frame = bytes(stream[6:6 + octets])
        good = good and check(frame) == stream[6 + octets:8 + octets]
        del stream[:octets + 8 if good else 1]
        if good:
            yield frame

def main(address):
    axis, due, own, peer, stream = Axis(), time.monotonic(), socket.create_server((address.split(":")[0], int(address.split(":")[1]))), None, bytearray()
    while True:
        ready = select.select([each for each in (own, peer) if each], [], [], max(0, due - time.monotonic()))[0]
        try:
            if own in ready:                                     # who comes last is the one
                peer, stream = own.accept()[0], bytearray()
            elif ready:
                octets = peer.recv(4096)
                stream += octets
                for answer in filter(None, (axis.take(each, time.monotonic()) for each in frames_of(stream))):
                    head = b"HS" + struct.pack("<H", len(answer))
                    peer.send(head + check(head) + answer + check(answer), socket.MSG_DONTWAIT)  # duty 6: it waits for nobody
                peer = peer if octets else None
        except OSError:
            peer = None
        while due <= time.monotonic():
            axis.step(due)
            due += CYCLE

main(sys.argv[1])
