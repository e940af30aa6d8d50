#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The shape of the house: no file over 500 lines, no class over 300, `supervisor.hpp` under 90, no circle of folders. Prints what
breaks it, and breaks each rule once itself, to be caught."""
import collections, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = ("hirosco", "robotics", "supervisor", "subsystems", "simulation", "missions", "ground", "tools", "tests", "bench")
LONGEST_FILE, LONGEST_CLASS = 500, 300
OTHERS = {"supervisor/supervisor.hpp": 90}
CODE = (".cpp", ".hpp", ".py", ".js", ".mjs")
CLASS = re.compile(r"^(?:template <.*> *)?(?:class|struct) (?:\[\[\w+\]\] )?(\w+)[^;(]*\{", re.M)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^">]+)"', re.M)


def files():
    for part in PARTS:
        for path in sorted((ROOT / part).rglob("*")):
            if path.suffix in CODE and not {"node_modules", "__pycache__", "build"} & set(path.parts):
                yield path.relative_to(ROOT).as_posix(), path.read_text()


def too_long(texts):
    for name, text in texts.items():
        limit = OTHERS.get(name, LONGEST_FILE)
        if (lines := text.count("\n")) > limit:
            yield f"{name}: {lines} lines, {limit} at most"
        if not name.endswith((".hpp", ".cpp")):
            continue
        for begin in CLASS.finditer(text):
            end = text.find("\n};", begin.start())
            if end > 0 and (lines := text.count("\n", begin.start(), end)) > LONGEST_CLASS:
                yield f"{name}: {begin.group(1)} has {lines} lines, {LONGEST_CLASS} at most"


def folder(name):
    return name.rsplit("/", 1)[0]


def within(one, other):
    return one == other or one.startswith(other + "/") or other.startswith(one + "/")


def circles(texts):
    """Folders that include each other, over however many; a folder and those in it are one. Tests may look up and down, and
    testing/ belongs to them."""
    edges = collections.defaultdict(set)
    for name, text in texts.items():
        if name.endswith((".hpp", ".cpp")) and "_test." not in name and "/testing/" not in name:
            edges[folder(name)] |= {folder(to) for to in INCLUDE.findall(text) if to in texts and not within(folder(name), folder(to))}
    seen, found = {}, []

    def visit(place, way):
        seen[place] = "open"
        for to in sorted(edges[place]):
            if seen.get(to) == "open":
                found.append(" -> ".join([*way[way.index(to):], to]))
            elif to not in seen:
                visit(to, way + [to])
        seen[place] = "done"
    for place in sorted(edges):
        if place not in seen:
            visit(place, [place])
    return found


def problems(texts):
    return list(too_long(texts)) + circles(texts)


PLANTED = [({"hirosco/a.cpp": "\n" * 501}, "501 lines"), ({"supervisor/supervisor.hpp": "\n" * 91}, "91 lines"),
           ({"hirosco/a.hpp": "class Big final : Base {\n" + "  int a;\n" * 301 + "};\n"}, "Big has 30"),
           ({"hirosco/a/a.hpp": '#include "hirosco/b/b.hpp"\n', "hirosco/b/b.hpp": '#include "hirosco/c/c.hpp"\n',
             "hirosco/c/c.hpp": '#include "hirosco/a/a.hpp"\n'}, "hirosco/a -> hirosco/b -> hirosco/c -> hirosco/a")]
missed = [f"planted and not seen: {wanted}" for texts, wanted in PLANTED if not any(wanted in found for found in problems(texts))]
ours = dict(files())
sys.exit("\n".join(problems(ours) + missed) or ("no files" if not ours else None))
