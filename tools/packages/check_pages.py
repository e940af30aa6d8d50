#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""check_pages.py PREFIX: whoever has installed HIROSCO and not its sources is sent to nothing that is not there. In the guides, the lists of codes,
the interfaces and the README below PREFIX/share/doc/hirosco, and in the templates, each path of the repository and each command of it is
installed, or its paragraph, row or block (or, for all of it, the page: PAGE below) says "in the repository"; and each link leads to a page."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
path = re.compile(r"(?<![\w./@-])((?:bench|build|cmake|docs|ground|hirosco|missions|robotics|simulation|subsystems|supervisor|templates|tests|tools)/[\w./-]*[\w/])|(?<![\w.])(\./(?:run|check))\b")
link = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")
code = re.compile(r"^```.*?^```$|`[^`\n]*`", re.M | re.S)
EXCUSE = "in the repository"
PAGE = "named here as they lie in the repository"
SOURCES = re.compile(r"(?:adr|safety)/|(?:decisions|dependencies|performance|CHANGELOG)\.md$")


def parts(text):
    """Paragraphs, rows of tables and blocks with the line before them, each with the number of its first line."""
    kept, begin, fenced = [], 1, False
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            fenced = not fenced
        ends = not fenced and (not line.strip() or line.startswith(("|", "- ", "#")))
        if ends and kept and not (not line.strip() and kept[-1].endswith(":")):
            yield begin, "\n".join(kept)
            kept = []
        if not kept:
            begin = number
        if line.strip():
            kept.append(line)
    if kept:
        yield begin, "\n".join(kept)


def dead(text, there):
    """Yields line and words of what one installed has not, and is not told so."""
    text = re.sub(r"(?m)^<!--.*?-->$", "", text)
    if PAGE in text:
        return
    for number, part in parts(text):
        if EXCUSE not in part.lower():
            yield from ((number, name or command) for name, command in path.findall(part) if command or not there(name))


def self_test():
    there = {"hirosco/a.hpp"}.__contains__
    for good in ("`hirosco/a.hpp`", "`tests/a.py` (in the repository)", "In the repository:\n\n```\ntools/x\n```", "/usr/hirosco/b", "`@hirosco/b`", "8 log/a"):
        assert not list(dead(good, there)), good
    for bad in ("`tests/a.py`\n\nin the repository", "```\n./run\n```", "| tools/a |\n| in the repository |", "`hirosco/b.hpp`", "x\n" * 12 + "in the repository\n\n./check"):
        assert list(dead(bad, there)), bad


def main(prefix):
    doc = prefix / "share/doc/hirosco"
    # What the package of the documents takes besides.
    beside = [ROOT / line for line in (ROOT / "tools/packages/debian/hirosco-doc.docs").read_text().split()]
    as_installed = {**{(doc / file.relative_to(doc)): file for file in doc.rglob("*.md")},
                    **{doc / file.relative_to(ROOT / "docs"): file for folder in beside for file in ([folder] if folder.is_file() else folder.rglob("*")) if file.is_file()}}
    places = {*as_installed, *(file.parent for file in as_installed)}

    def there(name):
        return any((prefix / base / name).exists() for base in ("include/hirosco", "share/hirosco")) or (
            name.startswith("docs/") and ((at := doc / name.removeprefix("docs/")) in places or at.exists() or any(str(each).startswith(f"{at}-") for each in places)))

    found = []
    for at, file in sorted(as_installed.items()):
        if file.suffix != ".md" or "examples" in at.relative_to(doc).parts:
            continue
        text, name = file.read_text(), str(at.relative_to(doc))
        if not SOURCES.match(name):
            found += [f"{name}:{line}: {what} is not installed; name where it is, or say '{EXCUSE}'" for line, what in dead(text, there)]
            found += [f"{name}: its link {target} leads nowhere" for target in link.findall(code.sub("", text))
                      if pathlib.Path(*_plain(at.parent / target)) not in places and not (at.parent / target).exists()]
    for file in sorted((prefix / "share/hirosco/templates").rglob("*")):
        if file.suffix in (".md", ".hpp", ".cpp", ".xml") and file.parent.name != "templates":
            found += [f"templates/{file.parent.name}/{file.name}:{line}: {what} is not installed" for line, what in dead(file.read_text(), there)
                      if not what.startswith("build")]
    return found


def _plain(where):
    kept = []
    for part in where.parts:
        if part == "..":
            kept.pop()
        else:
            kept.append(part)
    return kept


self_test()
sys.exit("\n".join(main(pathlib.Path(sys.argv[1]))) or None)
