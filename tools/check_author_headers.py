#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What is installed for authors is what an author includes (docs/adr/0187): the headers of hirosco/subsystem/author/, those that an example to copy
includes or that a guide names, and what these include; nothing of service loop and cycle is among them. Each header of ours that an example
includes or a guide names, and does not call the repository's, is installed. What a module and who loads it have to agree on has the framework's
object behind an author's class. Prints what breaks it, and breaks each rule once itself, to be caught."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = "cmake/HiroscoInstall.cmake"
AUTHOR = "hirosco/subsystem/author/"
ENGINE = ("hirosco/subsystem/service_loop/", "hirosco/subsystem/cycle/")
BEHIND = "hirosco/subsystem/service_loop/author_calls.cpp"  # what an author calls, by the framework's object
OURS = r"(?:hirosco|robotics|simulation)/[a-z0-9_/]+\.hpp"
INCLUDE = re.compile(rf'^[ \t]*#[ \t]*include[ \t]*[<"]({OURS})[>"]', re.M)
NAMED = re.compile(rf"`({OURS})`,?(?P<there>(?: and [^`]*)?\s+in the repository)?")
GUIDES = ("docs/guide/", "docs/installed/")


def copied():
    """Files and folders that are installed to be copied: templates and examples, wherever that is said."""
    for listed in (ROOT / LIST, *sorted(ROOT.glob("subsystems/*/CMakeLists.txt"))):
        top = "" if listed == ROOT / LIST else listed.parent.relative_to(ROOT).as_posix() + "/"
        for words in re.findall(r"install\((?:FILES|DIRECTORY) ([^)]*)\)", listed.read_text()):
            things, _, place = words.partition("DESTINATION")
            if "example" in place or things.strip() == "templates":
                yield from (top + thing for thing in things.split())


COPIED = tuple(copied())


def files():
    """All that the rules are about, by the path from the top."""
    patterns = [LIST, "docs/guide/*.md", "docs/installed/*.md", "hirosco/**/*.hpp", "robotics/**/*.hpp", "simulation/**/*.hpp", BEHIND]
    patterns += [name + ("/**/*" if (ROOT / name).is_dir() else "") for name in COPIED]
    found = {path for pattern in patterns for path in ROOT.glob(pattern) if path.suffix in (".cmake", ".hpp", ".cpp", ".md")}
    return {path.relative_to(ROOT).as_posix(): path.read_text() for path in sorted(found)}


def begun(texts, variable):
    """What a list of LIST begins with."""
    words = re.search(rf"^hirosco_headers_of\({variable}\s+([^)]*)\)", texts[LIST], re.M)[1].split()
    for word in words:
        if word == "${hirosco_author_folder_headers}":
            yield from (name for name in texts if re.fullmatch(AUTHOR + r"\w+\.hpp", name))
        elif word == "${HIROSCO_AUTHOR_HEADERS}":
            yield from begun(texts, "HIROSCO_AUTHOR_HEADERS")
        else:
            yield word


def closure(texts, first):
    """{header: who includes it} of these and all that they include."""
    found, left = {}, [(name, None) for name in first]
    while left:
        name, by = left.pop(0)
        if name not in found:
            found[name] = by
            left += [(to, name) for to in INCLUDE.findall(texts.get(name, ""))]
    return found


def installed(texts):
    return set(closure(texts, begun(texts, "HIROSCO_AUTHOR_HEADERS")))


def way(found, name):
    words = [name]
    while found[words[-1]]:
        words.append(found[words[-1]])
    return " <- ".join(words)


def wanted(texts):
    """{header: who shows it to an author}."""
    shown = {}
    for name, text in texts.items():
        if name.startswith(COPIED) and name.endswith((".hpp", ".cpp")):
            shown |= {to: name for to in INCLUDE.findall(text)}
        elif name.startswith(GUIDES):
            shown |= {named[1]: name for named in NAMED.finditer(text) if not named["there"]}
    return shown


def wrong(texts):
    first = set(begun(texts, "HIROSCO_AUTHOR_HEADERS"))
    found, shown = closure(texts, sorted(first)), wanted(texts)
    yield from (f"{way(found, name)}: of service loop or cycle, and would be installed" for name in found if name.startswith(ENGINE))
    yield from (f"{name}: is to be installed and is not there" for name in found if name not in texts)
    yield from (f"{LIST}: {name} is installed, and neither an example includes it nor a guide names it"
                for name in sorted(first) if not name.startswith(AUTHOR) and name not in shown)
    yield from (f"{by}: {name} is not installed" for name, by in shown.items() if name not in found)
    agreed = closure(texts, begun(texts, "HIROSCO_INTERFACE_HEADERS"))
    yield from (f"{LIST}: a module has {to} in common with who loads it, and HIROSCO_INTERFACE_HEADERS has it not"
                for to in INCLUDE.findall(texts[BEHIND]) if to not in agreed)


def planted(texts):
    """What each rule is for, once."""
    guide = "docs/guide/writing_a_subsystem.md"
    rig = "hirosco/subsystem/testing/rig.hpp"
    lists = texts[LIST]
    return {
        "an author's header that includes the service loop": texts | {rig: texts[rig] + '#include "hirosco/subsystem/service_loop/reports.hpp"\n'},
        "a header that nobody shows": texts | {LIST: lists.replace(f" {rig}", f" {rig} hirosco/xml/reader.hpp")},
        "a header that is not there": texts | {LIST: lists.replace("rig.hpp", "no_rig.hpp")},
        "a guide's header that is not installed": texts | {guide: texts[guide] + "By `hirosco/xml/reader.hpp`.\n"},
        "an example's header that is not installed": texts | {"templates/subsystem/newpart.cpp": "#include <hirosco/xml/reader.hpp>\n"},
        "a module that agrees on less": texts | {LIST: lists.replace("${HIROSCO_AUTHOR_HEADERS} hirosco/subsystem/service_loop/generic_subsystem.hpp",
                                                                     "${HIROSCO_AUTHOR_HEADERS}")},
    }


def main():
    texts = files()
    said = list(wrong(texts))
    missed = [f"planted and not seen: {what}" for what, broken in planted(texts).items() if broken == texts or len(list(wrong(broken))) <= len(said)]
    sys.exit("\n".join(said + missed) or None)


if __name__ == "__main__":
    main()
