#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The shape of the house: no file over 500 lines, be it code or a page, no class over 300 in any language, with its members in whatever files neither, `supervisor.hpp` under
90, no circle of folders, a test beside each file of the supervisor and the ground station. Prints what breaks it, and breaks each rule once itself, to be caught."""
import ast, bisect, collections, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = ("hirosco", "robotics", "supervisor", "subsystems", "simulation", "missions", "ground", "tools", "tests", "bench", "templates", "docs")
LONGEST_FILE, LONGEST_CLASS, LONGEST_WHOLE = 500, 300, 300
OTHERS = {"supervisor/supervisor.hpp": 90}
# A log, which grows with each version, and what tools/check_schema.py makes, a row for each attribute.
UNCOUNTED = ("CHANGELOG.md", "docs/interfaces/schema.md")
CODE = (".cpp", ".hpp", ".py", ".js", ".mjs", ".xsd", ".md")
CLASS = re.compile(r"^(?:template <.*> *)?(?:class|struct) (?:\[\[\w+\]\] )?((?:\w+::)*\w+)[^;(]*\{", re.M)
JS_CLASS = re.compile(r"^([ \t]*)(?:export )?(?:default )?(?:(?:const|let) \w+ = )?class\b ?(\w*)[^\n{]*\{[ \t]*$", re.M)
MEMBER = re.compile(r"^(?:[A-Za-z_\[][^\n;#/]*?[ *&])?((?:\w+(?:<[^\n()]*?>)?::)+)~?(?:operator[^\n(]*|\w+)\(", re.M)
# Braces, but for those of comments, strings and characters, and which of them open a namespace.
BRACE = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])+'"""
                   r"""|(namespace(?: [\w:]+)? *)?\{|\}""", re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^">]+)"', re.M)


def files():
    for part in PARTS:
        for path in sorted(ROOT.glob("*.md") if part == "docs" else []) + sorted((ROOT / part).rglob("*")):
            if path.suffix in CODE and not {"node_modules", "__pycache__", "build"} & set(path.relative_to(ROOT).parts):
                yield path.relative_to(ROOT).as_posix(), path.read_text()


def too_long(texts):
    for name, text in texts.items():
        limit = OTHERS.get(name, LONGEST_FILE)
        if name not in UNCOUNTED and (lines := text.count("\n")) > limit:
            yield f"{name}: {lines} lines, {limit} at most"
        for what, lines in classes(name, text):
            if lines > LONGEST_CLASS:
                yield f"{name}: {what} has {lines} lines, {LONGEST_CLASS} at most"


def classes(name, text):
    """Each with its lines from brace to brace, or in Python from the first to the last."""
    if name.endswith(".py"):
        yield from ((node.name, node.end_lineno - node.lineno + 1) for node in ast.walk(ast.parse(text, name)) if isinstance(node, ast.ClassDef))
    elif name.endswith((".js", ".mjs")):
        for begin in JS_CLASS.finditer(text):
            yield begin[2], text.count("\n", begin.start(), text.find(f"\n{begin[1]}}}", begin.end()))
    elif name.endswith((".hpp", ".cpp")):
        for begin in CLASS.finditer(text):
            end = text.find("\n};", begin.start())
            yield begin[1], text.count("\n", begin.start(), end) if end > 0 else 0


def namespaces(name, text):
    """Where in a file which namespace begins to hold. What has no name is the file's own."""
    found, open_ones = [(0, ())], []
    for brace in BRACE.finditer(text):
        if brace[0].endswith("{"):
            open_ones.append((brace[2].split()[1] if " " in brace[2].strip() else name) if brace[2] else None)
        elif brace[0] == "}" and open_ones:
            open_ones.pop()
        else:
            continue
        found.append((brace.end(), tuple(each for each in open_ones if each)))
    return found


def whole_name(namespace, written):
    """Of `a::Outer<T>::Inner`, written in a namespace: that of Outer, to which Inner belongs. None: what is written names no class."""
    parts = re.sub(r"<[^<>]*>|::$", "", written).split("::")
    kinds = [part[0].isupper() for part in parts]
    return "::".join([*namespace, *parts[:kinds.index(True) + 1]]) if True in kinds else None


def too_large(texts):
    """Of a class, what stands between its braces, each member that stands elsewhere, and its nested classes. Two of one name in two namespaces are two."""
    lines = collections.Counter()
    for name, text in texts.items():
        if not name.endswith((".hpp", ".cpp")) or "_test." in name:
            continue
        places = namespaces(name, text)
        for begin in [*CLASS.finditer(text), *MEMBER.finditer(text)]:
            namespace = places[bisect.bisect(places, (begin.start() + 1,)) - 1][1]
            end = text.find("\n}", begin.start())
            first = text[begin.start():].split("\n", 1)[0]
            whole = end < 0 or first.rstrip().endswith(("}", ";"))
            lines[whole_name(namespace, begin[1])] += 1 if whole else text.count("\n", begin.start(), end) + 1
    lines.pop(None, None)
    for name, count in lines.items():
        if count > LONGEST_WHOLE:
            yield f"{name} has {count} lines with its members, {LONGEST_WHOLE} at most"


# Where each file has its test beside it, and which have theirs elsewhere, or together.
TESTED = ("supervisor/", "ground/")
ELSEWHERE = {
    "supervisor/flight_shell.cpp": "tests/endtoend/flight_test.py",
    "supervisor/guard/guard_roster.cpp": "supervisor/guard/guard_test.cpp",
    "supervisor/guard/loop_watch.cpp": "supervisor/guard/watching_test.cpp",
    "supervisor/guard/stop_of_all.cpp": "supervisor/guard/guard_test.cpp",
    "supervisor/guard/supervisor_watch.cpp": "supervisor/guard/watching_test.cpp",
    "supervisor/platform/storage/log_writer.cpp": "supervisor/platform/storage/packet_log_test.cpp",
    "supervisor/platform/storage/sqlite_database.cpp": "supervisor/platform/storage/database_test.cpp",
    "supervisor/platform/storage/postgresql_": "supervisor/platform/storage/postgresql_database_test.cpp",
    "supervisor/platform/storage/value_disk.cpp": "supervisor/platform/storage/value_store_test.cpp",
    "supervisor/supervision/event_handling/plans_before.cpp": "supervisor/supervision/succession/plans_of_the_living_test.cpp",
    "supervisor/supervision/procedures/steps/": "supervisor/supervision/procedures/plan_step_kinds_test.cpp",
    "supervisor/supervision/subsystem_handling/fresh_descriptor.cpp": "supervisor/supervision/subsystem_handling/descriptors_test.cpp",
    "supervisor/supervisor.cpp": "tests/integration/commissioning_test.cpp",
    "ground/api/schemas.cpp": "ground/api/openapi_test.cpp",
    "ground/archive/archive_file.cpp": "ground/archive/archive_test.cpp",
    "ground/clients/xtce/": "ground/clients/xtce/xtce_test.cpp",
    "ground/shell/": "tests/ground/ground_test.py",
}


def untested(texts):
    used = set()
    for name in texts:
        if not name.startswith(TESTED) or not name.endswith(".cpp") or "/testing/" in name or name.endswith(("_test.cpp", "/main.cpp", "/example.cpp")):
            continue
        if name.removesuffix(".cpp") + "_test.cpp" in texts:
            continue
        row = next((row for row in ELSEWHERE if name.startswith(row)), None)
        used.add(row)
        if row is None:
            yield f"{name}: no {name.removesuffix('.cpp').rsplit('/', 1)[1]}_test.cpp beside it"
        elif ELSEWHERE[row] not in texts:
            yield f"{name}: its test is to be {ELSEWHERE[row]}, which there is not"
    if used:
        yield from (f"check_shape.py: {row} has its test beside it, or is no more" for row in ELSEWHERE if row not in used)


def folder(name):
    """Whose detail/ is nobody else's to include (check_layers.py), so the two are one."""
    return name.rsplit("/", 1)[0].removesuffix("/detail")


def circles(texts):
    """Folders that include each other, over however many; the files of a folder itself are one, those of each folder in it another.
    Tests may look up and down, testing/ belongs to them, and an example is run as a test."""
    edges = collections.defaultdict(set)
    for name, text in texts.items():
        if name.endswith((".hpp", ".cpp")) and "_test." not in name and "/testing/" not in name and not name.endswith("/example.cpp"):
            edges[folder(name)] |= {folder(to) for to in INCLUDE.findall(text) if to in texts and folder(to) != folder(name)}
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
    return list(too_long(texts)) + list(too_large(texts)) + circles(texts) + list(untested(texts))


PLANTED = [({"hirosco/a.cpp": "\n" * 501}, "501 lines"), ({"hirosco/a.xsd": "\n" * 501}, "a.xsd: 501 lines"), ({"docs/a.md": "\n" * 501}, "a.md: 501 lines"), ({"supervisor/supervisor.hpp": "\n" * 91}, "91 lines"),
           ({"hirosco/a.hpp": "class Big final : Base {\n" + "  int a;\n" * 301 + "};\n"}, "Big has 30"),
           ({"tests/a.py": "@b\nclass Big(c):\n" + "    a = 1\n\n" * 151 + "e = 2\n"}, "a.py: Big has 302"),
           ({"ground/a.js": "export class Big extends A {\n" + "  a() {\n  }\n" * 151 + "}\n"}, "a.js: Big has 302"),
           ({"ground/a.mjs": "  class Inner {\n" + "    a() {\n    }\n" * 151 + "  }\n"}, "a.mjs: Inner has 302"),
           ({"hirosco/a.hpp": "class Spread {\n" + "  int a;\n" * 250 + "};\n",
             "hirosco/a.cpp": "int Spread::a() {\n" + "  b();\n" * 250 + "}\n",
             "hirosco/b.cpp": "Spread::~Spread() {\n" + "  b();\n" * 250 + "}\n"}, "Spread has 7"),
           # In two files and folders, half of it nested, and members of a template.
           ({"hirosco/a/a.hpp": "namespace hirosco::a {\nclass Whole {\n" + "  int a;\n" * 120 + "};\n}  // namespace hirosco::a\n",
             "hirosco/a/a.cpp": "namespace hirosco::a {\nnamespace {\nint b() { return '{'; }\n}\nvoid Whole::Inner::a() {\n" + "  b();\n" * 100 + "}\n}\n",
             "hirosco/b/b.cpp": 'namespace hirosco {\nconstexpr auto c = "{";  // {\nvoid a::Whole<T>::a() {\n' + "  b();\n" * 100 + "}\n}\n"},
            "hirosco::a::Whole has 32"),
           ({"hirosco/a/a.hpp": '#include "hirosco/b/b.hpp"\n', "hirosco/b/b.hpp": '#include "hirosco/c/c.hpp"\n',
             "hirosco/c/c.hpp": '#include "hirosco/a/a.hpp"\n'}, "hirosco/a -> hirosco/b -> hirosco/c -> hirosco/a"),
           # A folder and one in it, at once or by way of another one.
           ({"hirosco/a/a.hpp": '#include "hirosco/a/b/b.hpp"\n', "hirosco/a/b/b.cpp": '#include "hirosco/a/a.hpp"\n', "hirosco/a/b/b.hpp": ""},
            "hirosco/a -> hirosco/a/b -> hirosco/a"),
           ({"hirosco/a/a.hpp": '#include "hirosco/a/b/b.hpp"\n', "hirosco/a/b/b.hpp": '#include "hirosco/c/c.hpp"\n',
             "hirosco/c/c.hpp": '#include "hirosco/a/a.hpp"\n'}, "hirosco/a -> hirosco/a/b -> hirosco/c -> hirosco/a"),
           ({"supervisor/a.cpp": ""}, "no a_test.cpp"), ({"ground/shell/a.cpp": ""}, "which there is not"),
           ({"ground/a.cpp": "", "ground/a_test.cpp": "", "ground/shell/b.cpp": ""}, "has its test beside it, or is no more")]
# Two classes of one name are no breach, be it in two namespaces or each in a file of its own; nor is a folder with its detail/, nor what tests include.
SOUND = {"CHANGELOG.md": "\n" * 501, "tests/a.py": ("class Twin:\n" + "    a = 1\n" * 200) * 2, "ground/a.js": ("class Twin {\n" + "  a;\n" * 200 + "}\n") * 2,
         "hirosco/e/e.hpp": '#include "hirosco/e/detail/e.hpp"\n', "hirosco/e/detail/e.hpp": '#include "hirosco/e/f.hpp"\n', "hirosco/e/f.hpp": "",
         "hirosco/e/example.cpp": '#include "hirosco/e/g/g.hpp"\n', "hirosco/e/f_test.cpp": '#include "hirosco/e/g/g.hpp"\n',
         "hirosco/e/g/g.hpp": '#include "hirosco/e/f.hpp"\n',
         "hirosco/a.hpp": "namespace hirosco::a {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}  // namespace hirosco::a\n",
         "hirosco/b.hpp": "namespace hirosco::b {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}\n",
         "hirosco/c.cpp": "namespace hirosco::a {\nnamespace {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}  // namespace\n}\n",
         "hirosco/d.cpp": "namespace hirosco::a {\nnamespace {\nvoid Twin::a() {\n" + "  b();\n" * 200 + "}\n}\n}\n"}
missed = [f"taken for a breach: {found}" for found in problems(SOUND)]
missed += [f"planted and not seen: {wanted}" for texts, wanted in PLANTED if not any(wanted in found for found in problems(texts))]
ours = dict(files())
sys.exit("\n".join(problems(ours) + missed) or ("no files" if not ours else None))
