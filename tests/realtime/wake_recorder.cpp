// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>

/// How late a real subsystem's cycle is woken, in bins of a microsecond: in memory of its own, where a test looks for it by way of
/// /proc. It stands before the C library's sleep, which the cycle alone calls with an absolute time. For tests only.
namespace {

constexpr std::size_t bins = 20'000;  ///< the last one has all that is later

std::uint32_t* make_record() {
  const int file = ::memfd_create("wake-record", MFD_CLOEXEC);
  if (file < 0 || ::ftruncate(file, bins * sizeof(std::uint32_t)) != 0) return nullptr;
  void* const at =
      ::mmap(nullptr, bins * sizeof(std::uint32_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
  return at == MAP_FAILED ? nullptr : static_cast<std::uint32_t*>(at);
}

std::uint32_t* const record = make_record();

}  // namespace

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left) {
  const long result = ::syscall(SYS_clock_nanosleep, clock, flags, until, left);
  if (result != 0) return errno;
  if ((flags & TIMER_ABSTIME) == 0 || record == nullptr) return 0;
  timespec now{};
  ::clock_gettime(clock, &now);
  constexpr std::int64_t second = 1'000'000'000;
  const std::int64_t late_ns = (now.tv_sec - until->tv_sec) * second + now.tv_nsec - until->tv_nsec;
  const auto bin = static_cast<std::size_t>(std::clamp<std::int64_t>(late_ns / 1000, 0, bins - 1));
  __atomic_fetch_add(&record[bin], 1U, __ATOMIC_RELAXED);
  return 0;
}
