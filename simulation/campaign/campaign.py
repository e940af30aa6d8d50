#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Flies a mission under random plans and has each flight judged. The drawing aims at what was seldom covered so far."""
import argparse, collections, concurrent.futures, json, os, pathlib, random, resource, signal, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "judge"))
from descriptors import STATES, read_mission  # noqa: E402
from judge import judge  # noqa: E402
from draw import Draw, commands_of, faults_of, out_of_reach  # noqa: E402
from flown_build import build_of, modules_of  # noqa: E402
from shrink import shrink  # noqa: E402

BATCH = 20                 # flights that are drawn from the same coverage
AIM_COMMANDS, AIM_FAULTS = 50, 10
COMMAND_GOAL, FAULT_GOAL = 20, 10
PROCESSOR_LIMIT_S = 120    # of a flight, which takes one or two: a busy host is no fault of the flight


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR_LIMIT_S, PROCESSOR_LIMIT_S + 5))


class Pilot:
    """Flies plans and has them judged."""

    def __init__(self, mission, fly_plan, defect=None):
        self.mission, self.fly_plan, self.defect = mission, fly_plan, defect
        self.judged = read_mission(mission)

    def fly(self, plan, folder=None):
        """{"violations": [[invariant, seconds, text]], ...}"""
        with tempfile.TemporaryDirectory() as own:
            folder = pathlib.Path(folder or own)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "plan.txt").write_text(plan)
            command = [self.fly_plan, self.mission, folder / "plan.txt", folder] + ([self.defect] if self.defect else [])
            flown = subprocess.run(command, capture_output=True, text=True, preexec_fn=limited)
            if flown.returncode == -signal.SIGXCPU:
                return {"violations": [["I1", 0, "the flight does not end"]], "commands": {}, "faults": {}}
            if flown.returncode != 0:
                last = (flown.stderr.strip().splitlines() or [""])[-1]
                return {"violations": [["I1", 0, f"the flight ended with {flown.returncode}: {last}"]], "commands": {}, "faults": {}}
            return judge(self.judged, folder)


def emptiest(cells, covered, goal, number, turn, seed):
    """The next `number` cells of those that are covered least, each flight of a batch its own as far as there are enough.
    Cells of one state stand together: the craft is driven there once."""
    place = list(range(len(cells)))
    random.Random(seed).shuffle(place)
    order = {cell: at for cell, at in zip(cells, place)}
    empty = sorted((cell for cell in cells if covered[cell] < goal), key=lambda cell: (covered[cell], state_of(cell), order[cell]))
    start = turn * number
    if start >= len(empty):
        start %= max(len(empty), 1)
    return empty[start:start + number]


def state_of(cell):
    return next(part for part in cell.split("|") if part in STATES)


class Campaign:
    def __init__(self, arguments):
        self.arguments = arguments
        self.mission = read_mission(arguments.mission)
        self.pilot = Pilot(arguments.mission, arguments.fly_plan, arguments.defect)
        self.commands, self.faults = collections.Counter(), collections.Counter()
        self.out_of_reach = out_of_reach(self.mission)
        self.command_cells = [cell for cell in commands_of(self.mission) if cell not in self.out_of_reach]
        self.fault_cells = [cell for cell in faults_of(self.mission) if cell not in self.out_of_reach]
        self.failed, self.violations, self.flown, self.before_s = [], 0, 0, 0.0
        self.kept = pathlib.Path(arguments.keep) if arguments.keep else None
        self.of = self.of_what() if self.kept else None
        if self.kept and self.kept.exists():
            self.go_on(json.loads(self.kept.read_text()))

    def of_what(self):
        """What a campaign that goes on must have alike."""
        mission, fly_plan = self.arguments.mission, self.arguments.fly_plan
        return {"mission": str(pathlib.Path(mission).resolve().name), "seed": self.arguments.seed, "defect": self.arguments.defect,
                "build": build_of(mission, [fly_plan, *modules_of(mission, fly_plan)])}

    def go_on(self, kept):
        if kept["of"] != self.of:
            raise SystemExit(f"{self.kept}: is the campaign of {kept['of']}, not of {self.of}: name another file, or take it away")
        self.commands.update(kept["commands"])
        self.faults.update(kept["faults"])
        self.failed, self.violations, self.flown, self.before_s = kept["failed"], kept["violations"], kept["flown"], kept["seconds"]

    def keep(self, flown, seconds):
        """In one stroke: whoever is killed here goes on from the batch before."""
        if self.of != self.of_what():
            raise SystemExit(f"{self.kept}: {flown} flights, the last of them flown while the programs were built anew: those until the batch before are kept")
        kept = {"of": self.of, "flown": flown, "seconds": seconds, "violations": self.violations, "failed": self.failed,
                "commands": self.commands, "faults": self.faults}
        new = self.kept.with_name(self.kept.name + ".new")
        new.write_text(json.dumps(kept))
        new.replace(self.kept)

    def plan(self, index):
        turn = index % BATCH
        seed = f"{self.arguments.seed}/{index // BATCH}"
        commands = emptiest(self.command_cells, self.commands, COMMAND_GOAL, AIM_COMMANDS, turn, seed)
        faults = emptiest(self.fault_cells, self.faults, FAULT_GOAL, AIM_FAULTS, turn, seed)
        return Draw(self.mission, self.arguments.seed, index, commands, faults).text()

    def run(self):
        started = time.monotonic() - self.before_s
        only, flights = self.arguments.only, self.arguments.flights
        last = flights if only is None else only + 1
        with concurrent.futures.ThreadPoolExecutor(self.arguments.jobs) as pool:
            for first in range(self.flown, last, BATCH):
                batch = range(first, min(first + BATCH, last))
                plans = {index: self.plan(index) for index in batch}
                wanted = [index for index in batch if only is None or index == only or first + BATCH <= only]
                for index, result in zip(wanted, pool.map(lambda index: self.pilot.fly(plans[index]), wanted)):
                    self.commands.update(result["commands"])
                    self.faults.update(result["faults"])
                    if result["violations"] and only in (None, index):
                        self.tell(index, result, plans[index])
                if self.kept and batch.stop % BATCH == 0:
                    self.keep(batch.stop, time.monotonic() - started)
                print(f"{batch.stop} flown, {time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
        full = self.table()
        flown = max(last, self.flown) if only is None else 1
        wrong = [cell for cell in self.out_of_reach if self.commands[cell] + self.faults[cell]]
        for cell in wrong:
            print(f"covered, though draw.py says that it is out of reach: {cell}")
        print(f"{flown} flights, {self.violations} violations, cells full {full[0]} and {full[1]}, {time.monotonic() - started:.0f} seconds")
        return 1 if self.failed or wrong else 0

    def tell(self, index, result, plan):
        self.failed.append(index)
        self.violations += len(result["violations"])
        print(f"flight {index} of seed {self.arguments.seed}:")
        for invariant, seconds, text in result["violations"]:
            print(f"  {invariant} {seconds:.4f} s: {text}")
        if self.arguments.out:
            pathlib.Path(self.arguments.out).mkdir(parents=True, exist_ok=True)
            (pathlib.Path(self.arguments.out) / f"{index}.plan").write_text(plan)
        if self.arguments.shrink and len(self.failed) <= self.arguments.shrink:
            kind = result["violations"][0][0], result["violations"][0][2].split(" ")[0]
            small = shrink(plan, lambda text: any((v[0], v[2].split(" ")[0]) == kind for v in self.pilot.fly(text)["violations"]),
                           self.arguments.jobs)
            print("  no action of this plan can be left out:\n    " + "\n    ".join(small.splitlines()))
            for invariant, seconds, text in self.pilot.fly(small)["violations"]:
                print(f"    -> {invariant} {seconds:.4f} s: {text}")
        sys.stdout.flush()

    def table(self):
        """State by state: how many cells reached their goal, and the emptiest. Returns "full/all" of both kinds."""
        shares = []
        for title, cells, covered, goal in (("state x telecommand x origin", self.command_cells, self.commands, COMMAND_GOAL),
                                            ("fault x state x member", self.fault_cells, self.faults, FAULT_GOAL)):
            print(f"{title}, each at least {goal} times:")
            print(f"  {'state':<18}{'cells':>7}{'full':>7}{'never':>7}{'least':>7}{'in all':>9}")
            for state in sorted({state_of(cell) for cell in cells}, key=STATES.index):
                counts = [covered[cell] for cell in cells if state_of(cell) == state]
                print(f"  {state:<18}{len(counts):>7}{sum(n >= goal for n in counts):>7}{counts.count(0):>7}{min(counts):>7}{sum(counts):>9}")
            lacking = sorted((covered[cell], cell) for cell in cells if covered[cell] < goal)
            for number, cell in lacking[:len(lacking) if self.arguments.table else 10]:
                print(f"    {number:>3} {cell}")
            shares.append(f"{len(cells) - len(lacking)}/{len(cells)}")
        print("out of reach:" if self.out_of_reach else "nothing is out of reach")
        for cell, why in self.out_of_reach.items():
            print(f"    {cell}: {why}")
        return shares


def parse(words=None):
    default = HERE.parents[1] / "build" / "release" / "bin" / "hirosco-fly-plan"
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mission")
    parser.add_argument("--flights", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="this flight alone; those of earlier batches fly first, as its drawing aims by them")
    parser.add_argument("--plan", help="fly and judge this plan")
    parser.add_argument("--show", action="store_true", help="print the plan of --only instead of flying it")
    parser.add_argument("--keep", metavar="FILE", help="write down after each batch how far it is, and go on from there where FILE is there already")
    parser.add_argument("--out", help="folder for the plans that failed, or for what --plan flew; it is made")
    parser.add_argument("--shrink", type=int, default=3, help="how many failed plans are made small (0: none)")
    parser.add_argument("--table", action="store_true", help="print all cells that are not full")
    parser.add_argument("--defect", help="fly with this planted defect")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--fly-plan", default=os.environ.get("HIROSCO_FLY_PLAN", str(default)))
    arguments = parser.parse_args(words)
    if arguments.keep and (arguments.only is not None or arguments.plan):
        parser.error("--keep is of a whole campaign: not with --only, which flies those of earlier batches first, nor with --plan")
    return arguments


def main():
    arguments = parse()
    if arguments.plan:
        result = Pilot(arguments.mission, arguments.fly_plan, arguments.defect).fly(pathlib.Path(arguments.plan).read_text(), arguments.out)
        for invariant, seconds, text in result["violations"]:
            print(f"{invariant} {seconds:.4f} s: {text}")
        return 1 if result["violations"] else 0
    campaign = Campaign(arguments)
    if arguments.show:
        print(campaign.plan(arguments.only or 0), end="")
        return 0
    return campaign.run()


if __name__ == "__main__":
    sys.exit(main())
