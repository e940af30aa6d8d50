// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/parameter/type.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/data_handling/permission_table.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// What a mode opens of the parameters of ARM: GAIN and SPEED may be set in Safe-Operational.
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using testing::arm;
using testing::hand;

constexpr std::uint8_t gain_number = 3, speed_number = 4, number_of_none = 9;

struct ParameterPermission : ::testing::Test {
  static constexpr const char* opened = "";
  descriptor::Mission mission = testing::small_mission();
  descriptor::Mode& mode = mission.modes[1];

  void SetUp() override {
    for (const auto& [name, id] : {std::pair{"GAIN", gain_number}, std::pair{"SPEED", speed_number}}) {
      descriptor::Parameter made;
      made.field.name = name;
      made.id = id;
      made.writable_states = testing::in_states({State::SafeOperational});
      mission.subsystems[0].subsystem.parameters.push_back(made);
      mission.subsystems[1].subsystem.parameters.push_back(made);
    }
  }
  void permits(std::vector<std::string> parameters, std::vector<std::uint8_t> services = {},
               std::string whose = "ARM") {
    mode.permits.push_back({.subsystem = std::move(whose),
                            .functions = {},
                            .services = std::move(services),
                            .parameters = std::move(parameters),
                            .at = {}});
  }
  /// Empty: it passes.
  [[nodiscard]] std::string refusal(std::uint8_t subtype, std::initializer_list<std::uint8_t> ids,
                                    std::uint16_t apid = arm, State state = State::SafeOperational) const {
    std::vector<std::byte> data(1 + ids.size() * (4 + (subtype == 3 ? sizeof(double) : 0)));
    OctetWriter writer{data};
    writer.put(static_cast<std::uint8_t>(ids.size()));
    for (const std::uint8_t id : ids) {
      writer.put(ParameterId{apid, Type::Double, id}.wire());
      if (subtype == 3) writer.put(1.0);
    }
    const LinkGraph links{mission};
    const auto packet = testing::telecommand(apid, 20, subtype, data);
    const auto decision =
        decide(pus::TelecommandView::parse(packet).value(), Origin::ground(), {mission, mode, links, state, 0});
    return decision ? opened : std::to_string(static_cast<int>(decision.error().code()));
  }
  const std::string wrong_mode = std::to_string(static_cast<int>(pus::FailureCode::WrongMode));
};

TEST_F(ParameterPermission, AModeThatNamesAParameterOpensItsSettingAndNothingElseOfTheService) {
  permits({"GAIN"});
  EXPECT_EQ(refusal(3, {gain_number}), opened);
  EXPECT_EQ(refusal(3, {speed_number}), wrong_mode);
  EXPECT_EQ(refusal(3, {gain_number, speed_number}), wrong_mode);
  EXPECT_EQ(refusal(1, {gain_number}), wrong_mode) << "reading is the service's";
  EXPECT_EQ(refusal(3, {gain_number}, arm, State::Operational),
            std::to_string(static_cast<int>(pus::FailureCode::NotPermittedNow)));
  EXPECT_EQ(refusal(3, {gain_number}, hand), wrong_mode) << "it is the arm's that is opened";
}

TEST_F(ParameterPermission, TheServiceAloneOpensReadingAndNoSetting) {
  permits({}, {20});
  EXPECT_EQ(refusal(1, {gain_number}), opened);
  EXPECT_EQ(refusal(3, {gain_number}), wrong_mode);
}

TEST_F(ParameterPermission, AllOfThemAreOpenedByAStarOfOneSubsystemOrOfAll) {
  permits({"*"}, {}, "*");
  for (const std::uint16_t apid : {arm, hand}) EXPECT_EQ(refusal(3, {gain_number, speed_number}, apid), opened);
}

TEST_F(ParameterPermission, WhatCannotBeReadIsTheAddresseesToRefuseWhereAnyIsOpenedAndTheModesWhereNoneIs) {
  EXPECT_EQ(refusal(3, {}), wrong_mode);
  EXPECT_EQ(refusal(3, {number_of_none}), wrong_mode);
  permits({"GAIN"});
  EXPECT_EQ(refusal(3, {}), opened);
  EXPECT_EQ(refusal(3, {number_of_none}), opened);
  EXPECT_EQ(refusal(3, {speed_number, number_of_none}), wrong_mode) << "what stands before it is seen";
}

TEST_F(ParameterPermission, StandsInTheTableAsItIsDecided) {
  mode.permits.clear();
  permits({"GAIN"});
  std::uint16_t gain = 0, speed = 0xFFFF;
  for (const PermissionRow& row : permission_table(mission, mode)) {
    if (!row.origin.is_ground() || row.addressee->id != arm) continue;
    if (row.request == "set GAIN") gain = row.permitted;
    if (row.request == "set SPEED") speed = row.permitted;
  }
  EXPECT_EQ(gain, testing::in_states({State::SafeOperational}));
  EXPECT_EQ(speed, 0);
}

}  // namespace
}  // namespace hirosco::supervisor
