// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// Somebody else comes to the arm, or the arm to something that it was not told of: when its world has them touch first, when the arm says so, and
/// how hard they press in between. The world is MuJoCo's, and the arm's observer knows of it what its sensors tell.
namespace hirosco {
namespace {

/// When it was, on virtual time, and how hard: of the world, looked at in each of the arm's cycles.
struct Met {
  std::optional<TimePoint> touched, told;
  double told_n{0}, peak_n{0};

  [[nodiscard]] double delay_ms() const { return touched && told ? 1e3 * seconds(*told - *touched) : NAN; }
};

struct ContactFromOutside : ::testing::Test {
  static constexpr std::uint16_t contact_event = 1025;
  static constexpr std::uint8_t events = 5;
  /// The reaction Stop, and limits in shares of each joint's effort: the default, and half of it for who stands.
  static constexpr std::uint8_t stops = 1;
  static constexpr double limit = 0.3, limit_at_rest = 0.15;

  std::optional<simulation::Flight> flown;
  Met met;

  void fly(double share, const std::vector<std::string>& world = {}) {
    met = {};
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/six_joints/mission.xml",
                         .subsystems = {},
                         .devices = {}});
    // As its file says, so that what it finds is from outside.
    for (const char* line : {"mass 1", "friction 1"}) ASSERT_TRUE(arm().fault(line));
    for (const std::string& line : world) does(line);
    ASSERT_TRUE(flown->commission()) << flown->story().text();
    ASSERT_TRUE(flown->craft().command("ARM", "SET_CONTACT", {stops, share}).completed) << flown->story().text();
    flown->craft().run(500ms);
    ASSERT_FALSE(flown->story().has("CONTACT JOINT")) << "nobody is there yet";
    watch();
  }
  void watch() {
    flown->craft().on_cycle([this](std::string_view, TimePoint now) {
      const double force_n = truth("contact_n");
      if (!met.touched && truth("contacts") > 0) met.touched = now;
      if (!met.told) met.told_n = std::max(met.told_n, force_n);
      met.peak_n = std::max(met.peak_n, force_n);
    });
    const ManualClock begin;
    const OnboardTime zero = begin.onboard() - begin.now().time_since_epoch();
    flown->story().on_telemetry = [this, zero](const pus::TelemetryView& report) {
      if (met.told || report.service() != events) return;
      OctetReader reader{report.source_data()};
      if (reader.get<std::uint16_t>() == contact_event) met.told = TimePoint{report.time() - zero};
    };
  }
  simulation::SimulatedDevice& arm() { return *flown->craft().device("arm"); }
  void does(const std::string& line) {
    const auto taken = arm().fault(line);
    ASSERT_TRUE(taken) << line << ": " << taken.error().text;
  }
  double truth(const std::string& name) {
    const std::string words = " " + arm().truth();
    const auto at = words.find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 2);
  }
  void judge(const std::string& what) {
    ASSERT_TRUE(met.touched) << what << ": the world has them touch";
    ASSERT_TRUE(met.told) << what << ": the arm says so\n" << flown->story().text();
    std::cout << fmt::format(
        "  {:<34} CONTACT {:5.1f} ms after the first touch, {:5.1f} N at most until then, peak {:5.1f} N\n", what,
        met.delay_ms(), met.told_n, met.peak_n);
    EXPECT_GT(met.delay_ms(), 0) << what << ": it knows nothing before they touch";
    // Its observer's 20 ms, the cycles that it has to last, and the service loop that tells.
    EXPECT_LT(met.delay_ms(), 100) << what;
    EXPECT_GT(met.told_n, 0) << what;
    EXPECT_GE(met.peak_n, met.told_n) << what;
  }
};

/// A ball on its way to the middle of the forearm, across it, from aside and level: 95 mm from the forearm's axis they touch.
struct Ball {
  static constexpr std::array middle_m{0.50248, 0.11206, 0.41787}, across{-0.19867, 0.98007, 0.0};
  static constexpr double radius_m = 0.05, touches_m = 0.045 + radius_m;
  double mass_kg{0};
  double force_n{0};  ///< that brings it there and goes on pressing
  double ahead_m{0};

  [[nodiscard]] double speed_m_s() const { return std::sqrt(2 * force_n * ahead_m / mass_kg); }
  [[nodiscard]] std::string laid() const {
    const double away = touches_m + ahead_m;
    return fmt::format("body_ball sphere {} {} {:.6f},{:.6f},{:.6f} 0.1", radius_m, mass_kg,
                       middle_m[0] - across[0] * away, middle_m[1] - across[1] * away, middle_m[2]);
  }
  /// Held against gravity besides.
  [[nodiscard]] std::string pulled() const {
    return fmt::format("pull_ball {:.4f} {:.4f} {:.4f}", force_n * across[0], force_n * across[1], 9.81 * mass_kg);
  }
};

TEST_F(ContactFromOutside, OfABodyThatLeansOnTheArmOrStrikesItIsToldAndItsForceIsPrinted) {
  constexpr std::array balls{Ball{.mass_kg = 5, .force_n = 100, .ahead_m = 0.001},
                             Ball{.mass_kg = 2, .force_n = 60, .ahead_m = 0.003},
                             Ball{.mass_kg = 2, .force_n = 60, .ahead_m = 0.01}};
  for (const Ball& ball : balls) {
    ASSERT_NO_FATAL_FAILURE(fly(limit_at_rest));
    does(ball.laid());
    does(ball.pulled());
    flown->craft().run(400ms);
    ASSERT_NO_FATAL_FAILURE(
        judge(fmt::format("a ball of {:g} kg with {:.2f} m/s, {:g} N", ball.mass_kg, ball.speed_m_s(), ball.force_n)));
    EXPECT_GE(met.peak_n, 0.8 * ball.force_n) << "it goes on pressing";
    EXPECT_TRUE(flown->story().has("CONTACT JOINT=turn")) << flown->story().text();
    does("body_ball none");
    flown->craft().run(200ms);
    EXPECT_EQ(truth("contacts"), 0);
    EXPECT_EQ(flown->state("ARM"), State::Operational);
  }
}

TEST_F(ContactFromOutside, OfAPostThatTheArmMeetsOnItsWayIsToldAndItsForceIsPrinted) {
  ASSERT_NO_FATAL_FAILURE(fly(limit, {"obstacle_post cylinder 0.05,1.6 0.5,-0.15,0.8 0.5"}));
  const auto outcome = flown->craft().command("ARM", "MOVE_J", {-0.8, -0.2, 0.6, 0.5, -0.5, 1.0, 0.2}, 70s);
  EXPECT_EQ(static_cast<std::uint16_t>(outcome.failure.value()), 0x8004) << flown->story().text();
  flown->craft().run(300ms);
  judge("a post, at a fifth of its speed");
}

/// What is told is no contact of the world's: a push has none.
TEST_F(ContactFromOutside, IsToldOfAPushWithoutATouchTooAndThenNothingIsToBeMeasured) {
  ASSERT_NO_FATAL_FAILURE(fly(limit_at_rest));
  does("push 0 80 0");
  flown->craft().run(300ms);
  EXPECT_TRUE(met.told) << flown->story().text();
  EXPECT_FALSE(met.touched);
  EXPECT_TRUE(std::isnan(met.delay_ms()));
}

}  // namespace
}  // namespace hirosco
