#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The mission stargazer with real processes, flown by an ordinary user without real-time rights: an image goes down over a ground link that loses
parts and is cut, and is put together octet by octet as the camera made it. And images of 1 MiB by a link to who is on board."""
import contextlib
import importlib
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import flight
import sky
from lossy_link import LossyLink
from ordinary_user import ordinary_user

HERE = pathlib.Path(__file__).resolve().parent
STARGAZER, WATCHED = HERE.parent, HERE / "watched.xml"
IMAGES, PART = 210, 4


def is_part(packet):
    return len(packet) > 13 and (packet[7], packet[8]) == (IMAGES, PART)


@contextlib.contextmanager
def client_of(mission):
    """The exported package of a mission, and fetch_image.py of the mission."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([str(flight.BINARIES / "hirosco"), "export", "python", str(mission), "--to", folder],
                       capture_output=True, timeout=20, check=True)
        paths = [folder, str(STARGAZER)]
        sys.path[:0] = paths
        try:
            yield importlib.import_module(f"hirosco_{pathlib.Path(mission).parent.name}"), importlib.import_module("fetch_image")
        finally:
            for path in paths:
                sys.path.remove(path)


class Observer(unittest.TestCase):
    def test_an_ordinary_user_gets_an_image_whole_over_a_link_that_loses_parts_and_is_cut(self):
        with client_of(STARGAZER / "mission.xml") as (package, fetch_image), \
                ordinary_user(STARGAZER / "mission.xml") as arguments, flight.Flight(**arguments) as craft:
            craft.wait_told("no real-time scheduling", 5.0)
            craft.wait_told("commissioned: mode observation", 30.0)
            begin = craft.count()
            parts = 0

            def loses(packet):
                nonlocal parts
                if not is_part(packet):
                    return False
                parts += 1
                if parts == 150:
                    link.cut()
                return parts % 7 == 0

            with LossyLink(flight.PORT, loses) as link, package.Spacecraft("127.0.0.1", link.port, reconnect=True) as client:
                imager = client.imager
                self.assertRaises(package.CommandFailed, imager.set_window, 1000, 0, 25, 10, 1)
                imager.set_send_rate(1_000_000)
                self.truth_and_image(craft, client, fetch_image, exposure=20.0)
                self.assertGreater(link.lost, 40)
                flight.measure(f"{link.lost} parts of 512 lost, the link cut once: {time.monotonic() - self.begun:.2f} s")
                # A window, binned, under another sky, with hot elements.
                for line in ("drift 0 0", "point -300 70", "hot 30"):
                    craft.ask("camera", line)
                imager.set_window(100, 64, 600, 300, 2)
                self.truth_and_image(craft, client, fetch_image, exposure=5.0)
                self.assertEqual([each["NUMBER"] for each in imager.list_images().reports], [1, 2])
                self.assertRaises(package.CommandFailed, imager.send_image, 7)
            worse = [line.told for line in craft.told(begin) if " high " in line.told or
                     (" medium " in line.told and "GROUND_LINK" not in line.told)]
            self.assertEqual(worse, [])
            self.assertEqual(craft.end(seconds=30.0), 0, craft.errors)

    def truth_and_image(self, craft, client, fetch_image, exposure):
        client.imager.acquire(exposure=exposure)
        self.begun = time.monotonic()
        truth = craft.truth("camera")
        about, pixels = fetch_image.fetch(client, client.imager)
        self.assertEqual(about["NUMBER"], truth["image"])
        self.assertEqual((about["WIDTH"] * truth["binning"], about["HEIGHT"] * truth["binning"]), (truth["width"], truth["height"]))
        self.assertTrue(pixels == sky.image(truth), "the image is another one than the camera's")
        self.assertTrue(any(pixels))

    def test_images_of_a_mebioctet_are_lent_to_who_is_on_board(self):
        with flight.Flight(WATCHED) as craft:
            craft.wait_told("commissioned: mode watch", 30.0)
            begun = time.monotonic()
            code, said = craft.tc("IMAGER", "ACQUIRE", 2, 90, 33)[:2]
            self.assertEqual(code, 0, said)
            flight.measure(f"90 images of 1 MiB in {time.monotonic() - begun:.2f} s")
            code, said = craft.tc("VIEWER", "EXPECT", 60)[:2]
            self.assertEqual(code, 0, said)
            craft.end()


if __name__ == "__main__":
    flight.main()
