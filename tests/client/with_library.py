#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Runs a script of this folder with an interpreter that has the library `spacepackets`: this one, or a virtual
environment in the build folder, which is made with pip when it is needed for the first time.

    with_library.py FOLDER SCRIPT [ARGUMENTS...]

Exit code 77: the library is neither here nor to be had."""
import fcntl
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
REQUIREMENTS = HERE / "requirements.txt"
NEEDED = "import spacepackets, fastcrc"


def works(python, needed):
    try:
        return subprocess.run([python, "-c", needed], capture_output=True, check=False).returncode == 0
    except OSError:
        return False


def interpreter(folder, needed=NEEDED, requirements=REQUIREMENTS, seconds=120):
    """(path of an interpreter that has the library, "") or (None, why there is none). All tests share one `folder`: to make it takes
    longer than most libraries do."""
    if works(sys.executable, needed):
        return sys.executable, ""
    folder = pathlib.Path(folder)
    python = folder / "bin" / "python"
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{folder}.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if python.exists() and works(str(python), needed):
            return str(python), ""
        steps = [[str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile", "-r", str(requirements)]]
        if not works(str(python), "import pip"):
            steps.insert(0, [sys.executable, "-m", "venv", "--clear", str(folder)])
        for step in steps:
            try:
                done = subprocess.run(step, capture_output=True, text=True, timeout=seconds, check=False)
            except (OSError, subprocess.TimeoutExpired) as error:
                return None, str(error)
            if done.returncode != 0:
                lines = (done.stderr or done.stdout).strip().splitlines() or ["no reason given"]
                return None, f"{' '.join(step[:4])}: {lines[-1]}"
    return str(python), ""


def interpreter_or_skip(*arguments):
    python, reason = interpreter(*arguments)
    if python is None:
        reasons = HERE.parents[1] / "tools/skip_reason"
        sys.exit(subprocess.run([reasons, "no-package-index-of-python", reason], check=False).returncode)
    return python


def main():
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    python = interpreter_or_skip(sys.argv[1])
    script = HERE / sys.argv[2]
    os.execv(python, [python, "-B", str(script), *sys.argv[3:]])


if __name__ == "__main__":
    main()
