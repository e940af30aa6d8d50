# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What the simulated camera sees, reckoned a second time from what its truth tells (simulation/devices/imager): seed, pointing, exposure, window,
threshold, dark current, hot elements. Shares nothing with it but these rules. Without noise, which takes Python too long."""
SENSOR, SQUARE, BRIGHTEST = 1024, 64, 255
MASK = (1 << 64) - 1
# Of a star's counts, in sixteenths, by the square of the distance.
SPREAD = {0: 16, 1: 9, 2: 5, 4: 3, 5: 1, 8: 0}


def mixed(value):
    """splitmix64."""
    value = (value + 0x9E3779B97F4A7C15) & MASK
    value = ((value ^ (value >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    value = ((value ^ (value >> 27)) * 0x94D049BB133111EB) & MASK
    return value ^ (value >> 31)


def image(truth):
    """The pixels of the image that these words are about: SimulatedDevice truth as numbers by their names."""
    number = {name: int(value) for name, value in truth.items() if name not in ("temperature", "world_s")}
    assert number["noise"] == 0
    sensor = bytearray([min(number["dark"], BRIGHTEST)]) * (SENSOR * SENSOR)
    if number["shutter"]:
        for x, y, counts in stars(number):
            for dy in range(-2, 3):
                for dx in range(-2, 3):
                    if 0 <= x + dx < SENSOR and 0 <= y + dy < SENSOR:
                        at = (y + dy) * SENSOR + x + dx
                        sensor[at] = min(sensor[at] + min(counts * SPREAD[dx * dx + dy * dy] // 16, BRIGHTEST), BRIGHTEST)
    for i in range(number["hot"]):
        where = mixed(number["sky"] + 0x484F5400 + i)
        sensor[(where >> 16) % SENSOR * SENSOR + where % SENSOR] = BRIGHTEST
    return window_of(sensor, number)


def stars(number):
    """Place on the sensor and counts in the middle of each that may be seen."""
    sky = mixed(number["sky"])
    for j in range((number["v"] - 2) // SQUARE, (number["v"] + SENSOR + 2) // SQUARE + 1):
        for i in range((number["u"] - 2) // SQUARE, (number["u"] + SENSOR + 2) // SQUARE + 1):
            star = mixed(sky ^ ((i << 32) & MASK | (j & 0xFFFFFFFF)))
            if star & 1:
                magnitude = star >> 24 & 255
                yield (i * SQUARE + (star >> 8 & 63) - number["u"], j * SQUARE + (star >> 16 & 63) - number["v"],
                       (1 + (magnitude ** 3 >> 16)) * number["exposure_us"] // 1000)


def window_of(sensor, number):
    pixels, binning = bytearray(), number["binning"]
    for y in range(number["y"], number["y"] + number["height"], binning):
        rows = [sensor[(y + b) * SENSOR + number["x"]:(y + b) * SENSOR + number["x"] + number["width"]] for b in range(binning)]
        if binning == 1:
            pixels += rows[0]
        else:
            pixels += bytes(min(sum(sum(row[x:x + binning]) for row in rows), BRIGHTEST) for x in range(0, number["width"], binning))
    dark = bytes(value if value >= number["threshold"] else 0 for value in range(256))
    return bytes(pixels.translate(dark))
