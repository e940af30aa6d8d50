# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A subsystem, its simulated device and a mission, all in one folder of whatever repository: tests/author builds, checks, simulates
and flies this one against an installed tree, which is more than could be tried here."""
import pathlib

LAMP = pathlib.Path(__file__).resolve().parents[2] / "tests/author/lamp"
WHO = "a subsystem, device and mission"
BEFORE = "7 + 3, 4 + 3, and 8 rooms"
GOAL = "own folder, in any repository"
FILES = {f"outside/{file.relative_to(LAMP.parent)}": file.read_text() for file in sorted(LAMP.rglob("*")) if file.is_file()}
MOST_FILES, MOST_EDITED = len(FILES), 0
EDITS = []
SOURCES = []
TRY = None
FLOWN = ["tests/author/author_test.py", "Built", "Flown"]
