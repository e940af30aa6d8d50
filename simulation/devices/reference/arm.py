#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""arm.py HOST:PORT HOST:PORT|NAME: frames and second inhibit of a six-joint arm, by UDP or by a UNIX socket NAME (docs/guide/your_robot.md). drives.py is yours to replace."""
import binascii, os, select, socket, struct, sys, time

from drives import JOINTS, MOST, Drives

OFF, ACTIVE, TRIPPED, OLD_EPOCH, MOVING, BRAKING, HOLDING = 0, 1, 1, 2, 1, 2, 3
CYCLE, FRESH = 0.002, 0.05                                     # s
HEAD, SECOND = struct.Struct("<HBBIIHHI"), struct.Struct("<HBBHII")

def check(octets):
    return struct.pack("<H", binascii.crc_hqx(octets, 0xFFFF))

class Arm:
    def __init__(self, drives):
        self.drives, self.wanted = drives, [0.0] * JOINTS
        self.epoch = self.sequence = self.flags = self.mode = self.heard = 0
        self.watchdog_at, self.second = 0.0, (0, 0, -1.0)      # of the second inhibit: on, epoch, when
    def watch(self, now):                                      # duty 3; a drive that let go says so, too: it is no longer who was commanded
        if self.mode != OFF and now >= self.watchdog_at or self.drives.fault:
            self.flags |= TRIPPED
    def take(self, frame, now):                                # the answer to a command (duty 1); None: it was none (duty 7)
        if len(frame) != HEAD.size + 8 * JOINTS + 2 or check(frame[:-2]) != frame[-2:] or frame[:3] != b"DH\x01" or frame[3] > 2 or frame[14:16] != bytes((8 * JOINTS, 0)):
            return None
        mode, epoch, sequence, _, _, watchdog_us = HEAD.unpack_from(frame)[2:]
        if epoch < self.epoch:                                 # duty 2
            self.flags |= OLD_EPOCH
            return self.status()
        self.watch(now)
        if epoch > self.epoch:                                 # faults are cleared with a new epoch, never because somebody goes on commanding
            self.drives.clear()
        latched = self.flags & TRIPPED and epoch == self.epoch or mode == ACTIVE and not self.heard  # duty 4
        self.flags, self.epoch, self.sequence, self.mode, self.heard = TRIPPED if latched else 0, epoch, sequence, mode, 1
        values = struct.unpack_from(f"<{JOINTS}d", frame, HEAD.size)
        if mode == ACTIVE and all(-MOST <= each <= MOST for each in values):  # no number is within
            self.wanted = list(values)
        self.watchdog_at = now + min(watchdog_us * 1e-6 or 0.01, 1.0)
        return self.status()
    def status(self):
        values = self.drives.angle + self.drives.speed + self.drives.torque
        frame = HEAD.pack(0x4844, 2, 0, self.epoch, self.sequence, self.flags, 8 * len(values), 0) + struct.pack(f"<{len(values)}d", *values)
        return frame + check(frame)
    def inhibit(self, frame, now):                             # of the supervisor's side; it is told what the drives do
        if len(frame) != 16 or check(frame[:-2]) != frame[-2:] or frame[:3] != b"EH\x33":
            return None
        on, _, epoch, sequence = SECOND.unpack_from(frame)[2:]
        self.second = on == 1, epoch, now
        does = MOVING if self.drives.enabled else BRAKING if any(self.drives.speed) else HOLDING
        frame = SECOND.pack(0x4845, 0x4C, does, self.flags, self.epoch, sequence)
        return frame + check(frame)
    def step(self, now):                                       # duty 5: the stop is its own
        self.watch(now)
        on, epoch, at = self.second
        if self.mode == ACTIVE and not self.flags & TRIPPED and on and epoch == self.epoch and now - at < FRESH:
            self.drives.enabled or self.drives.enable()
        elif self.drives.enabled:
            self.drives.stop()
        self.drives.step(self.wanted, CYCLE)

def bound(address):
    host, _, port = address.rpartition(":")
    way = socket.socket(socket.AF_INET if host else socket.AF_UNIX, socket.SOCK_DGRAM)
    if not host and os.path.exists(address):                   # a file of this folder, which one that was killed has left
        os.unlink(address)
    way.bind((host, int(port)) if host else address)
    return way

def main(*addresses):
    arm, due = Arm(Drives()), time.monotonic()
    ways = {bound(address): answer for address, answer in zip(addresses, (arm.take, arm.inhibit))}
    while True:
        for way in select.select(list(ways), [], [], max(0, due - time.monotonic()))[0]:
            try:
                frame, peer = way.recvfrom(2048)
                answer = ways[way](frame, time.monotonic())
                answer and way.sendto(answer, socket.MSG_DONTWAIT, peer)  # duty 6: it waits for nobody
            except OSError:
                pass
        while due <= time.monotonic():
            arm.step(due)
            due += CYCLE

if __name__ == "__main__":
    main(*sys.argv[1:])
