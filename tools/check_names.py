#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The framework knows no mission, no subsystem and no simulated device by name (adr 0054). Prints where it does, and says it of
itself once for each kind of place, to be caught.

Nor does a folder or file of tests/, templates/ or bench/ bear one: tests of one mission, subsystem or device alone stand in its own folder, as
tests/ (adr 0198), and what is of several is called by what it tests (adr 0212).

Names are those of the folders in missions/, subsystems/ and simulation/devices/, of a folder of simulation/ that makes a device by itself, and of the programs that these folders make. One is found wherever
it is a word of a path, an identifier, a text or a comment, however written: for a folder `lamp` these are lamp, lamps, LAMP_LOST, LampData and hirosco-lamp.
A name that docs/glossary.md has under "Names that are words, too" may be said in prose and be part of an identifier. It is found
where only the name can be meant: in capitals, as a program or package (hirosco-NAME, hirosco-sim-NAME, hirosco-world-NAME), as a path (subsystems/NAME).
What is read of the framework is every file in its folders, in the root of the repository and right in the homes of those names, whatever it is called, but for documentation. Who names one all the same, and
why, is a row of KNOWN (adr 0224); one that names nobody any more is told, too.
The code of a subsystem or a simulated device names no mission, and no other of them either (its tests and descriptors may: who is flown with whom is theirs). Its descriptors,
models and scripts, what builds and helps its tests, and what files of its folder are called, name no mission: who flies it says where its devices are. Nor does the folder of a mission name another one. What the
descriptors of its folder call its own devices, links and parameters are words of its own, whoever else is called so.
Documentation (.md) may show the demonstrator, and so may what stands in tests/, bench/ or a folder of its own; tests beside the
framework's code use names of nobody (ARM, LAMP, PROBE): where one of these is a word, too, only a program of the name is meant by it."""
import fnmatch, functools, pathlib, re, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
HOMES = ("missions", "subsystems", "simulation/devices")
WORLDS = "simulation"  # a folder of it may make a device by itself
FRAMEWORK = ("hirosco", "robotics", "supervisor", "simulation", "ground", "tools", "cmake", ".ci")
OUTSIDE = {"node_modules", "__pycache__", "build", "dist"}  # folders
NOBODY = {"arm", "lamp", "probe"}
PART = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
TABLE = re.compile(r"^KNOWN = \(\n.*?^\)\n", re.M | re.S)
KNOWN = (
    ("rokviss", "missions/usual", "the word by which the usual mission is chosen (adr 0054)"),
    ("robot", "simulation/devices/joystick/joystick_device.cpp", "a hand that leads the arm goes by the arm's world (simulation/README.md)"),
    ("mujoco", "tools/fetch_mujoco", "fetches the physics of that world, which no package of a distribution has"),
    ("mujoco", "tools/packages/", "packs that world by itself, as its physics is fetched when it is installed (adr 0129)"),
    ("mujoco", "tools/portable/cross", "leaves that world out: what is fetched is this computer's"),
)
PROGRAM = re.compile(r"\bhirosco_(?:subsystem|device)\(\s*hirosco-(?:sim-)?([\w-]+)\s")


@functools.cache
def ignored(root):
    """Of names of files that git leaves out."""
    lists = root / ".gitignore"
    return [line for line in (lists.read_text().splitlines() if lists.exists() else []) if line and "#" not in line and "/" not in line]


def kept(path, root):
    """A file that somebody wrote: none of a folder that a build makes. A program may be called `build`."""
    return path.is_file() and not OUTSIDE & set(path.relative_to(root).parts[:-1]) and not any(fnmatch.fnmatch(path.name, name) for name in ignored(root))


def text_of(path):
    return path.read_text(errors="replace")


def owned(root=ROOT, homes=HOMES):
    """Folders that may bear a name: (home, folder)."""
    for home in homes:
        if (root / home).is_dir():
            yield from ((home, path) for path in sorted((root / home).iterdir()) if path.is_dir())
    for path in sorted((root / WORLDS).glob("*/CMakeLists.txt")):
        if PROGRAM.search(path.read_text()):
            yield WORLDS, path.parent


def within(folder):
    """The programs that this folder makes, but for those of its tests."""
    lists = [path for path in sorted(folder.rglob("CMakeLists.txt")) if "tests" not in path.relative_to(folder).parts]
    return [name.replace("-", "_") for path in lists for name in PROGRAM.findall(path.read_text())]


def named(root=ROOT):
    """Those that are built or flown."""
    return [path for _, path in owned(root) if (path / "CMakeLists.txt").exists() or (path / "mission.xml").exists()]


def names(root=ROOT):
    return sorted({path.name for path in named(root)} | {name for path in named(root) for name in within(path)})


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
        if re.search(rf"\bhirosco-(sim-|mission-|world-)?{one}\b", line):
            return True
        return name not in NOBODY and bool(re.search(rf"(?<![A-Z]){one.upper()}(?![A-Z])|\b({'|'.join(HOMES)}|{WORLDS})/{one}\b", line))
    parts, several = parts_of(line), [*wanted[:-1], plural(wanted[-1])]
    return any(parts[i:i + len(wanted)] in (wanted, several) for i in range(len(parts)))


def found(texts, every, words):
    for path, text in texts.items():
        for number, line in enumerate([path, *text.splitlines()]):
            told = [name for name in every if says(line, name, name in words)]
            if told:
                yield f"{path}:{number}: {', '.join(told)}: {line.strip()[:110]}"


def framework(root=ROOT):
    """Its texts, the lists that stand right in the homes among them."""
    theirs = set(named(root))
    files = [path for part in FRAMEWORK for path in sorted((root / part).rglob("*"))]
    files += [path for place in (root, *(root / home for home in HOMES[:2])) if place.is_dir() for path in sorted(place.iterdir())]
    for path in files:
        if path.suffix != ".md" and not theirs & set(path.parents) and kept(path, root):
            yield path.relative_to(root).as_posix(), TABLE.sub("", text_of(path))


def not_known(lines, known=KNOWN):
    """Of what was found, and of the rows of those who are known to name somebody, what is left."""
    used = set()
    for line in lines:
        path, told = line.split(":", 1)[0], line.split(": ", 2)[1].split(", ")
        rows = {row for row in known if row[0] in told and (path.startswith(row[1]) if row[1].endswith("/") else path == row[1])}
        used |= rows
        if set(told) - {row[0] for row in rows}:
            yield line
    yield from (f"{place} does not name {name} any more: its row in KNOWN can go" for name, place, _ in known if not any(row[:2] == (name, place) for row in used))


def in_homes(theirs, every, words):
    """Not its path: that has the names of its own home."""
    yield from (line for line in found(theirs, every, words) if ":0: " not in line)


CODE = (".c", ".h", ".cpp", ".hpp", ".py", ".txt", ".cmake")
OWN_WORD = re.compile(r'\bname="([^"]+)"')


def homes(root=ROOT):
    """The code of each folder of its own, without its own name and words: (path, text)."""
    for home, folder in owned(root, HOMES[1:]):
        own = {word for path in folder.rglob("*.xml") if "tests" not in path.relative_to(folder).parts for word in OWN_WORD.findall(path.read_text())}
        mine = [*within(folder), folder.name]
        programs = "|".join(name.replace("_", "[-_]") for name in mine)
        hidden = re.compile("|".join([rf"\b{re.escape(word)}\b" for word in sorted(own, key=len, reverse=True)] + [rf"\bhirosco-(?:sim-)?(?:{programs})\b|\b{home}/{folder.name}\b"]))
        # A folder may have the name of one in another home: the robot's device and what a subsystem calls it. Nobody's is a part of other names, and not taken out of them.
        names_here = re.compile("|".join("[-_ ]?".join(name.split("_")) for name in mine if name == folder.name or name not in NOBODY), re.I)
        for path in sorted(folder.rglob("*")):
            if path.suffix in CODE and "_test." not in path.name and not {"testing", "tests"} & set(path.relative_to(root).parts) and kept(path, root):
                yield path.relative_to(root).as_posix(), names_here.sub("", hidden.sub("", text_of(path)))


MISSIONLESS = (".xml", ".urdf", ".script")


def missions(root=ROOT):
    """Of folders of missions that are nothing else besides."""
    others = {path.name for _, path in owned(root, HOMES[1:])}
    return sorted(path.name for path in (root / HOMES[0]).iterdir() if (path / "mission.xml").exists() and path.name not in others)


def naming_missions(root=ROOT):
    """What a folder of its own says of a mission, in what is no code, and in the names of all its files."""
    every = missions(root)
    for path in (path for _, folder in owned(root, HOMES[1:]) for path in sorted(folder.rglob("*"))):
        if not kept(path, root) or "_test." in path.name or "testdata" in path.parts:
            continue
        helps_tests = "tests" in path.relative_to(root).parts and path.suffix in CODE
        text = text_of(path) if path.suffix in MISSIONLESS or helps_tests else ""
        yield from found({path.relative_to(root).as_posix(): text}, every, set())


def among_missions(root=ROOT):
    """What the folder of a mission says of another one."""
    every = missions(root)
    for name in every:
        for path in sorted((root / HOMES[0] / name).rglob("*")):
            if path.suffix != ".md" and kept(path, root):
                yield from found({path.relative_to(root).as_posix(): text_of(path)}, [other for other in every if other != name], set())


NAMELESS = ("tests", "templates", "bench")


def bearing_names(every, words, root=ROOT):
    """Folders and files of these that bear a name. One of tests/ that is called by a word, which is a name, too, means it."""
    held = {place for part in NAMELESS for path in (root / part).rglob("*") if kept(path, root)
            for place in (path.relative_to(root), *path.relative_to(root).parents)}
    for place in sorted(held):
        called = place.name.partition(".")[0]
        if told := [name for name in every if called == name and place.parts[0] == NAMELESS[0] or says(called, name, name in words)]:
            yield f"{place.as_posix()}: {', '.join(told)}: what is of one alone stands in its own folder, as tests/, and other names say what is tested"


# `lamp` is a name, `beam` and `probe` are words, too, the second one of nobody's. The first must be found in each of these, the others in none.
CAUGHT = ["the lamp", "LAMP_LOST", "class LampData", '"LAMP.LEVEL"', "hirosco-lamp", "lamp_test", "two lamps", "of LAMPS", "spare lamp batteries", 'name="Lamp"', "hirosco-beam", "hirosco-sim-beam", "hirosco-world-beam",
          "subsystems/beam/beam.hpp", "simulation/beam", '"BEAM"', "BEAM_LOST", "<Mission name='BEAM'>", "hirosco-probe"]
SPARED = ["a beam of light", "class BeamView", "beam_width", "lampshade", "two beams", "BEAMS", "clamp", "CLAMP", "a probe", '"PROBE"', "PROBE_LOST", "missions/probe.xml"]


def plant(root, files):
    for path, text in files.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)


def self_test():
    """What is wrong with this program itself."""
    planted = {f"hirosco/{i}.cpp": text for i, text in enumerate(CAUGHT + SPARED)}
    seen = {line.partition(":")[0] for line in found(planted, ["lamp", "lamp_battery", "beam", "probe"], {"beam", "probe"})}
    yield from (f"planted and not seen: {text}" for path, text in planted.items() if text in CAUGHT and path not in seen)
    yield from (f"seen and no name: {text}" for path, text in planted.items() if text in SPARED and path in seen)
    with tempfile.TemporaryDirectory() as made:
        # As in a checkout that somebody keeps in a folder called `build`.
        yield from planted_names(pathlib.Path(made) / "build")
    with tempfile.TemporaryDirectory() as made:
        yield from planted_framework(pathlib.Path(made) / "build")


def planted_names(root):
    plant(root, {"subsystems/beam/beam.xml": '<Device name="LAMP"/>', "simulation/devices/lamp/lamp.cpp": "of the shed", "subsystems/beam/beam.cpp": 'use_device("LAMP"); // beam',
                 "subsystems/beam/lit.cpp": "class LampView", "subsystems/beam/dark.c": "lamps", "simulation/pond/CMakeLists.txt": "hirosco_device(hirosco-sim-pond SOURCES module.cpp)",
                 "simulation/pond/fish.cpp": "of a lamp, by hirosco-sim-pond"})
    caught = {line.partition(":")[0] for line in in_homes(dict(homes(root)), ["lamp", "beam", "shed", "pond"], {"pond"})}
    if caught != {"subsystems/beam/lit.cpp", "subsystems/beam/dark.c", "simulation/devices/lamp/lamp.cpp", "simulation/pond/fish.cpp"}:
        yield f"planted in folders of their own, and seen in {sorted(caught)}"
    plant(root, {"missions/shed/mission.xml": "<Mission/>", "subsystems/beam/shed.urdf": "", "subsystems/beam/more.xml": '<Endnode address="shed-beam"/>', "subsystems/beam/testdata/some.xml": "<!-- of the shed -->",
                 "subsystems/beam/tests/CMakeLists.txt": "hirosco_test(shed_flown)", "subsystems/beam/tests/lit_test.py": "shed", "simulation/devices/lamp/lamp.xml": "<!-- nobody's -->",
                 "simulation/pond/shed": ""})
    said = {line.partition(":")[0] for line in naming_missions(root)}
    if said != {"subsystems/beam/shed.urdf", "subsystems/beam/more.xml", "subsystems/beam/tests/CMakeLists.txt", "simulation/pond/shed"}:
        yield f"missions planted in folders of their own, and seen in {sorted(said)}"
    # Of its programs one is made of a file of another name, one by a list further within, one by its tests.
    plant(root, {"missions/hut/mission.xml": "<Mission/>", "missions/hut/flown.cpp": "as in the shed", "missions/hut/README.md": "as in the shed", "missions/hut/door.rules": "of the shed",
                 "subsystems/beam/CMakeLists.txt": "hirosco_subsystem(hirosco-wide-beam SOURCES wide/module.cpp DEPENDS a)\nhirosco_subsystem(hirosco-beam SOURCES module.cpp)\n"
                                                   "hirosco_subsystem(hirosco-narrow SOURCES narrow_module.cpp)",
                 "subsystems/beam/deep/CMakeLists.txt": "hirosco_device(hirosco-sim-glow\n  SOURCES glow.cpp)", "subsystems/beam/tests/CMakeLists.txt": "hirosco_subsystem(hirosco-tried SOURCES a.cpp)"})
    if (others := {line.partition(":")[0] for line in among_missions(root)}) != {"missions/hut/flown.cpp", "missions/hut/door.rules"}:
        yield f"a mission planted in another one's folder, and seen in {sorted(others)}"
    if (there := names(root)) != ["beam", "glow", "hut", "narrow", "pond", "shed", "wide_beam"]:
        yield f"modules planted within folders, and the names are {there}"
    plant(root, dict.fromkeys(("tests/beam/a.py", "tests/lit/lamp_in_sun/a.xml", "tests/beams/a.py", "tests/lit/lamp_test.py", "tests/lit/beam_width_test.py", "tests/lamp/__pycache__/a.pyc",
                               "templates/part/two_lamps.xml", "templates/beam/a.xml", "bench/lampshade.cpp"), ""))
    if (bearing := {line.partition(":")[0] for line in bearing_names(["lamp", "beam"], {"beam"}, root)}) != {
            "tests/beam", "tests/lit/lamp_in_sun", "tests/lit/lamp_test.py", "templates/part/two_lamps.xml"}:
        yield f"names planted in places of tests, templates and bench, and seen in {sorted(bearing)}"


def planted_framework(root):
    """In files of every kind, wherever one may stand."""
    caught = ["run", ".rules", ".gitignore", "tools/packages/build", "tools/portable/build", "tools/packages/a.install", "tools/packages/a.postinst", "tools/packages/a.postrm", "tools/packages/a@.service", "cmake/module.map",
              "tools/packages/a.docs", "hirosco/descriptor/rows.csv", "ground/a.c", ".ci/run", "missions/CMakeLists.txt", "subsystems/CMakeLists.txt", "simulation/devices/CMakeLists.txt", "simulation/CMakeLists.txt",
              "simulation/devices/shared.cpp", "cmake/both"]
    spared = ["README.md", "tools/README.md", "tools/build/made.cpp", "ground/web/node_modules/a.js", "docs/safety/rows.csv", "missions/hut/run", "subsystems/lamp/lamp.cpp", "simulation/pond/lamp.cpp", "build/a.cpp", "flight.db"]
    plant(root, dict.fromkeys(caught + spared, "as in the lamp") | {".gitignore": "# a lamp\n*.db\n"})
    plant(root, dict.fromkeys(("missions/hut/mission.xml", "subsystems/lamp/CMakeLists.txt"), "") | {"simulation/pond/CMakeLists.txt": "hirosco_device(hirosco-sim-pond SOURCES module.cpp)",
                                                                                                        "cmake/both": "the lamp of the hut"})
    lines = list(found(dict(framework(root)), names(root), set()))
    if (seen := {line.partition(":")[0] for line in lines}) != set(caught):
        yield f"planted in the framework, and seen otherwise in {sorted(seen ^ set(caught))}"
    rows = (("lamp", "run", "-"), ("lamp", "tools/packages/", "-"), ("hut", "tools/portable/build", "-"), ("lamp", "check", "-"), ("lamp", "cmake/both", "-"))
    left = {line.partition(" does not")[0].partition(":")[0] for line in not_known(lines, rows)}
    if left != {path for path in caught if path != "run" and not path.startswith("tools/packages/")} | {"check", "tools/portable/build"}:
        yield f"who is known to name somebody was taken out, and left are {sorted(left)}"


if __name__ == "__main__":
    ours, every, words = dict(framework()), names(), words_too()
    wrong = [*self_test(), *(f"the glossary has a word that is no name: {word}" for word in words - set(every) - {"word", "---"})]
    sys.exit("\n".join([*not_known([*found(ours, every, words), *in_homes(dict(homes()), every, words)]), *naming_missions(), *among_missions(), *bearing_names(every, words), *wrong])
             or ("no files" if not ours or not every else None))
