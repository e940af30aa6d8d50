// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/resource_management/power_handling.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// Electrical power and the plans that run: what one was granted nobody else has, it is given back whatever way the plan ends, and what
/// SET_POWER_BUDGET and the step `power` do meanwhile.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;

constexpr std::uint16_t spare = 13, event_broken = 2000, event_hot = 2001;
constexpr double giver_w = 10, receiver_w = 20, bright_w = 30;
/// Those who act, the supervisor and one of the receivers; two of them are too many.
constexpr double for_one_w = 60;

/// ARM's task goes to CAMERA, HAND's to SPARE. Nobody is joined by a link, and nobody is the ground link.
descriptor::Mission with_spares() {
  descriptor::Mission made = parts_mission();
  made.ground.subsystem.clear();
  made.links.clear();
  descriptor::MissionSubsystem fourth = made.subsystems.back();
  fourth.subsystem.name = "SPARE";
  fourth.subsystem.id = spare;
  made.subsystems.push_back(fourth);
  for (descriptor::MissionSubsystem& member : made.subsystems) {
    descriptor::Configuration only, bright;
    only.name = "ONLY";
    only.id = 1;
    only.sampling = 10ms;
    only.budget = 1ms;
    only.power_w = member.subsystem.id == camera || member.subsystem.id == spare ? receiver_w : giver_w;
    bright = only;
    bright.name = "BRIGHT";
    bright.id = 2;
    bright.power_w = bright_w;
    member.subsystem.configurations = {only, bright};
    member.subsystem.bumpless = {{.configurations = {1, 2}, .steps = {}}};
    for (const auto& [name, id] : {std::pair{"BROKEN", event_broken}, std::pair{"HOT", event_hot}}) {
      descriptor::Event event;
      event.name = name;
      event.id = id;
      event.severity = Severity::Low;
      member.subsystem.events.push_back(event);
    }
  }
  return made;
}

struct PowerOfPlans : PartsTest {
  PowerOfPlans() : PartsTest{with_spares()} {}
  void SetUp() override {
    PartsTest::SetUp();
    log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand, camera, spare}) {
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
      craft.member(apid)->fences_when_free = guard.fences(apid);
    }
    for (const std::uint16_t apid : {camera, spare}) set(apid, Offline);
    start_its_supervisor();
    plan("to camera", "ARM", "BROKEN", {hand_over(camera, "CAMERA")});
    plan("to spare", "HAND", "BROKEN", {hand_over(spare, "SPARE")});
    set_budget(for_one_w);
  }
  virtual void start_its_supervisor() { start_supervisor(); }
  void plan(std::string name, std::string whose, std::string event, std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = std::move(name);
    made.subsystem = std::move(whose);
    made.event = std::move(event);
    made.steps = std::move(steps);
    craft.mission.plans.push_back(std::move(made));
  }
  static descriptor::PlanStep hand_over(std::uint16_t to, std::string name) {
    return {"hand_over", {to, 1}, {}, {std::move(name), "ONLY"}};
  }
  static descriptor::PlanStep power(std::int64_t budget_w) { return {"power", {budget_w}}; }
  void happens(std::uint16_t id, std::uint16_t to) { event(to, id, Severity::Low); }
  /// It does what it is told.
  void carry_out(std::uint16_t apid, const Received& told) {
    constexpr std::string_view to_state = "SET_STATE ", configure = "CONFIGURE ";
    if (told.text.starts_with(to_state))
      set(apid, static_cast<State>(std::stoi(told.text.substr(to_state.size()))), craft.member(apid)->configuration());
    if (told.text.starts_with(configure))
      played[apid].vital->configuration = static_cast<std::uint8_t>(std::stoi(told.text.substr(configure.size())));
    verify(apid, told.request, 7);
  }
  /// The next that it was told, and nothing else.
  Received next(std::uint16_t apid) {
    const auto all = received(apid);
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? Received{} : all.front();
  }
  /// Its plan begins: it stops, and CAMERA, or SPARE, is on its way up, Pre-Operational and about to be told to go further.
  Received breaks(std::uint16_t giver, std::uint16_t receiver) {
    happens(event_broken, giver);
    carry_out(giver, next(giver));
    carry_out(receiver, next(receiver));
    return next(receiver);
  }
  /// ARM's plan runs; CAMERA has been told to go to Safe-Operational, with the power for that, and has not said anything.
  Received at_the_door() {
    carry_out(camera, breaks(arm, camera));
    const Received told = next(camera);
    EXPECT_EQ(told.text, to(SafeOperational));
    EXPECT_EQ(held_w(camera), receiver_w);
    return told;
  }
  void everybody_obeys() {
    for (int turn = 0; turn < 60; ++turn) {
      for (const std::uint16_t apid : {arm, hand, camera, spare})
        if (craft.member(apid)->alive())
          for (const Received& each : received(apid)) carry_out(apid, each);
      some_time();
    }
  }
  /// What the supervisor does in each of its steps.
  void some_time() {
    parts.own.beat(parts.own.beats() + 1);
    own_step();
    parts.power.watch(clock.now());
  }
  [[nodiscard]] double held_w(std::uint16_t apid) { return parts.power.ledger().held_mw(apid) * 1e-3; }
  void set_budget(double budget_w) { parts.power.ledger().set_budget(budget_w); }
  [[nodiscard]] bool is_granted(std::uint16_t apid, double demand_w) {
    parts.power.watch(clock.now());
    return !parts.power.ledger().shortage(apid, demand_w);
  }
  /// Nothing of it is left, and SPARE would be granted what it needs.
  void expect_given_back() {
    some_time();
    EXPECT_EQ(held_w(camera), 0);
    EXPECT_TRUE(is_granted(spare, receiver_w));
  }
  std::shared_ptr<HeldDatabase::Hold> hold = std::make_shared<HeldDatabase::Hold>();
};

TEST_F(PowerOfPlans, WhatOneThatRunsWasGrantedIsRefusedToAnotherWhichEndsByThat) {
  const Received granted = at_the_door();
  EXPECT_FALSE(is_granted(spare, receiver_w));
  carry_out(spare, breaks(hand, spare));
  EXPECT_THAT(texts(spare), IsEmpty()) << "it is not told to go where its power is not";
  EXPECT_TRUE(was_told("power short: SPARE asks for 20 W, 52 W of 60 W are reserved"));
  some_time();
  EXPECT_TRUE(was_told("nobody takes over the task of HAND: SPARE SafeOperational: power"));
  EXPECT_TRUE(was_told("plan failed"));
  EXPECT_TRUE(craft.member(hand)->recovery.going_down()) << "it escalates";
  EXPECT_EQ(held_w(spare), 0);
  EXPECT_EQ(held_w(camera), receiver_w) << "the first is none the worse for it";
  carry_out(camera, granted);
  carry_out(camera, next(camera));
  EXPECT_TRUE(was_told("the task of ARM is with CAMERA"));
  everybody_obeys();
  EXPECT_EQ(craft.member(camera)->state(), Operational);
  EXPECT_EQ(held_w(camera), receiver_w);
  EXPECT_EQ(craft.member(spare)->state(), PreOperational);
}

TEST_F(PowerOfPlans, OfAModeItIsTooLittleAsLongAsAPlanHasIt) {
  const auto commission = [](std::string name, State state) {
    return descriptor::CommissionStep{.subsystem = std::move(name), .configuration = "ONLY", .state = state, .at = {}};
  };
  craft.mission.modes[1].commission = {commission("ARM", SafeOperational), commission("HAND", Operational),
                                       commission("CAMERA", PreOperational), commission("SPARE", SafeOperational)};
  const Received granted = at_the_door();
  constexpr int narrow = 2;
  EXPECT_EQ(call_own("SET_MODE", narrow), "wrong status: reasons against it, all of them in TM[129,5]: 1");
  EXPECT_TRUE(was_told("mode narrow is impossible: SPARE needs 20 W, 8 W of 60 W are free"));
  verify(camera, granted.request, 8, pus::FailureCode::ExecutionError);
  expect_given_back();
  EXPECT_EQ(call_own("SET_MODE", narrow), "") << "it has begun";
  EXPECT_EQ(craft.changing_to, &craft.mission.modes[1]);
}

// --- given back, whatever way it ends -----------------------------------------------------------------------------------

TEST_F(PowerOfPlans, OneThatIsDoneHasItUntilItsReceiverIsDownAgain) {
  carry_out(camera, at_the_door());
  carry_out(camera, next(camera));
  EXPECT_TRUE(was_told("the task of ARM is with CAMERA"));
  some_time();
  EXPECT_EQ(held_w(camera), receiver_w);
  set(camera, PreOperational);
  expect_given_back();
}

TEST_F(PowerOfPlans, OneWhoseReceiverRefusesGivesItBack) {
  verify(camera, at_the_door().request, 8, pus::FailureCode::ExecutionError);
  EXPECT_TRUE(was_told("nobody takes over the task of ARM: CAMERA SafeOperational: execution error"));
  expect_given_back();
}

TEST_F(PowerOfPlans, OneWhoseReceiverDoesNotAnswerGivesItBackWhenItIsGivenUp) {
  at_the_door();
  wait(CommandDesk::answer_limit - 1ms);
  EXPECT_FALSE(is_granted(spare, receiver_w));
  wait(2ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(was_told("nobody takes over the task of ARM: CAMERA SafeOperational: no answer"));
  expect_given_back();
}

TEST_F(PowerOfPlans, OneWhoseReceiverDiesGivesItBack) {
  at_the_door();
  ends[played[camera].process] = {};
  parts.processes.watch(clock.now());
  expect_given_back();
}

TEST_F(PowerOfPlans, OneThatGaveWayGivesItBackWhenItsReceiverRefuses) {
  plan("network", "ARM", "HOT", {{"shut_down_network"}});
  const Received granted = at_the_door();
  happens(event_hot, arm);
  EXPECT_TRUE(was_told("ARM: plan to camera gives way to plan network"));
  some_time();
  EXPECT_EQ(held_w(camera), receiver_w) << "its receiver may still go there";
  verify(camera, granted.request, 8, pus::FailureCode::ExecutionError);
  expect_given_back();
}

/// Stopped, it may go there all the same: that moves nothing, and it draws.
TEST_F(PowerOfPlans, OneThatAStopOfEverythingEndsHasItAsLongAsItsReceiverDraws) {
  const Received granted = at_the_door();
  parts.safe_all.asked();
  some_time();
  EXPECT_EQ(held_w(camera), receiver_w);
  carry_out(camera, granted);
  everybody_obeys();
  EXPECT_TRUE(guard.fenced(camera));
  EXPECT_EQ(craft.member(camera)->state(), SafeOperational);
  EXPECT_EQ(held_w(camera), receiver_w);
  set(camera, PreOperational);
  expect_given_back();
}

TEST_F(PowerOfPlans, WhatAStopOfEverythingMakesVoidBeforeItLeftIsGivenBackAtOnce) {
  const Received configure = breaks(arm, camera);
  hold->tries = 1'000'000;
  carry_out(camera, configure);
  EXPECT_THAT(texts(camera), IsEmpty()) << "it waits for the disk";
  EXPECT_EQ(held_w(camera), receiver_w);
  parts.safe_all.asked();
  hold->tries = 0;
  craft.tell("the disk works");
  some_time();
  EXPECT_THAT(texts(camera), Not(Contains(to(SafeOperational))));
  expect_given_back();
}

TEST_F(PowerOfPlans, WhatLeavesTheDiskLateIsCarriedOutWithItsPower) {
  const Received configure = breaks(arm, camera);
  hold->tries = 1'000'000;
  carry_out(camera, configure);
  wait(WaitingForDisk::limit - 1ms);
  hold->tries = 0;
  craft.tell("the disk works");
  parts.telecommands.forward_durable();
  const Received told = next(camera);
  EXPECT_EQ(told.text, to(SafeOperational));
  verify(camera, told.request, 1);
  wait(1s);
  EXPECT_FALSE(is_granted(spare, receiver_w)) << "it is on its way there";
  wait(WaitingForDisk::limit);
  EXPECT_TRUE(is_granted(spare, receiver_w)) << "nobody says what became of it";
}

// --- another configuration of who acts ----------------------------------------------------------------------------------

TEST_F(PowerOfPlans, WhatIsToDrawMoreHasThatFromThePermissionOn) {
  plan("brighter", "ARM", "HOT", {{"configure", {2}, {}, {"BRIGHT"}}});
  happens(event_hot, arm);
  const Received told = next(arm);
  EXPECT_EQ(told.text, "CONFIGURE 2");
  some_time();
  EXPECT_EQ(held_w(arm), bright_w) << "whatever its state and configuration say until it is there";
  EXPECT_FALSE(is_granted(camera, receiver_w));
  verify(arm, told.request, 8, pus::FailureCode::ExecutionError);
  some_time();
  EXPECT_EQ(held_w(arm), giver_w) << "it stays as it is";
  EXPECT_TRUE(was_told("plan failed (execution error): escalating"));
}

TEST_F(PowerOfPlans, WhatIsToDrawMoreThanThereIsStaysAsItIs) {
  plan("brighter", "ARM", "HOT", {{"configure", {2}, {}, {"BRIGHT"}}});
  set_budget(51);
  happens(event_hot, arm);
  some_time();
  EXPECT_THAT(texts(arm), Not(Contains("CONFIGURE 2")));
  EXPECT_TRUE(was_told("power short: ARM asks for 30 W, 22 W of 51 W are reserved"));
  EXPECT_TRUE(was_told("plan failed"));
  EXPECT_EQ(held_w(arm), giver_w);
}

// --- a budget that shrinks while a plan runs ----------------------------------------------------------------------------

TEST_F(PowerOfPlans, ABudgetThatDoesNotCarryWhatOneWasGrantedTakesItsReceiverDownAndEndsIt) {
  const Received granted = at_the_door();
  EXPECT_EQ(call_own("SET_POWER_BUDGET", 40), "done");
  some_time();
  EXPECT_TRUE(was_told("LOAD_SHED BUDGET=40 W RESERVED=52 W"));
  EXPECT_TRUE(craft.member(camera)->recovery.going_down());
  EXPECT_TRUE(guard.fenced(camera));
  EXPECT_FALSE(craft.member(hand)->recovery.going_down()) << "what is left fits";
  carry_out(camera, granted);
  EXPECT_TRUE(was_told("nobody takes over the task of ARM: CAMERA is in a recovery"));
  EXPECT_TRUE(was_told("plan failed (CAMERA is in a recovery): escalating"));
  everybody_obeys();
  EXPECT_EQ(craft.member(camera)->state(), Offline);
  EXPECT_TRUE(guard.fenced(camera));
  EXPECT_EQ(held_w(camera), 0);
  EXPECT_FALSE(parts.power.ledger().overdrawn());
}

TEST_F(PowerOfPlans, ABudgetThatLeavesLittleStopsWhoActsBesideIt) {
  at_the_door();
  EXPECT_EQ(call_own("SET_POWER_BUDGET", 55), "done");
  some_time();
  EXPECT_TRUE(was_told("POWER_LOW"));
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational)));
  EXPECT_TRUE(guard.fenced(hand));
  for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_FALSE(craft.member(apid)->recovery.going_down());
}

// --- the step `power` ---------------------------------------------------------------------------------------------------

TEST_F(PowerOfPlans, APlanMayTakeABudgetByWhichItsNextStepIsGranted) {
  set_budget(33);
  craft.mission.plans.clear();
  plan("to camera", "ARM", "BROKEN", {power(100), hand_over(camera, "CAMERA")});
  happens(event_broken, arm);
  everybody_obeys();
  EXPECT_TRUE(was_told("the task of ARM is with CAMERA"));
  EXPECT_EQ(craft.member(camera)->state(), Operational);
  EXPECT_EQ(parts.power.ledger().budget_mw(), 100'000U);
}

TEST_F(PowerOfPlans, AStepBeforeItsBudgetIsTakenIsRefused) {
  set_budget(33);
  craft.mission.plans.clear();
  plan("to camera", "ARM", "BROKEN", {hand_over(camera, "CAMERA"), power(100)});
  happens(event_broken, arm);
  everybody_obeys();
  EXPECT_TRUE(was_told("nobody takes over the task of ARM: CAMERA SafeOperational: power"));
  EXPECT_EQ(parts.power.ledger().budget_mw(), 33'000U) << "the plan has ended";
  EXPECT_NE(craft.member(camera)->state(), Operational);
}

TEST_F(PowerOfPlans, WhoseBudgetDoesNotCarryItsOwnSubjectGivesWayToWhatSheds) {
  craft.mission.plans.clear();
  plan("frugal", "HAND", "HOT", {power(25), {"command", {1, 0, 15}, {}, {"BRAKE"}}});
  happens(event_hot, hand);
  for (int step = 0; step < 20; ++step) some_time();
  EXPECT_TRUE(was_told("HAND: plan frugal gives way to plan default"));
  EXPECT_TRUE(craft.member(hand)->recovery.going_down());
  EXPECT_FALSE(craft.member(arm)->recovery.going_down()) << "22 W of 25 W are left to it";
  everybody_obeys();
  EXPECT_EQ(craft.member(hand)->state(), Offline);
  EXPECT_FALSE(was_told("escalating")) << "it is over, and has not failed";
  EXPECT_FALSE(was_told("BRAKE")) << "its next step is given up";
  EXPECT_FALSE(parts.power.ledger().overdrawn());
}

TEST_F(PowerOfPlans, ABudgetThatTheDiskHoldsBackTooLongFailsItsPlanAndIsNeverTaken) {
  plan("frugal", "HAND", "HOT", {power(25)});
  hold->tries = 1'000'000;
  happens(event_hot, hand);
  wait(WaitingForDisk::limit);
  parts.telecommands.watch(clock.now());
  some_time();
  EXPECT_TRUE(was_told("plan failed"));
  hold->tries = 0;
  craft.tell("the disk works");
  for (int step = 0; step < 20; ++step) some_time();
  EXPECT_EQ(parts.power.ledger().budget_mw(), 60'000U);
  EXPECT_FALSE(craft.member(arm)->recovery.going_down()) << "nobody is shed for it";
}

TEST_F(PowerOfPlans, ABudgetThatNobodyAnswersForFailsItsPlan) {
  plan("frugal", "HAND", "HOT", {power(25)});
  happens(event_hot, hand);
  wait(CommandDesk::answer_limit);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(was_told("SUPERVISOR SET_POWER_BUDGET"));
  EXPECT_TRUE(was_told("plan failed (no answer): escalating"));
  EXPECT_TRUE(craft.member(hand)->recovery.going_down());
}

/// What no mission may write, as its reader knows the range.
TEST_F(PowerOfPlans, ABudgetOutsideItsRangeFailsItsPlanAndChangesNothing) {
  plan("frugal", "HAND", "HOT", {power(0), {"command", {1, 0, 15}, {}, {"BRAKE"}}});
  happens(event_hot, hand);
  for (int step = 0; step < 20; ++step) some_time();
  EXPECT_TRUE(was_told("plan failed (argument outside its range): escalating"));
  EXPECT_EQ(parts.power.ledger().budget_mw(), 60'000U);
  EXPECT_FALSE(was_told("BRAKE"));
}

/// Whose own functions are not there yet.
struct BeforeItsSupervisorIsUp : PowerOfPlans {
  void start_its_supervisor() override { parts.own.start(craft.mode_epoch); }
};

TEST_F(BeforeItsSupervisorIsUp, ABudgetIsRefusedAndFailsItsPlan) {
  plan("frugal", "HAND", "HOT", {power(25), {"command", {1, 0, 15}, {}, {"BRAKE"}}});
  happens(event_hot, hand);
  for (int step = 0; step < 20; ++step) some_time();
  EXPECT_TRUE(was_told("plan failed (not permitted in this state): escalating"));
  EXPECT_EQ(parts.power.ledger().budget_mw(), 60'000U);
  EXPECT_FALSE(was_told("BRAKE"));
}

TEST_F(PowerOfPlans, OfAnEventOfTheSupervisorItselfTheBudgetIsTakenOnceForAll) {
  craft.mission.plans.clear();
  plan("frugal", "", "LOG_DAMAGED", {power(50)});
  parts.own.announce("LOG_DAMAGED", {1});
  for (int step = 0; step < 30; ++step) some_time();
  EXPECT_EQ(parts.power.ledger().budget_mw(), 50'000U);
  EXPECT_EQ(std::ranges::count(story, "power budget 50 W, 32 W are reserved"), 1);
}

}  // namespace
}  // namespace hirosco::supervisor
