// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <expected>
#include <string>
#include <string_view>

namespace hirosco::tools {

/// What the lock of a flight says in one line, "PID MILLISECONDS MISSION VERSION": `hirosco safe` reads no descriptor, and may be of another
/// build than the flight.
struct FlightLock {
  static constexpr unsigned version = 1;
  int keeper{0};  ///< its process
  std::chrono::milliseconds limit{0};  ///< how long the answer to a stop may take
  std::string mission;
};
[[nodiscard]] std::string lock_text(const FlightLock& lock);
/// In words why it cannot be gone by. A lock without a version, as flights before docs/adr/0167 have it, is of the first.
[[nodiscard]] std::expected<FlightLock, std::string> lock_from_text(std::string_view text);

}  // namespace hirosco::tools
