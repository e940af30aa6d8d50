#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Seeded flights on real processes: a cycle that spins, a process that is stopped or killed, a device that is unplugged, a
stop of everything by three ways, a supervisor or a keeper that is killed or stands still, at work and in the midst of a stop or of a
change of mode; then the craft must be whole again by one bring-up. Each third flight ends without its keeper.

Judged from outside: only the victim dies (I1), the supervisor answers throughout (I6), what was taken is given back (I7),
the robot in the world puts out nothing after a stop, everybody else cycles on (hazards SF2, SF14, SF15, SF18). Each other flight asks at its end for
all that was said, which comes as the log has it (I14).

    real_campaign.py [--flights N] [--seed S] [--only K] [--keep FILE]    FILE: how far it is, and of which build; goes on from there
    real_campaign.py --hundreds [N]      each of spinning, stopped, unplugged, killed (each subsystem) N times (100), and what it took
    ... --evidence FOLDER                where the log of a flight with a violation is kept, with what was told
"""
import argparse
import pathlib
import random
import shutil
import signal
import sys
import threading
import time

import flight
import link_gaps
import pages
import punctual
import reactions
from demands import BACK_S, Unready, Violation, expect
from kept_flights import KeptFlights
from link_gaps import LinkGaps
from reactions import CYCLE_S, GRID_S, LOOK_S, Reactions

SPINNABLE = {"hirosco-joystick": "hirosco-spinnable-joystick", "hirosco-manipulator": "hirosco-spinnable-manipulator"}
RESTARTS = {"60": "1"}              # three deaths in a minute are many for a mission, few for a campaign
ROBOT, JOYSTICK, GROUND = "hirosco-spinnable-manipulator", "hirosco-spinnable-joystick", "hirosco-telepresence-relay"
# How long a cycle may stand still until it hangs (20 looks of the guard, 10 ms apart, and the one that it moved in), until the
# others cycle again once it has lost its priority, and what the watch's own grid adds. The robot does not wait for that: it
# obeys nobody once its watchdog has run out.
HANG_S, AGAIN_S, WATCHDOG_S = 0.220, 0.005, 0.010
ADOPTED_S = 1.0                                 # another supervisor goes on with what runs
STILL_S, STILL_PACE_S = 3.0, 0.5                # of a keeper: supervisor/keeper/kept.hpp
MODES = {"standalone": 2, "telepresence": 3}
# What took how long, and the deadline that it was held to.
DEADLINES_S = {"the robot obeys nobody": WATCHDOG_S + LOOK_S, "network fenced": HANG_S + 5 * CYCLE_S + GRID_S, "others cycle again": AGAIN_S + GRID_S,
               "longest pause of others": AGAIN_S + GRID_S, "back after its death": BACK_S, "adopted": ADOPTED_S,
               "a still keeper is told of": STILL_S + STILL_PACE_S, "a lost keeper is told of": ADOPTED_S,
               **reactions.DEADLINES_S, **link_gaps.DEADLINES_S}


class Trial(Reactions, LinkGaps):
    """One flight: some faults, what they must lead to, and a bring-up after each."""

    def __init__(self, seed, number, kind=None, times=3):
        super().__init__()
        self.random = random.Random(f"{seed}/{number}")
        self.number = number
        kinds = [self.spinning, self.stopped, self.killed, self.unplugged, self.ground_killed, self.safe_by_signal,
                 self.safe_by_telecommand, self.killed_while_it_recovers, self.supervisor_killed, self.supervisor_stopped, self.keeper_stopped,
                 self.supervisor_killed_in_a_stop, self.killed_in_a_mode_change]
        self.random.shuffle(kinds)
        self.steps = [getattr(self, kind)] * times if kind else kinds[:times]
        self.done = 0
        self.turn = self.random.random() < 0.5

    def fly(self, craft):
        self.craft = craft
        craft.wait_commissioned()
        craft.fault("joystick", "hand", "cartesian", 0.015, 0, 0.5)
        time.sleep(self.random.uniform(0.6, 1.2))
        self.baseline = self.taken()
        self.up_since = craft.count()
        for step in self.steps:
            self.still_up()
            self.begin = craft.count()
            step()
            self.bring_up()
            self.done += 1
        if self.number % 2 == 0:
            self.what_was_said_comes_again()
        held = self.taken()
        expect(held <= self.baseline + 2, f"I7: {held} descriptors where {self.baseline} were")
        if self.number % 3 == 2:
            return self.flies_on_without_its_keeper()
        expect(craft.end() in (0, 1, 5), f"exit code, {craft.errors}")

    def flies_on_without_its_keeper(self):
        """To its end: nobody would go on for this supervisor any more (docs/adr/0217)."""
        self.begin = self.craft.count()
        killed = self.craft.kill("hirosco")
        told = self.craft.wait_told("the keeper is gone", 2.0, self.begin).received - killed
        late = self.host.stood_still_s(killed, killed + told)
        expect(told <= ADOPTED_S + late, f"that the keeper is gone was told after {told:.2f} s")
        self.took("a lost keeper is told of", told)
        self.answers()
        changed = [line.told for line in self.craft.told(self.begin) if "STATE_CHANGED" in line.told]
        expect(not changed, f"a lost keeper changed {changed[:1]}")
        self.craft.kill("hirosco-supervisor", signal.SIGTERM)
        left = self.craft.wait_until_gone(15.0)
        expect(not left, f"without their keeper {left} were left behind")

    def victim(self):
        """Either in turn, so that as many of each are."""
        self.turn = not self.turn
        return ROBOT if self.turn else JOYSTICK

    def name(self, program):
        return "MANIPULATOR" if program == ROBOT else "JOYSTICK"

    def spinning(self):
        victim = self.victim()
        pid = self.craft.pid_of(victim)
        self.hangs_and_dies(victim, lambda: flight.spin(pid, pages.cycle_thread(pid)), self.others_go_on_without_its_priority)

    def stopped(self):
        victim = self.victim()
        self.hangs_and_dies(victim, lambda: self.craft.kill(victim, signal.SIGSTOP), self.others_go_on)

    def hangs_and_dies(self, victim, happens, judge_others):
        name = self.name(victim)
        other = JOYSTICK if victim == ROBOT else ROBOT
        with pages.Watch(self.craft, (ROBOT, JOYSTICK)) as watch:
            before = self.craft.truth("robot")
            done = time.monotonic()
            happens()
            hang = self.craft.wait_told(f"{name} hangs", 3.0, self.begin)
            self.until_offline([self.name(other)])
            self.craft.wait_at_rest("robot", hang.received)
        # A process is stopped when each of its threads has heard of it, which a busy computer takes its time for: what follows
        # is counted from its last cycle.
        happened = max([done] + [at for at, _ in watch.counts[victim]])
        self.took("it stands still after", happened - done)
        # In the time of its world, which leaves out how late the host was; `before` is as old as a look takes.
        obeyed = self.craft.truth("robot")["obeyed_s"] - before["world_s"] - (happened - done)
        expect(obeyed <= WATCHDOG_S + LOOK_S, f"the robot obeyed for another {1e3 * obeyed:.1f} ms")
        self.took("the robot obeys nobody", max(0.0, obeyed))
        expect(set(watch.fenced) == {ROBOT, JOYSTICK}, f"fenced were only {set(watch.fenced)}")
        fenced = max(watch.fenced.values()) - happened
        late = self.late_s(watch, happened, happened + fenced)
        expect(fenced <= HANG_S + 5 * CYCLE_S + GRID_S + late, f"the network was fenced only after {1e3 * fenced:.1f} ms")
        self.took("network fenced", fenced)
        judge_others(watch, victim, other, happened)
        expect(not [line for line in self.craft.told(self.begin) if f"{self.name(other)} hangs" in line.told],
               f"{other} was blamed for what {name} did")
        self.answers()
        died = self.craft.wait_told(f"{name} died: signal 9", 4.0, self.begin)
        expect(0.9 < died.at_s - hang.at_s < 1.5, f"grace was {died.at_s - hang.at_s:.2f} s")
        # That it hangs is known from the fence on.
        self.comes_down(watch, reactions.HANG, max(watch.fenced.values()), [other], died.received)
        self.only_died(name)

    def others_go_on_without_its_priority(self, watch, victim, other, _):
        expect(victim in watch.demoted, f"{victim} has kept its priority")
        demoted = watch.demoted[victim]
        again = next((at for at, _ in watch.counts[other] if at >= demoted), None)
        expect(again is not None, f"{other} does not cycle again")
        late = self.late_s(watch, demoted, again)
        expect(again - demoted <= AGAIN_S + GRID_S + late, f"{other} cycled again only {1e3 * (again - demoted):.1f} ms later")
        self.took("others cycle again", again - demoted)

    def others_go_on(self, watch, victim, other, happened):
        """Who stands still takes no processor from anybody, until its network goes down with it."""
        pause = watch.longest_pause_s(other, happened, watch.fenced[other])
        late = self.late_s(watch, happened - LOOK_S, watch.fenced[other])
        expect(pause <= AGAIN_S + GRID_S + late, f"{other} did not cycle for {1e3 * pause:.1f} ms")
        self.took("longest pause of others", pause)

    def killed(self):
        victim = self.victim()
        other = JOYSTICK if victim == ROBOT else ROBOT
        with pages.Watch(self.craft, (ROBOT, JOYSTICK)) as watch:
            before = self.look_before()
            killed = self.craft.kill(victim)
            self.craft.wait_told(f"{self.name(victim)} died: signal 9", 2.0, self.begin)
            self.until_offline([self.name(other)])
            self.craft.wait_at_rest("robot", killed)
        expect(victim in watch.ended, f"the system did not mark the end of {victim}")
        # Each of its threads has to run once more to end, which a busy computer takes its time for.
        dead = watch.ended[victim]
        self.took("it is dead after", dead - killed)
        self.is_safe(watch, reactions.DEATH, dead, [other])
        self.obeys_nobody(watch, reactions.DEATH, dead, before)
        self.comes_down(watch, reactions.DEATH, dead, [other])
        self.answers()
        self.only_died(self.name(victim))

    def killed_while_it_recovers(self):
        self.craft.ask("joystick", "unplug")
        killed = self.craft.kill(JOYSTICK)
        self.craft.wait_told("JOYSTICK died: signal 9", 2.0, self.begin)
        self.craft.wait_at_rest("robot", killed)
        self.answers()
        self.craft.ask("joystick", "plug")
        self.only_died("JOYSTICK")

    def unplugged(self):
        device = self.random.choice(("joystick", "robot"))
        owner = ROBOT if device == "robot" else JOYSTICK
        with pages.Watch(self.craft, (ROBOT, JOYSTICK)) as watch:
            before, unplugged = self.look_before(), time.monotonic()
            self.craft.ask(device, "unplug")
            pulled = time.monotonic()
            self.until_offline([self.name(ROBOT), self.name(JOYSTICK)])
            self.craft.wait_at_rest("robot", unplugged)
        # Pulled by then at the latest: a device hears of it in its own time, and whoever drives it may be quicker than its answer.
        noticed = watch.first(owner, lambda look: look.inhibited & pages.BY_DEVICE, unplugged)
        expect(noticed is not None, f"{owner} did not miss its device")
        since = min(pulled, noticed.at)
        self.took("it is unplugged after", since - unplugged)
        self.is_safe(watch, reactions.UNPLUGGING, since, [ROBOT, JOYSTICK])
        self.obeys_nobody(watch, reactions.UNPLUGGING, since, before)
        self.comes_down(watch, reactions.UNPLUGGING, since, [ROBOT, JOYSTICK])
        self.answers()
        self.craft.ask(device, "plug")
        self.only_died()

    def ground_killed(self):
        self.craft.kill(GROUND)
        self.craft.wait_told("the ground link is back", 4.0, self.begin)
        time.sleep(0.3)
        self.answers()
        self.only_died("COMMUNICATION")

    def safe_by_signal(self):
        asked = time.monotonic()
        self.craft.process.send_signal(signal.SIGUSR1)
        self.craft.wait_told("stop by signal or local socket", 0.5, self.begin)
        self.craft.wait_at_rest("robot", asked)
        self.craft.wait_told("everything has stopped", 1.0, self.begin)
        self.only_died()

    def safe_by_telecommand(self):
        code, reports = self.craft.tc("supervisor", "SAFE_ALL")
        truth = self.craft.truth("robot")
        expect(code == 0 and reports[-1] == "1,7", f"SAFE_ALL was answered {reports}")
        expect((truth["motor_1"], truth["motor_2"]) == (0.0, 0.0), f"it was completed while the robot moved: {truth}")
        self.only_died()

    def supervisor_killed(self):
        self.supervisor_lost(signal.SIGKILL)

    def supervisor_stopped(self):
        self.supervisor_lost(signal.SIGSTOP)

    def supervisor_lost(self, number):
        """Cycles and links run on, and another one goes on with them as they are."""
        with link_gaps.watched(self.craft, (ROBOT, JOYSTICK)) as watch:
            lost = self.craft.kill("hirosco-supervisor", number)
            self.another_goes_on(lost)
            there = time.monotonic()
        self.no_link_had_a_gap(watch, (ROBOT, JOYSTICK), lost, there)
        changed = [line.told for line in self.craft.told(self.begin) if "STATE_CHANGED" in line.told and "SUPERVISOR" not in line.told]
        expect(not changed, f"a lost supervisor changed {changed[:1]}")
        self.answers()
        self.only_died()

    def another_goes_on(self, lost):
        adopted = self.craft.wait_told("this supervisor goes on for one that died", 5.0, self.begin).received - lost
        late = self.host.stood_still_s(lost, lost + adopted)
        expect(adopted <= ADOPTED_S + late, f"another supervisor went on only after {adopted:.2f} s")
        self.took("adopted", adopted)
        self.supervisors_lost += 1

    def keeper_stopped(self):
        """A flight that runs goes on without anybody who would bring up another supervisor, and says so."""
        stopped = time.monotonic()
        self.craft.process.send_signal(signal.SIGSTOP)
        try:
            told = self.craft.wait_told("the keeper stands still", STILL_S + 2 * STILL_PACE_S, self.begin).received - stopped
            self.answers()
        finally:
            self.craft.process.send_signal(signal.SIGCONT)
        late = self.host.stood_still_s(stopped, stopped + told)
        expect(told <= STILL_S + STILL_PACE_S + late, f"that the keeper stands still was told after {told:.2f} s")
        self.took("a still keeper is told of", told)
        self.only_died()

    def supervisor_killed_in_a_stop(self):
        """Whoever comes after it finishes what it had begun."""
        asked = time.monotonic()
        self.craft.process.send_signal(signal.SIGUSR1)
        time.sleep(self.random.uniform(0.0, 0.02))
        lost = self.craft.kill("hirosco-supervisor")
        self.craft.wait_at_rest("robot", asked)
        self.another_goes_on(lost)
        self.craft.wait_told("everything has stopped", 5.0, self.begin)
        truth = self.craft.truth("robot")
        expect((truth["motor_1"], truth["motor_2"]) == (0.0, 0.0), f"the robot moves after a stop: {truth}")
        self.only_died()

    def killed_in_a_mode_change(self):
        """The change ends in the old mode, in the new one or in a safe craft; an operator's next change brings it back."""
        victim, change = self.victim(), []
        asks = threading.Thread(target=lambda: change.append(self.craft.tc("supervisor", "SET_MODE", MODES["standalone"])))
        asks.start()
        self.craft.wait_told("change from mode", 5.0, self.begin)
        time.sleep(self.random.uniform(0.0, 0.05))
        killed = self.craft.kill(victim)
        self.craft.wait_told(f"{self.name(victim)} died: signal 9", 2.0, self.begin)
        asks.join()
        expect(change[0][1] and change[0][1][-1] in ("1,7", "1,8"), f"the change was answered {change}")
        self.craft.wait_told(f"started {self.name(victim)}", BACK_S, self.begin)
        moving = [name for name in ("MANIPULATOR", "JOYSTICK") if self.state(name) == "Operational"]
        if "MANIPULATOR" not in moving:
            self.craft.wait_at_rest("robot", killed)
        self.answers()
        begin = self.craft.count()
        back = self.craft.tc("supervisor", "SET_MODE", MODES["telepresence"])
        expect(back[0] == 0, f"back to telepresence: {back[1]}; {[line.told for line in self.craft.told(begin)][-3:]}")
        self.only_died(self.name(victim))

# killed: two subsystems in turn
KINDS = {"spinning": 1, "stopped": 1, "unplugged": 1, "killed": 2, "ground_killed": 1, "supervisor_killed": 1, "supervisor_stopped": 1}
PER_FLIGHT = 10
LATE_FLIGHTS = 3            # of one number, before a host that is late again and again counts as a failure


def keep_evidence(craft, folder):
    kept = folder / time.strftime("%Y%m%dT%H%M%S", time.gmtime())
    shutil.copytree(craft.folder / "log", kept / "log")
    (kept / "told.txt").write_text(craft.story(), encoding="utf-8")
    print(f"  evidence: {kept}", flush=True)


def flown(mission, trial, again, evidence=None):
    """Whether it flew without a violation; None: it could not be brought up because the host was late, which says nothing."""
    before = flight.segments()
    with punctual.Lateness() as trial.host:
        try:
            with flight.Flight(mission, quiet=True) as craft:
                told = craft
                try:
                    trial.fly(craft)
                except (Violation, AssertionError):
                    if evidence:
                        keep_evidence(craft, evidence)
                    raise
            expect(flight.segments() == before, "I7: shared memory was left behind")
            return True
        except (Violation, AssertionError) as problem:
            violation = problem
    if isinstance(violation, Unready) and trial.host.worst_s is not None and trial.host.worst_s > punctual.WATCHDOG_S:
        print(f"{violation}, on a host that was late by {1e3 * trial.host.worst_s:.0f} ms: a new flight", flush=True)
        return None
    story = "\n".join(line for line in told.story().splitlines()[-60:] if "STATE_CHANGED" not in line)
    late = "unknown" if trial.host.worst_s is None else f"{1e3 * trial.host.worst_s:.0f} ms"
    print(f"{story}\n  VIOLATION {violation}\n  the host was late by {late}\n  again: real_campaign.py {again}", flush=True)
    return False


def table(figures):
    """A row for each figure: what it took, and how much of its deadline was left at worst. A deadline is longer by what the host stood
    still in that time, and what it takes without anybody's deadline has none."""
    rows = []
    for what, seconds in figures.items():
        seconds.sort()
        margin = f", deadline {1e3 * DEADLINES_S[what]:.1f} ms, margin {1e3 * (DEADLINES_S[what] - seconds[-1]):.1f} ms" if what in DEADLINES_S else ""
        if what in link_gaps.DEADLINES_S:
            margin += f", worst {seconds[-1] / CYCLE_S:.0f} cycles"
        rows.append(f"    {what:39} median {1e3 * seconds[len(seconds) // 2]:8.1f} ms, p99 {1e3 * seconds[int(0.99 * len(seconds))]:8.1f} ms, "
                    f"worst {1e3 * seconds[-1]:8.1f} ms of {len(seconds)}{margin}")
    return rows


def hundreds(mission, seed, times, evidence):
    """Each kind so many times, in flights of ten; the table of what it took. Whether each was done as often as was asked for, without a violation."""
    violations, late, lacking, rows = 0, 0, [], []
    for kind, share in KINDS.items():
        figures, done, wanted, number = {}, 0, share * times, 0
        while done < wanted and number < 2 * wanted:
            trial = Trial(seed, number, kind, min(PER_FLIGHT, wanted - done))
            number += 1
            outcome = flown(mission, trial, f"--hundreds {times} --seed {seed}", evidence)
            violations += outcome is False
            late += outcome is None
            done += trial.done
            for what, seconds in trial.figures.items():
                figures.setdefault(what, []).extend(seconds)
        if done < wanted:
            lacking.append(f"{kind} was done {done} times of {wanted}")
        rows.append(f"{kind:14} {done}/{wanted} times brought up again")
        rows.extend(table(figures))
        print("\n".join(rows[-1 - len(figures):]), flush=True)
    print("\nAll together\n" + "\n".join(rows) + f"\n{violations} violations; {late} new flights because the host was late")
    if lacking:
        print("FEWER than were asked for: " + "; ".join(lacking), flush=True)
    return not violations and not lacking


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--flights", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    parser.add_argument("--kind", help="each fault of a flight is of this kind, which is the name of a function of Trial")
    parser.add_argument("--keep", type=pathlib.Path, help="a line for each flight; those that this build has flown by it are not flown again")
    parser.add_argument("--hundreds", type=int, nargs="?", const=100)
    parser.add_argument("--evidence", type=pathlib.Path, help="the log of a flight with a violation is kept in this folder")
    options = parser.parse_args()
    if options.keep and (options.hundreds or options.only is not None):
        parser.error("--keep is of flights that are flown one after the other: not with --hundreds or --only")
    with flight.MissionCopy({**SPINNABLE, **RESTARTS}) as mission:
        if options.hundreds:
            return 0 if hundreds(mission, options.seed, options.hundreds, options.evidence) else 1
        numbers = [options.only] if options.only is not None else range(options.flights)
        kept = KeptFlights(options.keep, mission, options.seed, options.kind)
        for number in numbers:
            if number in kept.passed:
                continue
            trial = Trial(options.seed, number, options.kind)
            print(f"flight {number}: {' '.join(step.__name__ for step in trial.steps)}", flush=True)
            for _ in range(LATE_FLIGHTS):
                outcome = flown(mission, trial, f"--seed {options.seed} --only {number}", options.evidence)
                if outcome is not None:
                    break
                trial = Trial(options.seed, number, options.kind)
            kept.add(number, bool(outcome), trial.figures)
    failed = sum(not kept.passed[number] for number in numbers)
    print("\n".join(table(kept.figures)))
    print(f"{len(numbers) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
