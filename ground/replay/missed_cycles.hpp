// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"

namespace hirosco::ground {

/// How many cycles a subsystem missed around an instant, from a second before it until the next word of the supervisor's housekeeping, at most half a
/// second later; 0 where that tells nothing.
[[nodiscard]] std::uint32_t missed_around(const Catalogue& catalogue, Archive& archive, std::string_view subsystem,
                                          OnboardTime t);

/// In the chain of causes: "DRILL missed 35 cycles around it".
[[nodiscard]] std::string missed_words(std::string_view subsystem, std::uint32_t missed);
/// What to do where a device was lost beside them: who did not run answers late, and the device lets go by itself. `up`: the mode to bring up.
[[nodiscard]] std::string advice_for_missed(std::string_view device, std::uint32_t missed,
                                            const std::optional<std::string>& up);

}  // namespace hirosco::ground
