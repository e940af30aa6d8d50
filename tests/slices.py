#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Which slices of which campaigns a check has run, and what they said (slices.txt, docs/adr/0221).

    slices.py through FOLDER TURN BEGAN   hands on what ctest says; before its summary, which stays the end, stands the table of
                                    what the results in FOLDER (ctest --output-junit) say of slices, and how long it took
    slices.py kept BUILD            each slice of the table is a test of this build folder and so is its whole, or it is a
                                    file; each test with a NAME_whole stands in the table; what is told of planted results

TURN is one of turns.txt, or `whole`; BEGAN the time at which the check began, in seconds since 1970."""
import collections, pathlib, re, sys, tempfile, time
import xml.etree.ElementTree as xml

import turns

HERE = pathlib.Path(__file__).resolve().parent
SUMMARY = re.compile(r"\d+% tests passed")
NEXT = re.compile(r" *(\d+/\d+ Test +#|Start +\d+:)")  # what came before was the summary of a ctest that a test has run
WIDEST = 200  # letters of what a slice says of itself

Slice = collections.namedtuple("Slice", "whole pattern")
Run = collections.namedtuple("Run", "name seconds became said")


def table(text):
    """Slices by the names of their tests. ValueError: a row that cannot be one."""
    rows = re.sub(r"\n +", " ", re.sub(r"(?m)^#.*\n", "", text)).splitlines()
    found = {}
    for row in filter(None, rows):
        if row.count(": ") < 2: raise ValueError(f"slices.txt: '{row}' wants a whole, tests and an expression, each behind a colon")
        whole, tests, pattern = row.split(": ", 2)
        try:
            told_by = re.compile(f"(?m)^.*?{pattern}")
        except re.error as why:
            raise ValueError(f"slices.txt: '{pattern}' of {tests} is no expression: {why}") from why
        if told_by.groups != 1: raise ValueError(f"slices.txt: '{pattern}' of {tests} has {told_by.groups} groups; what is told is one")
        for test in tests.split():
            if test in found: raise ValueError(f"slices.txt: {test} has two rows; take one out")
            found[test] = Slice(whole.replace("*", test), told_by)
    return found


def runs(slices, results):
    """Of each slice that these results (the root of a file each) have, in their order."""
    for case in (case for root in results for case in root.iter("testcase") if case.get("name") in slices):
        output = case.findtext("system-out") or ""
        skipped = case.find("skipped") is not None or case.get("status") in ("notrun", "disabled")
        became = "skipped" if skipped else "passed" if case.get("status") == "run" else "FAILED"
        # A flight that was flown again on a late host says all of it again.
        said = list(dict.fromkeys(slices[case.get("name")].pattern.findall(output)))
        if became != "passed" and not said:
            said = [line.strip() for line in output.splitlines() if line.strip()][-1:]
        yield Run(case.get("name"), float(case.get("time", 0)), became, "; ".join(said) or "says no number of itself")


def told(slices, results, turn, left, took_s):
    """The lines of the table."""
    rows = list(runs(slices, results))
    yield f"Slices of campaigns in this check, turn '{turn}': name, whole, seconds, what it says"
    names, wholes = (max(map(len, column), default=0) for column in ([r.name for r in rows], [slices[r.name].whole for r in rows]))
    for run in rows:
        said = run.said if len(run.said) <= WIDEST else run.said[:WIDEST - 3] + "..."
        yield f"  {run.name:{names}}  {slices[run.name].whole:{wholes}}  {run.seconds:6.1f}  {run.became}: {said}"
    yield f"{len(rows)} slices in a check of {took_s // 60} min {took_s % 60} s"
    if others := [name for name in slices if name in left]:
        yield f"of other turns: {' '.join(others)}"


def through(lines, before_summary, say):
    """Hands lines on; the summary of ctest, and the empty lines before it, come behind what `before_summary` gives."""
    held = []
    for line in lines:
        if held and NEXT.match(line):
            say("".join(held))
            held = []
        if not line.strip() or any(map(SUMMARY.match, [*held, line])):
            held.append(line)
        else:
            say("".join([*held, line]))
            held = []
    say("\n" + "\n".join(before_summary()) + "\n" + "".join(held))


def results_in(folder):
    """The roots of what ctest wrote; what it did not write whole has no slice to tell of."""
    for path in sorted(pathlib.Path(folder).glob("*.xml")):
        try:
            yield xml.fromstring(path.read_text(errors="replace"))
        except xml.ParseError as error:
            print(f"{path}: {error}; the table lacks its slices", file=sys.stderr)


def faults(slices, known):
    """`known`: labels of every test by its name."""
    for name, each in slices.items():
        if name not in known: yield f"slices.txt: {name} is no test"
        if each.whole in known:
            if "long" not in known[each.whole]: yield f"slices.txt: {each.whole}, the whole of {name}, is in every check: then {name} need not be"
        elif not (HERE.parent / each.whole).is_file(): yield f"slices.txt: {each.whole}, the whole of {name}, is neither a test nor a file"
    for name, labels in known.items():
        numbered = re.fullmatch(r"(.+?)_\d+\w*", name)
        for part in known if numbered and "long" in labels else ():
            if "long" in known[part] or not re.fullmatch(rf"{numbered[1]}(_\d+)?", part): continue
            if part not in slices: yield f"slices.txt lacks {part}, of which {name} takes more"
        if f"{name}_whole" in known and name not in slices: yield f"slices.txt lacks {name}, of which {name}_whole takes all"
        if name.startswith("fuzz_slice_") and name not in slices: yield f"slices.txt lacks {name}"


PLANTED = """<testsuite><testcase name="fuzz_slice_words" time="0.21" status="run"><system-out>
10000 runs of seed 1 in 0.2 s of the processor, 8984 times something was taken: nothing found
</system-out></testcase><testcase name="layers" time="1" status="run"><system-out>10 passed</system-out></testcase>
<testcase name="robots_20" time="0.1" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/><system-out>no Pinocchio
</system-out></testcase><testcase name="restoration" time="9" status="run"><system-out>ok
measured: joystick: 3 kills, back as commanded after 1.00 s (median), 1.20 s at most
measured: joystick: 3 kills, back as commanded after 1.00 s (median), 1.20 s at most
measured: manipulator: 3 kills, back as commanded after 1.10 s (median), 1.30 s at most
</system-out></testcase><testcase name="stops" time="2" status="fail"><failure message=""/><system-out>VIOLATION late
</system-out></testcase><testcase name="pus_test" time="2" status="run"><system-out>[  PASSED  ] 214 tests.
</system-out></testcase></testsuite>"""
WANTED = ["fuzz_slice_words tests/fuzz/campaign 0.2 passed: 10000 runs of seed 1 in 0.2 s of the processor, 8984 times something was taken: nothing found",
          "robots_20 robots_1000 0.1 skipped: no Pinocchio",
          "restoration restoration_100 9.0 passed: joystick: 3 kills, back as commanded after 1.00 s (median), 1.20 s at most; "
          "manipulator: 3 kills, back as commanded after 1.10 s (median), 1.30 s at most",
          "stops stops_1000 2.0 FAILED: VIOLATION late", "pus_test pus_test_whole 2.0 passed: 214 tests"]


def problems_of_itself(slices):
    """What is told of planted results, and where."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "1.xml").write_text(PLANTED)
        rows = list(told(slices, results_in(folder), "arms", {"journal", "fuzz_slice_journal"}, 335))
    if [" ".join(row.split()) for row in rows[1:-2]] != WANTED: yield f"of planted results is told: {rows}"
    if rows[-2:] != ["5 slices in a check of 5 min 35 s", "of other turns: fuzz_slice_journal"]: yield f"at the end is told: {rows[-2:]}"
    nested = "2: 100% tests passed, 0 tests failed out of 3\n100% tests passed, 0 tests failed out of 3\n\nsomething\n 2/2 Test  #7: x ..   Passed\n"
    summary = "\n\n100% tests passed, 0 tests failed out of 1\n\nTotal Test time (real) =   1.00 sec\n"
    said = []
    through(f"1/2 Test\n\nsomething\n{nested}{summary}".splitlines(keepends=True), lambda: ["table"], said.append)
    if "".join(said) != f"1/2 Test\n\nsomething\n{nested}\ntable\n{summary}": yield f"ctest's summary is not the end: {said}"
    lacking = {f"slices.txt lacks {what}" for what in ("fuzz_slice_new", "a, of which a_whole takes all", "b_20, of which b_1000 takes more", "c, of which c_10_minutes takes more")}
    planted = {"fuzz_slice_new": [], "a": [], "a_whole": ["long"], "b_20": [], "b_1000": ["long"], "c": [], "c_10_minutes": ["long"], "c_d": []}
    if not lacking <= set(faults(slices, planted)) or "c_d" in "".join(faults({}, planted)): yield "what lacks in the table is not found"
    for wrong in ("a: b", "a: b: (x", "a: b: x", "a: b: (x)(y)", "a: b b: (x)"):
        try:
            table(wrong)
        except ValueError:
            continue
        yield f"the row '{wrong}' is taken"


def main(what, *rest):
    try:
        slices = table((HERE / "slices.txt").read_text())
    except ValueError as why:
        sys.exit(str(why))
    if what == "through" and len(rest) == 3:
        folder, turn, began = rest
        left = turns.left_out(turns.table((HERE / "turns.txt").read_text()), turn)
        sys.stdin.reconfigure(errors="replace")
        through(sys.stdin, lambda: told(slices, results_in(folder), turn, left, int(time.time()) - int(began)),
                lambda text: print(text, end="", flush=True))
    elif what == "kept" and len(rest) == 1:
        known = {test["name"]: turns.labels(test) for test in turns.tests_of(pathlib.Path(rest[0]))}
        wrong = [*faults(slices, known), *problems_of_itself(slices)]
        print(*wrong, sep="\n", end="\n" if wrong else "")
        print(f"{len(slices)} slices of {len({each.whole for each in slices.values()})} campaigns")
        sys.exit(1 if wrong else 0)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    if len(sys.argv) < 2: sys.exit(__doc__)
    main(*sys.argv[1:])
