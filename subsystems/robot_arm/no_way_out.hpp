// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::robot_arm {

/// Why an arm, on whatever base, is not let out (docs/adr/0199, 0209); each has failure codes of its own for it. In words that live as long as the program, or as the shapes of
/// whose names they are.
struct NoWayOut {
  enum class Why : std::uint8_t {
    NoPath,  ///< none is stored, or it came by no way
    OutOfRange,
    TooNear,
    TooSlow,  ///< to go there, or to judge it, takes longer than it may
  };
  Why why{};
  const char* text{""};
  std::int64_t number{0};
};

/// Of who is TooSlow, and s.
inline constexpr const char* would_last = "it would take longer, s";

}  // namespace hirosco::robot_arm
