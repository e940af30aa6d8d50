#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each folder of subsystems/ says what it is for: a README.md with its purpose, what it does in which state, hazards and limits, and an
INTERFACE.md that is what its descriptors say, no more and no less: parameters, functions, events, configurations. What a README lists of
these beside it exists. Each folder hirosco/pus/st*/ has a README.md with one row for each message of its service in docs/services.md, which a
test holds to the code, and a test that exists in each. The failure codes that a subsystem sends are, in docs/interfaces/packets.md, those of docs/failure-codes.md, which
a test holds to the code. Prints what lacks, and takes it away from copies itself, to be caught. `--write` makes the pages and that table.

What a parameter or event is stands in front of it in the descriptor, as a comment; what a function does, in its <Description>."""
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as xml

from check_hazards import known_tests

ROOT = pathlib.Path(__file__).resolve().parent.parent
HOME = ROOT / "subsystems"
WANTED = {  # a paragraph that begins so, or a table with such a head
    "its purpose": r"^\*\*Purpose",
    "what it does in which state": r"^\| [Ss]tate \|",
    "hazards and what stops them": r"^\*\*Hazards",
    "its limits": r"^\*\*Limits",
    "where its interface stands": r"\]\(INTERFACE\.md\)",
}
LICENCE = "".join(f"<!-- {'SPDX'}-{line} -->\n" for line in ("FileCopyrightText: 2026 The HIROSCO developers", "License-Identifier: Apache-2.0"))
GROUPS = {"Parameters", "EventService", "FunctionService"}


def read(path):
    return xml.fromstring(path.read_text(), xml.XMLParser(target=xml.TreeBuilder(insert_comments=True)))


def descriptors(folder):
    """Of this folder's subsystems, those that only tests know left out."""
    for path in sorted(folder.rglob("*.xml")):
        if not {"testdata", "tests"} & set(path.relative_to(folder).parts) and read(path).tag == "Subsystem":
            yield path


def words(text):
    return re.sub(r"\s+", " ", text or "").strip().replace("|", "\\|").replace("<", "&lt;")


def told(parent):
    """Each element below a node and the groups in it, with the comment right in front of it."""
    comment = ""
    for node in parent:
        if node.tag is xml.Comment:
            comment = words(node.text)
            continue
        if node.tag in GROUPS:
            yield from told(node)
        else:
            yield node, comment
        comment = ""


def form(node):
    """"DOUBLE[3]", "TEXT, 32 octets"."""
    if node.tag == "StructRef":
        return "structure" + (f"[{node.get('count')}]" if node.get("count") else "")
    text = node.get("type", "") + (f"[{node.get('count')}]" if node.get("count") else "")
    text += f", {node.get('octets')} octets" if node.get("octets") else ""
    return text + (f", {node.get('enumeration')}" if node.get("enumeration") else "")


def span(node):
    if node.get("minimum") is None and node.get("maximum") is None:
        return ""
    return f"{node.get('minimum', '')} to {node.get('maximum', '')}"


def parameters(root):
    def rows(node, comment, inside):
        name = inside + node.get("name")
        if node.tag == "StructRef" and not len(node):
            return  # the framework's, named for its id
        yield [name, node.get("id", ""), form(node), node.get("unit", ""), span(node), node.get("init", ""),
               node.get("writable") or ("never: a protection" if node.get("protection") == "yes" else ""), comment]
        for child, about in told(node):
            yield from rows(child, about, name + ".")
    for node, comment in told(root):
        if node.tag in ("ParamRef", "StructRef"):
            yield from rows(node, comment, "")


def arguments(node):
    return "; ".join(" ".join(filter(None, [one.get("name"), form(one) if one.get("type") else f"of {one.get('of')}", one.get("unit"), span(one)]))
                     for one in node if one.tag == "Argument")


def everywhere(root):
    """What stands below the subsystem and in its configurations, with the configuration it is of."""
    for node, comment in told(root):
        yield node, comment, ""
        if node.tag == "Configuration":
            for inner, about in told(node):
                yield inner, about, node.get("name")


def functions(root):
    for node, comment, configuration in everywhere(root):
        if node.tag == "Function":
            yield [node.get("name"), "8,1", node.get("states", "as ST[08]"), arguments(node), node.get("sets", ""), words(node.findtext("Description")) or comment, configuration]
        if node.tag == "CustomService":
            for request in node:
                if request.tag == "Request":
                    yield [request.get("name"), f"{node.get('type')},{request.get('subtype')}", request.get("states", ""), arguments(request),
                           request.get("sets", ""), words(request.findtext("Description")) or comment, configuration]


def events(root):
    for node, comment, configuration in everywhere(root):
        if node.tag == "Event" and node.get("id"):
            safety = ", on for safety" if node.get("safety") == "yes" else ""
            yield [node.get("name"), node.get("id"), node.get("severity") + safety, arguments(node), comment, configuration]


def configurations(root):
    for node, comment in told(root):
        if node.tag != "Configuration":
            continue
        links = [f"{kind} {one.get('name')}" for kind in ("Provides", "Requires") for one in node.iter(kind)]
        devices = [one.get("name") for one in node if one.tag == "Device"]
        yield [node.get("name"), node.get("id"), node.get("sampling_us", ""), node.get("priority", ""), node.get("power_W", ""),
               ", ".join(devices), ", ".join(links), comment]


def failures(root):
    for node, comment in told(root):
        if node.tag == "Failure":
            yield [node.get("name"), node.get("code"), comment]


TABLES = [("Parameters", ["parameter", "id", "type", "unit", "range", "begins as", "writable in", "what"], parameters),
          ("Functions and requests", ["name", "service", "states", "arguments", "sets besides", "what", "configuration"], functions),
          ("Events", ["event", "id", "severity", "arguments", "what", "configuration"], events),
          ("Failure codes", ["name", "code", "what"], failures),
          ("Configurations", ["configuration", "id", "period / us", "priority", "power / W", "devices", "links", "what"], configurations)]


def table(head, rows):
    """Without columns in which nothing stands."""
    kept = [i for i, title in enumerate(head) if i == 0 or any(row[i] for row in rows)]
    lines = [[head[i] for i in kept], ["---"] * len(kept), *([row[i] or "" for i in kept] for row in rows)]
    return "".join("| " + " | ".join(line).replace("|  |", "| |").replace("|  |", "| |").rstrip() + " |\n" for line in lines)


def page(folder):
    text = LICENCE + f"# Interface of {folder.name}\n\nMade from its descriptor by `tools/check_interfaces.py --write`. Beside it every subsystem has what " \
        "the framework gives to all (`docs/guide/writing_a_subsystem.md`).\n"
    for path in descriptors(folder):
        root = read(path)
        text += f"\n## {root.get('name')}, APID {root.get('id')}: `{path.relative_to(folder).as_posix()}`\n\n{words(root.findtext('Description'))}\n"
        for title, head, rows_of in TABLES:
            if rows := list(rows_of(root)):
                text += f"\n**{title}**\n\n" + table(head, rows)
    return text


def names_in(folder):
    """Every name that its descriptors give to something, and those that the framework gives."""
    found = {"SET_STATE", "CONFIGURE", "PING", "SELF_TEST", "SET"}
    for path in descriptors(folder):
        found |= {part for node in read(path).iter() for part in re.split(r"[.\[\]0-9]+$|\.", node.get("name", "")) if part}
    return found


def unknown(folder, readme):
    """What a README has in the first column of a table of parameters, functions or requests, and no descriptor has."""
    known, listing = names_in(folder), False
    for line in readme.splitlines():
        if not line.startswith("|"):
            listing = False
        elif re.match(r"^\| (parameter|function|request)\b", line):
            listing = True
        elif listing:
            yield from (name for name in re.findall(r"\b[A-Z][A-Z0-9_]+\b", line.split("|")[1]) if name not in known)


def problems(home):
    for folder in sorted(path for path in home.iterdir() if path.is_dir()):
        readme, interface = folder / "README.md", folder / "INTERFACE.md"
        if not readme.exists():
            yield f"{folder.name}: there is no README.md"
            continue
        text = readme.read_text()
        yield from (f"{folder.name}/README.md does not say {what} ({pattern})" for what, pattern in WANTED.items() if not re.search(pattern, text, re.M))
        yield from (f"{folder.name}/README.md lists {name}, which no descriptor has" for name in unknown(folder, text))
        if not list(descriptors(folder)):
            yield f"{folder.name}: there is no descriptor"
        elif not interface.exists() or interface.read_text() != page(folder):
            yield f"{folder.name}/INTERFACE.md is not what the descriptor says: tools/check_interfaces.py --write"


def self_test():
    """Each thing that it is for is missed in a copy that lacks it."""
    readme = "**Purpose.** A.\n\n| State | What it does |\n|---|---|\n\n**Hazards**: none.\n\n**Limits**: none. [page](INTERFACE.md)\n"
    descriptor = '<Subsystem name="S" id="9"><Parameters><!-- what it is --><ParamRef name="P" id="1" type="FLOAT" unit="K"/></Parameters>' \
        '<Configuration name="C" id="1" sampling_us="1000"><FunctionService><Function name="F"><Argument name="A" type="UINT8" minimum="0" maximum="1"/>' \
        '</Function></FunctionService></Configuration></Subsystem>'
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        folder = home / "s"
        folder.mkdir()
        (folder / "s.xml").write_text(descriptor)
        (folder / "README.md").write_text(readme)
        (folder / "INTERFACE.md").write_text(page(folder))
        assert not list(problems(home)), list(problems(home))
        assert "| P | 1 | FLOAT | K | what it is |" in page(folder) and "| F | 8,1 | as ST[08] | A UINT8 0 to 1 | C |" in page(folder), page(folder)
        for line in readme.splitlines():
            if line and not line.startswith("|--"):
                (folder / "README.md").write_text(readme.replace(line, ""))
                assert list(problems(home)), line
        (folder / "README.md").write_text(readme + "\n| parameter | what |\n|---|---|\n| P | is |\n")
        assert not list(problems(home))
        (folder / "README.md").write_text(readme + "\n| parameter | what |\n|---|---|\n| P (GONE) | was |\n")
        assert list(problems(home)) == ["s/README.md lists GONE, which no descriptor has"], list(problems(home))
        (folder / "README.md").write_text(readme)
        for old, new in (('name="P"', 'name="Q"'), ('maximum="1"', 'maximum="2"'), ('name="F"', 'name="G"'), ("what it is", "what it was")):
            (folder / "s.xml").write_text(descriptor.replace(old, new))
            assert list(problems(home)), new
        for lacking in ("s.xml", "README.md", "INTERFACE.md"):
            (folder / "s.xml").write_text(descriptor)
            (folder / "README.md").write_text(readme)
            (folder / "INTERFACE.md").write_text(page(folder))
            (folder / lacking).unlink()
            assert list(problems(home)), lacking


def messages(services):
    """Of each type of docs/services.md its messages, as the tables of clauses call them."""
    for number, requests, reports in re.findall(r"^\| ST\[(\d+)\][^|]* \| ([^|]+) \| ([^|]+) \|", services, re.M):
        yield int(number), [f"{way}[{number},{one.partition(' ')[0]}] {one.partition(' ')[2]}" for way, all_of_them in (("TC", requests), ("TM", reports))
                            for one in all_of_them.split(", ") if one != "none"]


def unproven(home, services, tests):
    """What a table of clauses lacks of its service, has too much, or proves by a test that is not there."""
    declared = dict(messages(services))
    folders = {int(re.match(r"st(\d+)", path.name)[1]): path for path in home.glob("st[0-9]*") if path.is_dir()}
    yield from (f"hirosco/pus: no folder of ST[{number}]" for number in sorted(set(declared) - set(folders)))
    for number, folder in sorted(folders.items()):
        readme = folder / "README.md"
        if not readme.exists():
            yield f"hirosco/pus/{folder.name}: there is no README.md"
            continue
        rows = [re.split(r"(?<!\\) \| ", line.strip("| ")) for line in readme.read_text().splitlines() if re.match(r"\| T[CM]\[", line)]
        told = [row[0] for row in rows]
        page = f"hirosco/pus/{folder.name}/README.md"
        yield from (f"{page} has no row of {name}" for name in declared.get(number, []) if name not in told)
        yield from (f"{page} has a row of {name}, which is not in docs/services.md" for name in told if name not in declared.get(number, []))
        yield from (f"{page} has several rows of {name}" for name in sorted(set(told)) if told.count(name) > 1)
        for row in rows:
            proofs = re.findall(r"`(\w+\.\w+)`", row[4]) if len(row) == 5 else []
            if not proofs:
                yield f"{page}: {row[0]} has no proof, or not five columns"
            yield from (f"{page}: {row[0]} is proven by {name}, which is no test" for name in proofs if name not in tests)


def clauses_self_test():
    services = "| ST[9] nine | 1 ASK | 2 TOLD | everybody |\n"
    readme = "| TC[9,1] ASK | - | c | a | `Nine.Asks` |\n| TM[9,2] TOLD | - | - | b | `Nine.Tells` |\n"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "st09_nine"
        folder.mkdir()
        page, tests = folder / "README.md", {"Nine.Asks", "Nine.Tells"}
        for planted, wanted in ((None, "no README.md"), (readme.splitlines()[0], "no row of TM[9,2] TOLD"), (readme.replace("Nine.Asks", "Nine.Gone"), "Nine.Gone, which is no test"),
                                (readme.replace("`", ""), "no proof"), (readme + readme, "several rows"), (readme + readme.replace("9,1", "9,3"), "[9,3] ASK, which is not")):
            if planted is not None:
                page.write_text(planted)
            found = list(unproven(folder.parent, services, tests))
            assert any(wanted in problem for problem in found), (wanted, found)
        page.write_text(readme)
        assert not list(unproven(folder.parent, services, tests)), list(unproven(folder.parent, services, tests))
        assert list(unproven(folder.parent, services + services.replace("9", "8"), tests)) == ["hirosco/pus: no folder of ST[8]"]


CODES, PACKETS = ROOT / "docs/failure-codes.md", ROOT / "docs/interfaces/packets.md"
MARK = "<!-- numbers: failure codes -->\n"
WHO = ("subsystem", "supervisor", "nobody yet")


def with_codes(packets, codes):
    """The page of packets with the codes that a subsystem sends. ValueError: a row of the codes does not say who does, or the page has no place."""
    rows = [re.split(r" \| ", line.strip("| ")) for line in codes.splitlines() if re.match(r"\| \d", line)]
    if unsaid := [row[0] for row in rows if len(row) != 5 or row[2] not in WHO]:
        raise ValueError(f"docs/failure-codes.md: who says {', '.join(unsaid)} is none of {', '.join(WHO)}, or it has not five columns")
    before, mark, behind = packets.partition(MARK)
    if not mark:
        raise ValueError(f"docs/interfaces/packets.md has no {MARK.strip()}")
    after = behind[re.match(r"(?:\|[^\n]*\n)*", behind).end():]
    return before + mark + table(("number", "name", "data"), [(row[0], row[1], row[3]) for row in rows if row[2] == WHO[0]]).rstrip("\n") + "\n" + after


def codes_self_test():
    codes = "| 1 | one | subsystem | none | Do. |\n| 0x0102 | two | supervisor | none | Do. |\n| 3 | three | nobody yet | none | Do. |\n"
    packets = f"before\n{MARK}| number | name | data |\n|---|---|---|\n| 9 | old | none |\n\nbehind\n"
    made = with_codes(packets, codes)
    assert made.startswith("before\n") and "| 1 | one | none |\n\nbehind\n" in made and "old" not in made and "two" not in made and "three" not in made, made
    assert with_codes(made, codes) == made and with_codes(made, codes.replace("supervisor", "subsystem")) != made
    for wrong in ((packets, codes.replace("supervisor", "somebody")), (packets, codes.replace(" | none | Do. |\n| 0x", " | Do. |\n| 0x")), ("nothing", codes)):
        try:
            with_codes(*wrong)
        except ValueError:
            continue
        raise AssertionError(wrong)


def wrong_codes(write):
    try:
        if write:
            PACKETS.write_text(with_codes(PACKETS.read_text(), CODES.read_text()))
        elif with_codes(PACKETS.read_text(), CODES.read_text()) != PACKETS.read_text():
            yield "docs/interfaces/packets.md: its failure codes are not those that docs/failure-codes.md says a subsystem sends: tools/check_interfaces.py --write"
    except ValueError as problem:
        yield str(problem)


def main():
    self_test()
    clauses_self_test()
    codes_self_test()
    if sys.argv[1:] == ["--write"]:
        for folder in sorted(path for path in HOME.iterdir() if path.is_dir()):
            (folder / "INTERFACE.md").write_text(page(folder))
    services = (ROOT / "docs/services.md").read_text()
    found = [*problems(HOME), *unproven(ROOT / "hirosco/pus", services, set(known_tests())), *wrong_codes(write=sys.argv[1:] == ["--write"])]
    for problem in found:
        print(problem)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
