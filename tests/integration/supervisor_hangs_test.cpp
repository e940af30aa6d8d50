// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "hirosco/subsystem/pages/inhibition.hpp"
#include "hirosco/subsystem/pages/supervisor_silence.hpp"
#include "tests/integration/loss_judges.hpp"

/// The supervisor stands still in the midst of its step, before or after each single message that it sends or takes, until its keeper ends it
/// and another one goes on (docs/adr/0233). What had left it has been said, its guard goes on, and members hear nobody.
namespace hirosco::testing {
namespace {

/// What it was in the middle of.
struct During {
  std::function<void(MortalFlight&)> begin;
  Duration span{1s};
  int every{one_in(3)};
  std::function<Plan()> plan{hand_at_rest};
};

int at_every_hang(const During& during, const std::function<void(MortalFlight&)>& judge) {
  int cycled_on = 0, moved_on = 0;
  const int flights = at_every_moment(
      during.begin,
      [&](MortalFlight& mortal) {
        cycled_on += mortal.cycled_on;
        moved_on += mortal.moved_on;
        EXPECT_EQ(mortal.flight.craft().supervisor_deaths(), mortal.hung_until ? 1 : 0) << mortal.text();
        judge(mortal);
        the_log_is_continuous(mortal);
      },
      during.every, during.plan, during.span, Loss::Hang);
  EXPECT_GE(cycled_on, flights - 1) << "who cycles does so while it hangs, the ground link at least";
  EXPECT_GT(moved_on, 0) << "and whoever may move does";
  std::printf("%d flights\n", flights);
  return flights;
}

void to_standalone(MortalFlight& mortal) {
  mortal.send(3000, "SET_MODE", mortal.flight.mission().find_mode("standalone")->id);
}

void unplugged(MortalFlight& mortal) {
  mortal.may_be_inhibited_by = inhibited_by_link | inhibited_by_device;
  static_cast<void>(mortal.flight.craft().device("joystick")->fault("unplug"));
}

/// It is as it is to be a second after it began, whoever it goes on for.
void goes_on(MortalFlight& mortal) {
  EXPECT_TRUE(mortal.flight.craft().supervised()) << mortal.text();
  EXPECT_EQ(mortal.flight.craft().supervisor().own_state(), State::Operational) << mortal.text();
}

TEST(SupervisorHangs, AtEveryMomentOfAModeChangeEndsInTheOldModeTheNewOneOrSafe) {
  std::map<std::string, int> ends;
  const int flights = at_every_hang({.begin = to_standalone}, [&](MortalFlight& mortal) {
    goes_on(mortal);
    is_in_the_old_mode_the_new_one_or_safe(mortal, ends);
    ground_hears_one_end_each(mortal);
    flies_again(mortal);
  });
  EXPECT_GT(flights, 20 / one_in(3));
  EXPECT_GT(ends["standalone"], 0);
  EXPECT_GT(ends["telepresence"] + ends["commissioning"], 0);
  for (const auto& [mode, count] : ends) std::printf("ended in %s: %d\n", mode.c_str(), count);
}

TEST(SupervisorHangs, AtEveryMomentOfAStopEverybodyHasStopped) {
  int accepted_before = 0, told_twice = 0;
  const auto stop = [&](MortalFlight& mortal) {
    mortal.send(3000, "SAFE_ALL");
    // Told as accepted, and it hangs: whom that leaves moving would move until another one goes on.
    mortal.on_hang = [&] {
      for (const auto& [id, verdict] : mortal.verdicts.of) {
        if (verdict.accepted == 0) continue;
        ++accepted_before;
        nobody_may_move(mortal);
      }
    };
  };
  const int flights = at_every_hang({.begin = stop}, [&](MortalFlight& mortal) {
    goes_on(mortal);
    has_stopped_all_or_nobody(mortal);
    // Who goes on may tell again what had left: the ground link knows that it had.
    told_twice += a_second_end_is_marked(mortal);
    ground_hears_one_end_each(mortal);
    flies_again(mortal);
  });
  EXPECT_GT(flights, 10 / one_in(3));
  EXPECT_GT(accepted_before, 0);
  constexpr int moments_of_one_batch = 12;
  EXPECT_LE(told_twice, moments_of_one_batch);
}

TEST(SupervisorHangs, AtEveryMomentOfARecoveryBothMachinesComeToRest) {
  const int flights = at_every_hang({.begin = unplugged}, [](MortalFlight& mortal) {
    goes_on(mortal);
    nobody_may_move(mortal);
    what_was_told_to_begin_is_done(mortal);
    static_cast<void>(mortal.flight.craft().device("joystick")->fault("plug"));
    flies_again(mortal);
  });
  EXPECT_GT(flights, 10 / one_in(3));
}

/// Somebody asks the guard to stop everything while the loop stands still: it needs nobody else, and the next supervisor holds it.
TEST(SupervisorHangs, AtEveryMomentOfAModeChangeAStopBesideItHolds) {
  const auto stopped_meanwhile = [](MortalFlight& mortal) {
    to_standalone(mortal);
    mortal.on_hang = [&] {
      mortal.flight.craft().stop_beside_flight();
      nobody_may_move(mortal);
    };
  };
  static_cast<void>(at_every_moment(
      stopped_meanwhile,
      [](MortalFlight& mortal) {
        goes_on(mortal);
        if (!mortal.hung_until) return;
        nobody_may_move(mortal);
        for (const char* name : movers)
          EXPECT_NE(mortal.flight.state(name), State::Operational) << name << "\n" << mortal.text();
        ground_hears_one_end_each(mortal);
        flies_again(mortal);
      },
      one_in(5), hand_at_rest, 1s, Loss::Hang));
}

/// From the end of its guard on, which goes on with it.
TEST(SupervisorHangs, AtEveryMomentOfAModeChangeWithNobodyToGoOnTheCraftIsSafeAfterItsTime) {
  const auto alone = [] { return Plan{.edit = simulation::hand_rests, .revives_after = 2 * supervisor_silence_limit}; };
  static_cast<void>(at_every_moment(
      to_standalone,
      [](MortalFlight& mortal) {
        Flight& flight = mortal.flight;
        if (!mortal.hung_until) return;
        const TimePoint safe_at = *mortal.hung_until + supervisor_silence_limit + 100ms;
        flight.craft().run(std::max(safe_at - flight.craft().now(), Duration{0}));
        ASSERT_FALSE(flight.craft().supervised());
        for (const char* name : movers)
          EXPECT_TRUE(flight.inhibited(name) != 0 || flight.state(name) != State::Operational) << name << "\n"
                                                                                               << mortal.text();
      },
      one_in(7), alone, 1s, Loss::Hang));
}

}  // namespace
}  // namespace hirosco::testing
