#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The supervisor, its keeper or both are lost in the midst of a change of mode, a plan and a SAFE_ALL (docs/adr/0233): the supervisor is stopped
(SIGSTOP), spins, gets no more memory, or no more descriptors; the keeper is stopped or killed; both are. `--rounds N`: each way in each step N times,
in the order that is drawn; without it the slice of a check: of one flight whose members nobody has to bring back from the rail. Behind each loss it is
looked whether it fell into the step: one that missed is tried again, and too few hits are a failure. Looked at by pages of the members, from above all
cycles: who is Operational or Safe-Operational makes its cycles and keeps its links. In the end what the client sent and heard is compared with each other
and with the log (accounts.py). The last loss, of both, is the control: nobody goes on, the judge of that has to complain, and members are safe after T."""
import contextlib
import math
import os
import random
import resource
import select
import signal
import struct
import sys
import time

import accounts
import flight
import honest
import judges
import kill_windows
import late_host
import pages
import step_judges
import stored_log
import supervisors
import witness

ROUNDS = int(sys.argv.pop(sys.argv.index("--rounds") + 1)) if "--rounds" in sys.argv else 0
if "--rounds" in sys.argv:
    sys.argv.remove("--rounds")
SEED = 20261130
# Who looks for the begin of a plan is not to wait for the threads that listen.
sys.setswitchinterval(0.0002)
# A supervisor that lives for 2 s is no part of a crash loop (supervisor/keeper/kept.hpp).
LIVES_S = 2.2
STANDALONE, TELEPRESENCE = 2, 3
MACHINES = ("hirosco-manipulator", "hirosco-joystick")
MODE_CHANGE, PLAN, SAFE_ALL = "mode change", "plan", "SAFE_ALL"
STEPS = (MODE_CHANGE, PLAN, SAFE_ALL)
# How long a step is at first taken for; Aim learns it. A plan takes 2 ms, and is seen by the state of who lost its device.
LONGEST_S = {MODE_CHANGE: 0.02, PLAN: 0.0004, SAFE_ALL: 0.02}
HIGH, STATE_CHANGED, OFFLINE = 4, 0xF000, 0
TRIES = 8
# Of who looks for the begin of a plan: above all that is not real-time, below cycles.
ABOVE_LOOPS = 20
STOPPED, SPINS, MEMORY, DESCRIPTORS, KEEPER_STOPPED, KEEPER_KILLED, BOTH_KILLED = (
    "stopped", "spins", "without memory", "without descriptors", "keeper stopped", "keeper killed", "both killed")
ORPHANS_GONE_S = 10.0
# The log, for longer than nobody was there.
SILENT_S = 0.5
# Reports of the step in which a supervisor hangs, which its log goes on to store.
OF_ONE_STEP = 16
# Until a supervisor that leaks has nothing left, at the most.
LEAKED_S = 20.0


def limit(pid, which, soft):
    """The soft limit bites; the hard one stays, or nobody could take it back."""
    resource.prlimit(pid, which, (soft, resource.prlimit(pid, which)[1]))


class LostInSteps(accounts.Accounts):
    """One flight, in which it is lost again and again."""
    starves = False               # of memory, and may die of it before its telecommand is accepted

    def fly(self, kind, wanted):
        """`wanted`: {(way, step): how often}; `kind` of the supervisor (supervisors.py)."""
        self.draw = random.Random(SEED)
        self.tally = kill_windows.Tally({f"{way} in a {step}": times for (way, step), times in wanted.items()})
        self.aims = {key: kill_windows.Aim(self.draw, LONGEST_S[key[1]]) for key in wanted}
        self.tally.TRIES = TRIES
        self.deaths, self.took = [], {}
        keys = {f"{way} in a {step}": (way, step) for way, step in wanted}
        with late_host.LateHost() as self.host, supervisors.instead(kind) as programs, \
             flight.Flight(binaries=programs, environment={"MALLOC_ARENA_MAX": "1"}) as self.craft:
            self.craft.wait_commissioned()
            before = self.craft.log(last=1)[-1]["number"]
            self.ground = witness.Witness()
            self.client = witness.Client(self.ground)
            try:
                self.time_a_plan()
                while windows := self.tally.open():
                    name = self.draw.choice(windows)
                    self.tally.count(name, self.strike(*keys[name]))
                if kind == "spinnable":
                    self.both_stand_still()
                time.sleep(LIVES_S)
            finally:
                self.client.ending = True
                self.client.thread.join()
                sent = list(self.client.sent)
                flight.measure(f"{self.tally}; {len(sent)} telecommands; another one went on " + ", ".join(
                    f"{max(times):.3f} s at most behind one that {way}" for way, times in self.took.items()))
            for packet, _ in sent[-200:]:
                self.ground.verdict(packet, 5.0)
            nobody_s = max((gone_on - lost for lost, gone_on in self.deaths), default=0.0)
            self.compare(self.craft, self.ground, sent, self.deaths, len(self.deaths) // 50 + 1, before, nobody_s + SILENT_S,
                         len(self.deaths) // 50 + 1 + OF_ONE_STEP * len(self.took.get(SPINS, [])))
            self.assertEqual(self.tally.missed(), [], "each window was hit as often as is wanted")

    # --- a loss in a step -------------------------------------------------------------------------------------------------

    def strike(self, way, step):
        """Why it missed, or HIT."""
        self.ready()
        self.begin, self.pid = self.craft.count(), self.craft.pid_of("hirosco-supervisor")
        aim, self.starves = self.aims[way, step], way == MEMORY
        with pages.Watch(self.craft, MACHINES) as watch:
            since, died = time.monotonic(), len(self.deaths)
            if way == DESCRIPTORS:
                limit(self.pid, resource.RLIMIT_NOFILE, len(os.listdir(f"/proc/{self.pid}/fd")))
            if way == MEMORY:
                self.leak()
            packet = self.begins(step)
            time.sleep(aim.wait_s() if way not in (DESCRIPTORS, MEMORY) else 0.0)
            lost, gone_on = self.WAYS[way](self)
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
            self.ends(step, packet)
            self.over(way)
        miss = self.missed_by(way, step, packet, since, lost)
        aim.learn(miss == kill_windows.HIT)
        told = [complaint for program in MACHINES for complaint in step_judges.stood_still(watch, program, lost, gone_on)]
        if len(self.deaths) > died:
            self.took.setdefault(way, []).append(gone_on - lost)
            told += step_judges.gone_on_late(lost, gone_on, step_judges.PATIENCE_S if way == SPINS else 0.0)
        status = self.craft.wait_status(lambda _: True, 3.0)
        told += step_judges.ended_elsewhere(step, "telepresence", "standalone", status)
        late = 0.0 if not told else self.host.worst_s()
        self.assertEqual(told, [], f"{way} in a {step}, on a host that was late by {1e3 * late:.1f} ms\n{self.since()}")
        return miss

    def since(self):
        return "\n".join(f"{line.at_s:.4f} s  {line.told}" for line in self.craft.told(self.begin))

    def ready(self):
        """Both machines move, in telepresence, under a supervisor that has lived long enough."""
        time.sleep(max(0.0, (self.deaths[-1][1] if self.deaths else 0.0) + LIVES_S - time.monotonic()))
        self.craft.ask("joystick", "plug")
        end = time.monotonic() + 15.0
        while self.craft.tc("supervisor", "SET_MODE", TELEPRESENCE)[0] != 0:
            self.assertLess(time.monotonic(), end, f"it flies again\n{self.since()}")
            time.sleep(0.3)
        self.host.forget()

    def begins(self, step):
        """Of a plan nothing: it has no telecommand."""
        if step == PLAN:
            page = pages.Vital(self.craft.pid_of("hirosco-joystick"))
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(ABOVE_LOOPS))
            self.sent_at_s = time.monotonic()
            self.craft.ask("joystick", "unplug")
            while page.state() == step_judges.OPERATIONAL and time.monotonic() < self.sent_at_s + 2.0:
                pass              # of some milliseconds that the plan takes no sleep may take one
            return None
        packet = honest.safe_all(self.ground.next()) if step == SAFE_ALL else honest.call(self.ground.next(), "SET_MODE", bytes([STANDALONE]))
        self.sent_at_s = time.monotonic()
        self.client.send(packet)
        accepted = self.ground.wait(lambda: any(subtype == 1 or subtype in honest.ENDS for subtype, _ in self.heard_of(packet)), 2.0 if self.starves else 8.0)
        self.assertTrue(accepted or self.starves, f"{step} is accepted\n{self.since()}")
        return packet

    def ends(self, step, packet):
        if step == PLAN:
            ends = [self.craft.wait_line(lambda line, name=name: f"{name} info STATE_CHANGED STATE=Offline" in line.told, 5.0, self.begin)
                    for name in ("MANIPULATOR", "JOYSTICK")]
            # Of an event that is being read at the very loss nobody knows (docs/adr/0217); what was told to begin is carried out.
            begun = [line.told for line in self.craft.told(self.begin) if "plan network-down" in line.told]
            self.assertTrue(all(ends) or not begun, f"a plan that has begun is carried out\n{self.since()}")
            return
        if self.starves and not self.heard_of(packet):
            return              # it was being read as there was no memory left (docs/adr/0217)
        ended = self.ground.wait(lambda: any(subtype in honest.ENDS for subtype, _ in self.heard_of(packet)), 15.0)
        self.assertTrue(ended, f"{step} has an end\n{self.since()}")

    def time_a_plan(self):
        """One that nobody is lost in."""
        self.begin = self.craft.count()
        self.begins(PLAN)
        seen = time.monotonic()
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        self.ends(PLAN, None)
        begun, ended = self.plan_noted()
        flight.measure(f"a plan takes {1e3 * (ended - begun):.1f} ms; that it is under way is seen {1e3 * (seen - begun):.1f} ms behind its event")

    def plan_noted(self):
        """When the supervisor noted the event, and that both are Offline, by the log, which has it as soon as a second later."""
        time.sleep(judges.TELEMETRY_S)
        told = [record for record in self.newest_records() if record.at > self.sent_at_s and record.packet[7:8] == b"\5"]
        begun = min((record.at for record in told if record.packet[8] == HIGH and self.said_by(record) == flight.JOYSTICK), default=math.inf)
        offline = {self.said_by(record): record.at for record in told if record.packet[20:23] == struct.pack(">HB", STATE_CHANGED, OFFLINE)}
        return begun, max(offline.get(apid, math.inf) for apid in (flight.MANIPULATOR, flight.JOYSTICK))

    def plan_told(self):
        """The same by what a supervisor told until it was lost, when records of its last milliseconds have not come to the disk: long ago, or never."""
        told = [line.told for line in self.craft.told(self.begin)]
        told = told[:next((place for place, text in enumerate(told) if "goes on for one that died" in text), len(told))]
        ended = all(any(f"{name} info STATE_CHANGED STATE=Offline" in text for text in told) for name in ("MANIPULATOR", "JOYSTICK"))
        return -math.inf if any("plan network-down" in text for text in told) else math.inf, -math.inf if ended else math.inf

    @staticmethod
    def said_by(record):
        return (record.packet[0] & 7) << 8 | record.packet[1]

    def heard_of(self, packet):
        """[(subtype, when)] since it was sent: its number was another one's 16384 telecommands before."""
        with self.ground.arrived:
            return [(subtype, at) for subtype, at in self.ground.reports.get(packet[:4], []) if at >= self.sent_at_s]

    def missed_by(self, way, step, packet, since, lost):
        if way == DESCRIPTORS:
            return kill_windows.HIT if step == PLAN else step_judges.in_the_whole(self.heard_of(packet), since, time.monotonic())
        if step == PLAN:
            return step_judges.in_a_plan(*(self.plan_noted() if way == KEEPER_STOPPED else self.plan_told()), lost)
        if way == KEEPER_STOPPED:
            return step_judges.in_a_step(self.heard_of(packet), lost)
        return kill_windows.in_a_telecommand(self.heard_of(packet), self.newest_records(), packet[:4], lost, self.deaths[-1][1])

    def newest_records(self):
        newest = [path for _, path in stored_log.pieces(self.craft.folder / "log")[-2:]]
        return [record for path in newest for record in stored_log.records_of(path) if record.at > time.monotonic() - 30.0]

    # --- ways: when it was lost, and when another one had gone on; the same, where nobody has to ---------------------------------------

    def stopped(self):
        return self.replaced(self.sends(signal.SIGSTOP))

    def spins(self):
        return self.replaced(self.sends(signal.SIGUSR2))

    def sends(self, number):
        at = time.monotonic()
        os.kill(self.pid, number)
        return at

    def leak(self):
        octets = int(open(f"/proc/{self.pid}/status", encoding="ascii").read().split("VmSize:")[1].split()[0]) * 1024
        limit(self.pid, resource.RLIMIT_AS, octets)
        self.process = os.pidfd_open(self.pid)
        self.starved = self.sends(signal.SIGUSR2)

    def without_memory(self):
        try:
            self.assertTrue(select.select([self.process], [], [], LEAKED_S)[0], "it ends of it")
            ended = time.monotonic()
            _, gone_on = self.replaced(self.starved)      # its log, too, had no memory from then on
            return ended, gone_on
        finally:
            os.close(self.process)

    def replaced(self, lost):
        told = self.craft.wait_told("goes on with MANIPULATOR", 5.0, self.begin)
        self.deaths.append((lost, told.received))
        return self.deaths[-1]

    def without_descriptors(self):
        """All through the step: it refuses what it cannot do, and lives."""
        return time.monotonic(), time.monotonic() + 0.5

    def keeper_stopped(self):
        at = time.monotonic()
        self.craft.process.send_signal(signal.SIGSTOP)
        return at, at + 0.5

    def over(self, way):
        """What was taken away is there again."""
        self.craft.process.send_signal(signal.SIGCONT)
        with contextlib.suppress(ProcessLookupError):
            hard = resource.prlimit(self.pid, resource.RLIMIT_NOFILE)[1]
            resource.prlimit(self.pid, resource.RLIMIT_NOFILE, (hard, hard))
        if way in (DESCRIPTORS, KEEPER_STOPPED):
            self.assertEqual(self.craft.pid_of("hirosco-supervisor"), self.pid, "it is the same one")

    WAYS = {STOPPED: stopped, SPINS: spins, MEMORY: without_memory, DESCRIPTORS: without_descriptors, KEEPER_STOPPED: keeper_stopped}

    # --- both -------------------------------------------------------------------------------------------------------------

    def both_stand_still(self):
        """In the midst of a change of mode; and the control of whoever judges that another one goes on."""
        self.ready()
        self.begin, self.pid = self.craft.count(), self.craft.pid_of("hirosco-supervisor")
        with pages.Watch(self.craft, MACHINES) as watch:
            packet = self.begins(MODE_CHANGE)
            self.craft.process.send_signal(signal.SIGSTOP)
            lost = self.sends(signal.SIGSTOP)
            time.sleep(step_judges.SAFE_AFTER_S + 2 * step_judges.LOOK_S)
            alone_until = time.monotonic()
            self.craft.process.send_signal(signal.SIGCONT)
            _, gone_on = self.replaced(lost)
            self.ends(MODE_CHANGE, packet)
        self.assertEqual(len(step_judges.gone_on_late(lost, gone_on, 0.0)), 1, "the judge sees that nobody went on in time")
        self.assertEqual([told for program in MACHINES for told in step_judges.moves_still(watch, program, lost, alone_until)], [])
        flight.measure(f"both stopped for {alone_until - lost:.2f} s: members are safe, another one goes on {gone_on - alone_until:.3f} s behind the keeper")

    def alone(self, way, step):
        """A flight of its own, as it has no keeper from then on. Returns why it missed, or HIT."""
        aim = self.aims[way, step]
        with flight.Flight() as self.craft:
            self.craft.wait_commissioned()
            self.ground = witness.Witness()
            self.client = witness.Client(self.ground)
            self.begin, self.pid = self.craft.count(), self.craft.pid_of("hirosco-supervisor")
            with pages.Watch(self.craft, MACHINES) as watch:
                packet = self.begins(step)
                time.sleep(aim.wait_s())
                lost = time.monotonic()
                os.kill(self.craft.process.pid, signal.SIGKILL)
                if way == BOTH_KILLED:
                    os.kill(self.pid, signal.SIGKILL)
                os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
                if way == BOTH_KILLED:
                    heard = self.heard_of(packet) if packet else []
                    left = self.craft.wait_until_gone(ORPHANS_GONE_S)
                else:
                    self.ends(step, packet)
                    heard, left = self.heard_of(packet) if packet else [], {}
                until = time.monotonic()
            self.client.ending = True
            self.assertEqual(left, {}, f"{way} in a {step}")
            plan = self.plan_told if way == BOTH_KILLED else self.plan_noted
            miss = step_judges.in_a_plan(*plan(), lost) if step == PLAN else step_judges.in_a_step(heard, lost)
            if way == BOTH_KILLED:
                self.assertEqual([told for program in MACHINES for told in step_judges.moves_still(watch, program, lost, until)], [])
            else:
                self.craft.wait_told("SUPERVISOR high KEEPER_LOST", 1.0, self.begin)
                self.craft.kill("hirosco-supervisor", signal.SIGTERM)
                self.assertEqual(self.craft.wait_until_gone(ORPHANS_GONE_S), {})
        aim.learn(miss == kill_windows.HIT)
        return miss


if ROUNDS == 0:
    class Slice(LostInSteps):
        def test_a_loss_in_each_step_leaves_the_old_mode_the_new_one_or_rest(self):
            self.fly("spinnable", {(STOPPED, SAFE_ALL): 1, (SPINS, MODE_CHANGE): 1, (SPINS, PLAN): 1, (DESCRIPTORS, MODE_CHANGE): 1,
                                   (KEEPER_STOPPED, MODE_CHANGE): 1})
else:
    class Whole(LostInSteps):
        def test_each_way_in_each_step(self):
            self.fly("spinnable", {(way, step): ROUNDS for way in (STOPPED, SPINS, DESCRIPTORS, KEEPER_STOPPED) for step in STEPS})

        def test_without_memory_in_each_step(self):
            # For the 2 ms of a plan the end of a leak cannot be aimed.
            self.fly("leaking", {(MEMORY, step): ROUNDS for step in (MODE_CHANGE, SAFE_ALL)})

        def test_without_a_keeper_and_without_both_from_each_step_on(self):
            ways = {f"{way} in a {step}": (way, step) for way in (KEEPER_KILLED, BOTH_KILLED) for step in STEPS}
            tally, draw = kill_windows.Tally(dict.fromkeys(ways, ROUNDS)), random.Random(SEED)
            tally.TRIES = TRIES
            self.aims = {key: kill_windows.Aim(draw, LONGEST_S[key[1]]) for key in ways.values()}
            with flight.Flight() as self.craft:
                self.craft.wait_commissioned()
                self.time_a_plan()
            while windows := tally.open():
                tally.count(windows[0], self.alone(*ways[windows[0]]))
            flight.measure(f"{tally}")
            self.assertEqual(tally.missed(), [])


if __name__ == "__main__":
    flight.main()
