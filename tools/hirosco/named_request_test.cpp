// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/named_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A craft of ARM with two configurations, and a mode.
struct NamedRequestTest : ::testing::Test {
  descriptor::Mission mission = [] {
    descriptor::Mission made;
    made.name = "CRAFT";
    made.supervisor.name = "SUPERVISOR";
    made.supervisor.id = 1;
    auto& set_mode = made.supervisor.functions.emplace_back();
    set_mode.name = "SET_MODE";
    auto& mode_wanted = set_mode.arguments.emplace_back().field;
    mode_wanted.name = "MODE";
    mode_wanted.type = Type::Uint8;
    auto& arm = made.subsystems.emplace_back().subsystem;
    arm.name = "ARM";
    arm.id = 10;
    for (const auto& [id, name] : {std::pair{1, "SLOW"}, std::pair{2, "QUICK"}}) {
      auto& configuration = arm.configurations.emplace_back();
      configuration.id = static_cast<std::uint8_t>(id);
      configuration.name = name;
    }
    auto& mode = made.modes.emplace_back();
    mode.id = 7;
    mode.name = "night";
    return made;
  }();

  /// "ARM SET_STATE 8,1: 04", or what is said about it.
  [[nodiscard]] std::string named(const std::string& subsystem, const std::string& function,
                                  const std::vector<std::string>& words = {}) const {
    const auto found = named_request(mission, subsystem, function, words);
    if (!found) return found.error();
    std::string text = found->subsystem->name + " " + found->request.name + ":";
    for (const std::byte octet : found->data) text += " " + std::to_string(std::to_integer<int>(octet));
    return text;
  }
};

TEST_F(NamedRequestTest, NamesAreTakenInEitherCaseAndWhatTheyStandForGoesUp) {
  EXPECT_THAT(named("arm", "set_state", {"Offline"}), AllOf(StartsWith("ARM SET_STATE:"), EndsWith(" 0")));
  EXPECT_THAT(named("ARM", "CONFIGURE", {"quick"}), AllOf(StartsWith("ARM CONFIGURE:"), EndsWith(" 2")));
  EXPECT_THAT(named("supervisor", "SET_MODE", {"night"}), AllOf(StartsWith("SUPERVISOR SET_MODE:"), EndsWith(" 7")));
  EXPECT_EQ(named("ARM", "ping"), "ARM PING:");
}

TEST_F(NamedRequestTest, WhatIsNoneIsSaidWithWhatThereIs) {
  EXPECT_EQ(named("", ""), "of which subsystem? the mission has SUPERVISOR, ARM");
  EXPECT_EQ(named("AMR", "PING"), "no subsystem 'AMR'; did you mean 'ARM'?; mission CRAFT has SUPERVISOR, ARM");
  EXPECT_THAT(named("ARM", ""), AllOf(StartsWith("which function? ARM has\n"), HasSubstr("\n  SET_STATE")));
  EXPECT_THAT(named("ARM", "SET_STAT"),
              AllOf(StartsWith("ARM has no function 'SET_STAT'; did you mean 'SET_STATE'?; it has\n"),
                    HasSubstr("\n  CONFIGURE")));
  EXPECT_THAT(named("ARM", "CONFIGURE", {"quickest"}),
              StartsWith("'quickest' is no CONFIGURATION, which may be 0..255; usage:\n  CONFIGURE"));
  EXPECT_THAT(named("ARM", "CONFIGURE"), HasSubstr("; usage:\n  CONFIGURE"));
}

}  // namespace
}  // namespace hirosco::tools
