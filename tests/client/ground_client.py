#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A foreign ground station against a running mission: pings every application process, decodes housekeeping by the
descriptor, commands a motion, and is refused with the reason for everything that a ground station can do wrong.

    pip install -r requirements.txt
    ground_client.py [--host H] [--port P] [--mission mission.xml] [--listen SECONDS]

Expects the mission in its start mode with all members in service. Leaves the manipulator in configuration standalone,
Operational, mode standalone. Exit code 0: every check passed."""
import argparse
import math
import sys
import time

from pus_link import (ACCEPTANCE, APIDS, COMPLETION, JOYSTICK, MANIPULATOR, STATES, SUPERVISOR, Call, GroundLink,
                      Mission, Table, add_arguments, onboard_seconds, set_state, verification_of)

TAI_MINUS_UTC = 37
UNIX_EPOCH_1958 = 378691200


def text(reports):
    """Verification reports in short: `1,1 1,3 1,5(1) 1,7` or `1,2 code 13 data 04`."""
    words = []
    for report in reports:
        step = f"({report.step})" if report.step is not None else ""
        reason = f" code {report.code:#06x}" if report.code is not None else ""
        words.append(f"1,{report.subtype}{step}{reason}" + (f" data {report.data.hex()}" if report.data else ""))
    return " ".join(words) or "nothing"


class Checks:
    def __init__(self, link, mission, table):
        self.link, self.mission, self.table = link, mission, table
        self.manipulator = mission.subsystems["manipulator"]

    # (a)
    def ping(self, apid):
        link = self.link
        begin = time.monotonic()
        request = link.send(link.telecommand(apid, 17, 1))
        alive = link.wait(lambda r: r.kind == (17, 2) and r.packet.apid == apid and r.destination == link.source, 2.0)
        reports = link.verify(request, 2.0)
        took = (alive.received - begin) * 1000 if alive else None
        good = alive is not None and [r.subtype for r in reports] == [1, 3, 7]
        self.table.row(good, f"TC[17,1] to {APIDS.get(apid, apid)} ({apid})",
                       text(reports) + (" 17,2" if alive else ", no 17,2"), took)

    def ping_with_flags(self, ack, expected):
        link = self.link
        request = link.send(link.telecommand(MANIPULATOR, 17, 1, ack=ack))
        alive = link.wait(lambda r: r.kind == (17, 2) and r.packet.apid == MANIPULATOR and
                          r.destination == link.source, 2.0)
        found = []
        # Those that are expected, however long they take, then no other.
        while report := link.wait(lambda r: r.kind[0] == 1 and verification_of(r).request == request,
                                  5.0 if len(found) < len(expected) else 0.3):
            found.append(verification_of(report))
        self.table.row(alive is not None and [r.subtype for r in found] == expected,
                       f"TC[17,1] with acknowledgement flags {ack:04b}", text(found))

    # (b)
    def housekeeping(self, descriptor, identifier, timeout=5.0):
        report = self.link.wait(lambda r: r.kind == (3, 25) and r.packet.apid == descriptor.apid and
                                int.from_bytes(r.packet.tm_data[:2], "big") == identifier, timeout)
        if report is None:
            self.table.row(False, f"TM[3,25] {identifier} of {descriptor.name}", "none received")
            return None
        try:
            values = descriptor.decode(report.packet.tm_data)
        except ValueError as error:
            self.table.row(False, f"TM[3,25] {identifier} of {descriptor.name}", str(error))
            return None
        return report, values

    def manipulator_housekeeping(self):
        self.link.forget()
        for _ in range(2):
            found = self.housekeeping(self.manipulator, 4711)
            if not found:
                return
            report, values = found
            state, position = values["CUR_VALUES.STATE"], values["CUR_VALUES.POSITION"]
            samples = [v for name, v in values.items() if name.startswith("DES_POSITION#")]
            numbers = [n for v in values.values() for n in (v if isinstance(v, tuple) else (v,))]
            plausible = (0 <= state < len(STATES) and all(math.isfinite(n) for n in numbers) and len(samples) == 5 and
                         -2.1 <= position[0] <= 1.1 and 0.1 <= position[1] <= 2.7)
            self.table.row(plausible, "TM[3,25] 4711 by the descriptor",
                           f"{STATES[state] if 0 <= state < len(STATES) else state}, q = ({position[0]:.4f}, "
                           f"{position[1]:.4f}) rad, {len(samples)} x DES_POSITION")
            age = time.time() + UNIX_EPOCH_1958 + TAI_MINUS_UTC - onboard_seconds(report.packet.timestamp)
            self.table.row(abs(age) < 5, "its time is TAI since 1958, CUC 4+3", f"{age:.3f} s ago")

    # (c)
    def bring_to(self, what, apid, call):
        reports = self.link.call(apid, call, timeout=20.0)
        self.table.row([r.subtype for r in reports][-1:] == [7], what, text(reports))

    def move_to(self):
        goal = (-0.85, 1.70)         # clear of the rail
        self.link.forget()
        begin = time.monotonic()
        reports = self.link.call(MANIPULATOR, self.manipulator.call("MOVE_TO", *goal, 2.0), timeout=15.0)
        took = (time.monotonic() - begin) * 1000
        self.table.row([r.subtype for r in reports] == [1, 3, 5, 7], "MOVE_TO with all four acknowledgements",
                       text(reports), took)
        self.table.row(took >= 1500, "MOVE_TO completes at the end of the motion", f"{took:.0f} ms for 2 s")
        self.link.forget()
        if found := self.housekeeping(self.manipulator, 4711):
            position = found[1]["CUR_VALUES.POSITION"]
            self.table.row(all(abs(q - g) < 0.02 for q, g in zip(position, goal)), "the manipulator is there",
                           f"q = ({position[0]:.4f}, {position[1]:.4f}) rad")

    # (d)
    def refused(self, why, reports, subtype, code, data=None):
        good = ([r.subtype for r in reports][-1:] == [subtype] and reports[-1].code == code and
                (data is None or reports[-1].data == data) and not any(r.subtype in (3, 7) for r in reports))
        self.table.row(good, f"refused: {why} (TM[1,{subtype}] {code:#06x})", text(reports))

    def refused_call(self, why, call, subtype, code, data=None, apid=MANIPULATOR):
        self.refused(why, self.link.call(apid, call, timeout=3.0), subtype, code, data)

    def refused_packet(self, why, telecommand, subtype, code, change=None):
        octets = telecommand.pack()
        if change:
            change(octets)
        self.link.send_raw(octets)
        request = int.from_bytes(octets[:4], "big")
        self.refused(why, self.link.verify(request, 3.0), subtype, code)

    def refused_in_any_mode(self):
        def damage(octets):
            octets[-1] ^= 0x01
        link = self.link
        self.refused_packet("wrong checksum", link.telecommand(MANIPULATOR, 17, 1), 2, 5, damage)
        self.refused_packet("unknown APID", link.telecommand(77, 17, 1), 10, 1)
        self.refused_packet("ping with an octet too many", link.telecommand(MANIPULATOR, 17, 1, b"\0"), 2, 8)

    def standalone(self):
        """Both robots down to Pre-Operational, the manipulator up again in its other configuration."""
        self.set_mode("commissioning")
        for apid in (JOYSTICK, MANIPULATOR):
            self.bring_to(f"{APIDS[apid]} to Safe-Operational", apid, set_state("SafeOperational"))
        for apid in (JOYSTICK, MANIPULATOR):
            self.bring_to(f"{APIDS[apid]} to Pre-Operational", apid, set_state("PreOperational"))
        configuration = next(c for c in self.manipulator.root.iter("Configuration")
                             if c.get("name").replace("_", "").lower() == "standalone")
        self.bring_to("manipulator takes configuration standalone", MANIPULATOR,
                      Call("CONFIGURE", (1, "UINT8", int(configuration.get("id")))))
        self.bring_to("manipulator to Safe-Operational", MANIPULATOR, set_state("SafeOperational"))
        self.set_mode("standalone", "ENTER_MODE")

    def set_mode(self, name, function="SET_MODE"):
        self.bring_to(f"{function} {name}", SUPERVISOR, Call(function, (1, "UINT8", self.mission.modes[name])))

    def run(self):
        for apid in APIDS:
            self.ping(apid)
        self.ping_with_flags(0, [])
        self.ping_with_flags(ACCEPTANCE, [1])
        self.ping_with_flags(COMPLETION, [7])
        self.manipulator_housekeeping()
        self.refused_in_any_mode()

        move = self.manipulator.call("MOVE_TO", -0.85, 1.70, 2.0)
        if self.mission.start != "standalone":
            self.refused_call(f"MOVE_TO in mode {self.mission.start}", move, 2, 13)
        self.standalone()
        self.refused_call("MOVE_TO in Safe-Operational", move, 2, 10, bytes([STATES.index("SafeOperational")]))
        self.bring_to("manipulator to Operational", MANIPULATOR, set_state("Operational"))
        self.move_to()
        self.refused_call("MOVE_TO out of range", self.manipulator.call("MOVE_TO", 5.0, 1.5, 2.0), 4, 0x0105)
        self.refused_call("unknown function", Call("FLY_AWAY"), 4, 0x0101)
        short = self.link.telecommand(MANIPULATOR, 8, 1, move.pack()[:-1])
        self.refused_packet("MOVE_TO with an octet too few", short, 2, 8)

    def listen(self, seconds):
        before = self.link.received
        time.sleep(seconds)
        count = self.link.received - before
        self.table.row(count > 0, f"listened for {seconds:g} s", f"{count} packets")

    def end(self):
        self.table.row(not self.link.closed, "the connection is still up")
        self.table.row(not self.link.malformed, f"{self.link.received} packets, none malformed",
                       "; ".join(self.link.malformed[:3]))
        self.table.row(not self.link.gaps, "no gap in any sequence count",
                       "; ".join(f"APID {a}: {b} then {c}" for a, b, c in self.link.gaps[:3]))
        return self.table.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    parser.add_argument("--listen", type=float, default=0.0, metavar="S", help="then listen for S seconds")
    options = parser.parse_args()
    with GroundLink(options.host, options.port) as link:
        checks = Checks(link, Mission(options.mission), Table())
        checks.run()
        if options.listen:
            checks.listen(options.listen)
        return checks.end()


if __name__ == "__main__":
    sys.exit(main())
