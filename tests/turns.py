#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Tests that take turns in ./check (turns.txt, docs/adr/0153).

    turns.py which [NAME]             the turn of this name; without one that of this commit
    turns.py tell TURN                one line for people
    turns.py left TURN                a regular expression for ctest -E: all tests that this turn leaves out
    turns.py targets BUILD [ctest options]   what ninja has to build before those tests
    turns.py kept BUILD...            every name of the table is a test of one of these build folders, once, and not `long`; what is `long`
                                      stands in the README, by its name or in a row whose command takes it

TURN is a name of the table, or `whole`, which leaves out nothing."""
import json, pathlib, re, shlex, subprocess, sys, time

HERE = pathlib.Path(__file__).resolve().parent


def table(text):
    """Names of turns and their tests. Lines that begin with a space go on with the row before."""
    rows = re.sub(r"\n +", " ", re.sub(r"(?m)^#.*\n", "", text)).splitlines()
    return {name: tests.split() for name, tests in (row.split(":") for row in rows)}


def of_commit(turns):
    """A commit has one turn, wherever it is checked; files without their history have the one of the day."""
    asked = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=HERE, capture_output=True, text=True)
    number = int(asked.stdout, 16) if asked.returncode == 0 else int(time.time() // 86_400)
    return list(turns)[number % len(turns)]


def left_out(turns, turn):
    return [] if turn == "whole" else [test for name, tests in turns.items() if name != turn for test in tests]


def tests_of(folder, options=()):
    shown = subprocess.run(["ctest", "--test-dir", str(folder), "--show-only=json-v1", *options], check=True, capture_output=True, text=True)
    return json.loads(shown.stdout)["tests"]


def targets_of(tests, folder):
    """A test of which ctest finds no command is a program of that name which is not built yet; others name what they use."""
    wanted, programs = set(), str(folder.resolve() / "bin") + "/"
    for test in tests:
        words = test.get("command", [programs + test["name"]])
        wanted.update("bin/" + word.removeprefix(programs) for word in words if word.startswith(programs))
    return sorted(wanted)


def faults(turns, known):
    """`known`: labels of every test by its name."""
    told, seen = [], set()
    for name, tests in turns.items():
        for test in tests:
            if test in seen: told.append(f"{test} has two turns")
            if test not in known: told.append(f"{test} ({name}) is no test")
            elif "long" in known[test]: told.append(f"{test} ({name}) is in no check, as it is `long`")
            seen.add(test)
    return told


def commands(readme):
    """What each `ctest` of the README chooses by: [{option: pattern}]. One that takes whatever is `long` names nobody."""
    found = []
    for span in re.findall(r"`ctest ([^`]+)`", readme):
        words = shlex.split(span)
        chosen = {option: pattern for option, pattern in zip(words, words[1:]) if option in ("-R", "-L", "-LE")}
        if chosen.keys() - {"-LE"} and chosen != {"-L": "long"}:
            found.append(chosen)
    return found


def takes(chosen, test, its_labels):
    of = lambda pattern: any(re.search(pattern, label) for label in its_labels)
    return (re.search(chosen.get("-R", ""), test) is not None and ("-L" not in chosen or of(chosen["-L"]))
            and not ("-LE" in chosen and of(chosen["-LE"])))


def unnamed(known, readme):
    rows, words = commands(readme), set(re.findall(r"`(\w+)`", readme))
    return [f"{test} is `long`, and no row of README.md names or takes it" for test, its_labels in sorted(known.items())
            if "long" in its_labels and test not in words and not any(takes(row, test, its_labels) for row in rows)]


def labels(test):
    return next((p["value"] for p in test.get("properties", ()) if p["name"] == "LABELS"), [])


def main(what, *rest):
    turns = table((HERE / "turns.txt").read_text())
    if what in ("tell", "left") and rest[0] not in (*turns, "whole"):
        sys.exit(f"turns.py: no turn '{rest[0]}'; there are {', '.join(turns)} and whole")
    if what == "which":
        print(rest[0] if rest and rest[0] else of_commit(turns))
    elif what == "tell":
        others = left_out(turns, rest[0])
        print(f"turn '{rest[0]}' of {len(turns)}: {len(others)} tests are left to other turns" if others else "all tests, whosever turn it is")
    elif what == "left":
        print("^(" + "|".join(left_out(turns, rest[0]) or ["-"]) + ")$")
    elif what == "targets":
        folder = pathlib.Path(rest[0])
        print(*targets_of(tests_of(folder, rest[1:]), folder))
    elif what == "kept":
        known = {test["name"]: labels(test) for folder in rest for test in tests_of(folder)}
        told = faults(turns, known) + unnamed(known, (HERE.parent / "README.md").read_text())
        planted = (faults({"a": ["x", "y"], "b": ["x", "z"]}, {"x": [], "y": ["long"]}) +
                   unnamed({"x": ["long"], "y": ["long"], "short": []}, "`ctest -L long` `ctest -L long -R '^y$'`"))
        print(*told, sep="\n", end="\n" if told else "")
        print(f"{sum(map(len, turns.values()))} tests in {len(turns)} turns; of four planted faults {len(planted)} found")
        sys.exit(1 if told or len(planted) != 4 else 0)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    if len(sys.argv) < 2: sys.exit(__doc__)
    main(*sys.argv[1:])
