// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/process/run.hpp"

namespace hirosco {

/// Takes the place of HELLO in a flight, under its descriptor; what it does in a cycle is the test's.
class StandIn : public Subsystem {
 protected:
  /// MOVE_TO of ground. Thread: service loop.
  virtual void asked(double /*argument*/) {}

 private:
  struct CurrentValues {  // CUR_VALUES in hello.xml: same members, same order
    std::int32_t moving;
    double position_rad;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", goal_rad_);
    on_function("MOVE_TO", [this](double argument) -> Result<> {
      asked(argument);
      return ok();
    });
    return done;
  }

  Parameter<CurrentValues> current_;
  Parameter<double> goal_rad_;
};

/// main() of a program that stands in.
template <typename Author>
int run_stand_in(int argc, char** argv) {
  return run_subsystem(argc, argv, [] { return std::make_unique<Author>(); });
}

}  // namespace hirosco
