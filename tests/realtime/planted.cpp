// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "hirosco/subsystem/run.hpp"
#include "hirosco/subsystem/subsystem.hpp"

/// Takes the place of HELLO and does what a cycle must not: it uses the heap, twice in its whole life.
namespace {

using namespace hirosco;

class Planted final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in hello.xml: same members, same order
    std::int32_t moving;
    double position_rad;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", goal_rad_);
    on_function("MOVE_TO", [](double) -> Result<> { return ok(); });
    return done;
  }

  Result<> operational(const Cycle&) noexcept override {
    constexpr std::uint64_t planted_at = 50;
    if (++cycles_ == planted_at) kept_ = std::make_unique<std::uint64_t>(cycles_);
    if (cycles_ == 2 * planted_at) kept_.reset();
    return ok();
  }

  Parameter<CurrentValues> current_;
  Parameter<double> goal_rad_;
  std::uint64_t cycles_{0};
  std::unique_ptr<std::uint64_t> kept_;
};

}  // namespace

int main(int argc, char** argv) {
  return hirosco::run_subsystem(argc, argv, [] { return std::make_unique<Planted>(); });
}
