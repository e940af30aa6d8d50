// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A slice of `hirosco report rokviss --corners`, and that the table can fail.
#include <iostream>

#include <gtest/gtest.h>

#include "missions/rokviss/scenarios/rokviss_corners.hpp"

namespace hirosco::simulation {
namespace {

const std::filesystem::path mission =
    std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions" / "rokviss" / "mission.xml";

TEST(RokvissCorners, StayWithinWhatTheDescriptorPromises) {
  const CornerTable table = fly_corners({.mission = mission, .one_in = 7});
  EXPECT_GT(table.corners.size(), 20U);
  EXPECT_EQ(table.beyond(), 0U) << table.text();
  // Who trips was stopped on the way to more: the milder limit comes first (adr 0048).
  EXPECT_GT(table.tripped(), 5U);
  EXPECT_LE(table.tripped() - table.tripping_harder(), 2U) << table.text();
}

TEST(RokvissCorners, AreBeyondItWhenTheLawKeepsToNoLimit) {
  const CornerTable table = fly_corners({.mission = mission, .planted_limit_n_m = 100, .one_in = 7});
  EXPECT_GT(table.beyond(), 5U) << table.text();
}

TEST(RokvissCorners, ArePromisedByRangesOfTheDescriptor) {
  const CornerTable table = fly_corners({.mission = mission, .one_in = 1000});
  for (const double promised :
       {table.promise.torque_n_m, table.promise.force_n, table.promise.speed_rad_s, table.promise.motor_n_m})
    EXPECT_GT(promised, 0);
}

TEST(RokvissCorners, DISABLED_AllOfThem) {
  const CornerTable table = fly_corners({.mission = mission});
  std::cout << table.text();
}

}  // namespace
}  // namespace hirosco::simulation
