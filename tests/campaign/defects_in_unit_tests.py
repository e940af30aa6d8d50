#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review and the unit test that sees each. As they were they are put into a copy of the sources, all at once and
each where it is chosen; the copy is built once in build/defects, and the tests of each must fail with it and pass without.
defects_in_unit_tests.py [--list] [--only NAME]... [--test PROGRAM]

Not here, with the reason:
- a permit page that its subsystem may write (SF13): takes a process that does it, tests/fault/hostile_test.py;
- output errors, numbers and exit codes of the commands: whole programs, tests/check and tests/endtoend;
- two flights on one log: whole flights, tests/endtoend/instances_test.py;
- the HTTP interface: a whole station, tests/ground/api_test.cpp and attack_test.py;
- failing malloc or threads: the whole process ends, hirosco/utilities/os/last_words_test.cpp;
- on-board time that goes by the calendar: nobody may step that of the computer, hirosco/utilities/os/clock_test.cpp gives an epoch;
- words declared and not in force: lists, tools/check_declared.py.
defects_flown.py has some of those here once more, found by flights.
"""
import argparse, os, pathlib, re, shutil, subprocess, sys, time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE)]
from defects_flown import CHOSEN, HEADER  # noqa: E402
from found_defects import DEFECTS  # noqa: E402

COPY = ROOT / "build" / "defects" / "sources"
BUILD = COPY / "build" / "release"
TEST_LIMIT_S = 120


def misfits(root=ROOT):
    """Defects whose place in the code is gone: [text]. What fits nowhere finds nothing."""
    names = [defect.name for defect in DEFECTS]
    found = [f"the name {name} stands twice" for name in sorted({name for name in names if names.count(name) > 1})]
    for defect in DEFECTS:
        number = (root / defect.file).read_text().count(defect.now)
        if number != 1:
            found.append(f"{defect.name}: {defect.file} has {number} times '{defect.now}'")
        if not defect.is_read and "PLANTED" not in defect.was:
            found.append(f"{defect.name}: would stand in the code of all the others")
    return found


def sources():
    """{name: octets} of the tree as it stands, without what git ignores, and with the defects."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            check=True, capture_output=True, text=True).stdout
    found = {name: (ROOT / name).read_bytes() for name in listed.split("\0") if name and (ROOT / name).is_file()}
    found["planted.hpp"] = HEADER.encode()
    for defect in DEFECTS:
        if not defect.is_read:
            found[defect.file] = found[defect.file].replace(defect.now.encode(), defect.planted.encode())
    for name in {defect.file for defect in DEFECTS if not defect.is_read}:
        found[name] = b'#include "planted.hpp"\n' + found[name]
    return found


class Copy:
    """The sources with all defects, in a folder that stays: what did not change since is not built again."""

    def __init__(self):
        wanted = sources()
        for path in COPY.rglob("*"):
            if path.is_file() and BUILD.parent not in path.parents and str(path.relative_to(COPY)) not in wanted:
                path.unlink()
        for name, octets in wanted.items():
            target = COPY / name
            if not target.exists() or target.read_bytes() != octets:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(octets)
                if (ROOT / name).exists():
                    shutil.copymode(ROOT / name, target)
        self.run("cmake", "--preset", "release")

    def run(self, *words):
        done = subprocess.run(words, cwd=COPY, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)}: {(done.stdout + done.stderr)[-4000:]}")

    def build(self, tests, jobs):
        self.run("ninja", "-C", str(BUILD), f"-j{jobs}", *tests)

    def failed(self, defect, with_it):
        """(tests of the filter that ran, those of them that failed); one that took the program with it is among them."""
        descriptor = (COPY / defect.file).read_text() if with_it and defect.is_read else None
        try:
            if descriptor is not None:
                (COPY / defect.file).write_text(descriptor.replace(defect.now, defect.was))
            done = subprocess.run([BUILD / "bin" / defect.test, f"--gtest_filter={defect.filter}"], cwd=BUILD, capture_output=True,
                                  text=True, errors="replace", timeout=TEST_LIMIT_S, env=os.environ | {CHOSEN: defect.name if with_it else ""})
            output, code = done.stdout, done.returncode
        except subprocess.TimeoutExpired as late:
            output, code = (late.stdout or b"").decode(errors="replace"), None
        finally:
            if descriptor is not None:
                (COPY / defect.file).write_text(descriptor)
        ran = re.findall(r"^\[ RUN      \] (\S+)", output, re.M)
        failed = re.findall(r"^\[  FAILED  \] ([^\s,]+).* \(\d+ ms\)$", output, re.M)
        if ran and not failed and (code is None or code < 0):
            failed = [f"{ran[-1]} ({'without end' if code is None else f'ended by signal {-code}'})"]
        return ran, failed


def find(copy, defect):
    """(whether its tests see it and nothing else, how that is told)"""
    ran, other = copy.failed(defect, with_it=False)
    if not ran:
        return False, f"ERROR: no test {defect.filter}"
    if other:
        return False, f"ERROR: without it there fails {', '.join(other)}"
    _, seen = copy.failed(defect, with_it=True)
    return bool(seen), f"found by {', '.join(seen)}" if seen else f"NOT FOUND by {defect.filter}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="NAME", help="those whose name begins so; may be given again")
    parser.add_argument("--test", metavar="PROGRAM", help="those that this program must see")
    parser.add_argument("--list", action="store_true", help="say which there are and whether each still fits the code; build nothing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the compiler at a time")
    arguments = parser.parse_args()
    chosen = [defect for defect in DEFECTS if arguments.test in (None, defect.test)
              and (not arguments.only or defect.name.startswith(tuple(arguments.only)))]
    if not chosen:
        parser.error("none is chosen")
    if arguments.list:
        for defect in chosen:
            print(f"{defect.name:<30} {defect.file}: {defect.test} {defect.filter}")
    if gone := misfits():
        sys.exit("\n".join(gone))
    if arguments.list:
        return 0
    copy = Copy()
    copy.build(sorted({defect.test for defect in chosen}), arguments.jobs)
    missed = 0
    for defect in chosen:
        begun = time.monotonic()
        found, text = find(copy, defect)
        missed += not found
        print(f"{defect.name:<30} {defect.test:<22} {text} ({time.monotonic() - begun:.1f} s)", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} defects found again")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
