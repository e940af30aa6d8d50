// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/control/sample_time.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What an arm feels from outside while cycles are missed (docs/adr/0229): its drives hold the torque that they were told last, and the world goes on.
namespace hirosco::robot_arm {
namespace {

using testing::bounds_of;
using testing::model_of;
using testing::Plant;

constexpr double observer_gain_per_s = 50, rotor_kg_m2 = 0.3;
/// Of a joint's effort: what counts as a contact, for so many cycles.
constexpr double contact_share = 0.3;
constexpr int contact_cycles = 3;

/// Who begins late commands late, and works by what is as old; who ends late does not. He who missed some does not know which it was.
enum class Pause : std::uint8_t { BeforeItCommands, BehindIt };

/// Device and world go by the time that passes, cycles by what they get of it.
struct Loop {
  Duration period;
  double cycle_s{seconds(period)};
  robotics::Model model = model_of(testing::six_axes);
  std::vector<JointBounds> bounds = bounds_of(model);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  Setpoints setpoints{model, model.find_frame("tool").value(), bounds, cycle_s};
  Laws laws{model, model.find_frame("tool").value(), cycle_s};
  Plant plant{model};
  std::vector<double> rotors = std::vector<double>(6, rotor_kg_m2);
  /// The second one takes each sample for a cycle after the one before.
  MomentumObserver observer{6, cycle_s, observer_gain_per_s}, by_cycles{6, cycle_s, observer_gain_per_s};
  SampleTime sample_time;
  TimePoint planned{}, world{};
  JointVector held, outside = JointVector::Zero(6);
  Measured answer, measured;  ///< to the newest command; what a cycle has found
  std::uint64_t cycles{0}, missed{0};

  explicit Loop(Duration cycle) : period{cycle} {
    const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
    dynamics.set_gravity({0, 0, -9.81});
    plant.rotor = rotor_kg_m2;
    plant.step_s = 200e-6;
    plant.place(start);
    setpoints.begin(start);
    look_at(plant.measured());
    robotics::Coordinates bias;
    dynamics.bias(bias);
    held = bias;
    answer = plant.measured();
    answer.torque = held;
  }
  void look_at(const Measured& now) {
    measured = now;
    robotics::State state;
    state.q = measured.position;
    state.qd = measured.velocity;
    dynamics.update(state);
  }
  void pass(TimePoint until) {
    plant.step(held, seconds(until - world), &outside);
    world = until;
  }
  /// One cycle, and those that are missed because of it; `answered`: its device was in time.
  void cycle(Duration pause = {}, Pause where = Pause::BehindIt, bool answered = true) {
    pass(planned);
    sample_time.update(planned, period, cycles++ == 0, answered);
    if (answered) look_at(answer);
    feel(answered);
    setpoints.advance();
    const JointVector torque =
        laws.torque(setpoints.now(), measured, dynamics, {}, bounds,
                    {.position = {.bandwidth_rad_s = std::min(40.0, robotics::fastest_rad_s(cycle_s)),
                                  .rotor = rotors,
                                  .gravity_m_s2 = {0, 0, -9.81}}});
    if (where == Pause::BeforeItCommands) pass(planned + pause);
    answer = plant.measured();
    held = torque;
    // As CyclePace has it: the next one is due on the grid and in the future.
    const auto skipped = pause > period ? (pause - period) / period + 1 : 0;
    planned += (1 + skipped) * period;
    missed += static_cast<std::uint64_t>(skipped);
  }
  void feel(bool answered) {
    const auto nothing = robotics::Coordinates::Zero(6);
    if (answered) observer.update(measured, dynamics, nothing, sample_time.between());
    by_cycles.update(measured, dynamics, nothing);
  }
  [[nodiscard]] double share(const MomentumObserver& its) const {
    double most = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i)
      most = std::max(most, std::abs(its.external()[static_cast<Eigen::Index>(i)]) / bounds[i].effort);
    return most;
  }
  void stand(double for_s) {
    for (double t = 0; t < for_s; t += cycle_s) cycle();
  }
  void go(double speed_share = 1) {
    ASSERT_TRUE(setpoints.go(vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0}), speed_share));
  }
};

/// As a computer with other work has them: in one of `rarely` cycles, up to `longest` periods, of both kinds.
struct Pauses {
  Duration period{};
  unsigned rarely{0}, longest{0};
  std::minstd_rand random{};

  [[nodiscard]] std::string words(unsigned seed) const {
    return std::to_string(1e3 * seconds(period)) + " ms, one in " + std::to_string(rarely) + ", up to " +
           std::to_string(longest) + " periods, seed " + std::to_string(seed);
  }
  void cycle(Loop& loop, bool answered = true) {
    const bool now = random() % rarely == 0;
    const Duration pause = now ? static_cast<std::int64_t>(random() % 1000 * longest) * period / 1000 : Duration{};
    const Pause where = random() % 2 == 0 ? Pause::BeforeItCommands : Pause::BehindIt;
    loop.cycle(pause, where, answered);
  }
};
const std::array loaded{Pauses{4ms, 25, 5}, Pauses{4ms, 50, 10}, Pauses{1ms, 25, 10}, Pauses{1ms, 100, 20}};

/// One of each is in `unanswered` cycles not heard in time.
double most_felt(const Pauses& of, unsigned seed, unsigned unanswered, double& most_by_cycles) {
  Pauses pauses = of;
  pauses.random.seed(seed);
  Loop loop{pauses.period};
  loop.stand(0.2);
  loop.go();
  double most = 0;
  while (!loop.setpoints.at_rest()) {
    pauses.cycle(loop, unanswered == 0 || pauses.random() % unanswered != 0);
    most = std::max(most, loop.share(loop.observer));
    most_by_cycles = std::max(most_by_cycles, loop.share(loop.by_cycles));
  }
  EXPECT_GT(loop.missed, loop.cycles / 50) << of.words(seed);
  return most;
}

TEST(MissedCycles, AreNoPushFromOutsideThoughTheArmMovesFast) {
  double by_cycles = 0;
  for (const Pauses& each : loaded)
    for (unsigned seed = 1; seed <= 6; ++seed)
      EXPECT_LT(most_felt(each, seed, 0, by_cycles), 0.15 * contact_share) << each.words(seed);
  EXPECT_GT(by_cycles, contact_share) << "who counts cycles is mistaken, or this test finds nothing";
}

TEST(MissedCycles, AreNoPushFromOutsideThoughItsDeviceIsLateBesides) {
  double by_cycles = 0;
  for (const Pauses& each : loaded)
    for (unsigned seed = 1; seed <= 6; ++seed)
      EXPECT_LT(most_felt(each, seed, 20, by_cycles), 0.5 * contact_share) << each.words(seed);
}

/// Its device has let go meanwhile and braked, of which the sample behind the pause tells nothing.
TEST(MissedCycles, OfSoLongAPauseThatNobodyKnowsWhatActedInItAreNoPushEither) {
  for (const Pause where : {Pause::BeforeItCommands, Pause::BehindIt}) {
    Loop loop{4ms};
    loop.stand(0.2);
    loop.go(0.5);
    loop.stand(0.5);
    ASSERT_GT(loop.plant.measured().velocity.cwiseAbs().maxCoeff(), 0.5);
    loop.cycle(150ms, where);
    loop.pass(loop.planned - 10ms);
    loop.plant.place(loop.plant.measured().position);
    loop.answer = loop.plant.measured();
    for (int i = 0; i < 3; ++i) {
      loop.cycle();
      EXPECT_LT(loop.share(loop.observer), 0.1 * contact_share) << i;
    }
  }
}

/// By a filter of 1 / gain, whatever lies between two samples.
TEST(MissedCycles, WeighWhatActedInThemAsIfItHadBeenFeltInEach) {
  for (const Duration pause : {5ms, 20ms, 60ms})
    for (const Pause where : {Pause::BeforeItCommands, Pause::BehindIt}) {
      Loop loop{1ms};
      loop.stand(0.2);
      const double push = 0.2 * loop.bounds[1].effort;
      loop.outside[1] = push;
      const TimePoint begun = loop.planned;
      loop.cycle(pause, where);
      loop.cycle();
      loop.cycle();
      // The newest sample is of the cycle before.
      const double felt_s = seconds(loop.planned - begun) - 2 * loop.cycle_s;
      EXPECT_NEAR(loop.observer.external()[1], push * (1 - std::exp(-observer_gain_per_s * felt_s)), 0.1 * push)
          << seconds(pause);
    }
}

/// From when the world has it: how long until it counts, with what was missed meanwhile; s.
struct Felt {
  double after_s{0}, missed_s{0};
};
std::optional<Felt> felt(Pauses pauses, unsigned seed, double push_share, bool moves) {
  pauses.random.seed(seed);
  Loop loop{pauses.period};
  loop.stand(0.2);
  if (moves) loop.go(0.3);
  for (unsigned i = 0; i < 60 + seed; ++i) pauses.cycle(loop);
  const TimePoint begun = loop.world;
  const auto missed = loop.missed;
  // A pause that is under way when it begins is one in which it is missed, too.
  const double under_way_s = std::max(0.0, seconds(loop.planned - loop.world) - loop.cycle_s);
  loop.outside[1] = push_share * loop.bounds[1].effort;
  for (int i = 0, over = 0; i < 1000; ++i) {
    const TimePoint now = loop.planned;
    const auto missed_by_now = loop.missed - missed;
    pauses.cycle(loop);
    over = loop.share(loop.observer) > contact_share ? over + 1 : 0;
    if (over == contact_cycles)
      return Felt{seconds(now - begun), static_cast<double>(missed_by_now) * loop.cycle_s + under_way_s};
  }
  return std::nullopt;
}

TEST(MissedCycles, HaveARealPushFeltLaterByAsMuchAsWasMissedAndNoMore) {
  for (const Pauses& each : loaded)
    for (const bool moves : {false, true})
      for (const double push : {0.4, 0.8}) {
        const Pauses none{each.period, 1'000'000'000, 1};
        const auto before = felt(none, 1, push, moves);
        ASSERT_TRUE(before);
        for (unsigned seed = 1; seed <= 12; ++seed) {
          const auto now = felt(each, seed, push, moves);
          ASSERT_TRUE(now) << each.words(seed);
          // And a cycle, whose sample is judged with the next one, and one that it begins in.
          EXPECT_LE(now->after_s, before->after_s + now->missed_s + 2 * seconds(each.period)) << each.words(seed);
        }
      }
}

/// Each second one is missed, for ever: whoever waits for one that comes in time would feel nothing any more.
TEST(MissedCycles, ThatNeverEndLeaveNobodyUnfelt) {
  Loop loop{1ms};
  loop.stand(0.2);
  for (int i = 0; i < 200; ++i) loop.cycle(1500us, Pause::BeforeItCommands);
  EXPECT_LT(loop.share(loop.observer), 0.2 * contact_share);
  loop.outside[1] = 0.6 * loop.bounds[1].effort;
  for (int i = 0; i < 60; ++i) loop.cycle(1500us, Pause::BeforeItCommands);
  EXPECT_GT(loop.share(loop.observer), contact_share);
}

TEST(MissedCycles, ChangeNothingWhereThereAreNone) {
  Loop loop{1ms};
  loop.stand(0.1);
  loop.go();
  loop.outside[2] = 20;
  for (int i = 0; i < 500; ++i) {
    loop.cycle();
    ASSERT_EQ(loop.observer.external(), loop.by_cycles.external()) << "to the last bit";
  }
}

// --- when a sample is of --------------------------------------------------------------------------------------------------

TEST(SampleTime, OfWhatIsNewIsThatOfTheCycleBefore) {
  SampleTime time;
  const auto at = [](Duration since) { return TimePoint{} + 1s + since; };
  time.update(at(0ms), 4ms, true, false);
  EXPECT_EQ(time.between().s, 0);
  time.update(at(4ms), 4ms, false, true);
  EXPECT_EQ(time.between().s, 0.004) << "of the first one nobody knows more";
  time.update(at(8ms), 4ms, false, true);
  EXPECT_EQ(time.between().s, 0.004);
  EXPECT_FALSE(time.between().unsure);
  time.update(at(24ms), 4ms, false, true);
  EXPECT_EQ(time.between().s, 0.004) << "it answers what was commanded before the pause, or late in it";
  EXPECT_TRUE(time.between().unsure);
  EXPECT_EQ(time.missed_lately(), 3U);
  time.update(at(28ms), 4ms, false, true);
  EXPECT_EQ(time.between().s, 0.016);
  EXPECT_FALSE(time.between().unsure);
  time.update(at(32ms), 4ms, false, false);
  EXPECT_EQ(time.between().s, 0);
  time.update(at(36ms), 4ms, false, true);
  EXPECT_EQ(time.between().s, 0.008) << "one answer did not come";
}

TEST(SampleTime, CountsWhatWasMissedInTheLastHalfSecondAtLeastAndInTheLastSecondAtMost) {
  SampleTime time;
  TimePoint now{};
  const auto run = [&](Duration span) {
    for (Duration t{}; t < span; t += 1ms) time.update(now += 1ms, 1ms, false, true);
  };
  time.update(now, 1ms, true, true);
  run(700ms);
  EXPECT_EQ(time.missed_lately(), 0U);
  time.update(now += 6ms, 1ms, false, true);
  run(490ms);
  EXPECT_EQ(time.missed_lately(), 5U);
  time.update(now += 3ms, 1ms, false, true);
  EXPECT_EQ(time.missed_lately(), 7U);
  run(1000ms);
  EXPECT_EQ(time.missed_lately(), 0U);
  time.update(now += 10s, 1ms, true, true);
  EXPECT_EQ(time.missed_lately(), 0U) << "who is configured anew has missed nothing";
}

}  // namespace
}  // namespace hirosco::robot_arm
