// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/descriptor/model/mission.hpp"

namespace hirosco::ground::testing {

[[nodiscard]] inline descriptor::Field field_of(const std::string& name, Type type, std::uint32_t count = 1) {
  descriptor::Field field;
  field.name = name;
  field.type = type;
  field.count = count;
  return field;
}

/// A supervisor and one subsystem with one of everything, under one name: a writable array of three numbers of which values have
/// names, a structure, a function, an event, a structure of housekeeping that samples once and four times, a failure code.
[[nodiscard]] inline descriptor::Mission mission_with(const std::string& name) {
  using enum Type;
  descriptor::Mission mission;
  mission.name = name;
  mission.supervisor.name = "SUPERVISOR";
  mission.supervisor.id = 1;
  descriptor::Parameter current_mode;
  current_mode.field = field_of("MODE", Uint8);
  mission.supervisor.parameters = {current_mode};
  descriptor::Function set_mode;
  set_mode.name = "SET_MODE";
  set_mode.arguments.push_back({.field = field_of("MODE", Uint8), .of = {}, .fallback = {}});
  mission.supervisor.functions = {set_mode};
  descriptor::Mode mode;
  mode.name = name;
  mode.id = 3;
  mission.modes = {mode};
  mission.start_mode = name;

  descriptor::MissionSubsystem member;
  auto& subsystem = member.subsystem;
  subsystem.name = name;
  subsystem.id = 10;
  subsystem.description = name;
  subsystem.enumerations.push_back({name, {{1, name}, {2, "two"}}});
  descriptor::Parameter parameter;
  parameter.field = field_of(name, Uint16, 3);
  parameter.field.unit = name;
  parameter.field.enumeration = name;
  parameter.id = 7;
  parameter.writable_states = 1U << static_cast<unsigned>(descriptor::State::Operational);
  descriptor::Parameter structure;
  structure.field = field_of("POSE", Struct);
  structure.id = 8;
  structure.members = {{field_of("X", Double), 20}, {field_of("ON", Bool), 21}};
  structure.members.front().field.unit = "m";
  structure.members.front().field.minimum = -2.0;
  structure.members.front().field.maximum = 1.5;
  subsystem.parameters = {parameter, structure};
  descriptor::Function function;
  function.name = name;
  function.states = 1U << static_cast<unsigned>(descriptor::State::Operational);
  function.arguments.push_back({.field = structure.members.front().field, .of = {}, .fallback = {}});
  subsystem.functions = {function};
  subsystem.events.push_back({name, 77, descriptor::Severity::Low, {parameter.field}, {}});
  subsystem.failures.push_back({0x8001, name});
  descriptor::HousekeepingStructure report;
  report.id = 99;
  report.sampled_once = {{name, 0, std::nullopt, {}}, {"POSE", 1, std::nullopt, {}}};
  report.sampled_repeatedly = {{4, {{"POSE.X", 1, 0, {}}}}};
  subsystem.housekeeping.push_back(report);
  mission.subsystems.push_back(member);
  return mission;
}

/// What somebody may have written to do harm, or by accident.
[[nodiscard]] inline std::vector<std::string> hostile_names() {
  return {"]]>",    "<!--",    "a&b;", "\"\n/><x y='",         "../../etc",
          "{evil}", "a|b`c*d", "-",    "\xE2\x80\xAE\xFF\x01", "$(exit 3)"};
}

}  // namespace hirosco::ground::testing
