// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/script.hpp"

#include <gtest/gtest.h>

namespace hirosco::manipulator::two_joint {
namespace {

constexpr double script_cycle_s = 0.0005;
const Joints home_rad{-0.8, 1.6};

TEST(Script, NeverJumpsAndMovesAlongTheContourAtItsSpeed) {
  Script script{Geometry{}};
  const Point home = tip({}, home_rad);
  script.start(Script::Id::Contour, home_rad, home_rad, {});
  Point last = home;
  double fastest_along_m_s = 0;
  while (!script.done()) {
    const bool along = script.leg() == 2;
    const Point at = script.advance_tip(script_cycle_s);
    EXPECT_LT(std::hypot(at[0] - last[0], at[1] - last[1]) / script_cycle_s, 0.15);
    if (along) fastest_along_m_s = std::max(fastest_along_m_s, (at[1] - last[1]) / script_cycle_s);
    last = at;
  }
  EXPECT_NEAR(std::hypot(last[0] - home[0], last[1] - home[1]), 0, 1e-12) << "it ends at home";
  EXPECT_NEAR(fastest_along_m_s, 0.020, 0.020 * 0.25) << "along the rail; the finger's centre gains on the flanks";
}

TEST(Script, HooksTheSpringAtItsSlackEndAndReleasesItThere) {
  Script script{Geometry{}};
  const Point slack_end = springs[0].slack_end_m;
  const Joints there = joints_for({}, slack_end);
  script.start(Script::Id::Spring, there, there, {});
  for (const std::uint8_t wanted : {std::uint8_t{1}, std::uint8_t{0}}) {
    for (int k = 0; k < 100'000; ++k) (void)script.advance(script_cycle_s);
    EXPECT_EQ(script.tool(), wanted);
    EXPECT_NEAR(distance_to_spring(1, tip({}, script.advance(script_cycle_s))), 0, 1e-12);
    script.tool_done();
  }
  for (int k = 0; k < 100'000; ++k) (void)script.advance(script_cycle_s);
  EXPECT_TRUE(script.done());
}

}  // namespace
}  // namespace hirosco::manipulator::two_joint
