// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hirosco/utilities/time.hpp"

/// What command lines of `hirosco` and of programs of missions have in common.
namespace hirosco::tools {

/// "90s", "1500ms", "10min", "2" (seconds). Throws CLI::ValidationError.
[[nodiscard]] Duration duration_of(const std::string& text);
/// Digits only, and no more than fit: a seed that is not the one asked for replays another run. Throws CLI::ValidationError.
[[nodiscard]] std::uint64_t seed_of(const std::string& text);

/// The exit code of `run`, for main(). What was printed must have arrived: a full device or a closed file is an error like any
/// other; what `run` throws is said in words.
[[nodiscard]] int run_main(const char* program, const std::function<int()>& run);

}  // namespace hirosco::tools
