#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each rule of the judge and each of its exemptions has a small flight of its own: one that breaks the rule and is found, and
the same within the exemption, which is not. At the end: no line of the rules was left out."""
import inspect, sys, tempfile

from judge_flight import MISSION, S, Written
from judge_cases import CASES
import coupling_rules, exchange_rules, judge, packet_rules, record, retrieval_rules, rules, succession_rules
import judge_cases_couplings, judge_cases_exchanges, judge_cases_packets, judge_cases_permits, judge_cases_retrieval, judge_cases_stays, judge_cases_stops, judge_cases_succession, judge_cases_world  # noqa: F401  (cases register themselves)

MODULES = (rules, packet_rules, retrieval_rules, succession_rules, coupling_rules, exchange_rules)
RULES = {rule.__name__: rule for table in (rules.WORLD, packet_rules.PACKETS, retrieval_rules.RETRIEVALS, succession_rules.SUCCESSIONS,
                                             coupling_rules.COUPLINGS, exchange_rules.EXCHANGES) for each in table.values() for rule in each}

# --- who counts as struck --------------------------------------------------------------------------------------------------
SPANS = [
    ("a kill until a second after it came back", ["alive JOYSTICK 0 at 1.0", "did kill JOYSTICK at 1.0", "alive JOYSTICK 1 at 2.0"],
     "JOYSTICK", [(1.0, 3.0)]),
    ("a kill for ever where it never came back", ["did kill JOYSTICK at 1.0", "alive JOYSTICK 0 at 1.0"], "JOYSTICK", [(1.0, 5.000001)]),
    ("a spin holds up everybody until the culprit is gone", ["did spin JOYSTICK at 1.0", "alive JOYSTICK 0 at 2.0"],
     "MANIPULATOR", [(1.0, 2.1)]),
    ("a stop until it goes on", ["did stop JOYSTICK at 1.0", "did stop JOYSTICK at 1.2", "did go JOYSTICK at 1.5"],
     "JOYSTICK", [(1.0, 1.6)]),
    ("who never went on, until calm", ["did stick JOYSTICK at 1.0", "calm at 4.0"], "JOYSTICK", [(1.0, 4.1)]),
    ("letting go of who was not stopped", ["did go JOYSTICK at 1.0", "did unstick JOYSTICK at 1.0"], "JOYSTICK", []),
    ("a strain until its cycles are made", ["did strain JOYSTICK 10 1000 at 1.0", "cycles JOYSTICK=5 at 0.9", "cycles JOYSTICK=10 at 1.1",
                                             "cycles JOYSTICK=20 at 1.2"], "JOYSTICK", [(1.0, 2.21)]),
    ("a strain over a new count", ["did strain JOYSTICK 10 1000 at 1.0", "cycles JOYSTICK=90 at 1.1", "cycles JOYSTICK=3 at 1.2",
                                   "cycles JOYSTICK=9 at 1.3", "cycles JOYSTICK=10 at 1.4"], "JOYSTICK", [(1.0, 2.41)]),
    ("a fault of a device until a second after it was healed", ["did fault joystick silent at 1.0", "did fault joystick heal at 1.5"],
     "JOYSTICK", [(1.0, 2.5)]),
    ("the device too", ["did fault joystick unplug at 1.0", "did fault joystick plug at 1.5"], "joystick", [(1.0, 2.5)]),
    ("healing what was only unplugged", ["did fault joystick unplug at 1.0", "did fault joystick heal at 1.5", "calm at 3.0"],
     "JOYSTICK", [(1.0, 4.0)]),
    ("a hand is no fault", ["did fault joystick hand wander at 1.0", "did fault robot hook 2 at 1.0"], "JOYSTICK", []),
    ("a fault of the log until after calm", ["did log full at 1.0", "calm at 4.0"], "LOG", [(1.0, 4.3)]),
    ("nobody supervises, until a second after another one does", ["did kill SUPERVISOR 300 at 1.0", "supervised 0 at 1.0", "supervised 1 at 1.3"],
     "SUCCESSION", [(1.0, 2.3)]),
    ("a supervisor that is killed is no member", ["did hang SUPERVISOR 5000 at 1.0", "supervised 0 at 1.0"], "SUPERVISOR", []),
    ("a flood for a second", ["did flood ground valid 100 at 1.0"], "FLOOD", [(1.0, 2.0)]),
]


def struck(problems):
    for says, lines, who, expected in SPANS:
        w = Written()
        for line in lines:
            text, seconds = line.rsplit(" at ", 1)
            w.at(round(float(seconds) * S), text)
        spans = [(start / S, end / S) for start, end in w.read().victims()[who]]
        if spans != expected:
            problems.append(f"{says}: {who} is struck in {spans}, not {expected}")


# --- all of it ---------------------------------------------------------------------------------------------------------------
def lines_of(module):
    """Numbers of the lines within the module's functions."""
    found = set()

    def walk(code):
        for constant in code.co_consts:
            if inspect.iscode(constant):
                found.update(line for _, _, line in constant.co_lines() if line and line != constant.co_firstlineno)
                walk(constant)
    walk(compile(inspect.getsource(module), module.__file__, "exec"))
    return found


def main():
    problems, reached = [], {module.__file__: set() for module in (*MODULES, record)}

    def trace(frame, what, _):
        if frame.f_code.co_filename not in reached:
            return None
        if what == "line":
            reached[frame.f_code.co_filename].add(frame.f_lineno)
        return trace

    sys.settrace(trace)
    for each in CASES:
        written = Written(each.mission)
        each.build(written)
        flight = written.read()
        said = [text for _, text in RULES[each.rule](flight, flight.victims())]
        good = any(each.found in text for text in said) if each.found else not said
        if not good:
            problems.append(f"{each.rule}, {each.build.__name__}: expected {each.found or 'nothing'!r}, judged {said}")
    struck(problems)
    whole = judge.judge
    sys.settrace(None)
    for rule in RULES:
        wants = {bool(each.found) for each in CASES if each.rule == rule}
        if wants != {True, False}:
            problems.append(f"{rule} has no case that is found, or none that is not")
    for module in MODULES:
        for line in sorted(lines_of(module) - reached[module.__file__]):
            problems.append(f"no case reaches {module.__name__}.py:{line}: {inspect.getsource(module).splitlines()[line - 1].strip()}")
    endless = Written().without("end")
    problems += ends(whole, endless)
    print("\n".join(problems) if problems else f"{len(CASES)} cases of {len(RULES)} rules, each as it should be")
    return 1 if problems else 0


def ends(whole, endless):
    """A flight without an end is a violation by itself; a quiet one is none, nor is one that loses its supervisor, whatever rule looks at it."""
    lost = Written().at(2 * S, "did kill SUPERVISOR 300", "supervised 0").at(2_300_000, "supervised 1")
    lost.at(3 * S, "did hang SUPERVISOR 50", "supervised 0").at(3_050_000, "supervised 1")
    found = []
    for written, wanted in ((endless, [["I1", 0.05, "the flight has no end"]]), (Written(), []), (lost, [])):
        with tempfile.TemporaryDirectory() as folder:
            written.write(folder)
            said = whole(MISSION, folder)["violations"]
        if said != wanted:
            found.append(f"a whole flight: expected {wanted}, judged {said}")
    return found


if __name__ == "__main__":
    sys.exit(main())
