// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <string>

#include "tests/integration/loss_judges.hpp"

/// The supervisor dies, before or after each single message that it sends or takes, and another one goes on (docs/adr/0093): rokviss,
/// with its links and its devices.
namespace hirosco::testing {
namespace {

TEST(SupervisorDeath, InSteadyFlightNobodyIsStoppedAndNoLinkBreaks) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().run(500ms);
  std::map<std::string, std::uint32_t> epochs;
  for (const char* name : movers) epochs[name] = flight.craft().permit(name)->epoch.load();
  bool rested = false;
  flight.craft().on_cycle([&](std::string_view name, TimePoint) {
    if (name == "MANIPULATOR" && flight.inhibited("MANIPULATOR") != 0) rested = true;
    if (name == "JOYSTICK" && flight.inhibited("JOYSTICK") != 0) rested = true;
  });
  for (int time = 1; time <= 3; ++time) {
    const auto cycles = flight.cycles("MANIPULATOR");
    flight.craft().kill_supervisor();
    flight.craft().run(4s);
    EXPECT_EQ(flight.cycles("MANIPULATOR") - cycles, 8000U) << "2 kHz, all the time";
    EXPECT_FALSE(rested) << flight.story().text();
    EXPECT_EQ(flight.craft().supervisor().own_state(), State::Operational);
    EXPECT_EQ(flight.craft().supervisor().mode().name, "telepresence");
    EXPECT_EQ(flight.craft().supervisor().links().up_count(), 2U);
    for (const char* name : movers) {
      EXPECT_EQ(flight.state(name), State::Operational);
      EXPECT_TRUE(mortal.may_move(name));
      EXPECT_EQ(flight.craft().permit(name)->epoch.load(), epochs[name]) << "by the permission that it had";
    }
  }
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed) << flight.story().text();
  for (const char* name : movers) EXPECT_FALSE(mortal.may_move(name));
  flies_again(mortal);
}

TEST(SupervisorDeath, WithNobodyToGoOnTheCraftIsSafeAfterItsTime) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().kill_supervisor();
  flight.craft().keep_down();
  flight.craft().run(1900ms);
  EXPECT_EQ(flight.inhibited("MANIPULATOR"), 0U);
  flight.craft().run(200ms);
  for (const char* name : movers) EXPECT_NE(flight.inhibited(name), 0U) << name;
}

TEST(SupervisorDeath, WhoIsLostForLongerThanASubsystemGoesOnIsGoneOnForByOneThatLetsNobodyMove) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().kill_supervisor(3s);
  flight.craft().run(2100ms);
  EXPECT_FALSE(flight.craft().supervised());
  for (const char* name : movers) EXPECT_NE(flight.inhibited(name), 0U) << name;
  flight.craft().run(2s);
  EXPECT_TRUE(flight.craft().supervised());
  for (const char* name : movers) EXPECT_FALSE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

TEST(SupervisorDeath, OfOneThatHangsForLessThanTheKeepersPatienceNobodyKnows) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().run(500ms);
  const auto cycles = flight.cycles("MANIPULATOR");
  flight.craft().hang_supervisor(700ms);
  flight.craft().run(600ms);
  EXPECT_FALSE(flight.craft().supervised());
  flight.craft().run(3400ms);
  EXPECT_TRUE(flight.craft().supervised());
  EXPECT_EQ(flight.craft().supervisor_deaths(), 0);
  EXPECT_EQ(flight.cycles("MANIPULATOR") - cycles, 8000U) << "2 kHz, all the time";
  for (const char* name : movers) EXPECT_TRUE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

TEST(SupervisorDeath, OneThatHangsLongerIsEndedByTheKeeperAndAnotherOneGoesOn) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().run(500ms);
  const auto cycles = flight.cycles("MANIPULATOR");
  flight.craft().hang_supervisor(60s);
  flight.craft().run(4s);
  EXPECT_EQ(flight.craft().supervisor_deaths(), 1);
  EXPECT_EQ(flight.cycles("MANIPULATOR") - cycles, 8000U) << "2 kHz, all the time";
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 2U);
  for (const char* name : movers) EXPECT_TRUE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

TEST(SupervisorDeath, WhereNobodyWouldGoOnTheGuardStopsAllForOneThatHangs) {
  Flight flight{{.edit = simulation::hand_rests}};
  ASSERT_TRUE(flight.commission());
  flight.craft().run(500ms);
  flight.craft().hang_supervisor(1500ms);
  flight.craft().run(1100ms);
  EXPECT_EQ(flight.craft().supervisor_deaths(), 0);
  for (const char* name : movers) {
    const auto* page = flight.craft().permit(name);
    EXPECT_TRUE(page == nullptr || !page->permits(page->epoch.load())) << name << "\n" << flight.story().text();
  }
}

TEST(SupervisorDeath, ASignalToAProcessThatIsGoneReachesNobody) {
  MortalFlight mortal{0};
  Flight& flight = mortal.flight;
  ASSERT_TRUE(flight.commission());
  flight.craft().kill_supervisor();
  flight.craft().hang_supervisor(60s);
  for (const bool stopped : {true, false}) flight.craft().stop("SUPERVISOR", stopped);
  flight.craft().run(settles);
  EXPECT_TRUE(flight.craft().supervised());
  for (const char* name : movers) EXPECT_TRUE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

TEST(SupervisorDeath, AtEveryMomentOfAModeChangeEndsInTheOldModeTheNewOneOrSafe) {
  std::map<std::string, int> ends;
  int told_twice = 0;
  const int flights = at_every_moment(
      [](MortalFlight& mortal) { mortal.send(3000, "SET_MODE", mortal.flight.mission().find_mode("standalone")->id); },
      [&](MortalFlight& mortal) {
        is_in_the_old_mode_the_new_one_or_safe(mortal, ends);
        told_twice += each_telecommand_has_one_end(mortal);
        flies_again(mortal);
      });
  EXPECT_GT(flights, 20 / one_in(3));
  EXPECT_GT(ends["standalone"], 0);
  // What a step has to say leaves together, here a message at a time, and is noted behind the last of them.
  constexpr int moments_of_one_batch = 12;
  EXPECT_LE(told_twice, moments_of_one_batch)
      << "between the sending of an end and its note nobody knows that it was sent";
  for (const auto& [mode, count] : ends) std::printf("ended in %s: %d\n", mode.c_str(), count);
}

TEST(SupervisorDeath, AtEveryMomentOfAStopEverybodyHasStopped) {
  int told_twice = 0;
  const int flights = at_every_moment([](MortalFlight& mortal) { mortal.send(3000, "SAFE_ALL"); },
                                      [&](MortalFlight& mortal) {
                                        has_stopped_all_or_nobody(mortal);
                                        told_twice += a_second_end_is_marked(mortal);
                                        ground_hears_one_end_each(mortal);
                                        flies_again(mortal);
                                      });
  EXPECT_GT(flights, 10 / one_in(3));
  EXPECT_GT(told_twice, 0) << "there is a moment behind its leaving and before the note of that";
}

TEST(SupervisorDeath, AtEveryMomentOfARecoveryBothMachinesComeToRest) {
  const int flights = at_every_moment(
      [](MortalFlight& mortal) { static_cast<void>(mortal.flight.craft().device("joystick")->fault("unplug")); },
      [&](MortalFlight& mortal) {
        nobody_may_move(mortal);
        what_was_told_to_begin_is_done(mortal);
        static_cast<void>(mortal.flight.craft().device("joystick")->fault("plug"));
        flies_again(mortal);
      });
  EXPECT_GT(flights, 10 / one_in(3));
}

/// Whoever dies comes back to what it was commanded to be.
void everybody_comes_back(descriptor::Mission& mission) {
  constexpr std::int64_t limit = 1000, window_s = 60, pause_ms = 20;
  simulation::hand_rests(mission);
  for (auto& plan : mission.plans)
    for (auto& step : plan.steps)
      if (step.kind == "restart")
        step.values = {limit, window_s, pause_ms, static_cast<std::int64_t>(State::Operational)};
}

/// In a mode in which the manipulator needs nobody else.
[[nodiscard]] bool flies_alone(Flight& flight) {
  const bool flies = flight.commission() && flight.set_mode("standalone").completed;
  flight.craft().run(500ms);
  return flies;
}

[[nodiscard]] bool permitted(Flight& flight, const char* name) {
  const auto* page = flight.craft().permit(name);
  return page != nullptr && page->permits(page->epoch.load());
}

TEST(SupervisorDeath, WhoDiesWithTheSupervisorComesBackAsCommanded) {
  Flight flight{{.edit = everybody_comes_back, .revives_after = 300ms}};
  ASSERT_TRUE(flies_alone(flight));
  flight.craft().kill("MANIPULATOR");
  flight.craft().kill_supervisor();
  flight.craft().run(10s);
  EXPECT_TRUE(permitted(flight, "MANIPULATOR")) << flight.story().text();
}

/// `hirosco safe` while the supervisor's loop stands still, or while there is none: nobody but the guard, or the keeper, knows of it.
TEST(SupervisorDeath, AStopThatNoSupervisorHadHeardOfHoldsForWhoDiesWithIt) {
  for (const bool before_the_death : {true, false}) {
    Flight flight{{.edit = everybody_comes_back, .revives_after = 300ms}};
    ASSERT_TRUE(flies_alone(flight));
    if (before_the_death) flight.craft().stop_beside_flight();
    flight.craft().kill("MANIPULATOR");
    flight.craft().kill_supervisor();
    if (!before_the_death) flight.craft().stop_beside_flight();
    flight.craft().run(10s);
    for (const char* name : movers) {
      EXPECT_FALSE(permitted(flight, name)) << before_the_death << name << "\n" << flight.story().text();
      EXPECT_NE(flight.state(name), State::Operational) << before_the_death << name << "\n" << flight.story().text();
    }
    EXPECT_FALSE(flight.story().has(": as commanded"));
    // It was carried out and noted: the next one goes on with whoever was let go since.
    for (const char* name : movers)
      if (!flight.craft().alive(name)) static_cast<void>(flight.set_state(name, State::Offline));
    ASSERT_TRUE(flight.set_mode("telepresence").completed) << flight.story().text();
    flight.craft().run(200ms);
    flight.craft().kill_supervisor();
    flight.craft().run(2s);
    for (const char* name : movers) EXPECT_TRUE(permitted(flight, name)) << name << "\n" << flight.story().text();
  }
}

TEST(SupervisorDeath, OfOneWhoseNotesHadNoRoomNothingIsBelievedAndAllStops) {
  Flight flight{{.edit = simulation::hand_rests, .revives_after = 300ms, .journal_octets = 256}};
  ASSERT_TRUE(flight.commission());
  flight.craft().run(500ms);
  EXPECT_EQ(flight.story().count("too long for its journal"), 1U) << "told once";
  flight.craft().kill_supervisor();
  flight.craft().run(settles);
  EXPECT_TRUE(flight.story().has("nothing tells what that knew"));
  for (const char* name : movers) EXPECT_FALSE(permitted(flight, name)) << name << "\n" << flight.story().text();
}

/// From the first message of the flight on: who was let go before the death moves on only where the whole craft was commissioned.
TEST(SupervisorDeath, AtEveryMomentOfCommissioningNobodyIsLeftMovingAndTheCraftIsCommissionedAnew) {
  std::map<std::string, int> ends;
  int flights = 0;
  for (int at = 1;; at += one_in(5)) {
    MortalFlight mortal{at};
    Flight& flight = mortal.flight;
    mortal.deaths.armed = true;
    for (int step = 0;
         step < 100 && flight.craft().supervisor_deaths() == 0 && !flight.story().has("commissioned: mode"); ++step)
      flight.craft().run(100ms);
    mortal.deaths.armed = false;
    const bool died = flight.craft().supervisor_deaths() > 0;
    flight.craft().run(settles);
    ++flights;
    const std::string now = flight.craft().supervisor().mode().name;
    // Between the last step and the word that all are there it has the mode already; then it is stopped in that one.
    const bool whole = !flight.story().has("commissioning stopped: the supervisor died") && now == "telepresence";
    ++ends[whole ? "commissioned" : "stopped"];
    EXPECT_TRUE(now == "telepresence" || now == flight.mission().initial_mode) << now;
    for (const char* name : movers) {
      EXPECT_EQ(mortal.may_move(name), whole) << name << "\n" << mortal.text();
      EXPECT_TRUE(whole || flight.state(name) != State::Operational) << name << "\n" << mortal.text();
    }
    EXPECT_EQ(flight.craft().supervisor().own_state(), State::Operational) << mortal.text();
    flies_again(mortal);
    if (HasFailure() || !died) break;
  }
  EXPECT_GT(ends["stopped"], 100 / one_in(5));
  EXPECT_GT(ends["commissioned"], 0);
  std::printf("%d flights, stopped: %d, commissioned: %d\n", flights, ends["stopped"], ends["commissioned"]);
}

}  // namespace
}  // namespace hirosco::testing
