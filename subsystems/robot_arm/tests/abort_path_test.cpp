// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// An arm that meets a post and is led out by its stored path, of a recovery plan (docs/adr/0199), on virtual time.
namespace hirosco {
namespace {

constexpr std::array last{0.6, 0.5, 1.2, -0.6, 0.7, 0.1};

struct AbortPathFlown : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    flown.emplace(simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/tests" /
                                              "abort.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  /// Of the joint that is farthest from the end of the path, as the world has it.
  [[nodiscard]] double off() {
    const std::string words = " " + flown->craft().device("arm")->truth();
    double most = 0;
    for (std::size_t i = 0; i < last.size(); ++i) {
      const std::string name = fmt::format(" q{}=", i + 1);
      const auto at = words.find(name);
      const double q = at == words.npos ? HUGE_VAL : std::atof(words.c_str() + at + name.size());
      most = std::max(most, std::abs(q - last.at(i)));
    }
    return most;
  }
};

TEST_F(AbortPathFlown, IsAStepOfAPlanThatLeadsTheArmAwayFromWhatItMet) {
  const auto checked = flown->craft().command("ARM", "CHECK_ABORT", {}, 5s);
  EXPECT_TRUE(checked.completed) << flown->story().text();
  const auto outcome = flown->craft().command("ARM", "MOVE_J", {-0.8, -0.2, 0.6, 0.5, -0.5, 1.0, 0.2}, 70s);
  ASSERT_TRUE(outcome.failure) << flown->story().text();
  EXPECT_EQ(static_cast<std::uint16_t>(*outcome.failure), 0x8004) << flown->story().text();
  flown->craft().run(8s);
  EXPECT_EQ(flown->story().missing_in_order({"CONTACT JOINT", "MOVE_ABORT 0.5 because of CONTACT", "MOTION_DONE"}), "")
      << flown->story().text();
  EXPECT_LT(off(), 2e-3);
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_EQ(flown->inhibited("ARM"), 0U);
}

}  // namespace
}  // namespace hirosco
