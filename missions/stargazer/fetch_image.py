#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Takes an image with the imager of a flying mission, or fetches one that is on board, and writes it as PGM or PNG.

    hirosco run stargazer                               # in another terminal
    hirosco export python stargazer --to out
    PYTHONPATH=out python3 missions/stargazer/fetch_image.py --expose 20 --to stars.png

What is lost on the way is asked for again, also after a ground link that was cut; nothing is written before the checksum of the whole is right.
Nothing but Python 3.9 is needed. `fetch()` is what a script of one's own takes from here."""
import argparse
import struct
import sys
import time
import zlib

PART_OCTETS = 2048
# A request asks for what comes in this time: what a link that is cut leaves on board to be sent in vain is no more.
REQUEST_S = 2.0
# Without a part for so long, other requests on board before ours included, it is asked for again.
SILENCE_S = 30.0


class NotWhole(Exception):
    """The image did not come whole, or is another one than was begun."""


def fetch(craft, imager, number=0, rounds=20, seconds=300.0, told=lambda have, of: None):
    """Image `number` (0: the newest) of the subsystem `imager` of `craft`: its IMAGE report and its pixels. NotWhole: not after so many requests
    in a row that brought nothing, or so many seconds. The client's CommandFailed: it is not on board any more; ArgumentError."""
    from_flight = sys.modules[type(craft).__module__]      # the exported package: hirosco_MISSION
    end = time.monotonic() + seconds
    most = max(1, int(imager.get_send_rate() * REQUEST_S / PART_OCTETS))
    about, parts, idle = None, {}, 0
    while about is None or len(parts) < about["PARTS"]:
        if idle >= rounds or time.monotonic() > end:
            raise NotWhole(f"image {number}: {len(parts)} of {about['PARTS'] if about else '?'} parts came")
        first, count = gap(about, parts, most)
        before = len(parts)
        request = None
        try:
            craft.wait_until(lambda: craft.connected, timeout=10.0, what="no ground link")
            request = imager.send_image(number=number, first=first, count=count, wait=None)
            wait_for(request, from_flight.NoAnswer)
        except (from_flight.LinkLost, from_flight.NoAnswer):
            time.sleep(0.2)        # what had come by then counts; the rest is asked for again
        for report in request.reports if request else ():
            if report.name == "IMAGE":
                if about is not None and report["CRC32"] != about["CRC32"]:
                    raise NotWhole(f"image {number} is another one now")
                about, number = report, report["NUMBER"]
            elif report["NUMBER"] == number and about is not None:
                parts[report["PART"]] = bytes(report["PIXELS"][:report["OCTETS"]])
        idle = 0 if len(parts) > before else idle + 1
        told(len(parts), about["PARTS"] if about else 0)
    pixels = b"".join(parts[part] for part in range(about["PARTS"]))
    if len(pixels) != about["OCTETS"] or zlib.crc32(pixels) != about["CRC32"]:
        raise NotWhole(f"image {number}: its checksum is wrong")
    return about, pixels


def wait_for(request, no_answer):
    """Until it has ended, or nothing comes any more."""
    heard, since = 0, time.monotonic()
    while True:
        try:
            return request.result(1.0)
        except no_answer:
            if len(request.reports) > heard:
                heard, since = len(request.reports), time.monotonic()
            elif time.monotonic() - since > SILENCE_S:
                raise


def gap(about, parts, most):
    """The first part that is missing, and how many in a row are, at most so many; of an image that nothing is known of its first part."""
    if about is None:
        return 0, 1
    first = next(part for part in range(about["PARTS"]) if part not in parts)
    last = first
    while last + 1 < about["PARTS"] and last + 1 not in parts and last + 1 - first < most:
        last += 1
    return first, last + 1 - first


def pgm(width, height, pixels):
    return b"P5\n%d %d\n255\n" % (width, height) + pixels


def png(width, height, pixels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + pixels[row * width:(row + 1) * width] for row in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main():
    words = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    words.add_argument("--expose", type=float, metavar="MS", help="take one first, exposed so long")
    words.add_argument("--number", type=int, default=0, help="of the image; the newest where nothing is said")
    words.add_argument("--to", default="image.pgm", metavar="FILE", help=".pgm or .png")
    words.add_argument("--mission", default="stargazer", help="whose exported package is used")
    words.add_argument("--subsystem", default="imager", help="the imager's name in it")
    words.add_argument("--telemetry", metavar="HOST:PORT", help="where the ground link is; else the flight on this computer is found")
    asked = words.parse_args()
    package = __import__(f"hirosco_{asked.mission}")
    host, _, port = (asked.telemetry or "").rpartition(":")
    with package.Spacecraft(host or None, int(port) if port else None, reconnect=True) as craft:
        imager = getattr(craft, asked.subsystem)
        if asked.expose is not None:
            imager.acquire(exposure=asked.expose)
        about, pixels = fetch(craft, imager, asked.number, told=lambda have, of: print(f"\r{have} of {of} parts", end="", file=sys.stderr))
    print(file=sys.stderr)
    write = png if asked.to.endswith(".png") else pgm
    with open(asked.to, "wb") as file:
        file.write(write(about["WIDTH"], about["HEIGHT"], pixels))
    begun = about.time_s - about["AGE"] / 1000
    print(f"image {about['NUMBER']}, {about['WIDTH']} x {about['HEIGHT']}, {about['EXPOSURE']:g} ms, exposed at {begun:.3f} s of on-board time, "
          f"checksum {about['CRC32']:08x}: {asked.to}")


if __name__ == "__main__":
    main()
