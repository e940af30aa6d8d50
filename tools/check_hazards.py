#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""docs/safety/hazards.csv is complete: every hazard has two barriers at least, says whether they are independent, and names
tests that exist. SF1 to SF24 are the findings of the safety review, R1 to R8 the rows of the reaction table. They stand in order,
and a number that is missing is named in docs/decisions.md as never given."""
import csv
import pathlib
import re
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parents[1]
HAZARDS = REPOSITORY / "docs/safety/hazards.csv"
COLUMNS = ["id", "hazard", "cause", "barriers", "independent", "tests"]
WANTED = [f"SF{n}" for n in range(1, 25)] + [f"R{n}" for n in range(1, 9)]
NEVER_GIVEN = re.compile(r"`docs/safety/hazards.csv`.*Never given: ([\w, ]+)")
TEST = re.compile(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)")


def known_tests():
    """Of all sources, of a copy of them, too, which knows no git."""
    for folder in sorted(path for path in REPOSITORY.iterdir() if path.is_dir() and path.name[0] != "." and path.name not in ("build", "log")):
        for path in sorted(folder.rglob("*.cpp")):
            for suite, test in TEST.findall(path.read_text(errors="replace")):
                yield f"{suite}.{test}"


def entries(cell):
    return [entry.strip() for entry in cell.split(";") if entry.strip()]


def out_of_order(ids, never_given):
    """Yields what is wrong with the order of the ids, and with the numbers that are missing; `never_given` has those that may be."""
    series = {}
    for name in ids:
        letters, number = re.fullmatch(r"([A-Z]+)(\d+)", name).groups()
        series.setdefault(letters, []).append(int(number))
    ordered = [f"{letters}{number}" for letters, numbers in series.items() for number in sorted(numbers)]
    yield from (f"{found} stands where {wanted} belongs" for found, wanted in zip(ids, ordered) if found != wanted)
    missing = {f"{letters}{n}" for letters, numbers in series.items() for n in range(1, max(numbers)) if n not in numbers}
    yield from (f"{name} is missing, and docs/decisions.md does not say that it was never given" for name in sorted(missing - never_given))
    yield from (f"{name} was never given, says docs/decisions.md" for name in sorted(never_given - missing))


def self_test():
    assert not list(out_of_order(["SF1", "SF2", "R1", "R3"], {"R2"}))
    for ids, never_given in ((["SF2", "SF1"], set()), (["R1", "SF1", "R2"], set()), (["R1", "R3"], set()), (["R1", "R2"], {"R2"}),
                             (["R1", "R2"], {"R3"})):
        assert list(out_of_order(ids, never_given)), ids


def problems():
    known = set(known_tests())
    with HAZARDS.open(newline="") as file:
        reader = csv.DictReader(file)
        if reader.fieldnames != COLUMNS:
            yield f"1: the columns are {','.join(COLUMNS)}"
            return
        rows = list(reader)
    for line, row in enumerate(rows, 2):
        where = f"{line}: {row['id']}"
        if len(entries(row["barriers"])) < 2:
            yield f"{where} has one barrier only"
        if row["independent"] not in ("yes", "no"):
            yield f"{where} does not say whether its barriers are independent (yes or no)"
        if not all(row[column] for column in COLUMNS):
            yield f"{where} has an empty cell"
        if not entries(row["tests"]):
            yield f"{where} has no test"
        for test in entries(row["tests"]):
            if "/" in test and not (REPOSITORY / test).is_file():
                yield f"{where}: there is no file {test}"
            if "/" not in test and test not in known:
                yield f"{where}: there is no test {test}"
    ids = [row["id"] for row in rows]
    told = NEVER_GIVEN.search((REPOSITORY / "docs/decisions.md").read_text())
    yield from out_of_order(ids, set(re.findall(r"\w+", told[1])) if told else set())
    for missing in [name for name in WANTED if name not in ids]:
        yield f"{missing} does not stand here"
    for twice in sorted({name for name in ids if ids.count(name) > 1}):
        yield f"{twice} stands here twice"


def main():
    self_test()
    found = list(problems())
    for problem in found:
        print(f"docs/safety/hazards.csv:{problem}")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
