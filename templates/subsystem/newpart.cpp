// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "newpart.hpp"

#include <algorithm>
#include <cmath>
#include <hirosco/subsystem/author/module.hpp>
#include <optional>

namespace {

using namespace hirosco;

/// A value that goes to where it is told, by as much in a second as RATE says.
class NewPart final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in newpart.xml: the same members in the same order
    double value;
    double goal;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("RATE", rate_per_s_);
    use_event(arrived_);
    on_function("GO_TO", [this](double goal, Call call) -> Outcome {
      if (going_) abort(*going_, {ErrorCode::NotPermitted, "another goal took over"});
      going_ = call;
      goal_ = goal;
      return running;
    });
    return done;
  }

  /// The cycle: it neither waits nor allocates.
  Result<> operational(const Cycle& cycle) noexcept override {
    const double step = rate_per_s_.load() * seconds(cycle.period);
    value_ += std::clamp(goal_ - value_, -step, step);
    current_.store({value_, goal_});
    if (!going_ || value_ != goal_) return ok();
    finish(*going_);
    going_.reset();
    raise(arrived_, value_);
    return ok();
  }

  Parameter<CurrentValues> current_;
  Parameter<double> rate_per_s_;
  Event<double> arrived_{"ARRIVED"};
  std::optional<Call> going_;  // the telecommand that is being carried out
  double value_{0};
  double goal_{0};
};

}  // namespace

std::unique_ptr<Subsystem> make_newpart() { return std::make_unique<NewPart>(); }

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_newpart>; }
