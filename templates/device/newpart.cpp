// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "newpart.hpp"

#include <hirosco/subsystem/author/module.hpp>

namespace {

using namespace hirosco;

/// Heats a plate to the temperature that it is told: a proportional law.
class NewPart final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in newpart.xml: the same members in the same order
    double temperature_k;
    double power_w;
  };
  struct Sensors {  // <Input> of the device
    double temperature_k;
  };
  struct Commands {  // its <Output>
    double power_w;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("GOAL", goal_k_);
    use_device("NEWPART", plate_);
    return done;
  }

  /// The cycle: it neither waits nor allocates. What it puts out is brought into the range that the descriptor gives it.
  Result<> operational(const Cycle&) noexcept override {
    const double now_k = plate_.input().temperature_k;
    plate_.output().power_w = gain_w_per_k * (goal_k_.load() - now_k);
    current_.store({now_k, plate_.output().power_w});
    return ok();
  }

  static constexpr double gain_w_per_k = 5;
  Parameter<CurrentValues> current_;
  Parameter<double> goal_k_;
  DevicePort<Sensors, Commands> plate_;
};

}  // namespace

std::unique_ptr<Subsystem> make_newpart() { return std::make_unique<NewPart>(); }

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_newpart>; }
