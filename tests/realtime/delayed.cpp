// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

#include "hirosco/utilities/os/clock.hpp"
#include "tests/stand_in.hpp"

/// MOVE_TO 2 makes two cycles in a row work for 5 ms each; MOVE_TO 0.5 lets one begin 5 ms late. For tests only.
namespace {

using namespace hirosco;

constexpr Duration injected = 5ms;
std::atomic<int> late_left{
    0};  ///< of cycles that are to begin late; the C library's sleep below has no object to look at

class Delayed final : public StandIn {
  void asked(double cycles) override {
    if (cycles >= 1) working_left_ = static_cast<int>(cycles);
    else late_left = 1;
  }

  Result<> operational(const Cycle&) noexcept override {
    if (working_left_ == 0) return ok();
    --working_left_;
    const TimePoint start = clock_.now();
    while (clock_.now() < start + injected) {}
    return ok();
  }

  SystemClock clock_;
  std::atomic<int> working_left_{0};
};

}  // namespace

/// In the place of the C library's, which the cycle alone calls with an absolute time (as wake_recorder.cpp).
extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left) {
  timespec at = *until;
  if ((flags & TIMER_ABSTIME) != 0 && late_left > 0) {
    --late_left;
    constexpr long second_ns = 1'000'000'000;
    at.tv_nsec += static_cast<long>(injected.count());
    if (at.tv_nsec >= second_ns) ++at.tv_sec, at.tv_nsec -= second_ns;
  }
  return ::syscall(SYS_clock_nanosleep, clock, flags, &at, left) == 0 ? 0 : errno;
}

int main(int argc, char** argv) { return hirosco::run_stand_in<Delayed>(argc, argv); }
