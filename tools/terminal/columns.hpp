// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text in columns of a terminal: a wide character takes two, one that combines none. All takes UTF-8; what is none, steers a terminal
/// or has no width that the C library knows is a '?'.
namespace hirosco::terminal {

[[nodiscard]] std::size_t width_of(std::string_view text);
/// At most `width` columns; what does not fit is left out, and the last column says so with a '…'.
[[nodiscard]] std::string cut(std::string_view text, std::size_t width);
/// Exactly `width` columns: cut, or with spaces behind; or before it.
[[nodiscard]] std::string left(std::string_view text, std::size_t width);
[[nodiscard]] std::string right(std::string_view text, std::size_t width);
/// The same columns in ASCII, for a terminal that takes nothing else.
[[nodiscard]] std::string ascii(std::string_view text);

}  // namespace hirosco::terminal
