# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""tools/conform/conform finds good what is good, in whatever language, and finds each planted mistake.

    suite_test.py PROGRAM DESCRIPTOR      the program keeps every duty; one in C is compiled first
    suite_test.py --mutants [N]           each of mutants.py, or every Nth, is found by its duty; each fits where it is to be planted
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CONFORM = HERE.parents[1] / "tools/conform/conform"


def judge(program, descriptor, *more):
    return subprocess.run([CONFORM, program, descriptor, *more], capture_output=True, text=True, check=False)


def compiled(source, folder):
    """A program in C11; the warnings of one with a planted mistake are not looked at."""
    program = f"{folder}/{pathlib.Path(source).stem}"
    subprocess.run([os.environ.get("CC", "cc"), "-std=c11", "-O2", "-o", program, source, "-lm"], check=True, capture_output=True)
    return program


def found(mutant):
    """Words, and whether the suite found it."""
    file, stands, planted, duty = mutant
    text = (HERE / file).read_text()
    with tempfile.TemporaryDirectory() as folder:
        whose = file.partition("_")[0].partition(".")[0]
        for each in HERE.glob(f"{whose}*"):
            shutil.copy(each, folder)
        (pathlib.Path(folder) / file).write_text(text.replace(stands, planted))
        program = compiled(f"{folder}/lantern.c", folder) if whose == "lantern" else f"{folder}/metronome.py"
        judged = judge(program, f"{folder}/{whose}.xml", "--only", duty)
    lines = judged.stdout.splitlines() or [judged.stderr[-200:]]
    return f"{planted.strip()[:60]!r}: {lines[0][:150]}", judged.returncode == 1 and lines[0].startswith(f"FAILED {duty}")


def misplaced(mutant):
    """What is wrong with where it is to be planted."""
    file, stands, _, _ = mutant
    times = (HERE / file).read_text().count(stands)
    return None if times == 1 else f"{stands!r} stands {times} times in {file}"


def mutants(every):
    sys.path.insert(0, str(HERE))
    from mutants import MUTANTS
    wrong = [words for words in map(misplaced, MUTANTS) if words]
    print("\n".join(wrong))
    chosen = [] if wrong else MUTANTS[::every]
    missed = len(wrong)
    with concurrent.futures.ThreadPoolExecutor(3) as several:       # they mostly wait
        for words, good in several.map(found, chosen):
            missed += not good
            print(f"{'found ' if good else 'MISSED'} {words}", flush=True)
    print(f"{len(chosen)} of {len(MUTANTS)} mutants, {missed} missed")
    return missed != 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--mutants"]:
        sys.exit(mutants(int(sys.argv[2]) if len(sys.argv) > 2 else 1))
    with tempfile.TemporaryDirectory() as place:
        given = [compiled(word, place) if word.endswith(".c") else word for word in sys.argv[1:]]
        outcome = judge(*given)
    print(outcome.stdout + outcome.stderr)
    sys.exit(outcome.returncode)
