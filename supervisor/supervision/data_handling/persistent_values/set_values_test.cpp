// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/set_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::call_data;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// ARM's P1 is persistent, P2 is not; SET_LIMIT has an argument of each.
struct SetValuesTest : ::testing::Test {
  descriptor::MissionSubsystem member = [] {
    auto made = testing::small_mission().subsystems.front();
    for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
      auto& parameter = made.subsystem.parameters.emplace_back();
      parameter.field.name = "P" + std::to_string(id);
      parameter.field.type = Type::Uint16;
      parameter.id = id;
      parameter.persistent = id == 1;
    }
    auto limit = testing::function("SET_LIMIT", testing::in_states({descriptor::State::Operational}));
    limit.arguments.resize(2);
    limit.arguments[0].of = "P2";
    limit.arguments[1].of = "P1";
    made.subsystem.functions.push_back(limit);
    return made;
  }();
  ValueSet values{member};

  static std::uint32_t id(std::uint8_t parameter) { return ParameterId{arm, Type::Uint16, parameter}.wire(); }
  static std::vector<std::byte> both(std::uint16_t first, std::uint16_t second) {
    std::vector<std::byte> data(13);
    OctetWriter{data}.put(std::uint8_t{2}).put(id(1)).put(first).put(id(2)).put(second);
    return data;
  }
  [[nodiscard]] AwaitedChanges::Ids set(std::uint8_t service, std::uint8_t subtype, Octets data) const {
    const auto packet = testing::telecommand(arm, service, subtype, data);
    return set_by(pus::TelecommandView::parse(packet).value(), member.subsystem, values);
  }
};

TEST_F(SetValuesTest, AWriteSetsThoseOfItThatArePersistent) { EXPECT_THAT(set(20, 3, both(7, 8)), ElementsAre(id(1))); }

TEST_F(SetValuesTest, AFunctionSetsThosePersistentThatAnArgumentIsOf) {
  EXPECT_THAT(set(8, 1, call_data("SET_LIMIT")), ElementsAre(id(1)));
  EXPECT_THAT(set(8, 1, call_data("MOVE_TO")), IsEmpty());
  EXPECT_THAT(set(8, 1, call_data("NO_SUCH")), IsEmpty());
}

TEST_F(SetValuesTest, WhatOnlyAsksSetsNothing) { EXPECT_THAT(set(20, 1, both(7, 8)), IsEmpty()); }

TEST_F(SetValuesTest, ValuesAreTakenUpToTheFirstThatIsCutOrUnknown) {
  const auto numbers = [&](Octets data) {
    std::vector<std::pair<std::uint32_t, std::uint16_t>> found;
    each_value(member.subsystem, data, [&](std::uint32_t of, Octets value) {
      found.emplace_back(of, OctetReader{value}.get<std::uint16_t>());
    });
    return found;
  };
  const auto data = both(7, 8);
  EXPECT_THAT(numbers(data), ElementsAre(std::pair{id(1), std::uint16_t{7}}, std::pair{id(2), std::uint16_t{8}}));
  EXPECT_THAT(numbers(Octets{data}.first(12)), ElementsAre(std::pair{id(1), std::uint16_t{7}}));
  auto unknown = data;
  unknown[4] = std::byte{99};
  EXPECT_THAT(numbers(unknown), IsEmpty());
  EXPECT_THAT(numbers({}), IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
