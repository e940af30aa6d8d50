# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A flight that an ordinary user without real-time rights starts. Python's standard library only."""
import contextlib
import os
import pathlib
import shutil
import tempfile

import flight

NOBODY = 65534
AS_NOBODY = ("setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", "--no-new-privs",
             "--inh-caps=-all", "--bounding-set=-all")


@contextlib.contextmanager
def open_to_all(mission=flight.ROKVISS):
    """Arguments of a Flight in a copy of programs and descriptors that every user may read, which the repository need not be."""
    with tempfile.TemporaryDirectory(prefix="hirosco-open-") as folder:
        home = pathlib.Path(folder)
        for name in ("supervisor", "subsystems", "missions"):
            for descriptor in (flight.REPOSITORY / name).rglob("*.xml"):
                to = home / descriptor.relative_to(flight.REPOSITORY)
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(descriptor, to)
        (home / "bin").mkdir()
        for program in flight.BINARIES.glob("hirosco*"):
            shutil.copy(program, home / "bin" / program.name)
        (home / "flight").mkdir()
        for path in [home, *home.rglob("*")]:
            mode = path.stat().st_mode
            path.chmod(mode | (0o555 if mode & 0o100 else 0o444))
        yield {"mission": home / pathlib.Path(mission).relative_to(flight.REPOSITORY), "binaries": home / "bin", "folder": home / "flight"}


@contextlib.contextmanager
def ordinary_user(mission=flight.ROKVISS):
    """Arguments of a Flight that an ordinary user starts. For root: as nobody, who may not even read the repository."""
    if os.geteuid() != 0:
        yield {"mission": mission, "prefix": ("setpriv", "--no-new-privs")}
        return
    with open_to_all(mission) as arguments:
        yield {**arguments, "prefix": AS_NOBODY, "owner": NOBODY}
