// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/permission.hpp"

#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "supervisor/supervision/event_handling/planned_reactions.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// What safety rests on is changed by no telecommand (docs/adr/0091).
namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

struct SafetyMarks : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    descriptor::Plan plan;
    plan.name = "died";
    plan.event = "PROCESS_DIED";
    plan.steps = {{"shut_down_network"}};
    craft.mission.plans.push_back(plan);
    plan.name = "severe";
    plan.event = {};
    plan.severities = {Severity::High};
    craft.mission.plans.push_back(plan);
    start_all(SafeOperational);
    start_supervisor();
  }
  /// Everything that plans would do, in words.
  [[nodiscard]] std::string plans() const {
    std::string all;
    for (const PlannedReaction& each : planned_reactions(craft.mission)) {
      all += each.subsystem + " " + each.event + " " + each.plan + " " + std::to_string(each.priority) + ": " +
             each.steps + " in";
      for (const std::string& mode : each.modes) all += " " + mode;
      all += "\n";
    }
    for (const PlannedPreemption& each : planned_preemptions(craft.mission)) all += each.subsystem + each.plan + "\n";
    return all;
  }
  void take(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data) {
    parts.telecommands.take({.packet = telecommand(apid, service, subtype, data), .origin = Origin::ground()});
    for (int step = 0; step < 3; ++step) own_step();
    for (const std::uint16_t member : {arm, hand, camera}) static_cast<void>(received(member));
  }
  /// A call with arguments of its descriptor's types, each of this value; nothing: it is none that a function takes.
  [[nodiscard]] static std::optional<std::vector<std::byte>> whole_call(const descriptor::Function& function,
                                                                        double value) {
    std::vector<std::optional<Value>> given;
    for (const auto& argument : function.arguments)
      given.emplace_back(argument.field.type == Type::Text ? Value{std::string{"2"}} : Value{Number{value}});
    const auto data = pus::encode_call(function, pus::GivenValues{given});
    return data ? std::optional{*data} : std::nullopt;
  }
  /// Every request of every service to the supervisor and ARM, every function of the supervisor but these; how many. Functions that change
  /// the mode come last, each other one in the mode that permits all.
  int ask_everything(std::initializer_list<std::string_view> but) {
    int asked = 0;
    const std::vector<std::byte> words[] = {{},
                                            std::vector<std::byte>(1, std::byte{1}),
                                            std::vector<std::byte>(5, std::byte{1}),
                                            std::vector<std::byte>(17, std::byte{1})};
    for (const std::uint16_t apid : {supervisor_apid, arm})
      for (const pus::ServiceKind* service : pus::standard_services())
        for (const pus::RequestKind& request : service->requests)
          for (const auto& data : words) {
            take(apid, service->type, request.subtype, data);
            ++asked;
          }
    auto functions = craft.mission.supervisor.functions;
    std::ranges::stable_partition(functions, [](const auto& each) { return !each.name.ends_with("_MODE"); });
    for (const descriptor::Function& function : functions) {
      if (std::ranges::find(but, function.name) != but.end()) continue;
      int whole = 0;
      for (const double value : {1.0, 2.0, static_cast<double>(arm), static_cast<double>(hand), 255.0})
        if (const auto data = whole_call(function, value)) {
          take(supervisor_apid, 8, 1, *data);
          ++whole;
        }
      EXPECT_GT(whole, 0) << function.name;
      for (const int argument : {-1, 0, 255}) take(supervisor_apid, 8, 1, call_data(function.name, argument));
      asked += whole + 3;
    }
    return asked;
  }
};

TEST_F(SafetyMarks, NoRequestOfAnyServiceOrFunctionChangesWhatAnyEventWouldDo) {
  const std::string before = plans();
  ASSERT_FALSE(before.empty());
  EXPECT_GT(ask_everything({"SHUTDOWN"}), 100);
  EXPECT_EQ(plans(), before);
  take(supervisor_apid, 8, 1, call_data("SHUTDOWN"));
  EXPECT_EQ(plans(), before);
}

/// SAFE_ALL and SHUTDOWN are stops themselves, and a power budget below what is reserved an event of severity high, whose plan goes before as
/// any does: what becomes of a plan beside them, their own tests say.
TEST_F(SafetyMarks, NoRequestEndsAPlanThatIsUnderWayOrTakesItsNextStepFromIt) {
  descriptor::Event hot;
  hot.name = "HOT";
  hot.id = 2000;
  hot.severity = Severity::Medium;
  craft.mission.subsystems.front().subsystem.events.push_back(hot);
  descriptor::Plan plan;
  plan.name = "two steps";
  plan.event = hot.name;
  for (const State state : {ErrorOperational, PostOperational})
    plan.steps.push_back({"set_state", {static_cast<std::int64_t>(state)}});
  craft.mission.plans.push_back(plan);
  set(arm, Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  event(arm, hot.id, hot.severity);
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  ASSERT_EQ(begun[0].text, to(ErrorOperational));
  EXPECT_GT(ask_everything({"SAFE_ALL", "SHUTDOWN", "SET_POWER_BUDGET"}), 100);
  for (int state = 0; state < 10; ++state) take(arm, 8, 1, call_data("SET_STATE", state));
  EXPECT_TRUE(craft.member(arm)->recovery.running());
  EXPECT_FALSE(was_told("gives way"));
  set(arm, ErrorOperational);
  verify(arm, begun[0].request, 7);
  EXPECT_THAT(texts(arm), ::testing::ElementsAre(to(PostOperational)));
}

TEST_F(SafetyMarks, NoProtectionIsWritableByTelecommand) {
  descriptor::Parameter limit;
  limit.field.name = "LIMIT";
  limit.id = 9;
  limit.protection = true;
  craft.mission.subsystems[0].subsystem.parameters.push_back(limit);
  craft.mission.modes.front().permits.front().parameters = {"*"};
  std::vector<std::byte> data(1 + 4 + 8);
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{arm, Type::Double, 9}.wire()).put(1.0);
  for (int state = 0; state < 10; ++state) {
    set(arm, static_cast<State>(state));
    parts.telecommands.take({.packet = telecommand(arm, 20, 3, data), .origin = Origin::ground()});
    parts.telecommands.forward_durable();
    EXPECT_TRUE(received(arm).empty()) << state;
  }
}

/// Of ARM: 1 is an event that safety rests on, 2 another one; of the supervisor: what it tells of members is such an event by itself.
TEST(SafetyMark, NobodySwitchesOffWhatSafetyRestsOnInWhateverModeAndState) {
  auto mission = small_mission();
  const auto event = [](const char* name, std::uint16_t id, bool safety) {
    descriptor::Event made;
    made.name = name;
    made.id = id;
    made.safety = safety;
    return made;
  };
  mission.subsystems[0].subsystem.events = {event("A", 1, true), event("B", 2, false), event("PROCESS_DIED", 3, false)};
  mission.supervisor.events = {event("PROCESS_DIED", 101, false), event("LOG_STORE", 103, false)};
  const LinkGraph links{mission};
  const auto ask = [&](std::uint16_t apid, std::uint8_t subtype, std::initializer_list<std::uint16_t> ids,
                       const Origin& origin, const descriptor::Mode& mode, State state) {
    std::vector<std::byte> data(1 + 2 * ids.size());
    OctetWriter writer{data};
    writer.put(static_cast<std::uint8_t>(ids.size()));
    for (const std::uint16_t id : ids) writer.put(id);
    const auto packet = telecommand(apid, 5, subtype, data);
    const auto decision = decide(pus::TelecommandView::parse(packet).value(), origin, {mission, mode, links, state, 0});
    std::string text = decision ? "ok" : std::string{to_text(decision.error().code())};
    if (!decision)
      for (const std::byte octet : decision.error().data())
        text.append(1, ' ').append(std::to_string(std::to_integer<int>(octet)));
    return text;
  };
  const std::string not_now{to_text(pus::FailureCode::NotPermittedNow)};
  for (const Origin& origin : {Origin::ground(), Origin::supervisor()})
    for (const auto& mode : mission.modes)
      for (int number = 0; number < 10; ++number) {
        const auto state = static_cast<State>(number);
        EXPECT_EQ(ask(arm, 6, {1}, origin, mode, state), not_now + " 0 0 0 0 1");
        EXPECT_EQ(ask(arm, 6, {2, 99, 1}, origin, mode, state), not_now + " 2 0 0 0 1") << "not even among others";
        EXPECT_EQ(ask(1, 6, {101}, origin, mode, state), not_now + " 0 0 0 0 101") << "whatever its descriptor says";
      }
  const auto& open = mission.modes.front();
  EXPECT_EQ(ask(arm, 6, {2, 3}, Origin::ground(), open, Operational), "ok");
  EXPECT_EQ(ask(arm, 5, {1}, Origin::ground(), open, Operational), "ok") << "on may be what is never off";
  EXPECT_EQ(ask(1, 6, {103}, Origin::ground(), open, Operational), "ok");
}

}  // namespace
}  // namespace hirosco::supervisor
