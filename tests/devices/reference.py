# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The reference device as a program beside a test: started, stopped, killed, and asked what it did by the lines that it writes."""
import binascii
import contextlib
import pathlib
import signal
import struct
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
# Of the sources; as an example, all lies in one folder.
FOLDER = HERE if (HERE / "device.c").exists() else HERE.parents[1] / "simulation/devices/reference"
OFF, ACTIVE, STOP = 0, 1, 2
TRIPPED, OLD_EPOCH = 1, 2


def built(folder):
    """The device in C, by nothing but a C compiler."""
    return compiled(FOLDER / "device.c", pathlib.Path(folder) / "device")


def compiled(source, program):
    subprocess.run(["cc", "-std=c11", "-Wall", "-Wextra", "-O2", "-o", str(program), str(source)], check=True)
    return program


class Device:
    def __init__(self, *command, folder=None):
        self.process = subprocess.Popen([str(word) for word in command], cwd=folder, stdout=subprocess.PIPE, text=True)
        self.lines, self.changed = [], threading.Condition()
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for text in self.process.stdout:
            words = text.split()
            with self.changed:
                self.lines.append({"at": int(words[0]) * 1e-9, "output": words[1], "epoch": int(words[3]), "flags": int(words[5]),
                                   "velocity": float(words[9])})
                self.changed.notify_all()

    def count(self):
        with self.changed:
            return len(self.lines)

    def wait(self, output, seconds, start=0):
        """The first line from number `start` on with this output; fails when it does not come."""
        end = time.monotonic() + seconds
        with self.changed:
            while True:
                for line in self.lines[start:]:
                    if line["output"] == output:
                        return line
                if end <= time.monotonic():
                    raise AssertionError(f"not {output} within {seconds} s: {self.lines}")
                self.changed.wait(end - time.monotonic())

    def kill(self, number=signal.SIGKILL):
        self.process.send_signal(number)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(ProcessLookupError):
            self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdout.close()


def crc(octets):
    return struct.pack("<H", binascii.crc_hqx(octets, 0xFFFF))


def command(epoch, sequence, velocity, mode=ACTIVE, watchdog_us=50_000):
    """By docs/interfaces/devices.md, as lantern and conform have it, too."""
    frame = struct.pack("<HBBIIHHI", 0x4844, 1, mode, epoch, sequence, 0, 8, watchdog_us) + struct.pack("<d", velocity)
    return frame + crc(frame)


def status(frame):
    """{epoch, sequence, flags, position, velocity} of a status; None: it is none."""
    if len(frame) != 20 + 16 + 2 or crc(frame[:-2]) != frame[-2:]:
        return None
    magic, kind, _, epoch, sequence, flags, octets, _ = struct.unpack_from("<HBBIIHHI", frame)
    if (magic, kind, octets) != (0x4844, 2, 16):
        return None
    position, velocity = struct.unpack_from("<dd", frame, 20)
    return {"epoch": epoch, "sequence": sequence, "flags": flags, "position": position, "velocity": velocity}


def streamed(frame):
    head = b"HS" + struct.pack("<H", len(frame))
    return head + crc(head) + frame + crc(frame)


PYTHON = sys.executable
