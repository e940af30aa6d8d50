# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Two network namespaces and a bad wire between them, for tests that are root: `with Wire() as wire:`.

Each of the two has one interface, `end`, with an address of its own. Its other side is held by this program, which hands every
frame on as an Ethernet cable would, and loses, doubles and overtakes some by a seed."""
import array
import ctypes
import fcntl
import multiprocessing
import os
import random
import selectors
import socket
import struct
import subprocess
import time

ADDRESSES = ("198.18.0.1", "198.18.0.2")     # of tests between networks (RFC 2544)
OVERTAKEN_S = 0.001                           # a frame that none overtakes is late by this
OUTGOING = 4                                  # PACKET_OUTGOING


def possible():
    """Whether this machine lets a test make namespaces and cables."""
    name = f"hirosco-try-{os.getpid()}"
    made = subprocess.run(["ip", "netns", "add", name], capture_output=True, check=False).returncode == 0
    return made and subprocess.run(["ip", "netns", "del", name], capture_output=True, check=False).returncode == 0


def _run(*words):
    subprocess.run(words, check=True, capture_output=True, text=True)


def _leave_sums_to_the_sender(interface):
    """What goes over a cable has its check sums; a virtual one may leave them out."""
    name = array.array("B", struct.pack("II", 0x17, 0))      # ETHTOOL_STXCSUM, off
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, 0x8946, struct.pack("16sP", interface.encode(), name.buffer_info()[0]))


class Wire:
    def __init__(self, seed=1):
        self.seed = seed
        self.names = [f"hirosco-{os.getpid()}-{side}" for side in "ab"]
        self.cables = [f"hx{os.getpid() % 100000}{side}" for side in "ab"]
        # Of a thousand frames: lost, doubled, overtaken.
        self.rates = multiprocessing.Array("i", 3)
        self.cut_off = multiprocessing.Value("b", 0)
        self.counts = multiprocessing.Array("q", 4)           # carried, lost, doubled, overtaken
        self.process = None

    def __enter__(self):
        try:
            for name, cable, address in zip(self.names, self.cables, ADDRESSES):
                _run("ip", "netns", "add", name)
                _run("ip", "link", "add", cable, "type", "veth", "peer", "name", "end", "netns", name)
                inside = ["ip", "-n", name]
                _run(*inside, "address", "add", f"{address}/24", "dev", "end")
                for interface in ("lo", "end"):
                    _run(*inside, "link", "set", interface, "up")
                _run("ip", "link", "set", cable, "up")
            sums = [multiprocessing.Process(target=_sums_inside, args=(name,)) for name in self.names]
            for each in sums:
                each.start()
                each.join()
            if any(each.exitcode for each in sums):
                raise RuntimeError("a namespace could not be entered")
            self.process = multiprocessing.Process(target=self._carry, daemon=True)
            self.process.start()
            return self
        except BaseException:
            self.__exit__()
            raise

    def __exit__(self, *_):
        if self.process is not None:
            self.process.kill()
            self.process.join()
        for name, cable in zip(self.names, self.cables):
            subprocess.run(["ip", "link", "del", cable], capture_output=True, check=False)
            subprocess.run(["ip", "netns", "del", name], capture_output=True, check=False)

    def inside(self, side):
        """What a command begins with that is to run at this end, 0 or 1."""
        return ["nsenter", f"--net=/run/netns/{self.names[side]}"]

    def treat(self, lost=0, doubled=0, overtaken=0):
        """From now on, of a thousand frames."""
        self.rates[:] = [lost, doubled, overtaken]

    def cut(self):
        """When that was, by time.monotonic()."""
        self.cut_off.value = 1
        return time.monotonic()

    def mend(self):
        self.cut_off.value = 0

    def set_mtu(self, octets):
        """When that was."""
        _run("ip", "-n", self.names[0], "link", "set", "end", "mtu", str(octets))
        return time.monotonic()

    def _carry(self):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(30))
        draw = random.Random(self.seed)
        ends = []
        for cable in self.cables:
            end = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
            end.bind((cable, 0))
            end.setblocking(False)
            ends.append(end)
        waiting = selectors.DefaultSelector()
        for side, end in enumerate(ends):
            waiting.register(end, selectors.EVENT_READ, side)
        held = [[], []]                                       # (due, frame) of those that may be overtaken, by where to
        while True:
            due = min((frames[0][0] for frames in held if frames), default=None)
            ready = waiting.select(None if due is None else max(0.0, due - time.monotonic()))
            for key, _ in ready:
                self._take(key.fileobj, 1 - key.data, ends, held, draw)
            now = time.monotonic()
            for to, frames in enumerate(held):
                while frames and frames[0][0] <= now:
                    self._put(ends[to], frames.pop(0)[1])

    def _take(self, end, to, ends, held, draw):
        try:
            frame, come_from = end.recvfrom(65536)
        except BlockingIOError:
            return
        if come_from[2] == OUTGOING or self.cut_off.value:
            return
        lost, doubled, overtaken = self.rates
        self.counts[0] += 1
        if draw.randrange(1000) < lost:
            self.counts[1] += 1
            return
        if draw.randrange(1000) < overtaken:
            self.counts[3] += 1
            held[to].append((time.monotonic() + OVERTAKEN_S, frame))
            return
        self._put(ends[to], frame)
        if draw.randrange(1000) < doubled:
            self.counts[2] += 1
            self._put(ends[to], frame)

    @staticmethod
    def _put(end, frame):
        try:
            end.send(frame)
        except OSError:
            pass        # too long for a cable that has become narrow, or the buffer is full: lost


def _sums_inside(name):
    with open(f"/run/netns/{name}", "rb") as namespace:
        if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), 0x40000000) != 0:      # CLONE_NEWNET
            raise OSError(ctypes.get_errno(), "setns")
    _leave_sums_to_the_sender("end")
