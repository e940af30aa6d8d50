#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Control and world give the same numbers on every processor (docs/adr/0004, 0139): none of them calls a function of the C library whose
last digit depends on the processor, as tools/portable/functions.cpp measures. Prints who does; `planted` does so itself, to be caught."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = ("hirosco", "robotics", "subsystems", "supervisor", "simulation")
CALL = re.compile(r"\b(hypot|cbrt)[fl]?\(")
PLANTED = {"simulation/world/a.cpp": "const double size = std::hypot(x, y);", "robotics/motion/a.hpp": "return ::cbrtf(x);"}


def wrong(texts):
    for name, text in texts.items():
        for number, line in enumerate(text.splitlines(), 1):
            if call := CALL.search(line.split("//")[0]):
                yield f"{name}:{number}: {call[1]} gives another last digit on another processor; write it with sqrt, or pow"


def sources():
    for part in PARTS:
        for path in sorted((ROOT / part).rglob("*.[ch]pp")):
            if not path.name.endswith("_test.cpp") and not {"testing", "tests"} & set(path.relative_to(ROOT).parts):
                yield path.relative_to(ROOT).as_posix(), path.read_text()


found = list(wrong(dict(sources())))
missed = [name for name, text in PLANTED.items() if not list(wrong({name: text}))]
print(*found, *(f"not caught: {name}" for name in missed), sep="\n", end="\n" if found or missed else "")
sys.exit(bool(found or missed))
