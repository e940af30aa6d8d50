// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ground/archive/archive.hpp"

/// What happened in a span of time, as lists of the archive's rows.
namespace hirosco::ground {

/// Of one kind in one answer, of too many the newest.
inline constexpr std::size_t most_rows = 10'000;

/// Modes, states, links, commands, events, faults and gaps, oldest first.
[[nodiscard]] nlohmann::json timeline_json(Archive& archive, const Span& span);
/// {events}, newest first.
[[nodiscard]] nlohmann::json events_json(Archive& archive, const Archive::Filter& filter);
/// {commands}, newest first, each with its reports.
[[nodiscard]] nlohmann::json commands_json(Archive& archive, const Archive::Filter& filter);
[[nodiscard]] nlohmann::json gaps_json(const std::vector<StoredGap>& gaps);

}  // namespace hirosco::ground
