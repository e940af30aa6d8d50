#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Runs a script of this folder with an interpreter that has the foreign readers of XTCE and the client of Yamcs.

    with_decoders.py FOLDER SCRIPT [ARGUMENTS...]

Exit code 77: they are neither here nor to be had."""
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "client"))
import with_library  # noqa: E402

NEEDED = "import space_packet_parser, xtce_lib, yamcs.client"
SECONDS_TO_FETCH = 300

if __name__ == "__main__":
    python = with_library.interpreter_or_skip(sys.argv[1], NEEDED, HERE / "requirements.txt", SECONDS_TO_FETCH)
    os.execv(python, [python, "-B", str(HERE / sys.argv[2]), *sys.argv[3:]])
