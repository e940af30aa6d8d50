#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What README.md and the guides give to type is there: a command of `hirosco`, a test of `ctest -R`, a program of the repository with each option that stands beside
it, a target that is built. Looked at are texts in backquotes and blocks without a language. Prints what is not there, and plants one of each itself, to be caught."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = re.compile(r"(?:^|(?<=[\s`]))(?:\./)?((?:tools|bench|tests|simulation)/[\w./-]+|run|check)((?:[^\n;|&`#]| \|)*)")
OPTION = re.compile(r"(?<=\s)(--[a-z][a-z-]+)")


def typed(text):
    """What somebody may type, line by line."""
    text = re.sub(r"(?s)<!--.*?-->", "", text)
    for block in re.findall(r"(?m)^```\n((?:.*\n)*?)```$", text):
        yield from block.splitlines()
    yield from re.findall(r"(?m)^ {4}(\S.*)$", text)
    yield from re.findall(r"`([^`\n]+)`", re.sub(r"(?m)^```[^\n]*\n(?:.*\n)*?```$", "", text))


def said_in(place):
    """All text of a program: its file, or those of its folder beside it, where the rest of it lies."""
    files = [place]
    if place.parent not in (ROOT, ROOT / "tools", ROOT / "bench"):
        files += [path for path in place.parent.rglob("*") if path.is_file() and path.suffix in ("", ".py", ".cpp", ".hpp")]
    return "".join(path.read_text(errors="ignore") for path in files)


def missing(name, text, known):
    for line in typed(text):
        words = line.split("#")[0]
        if re.match(r"(?:\$ )?(?:sudo )?(?:\$?[\w/]*/)?hirosco [a-z]", words):
            command = re.search(r"hirosco ([a-z]+)", words)[1]
            if command not in known["commands"]:
                yield f"{name}: hirosco has no command {command}"
        for test in re.findall(r"ctest [^;]*-R '?\^?(\w+)\$?'?", words):
            if not re.search(rf"\b\w*{test}\b", known["cmake"]):
                yield f"{name}: ctest has no test {test}"
        for target in re.findall(r"\bbuild/\w+/bin/([\w-]+)", words):
            if not re.search(rf"\b{re.escape(target)}\b", known["cmake"]) and target.removeprefix("hirosco-") not in known["cmake"]:
                yield f"{name}: nothing builds {target}"
        for program, rest in PROGRAM.findall(words):
            if program in ("run", "check") and f"./{program}" not in words:
                continue
            place = ROOT / program
            if not place.exists():
                yield f"{name}: there is no {program}"
            elif place.is_file():
                yield from (f"{name}: {program} does not take {option}" for option in OPTION.findall(rest.partition("--run")[0] + (" --run" if "--run" in rest else "")) if option not in known["of"](place))


def main():
    cmake = "".join((ROOT / path).read_text() for path in subprocess.run(["git", "ls-files", "*CMakeLists.txt", "*.cmake"], cwd=ROOT, capture_output=True, text=True).stdout.split())
    texts = {}
    known = {"commands": set(re.findall(r'add_subcommand\(\s*"(\w+)"', (ROOT / "tools/hirosco/main.cpp").read_text())), "cmake": cmake,
             "of": lambda place: texts.setdefault(place, said_in(place))}
    found = [what for page in [ROOT / "README.md", *sorted((ROOT / "docs/guide").glob("*.md"))]
             for what in missing(page.relative_to(ROOT).as_posix(), page.read_text(), known)]
    for planted, wanted in (("`hirosco fly`", "no command fly"), ("`ctest --preset release -R '^nonesuch$'`", "no test nonesuch"), ("`bench/nonesuch`", "there is no bench/nonesuch"),
                            ("`tools/coverage --nonesuch`", "does not take --nonesuch"), ("```\n./check --nonesuch\n```\n", "check does not take --nonesuch"), ("`build/release/bin/nonesuch`", "builds nonesuch"),
                            ("    hirosco fly now\n", "no command fly")):
        if not any(wanted in what for what in missing("here", planted, known)):
            found.append(f"planted and not seen: {planted}")
    if any(missing("here", "`hirosco run`, `./check --all`, `tools/coverage`, `the hirosco of old`\n```xml\nhirosco fly\n```\n", known)):
        found.append("seen and nothing wrong with it")
    return "\n".join(found) or ("nothing is read" if not known["commands"] else None)


if __name__ == "__main__":
    sys.exit(main())
