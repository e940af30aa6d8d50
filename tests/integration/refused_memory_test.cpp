// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <map>
#include <new>
#include <string>
#include <utility>

#include "hirosco/utilities/refused_allocations.hpp"
#include "tests/integration/loss_judges.hpp"

/// The supervisor is refused memory in the midst of a change of mode, a plan and a stop, at each of its allocations (docs/adr/0114, 0233). What it
/// does by `new` there is done by its reserve, and it ends behind that step; or it ends at that very place, where the reserve is too small.
/// One flight is flown, and at each of these allocations a child of this process flies on with the refusal; its judges are the ones of every
/// other loss.
namespace hirosco::testing {
namespace {

using Moment = simulation::SimulatedSupervisor::Moment;

enum class Reserve : std::uint8_t {
  Enough,  ///< for the rest of the step
  TooSmall,
};

struct Step {
  std::function<void(MortalFlight&)> begin;
  std::function<void(MortalFlight&)> judge;
  Duration span;  ///< in which it has ended where nothing is refused
};

/// What is refused, and what became of it. The handler of `new` has no argument: the one that is under way is found by its place.
class Refusals {
 public:
  Refusals(MortalFlight& mortal, Reserve reserve, std::uint64_t every)
      : mortal_{mortal}, reserve_{reserve}, every_{every}, before_{std::set_new_handler(&Refusals::refused)} {
    newest = this;
    if (reserve_ == Reserve::TooSmall) refused_.refuse(1);
    mortal_.flight.craft().on_supervisor_step([this](Moment moment) { step(moment); });
  }
  ~Refusals() {
    mortal_.flight.craft().on_supervisor_step({});
    std::set_new_handler(before_);
    newest = nullptr;
  }
  Refusals(const Refusals&) = delete;
  Refusals& operator=(const Refusals&) = delete;
  /// This is a flight in which one was refused.
  [[nodiscard]] bool branched() const noexcept { return branched_; }
  /// Nothing more is refused, and all that was is judged.
  void end() {
    over_ = true;
    while (under_way_ > 0) judged();
  }
  [[nodiscard]] int flights() const noexcept { return flights_; }
  [[nodiscard]] int failed() const noexcept { return failed_; }
  [[nodiscard]] bool unheard() const noexcept { return unheard_; }

 private:
  static inline Refusals* newest{nullptr};
  static void refused() { newest->branch(); }

  void step(Moment moment) {
    const bool begins = moment == Moment::Begins;
    refused_.set_counting(begins && !branched_ && !over_);
    // From whichever allocation of a step on it has been on its reserve: behind it that is the same.
    if (begins && reserve_ == Reserve::Enough) refused_.refuse(steps_++ % every_ == 0 ? 1 : 0);
    if (begins) return;
    // Who asked by malloc() is told so, and no handler is: it goes on in this flight.
    if (!branched_ && refused_.refused()) unheard_ = true;
    if (std::exchange(ends_, false)) mortal_.flight.craft().kill_supervisor();
  }
  void branch() {
    refused_.set_counting(false);
    while (under_way_ >= most_at_once) judged();
    std::fflush(nullptr);
    const pid_t child = ::fork();
    branched_ = child == 0;
    if (branched_ && reserve_ == Reserve::Enough) ends_ = true;
    if (branched_ && reserve_ == Reserve::TooSmall) mortal_.flight.craft().supervisor_dies_here();
    if (branched_) {
      under_way_ = 0;
      return;
    }
    if (child > 0) ++under_way_;
    else ++failed_;
    ++flights_;
    // Behind its handler `new` asks once more, which counts.
    refused_.refuse(reserve_ == Reserve::Enough ? 0 : every_ + 1);
    refused_.set_counting(true);
  }

  void judged() {
    int status = -1;
    if (::wait(&status) < 0 || status != 0) ++failed_;
    --under_way_;
  }

  static constexpr int most_at_once = 2;
  MortalFlight& mortal_;
  Reserve reserve_;
  std::uint64_t every_;
  std::new_handler before_;
  RefusedAllocations refused_;
  std::uint64_t steps_{0};
  bool over_{false}, branched_{false}, ends_{false}, unheard_{false};
  int flights_{0}, failed_{0};
  int under_way_{0};  ///< flights that are judged beside this one
};

/// The number of flights in which one was refused.
int at_every_allocation(const Step& during, Reserve reserve, int every) {
  MortalFlight mortal{0, hand_at_rest()};
  Flight& flight = mortal.flight;
  mortal.listen();
  if (!flight.commission()) {
    ADD_FAILURE() << "not commissioned\n" << mortal.text();
    return 0;
  }
  flight.craft().run(100ms);
  flight.craft().ground().on_telemetry([&](Octets packet) {
    if (const auto report = pus::TelemetryView::parse(packet)) mortal.heard.hear(*report);
  });
  Refusals refusals{mortal, reserve, static_cast<std::uint64_t>(every)};
  during.begin(mortal);
  flight.craft().run(during.span);
  refusals.end();
  if (!refusals.branched()) {
    EXPECT_EQ(refusals.failed(), 0);
    EXPECT_FALSE(refusals.unheard());
  }
  const int flights = refusals.flights();
  flight.craft().run(settles);
  EXPECT_EQ(flight.craft().supervisor_deaths(), refusals.branched() ? 1 : 0) << mortal.text();
  EXPECT_TRUE(flight.craft().supervised()) << mortal.text();
  during.judge(mortal);
  the_log_is_continuous(mortal);
  if (refusals.branched()) {
    if (::testing::Test::HasFailure()) std::printf("refused behind %d others\n", flights);
    std::fflush(nullptr);
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  std::printf("%d refusals\n", flights);
  return flights;
}

Step mode_change() {
  return {.begin =
              [](MortalFlight& mortal) {
                mortal.send(3000, "SET_MODE", mortal.flight.mission().find_mode("standalone")->id);
              },
          .judge =
              [](MortalFlight& mortal) {
                std::map<std::string, int> ends;
                is_in_the_old_mode_the_new_one_or_safe(mortal, ends);
                ground_hears_one_end_each(mortal);
                flies_again(mortal);
              },
          .span = 300ms};
}

Step stop() {
  return {.begin = [](MortalFlight& mortal) { mortal.send(3000, "SAFE_ALL"); },
          .judge =
              [](MortalFlight& mortal) {
                has_stopped_all_or_nobody(mortal);
                ground_hears_one_end_each(mortal);
                flies_again(mortal);
              },
          .span = 200ms};
}

Step plan() {
  return {
      .begin =
          [](MortalFlight& mortal) { static_cast<void>(mortal.flight.craft().device("joystick")->fault("unplug")); },
      .judge =
          [](MortalFlight& mortal) {
            nobody_may_move(mortal);
            what_was_told_to_begin_is_done(mortal);
            static_cast<void>(mortal.flight.craft().device("joystick")->fault("plug"));
            flies_again(mortal);
          },
      .span = 300ms};
}

TEST(RefusedMemory, AtEveryAllocationOfAModeChangeEndsInTheOldModeTheNewOneOrSafe) {
  EXPECT_GT(at_every_allocation(mode_change(), Reserve::TooSmall, one_in(37)), 20);
}

TEST(RefusedMemory, AtEveryAllocationOfAStopEverybodyHasStopped) {
  EXPECT_GT(at_every_allocation(stop(), Reserve::TooSmall, one_in(37)), 20);
}

TEST(RefusedMemory, AtEveryAllocationOfAPlanItIsDone) {
  EXPECT_GT(at_every_allocation(plan(), Reserve::TooSmall, one_in(37)), 20);
}

TEST(RefusedMemory, InEachStepOfAModeChangeThatStepEndsAndAnotherSupervisorGoesOn) {
  EXPECT_GT(at_every_allocation(mode_change(), Reserve::Enough, one_in(3)), 5);
}

TEST(RefusedMemory, InEachStepOfAStopThatStepEndsAndAnotherSupervisorGoesOn) {
  EXPECT_GT(at_every_allocation(stop(), Reserve::Enough, one_in(3)), 5);
}

TEST(RefusedMemory, InEachStepOfAPlanThatStepEndsAndAnotherSupervisorGoesOn) {
  EXPECT_GT(at_every_allocation(plan(), Reserve::Enough, one_in(3)), 5);
}

}  // namespace
}  // namespace hirosco::testing
