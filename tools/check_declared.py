#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Nothing is declared that is not in force: hirosco/descriptor/consumers/ has one row for each element, attribute and word of
the schemas, and what a row names is there; so are the folders and tests of docs/paper_map.md, and the readers
take nothing else. Prints what breaks that, and breaks it itself, to be caught.

A folder for each schema, in it a file for each part of a descriptor, as an author looks for it; `words.csv` has those of the named types.
`declared`: PARENT/ELEMENT, with @ATTRIBUTE, with =WORD; the words of a named type as TYPE=WORD, or all of them as TYPE=*; a group is a parent, too.
`honoured_by`: STRUCT::MEMBER or ENUMERATION::WORD of the model, and `in` the file that reads it, neither of hirosco/descriptor nor one that says what there is; an error
that hirosco/descriptor makes of it, where a refusal is all that it is for; or a name of the code that does it in any case. ENUMERATION::* is each word in its turn, `in` a file or the folder of
those that have one each. A member whose name other structures of the model bear, too, is read by one object of the file alone, or the row says by which: STRUCT::MEMBER of OBJECT. Of one that does it for
several attributes each row says its own part: FUNCTION>NAME, what that function of hirosco/descriptor, which the file calls, has to do with; TABLE[PLACE] of a
table that is read as a whole. Else the file names each of them: one that somebody stops reading is missed although the others are read."""
import csv, pathlib, re, sys
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "hirosco/descriptor"
MODEL = [FOLDER / "model" / f"{part}.hpp" for part in ("subsystem", "parameters", "resources", "service_list", "bumpless", "mission")]
MODEL += [ROOT / "hirosco/parameter/type.hpp", *(ROOT / "hirosco/data_transfer" / part for part in ("device/device_network.hpp", "device/data_flow.hpp", "link/link.hpp"))]
DECLARING = {str(path.relative_to(ROOT)) for path in MODEL}
COLUMNS = ["declared", "honoured_by", "in"]
XS = "{http://www.w3.org/2001/XMLSchema}"
PLAIN = {"YesNo"}  # its words are those of every language
NOT_BUILT_IN = {"read_only"}  # known to be refused in words
ASKED = re.compile(r'\b(?:optional|required|name|yes|numbers?|exact|watts|text|integer|(?:integer_or|required_integer|one_of|list_of)'
                   r'(?:<[\w:]+>)?|read_\w+|watchdog|limit)\((?:\w+, )*"(\w+)"|\{"([A-Z]\w*[a-z]\w*)",')


def tag(node):
    return node.tag.removeprefix(XS) if isinstance(node.tag, str) else ""


def whole(file, known):
    """The text of a schema with the parts that it includes in place, each once; a part that is not there is found out by who reads it."""
    text = file.read_text()

    def part(include):
        place = file.parent / include.group(1)
        if place in known:
            return ""
        known.add(place)
        return re.sub(r"^.*?<xs:schema[^>]*>|</xs:schema>\s*$", "", whole(place, known), flags=re.S)
    return re.sub(r'<xs:include schemaLocation="([^"]+)"/>', part, text)


def declared(schema):
    """What a schema lets somebody write, each once, in its order."""
    root = xml.fromstring(schema)
    named = {(tag(node), node.get("name")): node for node in root}
    found = {}

    def words(place, node):
        found.update({f"{place}={word.get('value')}": None for word in node.iter(XS + "enumeration")})

    def inside(node):
        """The parts of a type, those that it has from another one first."""
        for part in node:
            if tag(part) == "extension" and ("complexType", part.get("base")) in named:
                yield from inside(named["complexType", part.get("base")])
            if tag(part) in ("complexType", "complexContent", "simpleContent", "extension", "sequence", "choice", "all"):
                yield from inside(part)
            elif tag(part) == "attributeGroup":
                yield from inside(named["attributeGroup", part.get("ref")])
            else:
                yield part

    def elements(parent, node):
        for part in inside(node):
            if tag(part) == "group":
                elements(part.get("ref"), named["group", part.get("ref")])
            elif tag(part) == "element":
                element(f"{parent}/{part.get('name')}", part)

    def element(place, node):
        if place in found:
            return
        found[place] = None
        kind = named.get(("complexType", node.get("type")), node)
        for part in inside(kind):
            if tag(part) == "attribute":
                found[f"{place}@{part.get('name')}"] = None
                words(f"{place}@{part.get('name')}", part)
        elements(node.get("name"), kind)

    for (what, name), node in named.items():
        if what == "simpleType" and name not in PLAIN:
            words(name, node)
    for (what, name), node in named.items():
        if what == "element":
            element(name, node)
    return list(found)


def bare(code):
    """Without comments and texts."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', " ", code, flags=re.S)


def members(headers):
    """STRUCT::MEMBER and ENUMERATION::WORD, with what stands inside of others, and of which kind they are."""
    found = {}
    for text in headers:
        for begin in re.finditer(r"\b(struct|enum class) (\w+)[^;{]*\{", text):
            depth, at = 1, begin.end()
            while depth and at < len(text):
                depth += {"{": 1, "}": -1}.get(text[at], 0)
                at += 1
            names = re.findall(r"\b(\w+)\s*(?=[;{=,(}])", text[begin.end():at])
            found.update({f"{begin.group(2)}::{name}": begin.group(1) for name in names})
    return found


def bodies(texts):
    """What each function that begins a line says, by its name; several of one name together."""
    found = {}
    for text in texts:
        for begin in re.finditer(r"^(?!using|namespace|struct|class|enum)[\w\[][^;{}()=#]*?(?:(\w+)::)?(\w+)\([^;{}]*\)[^;{}()]*\{", text, re.M):
            depth, at = 1, begin.end()
            while depth and at < len(text):
                depth += {"{": 1, "}": -1}.get(text[at], 0)
                at += 1
            found[begin.group(2)] = found.get(begin.group(2), "") + text[begin.end():at]
    return found


def reached(function, functions, depth=3):
    """What it says and those that it calls, as far as they are of hirosco/descriptor."""
    names, newest = {function}, {function}
    for _ in range(depth):
        newest = {name for known in newest for name in re.findall(r"\b(\w+)\(", functions.get(known, "")) if name in functions} - names
        names |= newest
    return "".join(functions.get(name, "") for name in names)


def readers_of(member, code):
    """What stands before a member where a text reads it, calls and indices left out: names of objects, "" where it is not said."""
    found = set()
    for access in re.finditer(r"(?:\.|->|::)" + member + r"\b", code):
        left = code[:access.start()].rstrip()
        while left.endswith((")", "]")):
            depth, at = 0, len(left)
            while at and (depth or at == len(left)):
                at -= 1
                depth += {")": 1, "]": 1, "(": -1, "[": -1}.get(left[at], 0)
            left = left[:at].rstrip()
        name = re.search(r"\w+$", left)
        found.add(name.group() if name else "")
    return found


def read_by(whose, code):
    """Whether an object, as the code writes it, is asked for a member: (object, member)."""
    within = r"(?:\[[^\]]*\]|\([^()]*\))*"
    return re.search(r"(?<!\w)" + re.escape(whose[0]) + within + r"(?:\.|->|::)" + whose[1] + r"\b", code) is not None


def shared(rows, source):
    """Attributes that have a consumer in common, which does not name them: [(row, the others)]."""
    groups = {}
    for row in rows:
        if "@" in row["declared"] and "=" not in row["declared"] and all((row.get(column) or "").strip() for column in COLUMNS):
            groups.setdefault((row["schema"], row["honoured_by"], row["in"]), []).append(row)
    for (_, _, file), group in groups.items():
        names = {row["declared"].partition("@")[2] for row in group}
        code = re.sub(r"//[^\n]*|/\*.*?\*/", " ", source(file) or "", flags=re.S)
        for row in group if len(names) > 1 else []:
            name = row["declared"].partition("@")[2]
            if not re.search(rf"(?<![A-Za-z0-9]){name}(?![A-Za-z0-9])", code, re.I):
                yield row, sorted(names - {name})


def wrong(row, model, source, tests, functions):
    """What is not true of a row; `source` gives the text of a file, nothing when there is none."""
    if missing := [column for column in COLUMNS if not (row.get(column) or "").strip()]:
        return "says nothing in " + ", ".join(missing)
    by, _, owner = row["honoured_by"].partition(" of ")
    file = row["in"]
    text = source(file)
    if text is None or "_test." in file or "/testing/" in file or "tests/" in file:
        return f"{file} is no file of the product"
    if re.fullmatch(r"E\d{4}", by):
        if not file.startswith("hirosco/descriptor/") or f'"{by}"' not in text:
            return f"{file} makes no {by}"
        return None if f'"{by}"' in tests else f"no test of hirosco/descriptor sees {by}"
    if file in DECLARING or file.endswith("/") and not by.endswith("::*"):
        return f"{file} says what there is and honours nothing"
    code = bare(text)
    if part := re.fullmatch(r"(\w+)>([\w:]+)", by):
        function, name = part.group(1), part.group(2).split("::")[-1]
        if "::" in part.group(2) and part.group(2) not in model:
            return f"the model has no {part.group(2)}"
        if not re.search(rf"(?<!\w){function}\(", code):
            return f"{file} does not call {function}"
        before = r"(?:\.|->|::)" if "::" in part.group(2) else r"(?<!\w)"
        return None if re.search(before + name + r"\b", reached(function, functions)) else f"{function} has nothing to do with {part.group(2)}"
    if place := re.fullmatch(r"([\w:]+)\[([\w:]+)\]", by):
        by = place.group(1)
        if place.group(2) not in model:
            return f"the model has no {place.group(2)}"
    last = by.split("::")[-1]
    if last == "*":
        return None if by.removesuffix("*") in {name.removesuffix(name.split("::")[1]) for name in model} else f"the model has no {by}"
    structure = "::".join(by.split("::")[-2:])
    kind = model.get(structure)
    if owner and kind != "struct":
        return f"{by} is no member of the model"
    if "::" in by and kind is not None:
        if file.startswith("hirosco/descriptor/"):
            return f"{by} is to be read outside hirosco/descriptor"
        if owner:
            return None if read_by((owner, last), code) else f"{file} does not read {by} of {owner}"
        others = [name for name, what in model.items() if what == "struct" and name.endswith(f"::{last}") and name != structure]
        if kind == "struct" and others and len(objects := readers_of(last, code)) > 1:
            return f"{file} reads {last} of {', '.join(sorted(objects))}, and {', '.join(others[:3])} has one, too: say '{by} of' which"
        if kind == "struct":
            return None if re.search(r"(?:\.|->|::)" + last + r"\b", code) else f"{file} does not read {by}"
        within = r"(?<![\w.])" if f"using enum {by.rpartition('::')[0].split('::')[-1]}" in code else rf"\b{by.split('::')[-2]}::"
        return None if re.search(within + last + r"\b", code) else f"{file} does not read {by}"
    if by[0].isupper() and "::" in by and by.split("::")[0] in {name.split("::")[0] for name in model}:
        return f"the model has no {by}"
    return None if re.search(r"(?<!\w)" + re.escape(by) + r"\b", code) else f"{file} has no {by}"


def unread_words(row, words, source):
    """Of a row that stands for all words of an enumeration those that nobody reads."""
    if words and (row["honoured_by"] or "").endswith("::*"):
        code = bare(source(row["in"]) or "")
        for word in (place.partition("=")[2] for place in words):
            name = row["honoured_by"][:-1] + "".join(part.capitalize() for part in word.split("_"))
            if not re.search(r"(?<![\w.])" + name + r"\b", code):
                yield f"{row['schema']}: {row['declared'][:-1]}{word}: {row['in']} does not read {name}"


def problems(schemas, rows, model, source, tests, functions):
    yield from sorted({f"consumers/{row['schema']}: there is no {row['schema']}.xsd" for row in rows if row["schema"] not in schemas})
    for name, schema in schemas.items():
        wanted = declared(schema)
        listed = []
        for row in (row for row in rows if row["schema"] == name):
            words = [place for place in wanted if row["declared"].endswith("=*") and place.startswith(row["declared"][:-1])]
            listed += words or [row["declared"]]
            yield from unread_words(row, words, source)
        yield from (f"{name}.xsd: {place} has no row" for place in wanted if place not in listed)
        yield from (f"{name}: {place} is in no schema" for place in listed if place not in wanted)
        yield from (f"{name}: {place} has several rows" for place in set(listed) if listed.count(place) > 1)
    for row in rows:
        if why := wrong(row, model, source, tests, functions):
            yield f"{row['schema']}: {row['declared']}: {why}"
    for row, others in shared(rows, source):
        yield f"{row['schema']}: {row['declared']}: {row['in']} does not name it, and its consumer is that of {', '.join(others)}, too"


def unknown(readers, schemas):
    """What the readers take and no schema has."""
    known = {name for schema in schemas.values() for place in declared(schema) for name in re.split("[/@=]", place)}
    asked = {name for names in ASKED.findall(readers) for name in names if name}
    return [f"hirosco/descriptor reads {name}, which no schema has" for name in sorted(asked - known - NOT_BUILT_IN)]


def lost(promises):
    """Folders and tests of the map that are not there."""
    return [f"docs/paper_map.md: no {path}" for path in re.findall(r"`([\w./]+/[\w./]*)`", promises) if not (ROOT / path).exists()]


def rows_of(files):
    """[(schema/part.csv, its text)] as one table, each row with the schema of its folder. What cannot be a table is told: no row of it would count."""
    rows, wrong_ones = [], []
    for name, text in files:
        table = csv.DictReader(text.splitlines())
        found = list(table)
        if table.fieldnames != COLUMNS or not found:
            wrong_ones.append(f"consumers/{name}: rows of {','.join(COLUMNS)} are wanted, the first line says so")
        rows += [dict(row, schema=name.partition("/")[0]) for row in found]
    return rows, wrong_ones


def main():
    def source(file):
        """Of a folder those of its files that do not say what words there are."""
        if file.endswith("/") and (ROOT / file).is_dir():
            parts = [part.read_text() for part in sorted((ROOT / file).glob("*.[ch]pp")) if not part.name.endswith("_test.cpp")]
            return "\n".join(part for part in parts if "struct EnumTexts<" not in part)
        return (ROOT / file).read_text() if (ROOT / file).is_file() else None

    schemas = {name: whole(FOLDER / f"{name}.xsd", set()) for name in ("subsystem", "mission")}
    table = FOLDER / "consumers"
    rows, unreadable = rows_of((file.relative_to(table).as_posix(), file.read_text()) for file in sorted(table.rglob("*.csv")))
    model = members([bare(path.read_text()) for path in MODEL])
    tests = "".join(path.read_text() for path in sorted(FOLDER.rglob("*_test.cpp")))
    promises = (ROOT / "docs/paper_map.md").read_text()
    readers = "".join(path.read_text() for path in sorted(FOLDER.rglob("*.cpp")) if not path.name.endswith("_test.cpp"))
    functions = bodies([bare(path.read_text()) for path in sorted(FOLDER.rglob("*.cpp")) if not path.name.endswith("_test.cpp")])
    found = [*unreadable, *problems(schemas, rows, model, source, tests, functions), *unknown(readers, schemas), *lost(promises)]

    def changed(place, **values):
        return [dict(row, **(values if row["declared"] == place else {})) for row in rows]

    attribute = '<xs:attribute name="id" type="EventId">'
    planted = [
        ("Event@colour has no row", dict(schemas=dict(schemas, subsystem=schemas["subsystem"].replace(
            attribute, '<xs:attribute name="colour" type="xs:string"/>' + attribute))), rows),
        ("Framing=cobs has no row", dict(schemas=dict(schemas, subsystem=schemas["subsystem"].replace(
            '<xs:enumeration value="raw"/>', '<xs:enumeration value="raw"/><xs:enumeration value="cobs"/>'))), rows),
        ("colour is in no schema", {}, [*rows, dict(rows[0], declared="Event@colour")]),
        ("has several rows", {}, [*rows, rows[0]]),
        ("there is no flight.xsd", {}, [*rows, dict(rows[0], schema="flight")]),
        ("says nothing", {}, changed("Subsystem/Hang", honoured_by=" ")),
        ("is no file", {}, changed("Subsystem/Hang", **{"in": "supervisor/guard/nobody.cpp"})),
        ("is no file", {}, changed("Subsystem/Hang", **{"in": "hirosco/descriptor/read/mission_test.cpp"})),
        ("outside hirosco/descriptor", {}, changed("Subsystem/Hang", **{"in": "hirosco/descriptor/read/read_subsystem.cpp"})),
        ("does not read", {}, changed("Subsystem/Hang", **{"in": "hirosco/xml/reader.cpp"})),
        ("the model has no", {}, changed("Subsystem/Hang", honoured_by="SubsystemDescriptor::colour")),
        ("does not name it", {}, changed("Plan/Do@within_s", honoured_by="PlanStep::values") + [
            dict(rows[0], schema="mission", declared="Plan/Do@limit", honoured_by="PlanStep::values", **{"in": "supervisor/supervision/procedures/steps/link.hpp"}),
            dict(rows[0], schema="mission", declared="Plan/Do@pause_ms", honoured_by="PlanStep::values", **{"in": "supervisor/supervision/procedures/steps/link.hpp"})]),
        ("does not call", {}, changed("Subsystem/Set@value", honoured_by="nobody>begin_with")),
        ("has nothing to do with", {}, changed("Subsystem/Set@value", honoured_by="apply_change>Device::stop")),
        ("the model has no Resource::Colour", {}, changed("Mission/Resources@ports", honoured_by="Mission::budget[Resource::Colour]")),
        ("does not read Transfer::Ethercat", dict(schemas=dict(schemas, subsystem=schemas["subsystem"].replace(
            '<xs:enumeration value="udp"/><xs:enumeration value="tcp"/>', '<xs:enumeration value="udp"/><xs:enumeration value="ethercat"/><xs:enumeration value="tcp"/>'))), rows),
        ("honours nothing", {}, changed("Type=UINT8", **{"in": "hirosco/parameter/type.hpp"})),
        ("does not read Type::Uint8", {}, changed("Type=UINT8", **{"in": "hirosco/xml/reader.cpp"})),
        ("say 'Plan::name of' which", {}, changed("Recovery/Plan@name", honoured_by="Plan::name", **{"in": "supervisor/supervision/event_handling/reactions.cpp"})),
        ("does not read Plan::name of best", {}, changed("Recovery/Plan@name", **{"in": "supervisor/supervision/event_handling/reactions.cpp"})),
        ("the model has no Colour::*", {}, changed("Transfer=*", honoured_by="Colour::*")),
        ("makes no E0999", {}, changed("Subsystem/Hang", honoured_by="E0999", **{"in": "hirosco/descriptor/read/read_modes.cpp"})),
    ]
    for wanted, other, table in planted:
        seen = problems(**dict(dict(schemas=schemas, model=model, source=source, tests=tests, functions=functions), **other), rows=table)
        if not any(wanted in problem for problem in seen if problem not in found):
            found.append(f"planted and not seen: {wanted}")
    for asked in ('attributes.integer_or<int>("colour", 1, 2, 0)', '{"Colour", read}', 'read_states(attributes, "colour", {})'):
        if not unknown(asked, schemas):
            found.append(f"planted and not seen: {asked}")
    for text in ("declared,in,honoured_by\na,b,c\n", "declared,honoured_by,in\n", ""):
        if not rows_of([("mission/a.csv", text)])[1]:
            found.append(f"planted and not seen: a table that begins {text[:20]!r}")
    if not lost(promises + "`tests/nobody_test.cpp`"):
        found.append("planted and not seen: tests/nobody_test.cpp")
    return "\n".join(found) or ("no rows" if not rows else None)


if __name__ == "__main__":
    sys.exit(main())
