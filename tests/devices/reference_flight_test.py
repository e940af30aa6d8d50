#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The reference device flown: in C behind a pseudo-terminal, in Python over TCP. Who commands it is killed and stopped, its plug is pulled, all is
stopped; what becomes of its output is judged by what the device itself says."""
import contextlib
import os
import pathlib
import signal
import socket
import tempfile
import time
import unittest

import flight as flights
import reference
from flight import Flight

HERE = pathlib.Path(__file__).resolve().parent
INSTANCE = "axes"
# Of the descriptors, without real-time rights; what the device was told last may be a cycle old, and it looks each 2 ms.
WATCHDOG_S, STOP_S, SLACK_S = 0.25, 0.1, 0.15


def mission_in(folder, port):
    """The mission beside descriptors of its own: a port that nobody else has."""
    (folder / "axis_serial.xml").write_text((HERE / "axis_serial.xml").read_text())
    (folder / "axis_tcp.xml").write_text((HERE / "axis_tcp.xml").read_text().replace("10071", str(port)))
    (folder / "mission.xml").write_text((HERE / "mission.xml").read_text().replace("../../", "@hirosco/"))
    return folder / "mission.xml"


def pid_of(flight, descriptor):
    for pid in flights.marked_processes(flight.mark):
        with contextlib.suppress(OSError):
            words = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
            if words[0].endswith(b"hirosco-turner") and any(word.endswith(descriptor.encode()) for word in words):
                return pid
    return None


class Reference(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="hirosco-reference-")
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.program = reference.built(self.folder)

    def in_c(self):
        return reference.Device(self.program, "serial", f"axis.{INSTANCE}", folder=self.folder)

    def in_python(self):
        return reference.Device(reference.PYTHON, "-B", reference.FOLDER / "device.py", f"127.0.0.1:{self.port}")

    def turns(self, flight, axis, device, velocity, start=0):
        """Commanded, and active with a higher epoch than whatever it was told before."""
        device.wait("active", 10, start)
        self.assertEqual(flight.tc(axis, "TURN", velocity)[0], 0)

    def stopped(self, device, start, since, what):
        """By its own watchdog or what comes before it, and at rest in its declared time."""
        line = device.wait("stopping", 5, start)
        rest = device.wait("holding", 5, start)
        self.assertEqual(rest["velocity"], 0)
        self.assertLess(line["at"] - since, WATCHDOG_S + SLACK_S, what)
        self.assertLess(rest["at"] - line["at"], STOP_S + SLACK_S, what)
        flights.measure(f"{what}: stopping {1000 * (line['at'] - since):.0f} ms, at rest {1000 * (rest['at'] - since):.0f} ms after it")
        return line

    def bring_back(self, flight, start):
        """The whole craft into its mode again; who is being recovered refuses for a moment."""
        end = time.monotonic() + 20
        while (done := flight.hirosco("mode", "operation", "--instance", INSTANCE, seconds=60)).returncode != 0:
            self.assertLess(time.monotonic(), end, f"{done.stdout}{done.stderr}\n{[line.told for line in flight.told(start)]}")
            time.sleep(0.1)

    def test_unplugged_stopped_killed_and_told_to_stop_the_device_comes_to_rest_by_itself(self):
        with contextlib.ExitStack() as open_until_end:
            serial = open_until_end.enter_context(self.in_c())
            tcp = open_until_end.enter_context(self.in_python())
            flight = open_until_end.enter_context(Flight(mission_in(self.folder, self.port), folder=self.folder, instance=INSTANCE))
            flight.wait_told("commissioned: mode operation", 30)
            flight.place()
            self.turns(flight, "SERIAL_AXIS", serial, 2.0)
            self.turns(flight, "TCP_AXIS", tcp, -1.5)

            # Killed: nobody says stop to the device.
            before, told, epoch = serial.count(), flight.count(), serial.lines[-1]["epoch"]
            other = tcp.count()
            os.kill(pid_of(flight, "axis_serial.xml"), signal.SIGKILL)
            line = self.stopped(serial, before, time.monotonic(), "killed")
            self.assertAlmostEqual(line["velocity"], 2.0)
            flight.wait_told("died: signal 9", 10, told)
            self.assertFalse([line for line in tcp.lines[other:] if line["output"] != "active"], "the other axis has nothing to do with it")
            self.bring_back(flight, told)
            again = serial.wait("active", 10, before)
            self.assertGreater(again["epoch"], epoch, "what was fenced is followed by a higher epoch")

            # Stopped and let go on: what it still has to say is of an epoch that is over.
            before, told = tcp.count(), flight.count()
            stopped = pid_of(flight, "axis_tcp.xml")
            os.kill(stopped, signal.SIGSTOP)
            self.stopped(tcp, before, time.monotonic(), "SIGSTOP")
            with contextlib.suppress(ProcessLookupError):
                os.kill(stopped, signal.SIGCONT)
            flight.wait_told("TCP_AXIS", 10, told)
            self.assertFalse([line for line in tcp.lines[before:] if line["output"] == "active"], "it moves again by itself")
            self.bring_back(flight, told)
            tcp.wait("active", 10, before)

            # Unplugged: the subsystem knows, and says why; put back it flies again.
            told = flight.count()
            serial.kill()
            flight.wait_told("SERIAL_AXIS high AXIS_LOST", 5, told)
            flight.wait_told("SERIAL_AXIS is Offline", 5, told)
            with self.in_c() as serial:
                self.bring_back(flight, told)
                serial.wait("active", 10)
                # All at once, past everything.
                before_c, before_p, since = serial.count(), tcp.count(), time.monotonic()
                self.assertEqual(flight.hirosco("safe", "--instance", INSTANCE, seconds=60).returncode in (0, 1), True)
                asked = time.monotonic() - since
                for device, start in ((serial, before_c), (tcp, before_p)):
                    line = device.wait("stopping", 5, start)
                    self.assertLess(line["at"] - since, asked + WATCHDOG_S + SLACK_S)
                    device.wait("holding", 5, start)
                flight.end()


if __name__ == "__main__":
    flights.main()
