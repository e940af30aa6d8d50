#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""judge.py MISSION FOLDER: reads log.txt and trace.txt of a flight and the descriptors, prints what does not hold, as JSON:
{"violations": [[invariant, seconds, text]], "commands": {cell: n}, "faults": {cell: n}}. Exit code 1 with violations."""
import collections, json, sys

from coupling_rules import COUPLINGS
from descriptors import STATES, read_mission
from exchange_rules import EXCHANGES
from packet_rules import PACKETS
from record import Record
from retrieval_rules import RETRIEVALS
from rules import WORLD
from succession_rules import SUCCESSIONS

MOST_TOLD = 5  # of one invariant in one flight


def commands_covered(flight):
    """State of the addressee | kind | origin of each telecommand that was sent; the supervisor's own are in the log."""
    cells = collections.Counter()
    def count(time, origin, apid, service, subtype, function):
        addressee = flight.mission.by_apid(apid)
        if addressee is None or addressee.name not in flight.state:
            state = "Operational" if addressee else "none"
        else:
            state = STATES[flight.state[addressee.name].at(time)] if flight.alive[addressee.name].at(time) else "dead"
        known = {"SET_STATE", "CONFIGURE", *(f for s in [flight.mission.supervisor, *flight.mission.members] for f in s.functions)}
        kind = (function if function in known else "unknown") if service == 8 and subtype == 1 else f"{service}.{subtype}"
        cells[f"{state}|{kind}|{origin}"] += 1
    for sent in flight.sent:
        count(sent.time, sent.origin, sent.apid, sent.service, sent.subtype, sent.function)
    for record in flight.log:
        if record.kind == "telecommand-received" and record.source == flight.mission.supervisor.apid and record.telecommand:
            tc = record.telecommand
            count(record.time, "SUPERVISOR", tc.apid, tc.service, tc.subtype, tc.function)
    return cells


def faults_covered(flight):
    """Fault | state of the member it strikes | member."""
    cells = collections.Counter()
    for time, words in flight.did:
        verb, subject = words[0], words[1] if len(words) > 1 else ""
        if verb in ("tc", "raw"):
            continue
        fault = " ".join([verb, words[2]]) if verb in ("fault", "flood") else f"log {subject}" if verb == "log" else verb
        member = flight.mission.devices[subject][0] if verb == "fault" else subject
        if verb in ("log", "flood"):  # strikes everybody
            for name in flight.members:
                cells[f"{fault}|{STATES[flight.state[name].at(time - 1)]}|{name}"] += 1
        elif member in flight.state:
            cells[f"{fault}|{STATES[flight.state[member].at(time - 1)]}|{member}"] += 1
        else:
            cells[f"{fault}|Operational|{member}"] += 1
    return cells


def judge(mission, folder):
    flight = Record(mission, folder)
    victims = flight.victims()
    violations = []
    for name, rules in sorted({**WORLD, **PACKETS, **RETRIEVALS, **SUCCESSIONS, **COUPLINGS, **EXCHANGES}.items()):
        for rule in rules:
            for place, (time, text) in enumerate(rule(flight, victims)):
                if place == MOST_TOLD:
                    break
                violations.append([name, time / 1e6, text])
    if flight.mark("end") is None:
        violations.append(["I1", flight.end / 1e6, "the flight has no end"])
    return {"violations": violations, "commands": commands_covered(flight), "faults": faults_covered(flight)}


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    found = judge(read_mission(sys.argv[1]), sys.argv[2])
    print(json.dumps(found))
    sys.exit(1 if found["violations"] else 0)
