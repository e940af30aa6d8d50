#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A code block that follows `<!-- quote: PATH -->` in a Markdown file must be PATH or a contiguous part of it; and what
the documents name in backquotes as a file or folder of the project must exist."""
import pathlib
import re
import subprocess
import sys

quote = re.compile(r"^<!-- quote: (\S+) -->\n+```[^\n]*\n(.*?)^```$", re.M | re.S)
named = re.compile(r"`((?:cmake|docs|hirosco|missions|simulation|subsystems|supervisor|tests|tools)/[\w./-]*)`")
mark = re.compile(r"^<!-- quote:", re.M)


def wrong(text, read, exists):
    """Yields what is wrong with the quotes of one Markdown text; `read` gives the text of a path, None if absent."""
    blocks = quote.findall(text)
    if len(blocks) != len(mark.findall(text)):
        yield "a quote mark without a code block after it"
    for path, block in blocks:
        source = read(path)
        if source is None:
            yield f"quotes {path}, which does not exist"
        elif not block.strip() or f"\n{block}" not in f"\n{source}":
            yield f"its quote of {path} differs from the file"
    for path in named.findall(text):
        if "..." not in path and not re.search("/[A-Z]+(/|$)", path) and not exists(path):
            yield f"names {path}, which does not exist"


def self_test():
    read = {"a.cpp": "one\ntwo\nthree\n"}.get
    exists = {"tools/a.cpp", "tools/"}.__contains__
    fence = "<!-- quote: {} -->\n```cpp\n{}```\n"
    good = [("a.cpp", "one\ntwo\nthree\n"), ("a.cpp", "two\n")]
    bad = [("a.cpp", "tow\n"), ("a.cpp", "one\nthree\n"), ("a.cpp", "ne\ntwo\n"), ("b.cpp", "one\n"), ("a.cpp", "")]
    assert not any(list(wrong(fence.format(*case), read, exists)) for case in good)
    assert all(list(wrong(fence.format(*case), read, exists)) for case in bad)
    assert list(wrong("<!-- quote: a.cpp -->\nno block\n", read, exists))
    assert list(wrong("see `tools/b.cpp`", read, exists)) and not list(wrong("`tools/a.cpp` `tools/`", read, exists))


self_test()
root = pathlib.Path(__file__).resolve().parent.parent
names = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True).stdout.split()
documents = [root / name for name in names] or [file for file in root.rglob("*.md") if "build" not in file.parts]


def read(path):
    file = root / path
    return file.read_text() if file.is_file() else None


def exists(path):
    return (root / path).exists() or any(root.glob(path + "-*.md"))


found = [f"{file.relative_to(root)}: {what}" for file in documents if file.is_file()
         for what in wrong(file.read_text(), read, exists)]
sys.exit("\n".join(found) or None)
