# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The subsystem's side, or the supervisor's, of a device in this computer by shared memory or message queues, as docs/interfaces/devices.md has
them; nothing but Python's standard library. What is sent without anybody there is let go, as a subsystem does."""
import ctypes
import errno
import fcntl
import mmap
import os
import platform
import select
import stat
import struct
import time

LOOK_S = 0.0002
FOLDER, LONGEST = "/dev/shm/hirosco", 1024
libc = ctypes.CDLL(None, use_errno=True)


def flock(kind, octet):
    return struct.pack("hhqqi4x", kind, os.SEEK_SET, octet, 1, 0)


def lock(file, octet):
    try:
        fcntl.fcntl(file, fcntl.F_OFD_SETLK, flock(fcntl.F_WRLCK, octet))
    except (BlockingIOError, PermissionError):
        return False
    return True


def unlock(file, octet):
    fcntl.fcntl(file, fcntl.F_OFD_SETLK, flock(fcntl.F_UNLCK, octet))


def is_locked(file, octet):
    return struct.unpack_from("h", fcntl.fcntl(file, fcntl.F_OFD_GETLK, flock(fcntl.F_WRLCK, octet)))[0] != fcntl.F_UNLCK


def turn(file, octet):
    """Of who closes; the other one may hold it for a moment."""
    for _ in range(200):
        if lock(file, octet):
            return True
        time.sleep(0.0001)
    return False


def named(address):
    name = address.replace("/", ".")
    if name in ("", ".", ".."):
        raise OSError(errno.EINVAL, f"'{address}' is no name")
    return name


def opened(attempt):
    """Who goes last takes the name away and has both sides for a moment."""
    for _ in range(200):
        wire = attempt()
        if wire is not None:
            return wire
        time.sleep(0.0005)
    raise OSError(errno.EBUSY, "this side of it is open: a flight, or another one who tries it, has it")


class LocalWire:
    stream = False

    def flood(self, made, seconds):
        """Sends, and reads nothing of what comes."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.send(made())
            time.sleep(LOOK_S)


class SharedMemory(LocalWire):
    SIZE, MAGIC, OPENED, MAILBOXES = 2432, 0x0001574F4C465348, (64, 72), (128, 1280)
    SEQUENCE, OCTETS, WORDS, BELL = 0, 8, 16, 1088
    OWN, PEER, CLOSING = 0, 1, 2  # sides, which are octets of the file, and a third one
    FUTEX, FUTEX_WAKE = 202, 1

    def __init__(self, address, of_supervisor=False):
        if platform.machine() != "x86_64":
            raise OSError(errno.ENOSYS, "Python's stores are seen in order on x86-64 alone (docs/interfaces/memory.md)")
        name = named(address)
        self.path, self.folder = (f"{FOLDER}.{name}", None) if of_supervisor else (f"{FOLDER}/{name}/frames", f"{FOLDER}/{name}")
        self.file = opened(self.attempt)
        if os.fstat(self.file).st_size < self.SIZE:
            os.ftruncate(self.file, self.SIZE)
        self.mapping = mmap.mmap(self.file, self.SIZE)
        self.wide, self.narrow = (memoryview(self.mapping).cast(form) for form in "QI")
        if self.word(0) not in (0, self.MAGIC):
            raise OSError(errno.EPROTO, f"{self.path} is no flow's")
        self.put(0, self.MAGIC)
        self.take_over()

    def attempt(self):
        mode, before = 0o600, None
        if self.folder:
            for folder in (FOLDER, self.folder):
                try:
                    os.mkdir(folder)
                    os.chmod(folder, 0o1777)
                except FileExistsError:
                    if not stat.S_ISDIR(os.lstat(folder).st_mode):
                        raise
            if stat.S_IMODE(os.lstat(self.folder).st_mode) == 0o770:
                mode, before = 0o666, os.umask(0)
        try:
            file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, mode)
        except FileNotFoundError:
            return None
        finally:
            if before is not None:
                os.umask(before)
        if lock(file, self.OWN) and self.is_named(file):
            return file
        os.close(file)
        return None

    def is_named(self, file):
        try:
            return os.lstat(self.path).st_ino == os.fstat(file).st_ino
        except FileNotFoundError:
            return False

    def word(self, at):
        return self.wide[at // 8]

    def put(self, at, value):
        self.wide[at // 8] = value

    def take_over(self):
        if self.word(self.OPENED[self.PEER]) % 2 and not is_locked(self.file, self.PEER):
            self.put(self.OPENED[self.PEER], self.word(self.OPENED[self.PEER]) + 1)
        self.peer_at_start = self.word(self.OPENED[self.PEER]) // 2 * 2
        self.sent, self.seen = ((self.word(self.MAILBOXES[side]) + 1) // 2 * 2 for side in (self.PEER, self.OWN))
        self.put(self.MAILBOXES[self.PEER], self.sent)
        self.put(self.OPENED[self.OWN], (self.word(self.OPENED[self.OWN]) | 1) + 2)

    def ring(self):
        """Whether or not it waits: what is stored and then looked at may be seen the other way round."""
        at = self.MAILBOXES[self.PEER] + self.BELL
        self.narrow[at // 4] = (self.narrow[at // 4] + 1) & 0xFFFFFFFF
        bell = ctypes.c_uint32.from_buffer(self.mapping, at)
        libc.syscall(ctypes.c_long(self.FUTEX), ctypes.byref(bell), ctypes.c_int(self.FUTEX_WAKE), ctypes.c_int(1), None, None, ctypes.c_int(0))
        del bell  # or the mapping could not be closed

    def send(self, frame):
        if self.word(self.OPENED[self.PEER]) % 2 == 0:
            return
        to = self.MAILBOXES[self.PEER]
        self.put(to + self.SEQUENCE, self.sent + 1)
        self.put(to + self.OCTETS, len(frame))
        for i, (word,) in enumerate(struct.iter_unpack("=Q", frame + bytes(-len(frame) % 8))):
            self.put(to + self.WORDS + 8 * i, word)
        self.sent += 2
        self.put(to + self.SEQUENCE, self.sent)
        self.ring()

    def newest(self):
        own = self.MAILBOXES[self.OWN]
        sequence = self.word(own + self.SEQUENCE)
        if sequence == self.seen or sequence % 2:
            return None
        octets = self.word(own + self.OCTETS)
        words = [self.word(own + self.WORDS + 8 * i) for i in range((min(octets, LONGEST) + 7) // 8)]
        if self.word(own + self.SEQUENCE) != sequence:
            return None
        self.seen = sequence
        assert octets <= LONGEST, f"a frame of {octets} octets"
        return struct.pack(f"={len(words)}Q", *words)[:octets]

    def receive(self, seconds):
        end = time.monotonic() + seconds
        while (frame := self.newest()) is None:
            opened_now = self.word(self.OPENED[self.PEER])
            assert opened_now % 2 or opened_now == self.peer_at_start, "it hung up"
            if time.monotonic() >= end:
                return None
            time.sleep(LOOK_S)
        return frame

    def close(self):
        self.put(self.OPENED[self.OWN], self.word(self.OPENED[self.OWN]) + 1)
        self.ring()
        if turn(self.file, self.CLOSING) and lock(self.file, self.PEER) and self.is_named(self.file):
            os.unlink(self.path)
        self.wide.release()
        self.narrow.release()
        self.mapping.close()
        os.close(self.file)


class Attributes(ctypes.Structure):
    _fields_ = [(name, ctypes.c_long) for name in ("flags", "most", "octets", "waiting")] + [("spare", ctypes.c_long * 4)]


class MessageQueues(LocalWire):
    WAITING, READER, CLOSING = 8, 0, 1  # messages; octets of a queue

    def __init__(self, address):
        # Of older C libraries they are in a library of their own.
        self.calls = libc if hasattr(libc, "mq_open") else ctypes.CDLL("librt.so.1", use_errno=True)
        self.names = [f"/hirosco.{named(address)}.{end}".encode() for end in ("to_subsystem", "to_device")]
        self.own, self.peer = opened(self.attempt)
        self.peer_came = False
        for _ in range(self.WAITING):  # of a predecessor
            self.take(self.own)

    def queue(self, name, flags):
        room = Attributes(0, self.WAITING, LONGEST, 0)
        file = self.calls.mq_open(name, ctypes.c_int(flags | os.O_NONBLOCK | os.O_CLOEXEC), ctypes.c_uint(0o600), ctypes.byref(room))
        if file < 0:
            raise OSError(ctypes.get_errno(), f"{name.decode()}: {os.strerror(ctypes.get_errno())}")
        return file

    def attempt(self):
        own, peer = (self.queue(name, os.O_RDWR | os.O_CREAT) for name in self.names)
        if lock(own, self.READER) and self.is_named(0, own) and self.is_named(1, peer):
            return own, peer
        os.close(own)
        os.close(peer)
        return None

    def is_named(self, which, file):
        try:
            now = self.queue(self.names[which], os.O_RDONLY)
        except OSError:
            return False
        same = os.fstat(now).st_ino == os.fstat(file).st_ino
        os.close(now)
        return same

    def take(self, queue):
        room = ctypes.create_string_buffer(LONGEST)
        octets = self.calls.mq_receive(queue, room, ctypes.c_size_t(LONGEST), None)
        return room.raw[:octets] if octets >= 0 else None

    def put(self, frame):
        return self.calls.mq_send(self.peer, frame, ctypes.c_size_t(len(frame)), ctypes.c_uint(0)) == 0

    def is_there(self):
        there = is_locked(self.peer, self.READER)
        self.peer_came = self.peer_came or there
        return there

    def send(self, frame):
        if self.is_there() and not self.put(frame) and ctypes.get_errno() == errno.EAGAIN:
            self.take(self.peer)
            self.put(frame)

    def receive(self, seconds):
        if select.select([self.own], [], [], max(0, seconds))[0]:
            return self.take(self.own)
        assert self.is_there() or not self.peer_came, "it hung up"
        return None

    def close(self):
        if turn(self.peer, self.CLOSING) and lock(self.peer, self.READER):
            for which, file in enumerate((self.own, self.peer)):
                if self.is_named(which, file):
                    self.calls.mq_unlink(self.names[which])
        os.close(self.own)
        os.close(self.peer)
