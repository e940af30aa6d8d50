// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"

/// Turns the axis of the reference device as fast as it is told.
namespace {

using namespace hirosco;

class Turner final : public Subsystem {
  struct Sensed {
    double position;
    double velocity;
  };
  struct Driven {
    double velocity;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    use_device("AXIS", axis_);
    on_function("TURN", [this](double velocity) -> Result<> {
      wanted_ = velocity;
      return ok();
    });
    return done;
  }
  Result<> safe_operational(const Cycle&) noexcept override {
    wanted_ = 0;
    current_.store(axis_.input());
    return ok();
  }
  Result<> operational(const Cycle&) noexcept override {
    axis_.output().velocity = wanted_;
    current_.store(axis_.input());
    return ok();
  }

  Parameter<Sensed> current_;
  DevicePort<Sensed, Driven> axis_;
  double wanted_{0};
};

std::unique_ptr<Subsystem> make_turner() { return std::make_unique<Turner>(); }

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_turner>; }
