// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The smallest useful subsystem: one virtual joint that creeps towards its goal.
#include "subsystems/hello/hello.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco {
namespace {

class Hello final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in hello.xml: same members, same order
    std::int32_t moving;
    double position_rad;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", goal_rad_);
    on_function("MOVE_TO", [this](double goal_rad) -> Result<> {
      if (std::abs(goal_rad) > max_goal_rad) return fail(ErrorCode::OutOfRange, "joint limit");
      goal_rad_.store(goal_rad);
      return ok();
    });
    return done;
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    const double step_rad = speed_rad_per_s * seconds(cycle.period);
    auto current = current_.load();
    const double error_rad = goal_rad_.load() - current.position_rad;
    current.moving = std::abs(error_rad) > step_rad;
    current.position_rad += std::clamp(error_rad, -step_rad, step_rad);
    current_.store(current);
    return ok();
  }

  static constexpr double max_goal_rad = 1.57;
  static constexpr double speed_rad_per_s = 0.2;
  Parameter<CurrentValues> current_;
  Parameter<double> goal_rad_;
};

}  // namespace

std::unique_ptr<Subsystem> make_hello() { return std::make_unique<Hello>(); }

}  // namespace hirosco
