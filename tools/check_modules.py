#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""docs/safety/modules.csv is complete: each file of it is there and says so in its head, whoever says so stands in it, and
coverage_gaps.csv and mutants.csv speak of lines that are still there. tools/coverage and tools/mutants read it, too."""
import csv
import pathlib
import re
import subprocess
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parents[1]
SAFETY = REPOSITORY / "docs/safety"
COLUMNS = {
    "modules": ["file", "module", "keeps_from", "tests"],
    "coverage_gaps": ["file", "line", "gap", "reason"],
    "mutants": ["file", "line", "mutant", "reason"],
}
MARKER = re.compile(r"^// Safety module: (.+) \(docs/safety/modules\.csv\)\.$", re.MULTILINE)
HEAD_LINES = 6
NEXT_LINE = " ;; "


def table(name):
    """Rows of docs/safety/NAME.csv; nothing when there is no such file."""
    path = SAFETY / f"{name}.csv"
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def lines_like(file, wanted):
    """Numbers of the lines that read `wanted`; two lines in a row are told with the mark of NEXT_LINE, the first one then
    only says which of several equal ones is meant."""
    lines = [line.strip() for line in (REPOSITORY / file).read_text().split("\n")]
    parts = wanted.split(NEXT_LINE)
    return [n + len(parts) for n in range(len(lines) - len(parts) + 1) if lines[n:n + len(parts)] == parts]


def marked_files():
    names = subprocess.run(["git", "ls-files", "*.cpp", "*.hpp"], cwd=REPOSITORY, capture_output=True, text=True,
                           check=True).stdout
    for name in names.split():
        path = REPOSITORY / name
        if not path.exists():
            continue
        with path.open(errors="replace") as file:
            found = MARKER.search("".join(line for _, line in zip(range(HEAD_LINES), file)))
        if found:
            yield name, found.group(1)


def problems():
    for name, columns in COLUMNS.items():
        path = SAFETY / f"{name}.csv"
        if not path.exists():
            yield f"docs/safety/{name}.csv is not there"
            continue
        with path.open(newline="") as file:
            if next(csv.reader(file), None) != columns:
                yield f"docs/safety/{name}.csv:1: the columns are {','.join(columns)}"
                return
        for number, row in enumerate(table(name), 2):
            if not all(row[column] for column in columns):
                yield f"docs/safety/{name}.csv:{number}: an empty cell"
    modules = {row["file"]: row["module"] for row in table("modules")}
    marked = dict(marked_files())
    for file, module in modules.items():
        if not (REPOSITORY / file).is_file():
            yield f"docs/safety/modules.csv: there is no file {file}"
        elif marked.get(file) != module:
            yield f"{file}: its head does not say `// Safety module: {module} (docs/safety/modules.csv).`"
    for file in marked:
        if file not in modules:
            yield f"{file}: says that it is a safety module and does not stand in docs/safety/modules.csv"
    for name in ("coverage_gaps", "mutants"):
        for number, row in enumerate(table(name), 2):
            where = f"docs/safety/{name}.csv:{number}"
            if row["file"] not in modules:
                yield f"{where}: {row['file']} is no safety module"
            elif len(lines_like(row["file"], row["line"])) != 1:
                yield f"{where}: not exactly one line of {row['file']} reads `{row['line']}`"


def main():
    found = list(problems())
    for problem in found:
        print(problem)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
