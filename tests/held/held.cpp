// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <sys/eventfd.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "hirosco/resource/pool_resource.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/process/run.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

/// Stays in each transient state until it is told, so that somebody outside has the time to look at it there. SIGUSR1: from now on it does so,
/// or no more; SIGUSR2: the state that it is in is done. It takes a descriptor in each of the two states of the way up and gives it back in its
/// counterpart on the way down, a container in its pool with that of Software-Init, and wants its device to turn all the time.
namespace {

using namespace hirosco;

std::atomic<bool> holds{false};
std::atomic<int> told{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

struct HoldingSignals {
  HoldingSignals() {
    struct sigaction action{};
    action.sa_handler = [](int) { holds.store(!holds.load()); };
    ::sigaction(SIGUSR1, &action, nullptr);
    action.sa_handler = [](int) { told.fetch_add(1); };
    ::sigaction(SIGUSR2, &action, nullptr);
  }
} const holding_signals;

[[nodiscard]] bool stays() noexcept {
  if (!holds.load()) return false;
  int left = told.load();
  while (left > 0 && !told.compare_exchange_weak(left, left - 1)) {}
  return left <= 0;
}

[[nodiscard]] FileDescriptor taken() { return FileDescriptor{::eventfd(0, EFD_CLOEXEC)}; }

class Held final : public Subsystem {
  struct Turned {
    double angle_rad;
  };
  struct Turn {
    double rate_rad_per_s;
  };

  Result<Step> software_init() override {
    if (stays()) return again;
    publish("ANGLE", angle_);
    use_device("AXIS", axis_);
    of_software_ = taken();
    numbers_.emplace(std::size_t{100}, &resources());
    return done;
  }
  Result<Step> hardware_init() override {
    if (stays()) return again;
    of_hardware_ = taken();
    return done;
  }
  Result<Step> hardware_deinit() override {
    if (stays()) return again;
    of_hardware_ = {};
    return done;
  }
  Result<Step> software_deinit() override {
    if (stays()) return again;
    of_software_ = {};
    numbers_.reset();
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return turn(); }
  Result<> safe_operational(const Cycle&) noexcept override { return turn(); }
  Result<> operational(const Cycle&) noexcept override { return turn(); }

  Result<> turn() noexcept {
    constexpr double rate_rad_per_s = 0.1;
    axis_.output().rate_rad_per_s = rate_rad_per_s;
    angle_.store(axis_.input().angle_rad);
    return ok();
  }

  Parameter<double> angle_;
  DevicePort<Turned, Turn> axis_;
  FileDescriptor of_software_, of_hardware_;
  std::optional<std::pmr::vector<double>> numbers_;
};

}  // namespace

int main(int argc, char** argv) { return hirosco::run<Held>(argc, argv); }
