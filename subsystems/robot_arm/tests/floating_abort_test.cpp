// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// A floating arm that is stopped before a volume and led out by its stored path, of a recovery plan (docs/adr/0209), on virtual time.
namespace hirosco {
namespace {

constexpr std::array way_out_end{0.0, 0.75, -0.3, -1.25, -0.05, 1.85, 0.0};

struct FloatingAbortFlown : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    flown.emplace(simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/tests" /
                                              "floating_abort.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  /// Of the joint that is farthest from the end of the path, as the world has it.
  [[nodiscard]] double off() {
    const std::string words = " " + flown->craft().device("arm")->truth();
    double most = 0;
    for (std::size_t i = 0; i < way_out_end.size(); ++i) {
      const std::string name = fmt::format(" q{}=", i + 1);
      const auto at = words.find(name);
      const double q = at == words.npos ? HUGE_VAL : std::atof(words.c_str() + at + name.size());
      most = std::max(most, std::abs(q - way_out_end.at(i)));
    }
    return most;
  }
};

/// The tool swings about the base's axis z; the ball is where it would be with 0.8 rad at the first joint, and is told of when it is under way.
TEST_F(FloatingAbortFlown, IsAStepOfAPlanThatLeadsTheArmOutOnceItStands) {
  EXPECT_TRUE(flown->craft().command("MCS", "CHECK_ABORT", {}, 5s).completed) << flown->story().text();
  const auto begun = flown->craft().command("MCS", "MOVE_JOINT", {1.0, 0.75, -0.3, -1.25, -0.05, 1.85, 0.0, 20.0}, 3s);
  ASSERT_TRUE(begun.started) << flown->story().text();
  std::vector<Value> volumes(28, Value{0.0});
  constexpr std::array ball{0.783, 0.622, 2.602, 0.783, 0.622, 2.602, 0.05};
  std::ranges::copy(ball, volumes.begin());
  ASSERT_TRUE(flown->craft().command("MCS", "KEEP_OUT", volumes, 2s).completed) << flown->story().text();
  flown->craft().run(30s);
  EXPECT_EQ(
      flown->story().missing_in_order({"TOO_NEAR", "MOVE_ABORT 0.5 within 60 s because of TOO_NEAR", "MOTION_DONE"}),
      "")
      << flown->story().text();
  EXPECT_LT(off(), 2e-3);
  EXPECT_EQ(flown->state("MCS"), State::Operational);
  EXPECT_EQ(flown->inhibited("MCS"), 0U);
}

}  // namespace
}  // namespace hirosco
