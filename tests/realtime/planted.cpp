// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <mutex>

#include "tests/stand_in.hpp"

/// Does what a cycle must not: it uses the heap twice in its whole life, locks once and prints once.
namespace {

using namespace hirosco;

class Planted final : public StandIn {
  Result<> operational(const Cycle&) noexcept override {
    constexpr std::uint64_t planted_at = 50;
    if (++cycles_ == planted_at) kept_ = std::make_unique<std::uint64_t>(cycles_);
    if (cycles_ == 2 * planted_at) kept_.reset();
    if (cycles_ == 3 * planted_at) const std::lock_guard held{mutex_};
    if (cycles_ == 4 * planted_at) static_cast<void>(std::fputs("planted\n", stderr));
    return ok();
  }

  std::uint64_t cycles_{0};
  std::unique_ptr<std::uint64_t> kept_;
  std::mutex mutex_;
};

}  // namespace

int main(int argc, char** argv) { return hirosco::run_stand_in<Planted>(argc, argv); }
