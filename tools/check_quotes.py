#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A code block that follows `<!-- quote: PATH -->` in a Markdown file must be PATH or a contiguous part of it."""
import pathlib
import re
import subprocess
import sys

quote = re.compile(r"^<!-- quote: (\S+) -->\n+```[^\n]*\n(.*?)^```$", re.M | re.S)
mark = re.compile(r"^<!-- quote:", re.M)


def wrong(text, read):
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


def self_test():
    read = {"a.cpp": "one\ntwo\nthree\n"}.get
    fence = "<!-- quote: {} -->\n```cpp\n{}```\n"
    good = [("a.cpp", "one\ntwo\nthree\n"), ("a.cpp", "two\n")]
    bad = [("a.cpp", "tow\n"), ("a.cpp", "one\nthree\n"), ("a.cpp", "ne\ntwo\n"), ("b.cpp", "one\n"), ("a.cpp", "")]
    assert not any(list(wrong(fence.format(*case), read)) for case in good)
    assert all(list(wrong(fence.format(*case), read)) for case in bad)
    assert list(wrong("<!-- quote: a.cpp -->\nno block\n", read))


self_test()
root = pathlib.Path(__file__).resolve().parent.parent
names = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True).stdout.split()
documents = [root / name for name in names] or [file for file in root.rglob("*.md") if "build" not in file.parts]


def read(path):
    file = root / path
    return file.read_text() if file.is_file() else None


found = [f"{file.relative_to(root)}: {what}" for file in documents if file.is_file()
         for what in wrong(file.read_text(), read)]
sys.exit("\n".join(found) or None)
