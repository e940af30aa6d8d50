#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The coupled demonstrator with both links by UDP: in this computer, and over a bad wire between two network namespaces."""
import contextlib
import os
import pathlib
import shutil
import tempfile
import time
import unittest

import flight
import wire

FAR_AGE = 40          # cycles of 0.5 ms: what an engineer grants a network that delays and loses
CYCLE_S = 0.0005
STALE = ("ROBOT_STATE_STALE", "JOYSTICK_STATE_STALE")


@contextlib.contextmanager
def mission(addresses=None, age=None):
    """The demonstrator's, its two links by UDP between these addresses; a stale one takes the network down."""
    robot, hand = addresses or (None, None)

    def way(start, end):
        return 'method="udp"' + (f' from_address="{start}" to_address="{end}"' if addresses else "")

    plan = "".join(f'<Plan name="cut-{number}"><When event="{event}"/><Do action="shut_down_network"/></Plan>\n'
                   for number, event in enumerate(STALE))
    with flight.MissionCopy({}) as path:
        text = path.read_text()
        for set_name, start, end in (("JOYSTICK.ROBOT_STATE", robot, hand), ("MANIPULATOR.JOYSTICK_STATE", hand, robot)):
            assert text.count(f'to="{set_name}"/>') == 1
            text = text.replace(f'to="{set_name}"/>', f'to="{set_name}" {way(start, end)}/>')
        path.write_text(text.replace("<Recovery>", "<Recovery>" + plan))
        if age is not None:
            folder = path.parents[2] / "subsystems"
            folder.unlink()
            shutil.copytree(flight.REPOSITORY / "subsystems", folder)
            for name in ("manipulator", "joystick"):
                file = folder / name / f"{name}.xml"
                file.write_text(file.read_text().replace('age="3"', f'age="{age}"'))
        yield path


@contextlib.contextmanager
def programs(wrapped):
    """The built programs, those of `wrapped` behind the words that they are to be started with. In a sandbox nobody would start another program:
    the interpreter of these alone is a script, too, so that they fly in none (docs/adr/0210), and the others in theirs."""
    with tempfile.TemporaryDirectory(prefix="hirosco-far-", dir=flight.BINARIES) as folder:
        for program in flight.BINARIES.glob("hirosco*"):
            if program.is_file():
                os.link(program, pathlib.Path(folder) / program.name)
        shell = pathlib.Path(folder) / "far-shell"
        shell.write_text('#!/bin/sh\nexec /bin/sh "$@"\n')
        shell.chmod(0o755)
        for name, words in wrapped.items():
            far = pathlib.Path(folder) / "far" / name
            far.parent.mkdir(exist_ok=True)
            near = pathlib.Path(folder) / name
            near.rename(far)
            near.write_text(f'#!{shell}\nexec {" ".join(words)} {far} "$@"\n')
            near.chmod(0o755)
        yield folder


class Coupled(unittest.TestCase):
    def states(self, craft):
        status = craft.wait_status(lambda s: True, 3.0)
        return {member["name"]: member["state"] for member in status["subsystems"]}

    def feels(self, craft):
        """The hand pushes the robot to the rail, and lets go."""
        craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
        end = time.monotonic() + 15.0
        while craft.truth("robot")["force"] < 20.0:
            self.assertLess(time.monotonic(), end, "the robot pushes")
        craft.fault("joystick", "hand", "cartesian", 0, 0, 0.5)

    def stays_coupled(self, craft, seconds):
        begin = craft.count()
        time.sleep(seconds)
        told = [line.told for line in craft.told(begin) if any(event in line.told for event in STALE)]
        self.assertEqual(told, [])
        states = self.states(craft)
        self.assertEqual((states["MANIPULATOR"], states["JOYSTICK"]), ("Operational", "Operational"))

    def goes_down(self, craft, since, begin, age):
        """Within the declared age both are inhibited and the network is taken down."""
        stale = craft.wait_line(lambda line: any(event in line.told for event in STALE), 5.0, begin)
        self.assertIsNotNone(stale, "it is told")
        craft.wait_at_rest("robot", since)
        for name in ("MANIPULATOR", "JOYSTICK"):
            craft.wait_told(f"{name} info STATE_CHANGED STATE=Offline", 10.0, begin)
        cycles = float(stale.told.split("AGE=")[1].split()[0])
        self.assertEqual(cycles, age + 1, "the first cycle beyond the age")
        return stale.received - since

    def flies_again(self, craft):
        def do(*words):
            code, reports = craft.tc(*words)
            self.assertEqual(code, 0, f"{words}: {reports}")
        craft.bring_up(do)
        self.stays_coupled(craft, 1.0)
        self.feels(craft)


class Loopback(Coupled):
    def test_flies_in_this_computer(self):
        with mission() as path, flight.Flight(path) as rokviss:
            rokviss.wait_commissioned()
            for number in (1, 2):
                line = rokviss.wait_told(f"link {number} ")
                self.assertIn("up: udp, ", line.told)
                self.assertIn(", 127.0.0.1:", line.told)
            self.stays_coupled(rokviss, 3.0)
            self.feels(rokviss)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)


class BetweenNetworks(Coupled):
    def test_flies_over_a_bad_wire_stops_when_it_is_cut_or_too_narrow_and_flies_again(self):
        if not wire.possible():
            flight.skip("no-network-namespace")
        with wire.Wire(seed=7) as cable, mission(wire.ADDRESSES, FAR_AGE) as path, \
                programs({"hirosco-manipulator": cable.inside(0), "hirosco-joystick": cable.inside(1)}) as folder, \
                flight.Flight(path, binaries=folder) as rokviss:
            rokviss.wait_commissioned()
            open_ones = {line.told for line in rokviss.told() if "is not isolated: its" in line.told}
            self.assertLessEqual(open_ones, {f"{name} is not isolated: its interpreter is a script, too" for name in ("MANIPULATOR", "JOYSTICK")})
            cable.treat(lost=20, doubled=20, overtaken=20)
            self.stays_coupled(rokviss, 5.0)
            self.feels(rokviss)
            carried, *treated = cable.counts
            flight.measure(f"{carried} frames carried, lost {treated[0]}, doubled {treated[1]}, overtaken {treated[2]}")
            self.assertGreater(min(treated), 100)

            begin = rokviss.count()
            after = self.goes_down(rokviss, cable.cut(), begin, FAR_AGE)
            flight.measure(f"cut: told after {1e3 * after:.1f} ms, {1e3 * FAR_AGE * CYCLE_S:.0f} ms are the declared age")
            cable.mend()
            self.flies_again(rokviss)

            begin = rokviss.count()
            after = self.goes_down(rokviss, cable.set_mtu(100), begin, FAR_AGE)
            flight.measure(f"too narrow for a sample: told after {1e3 * after:.1f} ms")
            rokviss.tc("supervisor", "SET_MODE", 1)
            for name in ("manipulator", "joystick"):
                rokviss.tc(name, "SET_STATE", 3)
                rokviss.tc(name, "CONFIGURE", 2)
            self.assertNotEqual(rokviss.tc("supervisor", "LINK", 1)[0], 0)
            rokviss.wait_told("does not fit the MTU", 5.0, begin)
            cable.set_mtu(1500)
            self.flies_again(rokviss)


if __name__ == "__main__":
    flight.main()
