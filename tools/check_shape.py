#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The shape of the house: no text that somebody writes over 500 lines, be it code, a page, a table or a build file, no class over 300 in any language, with its members in
whatever files neither, `supervisor.hpp` under 90, no circle of folders, a test beside each file of the supervisor and the ground station, and beside each header with code of
its own. Prints what breaks it, and breaks each rule once itself, to be caught."""
import ast, bisect, collections, pathlib, re, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = ("hirosco", "robotics", "supervisor", "subsystems", "simulation", "missions", "ground", "tools", "tests", "bench", "templates", "docs", "cmake")
LONGEST_FILE, LONGEST_CLASS, LONGEST_WHOLE = 500, 300, 300
OTHERS = {"supervisor/supervisor.hpp": 89}
UNCOUNTED = {
    "CHANGELOG.md": "a log, which grows with each version",
    "docs/interfaces/schema.md": "made by tools/check_schema.py, a row for each attribute",
    "ground/web/package-lock.json": "made by npm, a row for each package of the page",
}
NOT_OURS = {"node_modules", "__pycache__", "build"}  # folders
CLASS = re.compile(r"^(?:template <.*> *)?(?:class|struct) (?:\[\[\w+\]\] )?((?:\w+::)*\w+)[^;(]*\{", re.M)
JS_CLASS = re.compile(r"^([ \t]*)(?:export )?(?:default )?(?:(?:const|let) \w+ = )?class\b ?(\w*)[^\n{]*\{[ \t]*$", re.M)
MEMBER = re.compile(r"^(?:[A-Za-z_\[][^\n;#/]*?[ *&])?((?:\w+(?:<[^\n()]*?>)?::)+)~?(?:operator[^\n(]*|\w+)\(", re.M)
# Braces, but for those of comments, strings and characters, and which of them open a namespace.
BRACE = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])+'"""
                   r"""|(namespace(?: [\w:]+)? *)?\{|\}""", re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^">]+)"', re.M)


def files(root):
    """All text, whatever it is: what is none has an octet 0 or is no UTF-8."""
    for part in (None, *PARTS):
        for path in sorted(root.glob("*") if part is None else (root / part).rglob("*")):
            place = path.relative_to(root)
            if NOT_OURS & set(place.parent.parts) or not path.is_file():
                continue
            octets = path.read_bytes()
            try:
                if b"\0" not in octets:
                    yield place.as_posix(), octets.decode()
            except UnicodeDecodeError:
                pass


def lines_of(text):
    return text.count("\n") + (text != "" and not text.endswith("\n"))


def too_long(texts):
    for name, text in texts.items():
        limit = OTHERS.get(name, LONGEST_FILE)
        if name not in UNCOUNTED and (lines := lines_of(text)) > limit:
            yield f"{name}: {lines} lines, {limit} at most"
        for what, lines in classes(name, text):
            if lines > LONGEST_CLASS:
                yield f"{name}: {what} has {lines} lines, {LONGEST_CLASS} at most"


def spared_for_nothing(texts):
    return [f"check_shape.py: {name} is spared and need not be" for name in UNCOUNTED if name in texts and lines_of(texts[name]) <= LONGEST_FILE]


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


# Headers without a .cpp that have code all the same: where that is tried, if not beside them, and why there.
STEPS = "supervisor/supervision/procedures/steps/"
STEP_KINDS = ("supervisor/supervision/procedures/plan_step_kinds_test.cpp", "a row of the table of steps: what a plan does by it")
COMMISSIONING = ("supervisor/supervision/modes/commissioning_test.cpp", "a row of the table of steps: no plan has it, the way up has")
HEADERS_ELSEWHERE = {
    "supervisor/composition.hpp": ("tests/integration/commissioning_test.cpp", "it makes and joins all parts: what it joins a whole flight tries"),
    "supervisor/keeper/job_control.hpp": ("tests/fault/stands_still_test.py", "what a terminal does to whole processes"),
    "supervisor/platform/launch/flight_launcher.hpp": ("supervisor/platform/launch/thread_launcher_test.cpp", "an interface; threads leave out what may be left out"),
    "supervisor/platform/launch/launcher.hpp": ("supervisor/supervision/subsystem_handling/processes_test.cpp",
                                                "an interface; the launcher that the rig plays leaves out what may be left out"),
    "supervisor/supervision/command_desk.hpp": ("supervisor/supervision/data_handling/own_telecommands_test.cpp", "an interface; what it says for its callers the desk tries"),
    "supervisor/supervision/procedures/step.hpp": STEP_KINDS,
    **{f"{STEPS}{kind}.hpp": STEP_KINDS for kind in ("command", "configure", "fence", "kill", "link", "power", "set_state", "step_kinds", "unlink", "wait_for")},
    **{f"{STEPS}{kind}.hpp": COMMISSIONING for kind in ("enter_mode", "self_test")},
    STEPS + "restart.hpp": ("supervisor/supervision/event_handling/reactions_test.cpp", "it answers a death alone"),
    "supervisor/supervision/status/rows.hpp": ("supervisor/supervision/status/housekeeping_test.cpp", "columns, as they come down"),
    "ground/archive/columns.hpp": ("ground/archive/archive_test.cpp", "values into a database and back, which takes an archive"),
    "ground/commands/question_source.hpp": ("ground/commands/commands_test.cpp", "what becomes of an answer under such an id"),
    "ground/model/answered.hpp": ("ground/commands/request_test.cpp", "a pair of status and words, as requests are refused"),
}
BARE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
# Of a function that does something: what is behind its arguments and stands between braces.
BODY = re.compile(r"\)(?:\s*(?:const|noexcept|override|final|mutable))*(?:\s*->\s*[\w:<>,&*\s]+?)?\s*\{\s*[^}\s]")


def untested_headers(texts):
    used = set()
    for name, text in texts.items():
        if not name.startswith(TESTED) or not name.endswith(".hpp") or "/testing/" in name or name.endswith("/testing.hpp"):
            continue
        test = name.removesuffix(".hpp") + "_test.cpp"
        if name.removesuffix(".hpp") + ".cpp" in texts or not BODY.search(BARE.sub(" ", text)):
            continue
        if name in HEADERS_ELSEWHERE:
            used.add(name)
            if test in texts or HEADERS_ELSEWHERE[name][0] not in texts:
                yield f"{name}: its test is to be {HEADERS_ELSEWHERE[name][0]}, which there is not, or it has one beside it"
        elif test not in texts:
            yield f"{name}: it has code, and no {test.rsplit('/', 1)[1]} beside it"
    if used:
        yield from (f"check_shape.py: {row} has no code of its own any more, or is no more" for row in HEADERS_ELSEWHERE if row not in used)


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
    return [*too_long(texts), *spared_for_nothing(texts), *too_large(texts), *circles(texts), *untested(texts), *untested_headers(texts)]


PLANTED = [({"hirosco/a.cpp": "\n" * 501}, "501 lines"), ({"hirosco/a.xsd": "\n" * 501}, "a.xsd: 501 lines"), ({"docs/a.md": "\n" * 501}, "a.md: 501 lines"), ({"supervisor/supervisor.hpp": "\n" * 90}, "90 lines"),
           ({"CHANGELOG.md": "\n" * 500}, "need not be"), ({"hirosco/a.csv": "\n" * 500 + "a,b"}, "a.csv: 501 lines"),
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
           ({"ground/a.cpp": "", "ground/a_test.cpp": "", "ground/shell/b.cpp": ""}, "has its test beside it, or is no more"),
           ({"ground/a.hpp": "inline int a(int b) noexcept { return b; }\n"}, "it has code, and no a_test.cpp"),
           ({"supervisor/a.hpp": "struct A {\n  [[nodiscard]] auto a() const -> int {\n    return 1;\n  }\n};\n"}, "it has code, and no a_test.cpp"),
           ({"supervisor/a.hpp": "constexpr Kind a{.run = [](int b) { run(b); }};\n"}, "it has code, and no a_test.cpp"),
           ({"ground/model/answered.hpp": "int a() { return 1; }\n"}, "which there is not"),
           ({"ground/model/answered.hpp": "int a() { return 1; }\n", "ground/commands/request_test.cpp": ""}, "has no code of its own any more")]
# Two classes of one name are no breach, be it in two namespaces or each in a file of its own; nor is a folder with its detail/, nor what tests include.
SOUND = {"CHANGELOG.md": "\n" * 501, "hirosco/a.csv": "\n" * 500, "supervisor/supervisor.hpp": "\n" * 89,
         "ground/b.hpp": "struct B {\n  virtual int b() = 0;\n  explicit B(int c) : c_{c} {}\n  virtual void d(int) {}  // { return 1; }\n  int c_{0};\n};\n",
         "ground/c.hpp": "int c() { return 1; }\n", "ground/c_test.cpp": "", "ground/d.hpp": "int d() { return 1; }\n", "ground/d.cpp": "", "ground/d_test.cpp": "",
         "ground/testing/e.hpp": "int e() { return 1; }\n", "tests/a.py": ("class Twin:\n" + "    a = 1\n" * 200) * 2, "ground/a.js": ("class Twin {\n" + "  a;\n" * 200 + "}\n") * 2,
         "hirosco/e/e.hpp": '#include "hirosco/e/detail/e.hpp"\n', "hirosco/e/detail/e.hpp": '#include "hirosco/e/f.hpp"\n', "hirosco/e/f.hpp": "",
         "hirosco/e/example.cpp": '#include "hirosco/e/g/g.hpp"\n', "hirosco/e/f_test.cpp": '#include "hirosco/e/g/g.hpp"\n',
         "hirosco/e/g/g.hpp": '#include "hirosco/e/f.hpp"\n',
         "hirosco/a.hpp": "namespace hirosco::a {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}  // namespace hirosco::a\n",
         "hirosco/b.hpp": "namespace hirosco::b {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}\n",
         "hirosco/c.cpp": "namespace hirosco::a {\nnamespace {\nclass Twin {\n" + "  int a;\n" * 200 + "};\n}  // namespace\n}\n",
         "hirosco/d.cpp": "namespace hirosco::a {\nnamespace {\nvoid Twin::a() {\n" + "  b();\n" * 200 + "}\n}\n}\n"}


def unread():
    """Kinds of text that nobody would count. What somebody else has made, and what is no text, is left alone."""
    kinds = ["a.c", "a.h", "a.css", "a.xml", "a.csv", "a.json", "a.html", "a.mjs", "a.cmake", "a.txt", "a.in", "run", "build"]
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for place in ("", "tools/part/", "ground/node_modules/", "tools/build/"):
            (root / place).mkdir(parents=True, exist_ok=True)
            for kind in kinds:
                (root / place / kind).write_text("a\n" * 501)
        (root / "tools/part/picture.png").write_bytes(b"\x89\0\n" * 501)
        (root / "tools/part/latin.txt").write_bytes(b"\xe9\n" * 501)
        found = {problem.partition(":")[0] for problem in too_long(dict(files(root)))}
    wanted = {place + kind for place in ("", "tools/part/") for kind in kinds}
    return [f"planted and not as it is to be: {name} of 501 lines" for name in sorted(found ^ wanted)]


missed = [f"taken for a breach: {found}" for found in problems(SOUND)]
missed += [f"planted and not seen: {wanted}" for texts, wanted in PLANTED if not any(wanted in found for found in problems(texts))]
ours = dict(files(ROOT))
missed += unread() + [f"check_shape.py: {name} is no more" for name in UNCOUNTED if name not in ours]
sys.exit("\n".join(problems(ours) + missed) or ("no files" if not ours else None))
