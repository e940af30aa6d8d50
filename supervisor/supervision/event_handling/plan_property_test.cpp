// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <ranges>
#include <set>
#include <utility>

#include "hirosco/utilities/testing/slice.hpp"
#include "supervisor/supervision/testing/plans_rig.hpp"

/// Every two plans at every moment: 17,328 crafts, which take minutes under a sanitizer, so optimised and in a program of its own. A
/// slice has each of them once, with one of the three priorities in turn.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using hirosco::testing::whole;
using enum descriptor::State;

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
  std::size_t turn = 0;
  constexpr std::array priorities{std::pair{1, 255}, std::pair{100, 100}, std::pair{255, 1}};
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
        for (int answered = 0; answered <= 1; ++answered)
          for (const bool stop : {false, true}) {
            ++turn;
            for (std::size_t each = 0; each < priorities.size(); ++each) {
              if (!whole() && each != turn % priorities.size()) continue;
              const auto& [priority, others] = priorities[each];
              try_one({one, two, other, static_cast<std::uint8_t>(priority), static_cast<std::uint8_t>(others),
                       answered, stop});
              if (::testing::Test::HasFailure()) return;
            }
          }
  EXPECT_EQ(tried, 19 * 4 * 19 * 2 * 2 * (whole() ? 3 : 1));
  EXPECT_GT(pre_empted, 160);
  EXPECT_GT(refused, 160);
  EXPECT_GT(networks, 330);
}

}  // namespace
}  // namespace hirosco::supervisor
