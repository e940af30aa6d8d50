// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_runs.hpp"

#include <memory>
#include <ranges>
#include <set>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

constexpr std::uint16_t first_event = 2000, second_event = 2001;

/// ARM, and HAND, tell FIRST and SECOND, both of low severity, so that a plan alone says what weighs.
struct PlanRunsTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems)
      for (const auto& [name, id] : {std::pair{"FIRST", first_event}, std::pair{"SECOND", second_event}}) {
        descriptor::Event event;
        event.name = name;
        event.id = id;
        event.severity = Severity::Low;
        member.subsystem.events.push_back(event);
      }
    start_all(Operational);
    parts.graph.set_up(1, true);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    parts.own.start(craft.mode_epoch);
    own_step();
  }
  void plan(std::string name, std::string event, std::uint8_t priority, std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = std::move(name);
    made.event = std::move(event);
    made.priority = priority;
    made.steps = std::move(steps);
    craft.mission.plans.push_back(std::move(made));
  }
  void happens(std::uint16_t id, std::uint16_t to = arm) { event(to, id, Severity::Low); }
  /// Each telecommand that it has is completed, or not.
  void answered(std::uint16_t apid, std::uint8_t subtype = 7) {
    for (const auto& sent : received(apid)) verify(apid, sent.request, subtype, pus::FailureCode::ExecutionError);
  }
  static descriptor::PlanStep to_be(State state, std::string whom = {}) {
    return {"set_state", {static_cast<std::int64_t>(state)}, std::move(whom)};
  }
  static descriptor::PlanStep down(std::string whom = {}) { return {"shut_down_network", {}, std::move(whom)}; }
};

TEST_F(PlanRunsTest, TheHigherPriorityEndsTheLowerAndAnEventNamesBoth) {
  plan("low", "FIRST", 100, {to_be(ErrorOperational), to_be(PostOperational)});
  plan("high", "SECOND", 101, {to_be(PreOperational)});
  happens(first_event);
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(PreOperational)));
  EXPECT_TRUE(was_told("ARM: plan low gives way to plan high at ARM: ErrorOperational"));
  own_step();
  EXPECT_TRUE(was_told("PLAN_PREEMPTED APID=10 PLAN=1 BY=2"));
  verify(arm, begun[0].request, 7);
  EXPECT_THAT(texts(arm), IsEmpty()) << "its next step is given up";
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(craft.member(arm)->recovery.running()) << "the other one runs";
}

TEST_F(PlanRunsTest, WhatFailsAfterItGaveWayEscalatesNothing) {
  plan("low", "FIRST", 100, {to_be(ErrorOperational)});
  plan("high", "SECOND", 101, {to_be(PreOperational)});
  happens(first_event);
  const auto begun = received(arm);
  happens(second_event);
  verify(arm, begun.at(0).request, 8, pus::FailureCode::ExecutionError);
  EXPECT_FALSE(was_told("escalating"));
  EXPECT_FALSE(guard.fenced(hand));
}

TEST_F(PlanRunsTest, AnEqualOrLowerOneIsRefusedAndThatIsToldOnce) {
  plan("runs", "FIRST", 100, {to_be(ErrorOperational)});
  plan("equal", "SECOND", 100, {to_be(Offline)});
  happens(first_event);
  answered(hand);
  static_cast<void>(texts(arm));
  for (int again = 0; again < 3; ++again) happens(second_event);
  EXPECT_THAT(texts(arm), IsEmpty());
  own_step();
  const auto told = [&](std::string_view what) {
    return std::ranges::count_if(story, [&](const std::string& line) { return line.find(what) != std::string::npos; });
  };
  EXPECT_EQ(told("ARM: plan equal because of SECOND is refused, plan runs runs"), 1);
  EXPECT_EQ(told("PLAN_REFUSED APID=10 PLAN=2 RUNS=1"), 1);
  happens(first_event);
  EXPECT_EQ(told("is refused"), 1) << "the same plan runs already";
}

TEST_F(PlanRunsTest, ARefusedPlanDoesNotBeginLater) {
  plan("runs", "FIRST", 100, {to_be(ErrorOperational)});
  plan("lower", "SECOND", 99, {to_be(PreOperational)});
  happens(first_event);
  happens(second_event);
  obey(arm);
  EXPECT_FALSE(craft.member(arm)->recovery.running());
  EXPECT_THAT(texts(arm), IsEmpty()) << "it would act on what has changed since";
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(PreOperational))) << "told again, it begins";
}

TEST_F(PlanRunsTest, WhatIsSaferGoesFirstWhateverItsNumber) {
  plan("state", "FIRST", 255, {to_be(SafeOperational)});
  plan("network", "SECOND", 1, {down()});
  happens(first_event);
  happens(second_event);
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_TRUE(guard.fenced(hand));
}

TEST_F(PlanRunsTest, NothingLessSafeEndsAPlanThatWillStillTakeTheNetworkDown) {
  plan("network", "FIRST", 1, {to_be(SafeOperational), down()});
  plan("state", "SECOND", 255, {to_be(PreOperational)});
  happens(first_event);
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_TRUE(was_told("ARM: plan state because of SECOND is refused, plan network runs"));
  set(arm, SafeOperational);
  happens(second_event);
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(PlanRunsTest, WhoGoesDownWithANetworkFollowsNoPlanOfItsOwnAnyMore) {
  plan("own", "FIRST", 255, {to_be(ErrorOperational), to_be(PostOperational)});
  plan("network", "SECOND", 1, {down()});
  happens(first_event, hand);
  happens(second_event, arm);
  EXPECT_TRUE(was_told("HAND: plan own gives way to plan network"));
  std::vector<std::string> sent;
  for (const auto& each : received(hand)) {
    sent.push_back(each.text);
    set(hand, ErrorOperational);
    verify(hand, each.request, 7);
  }
  for (const std::string& each : texts(hand)) sent.push_back(each);
  EXPECT_EQ(std::ranges::count(sent, to(PostOperational)), 0);
  EXPECT_EQ(std::ranges::count(sent, to(Offline)), 1);
}

TEST_F(PlanRunsTest, AStepMayMoveAnotherThanWhoseEventItIs) {
  plan("hand too", "FIRST", 100, {to_be(SafeOperational, "HAND")});
  happens(first_event);
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational)));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_FALSE(guard.fenced(arm));
  EXPECT_TRUE(was_told("plan hand too: HAND to SafeOperational because of FIRST"));
}

TEST_F(PlanRunsTest, WhomAPlanMovesIsHeldUpByNobodyElseOfIt) {
  plan("both", "FIRST", 100, {to_be(ErrorOperational), to_be(SafeOperational, "HAND")});
  happens(first_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational))) << "though ARM has not answered";
}

TEST_F(PlanRunsTest, AnEscalationIsOneAndWhereThatFailsTooTheNetworkGoesDown) {
  descriptor::Plan severe;
  severe.name = "severe";
  severe.severities = {Severity::High};
  severe.steps = {to_be(PreOperational)};
  craft.mission.plans.push_back(severe);
  plan("fails", "FIRST", 100, {to_be(ErrorOperational)});
  happens(first_event);
  answered(arm, 8);
  EXPECT_EQ(texts(arm).size(), 1U) << "the plan for what is severe";
  EXPECT_FALSE(guard.fenced(hand));
  wait(WaitingForDisk::limit);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_TRUE(guard.fenced(hand));
}

// --- the property -------------------------------------------------------------------------------------------------------

/// Everything that a plan may do, and what its reader refuses besides: to let go.
std::vector<descriptor::PlanStep> all_planned_steps() {
  std::vector<descriptor::PlanStep> all;
  for (const descriptor::StepWord& word : descriptor::plan_steps) {
    if (word.name == "set_state") {
      for (const State state :
           {Offline, PreOperational, SafeOperational, Operational, ErrorOperational, PostOperational})
        all.push_back(PlanRunsTest::to_be(state));
      continue;
    }
    if (word.name == descriptor::step_that_runs_a_plan) continue;  // no step of a flight
    descriptor::PlanStep step{std::string{word.name}};
    for (const auto& attribute : word.attributes) {
      using enum descriptor::StepAttribute::Kind;
      // Of what is looked up: a function that both have, the only configuration, the other member, a link that is up.
      const bool looked_up = attribute.kind == Configuration || attribute.kind == Link;
      std::int64_t value = looked_up ? 1 : attribute.otherwise.value_or(attribute.least);
      if (attribute.kind == descriptor::StepAttribute::Kind::Subsystem && !attribute.otherwise) value = hand;
      step.values.push_back(value);
      step.words.emplace_back(attribute.kind == Function ? "BRAKE" : looked_up ? "ONLY" : "HAND");
    }
    all.push_back(step);
  }
  return all;
}

struct PlanCase {
  descriptor::PlanStep one, two;  ///< of the plan that begins first
  descriptor::PlanStep other;
  std::uint8_t priority{}, others_priority{};
  int answered{};  ///< telecommands of the first when the other begins
  bool stop{};  ///< SAFE_ALL before it
};

/// A craft of its own for each case.
struct PlanRig final : PlanRunsTest {
  void TestBody() override {}

  void look(const std::string& when) {
    for (const std::uint16_t apid : {arm, hand}) {
      if (guard.fenced(apid)) was_fenced.insert(apid);
      if (was_fenced.contains(apid) && !guard.fenced(apid)) loosened = when + ": a fence was lifted";
      if (was_fenced.contains(apid) && played[apid].permit->go.load() != 0) loosened = when + ": permitted to go";
      const bool goes_down = craft.member(apid)->recovery.going_down();
      if (goes_down) went_down.insert(apid);
      if (went_down.contains(apid) && !goes_down && craft.member(apid)->state() != Offline)
        loosened = when + ": the way down was left";
    }
  }
  /// As a member would: up to where it acts goes nobody from below.
  void answer_one(std::uint16_t apid) {
    for (const Received& each : received(apid)) {
      constexpr std::string_view to_state = "SET_STATE ";
      const auto now = craft.member(apid)->state();
      const bool moves = each.text.starts_with(to_state);
      const auto wanted = static_cast<State>(moves ? std::stoi(each.text.substr(to_state.size())) : 0);
      const bool refused = moves && (wanted == Operational || (wanted == SafeOperational && now != Operational));
      if (moves && !refused) set(apid, wanted);
      verify(apid, each.request, refused ? 8 : 7, pus::FailureCode::ExecutionError);
    }
  }
  void fly(const PlanCase& each) {
    SetUp();
    plan("one", "FIRST", each.priority, {each.one, each.two});
    plan("other", "SECOND", each.others_priority, {each.other});
    happens(first_event);
    look("the first began");
    for (int i = 0; i < each.answered; ++i) answer_one(arm);
    look("the first went on");
    if (each.stop) {
      parts.safe_all.asked();
      look("everything was stopped");
    }
    happens(second_event);
    look("the other began");
    for (int i = 0; i < 6; ++i) {
      for (const std::uint16_t apid : {arm, hand}) answer_one(apid);
      own_step();
      look("both went on");
    }
  }
  std::set<std::uint16_t> was_fenced, went_down;
  std::string loosened;
};

std::string words_of(const PlanCase& each) {
  const auto say = [](const descriptor::PlanStep& step) {
    return step.kind + (step.values.empty() ? "" : " " + std::to_string(step.values[0]));
  };
  return say(each.one) + ", " + say(each.two) + " (" + std::to_string(each.priority) + ") then " + say(each.other) +
         " (" + std::to_string(each.others_priority) + ") after " + std::to_string(each.answered) +
         (each.stop ? " and a stop" : "");
}

TEST(PlanProperty, NoPlanEverLoosensWhatAnotherOrAStopHasTightenedWhateverItsKindNumberAndMoment) {
  const auto steps = all_planned_steps();
  ASSERT_EQ(steps.size(), 19U) << "a new kind of step is tried, too";
  // In the middle those that weigh: to let go, to stop, to hand over, to go down.
  const auto weighs = [](const descriptor::PlanStep& step) {
    return step.kind == "hand_over" || step.kind == "shut_down_network" || step.kind == "fence" ||
           (step.kind == "set_state" && step.values[0] == static_cast<std::int64_t>(Operational));
  };
  int tried = 0, pre_empted = 0, refused = 0, networks = 0;
  const auto try_one = [&](const PlanCase& each) {
    const auto own = std::make_unique<PlanRig>();
    PlanRig& rig = *own;
    rig.fly(each);
    ++tried;
    pre_empted += rig.was_told("gives way to") ? 1 : 0;
    refused += rig.was_told("is refused") ? 1 : 0;
    ASSERT_EQ(rig.loosened, "") << words_of(each);
    // What was to take the network down does, whatever came in between.
    const bool network = each.one.kind == "shut_down_network" || each.two.kind == "shut_down_network" ||
                         each.other.kind == "shut_down_network";
    if (!network) return;
    ++networks;
    EXPECT_TRUE(rig.was_fenced.contains(hand) && rig.was_fenced.contains(arm)) << words_of(each);
  };
  for (const auto& one : steps)
    for (const auto& two : steps | std::views::filter(weighs))
      for (const auto& other : steps)
        for (const auto& [priority, others] : {std::pair{1, 255}, {100, 100}, {255, 1}})
          for (int answered = 0; answered <= 1; ++answered)
            for (const bool stop : {false, true}) {
              try_one({one, two, other, static_cast<std::uint8_t>(priority), static_cast<std::uint8_t>(others),
                       answered, stop});
              if (::testing::Test::HasFailure()) return;
            }
  EXPECT_EQ(tried, 19 * 4 * 19 * 3 * 2 * 2);
  EXPECT_GT(pre_empted, 500);
  EXPECT_GT(refused, 500);
  EXPECT_GT(networks, 1000);
}

TEST(PlanRank, SafetyCountsMoreThanPriorityThanSeverity) {
  const PlanRank runs{Safety::Stop, 100, Severity::Medium};
  EXPECT_TRUE(pre_empts({Safety::Network, 1, Severity::Info}, runs));
  EXPECT_TRUE(pre_empts({Safety::Stop, 101, Severity::Info}, runs));
  EXPECT_TRUE(pre_empts({Safety::Stop, 100, Severity::High}, runs));
  EXPECT_FALSE(pre_empts(runs, runs));
  EXPECT_FALSE(pre_empts({Safety::None, 255, Severity::High}, runs));
  EXPECT_FALSE(pre_empts({Safety::Stop, 99, Severity::High}, runs));
}

}  // namespace
}  // namespace hirosco::supervisor
