// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "hirosco/subsystem/author/module.hpp"

/// The next version of one that a mission flies: it turns as fast as it is told, reports that, and tells when it is told so. What it has more
/// comes with its descriptor, in flight (docs/adr/0214).
namespace hirosco {
namespace {

class WithMore final : public Subsystem {
  struct CurrentValues {
    std::int32_t moving;
    double position_rad;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", goal_rad_);
    publish("SPEED", speed_rad_per_s_);
    use_event(speed_set_);
    on_function("MOVE_TO", [this](double goal_rad) -> Result<> {
      goal_rad_.store(goal_rad);
      return ok();
    });
    on_function("TURN_AT", [this](double speed_rad_per_s) -> Result<> {
      speed_rad_per_s_.store(speed_rad_per_s);
      raise(speed_set_, speed_rad_per_s);
      return ok();
    });
    return done;
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    const double step_rad = speed_rad_per_s_.load() * seconds(cycle.period);
    auto current = current_.load();
    const double error_rad = goal_rad_.load() - current.position_rad;
    current.moving = std::abs(error_rad) > step_rad;
    current.position_rad += std::clamp(error_rad, -step_rad, step_rad);
    current_.store(current);
    return ok();
  }

  Parameter<CurrentValues> current_;
  Parameter<double> goal_rad_;
  Parameter<double> speed_rad_per_s_;
  Event<double> speed_set_{"SPEED_SET"};
};

std::unique_ptr<Subsystem> make_with_more() { return std::make_unique<WithMore>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_with_more>; }
