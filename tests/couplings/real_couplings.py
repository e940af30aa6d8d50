#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Seeded flights on real processes, and as threads of one, of a mission of each kind of link and each word for its loss: whom all follow dies or leaves,
descriptors are read again, sound and not, programs are put in place of others and confirmed or not (docs/adr/0232). Judged from outside: what states and
devices are then, and what the flight told.

    real_couplings.py [--threads] [--flights N] [--seed S] [--only K] [--keep FILE]    FILE: how far it is, and of which build; goes on from there
"""
import argparse
import hashlib
import os
import pathlib
import random
import shutil
import signal
import sys
import tempfile
import time
import zlib

import flight
import punctual

sys.path.append(str(flight.REPOSITORY / "tests/fault"))
from demands import Unready, Violation, expect  # noqa: E402
from kept_flights import KeptFlights  # noqa: E402

MISSION = flight.REPOSITORY / "tests/couplings/mission.xml"
# Member: its descriptor, and the device that tells whether it acts.
FOLLOWERS = {"LED": "led", "FALLING": "falling", "COUNTER": "counter", "WOKEN": "woken"}
APIDS = {"ENCODER": 20, "LED": 21, "FALLING": 22, "COUNTER": 23, "WOKEN": 24}
OFFLINE, SAFE = 0, 4
HOLD_S, DOWN_S, TOOL_S = 1.5, 2.0, 1.0          # of link 3; of a network; of `hirosco tc` and of a status
LATE_FLIGHTS = 3
VERSIONS = ("2", "3")


class Craft:
    """The mission in a folder where its descriptors may be edited; for processes with a manifest and other versions of its programs."""

    def __init__(self, folder, threads):
        self.folder = pathlib.Path(folder)
        # Ground reads files of its own: what refuses is the craft.
        self.mission, self.of_ground = (self.copy(self.folder / name) for name in ("craft", "ground"))
        self.more, self.environment = ("--no-ground", *(["--threads"] if threads else [])), {}
        if not threads:
            self.add_versions()

    @staticmethod
    def copy(folder):
        mission = folder / "tests/couplings/mission.xml"
        mission.parent.mkdir(parents=True)
        for name in ("supervisor", "subsystems"):
            (folder / name).symlink_to(flight.REPOSITORY / name)
        for file in MISSION.parent.glob("*.xml"):
            shutil.copy(file, mission.parent)
        return mission

    def add_versions(self):
        """The same programs with another digest."""
        programs = self.folder / "programs"
        programs.mkdir()
        listed = []
        for name in ("hirosco-communication", "hirosco-encoder", "hirosco-follower", "hirosco-counter"):
            octets = (flight.BINARIES / name).read_bytes()
            listed.append(f"{hashlib.sha256(octets).hexdigest()}  {name}\n")
            for version in VERSIONS if name != "hirosco-communication" else ():
                file = programs / f"{name}@{version}"
                file.write_bytes(octets + version.encode())
                file.chmod(0o755)
                listed.append(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n")
        (self.mission.parent / "manifest.sha256").write_text("".join(listed))
        self.mission.write_text(self.mission.read_text().replace("<Links>", '<Manifest path="manifest.sha256"/>\n  <Links>', 1))
        self.environment = {"PATH": f"{programs}:{os.environ['PATH']}"}

    def file_of(self, member):
        return self.mission.parent / f"{member.lower()}.xml"

    def text_of(self, member):
        return (MISSION.parent / f"{member.lower()}.xml").read_text()

    def edit(self, member, how):
        """What its file says from now on."""
        text = self.text_of(member)
        if how == "faulty":
            text = text.replace('sampling_us="', 'sampling_us="x', 1)
        elif how == "forbidden":
            text = text.replace('sampling_us="', 'sampling_us="1', 1)
        elif how != "back":
            text += f"<!-- {how} -->\n"
        self.file_of(member).write_text(text)
        return text


class Trial:
    def __init__(self, seed, number, threads):
        self.random, self.threads = random.Random(f"{seed}/{number}/{threads}"), threads
        kinds = [self.leaves, self.reads_again, self.reads_again_what_is_none] + ([] if threads else [self.dies, self.replaces, self.replaces_on_trial])
        self.random.shuffle(kinds)
        self.steps = kinds[:3]
        self.figures, self.host = {}, punctual.Lateness()

    def fly(self, craft, files):
        self.craft, self.files = craft, files
        craft.wait_told("commissioned: mode quick", 20.0)
        craft.mission = str(files.of_ground)
        for step in self.steps:
            self.begin = craft.count()
            step()
            self.bring_up()
        self.nothing_of_a_queue_is_lost_uncounted()
        expect(craft.end() in (0, 5), f"exit code, {craft.errors}")

    # --- hands and eyes -----------------------------------------------------------------------------------------------------
    def do(self, subsystem, function, *arguments):
        code, reports = self.craft.tc(subsystem, function, *arguments)
        expect(code == 0, f"{subsystem} {function} {arguments}: {reports}")

    def refused(self, subsystem, function, *arguments):
        code, reports = self.craft.tc(subsystem, function, *arguments)
        expect(code != 0, f"{subsystem} {function} {arguments} was not refused: {reports}")

    def states(self):
        status = self.craft.wait_status(lambda s: True, 3.0)
        return {member["name"]: member["state"] for member in status["subsystems"]}

    def acts(self, member):
        return self.craft.truth(f"{FOLLOWERS[member]}-axis")["active"] == 1

    def wait(self, wanted, seconds, what, otherwise=Violation):
        end = time.monotonic() + seconds + TOOL_S
        while not wanted():
            expect(time.monotonic() < end + self.host.stood_still_s(end - seconds, end), f"{what} within {seconds:g} s: {self.states()}", otherwise)
            time.sleep(0.02)

    def bring_up(self):
        """One change of mode: all follow, and each moves what it has. Whose time to hold on ends in the midst of it would go down instead."""
        time.sleep(HOLD_S + 0.5)
        for name in ("commissioning", "quick"):
            done = self.craft.hirosco("mode", name, "--mission", self.craft.mission, seconds=40.0)
            expect(done.returncode == 0, f"mode {name}: {done.stdout}{done.stderr}", Unready)
        self.wait(lambda: set(self.states().values()) == {"Operational"}, 5.0, "all are Operational", Unready)
        self.wait(lambda: all(map(self.acts, FOLLOWERS)), 2.0, "all act", Unready)

    def at_rest(self, member):
        done = self.craft.hirosco("mode", "commissioning", "--mission", self.craft.mission, seconds=40.0)
        expect(done.returncode == 0, f"mode commissioning: {done.stdout}{done.stderr}", Unready)
        for state in (SAFE, OFFLINE):  # who is further down already refuses a step
            self.craft.tc(member, "SET_STATE", state)
        self.wait(lambda: self.states()[member] == "Offline", 3.0, f"{member} is Offline")

    # --- whom all follow is lost -----------------------------------------------------------------------------------------------
    def dies(self):
        """It comes back under who holds on, and nobody else leaves what the mission says."""
        pid, = (pid for pid, name in self.craft.processes().items() if "hirosco-encoder" in name)
        os.kill(pid, signal.SIGKILL)
        killed = time.monotonic()
        self.falls_back()
        self.craft.wait_told("LED info STATE_CHANGED STATE=Offline", DOWN_S, self.begin)
        back = self.craft.wait_told("ENCODER, LED: as commanded", HOLD_S, self.begin)
        self.figures.setdefault("back as commanded", []).append(back.received - killed)
        self.goes_on("WOKEN", "COUNTER", until=killed + HOLD_S + DOWN_S)
        expect(self.acts("LED"), "LED does not act though it is back as commanded")

    def leaves(self):
        """In good order: who holds on goes down behind its time, as it does not come back."""
        self.do("ENCODER", "SET_STATE", SAFE)
        self.do("ENCODER", "SET_STATE", OFFLINE)
        left = time.monotonic()
        self.falls_back()
        self.craft.wait_told("COUNTER: TICKS did not come back in time", HOLD_S + TOOL_S, self.begin)
        self.craft.wait_told("COUNTER info STATE_CHANGED STATE=Offline", DOWN_S, self.begin)
        self.goes_on("WOKEN", until=left + HOLD_S)
        expect(not self.acts("LED") and not self.acts("COUNTER"), "LED or COUNTER acts on")

    def falls_back(self):
        begun = time.monotonic()
        self.craft.wait_told("FALLING has lost TICKS of ENCODER: fallback", DOWN_S, self.begin)
        self.craft.wait_told("FALLING goes on in configuration ALONE", DOWN_S, self.begin)
        self.figures.setdefault("falls back", []).append(time.monotonic() - begun)
        self.wait(lambda: self.acts("FALLING"), 1.0, "FALLING acts alone")

    def goes_on(self, *names, until):
        while time.monotonic() < until:
            for name in names:
                expect(self.acts(name), f"{name} does not act on: {self.states()}")
            time.sleep(0.02)
        left = [line.told for line in self.craft.told(self.begin) if line.told.startswith(tuple(f"{name} info STATE_CHANGED" for name in names))]
        expect(not left, f"a state was left: {left}")

    # --- descriptors ------------------------------------------------------------------------------------------------------------
    def reads_again(self):
        member = self.random.choice(list(APIDS))
        self.at_rest(member)
        text = self.files.edit(member, self.random.choice(("2", "3")))
        self.do("SUPERVISOR", "REREAD", APIDS[member])
        self.craft.wait_told(f"CRC-32 {zlib.crc32(text.encode()):08x}", 5.0, self.begin)
        if self.random.random() < 0.5:
            self.files.edit(member, "back")
            self.do("SUPERVISOR", "REREAD", APIDS[member])

    def reads_again_what_is_none(self):
        member, how = self.random.choice(list(APIDS)), self.random.choice(("faulty", "forbidden"))
        self.refused("SUPERVISOR", "REREAD", APIDS[member])      # it is Operational
        self.at_rest(member)
        self.files.edit(member, how)
        self.refused("SUPERVISOR", "REREAD", APIDS[member])
        self.craft.wait_told(f"{member} keeps its descriptor", 5.0, self.begin)
        expect(not [line for line in self.craft.told(self.begin) if f"{member} flies by" in line.told], f"{member} flies by what is none")
        self.files.edit(member, "back")

    # --- versions -------------------------------------------------------------------------------------------------------------------
    def version_of(self, member):
        """Of the one process whose command line names its descriptor, as its program is called."""
        found = []
        for pid, name in self.craft.processes().items():
            words = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
            if str(self.files.file_of(member)).encode() in words and "hirosco-supervisor" not in name:
                found.append(name.removesuffix(" (deleted)").partition("@")[2])
        expect(len(found) == 1, f"{member} has {len(found)} processes: {self.craft.processes()}")
        return found[0]

    def replaces(self):
        """Confirmed it stays, also behind its death."""
        member, version = self.random.choice(list(FOLLOWERS)), self.random.choice(VERSIONS)
        self.at_rest(member)
        if self.version_of(member) == version:
            version = VERSIONS[1 - VERSIONS.index(version)]
        self.do("SUPERVISOR", "REPLACE", APIDS[member], version, 30)
        expect(self.version_of(member) == version, f"{member} runs {self.version_of(member)} in place of {version}")
        self.do("SUPERVISOR", "CONFIRM", APIDS[member])
        self.refused("SUPERVISOR", "REPLACE", APIDS[member], "9", 30)
        expect(self.version_of(member) == version, f"{member} runs {self.version_of(member)} behind a version that is none")

    def replaces_on_trial(self):
        """Not confirmed it goes, by itself, by its death or taken back."""
        member, version = self.random.choice(list(FOLLOWERS)), self.random.choice(VERSIONS)
        self.at_rest(member)
        before = self.version_of(member)
        if before == version:
            version = VERSIONS[1 - VERSIONS.index(version)]
        how = self.random.choice(("left", "taken back"))
        self.do("SUPERVISOR", "REPLACE", APIDS[member], version, 3 if how == "left" else 30)
        expect(self.version_of(member) == version, f"{member} runs {self.version_of(member)} in place of {version}")
        if how == "taken back":
            self.do("SUPERVISOR", "TAKE_BACK", APIDS[member])
        words = "the mission's own version" if not before else f"version {before}"
        self.craft.wait_told(f"{member} runs {words} again", 10.0, self.begin)
        expect(self.version_of(member) == before, f"{member} runs {self.version_of(member)}, not {before or 'its own'} again")

    # --- links ----------------------------------------------------------------------------------------------------------------------
    def nothing_of_a_queue_is_lost_uncounted(self):
        done = self.craft.hirosco("status", "COUNTER", "--mission", self.craft.mission)
        told = {}
        for line in done.stdout.splitlines():
            words = line.replace("=", " ").split()
            for name in ("TAKEN", "UNCOUNTED", "TORN"):
                if any(word.endswith(name) for word in words):
                    told[name] = float(next(word for word in words[1:] if word.replace(".", "").replace("+", "").isdigit()))
        expect(told.get("TAKEN", 0) > 0, f"COUNTER tells of {told}: {done.stdout}{done.stderr}")
        expect(told["UNCOUNTED"] == told["TORN"] == 0, f"COUNTER tells of {told}")


def flown(trial, threads, again):
    """Whether it flew without a violation; None: it could not be brought up because the host was late, which says nothing."""
    with tempfile.TemporaryDirectory(prefix="hirosco-couplings-") as folder, punctual.Lateness() as trial.host:
        files = Craft(folder, threads)
        try:
            with flight.Flight(files.mission, quiet=True, more=files.more, environment=files.environment) as craft:
                told = craft
                trial.fly(craft, files)
            return True
        except (Violation, AssertionError) as problem:
            violation = problem
    # Nobody here stops anybody: whose cycles stood still and went on by themselves had no processor.
    excused = isinstance(violation, Unready) or any(line.told.endswith(" moves again") for line in told.told())
    if excused and trial.host.worst_s is not None and trial.host.worst_s > punctual.WATCHDOG_S:
        print(f"{violation}, on a host that was late by {1e3 * trial.host.worst_s:.0f} ms: a new flight", flush=True)
        return None
    late = "unknown" if trial.host.worst_s is None else f"{1e3 * trial.host.worst_s:.0f} ms"
    print("\n".join(told.story().splitlines()[-60:]) + f"\n  VIOLATION {violation}\n  the host was late by {late}\n  again: real_couplings.py {again}", flush=True)
    return False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--threads", action="store_true", help="supervisor and subsystems as threads of one process: nobody dies alone, and there are no versions")
    parser.add_argument("--flights", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    parser.add_argument("--keep", type=pathlib.Path, help="a line for each flight; those that this build has flown by it are not flown again")
    options = parser.parse_args()
    if options.keep and options.only is not None:
        parser.error("--keep is of flights that are flown one after the other: not with --only")
    numbers = [options.only] if options.only is not None else range(options.flights)
    kept = KeptFlights(options.keep, MISSION, options.seed, "threads" if options.threads else "processes")
    for number in numbers:
        if number in kept.passed:
            continue
        for _ in range(LATE_FLIGHTS):
            trial = Trial(options.seed, number, options.threads)
            print(f"flight {number}: {' '.join(step.__name__ for step in trial.steps)}", flush=True)
            outcome = flown(trial, options.threads, f"--seed {options.seed} --only {number}{' --threads' if options.threads else ''}")
            if outcome is not None:
                break
        kept.add(number, bool(outcome), trial.figures)
    failed = sum(not kept.passed[number] for number in numbers)
    print(f"{len(numbers) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
