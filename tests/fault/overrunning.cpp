// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>

#include "tests/stand_in.hpp"

/// MOVE_TO makes that many cycles work for longer than their period.
namespace {

using namespace hirosco;

class Overrunning final : public StandIn {
  void asked(double cycles) override { left_ = static_cast<int>(cycles); }

  Result<> operational(const Cycle& cycle) noexcept override {
    if (left_ == 0) return ok();
    --left_;
    const auto end = std::chrono::steady_clock::now() + 3 * cycle.period / 2;
    while (std::chrono::steady_clock::now() < end) {}
    return ok();
  }

  std::atomic<int> left_{0};
};

}  // namespace

int main(int argc, char** argv) { return hirosco::run_stand_in<Overrunning>(argc, argv); }
