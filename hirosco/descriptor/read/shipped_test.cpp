// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/testing.hpp"

/// What holds for the descriptors that the repository ships.
namespace hirosco::descriptor {
namespace {

using testing::rendered;

std::map<std::filesystem::path, Mission> shipped_missions() {
  std::map<std::filesystem::path, Mission> missions;
  for (const auto& entry :
       std::filesystem::directory_iterator{std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions"}) {
    const auto file = entry.path() / "mission.xml";
    if (!std::filesystem::exists(file)) continue;
    auto reading = read_mission(file, file_system());
    EXPECT_TRUE(reading.value) << rendered(reading.problems, file_system());
    if (reading.value) missions.emplace(file, std::move(*reading.value));
  }
  return missions;
}

TEST(ShippedMissions, HaveNoProblem) { EXPECT_GE(shipped_missions().size(), 1U); }

/// Numbers that somebody outside can set, and how many of them have no range. Counted here and not by the reader, so that
/// a reader that lets one pass does not let it pass twice.
struct FromOutside {
  std::size_t count{0};
  std::string without_range;

  void add(const SubsystemDescriptor& subsystem, const std::string& where, const Field& field) {
    if (field.type == Type::Text) return;  // it has its octets
    ++count;
    if (!field.minimum || !field.maximum || *field.minimum > *field.maximum)
      without_range += subsystem.name + " " + where + " " + field.name + "\n";
  }
  void add(const SubsystemDescriptor& subsystem) {
    for (const Function& function : subsystem.functions)
      for (const Function::Argument& argument : function.arguments) add(subsystem, function.name, argument.field);
    for (const Parameter& parameter : subsystem.parameters) {
      if (!parameter.writable()) continue;
      if (parameter.members.empty()) add(subsystem, "parameter", parameter.field);
      for (const Parameter::Member& member : parameter.members) add(subsystem, parameter.field.name, member.field);
    }
  }
};

TEST(ShippedMissions, EveryNumberFromOutsideHasARange) {
  FromOutside numbers;
  for (const auto& [file, mission] : shipped_missions()) {
    numbers.add(mission.supervisor);
    for (const auto& member : mission.subsystems) numbers.add(member.subsystem);
  }
  EXPECT_GE(numbers.count, 15U);
  EXPECT_EQ(numbers.without_range, "");
}

/// Asked of what is shipped: permission takes the word of the descriptor for it, and a log that stands still refuses all else.
TEST(ShippedMissions, WhatStopsOrEndsTheFlightOrReplacesTheLogWaitsForNoDisk) {
  for (const auto& [file, mission] : shipped_missions())
    for (const char* name : {"SAFE_ALL", "SHUTDOWN", "SET_DATABASE"}) {
      const Function* function = mission.supervisor.find_function(name);
      ASSERT_NE(function, nullptr) << file << " " << name;
      EXPECT_TRUE(function->essential) << file << " " << name;
    }
}

/// What a person is asked once more, and what never: nobody is to be held up on the way to safety (docs/adr/0105).
TEST(ShippedMissions, WhatEndsTheFlightOrReplacesAProgramIsConfirmedAndWhatStopsIsNot) {
  for (const auto& [file, mission] : shipped_missions()) {
    for (const char* name : {"SHUTDOWN", "REPLACE", "TAKE_BACK"})
      EXPECT_TRUE(mission.supervisor.find_function(name)->confirm) << file << " " << name;
    EXPECT_FALSE(mission.supervisor.find_function("SAFE_ALL")->confirm) << file;
    for (const auto& member : mission.subsystems)
      for (const Function& function : member.subsystem.functions)
        EXPECT_FALSE(function.confirm && function.essential) << member.subsystem.name << " " << function.name;
  }
}

TEST(ShippedMissions, AProtectionIsSetByOneFunctionAtMostAndByNoTelecommandForParameters) {
  for (const auto& [file, mission] : shipped_missions())
    for (const auto& member : mission.subsystems)
      for (const Parameter& parameter : member.subsystem.parameters) {
        if (!parameter.protection) continue;
        EXPECT_FALSE(parameter.writable()) << member.subsystem.name << " " << parameter.field.name;
        const auto index = &parameter - member.subsystem.parameters.data();
        const auto raises = [&](const Function& function) {
          return std::ranges::find(function.unrepeated, index) != function.unrepeated.end();
        };
        EXPECT_LE(std::ranges::count_if(member.subsystem.functions, raises), 1) << parameter.field.name;
      }
}

/// What watches an arm in all states, and no function sets: a mission that wants more has a descriptor of its own (docs/adr/0170, 0174).
TEST(ShippedMissions, WhatStopsAnArmByItsOwnSensorsNoMissionWidens) {
  int tried = 0;
  for (const auto& [file, mission] : shipped_missions())
    for (const auto& member : mission.subsystems)
      for (const char* limit : {"LIMITS.TORQUE", "LIMITS.TORQUE_HARD", "LIMITS.SPEED", "TORQUE_HARD", "SPEED_LIMIT"}) {
        const std::string name{limit};
        const Parameter* parameter = member.subsystem.find_parameter(name.substr(0, name.find('.')));
        if (parameter == nullptr || (name.find('.') != std::string::npos) == parameter->members.empty()) continue;
        ++tried;
        EXPECT_TRUE(parameter->protection) << file << " " << member.subsystem.name << " " << limit;
        const Field* field = &parameter->field;
        for (const auto& part : parameter->members)
          if (part.field.name == name.substr(name.find('.') + 1)) field = &part.field;
        ASSERT_TRUE(field->minimum && field->maximum) << file << " " << member.subsystem.name << " " << limit;
        // A mission's <Set> beyond a range is refused by the reader.
        EXPECT_EQ(field->minimum->real(), field->maximum->real())
            << file << " " << member.subsystem.name << " " << limit;
      }
  EXPECT_GE(tried, 1) << "of whichever arm is shipped";
}

/// Read as text and not by the reader, which has made of it what the supervisor goes by: whoever sets one of these is not brought back to move
/// by itself (docs/adr/0170). That nobody else changes a protection is tried beside each subsystem: hirosco/subsystem/testing/tried_functions.hpp.
TEST(ShippedMissions, WhatFunctionsOfArmsSetIsLostInACrashAndSaid) {
  constexpr std::array<std::pair<const char*, const char*>, 15> sets{{{"SET_TEMP_LIMITS", "TEMP_LIMITS"},
                                                                      {"SET_GAINS", "KP"},
                                                                      {"SET_GAINS", "KD"},
                                                                      {"SET_TORQUE_LIMIT", "TORQUE_LIMIT"},
                                                                      {"KEEP_OUT", "KEPT_OUT"},
                                                                      {"SET_CONTACT", "CONTACT_WATCH"},
                                                                      {"SET_FORCE_LIMIT", "TOOL_FORCE_LIMIT"},
                                                                      {"SET_POWER_LIMIT", "POWER_LIMIT"},
                                                                      {"SET_POWER_LIMIT", "TOOL_POWER_LIMIT"},
                                                                      {"SET_PAYLOAD", "PAYLOAD"},
                                                                      {"SET_TOOL", "TOOL_PLACE"},
                                                                      {"SET_FORCE_SCALE", "FORCE_SCALE"},
                                                                      {"PASSIVITY", "PASSIVITY"},
                                                                      {"POINT_TO", "REFERENCE"},
                                                                      {"POINT_HERE", "REFERENCE"}}};
  int tried = 0;
  for (const auto& [file, mission] : shipped_missions())
    for (const auto& member : mission.subsystems)
      for (const auto& [name, wanted] : sets) {
        const Function* function = member.subsystem.find_function(name);
        const Parameter* parameter = member.subsystem.find_parameter(wanted);
        if (function == nullptr || parameter == nullptr) continue;
        ++tried;
        const auto index = parameter - member.subsystem.parameters.data();
        EXPECT_NE(std::ranges::find(function->unrepeated, index), function->unrepeated.end())
            << file << " " << member.subsystem.name << " " << name << " " << wanted;
      }
  EXPECT_GE(tried, 1) << "of whichever is shipped";
}

/// Whom a link joins to one, and to those, goes down with it and comes back with it.
std::vector<std::string> network_of(const Mission& mission, const std::string& name) {
  std::vector<std::string> network{name};
  for (std::size_t next = 0; next < network.size(); ++next)
    for (const MissionLink& link : mission.links) {
      const std::string member = network[next];
      const std::string& partner = link.from == member ? link.to : link.from;
      if ((link.from == member || link.to == member) && std::ranges::find(network, partner) == network.end())
        network.push_back(partner);
    }
  return network;
}

/// Who stands beside an arm whose program has crashed does not expect it to move before somebody has commanded it (docs/adr/0221).
TEST(ShippedMissions, NoCrashBringsWhatActsBackToMoveByItself) {
  int tried = 0;
  int commanded = 0;
  for (const auto& [file, mission] : shipped_missions())
    for (const Plan& plan : mission.plans)
      for (const PlanStep& step : plan.steps) {
        if (step.kind != "restart") continue;
        ++tried;
        if (step.values.at(restart_to) != static_cast<std::int64_t>(State::Operational)) continue;
        ++commanded;
        for (const auto& died : mission.subsystems)
          for (const std::string& name : network_of(mission, died.subsystem.name)) {
            if (!plan.subsystem.empty() && plan.subsystem != died.subsystem.name) continue;
            EXPECT_TRUE(std::ranges::none_of(mission.find_member(name)->devices, &Device::actuator))
                << file << ": plan " << plan.name << " brings " << name << " back to Operational";
          }
      }
  EXPECT_GE(tried, 1);
  EXPECT_GE(commanded, 1) << "of where nothing can move, which shows that it is looked at";
}

}  // namespace
}  // namespace hirosco::descriptor
