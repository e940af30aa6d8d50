#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The framework knows no mission, no subsystem and no simulated device by name (adr 0054). Prints where it does, and says it of
itself once for each kind of place, to be caught.

Nor does a folder or file of tests/, templates/ or bench/ bear one: tests of one mission, subsystem or device alone stand in its own folder, as
tests/ (adr 0198), and what is of several is called by what it tests (adr 0212).

Names are those of the folders in missions/, subsystems/ and simulation/devices/, and of the programs that a folder further within makes of its module.cpp. One is found wherever it is a word of a path, an
identifier, a text or a comment, however written: for a folder `lamp` these are lamp, lamps, LAMP_LOST, LampData and hirosco-lamp.
A name that docs/glossary.md has under "Names that are words, too" may be said in prose and be part of an identifier. It is found
where only the name can be meant: in capitals, as a program (hirosco-NAME, hirosco-sim-NAME), as a path (subsystems/NAME).
The code of a subsystem or a simulated device names no mission, and no other of them either (its tests and descriptors may: who is flown with whom is theirs). Its descriptors,
models and scripts, what builds and helps its tests, and what files of its folder are called, name no mission: who flies it says where its devices are. Nor does the folder of a mission name another one. What the
descriptors of its folder call its own devices, links and parameters are words of its own, whoever else is called so.
Documentation (.md) may show the demonstrator, and so may what stands in tests/, bench/ or a folder of its own; tests beside the
framework's code use names of nobody (ARM, LAMP, PROBE)."""
import pathlib, re, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
HOMES = ("missions", "subsystems", "simulation/devices")
FRAMEWORK = ("hirosco", "robotics", "supervisor", "simulation", "ground", "tools", "cmake")
TEXTS = (".cpp", ".hpp", ".py", ".js", ".mjs", ".json", ".html", ".css", ".svg", ".urdf", ".xml", ".xsd", ".cmake", ".txt", ".in", "")
OUTSIDE = {"node_modules", "__pycache__", "build", "dist"}
PART = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


PROGRAM = re.compile(r"\bhirosco_(?:subsystem|device)\(hirosco-(?:sim-)?([\w-]+) SOURCES \w+/module\.cpp")


def within(folder):
    """The programs of modules in folders of this one."""
    lists = folder / "CMakeLists.txt"
    return [name.replace("-", "_") for name in PROGRAM.findall(lists.read_text())] if lists.exists() else []


def names(root=ROOT):
    """Of folders that are built or flown, and of the programs within."""
    folders = [path for home in HOMES if (root / home).is_dir() for path in (root / home).iterdir()
               if (path / "CMakeLists.txt").exists() or (path / "mission.xml").exists()]
    return sorted({path.name for path in folders} | {name for path in folders for name in within(path)})


def words_too():
    section = (ROOT / "docs/glossary.md").read_text().partition("## Names that are words, too\n")[2].partition("\n## ")[0]
    return {word.replace(" ", "_") for row in re.findall(r"^\| ([^|]+) \|", section, re.M) for word in row.split(", ")}


def parts_of(text):
    """The words of which identifiers and prose are made: LampData is two, and so is lamp_data."""
    return [part.lower() for part in PART.findall(text)]


def plural(word):
    return word[:-1] + "ies" if word.endswith("y") else word + "es" if word.endswith(("s", "x", "ch")) else word + "s"


def says(line, name, is_word):
    wanted = name.split("_")
    if any(part.removesuffix("y") not in line.lower() for part in wanted):
        return False  # most lines, told in a tenth of the time
    if is_word:
        one = "[-_]".join(map(re.escape, wanted))
        return bool(re.search(rf"(?<![A-Z]){one.upper()}(?![A-Z])", line)
                    or re.search(rf"\bhirosco-(sim-|mission-)?{one}\b|\b({'|'.join(HOMES)})/{one}\b", line))
    parts, several = parts_of(line), [*wanted[:-1], plural(wanted[-1])]
    return any(parts[i:i + len(wanted)] in (wanted, several) for i in range(len(parts)))


def found(texts, every, words):
    for path, text in texts.items():
        for number, line in enumerate([path, *text.splitlines()]):
            told = [name for name in every if says(line, name, name in words)]
            if told:
                yield f"{path}:{number}: {', '.join(told)}: {line.strip()[:110]}"


def framework(every):
    homes = [ROOT / home / name for home in HOMES for name in every]
    for part in FRAMEWORK:
        for path in sorted((ROOT / part).rglob("*")):
            if path.suffix in TEXTS and path.is_file() and not OUTSIDE & set(path.parts) and not any(home in path.parents for home in homes):
                yield path.relative_to(ROOT).as_posix(), path.read_text()


def in_homes(theirs, every, words):
    """Not its path: that has the names of its own home."""
    yield from (line for line in found(theirs, every, words) if ":0: " not in line)


CODE = (".cpp", ".hpp", ".py", ".txt")
OWN_WORD = re.compile(r'\bname="([^"]+)"')


def homes(root=ROOT):
    """The code of each folder of its own, without its own name and words: (path, text)."""
    for home in HOMES[1:]:
        for folder in sorted(path for path in (root / home).iterdir() if path.is_dir()):
            own = {word for path in folder.rglob("*.xml") if "tests" not in path.relative_to(folder).parts for word in OWN_WORD.findall(path.read_text())}
            hidden = re.compile("|".join([rf"\b{re.escape(word)}\b" for word in sorted(own, key=len, reverse=True)] + [rf"\b(?:{home}|simulation|hirosco-sim-{folder.name}|hirosco-{folder.name.replace('_', '-')})\b"]))
            # A folder may have the name of one in another home: the robot's device and what a subsystem calls it.
            names_here = re.compile("|".join("[-_ ]?".join(name.split("_")) for name in [*within(folder), folder.name]), re.I)
            for path in sorted(folder.rglob("*")):
                if path.suffix in CODE and path.is_file() and "_test." not in path.name and not (OUTSIDE | {"testing", "tests"}) & set(path.relative_to(root).parts):
                    yield path.relative_to(root).as_posix(), names_here.sub("", hidden.sub("", path.read_text()))


MISSIONLESS = (".xml", ".urdf", ".script")


def missions(root=ROOT):
    """Of folders of missions that are nothing else besides."""
    others = {path.name for home in HOMES[1:] for path in (root / home).iterdir()}
    return sorted(path.name for path in (root / HOMES[0]).iterdir() if (path / "mission.xml").exists() and path.name not in others)


def naming_missions(root=ROOT):
    """What a folder of its own says of a mission, in what is no code, and in the names of all its files."""
    every = missions(root)
    for home in HOMES[1:]:
        for path in sorted((root / home).rglob("*")):
            if not path.is_file() or OUTSIDE & set(path.parts) or "_test." in path.name or "testdata" in path.parts:
                continue
            helps_tests = "tests" in path.relative_to(root).parts and path.suffix in CODE
            text = path.read_text() if path.suffix in MISSIONLESS or helps_tests else ""
            yield from found({path.relative_to(root).as_posix(): text}, every, set())


def among_missions(root=ROOT):
    """What the folder of a mission says of another one."""
    every = missions(root)
    for name in every:
        for path in sorted((root / HOMES[0] / name).rglob("*")):
            if path.is_file() and path.suffix in (*TEXTS, *MISSIONLESS, ".csv") and not OUTSIDE & set(path.relative_to(root).parts):
                yield from found({path.relative_to(root).as_posix(): path.read_text()}, [other for other in every if other != name], set())


NAMELESS = ("tests", "templates", "bench")


def bearing_names(every, words, root=ROOT):
    """Folders and files of these that bear a name. One of tests/ that is called by a word, which is a name, too, means it."""
    held = {place for part in NAMELESS for path in (root / part).rglob("*") if path.is_file() and not OUTSIDE & set(path.relative_to(root).parts)
            for place in (path.relative_to(root), *path.relative_to(root).parents)}
    for place in sorted(held):
        called = place.name.partition(".")[0]
        if told := [name for name in every if called == name and place.parts[0] == NAMELESS[0] or says(called, name, name in words)]:
            yield f"{place.as_posix()}: {', '.join(told)}: what is of one alone stands in its own folder, as tests/, and other names say what is tested"


# `lamp` is a name, `beam` a word, too. The first must be found in each of these, the second in none.
CAUGHT = ["the lamp", "LAMP_LOST", "class LampData", '"LAMP.LEVEL"', "hirosco-lamp", "lamp_test", "two lamps", "of LAMPS", "spare lamp batteries", 'name="Lamp"', "hirosco-beam", "hirosco-sim-beam",
          "subsystems/beam/beam.hpp", '"BEAM"', "BEAM_LOST", "<Mission name='BEAM'>"]
SPARED = ["a beam of light", "class BeamView", "beam_width", "lampshade", "two beams", "BEAMS", "clamp", "CLAMP"]
if __name__ == "__main__":
    planted = {f"hirosco/{i}.cpp": text for i, text in enumerate(CAUGHT + SPARED)}
    seen = {line.partition(":")[0] for line in found(planted, ["lamp", "lamp_battery", "beam"], {"beam"})}
    wrong = [f"planted and not seen: {text}" for path, text in planted.items() if text in CAUGHT and path not in seen]
    wrong += [f"seen and no name: {text}" for path, text in planted.items() if text in SPARED and path in seen]
    ours, every, words = dict(framework(names())), names(), words_too()
    theirs = dict(homes())
    with tempfile.TemporaryDirectory() as made:
        for path, text in {"subsystems/beam/beam.xml": '<Device name="LAMP"/>', "simulation/devices/lamp/lamp.cpp": "of the shed",
                           "subsystems/beam/beam.cpp": 'use_device("LAMP"); // beam', "subsystems/beam/lit.cpp": "class LampView"}.items():
            (pathlib.Path(made) / path).parent.mkdir(parents=True, exist_ok=True)
            (pathlib.Path(made) / path).write_text(text)
        caught = {line.partition(":")[0] for line in in_homes(dict(homes(pathlib.Path(made))), ["lamp", "beam", "shed"], set())}
        for path, text in {"missions/shed/mission.xml": "<Mission/>", "subsystems/beam/shed.urdf": "", "subsystems/beam/more.xml": '<Endnode address="shed-beam"/>',
                           "subsystems/beam/testdata/some.xml": "<!-- of the shed -->", "subsystems/beam/tests/CMakeLists.txt": "hirosco_test(shed_flown)", "subsystems/beam/tests/lit_test.py": "shed", "simulation/devices/lamp/lamp.xml": "<!-- nobody's -->"}.items():
            (pathlib.Path(made) / path).parent.mkdir(parents=True, exist_ok=True)
            (pathlib.Path(made) / path).write_text(text)
        said = {line.partition(":")[0] for line in naming_missions(pathlib.Path(made))}
        if said != {"subsystems/beam/shed.urdf", "subsystems/beam/more.xml", "subsystems/beam/tests/CMakeLists.txt"}:
            wrong.append(f"missions planted in folders of their own, and seen in {sorted(said)}")
        for path, text in {"missions/hut/mission.xml": "<Mission/>", "missions/hut/flown.cpp": "as in the shed", "missions/hut/README.md": "as in the shed",
                           "subsystems/beam/CMakeLists.txt": "hirosco_subsystem(hirosco-wide-beam SOURCES wide/module.cpp DEPENDS a)\nhirosco_subsystem(hirosco-beam SOURCES module.cpp)"
                           }.items():
            (pathlib.Path(made) / path).parent.mkdir(parents=True, exist_ok=True)
            (pathlib.Path(made) / path).write_text(text)
        if (others := {line.partition(":")[0] for line in among_missions(pathlib.Path(made))}) != {"missions/hut/flown.cpp"}:
            wrong.append(f"a mission planted in another one's folder, and seen in {sorted(others)}")
        if (planted_names := names(pathlib.Path(made))) != ["beam", "hut", "shed", "wide_beam"]:
            wrong.append(f"a module planted within a folder, and the names are {planted_names}")
        for path in ("tests/beam/a.py", "tests/lit/lamp_in_sun/a.xml", "tests/beams/a.py", "tests/lit/lamp_test.py", "tests/lit/beam_width_test.py",
                     "tests/lamp/__pycache__/a.pyc", "templates/part/two_lamps.xml", "templates/beam/a.xml", "bench/lampshade.cpp"):
            (pathlib.Path(made) / path).parent.mkdir(parents=True, exist_ok=True)
            (pathlib.Path(made) / path).write_text("")
        if (bearing := {line.partition(":")[0] for line in bearing_names(["lamp", "beam"], {"beam"}, pathlib.Path(made))}) != {
                "tests/beam", "tests/lit/lamp_in_sun", "tests/lit/lamp_test.py", "templates/part/two_lamps.xml"}:
            wrong.append(f"names planted in places of tests, templates and bench, and seen in {sorted(bearing)}")
        if caught != {"subsystems/beam/lit.cpp", "simulation/devices/lamp/lamp.cpp"}:
            wrong.append(f"planted in folders of their own, and seen in {sorted(caught)}")
    wrong += [f"the glossary has a word that is no name: {word}" for word in words - set(every) - {"word", "---"}]
    sys.exit("\n".join([*found(ours, every, words), *in_homes(theirs, every, words), *naming_missions(), *among_missions(), *bearing_names(every, words), *wrong]) or ("no files" if not ours or not every else None))
