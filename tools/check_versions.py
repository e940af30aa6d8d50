#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The version of the project stands in CMakeLists.txt. Files that other tools read as they are say the same, and code says
none: it asks hirosco/utilities/version.hpp. Versions and marks of interfaces are said in docs/interfaces.md as their constants are."""
import json
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent


def read(path):
    return (root / path).read_text()


version = re.search(r"^project\(hirosco VERSION (\S+)", read("CMakeLists.txt"), re.M)[1]
said = {
    "CITATION.cff": re.search(r"^version: (\S+)$", read("CITATION.cff"), re.M)[1],
    "CHANGELOG.md": re.search(r"^## (\S+?),", read("CHANGELOG.md"), re.M)[1],
}
for folder in ("ground/web", "tests/browser"):
    lock = json.loads(read(f"{folder}/package-lock.json"))
    said[f"{folder}/package.json"] = json.loads(read(f"{folder}/package.json"))["version"]
    said[f"{folder}/package-lock.json"] = lock["version"] if lock["version"] == lock["packages"][""]["version"] else "two"
wrong = [f"{path} says version {found}, CMakeLists.txt {version}" for path, found in said.items() if found != version]
code = subprocess.run(["git", "grep", "-lF", f'"{version}"', "--", "*.cpp", "*.hpp", "*.py", "*.js", "*.mjs"], cwd=root,
                      capture_output=True, text=True, check=False).stdout.split()
wrong += [f"{path} says the version itself" for path in code if path != "hirosco/utilities/version.hpp"]


def constant_of(name, texts):
    """The values of a constant `name`, or `Scope::name` in the files that have the scope, wherever it is given one."""
    scope, _, name = name.rpartition("::")
    has_scope = re.compile(rf"\b(?:namespace|class|struct) (?:\w+::)*{scope}\b")
    value = re.compile(rf"\bconstexpr [\w:]+ {name} = (\d+);")
    return {int(number) for text in texts if name in text and (not scope or has_scope.search(text)) for number in value.findall(text)}


def of_interfaces(page, texts):
    """What of the table in docs/interfaces.md is not as the code has it."""
    rows = [line for line in page.splitlines() if line.startswith("| ")]
    told = [(row.split(" | ")[0][2:], name, int(number)) for row in rows for name, number in re.findall(r"`([\w:]*version|application_id)`,? (\d+)", row)]
    for row, name, number in told:
        if name in ("application_id", "user_version"):  # SQLite's words: by the statement that sets them
            if not any(f"PRAGMA {name} = {number}" in text for text in texts):
                yield f"docs/interfaces.md: {row}: nothing sets {name} to {number}"
        elif (found := constant_of(name, texts)) != {number}:
            yield f"docs/interfaces.md: {row}: {name} is {number}, in the code {sorted(found) or 'nothing'}"
    if len(told) < 10:
        yield "docs/interfaces.md: its table of versions is not read"


sources = [path.read_text() for folder in ("hirosco", "supervisor", "ground", "tools") for path in sorted((root / folder).rglob("*.[ch]pp"))
           if not path.name.endswith("_test.cpp")]
wrong += of_interfaces(read("docs/interfaces.md"), sources)
# One that is said wrongly is seen, of each kind.
for written, planted in (("`page_version` ", "`page_version` 9"), ("`Journal::version` ", "`Journal::version` 9"), ("`application_id` ", "`application_id` 9")):
    if len(list(of_interfaces(read("docs/interfaces.md").replace(written, planted, 1), sources))) != 1:
        wrong.append(f"planted and not seen: {planted}")
sys.exit("\n".join(wrong) or None)
