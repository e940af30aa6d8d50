#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each program that a folder of subsystems/ makes is flown twice: by a mission of missions/, and by a test mission, a file in tests/, or in the tests/ of a
folder of its own, that commissions it into Operational and that a test beside it flies or simulates; what is meant to be otherwise stands below, with its reason (docs/adr/0223). Who is
flown by what is the table of subsystems/README.md. Prints who is not and what to do, and takes it away from a copy itself, to be caught. `--write` makes the table."""
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = re.compile(r"^\s*hirosco_(?:subsystem|executable)\((hirosco-[a-z0-9-]+)", re.M)
BEGIN, END = "<!-- flown: made by tools/check_flown.py --write -->\n", "<!-- end -->\n"
KINDS = ("missions", "tests")
OWNERS = ("missions", "subsystems", "simulation/devices")
SOURCES = (".py", ".cpp", ".hpp", ".mjs")
# A line of a subsystem's README: who is not flown by which kind, and why. No program is flown by neither.
NOT_FLOWN = re.compile(r"^Not flown by `(missions|tests)/`: `(hirosco-[a-z0-9-]+)`: (.+?)\.?$", re.M)


def not_flown(root):
    """By kind and program: why."""
    return {(kind, program): why for path in sorted((root / "subsystems").glob("*/README.md"))
            for kind, program, why in NOT_FLOWN.findall(path.read_text())}


def programs(folder):
    """What the build makes of a subsystem's folder."""
    return [name for path in sorted(folder.rglob("CMakeLists.txt")) if "tests" not in path.relative_to(folder).parts
            for name in PROGRAM.findall(path.read_text())]


def places(root, kind):
    """The folders in which its missions are."""
    if kind == "missions":
        return sorted(folder for folder in (root / kind).iterdir() if folder.is_dir())
    return [root / kind, *(folder for owner in OWNERS for folder in sorted((root / owner).glob("*/tests")))]


def missions(root, kind):
    """Files that may be one of this kind."""
    for place in places(root, kind):
        yield from (path for path in sorted(place.rglob("*.xml")) if kind == "tests" or "tests" not in path.relative_to(place).parts)


def place(root, mission, named):
    """Where a descriptor is that a mission names."""
    return root / named.removeprefix("@hirosco/") if named.startswith("@hirosco/") else mission.parent / named


def commissioned(root, mission):
    """(program, configuration) of all whom a mode of this mission brings into Operational."""
    tree = xml.parse(mission).getroot()
    if tree.tag != "Mission":
        return
    program = {}
    for member in tree.iter("Subsystem"):
        name = member.get("name") or xml.parse(place(root, mission, member.get("descriptor"))).getroot().get("name")
        program[name] = member.get("executable")
    for step in tree.iter("Commission"):
        if step.get("state") == "Operational":
            yield program[step.get("subsystem")], step.get("configuration")


def is_used(root, mission):
    """A test names it: by its way from the root, by its name from beside it or from the tests/ of its folder, by the folder of a mission."""
    words = [mission.relative_to(root).as_posix()]
    if mission.relative_to(root).parts[0] == "missions":
        words.append(mission.parent.relative_to(root).as_posix() + '"')
    for place in places(root, "tests"):
        for path in sorted(place.rglob("*")):
            if path.suffix in SOURCES and "node_modules" not in path.parts:
                text = path.read_text()
                beside = path.parent in (mission.parent, mission.parent / "tests")
                if any(word in text for word in words) or (beside and f'"{mission.name}"' in text):
                    return True
    return False


def flights(root):
    """By kind and program: the missions that fly it, each with the configurations."""
    found = {kind: {} for kind in KINDS}
    for kind in KINDS:
        for mission in missions(root, kind):
            flown = list(commissioned(root, mission))
            if flown and is_used(root, mission):
                for program, configuration in flown:
                    found[kind].setdefault(program, {}).setdefault(mission, set()).add(configuration)
    return found


def folders(root):
    return [path for path in sorted((root / "subsystems").iterdir()) if path.is_dir() and programs(path)]


def cell(root, kind, flown, program, reasons):
    """"light (NOMINAL, DIM)", or why there is none."""
    told = {}
    for mission, configurations in flown[kind].get(program, {}).items():
        told.setdefault(mission.relative_to(root).as_posix().removeprefix(f"{kind}/").removesuffix("/mission.xml"), set()).update(configurations)
    by = ", ".join(f"{mission} ({', '.join(sorted(configurations))})" for mission, configurations in sorted(told.items()))
    return by or reasons.get((kind, program), "")


def table(root, flown, reasons):
    text = "| subsystem | program | flown by `missions/` | and by `tests/`, or those of a folder |\n|---|---|---|---|\n"
    for folder in folders(root):
        for program in programs(folder):
            text += f"| [{folder.name}]({folder.name}/README.md) | `{program}` |"
            text += "".join(f" {cell(root, kind, flown, program, reasons)} |" for kind in KINDS) + "\n"
    return text


def written(root, flown, reasons):
    """The README as it has to be."""
    text = (root / "subsystems/README.md").read_text()
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + table(root, flown, reasons) + END + rest.partition(END)[2]


def problems(root, reasons):
    flown = flights(root)
    mended_by = {"missions": "put <Subsystem> and <Commission ... state=\"Operational\"/> of it into a mission.xml there, which a test flies",
                 "tests": "put them into a test mission and judge it in the test beside that (tests/stock/ has three that others may join)"}
    made = {program: folder for folder in folders(root) for program in programs(folder)}
    for program, folder in made.items():
        for kind in KINDS:
            if not flown[kind].get(program) and (kind, program) not in reasons:
                yield f"subsystems/{folder.name}: no mission of {kind}/{' or of a tests/ of its own' * (kind == 'tests')} flies {program}: {mended_by[kind]}"
        if all((kind, program) in reasons for kind in KINDS):
            yield f"subsystems/: {program} would be flown by nobody: take one of its lines Not flown by out of its README"
    for kind, program in reasons:
        if program not in made:
            yield f"subsystems/: a README says Not flown by of {program}, which nobody makes: take that line out"
        elif by := cell(root, kind, flown, program, {}):
            yield f"subsystems/: a README says Not flown by {kind}/ of {program}, and {by} flies it: take that line out"
    if written(root, flown, reasons) != (root / "subsystems/README.md").read_text():
        yield "subsystems/README.md: its table is not what flies: tools/check_flown.py --write"


def self_test():
    """Each thing that it is for is missed in a copy that lacks it."""
    mission = '<Mission><Subsystem executable="hirosco-lamp" descriptor="../../subsystems/lamp/lamp.xml"/>' \
        '<Mode><Commission subsystem="LAMP" configuration="NOMINAL" state="Operational"/></Mode></Mission>'
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        files = {"subsystems/lamp/CMakeLists.txt": "hirosco_subsystem(hirosco-lamp SOURCES lamp.cpp)\n", "subsystems/lamp/lamp.xml": '<Subsystem name="LAMP"/>',
                 "subsystems/README.md": BEGIN + END, "missions/light/mission.xml": mission, "tests/dark/dark.xml": mission,
                 "tests/dark/dark_test.cpp": '"missions/light/mission.xml" "dark.xml"'}
        for path, text in files.items():
            put(root / path, text)
        assert len(list(problems(root, {}))) == 1, list(problems(root, {}))
        settle(root, {})
        assert "| `hirosco-lamp` | light (NOMINAL) | dark/dark.xml (NOMINAL) |" in (root / "subsystems/README.md").read_text()
        for path, wrong in (("missions/light/mission.xml", mission.replace("Operational", "PreOperational")),
                            ("tests/dark/dark.xml", mission.replace("hirosco-lamp", "hirosco-rogue-lamp")),
                            ("tests/dark/dark.xml", mission.replace("NOMINAL", "BRIGHT")),
                            ("tests/dark/dark_test.cpp", '"dark.xml"'), ("tests/dark/dark_test.cpp", '"missions/light/mission.xml"')):
            put(root / path, wrong)
            assert list(problems(root, {})), wrong
            put(root / path, files[path])
        assert not list(problems(root, {}))
        self_test_of_a_second_program(root, files, mission)
        for path in ("dark.xml", "dark_test.cpp"):
            put(root / "subsystems/lamp/tests" / path, files["tests/dark/" + path].replace("../../subsystems/lamp", ".."))
            (root / "tests/dark" / path).unlink()
        settle(root, {})
        assert "| light (NOMINAL) | subsystems/lamp/tests/dark.xml (NOMINAL) |" in (root / "subsystems/README.md").read_text()


def self_test_of_a_second_program(root, files, mission):
    """One that flies says nothing of another one of its folder, and a reason holds as long as it is true. `root` is as it was in the end."""
    lists, name = root / "subsystems/lamp/CMakeLists.txt", "hirosco-red-lamp"
    put(lists, files["subsystems/lamp/CMakeLists.txt"] + f"hirosco_subsystem({name} SOURCES red.cpp)\n")
    unflown = [line for line in problems(root, {}) if f"flies {name}: " in line]
    assert len(unflown) == len(KINDS), unflown
    put(root / "tests/dark/dark.xml", mission.replace("hirosco-lamp", name))
    put(root / "tests/dark/both.xml", mission)
    put(root / "tests/dark/dark_test.cpp", files["tests/dark/dark_test.cpp"] + ' "both.xml"')
    reason = {("missions", name): "it is for tests"}
    settle(root, reason)
    assert f"| `{name}` | it is for tests | dark/dark.xml (NOMINAL) |" in (root / "subsystems/README.md").read_text()
    for wrong in ({}, {("tests", name): "it is not flown"}, {**reason, ("tests", name): "it is not flown"}, {**reason, ("missions", "hirosco-lamp"): "it is not flown"},
                  {**reason, ("missions", "hirosco-torch"): "it is gone"}):
        assert any("table" not in line for line in problems(root, wrong)), wrong
    (root / "tests/dark/both.xml").unlink()
    for path in ("subsystems/lamp/CMakeLists.txt", "tests/dark/dark.xml", "tests/dark/dark_test.cpp"):
        put(root / path, files[path])
    settle(root, {})


def put(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def settle(root, reasons):
    """Makes the table, and there is nothing else to mend."""
    (root / "subsystems/README.md").write_text(written(root, flights(root), reasons))
    assert not list(problems(root, reasons)), list(problems(root, reasons))


def main():
    self_test()
    if sys.argv[1:] == ["--write"]:
        (ROOT / "subsystems/README.md").write_text(written(ROOT, flights(ROOT), not_flown(ROOT)))
    found = list(problems(ROOT, not_flown(ROOT)))
    for problem in found:
        print(problem)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
