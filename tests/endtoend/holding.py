# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a process holds, as the system has it in /proc. Python's standard library only."""
import collections
import os
import pathlib
import re


class Holding:
    """What a process holds now: descriptors, shared mappings, each by the name that the system has for it."""

    def __init__(self, pid):
        folder = pathlib.Path(f"/proc/{pid}")
        self.descriptors = collections.Counter()
        for entry in (folder / "fd").iterdir():
            try:
                self.descriptors[re.sub(r"\d{3,}", "N", os.readlink(entry))] += 1
            except FileNotFoundError:
                pass                       # closed while it was looked at
        self.mappings = collections.Counter()
        for line in (folder / "maps").read_text().splitlines():
            words = line.split(None, 5)
            if len(words) == 6 and words[1].endswith("s"):
                self.mappings[words[5].removesuffix(" (deleted)")] += 1
        status = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines() if ":" in line)
        self.memory_kb = int(status["RssAnon"].split()[0])
        self.data_kb = int(status["VmData"].split()[0])    # what it has mapped for itself alone, touched or not
        self.threads = int(status["Threads"])

    def devices(self):
        """Names of memory that it shares with devices."""
        named = [name for name in [*self.descriptors, *self.mappings] if name.startswith("/dev/shm/")]
        return sorted(set(named))

    def links(self):
        return sum(count for name, count in self.mappings.items() if name.startswith("/memfd:hirosco-link"))

    def __eq__(self, other):
        return (self.descriptors, self.mappings, self.threads) == (other.descriptors, other.mappings, other.threads)

    def __repr__(self):
        return f"{dict(self.descriptors)} {dict(self.mappings)} {self.threads} threads {self.memory_kb} kB"
