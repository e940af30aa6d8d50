# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_campaign.py demands of a craft, whatever befell it: it answers, nobody died but who was to, it is whole again by one bring-up,
and all that was said can be had."""
import pathlib
import time

import floods
import punctual
import said_again

# What the supervisor may take to answer, and what `hirosco tc` itself takes to start on a busy computer.
ANSWER_S, TOOL_S = 0.2, 0.3
BACK_S = 2.0                        # who died is there again


class Violation(Exception):
    pass


class Unready(Violation):
    """What was brought up did not stay so. Of a host that is late that is no violation: devices let go, as they must."""


def expect(good, what, otherwise=Violation):
    if not good:
        raise otherwise(what)


class Demands:
    """On a craft that flies: `craft`, and `begin`, the line of its story from which on is judged. Both are set by whoever flies it."""

    def __init__(self):
        self.craft, self.begin, self.up_since = None, 0, 0
        self.figures = {}           # what took how long: [seconds]
        self.host = punctual.Lateness()  # that of the flight, where one is flown
        self.reach = 0.01           # of the hand, to and fro
        self.supervisors_lost = 0

    def still_up(self):
        """Nothing of its own may take the craft down between a bring-up and the next fault: that fault would find nobody to stop."""
        down = [line.told for line in self.craft.told(self.up_since) if ": network {" in line.told]
        expect(not down, f"before the next fault: {down[:1]}", Unready)

    def taken(self):
        return len(list(pathlib.Path(f"/proc/{self.craft.pid_of('hirosco-supervisor')}/fd").iterdir()))

    def took(self, what, seconds):
        self.figures.setdefault(what, []).append(seconds)

    def late_s(self, watch, begin, end):
        """Nobody was earlier than the watch could see, nor did anybody run on a processor while the host gave it to nobody."""
        return max(watch.worst_s, self.host.stood_still_s(begin, end))

    def answers(self):
        begin = time.monotonic()
        code, reports = self.craft.tc("supervisor", "ping")
        took = time.monotonic() - begin
        expect(code == 0, f"I6: ping was answered {reports}")
        late = self.host.stood_still_s(begin, begin + took)
        expect(took < ANSWER_S + TOOL_S + late, f"I6: ping took {took:.2f} s")

    def what_was_said_comes_again(self):
        """All reports of this flight but housekeeping, as its log has them: in order, each once, and its end says so."""
        begun = time.monotonic()
        try:
            came, end = said_again.all_again(20.0)
        except (AssertionError, OSError) as problem:
            raise Violation(f"I14: {problem}") from problem
        self.took("what was said comes again", time.monotonic() - begun)
        numbers = [number for number, _ in came]
        expect(numbers == sorted(set(numbers)), "I14: what was said did not come in order, each once")
        records = self.craft.log()
        # A report goes to the ground before it is on the disk: of a supervisor that dies in between a gap tells, which is counted.
        gaps = [floods.lost_in(record) for record in records if record["kind"] == "gap"]
        expect(len(gaps) <= self.supervisors_lost, f"I14: {len(gaps)} gaps of the log where {self.supervisors_lost} supervisors died")
        expect(end == (len(came), 0, sum(gaps), 0, ""), f"I14: {len(came)} reports came, {sum(gaps)} stand in gaps, its end tells of {end}")
        stored = [record["number"] for record in records if record["kind"] in ("telemetry", "event") and "TM[3,25]" not in record["text"]]
        expect(numbers, "I14: nothing of what was said came")
        lacking = set(number for number in stored if number <= numbers[-1]) ^ set(numbers)
        expect(not lacking, f"I14: {len(lacking)} reports stand in the log or came, and not both, the first {min(lacking, default=0)}")

    def only_died(self, *victims):
        words = [line.told.split() for line in self.craft.told(self.begin)]
        died = {told[0] for told in words if told[1:2] == ["died:"] and told[0] != "plan"}
        expect(died <= set(victims), f"I1: {died} died where {victims} were to")

    def bring_up(self):
        """The one bring-up of an operator; whoever died must be back within 2 s. Who is further on already refuses a step:
        the states in the end decide."""
        craft = self.craft
        for line in craft.told(self.begin):
            if line.told.split()[1:2] == ["died:"] and line.told.split()[0] != "plan":
                back = craft.wait_told(f"started {line.told.split()[0]}", BACK_S, self.begin)
                expect(back.at_s - line.at_s < BACK_S, f"{line.told.split()[0]} was back after 2 s only")
                self.took("back after its death", back.at_s - line.at_s)
        time.sleep(0.5)
        self.up_since = craft.count()
        craft.bring_up(self.do)
        self.reach = -self.reach
        craft.fault("joystick", "hand", "cartesian", 0, self.reach, 0.5)
        pushed = 0
        end = time.monotonic() + 1.0
        while time.monotonic() < end and not pushed:
            truth = craft.truth("robot")
            pushed = abs(truth["motor_1"]) + abs(truth["motor_2"])
        for name in ("MANIPULATOR", "JOYSTICK"):
            expect(self.state(name) == "Operational", f"{name} is {self.state(name)} after the bring-up", Unready)
        expect(pushed, f"the robot does not follow after the bring-up: {truth}", Unready)

    def do(self, subsystem, function, *arguments):
        code, reports = self.craft.tc(subsystem, function, *arguments)
        expect(code == 0, f"{subsystem} {function} {arguments}: {reports}")

    def state(self, name):
        status = self.craft.wait_status(lambda s: True, 3.0)
        return {member["name"]: member for member in status["subsystems"]}[name]["state"]
