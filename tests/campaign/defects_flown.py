#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings as they were in the code. All are put back into a copy of the sources, which is built once; each is flown until
the judge sees it, and the same flights without it, of which the judge must say nothing. Nothing of them is ever in what flies.
defects_flown.py [--flights N] [--seed S] [FINDING...]"""
import argparse, os, pathlib, shutil, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "simulation" / "campaign")]
from campaign import Campaign, parse  # noqa: E402

SUPERVISION = "supervisor/supervision"
TELECOMMANDS, REACTIONS = f"{SUPERVISION}/data_handling/telecommands.cpp", f"{SUPERVISION}/event_handling/reactions.cpp"
STOPS, SHUTDOWN = f"{SUPERVISION}/event_handling/safe_all.cpp", f"{SUPERVISION}/modes/shutdown.cpp"
REFUSED = "return refused(pus::FailureCode::ExecutionError);"
CHOSEN = "HIROSCO_PLANTED_FINDING"  # which of them a flight has
# {finding: (invariant, [(file, as it is, as it was where the finding is chosen)])}
DEFECTS = {
    # States of the supervisor were anybody's to command, and SAFE_ALL a function that some of them do not permit.
    "SF1": ("I4", [
        (f"{SUPERVISION}/data_handling/permission.cpp", 'if (!asked.origin.is_supervisor() && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode',
         'if (!planted("SF1") && !asked.origin.is_supervisor() && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode'),
        (TELECOMMANDS, "apid == supervisor_apid && call ? at_once_", '!planted("SF1") && apid == supervisor_apid && call ? at_once_'),
        (STOPS, f'on_function("SAFE_ALL", []() -> Outcome {{ {REFUSED} }});',
         f'on_function("SAFE_ALL", [this]() -> Outcome {{ if (!planted("SF1")) {REFUSED}\n'
         '    craft_.guard.stop_all(); after_stop("SAFE_ALL"); return ok(); });'),
        (SHUTDOWN, f'on_function("SHUTDOWN", []() -> Outcome {{ {REFUSED} }});',
         f'on_function("SHUTDOWN", [this]() -> Outcome {{ if (!planted("SF1")) {REFUSED}\n    request(); return ok(); }});')]),
    # The stop was lifted when SET_STATE(Operational) was permitted, and what waited for the disk was forwarded whatever
    # had happened in between.
    "SF4": ("I4", [
        (TELECOMMANDS, "  std::string text = telecommand_text(*telecommand);",
         "  std::string text = telecommand_text(*telecommand);\n"
         '  if (planted("SF4") && decision->releases_stop && apid != supervisor_apid)\n'
         "    static_cast<void>(craft_.guard.release(apid, craft_.guard.fences(apid)));"),
        (TELECOMMANDS, "if (craft_.guard.fences(next->apid) != next->fences) {",
         'if (!planted("SF4") && craft_.guard.fences(next->apid) != next->fences) {'),
        (TELECOMMANDS, "if (releases_stop && !to_itself && !craft_.guard", 'if (!planted("SF4") && releases_stop && !to_itself && !craft_.guard')]),
    # Death was swallowed while a plan of the same severity ran. This mission's plans take the network down all the same;
    # it shows where the plan for high severity is milder.
    "SF5": ("I4", [
        (REACTIONS, ".of_loss = &subject == whose &&", '.of_loss = !planted("SF5") && &subject == whose &&'),
        ("missions/rokviss/mission.xml", '<When severity="high"/><Do action="shut_down_network"/>',
         '<When severity="high"/><Do action="set_state" state="SafeOperational"/>')]),
    # Recovery heard events as reports: one whose report was off was not heard.
    "SF6": ("I4", [
        ("hirosco/subsystem/service_loop/reports.cpp", "if (octets) backlog_.send(channel_, {.kind = MessageKind::Event",
         'if (octets && (!planted("SF6") || reported == pus::Reported::Yes)) backlog_.send(channel_, {.kind = MessageKind::Event'),
        # And ground could switch that of a loss off.
        (f"{SUPERVISION}/data_handling/permission.cpp", "    if (event->safety || (asked", '    if ((event->safety && !planted("SF6")) || (asked')]),
    # Nothing raised the epoch on the way up: a device that had latched on the way down stayed so.
    "SF14": ("I10", [
        ("supervisor/guard/guarded_member.cpp", "  permit->release();",
         '  if (planted("SF14")) {\n    permit->stop.store(0);\n    permit->go.store(permission_word(epoch));\n'
         "  } else {\n    permit->release();\n  }")]),
    # Nobody remembered what the dead had been asked.
    "NO_OUTCOME": ("I2", [
        (TELECOMMANDS, "for (const pus::Request& request : parts_.unanswered.take(apid))",
         'for (const pus::Request& request : planted("NO_OUTCOME") ? std::vector<pus::Request>{} : parts_.unanswered.take(apid))')]),
    # A device that had just begun obeyed what it was told first.
    "BEGINS": ("I4", [
        ("simulation/devices/obedience.cpp", "const bool begins = begins_ && declared_.actuator",
         'const bool begins = !planted("BEGINS") && begins_ && declared_.actuator')]),
    # An exchange moved a device's clock by at least one cycle, and the rest was forgotten.
    "OWN_CLOCK": ("I13", [
        ("simulation/devices/world_clock.cpp", "  if (!exchanged && behind < planned_step()) return 0;",
         '  if (exchanged && planted("OWN_CLOCK")) {\n    by_own_clock_ = false;\n    world_time_ = now;\n'
         "    return std::max<std::int64_t>(1, (behind + cycle_ / 2) / cycle_);\n  }\n"
         "  if (!exchanged && behind < planned_step()) return 0;")]),
}
HEADER = f"""#pragma once
#include <cstdlib>
#include <string_view>
inline bool planted(std::string_view finding) {{
  static const char* const chosen = std::getenv("{CHOSEN}");
  return chosen != nullptr && finding == chosen;
}}
"""


def misfits(root=ROOT):
    """Findings whose place in the code is gone: [text]. A defect that fits nowhere finds nothing."""
    found = []
    for finding, (_, edits) in DEFECTS.items():
        for name, now, _ in edits:
            number = (root / name).read_text().count(now)
            if number != 1:
                found.append(f"{finding}: {name} has {number} times '{now}'")
    return found


class Copy:
    """The sources with all findings, beside a build of their own."""

    def __init__(self, root):
        self.root = root
        shutil.copytree(ROOT, root, symlinks=True, ignore=lambda folder, names: [n for n in names if n in (".git", "build", "__pycache__")])
        (root / "planted.hpp").write_text(HEADER)
        for finding in DEFECTS:
            self.replace(finding, of_mission=False)
        self.run("cmake", "--preset", "release")
        self.run("ninja", "-C", "build/release", "hirosco-fly-plan")
        self.fly_plan = root / "build" / "release" / "bin" / "hirosco-fly-plan"

    def replace(self, finding, of_mission, back=False):
        """Descriptors are read by each flight: what stands there is put back for the flights of this finding only."""
        for name, now, was in DEFECTS[finding][1]:
            if name.endswith(".xml") != of_mission:
                continue
            text = (self.root / name).read_text()
            text = text.replace(was, now) if back else text.replace(now, was)
            if not of_mission and "planted.hpp" not in text:
                text = '#include "planted.hpp"\n' + text
            (self.root / name).write_text(text)

    def run(self, *words):
        done = subprocess.run(words, cwd=self.root, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {(done.stdout + done.stderr)[-2000:]}")


def control(copy, finding, arguments, number, flown):
    """What the judge says of the same flights without the defect: nothing, or it was found for another reason. Flights of the
    mission as it is are flown once for all findings."""
    os.environ[CHOSEN] = ""
    of_mission = finding if any(name.endswith(".xml") for name, _, _ in DEFECTS[finding][1]) else ""
    campaign = Campaign(parse([str(copy.root / "missions" / "rokviss"), "--seed", str(arguments.seed), "--fly-plan", str(copy.fly_plan)]))
    for index in range(number):
        key = of_mission, index
        if key not in flown:
            flown[key] = campaign.pilot.fly(campaign.plan(index))["violations"]
        if flown[key]:
            return f"without it flight {index + 1} says {flown[key][0]}"
    return ""


def find(copy, finding, arguments):
    """(flights until the judge saw it or 0, what it said)"""
    os.environ[CHOSEN] = finding
    campaign = Campaign(parse([str(copy.root / "missions" / "rokviss"), "--seed", str(arguments.seed), "--fly-plan", str(copy.fly_plan)]))
    for index in range(arguments.flights):
        result = campaign.pilot.fly(campaign.plan(index))
        seen = [violation for violation in result["violations"] if violation[0] == DEFECTS[finding][0]]
        if seen:
            return index + 1, f"{seen[0][1]:.3f} s: {seen[0][2]}"
    return 0, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("finding", nargs="*", default=list(DEFECTS))
    parser.add_argument("--flights", type=int, default=100, help="at most, for each")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    if gone := misfits():
        sys.exit("\n".join(gone))
    missed, flown = 0, {}
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(pathlib.Path(folder) / "sources")
        for finding in arguments.finding:
            begun = time.monotonic()
            copy.replace(finding, of_mission=True)
            number, text = find(copy, finding, arguments)
            other = control(copy, finding, arguments, number, flown)
            copy.replace(finding, of_mission=True, back=True)
            missed += number == 0 or bool(other)
            where = f"found in flight {number}, {DEFECTS[finding][0]} {text}" if number else f"NOT FOUND in {arguments.flights} flights"
            print(f"{finding:<5} {where}; {other or 'the same flights without it: nothing'} ({time.monotonic() - begun:.0f} s)", flush=True)
    print(f"{len(arguments.finding) - missed} of {len(arguments.finding)} findings found again")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
