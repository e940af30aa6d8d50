#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A parser comes with its fuzz target: each header that declares a function which reads octets or text has its row in parsers.csv, with a target of
this folder that calls it, or with the reason why there is none. Each target is named, has its corpus and is built. Prints what breaks that, and
breaks it itself, to be caught."""
import csv, pathlib, re, sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PARTS = ("hirosco", "robotics", "supervisor", "subsystems", "simulation", "missions", "ground", "tools")
READS = re.compile(r"\b(?:(?:read|parse|parsed|decode|hear|receive|received|recall|take)(?:_\w+)?|\w+_from_text|words_of_line)\s*\(\s*"
                   r"(?:(?:const\s+)?(?:std::)?(?:string_view|string&|istream&|Octets|OctetReader&|nlohmann::json&)"
                   r"|const std::filesystem::path& file, const FileSource|std::string name, std::string_view|MeshKind kind, std::string_view)")
LARGEST_CORPUS_OCTETS = 4096


def headers():
    for part in PARTS:
        for path in sorted((ROOT / part).rglob("*.hpp")):
            if "testing" not in path.parts and path.name != "testing.hpp":
                yield path.relative_to(ROOT).as_posix(), path.read_text()


def faults(texts, rows, files, build):
    """`texts` by the names of headers; `rows` of the table; `files` of this folder with their sizes; `build`: its CMakeLists.txt."""
    known = [row["file"] for row in rows]
    for name, text in texts.items():
        # What remembers is read from the journal: one target has all of them.
        if (found := READS.search(text.replace("recall(OctetReader&", ""))) and name not in known:
            yield f"{name} reads what others write ({found[0]}...) and has no row in tests/fuzz/parsers.csv"
    named = set()
    for row in rows:
        targets = row["targets"].split()
        named.update(targets)
        if row["file"] not in texts:
            yield f"parsers.csv: there is no {row['file']}"
        if known.count(row["file"]) != 1:
            yield f"parsers.csv: {row['file']} has two rows"
        if not targets and not row["why_none"]:
            yield f"parsers.csv: {row['file']} has neither a target nor a reason"
    there = {name.removesuffix("_fuzz.cpp") for name in files if name.endswith("_fuzz.cpp")} - {"planted"}
    for name in sorted(named | there):
        if name not in there: yield f"parsers.csv: there is no target {name}"
        elif name not in named: yield f"{name}_fuzz.cpp is no row's of parsers.csv"
        elif f"{name}_corpus.txt" not in files: yield f"{name}_fuzz.cpp has no {name}_corpus.txt"
        elif not re.search(rf"hirosco_fuzz_target\({name} ", build): yield f"{name}_fuzz.cpp is not built"
    for name, octets in files.items():
        if name.endswith("_corpus.txt") and octets > LARGEST_CORPUS_OCTETS:
            yield f"{name} has {octets} octets, {LARGEST_CORPUS_OCTETS} at most: name files of the tree, or keep less"


def planted():
    """Each fault once."""
    row = {"file": "a.hpp", "targets": "a", "why_none": ""}
    texts, files, build = {"a.hpp": "Thing read_a(Octets octets);"}, {"a_fuzz.cpp": 1, "a_corpus.txt": 1}, "hirosco_fuzz_target(a RUNS 1)"
    assert not list(faults(texts, [row], files, build))
    yield faults(texts | {"b.hpp": "static Result<B> parse(std::string_view text);"}, [row], files, build)
    yield faults(texts, [row, row], files, build)
    yield faults(texts, [row | {"targets": ""}], {}, build)
    yield faults(texts, [row, {"file": "gone.hpp", "targets": "", "why_none": "x"}], files, build)
    yield faults(texts, [row | {"targets": "a b"}], files, build)
    yield faults(texts, [row], files | {"c_fuzz.cpp": 1}, build)
    yield faults(texts, [row], {"a_fuzz.cpp": 1}, build)
    yield faults(texts, [row], files, "")
    yield faults(texts, [row], files | {"a_corpus.txt": 5000}, build)


def main():
    with (HERE / "parsers.csv").open() as table:
        rows = list(csv.DictReader(table))
    texts = dict(headers())
    files = {path.name: path.stat().st_size for path in HERE.iterdir()}
    told = list(faults(texts, rows, files, (HERE / "CMakeLists.txt").read_text()))
    told += [f"planted fault {i} was not seen" for i, found in enumerate(planted()) if not list(found)]
    print(*told, sep="\n", end="\n" if told else "")
    print(f"{len(rows)} headers that read, {sum(1 for row in rows if row['targets'])} of them by fuzz targets")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
