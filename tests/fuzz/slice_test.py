#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a slice (slice.cpp) finds: a defect of each kind, planted into a small parser, within as many runs as slices have, and its input is told so
that it can be tried again. slice_test.py PROGRAM CORPUS [address]: with this word the program was built with ASan."""
import os, pathlib, re, subprocess, sys, tempfile

RUNS = 20_000
ANYWHERE = {"the sum is not looked at": "what is taken has its sum",
            "no end": "an input takes too long",
            "something is thrown": "too short"}
BY_ADDRESS = {"octets behind the end are read": "overflow",
              "memory without bound": "max_allocation_size_mb|allocation-size-too-big|exceeds maximum"}


def tried(program, defect, *options):
    environment = dict(os.environ, HIROSCO_PLANTED=defect, ASAN_OPTIONS="max_allocation_size_mb=256:symbolize=0")
    done = subprocess.run([program, *options, "--patience", "2"], env=environment, capture_output=True, text=True, errors="replace", check=False)
    return done.returncode, done.stdout + done.stderr


def counted(told):
    return (re.search(r"(\d+) times something was taken", told) or [None, None])[1]


def faults(program, corpus, defects):
    for defect, says in defects.items():
        code, told = tried(program, defect, corpus, "--runs", str(RUNS))
        found = re.search(r"run (\d+), input: ([0-9a-f]*)", told)
        if code == 0 or not found or not re.search(says, told):
            yield f"NOT FOUND: {defect}: {code}: {told[-2000:]}"
            continue
        print(f"found in run {found[1]}: {defect}: {found[2]}", flush=True)
        again, told = tried(program, defect, corpus, "--input", found[2])
        if again == 0 or not re.search(says, told):
            yield f"its input does not show it again: {defect}: {again}: {told[-2000:]}"
        if tried(program, "", corpus, "--input", found[2])[0] != 0:
            yield f"its input shows it where nothing is planted: {defect}"
    code, told = tried(program, "", corpus, "--runs", str(RUNS))
    if code != 0 or "nothing found" not in told:
        yield f"something is found where nothing is planted: {told[-2000:]}"
    if counted(told) != counted(tried(program, "", corpus, "--runs", str(RUNS))[1]):
        yield "the same seed was not the same runs"
    with tempfile.TemporaryDirectory() as folder:
        for name, text, says in (("refused.txt", "4846 01 05 06\n", "nothing in it is taken"), ("odd.txt", "4846 0\n", "neither octets"),
                                 ("gone.txt", "file nobody.xml\n", "neither octets"), ("empty.txt", "# nothing\n", "there is no input")):
            rotten = pathlib.Path(folder) / name
            rotten.write_text(text)
            code, told = tried(program, "", str(rotten), "--runs", "100")
            if code == 0 or says not in told:
                yield f"a corpus of this kind is not seen: {name}: {code}: {told[-500:]}"


def main(program, corpus, *built):
    told = list(faults(program, corpus, ANYWHERE | (BY_ADDRESS if "address" in built else {})))
    print(*told, sep="\n", end="\n" if told else "")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
