// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>

#include "tests/integration/mortal_flight.hpp"

/// The supervisor dies while it waits for a step of what it has begun for somebody else (docs/adr/0191).
namespace hirosco::testing {
namespace {

constexpr const char* handover = "tests/endtoend/handover.xml";

/// Until whoever takes over has come from where the death left it, at the latest.
constexpr Duration taken_over = 5s;

/// In a mission in which one that rests takes over from one that is gone, and that one comes back behind it.
[[nodiscard]] Plan keeper_comes_back() {
  return {
      .mission = handover, .edit = [](descriptor::Mission& mission) {
        constexpr std::int64_t limit = 100, window_s = 60, pause_ms = 20;
        for (auto& plan : mission.plans)
          if (plan.name == "keep-on")
            plan.steps.push_back({"restart", {limit, window_s, pause_ms, static_cast<std::int64_t>(State::Offline)}});
      }};
}

TEST(SupervisorDeath, AtEveryMomentOfATaskThatIsHandedOverSomebodyHasItInTheEnd) {
  const int flights = at_every_moment(
      [](MortalFlight& mortal) { mortal.flight.craft().kill("KEEPER"); },
      [](MortalFlight& mortal) {
        Flight& flight = mortal.flight;
        const auto has_it = [&] { return flight.state("SPARE") == State::Operational && mortal.may_move("SPARE"); };
        EXPECT_TRUE(flight.craft().run_until(has_it, taken_over)) << mortal.text();
        EXPECT_TRUE(flight.craft().run_until([&] { return flight.craft().alive("KEEPER"); }, taken_over))
            << "the step behind the one that waits\n"
            << mortal.text();
        flight.craft().run(taken_over);
        EXPECT_TRUE(has_it()) << "and keeps it\n" << mortal.text();
        EXPECT_EQ(flight.state("KEEPER"), State::Offline) << mortal.text();
        EXPECT_FALSE(flight.story().has("nobody takes over")) << mortal.text();
      },
      1, keeper_comes_back, 200ms);
  EXPECT_GT(flights, 10);
}

/// The robot goes on without the joystick in another configuration, by way of states in which it does nothing.
[[nodiscard]] Plan robot_falls_back() {
  return {.edit = [](descriptor::Mission& mission) {
    simulation::hand_rests(mission);
    for (auto& link : mission.links) {
      if (link.to != "MANIPULATOR" || link.from != "JOYSTICK") continue;
      link.on_loss = descriptor::OnLoss::Fallback;
      link.fallback = "STANDALONE";
    }
  }};
}

TEST(SupervisorDeath, AtEveryMomentOfAFallBackNobodyIsLeftBetweenTwoConfigurations) {
  std::map<std::string, int> ends;
  const int flights = at_every_moment(
      [](MortalFlight& mortal) { mortal.flight.craft().kill("JOYSTICK"); },
      [&](MortalFlight& mortal) {
        Flight& flight = mortal.flight;
        flight.craft().run(taken_over);
        const State state = flight.state("MANIPULATOR");
        const bool moves = mortal.may_move("MANIPULATOR");
        const auto* page = flight.craft().vital("MANIPULATOR");
        const auto* alone = flight.mission().find_subsystem("MANIPULATOR")->subsystem.find_configuration("STANDALONE");
        const bool elsewhere = page != nullptr && page->configuration.load() == alone->id;
        EXPECT_TRUE(state == State::Offline || (state == State::SafeOperational && !moves) ||
                    (state == State::Operational && moves && elsewhere))
            << static_cast<int>(state) << "\n"
            << mortal.text();
        ++ends[std::string{to_text(state)}];
      },
      one_in(3), robot_falls_back, 300ms);
  EXPECT_GT(flights, 10 / one_in(3));
  EXPECT_GT(ends["Operational"], 0) << "what has ended before stays so";
  for (const auto& [state, count] : ends) std::printf("ended in %s: %d\n", state.c_str(), count);
}

}  // namespace
}  // namespace hirosco::testing
