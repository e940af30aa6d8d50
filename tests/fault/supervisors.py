# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Supervisors that can be brought into trouble, in place of the real one."""
import contextlib
import os
import pathlib
import tempfile

import flight


@contextlib.contextmanager
def instead(kind):
    """Folder of the executables in which the supervisor is `hirosco-KIND-supervisor`."""
    with tempfile.TemporaryDirectory(prefix=f"hirosco-{kind}-", dir=flight.BINARIES) as programs:
        for program in flight.BINARIES.glob("hirosco*"):
            if program.is_file() and program.name != "hirosco-supervisor":
                os.link(program, pathlib.Path(programs) / program.name)
        os.link(flight.BINARIES / f"hirosco-{kind}-supervisor", pathlib.Path(programs) / "hirosco-supervisor")
        yield programs
