#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A slice of the campaign has no violation, the same seed gives the same octets, a failing plan shrinks to what it needs,
and each planted defect is found. campaign_test.py [some_flights|flights|typed|authors|couplings|defects|tools] [DEFECT...]"""
import collections, contextlib, os, pathlib, subprocess, sys, tempfile, unittest.mock
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "simulation" / "campaign")]
from campaign import Campaign, Pilot, parse  # noqa: E402
from draw import Draw  # noqa: E402
import defects_in_unit_tests, defects_flown, losses  # noqa: E401, E402
from shrink import shrink, split  # noqa: E402

MISSION = str(HERE.parents[1] / "missions" / "rokviss")
# The planted defects bear the name of the invariant that they break.
COUPLINGS = str(HERE.parent / "couplings")
DEFECTS = ["I1", "I2", "I3", "I4", "I5", "I6", "I8", "I9", "I10", "I11", "I12", "I13", "I14", "I15", "I16", "I17"]
OF_COUPLINGS = ["I18", "I19", "I20", "I21"]  # what rokviss has nothing of
MOST_FLIGHTS = 40          # until a planted defect is found
SLICE = 20
SOME = 3                   # of these, in every check: each has calls, faults and an end of its own
CALLS = 1_000              # of functions with arguments of every type
# Plans of flights with a violation, of what they cannot do without, and what holds in them by now.
FOUND = {
    "a recovery reaches who has flooded the supervisor and not read the answers yet": """
seed 2067581723
mode standalone
finale 26.0
ends telepresence standalone
14.713206 tc ground 1 8 1 15 5345545f4d4f44450000000000000000010101
14.743206 tc ground 10 8 1 15 5345545f535441544500000000000000010104
14.743206 tc ground 11 8 1 15 5345545f535441544500000000000000010104
14.803206 tc ground 10 8 1 15 5345545f535441544500000000000000010103
14.803206 tc ground 11 8 1 1 5345545f535441544500000000000000010103
19.112965 tc ground 10 8 1 15 434f4e46494755524500000000000000010102
19.112965 tc ground 11 8 1 15 434f4e46494755524500000000000000010102
19.142965 tc ground 1 8 1 15 4c494e4b000000000000000000000000010101
20.829673 kill MANIPULATOR
20.829673 flood JOYSTICK valid 400
""",
    "nobody is ended for the time in which supervisor and guard stood still during a stop": """
seed 4203175389
mode telepresence
finale 26.0
ends telepresence standalone
18.946899 tc ground 1 8 1 15 534146455f414c4c000000000000000000
19.073649 stop SUPERVISOR
""",
    "a hand that held the joystick away is no reason for a craft not to come up again": """
seed 1824551638
mode telepresence
finale 26.0
ends telepresence standalone
7.672652 strain MANIPULATOR 3 600
12.180817 tc ground 10 8 1 15 5345545f535441544500000000000000010105
23.318167 fault joystick hand hold 0.1 0.1
""",
}
problems = []


def check(condition, text):
    print(("passed: " if condition else "FAILED: ") + text, flush=True)
    if not condition:
        problems.append(text)


def some_flights():
    check(Campaign(parse([MISSION, "--flights", str(SOME), "--shrink", "0"])).run() == 0, f"{SOME} flights hold every invariant")


def flights():
    with tempfile.TemporaryDirectory() as folder:
        words = [MISSION, "--flights", str(SLICE), "--shrink", "1", "--keep", f"{folder}/kept.json"]
        campaign = Campaign(parse(words))
        check(campaign.run() == 0, f"{SLICE} flights hold every invariant")
        again = Campaign(parse(words))
        check(again.flown == SLICE and again.plan(SLICE) == campaign.plan(SLICE), "who goes on draws as if nothing had come between")
        with contextlib.suppress(SystemExit):
            Campaign(parse([*words, "--seed", "2"]))
            check(False, "a campaign of another seed is not gone on with")


def builds():
    """Whoever goes on flies the same programs: one octet of one of them is another build."""
    with tempfile.TemporaryDirectory() as folder:
        program, module, kept = (pathlib.Path(folder) / name for name in ("hirosco-fly-plan", "hirosco-joystick.so", "kept.json"))
        words = [MISSION, "--keep", str(kept), "--fly-plan", str(program)]
        program.write_bytes(b"program")
        module.write_bytes(b"module")
        Campaign(parse(words)).keep(0, 0.0)
        check(not stopped(lambda: Campaign(parse(words))), "a campaign of the same build is gone on with")
        for file in (program, module):
            under_way = Campaign(parse(words))
            before = file.read_bytes()
            file.write_bytes(before + b" anew")
            check("build" in stopped(lambda: Campaign(parse(words))), f"a campaign of another {file.name} is not gone on with")
            check("built anew" in stopped(lambda: under_way.keep(20, 1.0)), f"{file.name} may not be built anew while it flies")
            file.write_bytes(before)


def stopped(work):
    """By what words it ends, if it does."""
    try:
        work()
    except SystemExit as refusal:
        return str(refusal)
    return ""


def typed():
    """A subsystem with a function of every type: what is drawn for it is carried out or refused as its descriptor says."""
    mission = HERE.parent / "typed"
    pilot = Pilot(str(mission), fly_plan())
    member = pilot.judged.by_name("PROGRAMMABLE")
    draw = Draw(pilot.judged, 1, 0)
    lines, judged = [], collections.Counter()
    for number in range(CALLS):
        function = draw.random.choice(list(member.functions.values()))
        data = draw.plan.data.call(function.name, function.arguments)
        judged[function.name, function.refusal(data)] += 1
        lines.append(f"{2 + number * 0.005:.6f} tc ground {member.apid} 8 1 15 {data.hex()}")
    for function in member.functions:
        check(judged[function, None] >= 20 and judged[function, "values"] >= 20, f"{function} is called with good and with bad arguments")
    flown = pilot.fly("\n".join(["seed 1", "mode telepresence", "finale 26.0", *lines]) + "\n")
    for violation in flown["violations"]:
        print(*violation)
    check(not flown["violations"], f"{CALLS} calls with arguments of every type end as their descriptor says")
    called = sum(count for cell, count in flown["commands"].items() if cell.startswith("Operational|") and cell.endswith("|ground"))
    check(called >= CALLS, "they reached a subsystem that is Operational")


def authors():
    """The mission of the guide (docs/guide/your_mission.md): a slice of it holds, too."""
    campaign = Campaign(parse([str(HERE.parent / "author" / "pair"), "--flights", "4", "--shrink", "0"]))
    check(campaign.run() == 0, "4 flights of a mission that was written by the guide hold every invariant")


def couplings():
    """Each kind of link and each loss of one, descriptors that are read again and versions of programs: a slice of these holds, too."""
    campaign = Campaign(parse([COUPLINGS, "--flights", str(SOME), "--shrink", "0"]))
    check(campaign.run() == 0, f"{SOME} flights of a mission with each kind of link hold every invariant")
    drawn = collections.Counter(word for index in range(20) for line in campaign.plan(index).splitlines()
                                for word in line.split() if word in ("edit", "REREAD", "REPLACE", "CONFIRM", "TAKE_BACK"))
    check(len(drawn) == 5, f"twenty plans have {', '.join(f'{number} {word}' for word, number in sorted(drawn.items()))}")


def find(defect):
    """How many flights it took, 0 when it was not found."""
    campaign = Campaign(parse([COUPLINGS if defect in OF_COUPLINGS else MISSION, "--defect", defect]))
    for index in range(MOST_FLIGHTS):
        result = campaign.pilot.fly(campaign.plan(index))
        if any(violation[0] == defect for violation in result["violations"]):
            return index + 1
    return 0


def defects(wanted):
    names = subprocess.run([fly_plan()], capture_output=True, text=True).stdout.split()
    check(set(names) == {*DEFECTS, *OF_COUPLINGS}, "every invariant has a planted defect")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for defect, found in zip(wanted, pool.map(find, wanted)):
            check(found, f"what is planted against {defect} is found" + (f" in flight {found}" if found else ""))


def fly_plan():
    return parse([MISSION]).fly_plan


def losses_drawn():
    """How the supervisor is lost in a hundred plans, and in the middle of what; that some lose none is seen to, too."""
    campaign, found, without = Campaign(parse([MISSION])), set(), 0
    for index in range(100):
        begun = []
        with unittest.mock.patch.object(losses, "begin_what", lambda draw, dice, what, time: begun.append(what)):
            lines = [line.split()[1:] for line in Draw(campaign.mission, 1, index).text().splitlines()]
        lost = [words for words in lines if words[0] in ("kill", "hang") and words[1] == campaign.mission.supervisor.name]
        without += not lost
        found.update(words[0] for words in lost)
        found.update(begun)
        if lost and not begun:
            found.add("long" if int(lost[0][2]) > 2000 and lost[0][0] == "kill" else "anything")
    return found if without > 40 else set()


def tools():
    builds()
    for misfit in (gone := defects_flown.misfits() + defects_in_unit_tests.misfits()):
        print(misfit)
    check(not gone, "every finding that is put back into a copy of the code still has its place there")
    plan = Campaign(parse([MISSION, "--seed", "7"])).plan(3)
    check(plan == Campaign(parse([MISSION, "--seed", "7"])).plan(3), "the same seed draws the same plan")
    lost = losses_drawn()
    check(lost >= {"kill", "hang", "long", "mode", "plan", "stop", "nothing", "anything"},
          f"the supervisor dies and hangs, alone and in the middle of things: {', '.join(sorted(lost))}")
    octets = []
    for _ in range(2):
        with tempfile.TemporaryDirectory() as folder:
            Pilot(MISSION, fly_plan()).fly(plan, folder)
            octets.append([(pathlib.Path(folder) / name).read_bytes() for name in ("log.txt", "trace.txt")])
    check(octets[0] == octets[1], "the same plan flies to the same octets of log and trace")
    with tempfile.TemporaryDirectory() as folder:
        for number, (text, plan) in enumerate(FOUND.items()):
            out = pathlib.Path(folder) / str(number) / "flown"
            violations = Pilot(MISSION, fly_plan()).fly(plan.lstrip(), out)["violations"]
            check(not violations and (out / "trace.txt").exists(), text + "".join(f"; {v[0]} {v[1]:.4f} s: {v[2]}" for v in violations))
    small = shrink("seed 1\n" + "".join(f"{n}.0 a{n}\n" for n in range(40)), lambda text: " a7\n" in text and " a31\n" in text, 2)
    check(split(small)[1] == ["7.0 a7", "31.0 a31"], "a plan shrinks to the two actions that it takes")


if __name__ == "__main__":
    what = sys.argv[1] if len(sys.argv) > 1 else "all"
    if what == "some_flights":
        some_flights()
    if what in ("flights", "all"):
        flights()
    if what in ("typed", "all"):
        typed()
    if what in ("authors", "all"):
        authors()
    if what in ("couplings", "all"):
        couplings()
    if what in ("defects", "all"):
        defects(sys.argv[2:] or DEFECTS + OF_COUPLINGS)
    if what in ("tools", "all"):
        tools()
    sys.exit(1 if problems else 0)
