// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/permission_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "hirosco/parameter/type.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// CAMERA may call MOVE_TO of HAND, read and hear things of ARM; ARM has a parameter of its own and a service.
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using testing::arm;
using testing::camera;
using ::testing::ElementsAre;
using testing::hand;
using testing::in_states;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using enum State;

struct PermissionTableTest : ::testing::Test {
  static constexpr std::uint16_t everywhere = 0x03FF;
  static constexpr std::uint8_t own_service = 200;
  descriptor::Mission mission = testing::small_mission();
  descriptor::SubsystemDescriptor& of_arm = mission.subsystems[0].subsystem;
  const descriptor::Mode& open = mission.modes[0];
  const descriptor::Mode& narrow = mission.modes[1];

  void SetUp() override {
    descriptor::Parameter scale;
    scale.field.name = "SCALE";
    scale.field.type = Type::Uint16;
    scale.id = 8;
    scale.writable_states = in_states({SafeOperational});
    of_arm.parameters = {scale};
    mission.modes[0].permits.front().parameters = {"SCALE"};
    descriptor::CustomService archive;
    archive.name = "ARCHIVE";
    archive.type = own_service;
    archive.requests = {testing::function("COUNT", in_states({PreOperational, SafeOperational}))};
    archive.requests[0].service = own_service;
    archive.requests[0].subtype = 3;
    of_arm.services = {archive};
  }
  void camera_commands(std::uint16_t whom, std::vector<std::string> functions, std::vector<descriptor::Thing> things) {
    mission.subsystems[2].subsystem.commands.push_back(
        {.subsystem = "", .functions = std::move(functions), .things = std::move(things), .at = {}, .apid = whom});
  }
  /// What a row stands for, made without looking at how the table makes it; empty: TC[service,subtype] without data.
  static std::vector<std::byte> data_of(const PermissionRow& row) {
    constexpr std::string_view to_state = "SET_STATE ", sets = "set ";
    if (row.request.starts_with(to_state))
      for (const auto& each : EnumTexts<State>::table)
        if (row.request.substr(to_state.size()) == each.text)
          return testing::call_data("SET_STATE", static_cast<int>(each.value));
    if (row.request == "CONFIGURE") return testing::call_data("CONFIGURE", 0);
    if (row.service == 8) return testing::call_data(row.request);
    if (!row.request.starts_with(sets)) return {};
    const auto* parameter = row.addressee->find_parameter(row.request.substr(sets.size()));
    std::vector<std::byte> data(5 + parameter->octets());
    OctetWriter{data}
        .put(std::uint8_t{1})
        .put(ParameterId{row.addressee->id, parameter->field.type, parameter->id}.wire());
    return data;
  }
  [[nodiscard]] std::vector<PermissionRow> rows_of(const Origin& origin, std::uint16_t addressee,
                                                   const descriptor::Mode& mode) const {
    auto rows = permission_table(mission, mode);
    std::erase_if(rows, [&](const PermissionRow& row) {
      const bool same = row.origin.apid() == origin.apid() && row.origin.is_ground() == origin.is_ground();
      return !same || row.addressee->id != addressee;
    });
    return rows;
  }
  [[nodiscard]] std::vector<std::string> requests(const Origin& origin, std::uint16_t addressee) const {
    std::vector<std::string> all;
    for (const PermissionRow& row : rows_of(origin, addressee, open)) all.push_back(row.request);
    return all;
  }
  [[nodiscard]] PermissionRow row(const Origin& origin, std::uint16_t addressee, std::string_view request,
                                  const descriptor::Mode& mode) const {
    for (PermissionRow& each : rows_of(origin, addressee, mode))
      if (each.request == request) return each;
    ADD_FAILURE() << "no row " << request;
    return {};
  }
};

TEST_F(PermissionTableTest, EachRowIsWhatIsDecidedInEachStateInAndOutOfAChangeOfMode) {
  camera_commands(hand, {"MOVE_TO"}, {});
  const LinkGraph links{mission};
  for (const descriptor::Mode* mode : {&open, &narrow}) {
    const auto rows = permission_table(mission, *mode);
    ASSERT_THAT(rows, Not(IsEmpty()));
    for (const PermissionRow& row : rows) {
      SCOPED_TRACE(mode->name + ": " + std::to_string(row.origin.apid()) + " asks " + row.addressee->name + ": " +
                   row.request);
      const auto packet = testing::telecommand(row.addressee->id, row.service, row.subtype, data_of(row));
      const auto asked = pus::TelecommandView::parse(packet).value();
      std::uint16_t permitted = 0, essential = 0, in_change = 0;
      for (unsigned state = 0; state < 10; ++state) {
        Situation situation{.mission = mission, .mode = *mode, .links = links, .state = static_cast<State>(state)};
        const auto bit = static_cast<std::uint16_t>(1U << state);
        const auto decision = decide(asked, row.origin, situation);
        if (decision) permitted |= bit;
        if (decision && decision->essential) essential |= bit;
        situation.changing = true;
        if (decide(asked, row.origin, situation)) in_change |= bit;
      }
      EXPECT_EQ(row.permitted, permitted);
      EXPECT_EQ(row.essential, essential);
      EXPECT_EQ(row.in_change, in_change);
      EXPECT_THAT(row.not_in, IsEmpty());
    }
  }
}

TEST_F(PermissionTableTest, WhatIsKnownOfTheseRequestsStandsInIt) {
  const auto ground = Origin::ground();
  const auto move = row(ground, arm, "MOVE_TO", open);
  EXPECT_EQ(move.permitted, in_states({Operational}));
  EXPECT_EQ(move.essential, 0);
  EXPECT_EQ(move.in_change, 0) << "the craft moves nothing on its way into another mode";
  EXPECT_EQ(row(ground, hand, "MOVE_TO", narrow).permitted, 0) << "that mode does not open it";
  const auto brake = row(ground, hand, "BRAKE", narrow);
  EXPECT_EQ(brake.permitted, everywhere) << "what protects is refused by no mode";
  EXPECT_EQ(brake.essential, everywhere);
  EXPECT_EQ(brake.in_change, everywhere);
  EXPECT_EQ(row(ground, arm, "set SCALE", open).permitted, in_states({SafeOperational}));
  EXPECT_EQ(row(ground, arm, "ARCHIVE COUNT", open).permitted, in_states({PreOperational, SafeOperational}));
  EXPECT_EQ(row(ground, supervisor_apid, "CONFIGURE", open).permitted, 0) << "the supervisor's states are its own";
}

TEST_F(PermissionTableTest, EverySenderAsksEverybodyForEverythingOnce) {
  camera_commands(hand, {"MOVE_TO"}, {});
  std::map<std::pair<int, std::uint16_t>, std::multiset<std::string>> asked;
  for (const PermissionRow& row : permission_table(mission, open)) {
    const int sender = row.origin.is_ground() ? 0 : row.origin.apid();
    asked[{sender, row.addressee->id}].insert(row.request);
  }
  EXPECT_EQ(asked.size(), 3U * 4U) << "ground, supervisor and CAMERA, each of all four";
  std::size_t standard = 0;
  for (const pus::ServiceKind* kind : pus::standard_services())
    if (kind->type != 8) standard += kind->requests.size();
  for (const int sender : {0, int{supervisor_apid}, int{camera}})
    for (const descriptor::SubsystemDescriptor* addressee : mission.everybody()) {
      SCOPED_TRACE(std::to_string(sender) + " " + addressee->name);
      const auto& requests = asked[{sender, addressee->id}];
      EXPECT_EQ(std::set<std::string>(requests.begin(), requests.end()).size(), requests.size());
      for (const auto& state : EnumTexts<State>::table)
        EXPECT_TRUE(requests.contains("SET_STATE " + std::string{state.text}));
      for (const auto& function : addressee->functions) EXPECT_TRUE(requests.contains(function.name));
      const std::size_t own = addressee->id == arm ? 1 : 0;
      // In place of TC[20,3] there is a row for each parameter.
      EXPECT_EQ(requests.size(),
                standard - 1 + addressee->parameters.size() + 10 + 1 + addressee->functions.size() + own);
    }
}

TEST_F(PermissionTableTest, WhatASubsystemDeclaresOfAnotherStandsThereThingByThingAndIsPermitted) {
  using Kind = descriptor::Thing::Kind;
  const ParameterId scale{arm, Type::Uint16, 8};
  camera_commands(arm, {},
                  {{.kind = Kind::Read, .name = "SCALE", .id = scale.wire()},
                   {.kind = Kind::Event, .name = "CRACKED", .id = 2000},
                   {.kind = Kind::Housekeeping, .name = "4800", .id = 4800}});
  mission.subsystems[2].subsystem.subscribes = {
      {.subsystem = "ARM", .things = {{.kind = Kind::Event, .name = "CRACKED", .id = 2000}}, .at = {}, .apid = arm}};
  mission.modes[0].permits.front().services = {3, 5, 20};
  const auto by_camera = Origin::subsystem(camera);
  const std::vector<std::string> things{"read SCALE",   "enable CRACKED",   "disable CRACKED", "enable 4800",
                                        "disable 4800", "one shot of 4800", "interval of 4800"};
  EXPECT_THAT(requests(by_camera, arm), IsSupersetOf(things));
  for (const std::string& thing : things) EXPECT_NE(row(by_camera, arm, thing, open).permitted, 0) << thing;
  EXPECT_THAT(requests(by_camera, hand), Not(::testing::Contains("read SCALE")));
  EXPECT_THAT(requests(Origin::ground(), arm), Not(::testing::Contains("read SCALE"))) << "it declares nothing";
  EXPECT_EQ(row(by_camera, supervisor_apid, "hear CRACKED of ARM", open).permitted, everywhere);
}

TEST_F(PermissionTableTest, WhomAPermitNamesStandsThereAloneAndOfTheSupervisorWhatIsHeard) {
  camera_commands(hand, {"MOVE_TO"}, {});
  camera_commands(supervisor_apid, {"SET_MODE"}, {});
  mission.subsystems[2].subsystem.subscribes = {
      {.subsystem = "SUPERVISOR",
       .things = {{.kind = descriptor::Thing::Kind::Housekeeping, .name = "4701", .id = 4701}},
       .at = {},
       .apid = supervisor_apid}};
  const auto by_camera = Origin::subsystem(camera), ground = Origin::ground();
  EXPECT_EQ(row(by_camera, supervisor_apid, "SET_MODE", open).permitted, 0) << "no row names it";
  mission.modes[0].permits.push_back(
      {.subsystem = "SUPERVISOR", .functions = {"*"}, .services = {}, .parameters = {}, .at = {}, .from = {"CAMERA"}});
  mission.modes[0].permits[0].from = {"ground"};
  EXPECT_EQ(row(by_camera, supervisor_apid, "SET_MODE", open).permitted, in_states({Operational}));
  EXPECT_EQ(row(by_camera, supervisor_apid, "SET_MODE", open).essential, 0);
  EXPECT_EQ(row(by_camera, supervisor_apid, "hear 4701 of SUPERVISOR", open).permitted, everywhere);
  EXPECT_EQ(row(by_camera, hand, "MOVE_TO", open).permitted, 0);
  EXPECT_EQ(row(ground, hand, "MOVE_TO", open).permitted, in_states({Operational}));
}

TEST_F(PermissionTableTest, WhoDeclaresNothingHasNoRow) {
  for (const PermissionRow& row : permission_table(mission, open)) EXPECT_FALSE(row.origin.is_subsystem());
}

TEST_F(PermissionTableTest, ConfigurationsThatLeaveAServiceOutStandBesideItAndTheOthersAreAsked) {
  EXPECT_THAT(row(Origin::ground(), arm, "ARCHIVE COUNT", open).not_in, IsEmpty());
  of_arm.service_uses = {{.type = own_service, .offered = false, .loop = -1, .at = {}}};
  EXPECT_THAT(row(Origin::ground(), arm, "ARCHIVE COUNT", open).not_in, ElementsAre("-", "COUPLED"));
  EXPECT_EQ(row(Origin::ground(), arm, "ARCHIVE COUNT", open).permitted, 0) << "nobody offers it";
  of_arm.configurations[0].services = {{.type = own_service, .offered = true, .loop = -1, .at = {}}};
  const auto offered = row(Origin::ground(), arm, "ARCHIVE COUNT", open);
  EXPECT_THAT(offered.not_in, ElementsAre("-"));
  EXPECT_EQ(offered.permitted, in_states({PreOperational, SafeOperational})) << "as with COUPLED in force";
  EXPECT_THAT(row(Origin::ground(), arm, "MOVE_TO", open).not_in, IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
