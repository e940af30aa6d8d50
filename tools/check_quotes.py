#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A code block that follows `<!-- quote: PATH -->` in a Markdown file must be PATH or a contiguous part of it; and what
the documents name in backquotes as a file or folder of the project must exist; in a README also what it names by a part of its
path. Where a link of a document leads, there must be a file or folder. Everywhere in the repository each decision, page of docs/adr and hazard that is cited must exist,
and nothing cites a paragraph of the notes from which the project was designed: nobody else has those. What comments and documents name as
Class::member must be one where that class is of the repository. Each page of docs/adr has a status; one that says "Changes NNNN" is named there by
"changed by" of that page, and the other way round. In the guides that build something
from files to copy (WHOLE) each block with a language is such a quote: what a reader copies is what tests build and simulate."""
import pathlib
import posixpath
import re
import subprocess
import sys

quote = re.compile(r"^<!-- quote: (\S+) -->\n+```[^\n]*\n(.*?)^```$", re.M | re.S)
named = re.compile(r"`((?:bench|cmake|docs|ground|hirosco|missions|simulation|subsystems|supervisor|tests|tools)/[\w./-]*)`")
part = re.compile(r"`((?![A-Z]+_)[\w./-]*\w\.(?:hpp|cpp|py|m?js|xml|csv))`")
cited = re.compile(r"\b(adr[ /]|decisions? |SF|findings? |LW(?=\d))(\d+)", re.I)
notes = re.compile(r"\b(?:pus-c|tailoring|reliability|architecture|mission row) [A-Z]?\d[\d.]*", re.I)
mark = re.compile(r"^<!-- quote:", re.M)
code = re.compile(r"^(```+)[^\n]*\n.*?^\1|`[^`\n]*`", re.M | re.S)
WHOLE = ("docs/guide/your_mission.md", "docs/guide/your_project.md")
fenced = re.compile(r"(?m)^(<!-- .* -->\n+)?```(\w*)\n(?:.*\n)*?```$")
link = re.compile(r"\]\(<?([^)\s>]+)|^\[[^\]]+\]: +(\S+)", re.M)


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


def unquoted(text):
    """Yields blocks with a language that are no quotes."""
    for before, language in fenced.findall(text):
        if language and not before.startswith("<!-- quote: "):
            yield f"has a block of {language} that is no quote of a file"


def dead(folder, text, exists):
    """Yields the links to nothing of a Markdown text in `folder`; those to other places, or within the page, are not looked at."""
    for inline, reference in link.findall(code.sub("", text)):
        to = (inline or reference).partition("#")[0]
        if to and not re.match(r"[a-z][a-z0-9+.-]*:|/", to) and not exists(posixpath.normpath(f"{folder}/{to}")):
            yield f"links to {to}, which does not exist"


def lost(folder, text, files):
    """Yields what a README names by its name or the end of its path, and neither its folder nor another place has."""
    for path in part.findall(text):
        if posixpath.normpath(f"{folder}/{path}") not in files and not any(f"/{file}".endswith(f"/{path}") for file in files):
            yield f"names {path}, which does not exist"


def undefined(text, known):
    """Yields what is cited and stands nowhere; `known` has a set of numbers for each kind."""
    for kind, number in cited.findall(text):
        kind = kind.strip(" /").rstrip("s").lower()
        if int(number) not in known.get(kind, set()):
            yield f"cites {kind} {number}, which does not exist"
    yield from (f"cites '{note}' of notes that are not in the repository" for note in notes.findall(text))


CLASS = re.compile(r"\b(?:class|struct|enum class|enum|union)\s+(?:\[\[\w+\]\]\s*)?(\w+)(?:<[^>{;]*>)?\s*(?:final)?\s*(:[^{;]*)?\{")
ALIAS = re.compile(r"\busing (\w+) = ([^;]+);")
PARAMETER = re.compile(r"\b(?:class|typename) (\w+)(?=[,>])")
MEMBER = re.compile(r"(?<![\w:])([A-Z]\w*)::(~?\w+)")
comment = re.compile(r"//[^\n]*")


def classes(sources):
    """The words between the braces of each class of C++ texts, with those of its bases and of what it is another name for; those of one name are one.
    Names that are a template's parameter or another one of the standard library's, too, are left out: theirs may be any members."""
    own, others, any_class = {}, {}, set()
    for text in sources:
        text = comment.sub("", text)
        any_class.update(PARAMETER.findall(text))
        for name, whole in ALIAS.findall(text):
            any_class.update([name] if "std::" in whole else [])
            own.setdefault(name, set())
            others.setdefault(name, set()).update(re.findall(r"\w+", whole))
        for begin in CLASS.finditer(text):
            depth, end = 1, begin.end()
            while depth and end < len(text):
                depth += {"{": 1, "}": -1}.get(text[end], 0)
                end += 1
            own.setdefault(begin[1], set()).update(re.findall(r"\w+", text[begin.end():end]))
            others.setdefault(begin[1], set()).update(re.findall(r"\w+", begin[2] or ""))

    def all_words(name, seen):
        seen.add(name)
        return own[name].union(*(all_words(other, seen) for other in others.get(name, ()) if other in own and other not in seen))
    return {name: all_words(name, set()) for name in own if name not in any_class}


def memberless(prose, has):
    """Yields what a text cites as a member of a class that has none of that name; `has` is of classes()."""
    yield from (f"cites {name}::{member}, which {name} does not have" for name, member in MEMBER.findall(prose)
                if name in has and member.lstrip("~") not in has[name] | {name})


def statuses(pages):
    """Yields what is wrong with the statuses of docs/adr; `pages` has the text of each by its number, four digits."""
    changes = {number: set() for number in pages}
    changed_by = {number: set() for number in pages}
    for number, text in pages.items():
        status = re.search(r"^# .*\n\n(Status: (?:accepted|superseded)[;.].*\n(?:.+\n)*)", re.sub(r"\]\([^)]*\)", "]", text) + "\n", re.M)
        if not status:
            yield f"{number} has no line 'Status: accepted.' below its heading"
            continue
        words = re.sub(r"\([^)]*\)", "", status[1])
        for which, told in ((changes, r"\bChanges ([^.]*)"), (changed_by, r"; changed by ([^.]*)")):
            which[number].update(other for part in re.findall(told, words) for other in re.findall(r"\b\d{4}\b", part))
    for number in sorted(pages):
        yield from (f"{number} says that it changes {other}, whose status lacks 'changed by {number}'"
                    for other in sorted(changes[number]) if number not in changed_by.get(other, ()))
        yield from (f"{number} says that {other} changed it, which does not say 'Changes {number}'"
                    for other in sorted(changed_by[number]) if number not in changes.get(other, ()))


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
    assert not list(unquoted(fence.format("a.cpp", "one\n") + "\n<!-- typed -->\n```\nls\n```\n\n```\nls\n```\n"))
    for fault in ("```xml\n<A/>\n```\n", "<!-- typed -->\n```bash\nls\n```\n", "```\nls\n```\n```xml\n<A/>\n```\n"):
        assert list(unquoted(fault)), fault
    there = {"docs/a.md", "tools", "a.md"}.__contains__
    assert not list(dead("docs", "[a](a.md) [a](a.md#of-it) [b](#b) [t](../tools/) ![a](<../a.md>) [w](https://b.md)\n[r]: a.md\n", there))
    assert not list(dead("docs", "`[a](b.md)`\n```\nf[0](b)\n```\n", there)) and not list(dead(".", "[a](a.md 'A')", there))
    for fault in ("[a](b.md)", "[a](b.md#a)", "[a](a.md)[b](../docs/b.md)", "![a](tools/a.png)", "[r]: b.md\n"):
        assert list(dead("docs", fault, there)), fault
    assert list(lost("ground", "`model/b.hpp`", {"ground/model/a.hpp"})) and list(lost("ground", "`b.hpp`", {"ground/ab.hpp"}))
    assert not list(lost("ground", "`model/a.hpp` `a.hpp` `NAME_test.py` `STDERR`", {"ground/model/a.hpp"}))
    known = {"adr": {7}, "decision": {3}, "sf": {1}}
    assert not list(undefined("adr 0007, docs/adr/0007-one.md, Decision 3, decisions 3 and 4, hazard SF1", known))
    for fault in ("adr 0008", "docs/adr/0008-one.md", "decision 4", "(hazard SF2)", "findings SF1, finding 3", "LW1"):
        assert list(undefined(fault, known)), fault
    assert not list(undefined("(architecture, rule 3), ECSS-E-ST-70-41C 8.1.2, PUS-C clients", known))
    for fault in ("(pus-c tailoring 5.3)", "pus-c 9.7", "reliability 5.1", "architecture 4", "mission row B1"):
        assert list(undefined(fault, known)), fault
    has = classes(["struct A : B<C> {\n  int a;  // b\n};\nclass B { void c(); };", "using D = A; using G = std::a;\ntemplate <class E> f();\nstruct E { int a; };"])
    assert not list(memberless("A::a, A::c(), D::c, A::A, std::b, E::z, F::z, G::z, x::A::z", has))
    for fault in ("A::b", "`B::a()`", "D::z"):
        assert list(memberless(fault, has)), fault
    page = "# {} A\n\nStatus: accepted{}\n\n## Context\nChanges 0009.\n".format
    newer, older = page(2, ". Changes 0001 (as of\n0003), and decision 7. New."), page(1, "; changed by [0002](0002-a.md).")
    assert not list(statuses({"0001": older, "0002": newer}))
    for wrong_page in (page(1, "."), page(1, "; changed by 0003."), older.replace("Status", "State"), older.replace("\n\nS", "\n\nA\n\nS")):
        assert list(statuses({"0001": wrong_page, "0002": newer})), wrong_page
    assert list(statuses({"0001": older, "0002": page(2, ".")}))


self_test()
root = pathlib.Path(__file__).resolve().parent.parent
names = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True).stdout.split()
documents = [root / name for name in names] or [file for file in root.rglob("*.md") if "build" not in file.parts]


def read(path):
    file = root / path
    return file.read_text() if file.is_file() else None


def exists(path):
    return (root / path).exists() or any(root.glob(path + "-*.md")) or any(root.glob(path + ".*pp"))


def numbers(pattern, text):
    return {int(number) for row in re.findall(pattern, text, re.M) for number in re.findall(r"\d+", row)}


files = set(subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True).stdout.split()) or {
    str(file.relative_to(root)) for file in root.rglob("*") if "build" not in file.parts}
known = {"adr": numbers(r"^docs/adr/(\d{4})", "\n".join(files)), "decision": numbers(r"^\| ([\d, ]+) \|", read("docs/decisions.md")),
         "sf": numbers(r"^SF(\d+),", read("docs/safety/hazards.csv"))}
index = {int(number) for number in re.findall(r"^\| \[(\d{4})\]", read("docs/adr/README.md"), re.M)}
found = [f"docs/adr/README.md has no row of {number:04}" for number in sorted(known["adr"] - index)]
found += [f"docs/adr: {what}" for what in statuses(
    {pathlib.Path(name).name[:4]: read(name) for name in files if re.match(r"docs/adr/\d{4}-", name) and exists(name)})]
found += [f"{file.relative_to(root)}: {what}" for file in documents if file.is_file()
          for what in wrong(file.read_text(), read, exists)]
found += [f"{name}: {what}" for name in WHOLE for what in unquoted(read(name) or "```lost\n```")]
# Of the packages the pages of docs/ stand in one folder with docs/installed/README.md.
found += [f"{file.relative_to(root)}: {what}" for file in documents if file.is_file()
          for what in dead(str(file.relative_to(root).parent).replace("docs/installed", "docs"), file.read_text(), lambda path: (root / path).exists())]
for name in sorted(files):
    if name.endswith("README.md") and name != "docs/adr/README.md":
        found += [f"{name}: {what}" for what in lost(str(pathlib.Path(name).parent), read(name) or "", files)]
    if name.endswith((".md", ".hpp", ".cpp", ".py", ".xml", ".js", ".mjs", ".csv")) and name != "tools/check_quotes.py":
        found += [f"{name}: {what}" for what in undefined(read(name) or "", known)]
sources = {name: read(name) or "" for name in sorted(files) if name.endswith((".hpp", ".cpp"))}
has = classes(sources.values())
found += [f"{name}: {what}" for name, text in sources.items() for what in memberless("\n".join(comment.findall(text)), has)]
found += [f"{name}: {what}" for name in sorted(files) if name.endswith(".md") and not name.startswith("docs/adr/")
          for what in memberless("\n".join(each[0] for each in code.finditer(read(name) or "") if not each[1]), has)]
sys.exit("\n".join(found) or None)
