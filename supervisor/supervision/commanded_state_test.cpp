// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/commanded_state.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "hirosco/parameter/type.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// What commanded_members_test.cpp does not see through its telecommands and reports: notes, limits, structures.
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::call_data;
using ::testing::ElementsAre;
using testing::in_states;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;

struct CommandedStateTest : ::testing::Test {
  static constexpr std::uint16_t known_structure = 100, other_structure = 101;
  static constexpr std::uint8_t single = 1, in_force = 2;
  static constexpr std::uint8_t gains = 20, gain_p = 21, gain_i = 22, first_table = 30;
  static constexpr std::uint32_t table_octets = 200;
  static constexpr std::uint8_t own_service = 200;
  descriptor::SubsystemDescriptor subsystem = testing::small_mission().subsystems[0].subsystem;
  CommandedState commanded;

  void SetUp() override {
    descriptor::Parameter whole;
    whole.field.name = "GAINS";
    whole.field.type = Type::Struct;
    whole.id = gains;
    whole.writable_states = in_states({PreOperational});
    for (const auto& [name, id] : {std::pair{"P", gain_p}, std::pair{"I", gain_i}}) {
      descriptor::Parameter::Member member;
      member.field.name = name;
      member.field.type = Type::Uint16;
      member.id = id;
      whole.members.push_back(member);
    }
    subsystem.parameters.push_back(whole);
    for (std::uint8_t i = 0; i < 5; ++i) {
      descriptor::Parameter table;
      table.field.name = "TABLE" + std::to_string(i);
      table.field.type = Type::Uint8;
      table.field.count = table_octets;
      table.id = static_cast<std::uint8_t>(first_table + i);
      table.writable_states = in_states({PreOperational});
      subsystem.parameters.push_back(table);
    }
    descriptor::Parameter only_operational;
    only_operational.field.name = "LATE";
    only_operational.field.type = Type::Uint16;
    only_operational.id = 3;
    only_operational.writable_states = in_states({Operational});
    descriptor::Parameter limit;
    limit.field.name = "LIMIT";
    limit.id = 4;
    limit.protection = true;
    subsystem.parameters.insert(subsystem.parameters.end(), {only_operational, limit});
    auto sets = testing::function("SET_LIMIT", in_states({Operational}));
    sets.unrepeated = {static_cast<std::uint16_t>(subsystem.parameters.size() - 1)};
    subsystem.functions.push_back(sets);
    auto request = testing::function("TABLES", in_states({Operational}));
    request.service = own_service;
    request.unrepeated = {1, 2};
    descriptor::CustomService own;
    own.type = own_service;
    own.requests = {request};
    subsystem.services = {own};
    descriptor::HousekeepingStructure housekeeping;
    housekeeping.id = known_structure;
    subsystem.housekeeping = {housekeeping};
  }
  template <class... Values>
  static std::vector<std::byte> data_of(Values... values) {
    std::vector<std::byte> data(64);
    OctetWriter writer{data};
    (writer.put(values), ...);
    data.resize(writer.size());
    return data;
  }
  Kept completed(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data) {
    const auto packet = testing::telecommand(arm, service, subtype, data);
    return commanded.completed(pus::TelecommandView::parse(packet).value(), subsystem);
  }
  [[nodiscard]] bool concerns(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data) const {
    const auto packet = testing::telecommand(arm, service, subtype, data);
    return CommandedState::concerns(pus::TelecommandView::parse(packet).value(), subsystem);
  }
  void state(State to) { completed(8, 1, call_data("SET_STATE", static_cast<int>(to))); }
  void up() {
    state(PreOperational);
    completed(8, 1, call_data("CONFIGURE", in_force));
    state(SafeOperational);
    state(Operational);
  }
  static std::uint32_t id(Type type, std::uint8_t parameter) { return ParameterId{arm, type, parameter}.wire(); }
  void set_gain(std::uint8_t which, std::uint16_t value) {
    completed(20, 3, data_of(single, id(Type::Uint16, which), value));
  }
  /// "20,3 01...": all that would be sent.
  [[nodiscard]] std::vector<std::string> settings(const CommandedState& of) const {
    std::vector<std::string> all;
    for (const State in : {PreOperational, SafeOperational})
      for (const SettingCommand& each : of.settings_for(in, subsystem)) {
        all.push_back(fmt::format("{},{} ", each.service, each.subtype));
        for (const std::byte octet : each.data) all.back() += fmt::format("{:02x}", std::to_integer<int>(octet));
      }
    return all;
  }
};

TEST_F(CommandedStateTest, WhatIsNotedIsRecalledWholeAndNothingElseIsLeft) {
  up();
  set_gain(gain_p, 7);
  set_gain(3, 8);
  completed(8, 1, call_data("SET_LIMIT"));
  completed(5, 6, data_of(single, std::uint16_t{4}));
  completed(3, 6, data_of(single, known_structure));
  completed(3, 31, data_of(single, known_structure, std::uint32_t{20}));
  completed(3, 29, data_of(known_structure, single, id(Type::Uint16, gain_p), std::uint8_t{0}));
  completed(3, 1, data_of(other_structure, std::uint32_t{40}, single, id(Type::Uint16, gain_i), std::uint8_t{0}));
  completed(3, 5, data_of(single, other_structure));
  std::vector<std::byte> room(1024);
  OctetWriter writer{room};
  commanded.note(writer);
  const auto noted = std::exchange(commanded, {});
  ASSERT_EQ(settings(noted).size(), 8U) << "all kinds";
  completed(5, 6, data_of(single, std::uint16_t{9}));
  OctetReader reader{writer.written()};
  commanded.recall(reader);
  EXPECT_TRUE(reader.exhausted());
  EXPECT_EQ(commanded.state(), Operational);
  EXPECT_EQ(commanded.configuration(), in_force);
  EXPECT_THAT(commanded.unrepeated_names(subsystem), ElementsAre("LIMIT"));
  EXPECT_EQ(settings(commanded), settings(noted));
  EXPECT_THAT(commanded.out_of_reach(subsystem), ElementsAre("LATE"));
}

TEST_F(CommandedStateTest, WhatFunctionsAndRequestsSetIsRememberedByNameUntilItsValuesAreGivenBack) {
  up();
  EXPECT_TRUE(concerns(8, 1, call_data("SET_LIMIT")));
  EXPECT_TRUE(concerns(own_service, 1, {}));
  EXPECT_FALSE(concerns(8, 1, call_data("MOVE_TO")));
  EXPECT_FALSE(concerns(own_service, 2, {}));
  completed(8, 1, call_data("MOVE_TO"));
  EXPECT_THAT(commanded.unrepeated_names(subsystem), IsEmpty());
  completed(own_service, 1, {});
  completed(8, 1, call_data("SET_LIMIT"));
  EXPECT_THAT(commanded.unrepeated_names(subsystem), ElementsAre("TABLE0", "TABLE1", "LIMIT"));
  state(PreOperational);
  EXPECT_THAT(commanded.unrepeated_names(subsystem), Not(IsEmpty()));
  state(Offline);
  EXPECT_THAT(commanded.unrepeated_names(subsystem), IsEmpty());
}

TEST_F(CommandedStateTest, AStateThatThereIsNotIsRecalledAsOffline) {
  up();
  std::vector<std::byte> room(64);
  OctetWriter writer{room};
  commanded.note(writer);
  room.front() = std::byte{10};
  OctetReader reader{room};
  commanded.recall(reader);
  EXPECT_EQ(commanded.state(), Offline);
}

TEST_F(CommandedStateTest, ValuesThatAreTooLongForOneTelecommandComeInSeveral) {
  up();
  for (std::uint8_t i = 0; i < 5; ++i) {
    auto data = data_of(single, id(Type::Uint8, static_cast<std::uint8_t>(first_table + i)));
    data.resize(data.size() + table_octets, std::byte{i});
    completed(20, 3, data);
  }
  const auto all = commanded.settings_for(PreOperational, subsystem);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].data.front(), std::byte{3}) << "a fourth would be more than 800 octets";
  EXPECT_EQ(all[0].data.size(), 1 + 3 * (4 + table_octets));
  EXPECT_EQ(all[1].data.front(), std::byte{2});
  EXPECT_EQ(all[1].data.back(), std::byte{4}) << "in the order in which they were set";
}

TEST_F(CommandedStateTest, AWholeStructureTakesThePlaceOfWhatIsInItAndAMemberStandsBehindIt) {
  up();
  set_gain(gain_p, 1);
  set_gain(gain_i, 2);
  completed(20, 3, data_of(single, id(Type::Struct, gains), std::uint16_t{3}, std::uint16_t{4}));
  ASSERT_EQ(settings(commanded).size(), 1U);
  EXPECT_THAT(settings(commanded).front(), ::testing::StartsWith("20,3 01"));
  EXPECT_THAT(settings(commanded).front(), ::testing::EndsWith("00030004"));
  set_gain(gain_i, 5);
  EXPECT_THAT(settings(commanded).front(), ::testing::StartsWith("20,3 02"));
  EXPECT_THAT(settings(commanded).front(), ::testing::EndsWith("0005"));
}

TEST_F(CommandedStateTest, OnItsWayDownItHasItsConfigurationUntilItGivesThatBack) {
  up();
  set_gain(gain_p, 1);
  state(ErrorOperational);
  EXPECT_EQ(commanded.state(), PreOperational) << "nobody is commanded to have failed";
  EXPECT_EQ(commanded.configuration(), in_force);
  state(PostOperational);
  EXPECT_EQ(commanded.state(), PreOperational);
  EXPECT_EQ(commanded.configuration(), 0);
  EXPECT_THAT(settings(commanded), Not(IsEmpty())) << "values are given back in Offline";
  state(Offline);
  EXPECT_THAT(settings(commanded), IsEmpty());
}

TEST_F(CommandedStateTest, OfWhatIsDefinedNowhereNothingIsKept) {
  up();
  EXPECT_EQ(completed(3, 29, data_of(other_structure, single, id(Type::Uint16, gain_p), std::uint8_t{0})),
            Kept::NoRoom);
  EXPECT_EQ(completed(3, 31, data_of(single, other_structure, std::uint32_t{20})), Kept::NoRoom);
  EXPECT_THAT(settings(commanded), IsEmpty());
  EXPECT_EQ(completed(3, 6, data_of(std::uint8_t{2}, other_structure, known_structure)), Kept::NoRoom);
  EXPECT_THAT(settings(commanded), ElementsAre("3,6 010064")) << "the one that there is";
}

TEST_F(CommandedStateTest, AnIntervalCountsFromTheFirstReportOnWhereItWasOn) {
  up();
  completed(3, 31, data_of(single, known_structure, std::uint32_t{20}));
  EXPECT_THAT(settings(commanded), ElementsAre("3,6 010064", "3,31 01006400000014", "3,5 010064")) << "on by itself";
  subsystem.housekeeping.front().enabled = false;
  EXPECT_THAT(settings(commanded), ElementsAre("3,6 010064", "3,31 01006400000014"));
  completed(3, 5, data_of(single, known_structure));
  EXPECT_THAT(settings(commanded), ElementsAre("3,6 010064", "3,31 01006400000014", "3,5 010064"));
}

TEST_F(CommandedStateTest, OnlyWhatASettingOrAStateIsIsLookedAt) {
  EXPECT_TRUE(concerns(8, 1, call_data("SET_STATE", 3)));
  EXPECT_TRUE(concerns(8, 1, call_data("CONFIGURE", 2)));
  EXPECT_TRUE(concerns(8, 1, call_data("SET_LIMIT")));
  EXPECT_TRUE(concerns(20, 3, {}));
  EXPECT_TRUE(concerns(5, 5, {}));
  EXPECT_TRUE(concerns(3, 31, {}));
  EXPECT_FALSE(concerns(8, 1, call_data("SET_STATE"))) << "to none";
  EXPECT_FALSE(concerns(8, 1, call_data("MOVE_TO")));
  EXPECT_FALSE(concerns(20, 1, {}));
  EXPECT_FALSE(concerns(5, 7, {}));
  EXPECT_FALSE(concerns(3, 27, {})) << "a report once is no setting";
  EXPECT_EQ(completed(17, 1, {}), Kept::NoMatter);
}

}  // namespace
}  // namespace hirosco::supervisor
