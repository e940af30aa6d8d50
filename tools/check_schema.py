#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""docs/interfaces/schema.md is what the schemas of descriptors and missions say: of each element and attribute what it means, its unit, range and what it is
where it is left out. `--write` makes it. In the schemas each element and attribute has its words (xs:documentation), each number a unit (xs:appinfo; "-": it
has none; "its own": that of what it is a value of) and ends on both sides, each attribute that may be left out a `default` or the words "Left out:". An
attribute whose name ends with a unit has this one. Prints what lacks, and takes each away from a copy itself, to be caught."""
import pathlib
import re
import sys
import xml.etree.ElementTree as xml

import check_declared

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/interfaces/schema.md"
SCHEMAS = {"Mission": "hirosco/descriptor/mission.xsd", "Subsystem": "hirosco/descriptor/subsystem.xsd"}
XS = "{http://www.w3.org/2001/XMLSchema}"
ENDS = {"us": "us", "ms": "ms", "s": "s", "h": "h", "W": "W", "kB": "kB", "MB": "MB", "percent": "%"}
WHOLE = {"positiveInteger": (1, None), "nonNegativeInteger": (0, None), "integer": (None, None), "unsignedByte": (0, 255),
         "unsignedShort": (0, 65535), "unsignedInt": (0, 4294967295)}
REAL = {"double", "decimal"}
UNBOUNDED = {"its own", "-"}  # of what has its range elsewhere: a field, a parameter, an enumeration
LEFT_OUT = re.compile(r" ?Left out: (.*?)\.(?= |$)")
LICENCE = "".join(f"<!-- {'SPDX'}-{line} -->\n" for line in ("FileCopyrightText: 2026 The HIROSCO developers", "License-Identifier: Apache-2.0"))
HEAD = LICENCE + """# Elements and attributes of missions and descriptors

Files are named here as they lie in the repository. Made of the schemas by `tools/check_schema.py --write`. Editors complete and explain by the same files, in `/usr/share/hirosco/schemas` (`hirosco/descriptor/`): `xmllint --noout --schema
/usr/share/hirosco/schemas/mission.xsd mission.xml`. What only a reader can know (references, sums, sizes) is said by `hirosco check`, by [codes](../descriptor-errors.md). Units are SI or the one that a name ends with; limits with
*reduced* in their name hold without real-time scheduling. Records (`docs/adr/NNNN`) are in [adr](../adr/README.md).
"""


def tag(node):
    return node.tag.removeprefix(XS) if isinstance(node.tag, str) else ""


def said(node, what):
    return " ".join((node.findtext(f"{XS}annotation/{XS}{what}") or "").split())


class Schema:
    def __init__(self, text):
        self.root = xml.fromstring(text)
        self.named = {(tag(node), node.get("name")): node for node in self.root}

    def inside(self, node):
        """The parts of a type, those that it has from another one first."""
        for part in node:
            if tag(part) == "extension" and ("complexType", part.get("base")) in self.named:
                yield from self.inside(self.named["complexType", part.get("base")])
            if tag(part) in ("complexType", "complexContent", "simpleContent", "extension", "sequence", "choice", "all"):
                yield from self.inside(part)
            elif tag(part) in ("attributeGroup", "group"):
                yield from self.inside(self.named[tag(part), part.get("ref")])
            else:
                yield part

    def parts(self, element, kind):
        """Attributes or elements of an element."""
        found = {}
        for part in self.inside(self.named.get(("complexType", element.get("type")), element)):
            if tag(part) == kind:
                found.setdefault(part.get("name"), part)
        return list(found.values())

    def value(self, node):
        """Of an attribute: (words for people, whether it is a number, least, most)."""
        name = node.get("type") or ""
        kind = self.named.get(("simpleType", name)) if name else node.find(f"{XS}simpleType")
        if name.startswith("xs:"):
            return self.built_in(name.removeprefix("xs:"))
        if (many := kind.find(f"{XS}list")) is not None:
            item = xml.Element("item", type=many.get("itemType")) if many.get("itemType") else many
            words, is_number, least, most = self.value(item)
            return "list of " + words, is_number, least, most
        if (union := kind.find(f"{XS}union")) is not None:
            members = [self.value(xml.Element("item", type=one))[0] for one in union.get("memberTypes").split()]
            members += [", ".join(word.get("value") for word in one.iter(f"{XS}enumeration")) for one in union]
            return ", ".join(members), False, None, None
        restriction = kind.find(f"{XS}restriction")
        if words := [word.get("value") for word in restriction.iter(f"{XS}enumeration")]:
            return ", ".join(words), False, None, None
        text, is_number, least, most = self.built_in(restriction.get("base").removeprefix("xs:"))
        ends = {end: restriction.find(f"{XS}{end}Inclusive") for end in ("min", "max")}
        least = ends["min"].get("value") if ends["min"] is not None else least
        most = ends["max"].get("value") if ends["max"] is not None else most
        return (self.names(name) if text == "text" else text), is_number, least, most

    @staticmethod
    def built_in(name):
        if name in WHOLE:
            return "whole number", True, *WHOLE[name]
        return ("number", True, None, None) if name in REAL else ("text", False, None, None)

    @staticmethod
    def names(name):
        return {"Reference": "name, with its way", "Way": "name, with its way", "SetName": "SUBSYSTEM.SET", "SubsystemOrAll": "name or *"}.get(name, "name" if "Name" in name else "text")

    def elements(self):
        """Each declared element once, with the ways by which it is reached."""
        ways, order = {}, []

        def visit(node, way):
            if id(node) not in ways:
                ways[id(node)] = []
                order.append(node)
                deeper = True
            else:
                deeper = False
            ways[id(node)].append(way)
            if deeper:
                for child in self.parts(node, "element"):
                    visit(child, f"{way}/{child.get('name')}")

        for node in self.root:
            if tag(node) == "element":
                visit(node, node.get("name"))
        return [(node, ways[id(node)]) for node in order]


def lacking(schema):
    """What is not said in it."""
    for node, ways in schema.elements():
        if not said(node, "documentation"):
            yield f"<{ways[0]}> has no xs:documentation: say what it is"
        for one in schema.parts(node, "attribute"):
            where, words, unit = f"{ways[0]}@{one.get('name')}", said(one, "documentation"), said(one, "appinfo")
            _, is_number, least, most = schema.value(one)
            if not words:
                yield f"{where} has no xs:documentation: say what it means"
            if one.get("use") != "required" and one.get("default") is None and one.get("fixed") is None and not LEFT_OUT.search(words):
                yield f"{where} may be left out and does not say what it is then: default=\"...\", or \"Left out: ...\" in its documentation"
            if is_number and not unit:
                yield f"{where} is a number and has no unit: xs:appinfo, \"-\" where it has none"
            if not is_number and unit:
                yield f"{where} is no number and has the unit {unit}"
            if is_number and (least is None or most is None) and unit not in UNBOUNDED:
                yield f"{where} is a number without ends: minInclusive and maxInclusive"
            end = one.get("name").rpartition("_")[2]
            if "_" in one.get("name") and end in ENDS and unit != ENDS[end]:
                yield f"{where} is called for {ENDS[end]} and has the unit {unit or 'none'}"


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;")


def page(schemas):
    text = HEAD
    for schema in schemas:
        seen = set()
        for node, ways in schema.elements():
            if node.get("type") and ("complexType", node.get("type")) in schema.named:
                key = (node.get("name"), node.get("type"), said(node, "documentation"))
                if key in seen:
                    continue
                seen.add(key)
            level = "##" if "/" not in ways[0] else "###"
            text += f"\n{level} {ways[0]}\n\n{cell(said(node, 'documentation'))}\n"
            if more := [way for way in ways[1:] if way != ways[0]]:
                text += "\nAlso " + ", ".join(f"`{way}`" for way in more) + ".\n"
            if attributes := schema.parts(node, "attribute"):
                text += "\n| attribute | what | unit | range | left out |\n|---|---|---|---|---|\n"
                for one in attributes:
                    words, is_number, least, most = schema.value(one)
                    span = f"{least} to {most}" if is_number and least is not None and most is not None else ""
                    unit = said(one, "appinfo").replace("-", "")
                    told = said(one, "documentation")
                    without = LEFT_OUT.search(told)
                    otherwise = "needed" if one.get("use") == "required" else one.get("default") or one.get("fixed") or (without[1] if without else "")
                    told = LEFT_OUT.sub("", told)
                    text += f"| `{one.get('name')}` | {cell(told)} | {unit} | {cell(span or words)} | {cell(otherwise)} |\n".replace("|  |", "| |")
    return text


def read():
    return [check_declared.whole(ROOT / path, set()) for path in SCHEMAS.values()]


def problems(texts, written):
    schemas = [Schema(text) for text in texts]
    yield from (f"{path}: {what}" for path, schema in zip(SCHEMAS.values(), schemas) for what in lacking(schema))
    if written != page(schemas):
        yield f"{PAGE.relative_to(ROOT)} is not what the schemas say: tools/check_schema.py --write"


def self_test(texts):
    """Each thing that it is for is missed in a copy that lacks it."""
    mission, subsystem = texts
    interval = re.search(r'<xs:attribute name="interval".*?</xs:attribute>', subsystem)[0]
    words = re.search(r"<xs:documentation>.*?</xs:documentation>", interval)[0]
    planted = [("interval has no xs:documentation", interval.replace(words, "")), ("interval is a number and has no unit", interval.replace("<xs:appinfo>cycles</xs:appinfo>", "")),
               ("interval may be left out", interval.replace(' use="required"', "")), ("interval is a number without ends", interval.replace("IntervalCycles", "xs:positiveInteger")),
               ("interval_ms is called for ms and has the unit cycles", interval.replace('"interval"', '"interval_ms"')),
               ("interval is no number and has the unit", interval.replace("IntervalCycles", "xs:string")),
               ("colour has no xs:documentation", interval + '<xs:attribute name="colour" type="xs:string"/>'),
               ("schema.md is not what", interval.replace("Cycles of", "Turns of"))]
    written = page([Schema(text) for text in texts])
    for wanted, other in planted:
        assert other != interval, wanted
        found = list(problems([mission, subsystem.replace(interval, other)], written))
        assert any(wanted in what for what in found), (wanted, found)
    element = re.search(r'<xs:element name="Hang"><xs:annotation>.*?</xs:annotation>', subsystem)[0]
    assert any("<Subsystem/Hang> has no" in what for what in problems([mission, subsystem.replace(element, '<xs:element name="Hang">')], written))


if __name__ == "__main__":
    if "--write" in sys.argv:
        PAGE.write_text(page([Schema(text) for text in read()]))
    self_test(read())
    sys.exit("\n".join(problems(read(), PAGE.read_text() if PAGE.exists() else "")) or None)
