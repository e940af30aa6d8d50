#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review and the unit test that sees each: the old mistake is put back into a copy of the sources, one at a time;
the one test that guards it is built and must fail there, and pass once the code is as it is. plants_in_code.py does the same
with flights (SF1, SF4, SF5, SF6, SF14, outcomes and clocks), tests/fault with real processes (SF2, SF3, SF13).
defects_in_code.py [--list] [--only NAME]...
"""
import argparse, os, pathlib, re, shutil, subprocess, sys, time
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
COPY = ROOT / "build" / "defects" / "sources"
BUILD = COPY / "build" / "release"
TEST_LIMIT_S = 300

SUPERVISION, CYCLE = "supervisor/supervision", "hirosco/subsystem/cycle/cycle.cpp"
GUARD, MANIPULATOR = "supervisor/guard/guard.cpp", "subsystems/manipulator/manipulator.cpp"
PERMISSION, LINK_ENDS = f"{SUPERVISION}/data_handling/permission.cpp", "hirosco/subsystem/engine/link_ends.cpp"
RECEPTION = f"{SUPERVISION}/data_handling/reception.cpp"


@dataclass(frozen=True)
class Defect:
    """Text `now` of a file was `was`; the tests of `filter` in the program `test` are those that must see it."""
    name: str
    file: str
    now: str
    was: str
    test: str
    filter: str


DEFECTS = [
    # What a subsystem sent and nobody could read closed its channel, and it was killed.
    Defect("SF9 damage is a loss", RECEPTION, "if (is_damage(found.error().code)) continue;",
           "if (is_damage(found.error().code)) member.refused = most_refused;",
           "supervisor_test", "ReceptionTest.DamageIsCountedAndWhatFollowsIsRead"),
    # Who was judged gone went on moving until it was killed.
    Defect("SF9 gone and not fenced", RECEPTION, "      craft_.guard.fence(member.apid());\n", "",
           "supervisor_test", "ReceptionTest.WhoCanBeNeitherCommandedNorHeardIsStoppedAtOnce"),
    # A mode was entered whose members were dead.
    Defect("SF15 mode of the dead", f"{SUPERVISION}/modes/modes.cpp", "[&](const auto& step) { return lives(step); }",
           "[&](const auto& step) { return lives(step) || true; }",
           "supervisor_test", "ModesTest.AModeWhoseMembersAreDeadIsRefusedUntilTheyLiveAgain"),
    # A supervisor that lives and does not step was in nobody's list.
    Defect("SF18 supervisor stands still", GUARD, "  watch_supervisor(watched_);\n", "",
           "supervisor_test", "Watching.ASupervisorThatStandsStillIsSeenAfterASecondOfTheGuardsSteps"),
    # Permission looked at services, not at parameters.
    Defect("SF20 any parameter", PERMISSION, "if (const auto refused = write_refused(asked)) return refused;",
           "if (const auto refused = write_refused(asked); refused && false) return refused;",
           "supervisor_test", "Permission.AParameterIsWrittenOnlyInItsStatesAndOnlyWhereTheModeOpensIt"),
    # "Commissioned" was told of members that a recovery had taken down.
    Defect("commissioned and Offline", f"{SUPERVISION}/modes/commissioning.cpp", "if (missing.empty() && (subject == nullptr ||",
           "if (missing.empty() && false && (subject == nullptr ||",
           "supervisor_test", "CommissioningTest.WhoWasTakenDownAfterItsOwnStepIsMissed"),
    # Plans for the supervisor's own events were accepted and never fired.
    Defect("plans of own events", f"{SUPERVISION}/event_handling/reactions.cpp",
           "if (from == supervisor_apid) react_to_own(name, severity);\n  else if", "if",
           "supervisor_test", "ReactionsTest.APlanForAnEventOfTheSupervisorItselfConcernsAllThatAct"),
    # The entry into Operational forgot that a node had failed in the cycle before.
    Defect("SF10 entry forgets failure", CYCLE, "if (state == State::Operational && (inhibited_ & inhibited_by_failure) != 0)",
           "if (state == State::Operational && inhibited_ != inhibited_)",
           "subsystem_test", "FailedNode.StaysInhibitedAndRefusesAnEntryIntoOperationalThatWasOnItsWay"),
    # The cycle did not look at the supervisor's heartbeat.
    Defect("SF8 cycle without supervisor", CYCLE, "  if (silent_cycles_ > silence_limit_) inhibit(inhibited_by_supervisor);\n", "",
           "subsystem_test", "SupervisorGone.TheCycleItselfInhibitsTheActuatorsInItsOwnCyclesThoughTheServiceLoopIsStuck"),
    # One bit of the page decided: flipped, it enabled.
    Defect("SF19 one bit of the page", CYCLE, "(epoch != entered_epoch_ || !parts_.permit.permits(epoch))", "epoch != entered_epoch_",
           "subsystem_test", "Devices.NoFlippedBitOfAFencedPermitPageReachesAnActuator"),
    # A second link into a set was taken; its end ended the first.
    Defect("second link into a set", LINK_ENDS, 'return has_another ? "the set', 'return has_another && false ? "the set',
           "subsystem_test", "Links.ASecondOneIntoARequiredSetIsRefusedAndDetachingItLeavesTheFirst"),
    # Links were made in Operational.
    Defect("link in Operational", LINK_ENDS, "if (settled && state_ != State::PreOperational)",
           "if (settled && !is_cyclic(state_))",
           "subsystem_test", "Links.IntoASetThatIsNeededAreMadeInPreOperationalOnly"),
    # A failed Post-Operational reached Offline with configuration, plan and flows in place.
    Defect("failed way down keeps all", "hirosco/subsystem/engine/state_machine.cpp",
           "if (at == State::PostOperational && configuration_ != nullptr) {",
           "if (at == State::PostOperational && configuration_ != nullptr && false) {",
           "subsystem_test", "FailedPostOperational.GivesBackConfigurationPlanAndFlowsWhenTheCycleHasComeToRest"),
]


def misfits(root=ROOT):
    """Defects whose place in the code is gone, or whose test: [text]. What fits nowhere finds nothing."""
    found = [f"{defect.name}: the name is taken" for at, defect in enumerate(DEFECTS)
             if any(other.name == defect.name for other in DEFECTS[:at])]
    for defect in DEFECTS:
        number = (root / defect.file).read_text().count(defect.now)
        if number != 1:
            found.append(f"{defect.name}: {defect.file} has {number} times '{defect.now}'")
    return found


def sources():
    """Files of the tree as they stand, without what git ignores."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            check=True, capture_output=True, text=True).stdout
    return [name for name in listed.split("\0") if name and (ROOT / name).is_file()]


class Copy:
    """The sources in a folder of their own, which stays: what did not change since is not built again."""

    def __init__(self):
        wanted = sources()
        for name in wanted:
            target = COPY / name
            if target.exists() and target.read_bytes() == (ROOT / name).read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, target)  # with the time of now, so that it is built
        for path in [path for path in COPY.rglob("*") if path.is_file() and BUILD.parent not in path.parents]:
            if str(path.relative_to(COPY)) not in wanted:
                path.unlink()
        self.run("cmake", "--preset", "release")

    def run(self, *words):
        done = subprocess.run(words, cwd=COPY, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {(done.stdout + done.stderr)[-2000:]}")

    def build(self, test, jobs):
        self.run("ninja", "-C", str(BUILD), f"-j{jobs}", test)

    def failed(self, defect):
        """The tests of the filter that failed; one that took the whole program with it is among them."""
        words = [BUILD / "bin" / defect.test, f"--gtest_filter={defect.filter}"]
        try:
            done = subprocess.run(words, cwd=BUILD, capture_output=True, text=True, errors="replace", timeout=TEST_LIMIT_S)
        except subprocess.TimeoutExpired:
            return ["without end"]
        ran = re.findall(r"^\[ RUN      \] (\S+)", done.stdout, re.M)
        if not ran:
            raise RuntimeError(f"{defect.test} has no test {defect.filter}: {done.stderr[-500:]}")
        failed = re.findall(r"^\[  FAILED  \] (\S+) \(", done.stdout, re.M)
        return failed or ([f"{ran[-1]} (ended by signal {-done.returncode})"] if done.returncode < 0 else [])

    def write(self, defect, text):
        (COPY / defect.file).write_text(text)


def find(copy, defect, jobs):
    """(the tests that failed with the defect, why the row is no proof or "")"""
    text = (COPY / defect.file).read_text()
    if text.count(defect.now) != 1:
        return [], f"{defect.file} has {text.count(defect.now)} times '{defect.now}'"
    try:
        copy.write(defect, text.replace(defect.now, defect.was))
        copy.build(defect.test, jobs)
        seen = copy.failed(defect)
    except RuntimeError as error:
        return [], str(error)
    finally:
        copy.write(defect, text)
    return seen, ""


def controls(copy, defects, jobs):
    """Of tests that fail without any defect: {(program, filter)}. They would prove nothing."""
    bad = set()
    for test in dict.fromkeys(defect.test for defect in defects):
        copy.build(test, jobs)
    for defect in defects:
        if copy.failed(defect):
            bad.add((defect.test, defect.filter))
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="NAME", help="rows whose name begins so; may be given again")
    parser.add_argument("--list", action="store_true", help="the rows, without building anything")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the compiler at a time")
    arguments = parser.parse_args()
    chosen = [defect for defect in DEFECTS if not arguments.only or any(defect.name.startswith(name) for name in arguments.only)]
    if not chosen:
        parser.error("no row of that name")
    if arguments.list:
        for defect in chosen:
            print(f"{defect.name:<30} {defect.file}: {defect.test} {defect.filter}")
        return 0
    if gone := misfits():
        sys.exit("\n".join(gone))
    copy = Copy()
    bad = controls(copy, chosen, arguments.jobs)
    missed = 0
    for defect in chosen:
        begun = time.monotonic()
        seen, error = find(copy, defect, arguments.jobs)
        if (defect.test, defect.filter) in bad:
            error = "the test fails without the defect"
        missed += bool(error) or not seen
        verdict = f"ERROR {error}" if error else f"found by {', '.join(seen)}" if seen else f"NOT FOUND by {defect.filter}"
        print(f"{defect.name:<30} {defect.test:<22} {verdict} ({time.monotonic() - begun:.0f} s)", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} defects found again")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
