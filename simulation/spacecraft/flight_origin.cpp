// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/flight_origin.hpp"

#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hirosco/utilities/version.hpp"

namespace hirosco::simulation {
namespace {

#if defined(__x86_64__)
constexpr const char* architecture = "x86_64";
#elif defined(__aarch64__)
constexpr const char* architecture = "aarch64";
#elif defined(__riscv) && __riscv_xlen == 64
constexpr const char* architecture = "riscv64";
#elif defined(__s390x__)
constexpr const char* architecture = "s390x";
#else
constexpr const char* architecture = "another";
#endif

/// Sines and exponentials are its own, and not the same in all versions.
[[nodiscard]] std::string c_library() {
#ifdef __GLIBC__
  return fmt::format("glibc-{}", gnu_get_libc_version());
#else
  return "another";
#endif
}

}  // namespace

std::string origin_of(const descriptor::Mission& mission, Spacecraft& craft, std::uint64_t seed) {
  std::set<std::string> engines;
  for (const auto& described : mission.devices)
    if (const auto* device = craft.device(described.name); device != nullptr && !device->engine().empty())
      engines.insert(device->engine());
  return fmt::format("hirosco={} architecture={} c_library={} engines={} mission={} seed={}", version, architecture,
                     c_library(), engines.empty() ? "none" : fmt::format("{}", fmt::join(engines, ",")), mission.name,
                     seed);
}

}  // namespace hirosco::simulation
