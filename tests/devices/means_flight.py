#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""means_flight.py TRANSFER REACHES: the demonstrator whose hand is a device by this means of transfer. Its subsystem opens it in a sandbox, which lets in
what the means' row says, and it is told what it reaches by that; the hand pushes the robot to the rail, through frames both ways. For a means that no
mission flies: tools/extension_points/fly has it with that of its example."""
import shutil
import sys
import time

import flight

ADDRESS = 'address="joystick-handle" '


def main():
    transfer, reaches = sys.argv[1:]
    with flight.MissionCopy({}) as path:
        folder = path.parents[2] / "subsystems"
        folder.unlink()
        shutil.copytree(flight.REPOSITORY / "subsystems", folder)
        descriptor = folder / "joystick/joystick.xml"
        text, now = descriptor.read_text(), f'transfer="shared_memory" {ADDRESS}'
        assert now in text, f"{descriptor} has no {now}"
        descriptor.write_text(text.replace(now, f'transfer="{transfer}" {ADDRESS}'))
        with flight.Flight(path) as craft:
            craft.wait_commissioned()
            craft.wait_told(f"JOYSTICK is isolated but for what its endnodes and links need: it reaches {reaches}")
            craft.fault("joystick", "hand", "cartesian", 0.0226, 0, 0.5)
            end = time.monotonic() + 15.0
            while craft.truth("robot")["force"] < 20.0:
                assert time.monotonic() < end, "the robot does not push"
            code = craft.end()
            assert code == 0, f"ended with {code}: {craft.errors}"
    print(f"flown by {transfer}")


if __name__ == "__main__":
    main()
