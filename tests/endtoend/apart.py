#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""apart.py PROGRAM [WORD...]: runs a flight where no other can meet it: with a loopback, queues, shared memory and list of flights of its own,
so that some may fly at a time. Where that is not permitted (it takes root) it waits until no other flies, and flies alone among those."""
import ctypes
import fcntl
import os
import pathlib
import socket
import struct
import sys
import tempfile

CLONE_NEWNS, CLONE_NEWIPC, CLONE_NEWNET = 0x00020000, 0x08000000, 0x40000000
MS_REC, MS_PRIVATE = 0x4000, 0x40000
SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP = 0x8913, 0x8914, 0x1
# Where `hirosco run` writes down which flights there are (FlightRegistry::default_folder()).
REGISTRY = pathlib.Path("/tmp") / f"hirosco-flights-{os.getuid()}"
LOCK = pathlib.Path(tempfile.gettempdir()) / f"hirosco-apart-{os.getuid()}.lock"


def _called(name, *words):
    if getattr(ctypes.CDLL(None, use_errno=True), name)(*words) != 0:
        raise OSError(ctypes.get_errno(), f"{name}: {os.strerror(ctypes.get_errno())}")


def _raise_loopback():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        flags = struct.unpack("16sh", fcntl.ioctl(any_socket, SIOCGIFFLAGS, struct.pack("16sh", b"lo", 0))[:18])[1]
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sh", b"lo", flags | IFF_UP))


def set_apart():
    """True: this process and all that it begins have networks, queues and shared memory of their own. False: that is not permitted, or
    this is a chroot whose root is no mount, which nobody can make private, and nothing has changed. A half of it is an error."""
    if not any(line.split()[4] == "/" for line in pathlib.Path("/proc/self/mountinfo").read_text().splitlines()):
        return False
    try:
        _called("unshare", CLONE_NEWNS | CLONE_NEWIPC | CLONE_NEWNET)
    except OSError:
        return False
    _called("mount", b"none", b"/", None, MS_REC | MS_PRIVATE, None)
    _called("mount", b"tmpfs", b"/dev/shm", b"tmpfs", 0, None)
    if os.path.ismount("/dev/mqueue"):      # else it shows those of all others
        _called("mount", b"mqueue", b"/dev/mqueue", b"mqueue", 0, None)
    REGISTRY.mkdir(mode=0o700, exist_ok=True)
    _called("mount", b"tmpfs", bytes(REGISTRY), b"tmpfs", 0, b"mode=0700")
    _raise_loopback()
    return True


def main():
    if not set_apart():
        lock = open(LOCK, "w")              # held by the program that takes this one's place, until it has ended
        os.set_inheritable(lock.fileno(), True)
        fcntl.flock(lock, fcntl.LOCK_EX)
    os.execvp(sys.argv[1], sys.argv[1:])


if __name__ == "__main__":
    main()
