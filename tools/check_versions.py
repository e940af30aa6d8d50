#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The version of the project stands in CMakeLists.txt. Files that other tools read as they are say the same, and code says
none: it asks hirosco/utilities/version.hpp."""
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
sys.exit("\n".join(wrong) or None)
