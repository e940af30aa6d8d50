// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <vector>

#include "hirosco/utilities/time.hpp"

namespace hirosco::tools {

/// One `hirosco simulate --at "SECONDS DEVICE LINE"`.
struct Injection {
  Duration after{};    ///< since the begin of the flight
  std::string device;  ///< or "kill", or "tc"
  std::string line;    ///< what the device is told, who is killed, or the telecommand by its names
};

/// By their times, whatever their order in `texts`; those of one time stay in it. In words: which of them is none, or would come when a
/// flight of `run_for` is over.
[[nodiscard]] std::expected<std::vector<Injection>, std::string> plan_injections(const std::vector<std::string>& texts,
                                                                                 Duration run_for);

}  // namespace hirosco::tools
