# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""`hirosco check` says everything that keeps a mission from flying, before it flies."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"


def hirosco(*words, **environment):
    done = subprocess.run([HIROSCO, *map(str, words)], capture_output=True, text=True, check=False,
                          env={**os.environ, "NO_COLOR": "1", **environment})
    return done.returncode, done.stdout + done.stderr


class Check(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hirosco-check-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("missions", "subsystems", "supervisor"):
            for file in [*(REPOSITORY / name).rglob("*.xml"), *(REPOSITORY / name).rglob("*.script")]:
                copy = self.folder / file.relative_to(REPOSITORY)
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(file.read_text())

    def mission(self, name, file="mission.xml", **changes):
        """The path of a mission of which one file has other words: mission("hello", old="...", new="...")."""
        mission = self.folder / "missions" / name / "mission.xml"
        changed = mission if file == "mission.xml" else self.folder / file
        if changes:
            text = changed.read_text()
            self.assertIn(changes["old"], text)
            changed.write_text(text.replace(changes["old"], changes["new"], 1))
        return mission

    def expect(self, mission, code, *texts):
        found, told = hirosco("check", mission)
        self.assertEqual(found, code, told)
        for text in texts:
            self.assertIn(text, told)
        return told

    def test_success_says_how_many_files(self):
        self.assertIn("4 files, no problem", self.expect(self.mission("hello"), 0))
        self.assertIn("1 file, no problem", self.expect(self.folder / "subsystems/hello/hello.xml", 0))

    def test_a_missing_program_is_a_warning_until_it_is_to_fly(self):
        mission = self.mission("hello", old='"hirosco-hello"', new='"hirosco-hallo"')
        self.expect(mission, 0, "warning: E0401: no program hirosco-hallo for subsystem HELLO", "mission.xml:10:3", "1 warning")
        self.assertEqual(hirosco("check", "--fly", mission)[0], 1)
        for command, what in (("run", "program"), ("simulate", "module")):
            code, told = hirosco(command, mission, "--for", "1s")
            self.assertEqual(code, 3, told)
            self.assertIn(f"no {what} hirosco-hallo", told)

    def test_a_script_whose_interpreter_is_one_is_told_to_fly_in_no_sandbox_and_is_an_error_where_each_must_have_one(self):
        script, shim = self.folder / "hallo.py", self.folder / "shim"
        for file, line in ((script, f"#!{shim}\n"), (shim, "#!/bin/sh\n")):
            file.write_text(line)
            file.chmod(0o755)
        path = f"{self.folder}:{os.environ['PATH']}"
        mission = self.mission("hello", old='"hirosco-hello"', new='"hallo.py"')
        code, told = hirosco("check", mission, PATH=path)
        self.assertEqual(code, 0, told)
        self.assertIn("mission.xml:10:3: warning: E0411: hallo.py of subsystem HELLO is a script that flies in no sandbox: "
                      "its interpreter is a script, too", told)
        mission = self.mission("hello", old='<Modes', new='<Isolation required="yes"/>\n  <Modes')
        code, told = hirosco("check", mission, PATH=path)
        self.assertEqual(code, 1, told)
        self.assertIn('error: E0411: hallo.py of subsystem HELLO is a script that <Isolation required="yes"/> does not let fly: its interpreter', told)
        script.write_text("#!/bin/sh\n")
        code, told = hirosco("check", mission, PATH=path)
        self.assertEqual(code, 0, told)
        self.assertNotIn("E0411", told)

    def test_a_device_is_asked_for_its_settings(self):
        mission = self.mission("rokviss", old='value="wander"', new='value="hold"')
        told = self.expect(mission, 1, "device joystick does not take 'hand hold'")
        line = next(n for n, text in enumerate(mission.read_text().splitlines(), 1) if 'value="hold"' in text)
        self.assertIn(f"mission.xml:{line}:", told)
        for command in ("run", "simulate"):
            self.assertEqual(hirosco(command, mission, "--for", "1s")[0], 3)
        self.assertEqual(hirosco("check", self.mission("rokviss", old='value="hold"', new='value="hold 0 0"'))[0], 0)

    @unittest.skipUnless((HIROSCO.parent / "hirosco-sim-mujoco.so").exists(), "no MuJoCo")
    def test_a_world_is_made_of_its_files_before_it_is_asked(self):
        self.expect(self.mission("six_joints"), 1, "error: E0407: no simulated device arm: ", "robot_arm.urdf does not exist")
        urdf = "subsystems/robot_arm/robot_arm.urdf"
        shutil.copy(REPOSITORY / urdf, self.folder / urdf)
        self.expect(self.mission("six_joints"), 0)
        # What the world refuses of a file the reader of this project tells, at the file's own place; a likely mistake of units is a warning.
        text = (self.folder / urdf).read_text()
        line = next(n for n, each in enumerate(text.splitlines(), 1) if "<limit " in each)
        (self.folder / urdf).write_text(re.sub(r'(<limit [^>]*upper=")[^"]*', r"\g<1>0,4", text, count=1))
        told = self.expect(self.mission("six_joints"), 1, "error: U0106: ")
        self.assertIn(f"robot_arm.urdf:{line}:", told)
        self.assertNotIn("E0407", told)
        (self.folder / urdf).write_text(re.sub(r'(<limit [^>]*upper=")[^"]*', r"\g<1>170", text, count=1))
        self.assertIn(f"robot_arm.urdf:{line}:", self.expect(self.mission("six_joints"), 0, "warning: U0509: ", " turns to 170 rad"))
        (self.folder / urdf).write_text(text)
        obstacle = '<Setting name="obstacle_post" value="{}"/>\n    <Setting name="friction"'
        good, wrong, within = "cylinder 0.05,1.6 0.5,-0.15,0.8", "cylinder 0.05 0.5,-0.15,0.8", "sphere 0.1 0,0.13,0.3"
        self.expect(self.mission("six_joints", old='<Setting name="friction"', new=obstacle.format(good)), 0)
        self.expect(self.mission("six_joints", old=good, new=wrong), 1, "E0402", "the size '0.05' has 1 numbers, not 2; write cylinder RADIUS,LENGTH")
        self.expect(self.mission("six_joints", old=wrong, new=within), 1, "E0402", "stands in obstacle 'post'")

    def test_a_setting_that_no_code_reads_is_told_with_its_place_before_and_in_a_flight(self):
        hand = "subsystems/joystick/joystick.xml"
        mission = self.mission("rokviss", hand, old='<Endnode transfer="shared_memory" address="joystick-handle"',
                               new='<Setting name="GRIP" value="3"/>\n<Endnode transfer="shared_memory" address="joystick-handle"')
        line = next(n for n, text in enumerate((self.folder / hand).read_text().splitlines(), 1) if "GRIP" in text)
        self.expect(mission, 0)
        for words in (("check", "--fly", mission), ("simulate", mission, "--for", "2s")):
            code, told = hirosco(*words)
            self.assertNotEqual(code, 0, told)
            self.assertIn("nobody reads setting 'GRIP' of 'JOYSTICK'", told)
            self.assertIn(f"joystick.xml:{line}:", told)

    def test_what_software_init_will_find_is_told_by_check_fly(self):
        mission = self.mission("hello", "subsystems/hello/hello.xml", old='<Function name="MOVE_TO"', new='<Function name="MOVE_TOO"')
        self.expect(mission, 0)
        code, told = hirosco("check", "--fly", mission)
        self.assertEqual(code, 1)
        self.assertIn("error: E0406: HELLO: on_function: the descriptor declares no function 'MOVE_TO'", told)
        self.assertIn("error: E0406: HELLO: function declared but without a handler: MOVE_TOO", told)

    def test_a_port_of_a_configuration_that_nobody_flies_is_compared_by_check_fly(self):
        hand = "subsystems/joystick/joystick.xml"
        text = (self.folder / hand).read_text()
        begin = text.index('<Requires name="REMOTE_ROBOT"')
        required = text[begin:text.index("</Requires>", begin)]
        mission = self.mission("rokviss", hand, old=required, new=required.replace('<Field name="ACTIVE" type="UINT8"/>', ""))
        self.expect(mission, 0)
        code, told = hirosco("check", "--fly", mission)
        self.assertEqual(code, 1, told)
        self.assertIn("error: E0406: require_link REMOTE_ROBOT: the C++ type has 3 members, the descriptor declares 2 fields", told)
        self.assertIn(f"joystick.xml:{text.count(chr(10), 0, begin) + 1}:", told)

    def test_what_cannot_fly_is_refused(self):
        robot, hand = "subsystems/manipulator/manipulator.xml", "subsystems/joystick/joystick.xml"
        for file, old, new, code in (
                (robot, 'sampling_us="500"', 'sampling_us="1"', "sampling_us 1 is out of range"),
                (robot, '<ParamRef name="TIP_FORCE"', '<ParamRef name="Tip_Force"', "refers to 'TIP_FORCE'"),
                (hand, 'name="PASSIVITY" id="3"', 'name="force_scale" id="3"', "in case only"),
                (hand, 'transfer="shared_memory"', 'transfer="ethercat"', "'ethercat' is not built in"),
                (hand, 'methods="shared_memory"', 'methods="tcp"', "'tcp' is not built in"),
                (hand, 'methods="shared_memory udp" byte_order="native" kind="latest"', 'methods="shared_memory" byte_order="native" kind="queued"',
                 "no common kind"),
                (hand, 'kind="latest"', 'kind="queued"', "'udp' carries no set of kind"),
                (hand, 'name="COUPLED" id="2" priority="80" sampling_us="500"', 'name="COUPLED" id="2" priority="80" sampling_us="750"',
                 "one period has to be a multiple of the other, of"),
                (hand, 'watchdog_ms="10"', 'watchdog_ms="0.4"', "trips between cycles"),
                (hand, '"joystick-handle"', '"manipulator-robot"', "'manipulator-robot' is a device's of 'MANIPULATOR'"),
                ("mission.xml", '<Establish link="2"/>', "", "brings up no link into 'MANIPULATOR.JOYSTICK_STATE'")):
            with self.subTest(new=new):
                path = (self.folder / "missions/rokviss/mission.xml") if file == "mission.xml" else self.folder / file
                before = path.read_text()
                self.expect(self.mission("rokviss", file, old=old, new=new), 1, code)
                path.write_text(before)

    def test_all_files_are_judged_at_once(self):
        first = self.mission("hello", old="<Mission", new="<Mision")
        second = self.folder / "subsystems/joystick/joystick.xml"
        second.write_text(second.read_text().replace("</Parameters>", "", 1))
        code, told = hirosco("check", first, second, self.folder / "none.xml")
        self.assertEqual(code, 1)
        for text in ("</Mission> stands where <Mision>, opened in 4:1",
                     "</Subsystem> stands where <Parameters>, opened in ", "none.xml: error: E0001: does not exist"):
            self.assertIn(text, told)

    def test_what_is_no_file_says_what_it_is(self):
        pipe, large = self.folder / "pipe.xml", self.folder / "large.xml"
        os.mkfifo(pipe)
        large.write_bytes(b" " * (4 * 1024 * 1024 + 1))
        self.expect(pipe, 1, "is a pipe (FIFO)")
        self.expect(self.folder, 1, "is a folder")
        self.expect(large, 1, "is larger than 4 MiB")

    def test_what_the_plans_would_do_is_told_without_a_flight(self):
        code, told = hirosco("check", "--recovery", self.mission("rokviss", old='within_s="60"', new='within_s="60" to="commanded"'))
        self.assertEqual(code, 0)
        self.assertIn("JOYSTICK high PROCESS_DIED: plan died: restart limit=3 within_s=60 pause_ms=100 to=commanded, "
                      "shut_down_network", told)
        self.assertIn("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED: plan to-safe: set_state state=SafeOperational", told)
        self.assertIn("MANIPULATOR: plan to-safe (medium) gives way to died (high), network-down (high)", told)

    def test_a_plan_of_another_priority_is_shown_with_it(self):
        code, told = hirosco("check", "--recovery", self.mission("rokviss", old='"to-safe"', new='"to-safe" priority="7"'))
        self.assertEqual(code, 0)
        self.assertIn("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED: plan to-safe (priority 7): set_state state=SafeOperational", told)

    def test_json_has_a_line_for_each(self):
        mission = self.mission("hello", old='"hirosco-hello"', new='"hirosco-hallo"')
        code, told = hirosco("check", "--json", mission)
        self.assertEqual(code, 0)
        (row,) = map(json.loads, told.splitlines())
        self.assertEqual((row["grade"], row["code"], row["line"]), ("warning", "E0401", 10))


if __name__ == "__main__":
    unittest.main()
