#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings as they were in the code. Each is put back into a copy of the sources, which is built and flown until the judge
sees it: nothing of a plant is ever in what flies. plants_in_code.py [--flights N] [--seed S] [FINDING...]"""
import argparse, pathlib, shutil, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
from campaign import Campaign, parse  # noqa: E402

HANDLING, REACTIONS, SUPERVISOR = "supervisor/data_handling.cpp", "supervisor/reactions.cpp", "supervisor/supervisor.cpp"
# {finding: (invariant, [(file, as it is, as it was)])}
PLANTS = {
    # States of the supervisor were anybody's to command, and SAFE_ALL a function that some of them do not permit.
    "SF1": ("I4", [
        ("supervisor/supervision/data_handling/permission.cpp",
         'return apid == supervisor_apid && (call.name == "SET_STATE" || call.name == "CONFIGURE");',
         'return apid == 0 && call.name.empty();'),
        (HANDLING, "apid == 1 && call && carry_out_at_once(incoming, request, call->name)",
         "false && carry_out_at_once(incoming, request, call->name)"),
        (SUPERVISOR, 'on_function("SAFE_ALL", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });',
         'on_function("SAFE_ALL", [this]() -> Outcome { parts_.guard.stop_all(); after_stop("SAFE_ALL"); return ok(); });'),
        (SUPERVISOR, 'on_function("SHUTDOWN", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });',
         'on_function("SHUTDOWN", [this]() -> Outcome { request_shutdown(); return ok(); });')]),
    # The stop was lifted when SET_STATE(Operational) was permitted, and what waited for the disk was forwarded whatever
    # had happened in between.
    "SF4": ("I4", [
        (HANDLING, "  if (asks_only) return answer_query(incoming, *telecommand);",
         "  if (asks_only) return answer_query(incoming, *telecommand);\n"
         "  if (decision->releases_stop && apid != 1) parts_.guard.release(apid, parts_.guard.fences(apid));"),
        (HANDLING, "if (parts_.guard.fences(next.apid) != next.fences) {", "if (false) {"),
        (HANDLING, "if (releases_stop && apid != 1 && !parts_.guard.release(apid, fences))", "if (false && releases_stop && fences)")]),
    # Death was swallowed while a plan of the same severity ran. This mission's plans take the network down all the same;
    # it shows where the plan for high severity is milder.
    "SF5": ("I4", [
        (REACTIONS, "if (origin.recovering && *origin.recovering >= severity && !is_loss(event)) return;",
         "if (origin.recovering && *origin.recovering >= severity) return;"),
        ("missions/rokviss/mission.xml", '<When severity="high"/><Do action="shut_down_network"/>',
         '<When severity="high"/><Do action="set_state" state="SafeOperational"/>')]),
    # Recovery heard events as reports: one whose report was off was not heard.
    "SF6": ("I4", [
        ("hirosco/subsystem/reporting.cpp",
         "if (octets) backlog_.send(channel_, {.kind = MessageKind::Event",
         "if (octets && reported == pus::Reported::Yes) backlog_.send(channel_, {.kind = MessageKind::Event")]),
    # Nothing raised the epoch on the way up: a device that had latched on the way down stayed so.
    "SF14": ("I10", [
        ("hirosco/subsystem/pages.hpp", "const std::uint32_t under = epoch.fetch_add(1, std::memory_order_acq_rel) + 1;",
         "const std::uint32_t under = epoch.load(std::memory_order_acquire);")]),
    # Nobody remembered what the dead had been asked.
    "LW1": ("I2", [
        (REACTIONS, "for (const pus::Request& request : outstanding_.take(apid))",
         "static_cast<void>(outstanding_.take(apid));\n  for (const pus::Request& request : std::vector<pus::Request>{})")]),
    # An exchange moved a device's clock by at least one cycle, and the rest was forgotten.
    "LW13": ("I13", [
        ("simulation/devices/simulated_device.cpp", "  if (!exchanged && behind < settings_.cycle * (by_own_clock_ ? 1 : 2)) return 0;",
         "  if (exchanged) {\n    by_own_clock_ = false;\n    world_time_ = now;\n"
         "    return std::max<std::int64_t>(1, (behind + settings_.cycle / 2) / settings_.cycle);\n  }\n"
         "  if (!exchanged && behind < settings_.cycle * (by_own_clock_ ? 1 : 2)) return 0;")]),
}


def misfits(root=ROOT):
    """Plants whose place in the code is gone: [text]. A plant that fits nowhere finds nothing."""
    found = []
    for finding, (_, edits) in PLANTS.items():
        for name, now, _ in edits:
            number = (root / name).read_text().count(now)
            if number != 1:
                found.append(f"{finding}: {name} has {number} times '{now}'")
    return found


class Copy:
    """The sources beside a build of their own."""

    def __init__(self, root):
        self.root = root
        shutil.copytree(ROOT, root, symlinks=True, ignore=lambda folder, names: [n for n in names if n in (".git", "build", "__pycache__")])
        self.run("cmake", "--preset", "release")

    def run(self, *words):
        done = subprocess.run(words, cwd=self.root, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {(done.stdout + done.stderr)[-2000:]}")

    def build(self):
        self.run("ninja", "-C", "build/release", "hirosco-fly-plan")
        return self.root / "build" / "release" / "bin" / "hirosco-fly-plan"

    def plant(self, edits):
        before = {name: (self.root / name).read_text() for name, _, _ in edits}
        for name, now, was in edits:
            text = (self.root / name).read_text()
            (self.root / name).write_text(text.replace(now, was))
        return before

    def restore(self, before):
        for name, text in before.items():
            (self.root / name).write_text(text)


def find(copy, finding, arguments):
    """(flights until the judge saw it or 0, what it said)"""
    invariant, _ = PLANTS[finding]
    campaign = Campaign(parse([str(copy.root / "missions" / "rokviss"), "--seed", str(arguments.seed), "--fly-plan", str(copy.build())]))
    for index in range(arguments.flights):
        result = campaign.pilot.fly(campaign.plan(index))
        seen = [violation for violation in result["violations"] if violation[0] == invariant]
        if seen:
            return index + 1, f"{seen[0][1]:.3f} s: {seen[0][2]}"
    return 0, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("finding", nargs="*", default=list(PLANTS))
    parser.add_argument("--flights", type=int, default=60, help="at most, for each")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    if gone := misfits():
        sys.exit("\n".join(gone))
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(pathlib.Path(folder) / "sources")
        for finding in arguments.finding:
            begun, before = time.monotonic(), copy.plant(PLANTS[finding][1])
            number, text = find(copy, finding, arguments)
            copy.restore(before)
            missed += number == 0
            where = f"found in flight {number}, {PLANTS[finding][0]} {text}" if number else f"NOT FOUND in {arguments.flights} flights"
            print(f"{finding:<5} {where} ({time.monotonic() - begun:.0f} s)", flush=True)
    print(f"{len(arguments.finding) - missed} of {len(arguments.finding)} findings found again")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
