# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""An installed tree, moved to where nobody knew that it would be, for whoever builds against one. Once for all in one program.
HIROSCO_BUILD names the build folder that is installed, HIROSCO_BIN its programs."""
import atexit
import functools
import os
import pathlib
import shutil
import subprocess
import tempfile

import flight

BUILD = pathlib.Path(os.environ.get("HIROSCO_BUILD", flight.BINARIES.parent))


@functools.cache
def place():
    folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-author-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@functools.cache
def installed():
    Installed.said("cmake", "--install", BUILD, "--prefix", place() / "first")
    # Nothing in it may know where it was put.
    return (place() / "first").rename(place() / "moved")


class Installed:
    """Its folder, the tree's prefix, and commands in it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = place()
        cls.prefix = installed()
        cls.environment = {}

    @classmethod
    def said(cls, *words, environment=None, code=0, at=None):
        done = subprocess.run([*map(str, words)], capture_output=True, text=True, check=False, cwd=at or place(),
                              env={**os.environ, "NO_COLOR": "1", **(environment or {})})
        told = done.stdout + done.stderr
        if code is not None and done.returncode != code:
            raise AssertionError(f"{words} ended with {done.returncode}:\n{told[-4000:]}")
        return told

    def hirosco(self, *words, code=0, at=None):
        return self.said(self.prefix / "bin/hirosco", *words, environment=self.environment, code=code, at=at)
