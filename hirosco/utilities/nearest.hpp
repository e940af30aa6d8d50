// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace hirosco {

/// The name that somebody who wrote `text` may have meant: fewest letters changed, left out, added or swapped with their neighbour, a third
/// of them at most; upper and lower case are equal. Empty: none is near. Of words up to 32 octets and the first 2,000 candidates,
/// which bounds its time.  Realtime: allocates.
[[nodiscard]] std::string_view nearest(std::string_view text, std::span<const std::string_view> candidates);

}  // namespace hirosco
