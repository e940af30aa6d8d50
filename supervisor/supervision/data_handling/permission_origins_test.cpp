// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "hirosco/descriptor/model/supervisor_functions.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// Who asks: what a permit says that names senders, and what a subsystem may ask the supervisor for (docs/adr/0216). CAMERA's descriptor
/// declares MOVE_TO of HAND, and of the supervisor all that it has; ARM's declares nothing.
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using descriptor::Thing;
using testing::arm;
using testing::camera;
using testing::hand;

struct PermissionOrigins : ::testing::Test {
  static constexpr const char* not_declared = "18";
  static constexpr const char* not_in_mode = "13 1";
  static constexpr std::uint16_t structure = 4701, alarming = 9, harmless = 10;
  const Origin by_ground = Origin::ground(), by_camera = Origin::subsystem(camera), by_arm = Origin::subsystem(arm);
  descriptor::Mission mission = testing::small_mission();
  State state{State::Operational};

  void SetUp() override {
    auto& own = mission.supervisor;
    for (const char* name :
         {"ENTER_MODE", "LINK", "UNLINK", "SET_POWER_BUDGET", "REPLACE", "CONFIRM", "TAKE_BACK", "REREAD"})
      own.functions.push_back(testing::function(name, testing::in_states({State::Operational})));
    for (const char* name : {"SET_DATABASE", "SHUTDOWN"})
      own.functions.push_back(testing::function(name, testing::in_states({State::Operational}), true));
    descriptor::Event event;
    event.name = "HARMLESS";
    event.id = harmless;
    own.events = {event};
    event.name = "ALARMING";
    event.id = alarming;
    event.safety = true;
    own.events.push_back(event);
    descriptor::Commands of_hand{.subsystem = "HAND", .functions = {"MOVE_TO"}, .at = {}, .apid = hand};
    descriptor::Commands of_supervisor{.subsystem = "SUPERVISOR", .functions = {}, .at = {}, .apid = supervisor_apid};
    for (const auto& function : own.functions) of_supervisor.functions.push_back(function.name);
    using enum Thing::Kind;
    of_supervisor.things = {
        {Housekeeping, "4701", structure, {}}, {Event, "ALARMING", alarming, {}}, {Event, "HARMLESS", harmless, {}}};
    mission.subsystems[2].subsystem.commands = {of_hand, of_supervisor};
  }
  /// The mode permits this and nothing else.
  void permit(descriptor::Permit permit) { mission.modes[0].permits = {std::move(permit)}; }
  void permit(std::string whom, std::vector<std::string> functions, std::vector<std::string> from) {
    permit({.subsystem = std::move(whom),
            .functions = std::move(functions),
            .services = {},
            .parameters = {},
            .at = {},
            .from = std::move(from)});
  }
  [[nodiscard]] std::string decided(const Origin& origin, std::uint16_t to, std::uint8_t service, std::uint8_t subtype,
                                    Octets data, bool changing = false) const {
    const LinkGraph links{mission};
    const auto packet = testing::telecommand(to, service, subtype, data);
    Situation situation{.mission = mission, .mode = mission.modes[0], .links = links, .state = state};
    situation.changing = changing;
    const auto decision = decide(pus::TelecommandView::parse(packet).value(), origin, situation);
    if (decision) return decision->essential ? "essential" : "ok";
    std::string text = std::to_string(static_cast<int>(decision.error().code()));
    if (const auto reason = pus::reason_in(decision.error().data())) return text.append(": ").append(reason->text);
    for (const std::byte octet : decision.error().data())
      text.append(1, ' ').append(std::to_string(std::to_integer<int>(octet)));
    return text;
  }
  [[nodiscard]] std::string calls(const Origin& origin, std::uint16_t to, const char* function) const {
    return decided(origin, to, 8, 1, testing::call_data(function));
  }
};

TEST_F(PermissionOrigins, ARowIsForThoseThatItNamesAndOneThatNamesNobodyForAllWhoMayAsk) {
  struct Row {
    std::vector<std::string> from;
    const char *ground, *camera;
  };
  for (const auto& [from, ground, of_camera] :
       {Row{{}, "ok", "ok"}, Row{{"ground"}, "ok", not_in_mode}, Row{{"CAMERA"}, not_in_mode, "ok"},
        Row{{"ground", "CAMERA"}, "ok", "ok"}, Row{{"ARM"}, not_in_mode, not_in_mode}})
    for (const char* whom : {"HAND", "*"})
      for (const char* function : {"MOVE_TO", "*"}) {
        permit(whom, {function}, from);
        SCOPED_TRACE(::testing::PrintToString(from) + " " + whom + " " + function);
        EXPECT_EQ(calls(by_ground, hand, "MOVE_TO"), ground);
        EXPECT_EQ(calls(by_camera, hand, "MOVE_TO"), of_camera);
        EXPECT_EQ(calls(by_arm, hand, "MOVE_TO"), not_declared) << "who is named asks for what its descriptor says";
        EXPECT_EQ(calls(Origin::supervisor(), hand, "MOVE_TO"), "ok") << "it is bound to no mode";
      }
}

TEST_F(PermissionOrigins, ServicesAndParametersAreOpenedForThoseThatAreNamedToo) {
  descriptor::Parameter gain;
  gain.field.name = "GAIN";
  gain.id = 3;
  gain.writable_states = testing::in_states({State::Operational});
  mission.subsystems[1].subsystem.parameters = {gain};
  std::vector<std::byte> value(5 + gain.octets());
  const std::uint32_t id = ParameterId{hand, gain.field.type, gain.id}.wire();
  OctetWriter{value}.put(std::uint8_t{1}).put(id);
  std::vector<std::byte> asked(5);
  OctetWriter{asked}.put(std::uint8_t{1}).put(id);
  mission.subsystems[2].subsystem.commands[0].things = {{Thing::Kind::Set, "GAIN", id, {gain.field}},
                                                        {Thing::Kind::Read, "GAIN", id, {gain.field}}};
  for (const char* named : {"ground", "CAMERA"}) {
    permit({.subsystem = "HAND", .functions = {}, .services = {20}, .parameters = {"GAIN"}, .at = {}, .from = {named}});
    const bool of_ground = std::string_view{named} == "ground";
    EXPECT_EQ(decided(by_ground, hand, 20, 3, value) == "ok", of_ground);
    EXPECT_EQ(decided(by_camera, hand, 20, 3, value) == "ok", !of_ground);
    EXPECT_EQ(decided(by_ground, hand, 20, 1, asked) == "ok", of_ground);
    EXPECT_EQ(decided(by_camera, hand, 20, 1, asked) == "ok", !of_ground);
  }
}

TEST_F(PermissionOrigins, OfTheSupervisorARowThatNamesNobodyOpensNothingForASubsystem) {
  permit("*", {"*"}, {});
  for (const char* mode : {"SET_MODE", "ENTER_MODE"}) {
    EXPECT_EQ(calls(by_ground, supervisor_apid, mode), "ok");
    EXPECT_EQ(calls(by_camera, supervisor_apid, mode), not_in_mode);
  }
  permit("SUPERVISOR", {"SET_MODE"}, {"CAMERA"});
  EXPECT_EQ(calls(by_camera, supervisor_apid, "SET_MODE"), "ok");
  EXPECT_EQ(calls(by_camera, supervisor_apid, "ENTER_MODE"), not_in_mode) << "function by function";
  EXPECT_EQ(calls(by_ground, supervisor_apid, "SET_MODE"), not_in_mode) << "it names another one";
  EXPECT_EQ(calls(by_arm, supervisor_apid, "SET_MODE"), not_declared);
  state = State::SafeOperational;
  EXPECT_EQ(calls(by_camera, supervisor_apid, "SET_MODE"), "10 4") << "the state binds it, too";
  state = State::Operational;
  EXPECT_EQ(decided(by_camera, supervisor_apid, 8, 1, testing::call_data("SET_MODE"), true).substr(0, 4), "263:")
      << "it crosses no change of mode";
}

/// Whatever descriptor and mission say, and in every state: no subsystem ends the flight, changes programs or links, or gives more power.
TEST_F(PermissionOrigins, WhatLiftsOrReplacesWhatSafetyRestsOnIsTheGroundsAlone) {
  const std::string why = "263: of the supervisor the ground alone may ask for that";
  for (const auto& from : {std::vector<std::string>{}, {"CAMERA"}, {"ground", "CAMERA"}})
    for (int number = 0; number < 10; ++number) {
      state = static_cast<State>(number);
      permit("*", {"*"}, from);
      for (const auto& function : mission.supervisor.functions) {
        if (descriptor::is_for_subsystems(function.name)) continue;
        EXPECT_EQ(calls(by_camera, supervisor_apid, function.name.c_str()), why) << function.name << " " << number;
      }
      EXPECT_EQ(calls(by_camera, supervisor_apid, "SAFE_ALL"), "essential") << number;
      for (const char* steers : {"SET_STATE", "CONFIGURE"})
        EXPECT_EQ(calls(by_camera, supervisor_apid, steers), not_in_mode) << steers << " " << number;
    }
  EXPECT_EQ(descriptor::functions_for_subsystems.size(), 3U) << "one more is to be thought of here";
}

TEST_F(PermissionOrigins, WhatADescriptorCallsEssentialIsBoundToTheModeForASubsystem) {
  for (auto& function : mission.supervisor.functions) function.essential = true;
  permit("SUPERVISOR", {"SAFE_ALL"}, {"CAMERA"});
  EXPECT_EQ(calls(by_camera, supervisor_apid, "SET_MODE"), not_in_mode);
  EXPECT_EQ(calls(by_ground, supervisor_apid, "SET_MODE"), "essential");
  permit("SUPERVISOR", {"SET_MODE"}, {"CAMERA"});
  EXPECT_EQ(calls(by_camera, supervisor_apid, "SET_MODE"), "ok") << "and waits for the disk";
}

TEST_F(PermissionOrigins, ReportsOfTheSupervisorAreSwitchedByWhoIsNamedAndThoseOfLossesByNobody) {
  const auto about = [](std::uint16_t id) {
    std::vector<std::byte> data(3);
    OctetWriter{data}.put(std::uint8_t{1}).put(id);
    return data;
  };
  for (const bool named : {false, true}) {
    permit({.subsystem = "*", .functions = {}, .services = {3, 5}, .parameters = {}, .at = {}});
    if (named) mission.modes[0].permits[0].from = {"CAMERA"};
    const char* outcome = named ? "ok" : not_in_mode;
    EXPECT_EQ(decided(by_camera, supervisor_apid, 3, 27, about(structure)), outcome);
    EXPECT_EQ(decided(by_camera, supervisor_apid, 3, 27, about(structure + 1)), not_declared);
    EXPECT_EQ(decided(by_camera, supervisor_apid, 5, 6, about(harmless)), outcome);
    EXPECT_EQ(decided(by_camera, supervisor_apid, 5, 5, about(alarming)), outcome) << "on it may be switched";
    EXPECT_EQ(decided(by_camera, supervisor_apid, 5, 6, about(alarming)).substr(0, 3), "263") << named;
  }
}

/// What cannot be read to its end, or says more than its count, names something that nobody has compared.
TEST_F(PermissionOrigins, WhatIsNamedOutsideOfWhatADescriptorDeclaresOrNotNamedInFullIsNotDeclared) {
  constexpr std::uint16_t zero = 0;  // what a reader gives for what is not there
  mission.subsystems[2].subsystem.commands[1].things.push_back({Thing::Kind::Event, "ZERO", zero, {}});
  permit({.subsystem = "*", .functions = {}, .services = {5}, .parameters = {}, .at = {}, .from = {"CAMERA"}});
  const auto switches_on = [&](std::uint8_t count, std::initializer_list<std::uint16_t> ids, std::size_t trailing = 0) {
    std::vector<std::byte> data(1 + 2 * ids.size() + trailing);
    OctetWriter writer{data};
    writer.put(count);
    for (const std::uint16_t id : ids) writer.put(id);
    return decided(by_camera, supervisor_apid, 5, 5, data);
  };
  EXPECT_EQ(switches_on(2, {harmless, zero}), "ok");
  EXPECT_EQ(switches_on(2, {harmless, structure}), not_declared) << "each of them";
  EXPECT_EQ(switches_on(2, {harmless}), not_declared) << "the second is not there";
  EXPECT_EQ(switches_on(2, {harmless}, 1), not_declared) << "or half of it";
  EXPECT_EQ(switches_on(1, {harmless}, 1), not_declared) << "more than it counts";
  EXPECT_EQ(switches_on(0, {}), not_declared) << "nothing at all";
}

TEST_F(PermissionOrigins, OfAListOfReportsThatIsCutShortWhatIsThereIsLookedAtAndNothingElse) {
  permit({.subsystem = "*", .functions = {}, .services = {5}, .parameters = {}, .at = {}});
  const auto switches_off = [&](std::uint8_t count, std::initializer_list<std::uint16_t> ids) {
    std::vector<std::byte> data(1 + 2 * ids.size());
    OctetWriter writer{data};
    writer.put(count);
    for (const std::uint16_t id : ids) writer.put(id);
    return decided(by_ground, supervisor_apid, 5, 6, data).substr(0, 3);
  };
  descriptor::Event zero = mission.supervisor.events.back();
  zero.name = "ZERO";
  zero.id = 0;
  mission.supervisor.events.push_back(zero);
  EXPECT_EQ(switches_off(1, {0}), "263");
  EXPECT_EQ(switches_off(3, {harmless}), "ok") << "its addressee says what is missing: it names no report of safety";
  EXPECT_EQ(switches_off(3, {harmless, alarming}), "263");
}

TEST_F(PermissionOrigins, WhoMayNotAskHearsThatWhateverItIsAbout) {
  permit({.subsystem = "*", .functions = {}, .services = {5}, .parameters = {}, .at = {}, .from = {"ARM", "CAMERA"}});
  std::array<std::byte, 3> data{};
  OctetWriter{data}.put(std::uint8_t{1}).put(alarming);
  EXPECT_EQ(decided(by_camera, supervisor_apid, 5, 6, data).substr(0, 3), "263") << "a report of safety";
  EXPECT_EQ(decided(by_arm, supervisor_apid, 5, 6, data), not_declared) << "what it may not name it learns nothing of";
}

}  // namespace
}  // namespace hirosco::supervisor
