// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/driven.hpp"
#include "robotics/dynamics/model.hpp"

namespace hirosco::robot_arm::testing {

/// KEEP_OUT of a ball of 5 cm there, that no link comes near, and of nothing else.
inline void keep_out_ball(hirosco::testing::Driven& arm, const robotics::Vector3& there) {
  constexpr std::size_t volumes = 4, numbers_of_one = 7;
  std::vector<std::optional<Value>> numbers;
  for (const double number : {there.x(), there.y(), there.z(), there.x(), there.y(), there.z(), 0.05})
    numbers.emplace_back(number);
  numbers.resize(volumes * numbers_of_one, Value{0.0});
  const auto set = arm.rig.call_with("KEEP_OUT", numbers);
  arm.cycle(5);
  ASSERT_EQ(arm.rig.outcome(set), "1 3 7");
}

}  // namespace hirosco::robot_arm::testing
