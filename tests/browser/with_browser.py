#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""with_browser.py [NAME_test.mjs | PROGRAM.mjs [WORD...]]: runs a browser test, or another program beside them, with its packages (by the
lock file, into the build folder); without one only sees whether all is there. Exits 77 (skipped), with the reason, where something is missing that a machine without a ground
station need not have."""
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
WORK = pathlib.Path(os.environ["HIROSCO_BROWSER_WORK"])
PAGE = pathlib.Path(os.environ["HIROSCO_PAGE"])
PAGE_WORK = pathlib.Path(os.environ["HIROSCO_PAGE_WORK"])


def skip(reason):
    """As skipped if the reason, one of tools/skip_reason, is true here; else as failed."""
    sys.exit(subprocess.run([HERE.parents[1] / "tools/skip_reason", reason], check=False).returncode)


def install():
    """Copies the tests beside their packages; npm runs when the lock file has changed."""
    for file in [*HERE.glob("*.mjs"), HERE / "package.json", HERE / "package-lock.json", HERE / ".npmrc"]:
        shutil.copy(file, WORK / file.name)
    wanted = hashlib.sha256((HERE / "package-lock.json").read_bytes()).hexdigest()
    stamp = WORK / "node_modules" / "installed"
    if stamp.exists() and stamp.read_text() == wanted:
        return
    if subprocess.run(["npm", "ci", "--prefer-offline", "--fetch-retries=1", "--fetch-timeout=30000"], cwd=WORK, capture_output=True).returncode:
        skip("no-package-index-of-node")
    stamp.write_text(wanted)


def main():
    for tool in ("node", "npm"):
        if not shutil.which(tool):
            skip("no-node")
    if not os.environ.get("HIROSCO_CHROMIUM") and not shutil.which("chromium"):
        skip("no-chromium")
    if not (PAGE / "index.html").exists():
        skip("no-package-index-of-node")
    WORK.mkdir(parents=True, exist_ok=True)
    install()
    if not sys.argv[1:]:
        return
    # The development server stays beside the page's packages, ws among them.
    development = PAGE_WORK / "development"
    shutil.copytree(HERE.parents[1] / "ground/web/development", development, dirs_exist_ok=True)
    environment = {**os.environ, "HIROSCO_PAGE_SERVER": str(development / "server.mjs"), "HIROSCO_SOURCES": str(HERE.parents[1])}
    runner = ["node", "--test", "--test-reporter=spec"] if sys.argv[1].endswith("_test.mjs") else ["node"]
    sys.exit(subprocess.run([*runner, *sys.argv[1:]], cwd=WORK, env=environment).returncode)


main()
