// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <memory>

#include "hirosco/subsystem/run.hpp"
#include "hirosco/subsystem/subsystem.hpp"

/// Takes the place of HELLO; MOVE_TO makes that many cycles work for longer than their period.
namespace {

using namespace hirosco;

class Overrunning final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in hello.xml: same members, same order
    std::int32_t moving;
    double position_rad;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", goal_rad_);
    on_function("MOVE_TO", [this](double cycles) -> Result<> {
      left_ = static_cast<int>(cycles);
      return ok();
    });
    return done;
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    if (left_ == 0) return ok();
    --left_;
    const auto end = std::chrono::steady_clock::now() + 3 * cycle.period / 2;
    while (std::chrono::steady_clock::now() < end) {}
    return ok();
  }

  Parameter<CurrentValues> current_;
  Parameter<double> goal_rad_;
  std::atomic<int> left_{0};
};

}  // namespace

int main(int argc, char** argv) {
  return hirosco::run_subsystem(argc, argv, [] { return std::make_unique<Overrunning>(); });
}
