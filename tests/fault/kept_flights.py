# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_campaign.py keeps of flights, so that it may be ended at any time and goes on: a line for each, with what it took, behind one that
says which build flew them."""
import json
import sys

import flight

sys.path.append(str(flight.REPOSITORY / "simulation/campaign"))
from flown_build import build_of, executables_of  # noqa: E402


def build_that_flies(mission):
    return build_of(mission, [flight.BINARIES / name for name in ("hirosco", "hirosco-supervisor", *executables_of(mission))])


class KeptFlights:
    """Of one seed. `file`: None where nothing is kept. Refused is one of another build or kind, or of another form."""

    def __init__(self, file, mission, seed, kind=None):
        self.file, self.mission, self.seed = file, mission, seed
        self.passed, self.figures = {}, {}      # {number: whether it did}; {what: [seconds]} of all
        self.of = {"build": build_that_flies(mission), "kind": kind} if file else None
        if file and file.exists():
            self._go_on(file.read_text(encoding="utf-8"))
        elif file:
            self._write(self.of)

    def _go_on(self, text):
        whole = text[:text.rfind("\n") + 1]
        try:
            of, *flights = map(json.loads, whole.splitlines())
            of = {what: of[what] for what in self.of}
        except (ValueError, LookupError, TypeError) as problem:
            raise SystemExit(f"{self.file}: does not say of which build its flights are ({problem}): name another file, or take it away") from problem
        if of != self.of:
            raise SystemExit(f"{self.file}: its flights are those of {of}, what flies now is {self.of}: name another file, or take it away")
        if whole != text:                       # whoever was ended in the midst of a line did not fly it to its end
            self.file.write_text(whole, encoding="utf-8")
        for flown in flights:
            if flown["seed"] == self.seed:
                self._count(flown["number"], flown["passed"], flown["figures"])

    def add(self, number, passed, figures):
        if self.file:
            if build_that_flies(self.mission) != self.of["build"]:
                raise SystemExit(f"{self.file}: flight {number} was flown while the programs were built anew: those before it are kept")
            self._write({"seed": self.seed, "number": number, "passed": passed, "figures": figures})
        self._count(number, passed, figures)

    def _count(self, number, passed, figures):
        self.passed[number] = passed
        for what, seconds in figures.items():
            self.figures.setdefault(what, []).extend(seconds)

    def _write(self, content):
        with self.file.open("a", encoding="utf-8") as file:
            file.write(json.dumps(content) + "\n")
