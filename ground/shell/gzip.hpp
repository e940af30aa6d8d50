// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Answers as gzip (RFC 1952): what the API tells is text with much that repeats, and a tunnel is slow.
namespace hirosco::ground {

/// Shorter answers are not worth it; longer ones would keep everybody else waiting while they are compressed.
inline constexpr std::size_t least_zipped_octets = 1024;
inline constexpr std::size_t most_zipped_octets = std::size_t{1} << 20;

/// The text compressed; empty where that is not worth it. Takes about 10 ms for 1 MiB.
[[nodiscard]] std::optional<std::string> zipped(std::string_view text);

/// Whether a browser with this Accept-Encoding takes gzip: listed, and not with a weight of 0.
[[nodiscard]] bool takes_gzip(std::string_view accepts);

}  // namespace hirosco::ground
