// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "supervisor/guard/safe_answer.hpp"

namespace hirosco::tools {

/// How a guard answered who asked it for a stop of everything.
struct HeardSafe {
  supervisor::SafeAnswer::Stop stop{supervisor::SafeAnswer::Stop::Nobody};
  std::string why_not_whole;  ///< somebody may be missing in what was said; empty: nobody is, or nothing was said
};

/// Hears a guard on a connection of SOCK_SEQPACKET until it has ended, or `limit`. `print` has the words of each line.
[[nodiscard]] HeardSafe hear_safe(int socket, std::chrono::steady_clock::time_point limit,
                                  const std::function<void(std::string_view)>& print);

}  // namespace hirosco::tools
