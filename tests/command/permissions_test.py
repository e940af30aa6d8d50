#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""permissions_test.py HIROSCO MISSION...: `hirosco permissions --csv` against what the mission's files say, read here by rules that
were written down apart from those on board: every sender, addressee and request, in every mode and each of the ten states. What can be asked of the framework's services, and by whom,
says the table of clauses in the README of each (hirosco/pus/st*/), which somebody wrote by hand and nothing makes."""
import csv, pathlib, re, subprocess, sys, typing, xml.etree.ElementTree as xml

STATES = ["Offline", "SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational", "ErrorOperational",
          "PostOperational", "HardwareDeinit", "SoftwareDeinit"]
SAFE, OPERATIONAL = 4, 5
ALWAYS, NEVER = set(range(10)), set()
# What a subsystem may ask the supervisor for, where a permit names it; SAFE_ALL in any case.
OF_SUPERVISOR = {"ENTER_MODE", "SAFE_ALL", "SET_MODE"}
ROOT = pathlib.Path(__file__).resolve().parents[2]
MODE, EVERYBODY, SUPERVISOR, GROUND, DECLARED = "whom the mode permits", "everybody, always", "the supervisor", "the ground, always", "subsystems, what they declare"


class Asked(typing.NamedTuple):
    by: str = MODE
    in_states: frozenset = frozenset(ALWAYS)
    of_supervisor: bool = False  # nobody else has the service


def services(home=ROOT / "hirosco/pus"):
    """{(type, subtype): by whom it is asked for} of the framework's services, as their READMEs say."""
    found = {}
    for folder in sorted(path for path in home.glob("st[0-9]*") if path.is_dir()):
        page = folder / "README.md"
        text = page.read_text()
        assert re.search(r"^\| T[CM]\[", text, re.M), f"{page} has no table of clauses"
        for service, subtype, words in re.findall(r"^\| TC\[(\d+),(\d+)\] \w+ \| [^|]+ \| ([^|]+) \|", text, re.M):
            said = re.fullmatch(rf"({MODE}|{EVERYBODY}|{SUPERVISOR}|{GROUND}|{DECLARED})(?:, in ((?:\w+)(?:, \w+)*))?(; of the supervisor)?", words)
            assert said, f"{page}: TC[{service},{subtype}] is asked for by '{words}', which is not one of the words that {pathlib.Path(__file__).name} knows"
            states = frozenset(map(STATES.index, said[2].split(", "))) if said[2] else frozenset(ALWAYS)
            found[int(service), int(subtype)] = Asked(said[1], states, said[3] is not None)
    return found


SERVICES = services()


def words(element, name):
    return (element.get(name) or "").split()


class Subsystem:
    def __init__(self, path, renamed=None):
        root = xml.parse(path).getroot()
        self.name = renamed or root.get("name")
        self.functions, self.requests, self.writable = {}, {}, {}
        for f in root.iter("Function"):
            states = {STATES.index(s) for s in words(f, "states")} if f.get("states") else {OPERATIONAL}
            self.functions[f.get("name")] = (states, f.get("essential") == "yes")
        for service in root.iter("CustomService"):
            for r in service.findall("Request"):
                states = {STATES.index(s) for s in words(r, "states")} if r.get("states") else {3, SAFE, OPERATIONAL, 6}
                self.requests[int(service.get("type")), int(r.get("subtype"))] = (r.get("name"), states)
        for p in root.find("Parameters") if root.find("Parameters") is not None else []:
            if p.get("writable"):
                self.writable[p.get("name")] = {STATES.index(s) for s in words(p, "writable")}
        own = {s.get("name"): int(s.get("type")) for s in root.iter("CustomService")} | {"ST03": 3, "ST05": 5, "ST20": 20}
        left_out = lambda uses: {own[u.get("name")]: u.get("offered") == "no" for u in uses}
        everywhere = left_out(root.findall("Service"))
        self.left_out = {"-": everywhere}
        for c in root.findall("Configuration"):
            self.left_out[c.get("name")] = everywhere | left_out(c.findall("Service"))
        self.commands = {c.get("subsystem"): set(words(c, "functions")) for c in root.findall("Commands")}
        # What the framework's services may be asked about, and what is heard: {whose: rows of the table}.
        self.things, self.heard = {}, {}
        for c in root.findall("Commands"):
            self.things[c.get("subsystem")] = (
                {(20, 3, f"set {p}") for p in words(c, "sets")} | {(20, 1, f"read {p}") for p in words(c, "reads")} |
                {(3, subtype, f"{does} {s}") for s in words(c, "housekeeping")
                 for subtype, does in ((5, "enable"), (6, "disable"), (27, "one shot of"), (31, "interval of"))} |
                {(5, subtype, f"{does} {e}") for e in words(c, "events") for subtype, does in ((5, "enable"), (6, "disable"))})
        for s in root.findall("Subscribes"):
            self.heard[s.get("subsystem")] = words(s, "housekeeping") + words(s, "events")


def read(mission, installed):
    root, base = xml.parse(mission).getroot(), mission.parent

    def at(text):
        return installed / text.removeprefix("@hirosco/") if text.startswith("@hirosco/") else base / text

    supervisor = Subsystem(at(root.find("Supervisor").get("descriptor")))
    members = []
    for s in root.findall("Subsystem"):
        member = Subsystem(at(s.get("descriptor")), s.get("name"))
        for c in s.findall("Commands"):
            member.commands[c.get("to")] = member.commands.pop(c.get("subsystem"))
            member.things[c.get("to")] = member.things.pop(c.get("subsystem"))
        for c in s.findall("Subscribes"):
            member.heard[c.get("to")] = member.heard.pop(c.get("subsystem"))
        members.append(member)
    return supervisor, members, root.find("Modes").findall("Mode")


def expected(sender, addressee, mode, service, subtype, request, supervisor, asked=Asked()):
    """States in which it is permitted, those in which it is forwarded past what waits, those that remain in a change of mode."""
    ground, on_board, to_supervisor = sender == "ground", sender is supervisor, addressee is supervisor
    function = request if service == 8 and " " not in request else None
    target = STATES.index(request.split()[1]) if request.startswith("SET_STATE ") else None
    plain = function or (addressee.requests.get((service, subtype), (None,))[0])
    if asked.of_supervisor and not to_supervisor:
        return NEVER, NEVER, NEVER
    if asked.by == DECLARED:
        # Only what its descriptor names is heard, and by subsystems only.
        names = {f"hear {what} of {whose}" for whose, all_ in getattr(sender, "heard", {}).items() for what in all_}
        return (ALWAYS, ALWAYS, ALWAYS) if request in names else (NEVER, NEVER, NEVER)
    if asked.by == GROUND:
        # What was said before goes down to ground: nobody else asks for it.
        return (ALWAYS, ALWAYS, ALWAYS) if ground else (NEVER, NEVER, NEVER)
    if asked.by == SUPERVISOR and not on_board:
        return NEVER, NEVER, NEVER
    if ground and to_supervisor and (target is not None or function == "CONFIGURE"):
        return NEVER, NEVER, NEVER
    if not ground and not on_board:
        declared = (plain in sender.commands.get(addressee.name, ()) or
                    (service, subtype, request) in sender.things.get(addressee.name, ()))
        if not declared and not (to_supervisor and function == "SAFE_ALL"):
            return NEVER, NEVER, NEVER
        if to_supervisor and service == 8 and function not in OF_SUPERVISOR:
            return NEVER, NEVER, NEVER
    # What is essential passes everywhere, whoever may ask for it at all.
    essential = NEVER
    of_subsystem = not ground and not on_board
    by_descriptor = addressee.functions.get(function, (None, False))[1] and not (of_subsystem and to_supervisor and function != "SAFE_ALL")
    if asked.by == EVERYBODY or by_descriptor:
        essential = ALWAYS
    elif target is not None and STATES[target] in ("ErrorOperational", "PostOperational"):
        essential = ALWAYS
    elif target == SAFE:
        essential = {OPERATIONAL}
    elif target == 0 and on_board:
        essential = ALWAYS
    if on_board:
        return ALWAYS, essential, ALWAYS
    # The rest is the mode's to open and the state's to permit.
    states = ALWAYS
    if function in addressee.functions:
        states = addressee.functions[function][0]
    elif (service, subtype) in addressee.requests:
        states = addressee.requests[service, subtype][1]
    else:
        states = set(asked.in_states)
    parameter = request.removeprefix("set ") if service == 20 and subtype == 3 else None
    if parameter is not None:
        states = addressee.writable.get(parameter, NEVER)
    ours = [p for p in mode.findall("Permit") if p.get("subsystem") in ("*", addressee.name) and
            (("ground" if ground else sender.name) in words(p, "from") if p.get("from") else not (of_subsystem and to_supervisor))]
    called = "SET_STATE" if target is not None else plain
    opened = any(str(service) in words(p, "services") or (called and {"*", called} & set(words(p, "functions"))) for p in ours)
    if parameter is not None:
        opened = any({"*", parameter} & set(words(p, "parameters")) for p in ours)
    bound = states if opened else NEVER
    acts = service == 8 or service >= 192 or parameter is not None or states != ALWAYS
    return bound | essential, essential, (NEVER if acts else bound) | essential


def places(text):
    assert len(text) == 10 and all(c in (".", str(i)) for i, c in enumerate(text)), text
    return {i for i, c in enumerate(text) if c != "."}


def things_of(sender, addressee, supervisor):
    """Rows of what one subsystem may ask the framework's services of another about, and of what it may hear."""
    if not isinstance(sender, Subsystem) or sender is supervisor:
        return set()
    asked = {row for row in sender.things.get(addressee.name, ()) if row[:2] != (20, 3)}
    if addressee is supervisor:
        asked |= {(129, 8, f"hear {what} of {whose}") for whose, all_ in sender.heard.items() for what in all_}
    return asked


def requests_of(addressee, seen_parameters, framework):
    """Everything that can be asked of it, as (service, subtype, its name in the table or None for a framework's request)."""
    asked = {(*key, None) for key in framework} - {(8, 1, None), (20, 3, None)}  # each function and each parameter by itself
    asked |= {(8, 1, f"SET_STATE {state}") for state in STATES} | {(8, 1, "CONFIGURE")}
    asked |= {(8, 1, name) for name in addressee.functions} | {(20, 3, f"set {name}") for name in seen_parameters}
    return asked | {(*key, None) for key in addressee.requests}


def told_by(hirosco, mission):
    table = subprocess.run([hirosco, "permissions", mission, "--csv"], capture_output=True, text=True, check=True).stdout
    return list(csv.DictReader(table.splitlines()))


def compare(rows, mission, installed, tampered=lambda modes, framework: None):
    supervisor, members, modes = read(mission, installed)
    framework = dict(SERVICES)
    tampered(modes, framework)
    everybody = {s.name: s for s in [supervisor, *members]}
    senders = {"ground", supervisor.name} | {m.name for m in members if m.commands or m.heard}
    assert {r["sender"] for r in rows} == senders and {r["mode"] for r in rows} == {m.get("name") for m in modes}
    cells, permitted, asked = 0, 0, {}
    for row in rows:
        mode = next(m for m in modes if m.get("name") == row["mode"])
        sender = "ground" if row["sender"] == "ground" else everybody[row["sender"]]
        service, subtype = int(row["service"]), int(row["subtype"])
        addressee = everybody[row["addressee"]]
        told = tuple(places(row[column]) for column in ("permitted", "essential", "in_change"))
        want = expected(sender, addressee, mode, service, subtype, row["request"], supervisor, framework.get((service, subtype), Asked()))
        # Whether something goes past what waits says nothing of what is refused.
        assert told == (want[0], want[1] & want[0], want[2]), f"{mission.parent.name}: {row}: expected {want}"
        not_in = [name for name, out in addressee.left_out.items() if out.get(service)]
        assert row["not_in"].split() == not_in, (mission.parent.name, row, not_in)
        own_name = service in (8, 20) and (service, subtype) != (20, 1)
        own_name = own_name or (service, subtype, row["request"]) in things_of(sender, addressee, supervisor)
        asked.setdefault((row["mode"], row["sender"], row["addressee"]), []).append(
            (service, subtype, row["request"] if own_name else None))
        cells, permitted = cells + 10, permitted + len(told[0])
    for m in modes:
        for s in senders:
            for a in everybody.values():
                got = asked[m.get("name"), s, a.name]
                parameters = {name.removeprefix("set ") for service, subtype, name in got if (service, subtype) == (20, 3)}
                assert parameters >= set(a.writable), (a.name, parameters)
                things = things_of(everybody.get(s), a, supervisor)
                assert len(got) == len(set(got)) and set(got) == requests_of(a, parameters, framework) | things, (m.get("name"), s, a.name)
    assert 0 < permitted < cells
    return cells, permitted


def permit_less(modes, _):
    """Takes one word from what one mode permits."""
    permit = next(p for m in reversed(modes) for p in m.findall("Permit") if "functions" in p.attrib)
    permit.set("functions", " ".join(permit.get("functions").split()[1:]))


def name_another(modes, _=None):
    """Whom one mode's permits name, another one is. False: none names anybody."""
    named = [p for m in modes for p in m.findall("Permit") if p.get("from")]
    for permit in named[:1]:
        permit.set("from", "NOBODY")
    return bool(named)


def without_a_service(_, framework):
    for key in [key for key in framework if key[0] == 17]:
        del framework[key]


def another_subtype(_, framework):
    framework[130, 3] = framework.pop((130, 2))


def asked_by_more(_, framework):
    framework[128, 1] = framework[128, 1]._replace(by=EVERYBODY)


def main():
    for mission in sys.argv[2:]:
        rows = told_by(sys.argv[1], ROOT / mission)
        cells, permitted = compare(rows, ROOT / mission, ROOT)
        named = name_another(read(ROOT / mission, ROOT)[2])
        trials = [("one word less", permit_less), ("a service less", without_a_service), ("another subtype", another_subtype), ("a request that more may ask for", asked_by_more)]
        for what, tampered in [*trials, *([("another sender", name_another)] if named else [])]:
            try:
                compare(rows, ROOT / mission, ROOT, tampered)
            except AssertionError:
                print(f"{mission}: {cells} cells, {permitted} permitted, all as its files say, and {what} is seen")
            else:
                sys.exit(f"{mission}: {what} in what it is read by is not seen")


main()
