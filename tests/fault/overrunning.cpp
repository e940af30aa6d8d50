// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "hirosco/utilities/os/clock.hpp"
#include "tests/stand_in.hpp"

/// MOVE_TO makes that many cycles work for longer than their period; one that began late, which is no part of a row, does so
/// beside them.
namespace {

using namespace hirosco;

class Overrunning final : public StandIn {
  void asked(double cycles) override { left_ = static_cast<int>(cycles); }

  Result<> operational(const Cycle& cycle) noexcept override {
    if (left_ == 0) return ok();
    const TimePoint start = clock_.now();
    if (start - cycle.planned <= cycle.period) --left_;
    while (clock_.now() < start + 3 * cycle.period / 2) {}
    return ok();
  }

  SystemClock clock_;
  std::atomic<int> left_{0};
};

}  // namespace

int main(int argc, char** argv) { return hirosco::run_stand_in<Overrunning>(argc, argv); }
