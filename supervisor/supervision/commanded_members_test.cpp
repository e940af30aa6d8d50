// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/commanded_members.hpp"

#include <fmt/format.h>

#include "hirosco/parameter/type.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

template <class... Values>
std::vector<std::byte> octets(Values... values) {
  std::vector<std::byte> data(64);
  OctetWriter writer{data};
  (writer.put(values), ...);
  data.resize(writer.size());
  return data;
}
constexpr std::uint8_t one = 1;
constexpr std::uint16_t declared = 100;

struct CommandedMembersTest : PartsTest {
  CommandedMembers& commanded = parts.commanded;
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    descriptor::Plan plan;
    plan.name = "back";
    plan.event = "PROCESS_DIED";
    plan.steps = {{"restart", {3, 60, 0, static_cast<std::int64_t>(Operational)}}, {"shut_down_network"}};
    craft.mission.plans.push_back(plan);
    auto& subsystem = craft.mission.subsystems.front().subsystem;
    const auto add = [&](std::uint8_t id, std::uint16_t states, bool protection = false) {
      descriptor::Parameter made;
      made.field.name = "P" + std::to_string(id);
      made.field.type = Type::Uint16;
      made.id = id;
      made.writable_states = states;
      made.protection = protection;
      subsystem.parameters.push_back(made);
    };
    add(1, in_states({PreOperational, SafeOperational}));
    add(2, in_states({SafeOperational}));
    add(3, in_states({Operational}));
    add(4, 0, true);
    auto limit = function("SET_LIMIT", in_states({Operational}));
    limit.unrepeated = {static_cast<std::uint16_t>(subsystem.parameters.size() - 1)};
    subsystem.functions.push_back(limit);
    descriptor::HousekeepingStructure structure;
    structure.id = declared;
    structure.interval_cycles = 10;
    subsystem.housekeeping = {structure};
    start_all(Offline);
  }
  static std::uint32_t id(std::uint8_t parameter) { return ParameterId{arm, Type::Uint16, parameter}.wire(); }
  /// It leaves for ARM; its request id.
  std::uint32_t leaves(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data,
                       std::uint8_t ack = pus::ack_all) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = arm,
                                                .sequence_count = ++count,
                                                .ack = ack,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = supervisor_apid},
                                               data);
    const auto telecommand = pus::TelecommandView::parse(*packet).value();
    commanded.forwarded(arm, telecommand, Origin::supervisor());
    return telecommand.request_id();
  }
  void done(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data) {
    verify(arm, leaves(service, subtype, data), 7);
  }
  void state(State to) { done(8, 1, call_data("SET_STATE", static_cast<int>(to))); }
  void configure(int which) { done(8, 1, call_data("CONFIGURE", which)); }
  void up() {
    state(PreOperational);
    configure(2);
    state(SafeOperational);
    state(Operational);
  }
  [[nodiscard]] std::vector<std::string> not_repeated() {
    return commanded.of(arm).unrepeated_names(craft.member(arm)->descriptor());
  }
  /// "20,3: 01...", what is sent in this state.
  std::vector<std::string> settings(State in = PreOperational) {
    std::vector<std::string> all;
    for (const SettingCommand& each : commanded.of(arm).settings_for(in, craft.member(arm)->descriptor())) {
      std::string text = fmt::format("{},{}:", each.service, each.subtype);
      for (const std::byte octet : each.data) text += fmt::format(" {:x}", std::to_integer<int>(octet));
      all.push_back(text);
    }
    return all;
  }
};

TEST_F(CommandedMembersTest, WhatWasCompletedCountsAndWhatWasNotDoesNot) {
  up();
  EXPECT_EQ(commanded.of(arm).state(), Operational);
  EXPECT_EQ(commanded.of(arm).configuration(), 2);
  state(SafeOperational);
  for (const std::uint8_t failure : std::array<std::uint8_t, 4>{2, 4, 8, 10}) {
    verify(arm, leaves(8, 1, call_data("SET_STATE", static_cast<int>(Operational))), failure);
    EXPECT_EQ(commanded.of(arm).state(), SafeOperational) << int{failure};
  }
  leaves(8, 1, call_data("SET_STATE", static_cast<int>(Operational)));
  EXPECT_EQ(commanded.of(arm).state(), SafeOperational) << "nobody has said anything yet";
}

TEST_F(CommandedMembersTest, DownwardsCountsWhenItIsSentAndVoidsWhatWasOnItsWayUp) {
  up();
  state(SafeOperational);
  const auto rising = leaves(8, 1, call_data("SET_STATE", static_cast<int>(Operational)));
  commanded.all_stopped();
  verify(arm, rising, 7);
  EXPECT_EQ(commanded.of(arm).state(), SafeOperational);
  leaves(8, 1, call_data("SET_STATE", static_cast<int>(PreOperational)));
  EXPECT_EQ(commanded.of(arm).state(), PreOperational);
}

TEST_F(CommandedMembersTest, APlanLowersAtOnceButForTheDeathThatItAnswers) {
  up();
  commanded.lower(arm, SafeOperational, "PROCESS_DIED");
  EXPECT_EQ(commanded.of(arm).state(), Operational);
  commanded.lower(arm, SafeOperational, "TOO_HOT");
  EXPECT_EQ(commanded.of(arm).state(), SafeOperational);
  commanded.lower(arm, ErrorOperational, "TOO_HOT");
  EXPECT_EQ(commanded.of(arm).state(), PreOperational);
  commanded.lower(arm, Operational, "TOO_HOT");
  EXPECT_EQ(commanded.of(arm).state(), PreOperational);
}

TEST_F(CommandedMembersTest, AStaleLinkIsTheBeginningOfItsPartnersDeathForASecond) {
  up();
  commanded.lower(arm, SafeOperational, "HAND_STATE_STALE");
  wait(CommandedMembers::loss_before_death);
  commanded.lower(arm, SafeOperational, "OTHER_STALE");
  EXPECT_EQ(commanded.of_partner(arm).state(), Operational);
  EXPECT_EQ(commanded.of(arm).state(), SafeOperational);
  wait(1ms);
  EXPECT_EQ(commanded.of_partner(arm).state(), SafeOperational);
}

TEST_F(CommandedMembersTest, AValueIsSetAgainInTheFirstStateThatIsNotOperationalInWhichItMayBe) {
  up();
  done(20, 3, octets(std::uint8_t{3}, id(1), std::uint16_t{7}, id(2), std::uint16_t{8}, id(3), std::uint16_t{9}));
  done(20, 3, octets(one, id(1), std::uint16_t{10}));
  EXPECT_THAT(settings(), ElementsAre(fmt::format("20,3: 1 {:x} {:x} {:x} {:x} 0 a", id(1) >> 24, id(1) >> 16 & 255,
                                                  id(1) >> 8 & 255, id(1) & 255)));
  EXPECT_THAT(settings(SafeOperational), ElementsAre(::testing::EndsWith(" 0 8")));
  EXPECT_THAT(commanded.of(arm).out_of_reach(craft.member(arm)->descriptor()), ElementsAre("P3"));
  state(PreOperational);
  EXPECT_EQ(settings().size(), 1U) << "values outlive the configuration";
  state(Offline);
  EXPECT_THAT(settings(), IsEmpty());
}

TEST_F(CommandedMembersTest, WhatAConfigurationSetsItselfIsNotOurs) {
  auto& subsystem = craft.mission.subsystems.front().subsystem;
  subsystem.configurations.front().initial.push_back(
      {.parameter = *descriptor::find_parameter(subsystem, id(1)), .values = {}});
  state(PreOperational);
  done(20, 3, octets(one, id(1), std::uint16_t{7}));
  configure(2);
  EXPECT_THAT(settings(), IsEmpty());
}

TEST_F(CommandedMembersTest, WhatAFunctionHasSetIsKnown) {
  up();
  EXPECT_THAT(not_repeated(), IsEmpty());
  done(8, 1, call_data("SET_LIMIT"));
  EXPECT_THAT(not_repeated(), ElementsAre("P4"));
  state(Offline);
  EXPECT_THAT(not_repeated(), IsEmpty());
}

/// Safe is to take for set what may be: each end that such a telecommand has, and none.
TEST_F(CommandedMembersTest, WhatAFunctionMayHaveSetCountsUnlessItWasRefused) {
  parts.own.start(craft.mode_epoch);
  own_step();
  up();
  for (const std::uint8_t refused : {std::uint8_t{2}, std::uint8_t{4}}) {
    verify(arm, leaves(8, 1, call_data("SET_LIMIT")), refused, pus::FailureCode::NotPermittedNow);
    EXPECT_THAT(not_repeated(), IsEmpty()) << int{refused};
  }
  const auto under_way = leaves(8, 1, call_data("SET_LIMIT"));
  EXPECT_THAT(not_repeated(), ElementsAre("P4")) << "who dies now has perhaps done it";
  EXPECT_THAT(commanded.of_partner(arm).unrepeated_names(craft.member(arm)->descriptor()), ElementsAre("P4"));
  verify(arm, under_way, 4, pus::FailureCode::NotPermittedNow);
  EXPECT_THAT(not_repeated(), IsEmpty());
  verify(arm, leaves(8, 1, call_data("SET_LIMIT")), 8, pus::FailureCode::Aborted);
  EXPECT_THAT(not_repeated(), ElementsAre("P4")) << "it was begun";
  state(Offline);
  EXPECT_THAT(not_repeated(), IsEmpty());
  leaves(8, 1, call_data("SET_LIMIT"), 0);
  EXPECT_THAT(not_repeated(), ElementsAre("P4")) << "nobody will say whether it was done";
}

TEST_F(CommandedMembersTest, WhatWasSetSinceALinkWentStaleIsLostLikeWhatWasSetBefore) {
  up();
  commanded.lower(arm, SafeOperational, "HAND_STATE_STALE");
  done(8, 1, call_data("SET_LIMIT"));
  const auto before = commanded.of_partner(arm);
  EXPECT_EQ(before.state(), Operational);
  EXPECT_THAT(before.unrepeated_names(craft.member(arm)->descriptor()), ElementsAre("P4"));
}

TEST_F(CommandedMembersTest, StructuresComeBackAsTheyWereWithTheConfigurationThatTheyBelongTo) {
  up();
  done(3, 6, octets(one, declared));
  done(3, 31, octets(one, declared, std::uint32_t{20}));
  done(3, 29, octets(declared, one, id(1), std::uint8_t{0}));
  done(3, 5, octets(one, declared));
  done(3, 1, octets(std::uint16_t{7}, std::uint32_t{40}, one, id(2), std::uint8_t{0}));
  done(3, 1, octets(std::uint16_t{8}, std::uint32_t{40}, one, id(2), std::uint8_t{0}));
  done(3, 3, octets(one, std::uint16_t{8}));
  const auto names = [this] {
    std::vector<std::string> all;
    for (const auto& each : settings()) all.push_back(each.substr(0, each.find(':')));
    return all;
  };
  EXPECT_THAT(names(), ElementsAre("3,6", "3,31", "3,29", "3,5", "3,1"));
  configure(2);
  EXPECT_EQ(names().size(), 5U) << "it was in force: nothing has happened";
  state(PreOperational);
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(CommandedMembersTest, SwitchesOfEventsLastAsLongAsTheProcess) {
  up();
  done(5, 6, octets(std::uint8_t{2}, std::uint16_t{4}, std::uint16_t{5}));
  done(5, 5, octets(one, std::uint16_t{4}));
  EXPECT_THAT(settings(), ElementsAre("5,6: 1 0 5"));
  state(Offline);
  EXPECT_THAT(settings(), ElementsAre("5,6: 1 0 5"));
  commanded.ended(arm);
  EXPECT_THAT(settings(), IsEmpty());
}

TEST_F(CommandedMembersTest, WhatHasNoRoomIsTold) {
  parts.own.start(craft.mode_epoch);
  own_step();
  up();
  std::vector<std::byte> wide(900);
  for (std::uint16_t structure = 1; structure < 40; ++structure) {
    OctetWriter writer{wide};
    writer.put(structure).put(std::uint32_t{40});
    done(3, 1, wide);
  }
  own_step();
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=10 SERVICE=3 SUBTYPE=1"));
  std::size_t kept = 0;
  for (const SettingCommand& each : commanded.of(arm).settings_for(PreOperational, craft.member(arm)->descriptor()))
    kept += each.data.size();
  EXPECT_EQ(kept, CommandedState::most_definition_octets / 900 * 900);
}

TEST_F(CommandedMembersTest, WhatNobodyReportsOnIsTold) {
  parts.own.start(craft.mode_epoch);
  own_step();
  leaves(5, 6, octets(one, std::uint16_t{4}), 0);
  own_step();
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=10 SERVICE=5 SUBTYPE=6"));
  story.clear();
  for (std::size_t i = 0; i <= CommandedMembers::most_open; ++i) leaves(5, 6, octets(one, std::uint16_t{4}));
  own_step();
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT"));
}

TEST_F(CommandedMembersTest, WhatNobodyReportsOnFillsNoJournal) {
  parts.own.start(craft.mode_epoch);
  own_step();
  std::vector<std::byte> wide(3000);
  wide[2] = std::byte{one};
  for (std::size_t i = 0; i < CommandedMembers::most_open_octets / wide.size() - 1; ++i) leaves(3, 1, wide);
  own_step();
  EXPECT_FALSE(was_told("COMMAND_NOT_KEPT"));
  for (int i = 0; i < 3; ++i) leaves(3, 1, wide);
  own_step();
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=10 SERVICE=3 SUBTYPE=1"));
  std::vector<std::byte> room(2 * CommandedMembers::most_open_octets);
  OctetWriter writer{room};
  commanded.note(writer);
  EXPECT_LT(writer.size(), CommandedMembers::most_open_octets + 8192);
}

TEST_F(CommandedMembersTest, WhatIsDoneInPartEndsWithItsCompletionOnly) {
  parts.own.start(craft.mode_epoch);
  own_step();
  const auto two = octets(std::uint8_t{2}, std::uint16_t{4}, std::uint16_t{5});
  const auto in_part = leaves(5, 6, two);
  verify(arm, in_part, 4);
  own_step();
  EXPECT_FALSE(was_told("COMMAND_NOT_KEPT"));
  verify(arm, in_part, 8, pus::FailureCode::ExecutedInPart);
  own_step();
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT"));
  EXPECT_THAT(settings(), IsEmpty());
}

TEST_F(CommandedMembersTest, AMissionThatBringsNobodyBackKeepsNothing) {
  craft.mission.plans.back().steps.front().values.back() = 0;
  EXPECT_FALSE(commanded.in_use());
  up();
  EXPECT_EQ(commanded.of(arm).state(), Offline);
}

}  // namespace
}  // namespace hirosco::supervisor
