#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What is drawn for a mission is of that mission: its modes' configurations and links, its budget, faults of devices that it has. Nothing is flown."""
import collections, dataclasses, pathlib, struct, sys, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "simulation" / "campaign")]
from draw import Draw, faults_of  # noqa: E402
from of_mission import NOTHING_SAID, OfMission  # noqa: E402
from plan_lines import DEVICE_FAULTS  # noqa: E402
from descriptors import OPERATIONAL, read_mission  # noqa: E402

# Every mission that lies in a folder of its own and that the judge's own reader takes.
PLACES = ("missions/*", "missions/*/tests", "subsystems/*/tests", "tests/*", "tests/author/*")
MISSIONS = sorted(file.parent for place in PLACES for file in ROOT.glob(f"{place}/mission.xml"))


def driven(draw, mode):
    """What ground says to bring the craft up in a mode: {function: [data behind its name]}, by the subsystem in front of CONFIGURE."""
    draw.plan.lines.clear()
    draw.plan.drive(1.0, OPERATIONAL, mode)
    said = collections.defaultdict(list)
    for _, line in draw.plan.lines:
        words, _, remark = line.partition("  # ")
        subsystem, function = remark.split()
        said[f"{subsystem} {function}" if function == "CONFIGURE" else function].append(bytes.fromhex(words.split()[6])[16:])
    return said


def arguments(data):
    return [octets[2] for octets in data]


class Drawn(unittest.TestCase):
    def test_every_mission_of_the_repository_is_drawn_for(self):
        self.assertGreater(len(MISSIONS), 10)
        for mission in map(read_mission, MISSIONS):
            cells = list(faults_of(mission))
            for index in range(10):
                text = Draw(mission, 1, index, (), cells[index::10]).text()
                self.assertIn(text.split("\n", 2)[1].removeprefix("mode "), mission.modes)

    def test_ground_brings_up_each_member_in_the_configuration_that_the_mode_commissions(self):
        for mission in map(read_mission, MISSIONS):
            draw = Draw(mission, 1, 0)
            for mode in OfMission.of(mission).flown:
                said = driven(draw, mode)
                for member in draw.plan.acting:
                    ids = arguments(said[f"{member.name} CONFIGURE"])
                    if not member.configurations:
                        continue
                    self.assertEqual(len(ids), 1)
                    name = member.configurations[ids[0]].name
                    of_modes = {names[member.name] for names in mission.commissions.values() if member.name in names}
                    self.assertEqual(name, mission.commissions[mode].get(member.name, name), f"{member.name} in {mode}")
                    self.assertTrue(not of_modes or name in of_modes, f"{member.name} in {mode}: {name} is of no mode")

    def test_links_are_those_of_the_mode_or_of_the_usual_one(self):
        for mission in map(read_mission, MISSIONS):
            draw, its = Draw(mission, 1, 0), OfMission.of(mission)
            for mode in its.flown:
                links = arguments(driven(draw, mode)["LINK"])
                self.assertIn(links, (mission.establishes[mode], mission.establishes[its.usual]))
                self.assertLessEqual(set(links), set(mission.links))

    def test_the_budget_is_the_missions_and_where_it_has_none_nothing_is_said_of_it(self):
        budgets = set()
        for mission in map(read_mission, MISSIONS):
            draw = Draw(mission, 1, 0)
            budgets.add(mission.budget_W)
            said = driven(draw, OfMission.of(mission).usual)["SET_POWER_BUDGET"]
            expected = [] if mission.budget_W is None else [mission.budget_W]
            self.assertEqual([struct.unpack(">f", data[2:])[0] for data in said], expected)
        self.assertGreater(len(budgets - {None}), 3, "they are not all alike")
        self.assertIn(None, budgets)

    def test_no_device_of_somebody_who_has_none_is_faulted(self):
        for mission in map(read_mission, MISSIONS):
            owners = {owner for owner, _ in mission.devices.values()}
            struck = {cell.split("|")[2] for cell in faults_of(mission) if cell.startswith("fault ")}
            self.assertEqual(struck, owners - {mission.ground})
            for index in range(40):
                for line in Draw(mission, 2, index).text().splitlines():
                    words = line.split()
                    if words[1:2] == ["fault"] and words[3] in DEVICE_FAULTS:
                        self.assertIn(words[2], mission.devices, line)

    def test_what_the_mission_moves_by_itself_rests_before_it_loses_its_supervisor(self):
        moved = read_mission(ROOT / "missions/rokviss")
        rests = [line for index in range(60) for line in Draw(moved, 1, index).text().splitlines() if line.split("#")[0].rstrip().endswith("hand hold 0 0")]
        self.assertTrue(rests)
        for mission in map(read_mission, MISSIONS):
            if not OfMission.of(mission).rests:
                plans = "".join(Draw(mission, 1, index).text() for index in range(20))
                self.assertNotIn("hand hold", plans)

    def test_a_mode_that_the_mission_has_not_is_refused_by_its_name(self):
        mission = read_mission(ROOT / "missions/hello")
        with self.assertRaisesRegex(SystemExit, "campaign.py: the mission has no mode orbit; it has commissioning, operation"):
            OfMission(mission, NOTHING_SAID | {"DRIVEN": ["orbit"]})

    def test_a_mission_of_another_budget_and_other_names_is_drawn_by_these(self):
        mission = read_mission(ROOT / "tests/author/pair")
        joystick = mission.by_name("JOYSTICK")
        coupled = next(c for c in joystick.configurations.values() if c.name == mission.commissions["coupled"]["JOYSTICK"])
        joystick.configurations[200] = dataclasses.replace(coupled, id=200, name="LED")
        mission.commissions["coupled"]["JOYSTICK"] = "LED"
        mission.budget_W = 77.0
        said = driven(Draw(mission, 1, 0), "coupled")
        self.assertEqual(arguments(said["JOYSTICK CONFIGURE"]), [200])
        self.assertEqual(said["SET_POWER_BUDGET"], [bytes([1, 1]) + struct.pack(">f", 77.0)])


if __name__ == "__main__":
    unittest.main()
