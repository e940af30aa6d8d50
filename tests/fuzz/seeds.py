# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The inputs of a corpus as files, as libFuzzer has them; slice.cpp reads the same lines (README.md)."""
import pathlib


def seed_of(line, folder):
    if line.startswith("file "):
        return (folder / line.removeprefix("file ")).read_bytes()
    if line.startswith("text "):
        return line.removeprefix("text ").replace("\\n", "\n").encode()
    return bytes.fromhex(line)


def write(corpus, folder):
    """`folder` is there."""
    corpus = pathlib.Path(corpus)
    lines = [line for line in corpus.read_text().splitlines() if line and not line.startswith("#")]
    for number, line in enumerate(lines):
        (pathlib.Path(folder) / f"seed{number}").write_bytes(seed_of(line, corpus.parent))
