// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hirosco {

/// A word that a program understands, and what stands behind it ("FILE"); empty: nothing does.
struct ProgramOption {
  std::string_view name;
  std::string_view value{};
};

/// One of them as it was said; both are words of main().
struct GivenOption {
  std::string_view name;
  std::string_view value;
};

/// What was said to a program that other programs start, in order and as often as it was said. Otherwise why it is not what anybody meant, and
/// what there is, in words for one line: an option that is not `known`, one without its value (another option is none), a word that belongs to
/// no option.  Realtime: allocates.
[[nodiscard]] std::expected<std::vector<GivenOption>, std::string> given_options(int argc, const char* const* argv,
                                                                                 std::span<const ProgramOption> known);

}  // namespace hirosco
