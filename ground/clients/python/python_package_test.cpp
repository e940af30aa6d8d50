// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_package.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace hirosco::ground {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

descriptor::Function function_with(const std::string& name, const std::string& argument) {
  descriptor::Function function;
  function.name = name;
  function.states = 1U << static_cast<int>(descriptor::State::Operational);
  descriptor::Function::Argument only;
  only.field.name = argument;
  only.field.unit = "rad";
  only.field.minimum = -2.0;
  only.field.maximum = 1.5;
  function.arguments.push_back(only);
  return function;
}

/// A supervisor and one subsystem of this name with everything that a descriptor can have, under one name too.
descriptor::Mission mission_with(const std::string& name) {
  descriptor::Mission mission;
  mission.name = name;
  mission.supervisor.name = "SUPERVISOR";
  mission.supervisor.id = 1;
  descriptor::MissionSubsystem member;
  auto& subsystem = member.subsystem;
  subsystem.name = name;
  subsystem.id = 10;
  subsystem.description = name;
  subsystem.enumerations.push_back({name, {{1, name}, {2, "two"}}});
  descriptor::Parameter parameter;
  parameter.field.name = name;
  parameter.field.type = Type::Uint16;
  parameter.field.count = 3;
  parameter.field.unit = name;
  parameter.field.enumeration = name;
  parameter.id = 7;
  parameter.writable_states = 1U << static_cast<unsigned>(descriptor::State::Operational);
  subsystem.parameters.push_back(parameter);
  subsystem.functions = {function_with(name, name)};
  subsystem.events.push_back({name, 77, descriptor::Severity::Low, {parameter.field}, {}});
  descriptor::HousekeepingStructure structure;
  structure.id = 99;
  structure.sampled_once.push_back({name, 0, std::nullopt, {}});
  subsystem.housekeeping.push_back(structure);
  mission.subsystems.push_back(member);
  return mission;
}

std::string module_of(descriptor::Mission mission) {
  return python_package(Catalogue{std::move(mission)}).files.at("__init__.py");
}

std::filesystem::path write_package(const std::string& folder, const PythonPackage& package) {
  const auto path = std::filesystem::path{HIROSCO_BINARY_DIR} / "python_package_test" / folder / package.name;
  std::filesystem::create_directories(path);
  for (const auto& [name, text] : package.files) std::ofstream{path / name} << text;
  return path;
}

/// Imports packages, given as folders, and looks whether the client is still itself.
constexpr const char* judge = R"(
import importlib, inspect, os, sys
for folder in sys.argv[1:]:
    sys.path[0], name = os.path.split(folder)
    module = importlib.import_module(name)
    assert os.path.dirname(module.__file__) == folder, module
    assert issubclass(module.Spacecraft, module._r.Craft)
    parts = [c for c in vars(module).values() if inspect.isclass(c) and issubclass(c, module._r.Subsystem)]
    assert sorted(c._about.apid for c in parts) == [1, 10], parts
    for part in parts:
        for member in ('latest', 'record', 'state', '_call', '_get'):
            assert getattr(part, member) is getattr(module._r.Subsystem, member), (folder, member)
    for loaded in [m for m in sys.modules if m.split('.')[0] == name]:
        del sys.modules[loaded]
)";

TEST(PythonPackage, EverythingOfADescriptorBecomesAMethodWithItsUnitAndRange) {
  const std::string text = module_of(mission_with("GRIPPER"));
  EXPECT_THAT(text, HasSubstr("class Gripper(_r.Subsystem):"));
  EXPECT_THAT(text, HasSubstr("self.gripper = Gripper(self)"));
  EXPECT_THAT(text, HasSubstr("def gripper(self, gripper: float, *, wait: _t.Optional[float] = 70.0) -> _r.Request:"));
  EXPECT_THAT(text, HasSubstr("gripper: DOUBLE, rad, -2 to 1.5"));
  EXPECT_THAT(text, HasSubstr("Permitted in: Operational"));
  EXPECT_THAT(text, HasSubstr("def hk_99(self, timeout: float = 5.0) -> _r.Housekeeping:"));
  EXPECT_THAT(text, HasSubstr("def get_gripper(self, wait: float = 10.0):"));
  EXPECT_THAT(text,
              HasSubstr("def set_gripper(self, value: _t.Sequence[_t.Union[int, _t.Literal[\"GRIPPER\", \"two\"]]]"));
  EXPECT_THAT(text, HasSubstr("_r.Parameter(\"GRIPPER\", 0xa0307,"));
  EXPECT_THAT(text, HasSubstr("_r.EventKind(77, \"GRIPPER\","));
}

TEST(PythonPackage, WhatIsEssentialLeavesByTheTelecommandPort) {
  auto mission = mission_with("GRIPPER");
  mission.ground.telemetry = "127.0.0.1:10015";
  mission.ground.telecommand = "127.0.0.1:10025";
  const std::string before = module_of(mission);
  EXPECT_THAT(before, HasSubstr("port=10015"));
  EXPECT_THAT(before, HasSubstr("telecommand_port=10025)"));
  EXPECT_THAT(before, Not(HasSubstr("alone=True"))) << "a ping asks about the ordinary way";
  mission.subsystems[0].subsystem.functions[0].essential = true;
  EXPECT_THAT(module_of(mission), HasSubstr("maximum=1.5),), alone=True),"));
}

TEST(PythonPackage, ASubsystemIsAskedAllThatTheFrameworkOffers) {
  const std::string text = module_of(mission_with("GRIPPER"));
  EXPECT_THAT(text, HasSubstr("        reports=(\n            *_told,\n        ), requests=(*_st3, *_st5, *_st20, ))"));
  EXPECT_THAT(
      text,
      HasSubstr("_r.ReportKind(17, 129, \"SELF_TEST_OUTCOME\", fields=(_r.Field(\"OUTCOME\", \"UINT8\", texts=(("));
}

TEST(PythonPackage, AParameterThatIsNeverWritableHasNoSetter) {
  auto mission = mission_with("GRIPPER");
  mission.subsystems[0].subsystem.parameters[0].writable_states = 0;
  EXPECT_THAT(module_of(mission), Not(HasSubstr("def set_gripper")));
}

TEST(PythonPackage, SwitchesAreBoolAndTextsAreStr) {
  auto mission = mission_with("GRIPPER");
  auto& subsystem = mission.subsystems[0].subsystem;
  descriptor::Field& field = subsystem.parameters[0].field;
  field = {};
  field.name = "TITLE";
  field.type = Type::Text;
  field.text_octets = 6;
  const std::string words = module_of(mission);
  EXPECT_THAT(words, HasSubstr("def set_title(self, value: str, *"));
  EXPECT_THAT(words,
              HasSubstr("_r.Layout(99, 8, columns=(_r.Field(\"TITLE\", \"TEXT\", most=6, fixed=True, offset=2),)"));
  EXPECT_THAT(words, HasSubstr("value: TEXT, at most 6 octets of UTF-8"));
  field = {};
  field.name = "ON";
  field.type = Type::Bool;
  field.count = 2;
  const std::string on = module_of(mission);
  EXPECT_THAT(on, HasSubstr("def set_on(self, value: _t.Sequence[bool], *"));
  EXPECT_THAT(on, HasSubstr("_r.Layout(99, 4, columns=(_r.Field(\"ON\", \"BOOL\", count=2, offset=2),)"));
}

TEST(PythonPackage, ArraysOfAReportAreOneColumnAtTheirPlace) {
  EXPECT_THAT(module_of(mission_with("GRIPPER")),
              HasSubstr("_r.Layout(99, 8, columns=(_r.Field(\"GRIPPER\", \"UINT16\", count=3, unit=\"GRIPPER\""));
}

TEST(PythonPackage, TheSameCatalogueGivesTheSameOctets) {
  const Catalogue catalogue{mission_with("GRIPPER")};
  EXPECT_EQ(python_package(catalogue).files, python_package(catalogue).files);
}

TEST(PythonPackage, APackageIsNeverNamedAsAModuleOfPython) {
  EXPECT_EQ(python_package(Catalogue{mission_with("json")}).name, "hirosco_json");
  EXPECT_EQ(python_package(Catalogue{mission_with("../../etc")}).name, "hirosco_etc");
}

TEST(PythonPackage, HostileNamesAreTextForPythonAndNothingElse) {
  const std::string program = std::filesystem::path{HIROSCO_BINARY_DIR} / "python_package_test/judge.py";
  std::string command = "python3 -B '" + program + "'";
  int folder = 0;
  for (const std::string name :
       {"\"\"\"\nraise SystemExit(3)\n\"\"\"", "x\"); raise SystemExit(3) #", "\\", "mro", "class", "__class__",
        "Craft", "_r", "Spacecraft", "float", "\xE2\x80\xAE{evil}\xFF", "$(exit 3)", "record", "close", "-", "init"}) {
    const auto path = write_package(std::to_string(++folder), python_package(Catalogue{mission_with(name)}));
    command += " '" + path.string() + "'";
  }
  std::ofstream{program} << judge;
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace hirosco::ground
