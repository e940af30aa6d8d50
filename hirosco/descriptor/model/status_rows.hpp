// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/mission.hpp"

/// What the supervisor tells of everybody: a row for itself and each subsystem, a row for each link, as four structures of its
/// descriptor whose members are columns.
namespace hirosco::descriptor {

inline constexpr std::string_view subsystem_rows = "SUBSYSTEMS";
inline constexpr std::string_view link_rows = "LINK_STATUS";
inline constexpr std::string_view link_quality_rows = "LINK_QUALITY";
inline constexpr std::string_view link_latency_rows = "LINK_LATENCY";
/// Of either; as many as go into one telemetry packet are taken, whatever this says.
inline constexpr std::size_t most_status_rows = 128;

/// Of LINK_LATENCY, whose rows are long: links beyond these are not told there.
inline constexpr std::size_t most_latency_rows = 99;

/// Makes the columns as long as the mission needs. What the descriptor counts is the least, so that the reports of small
/// missions are of one length. Empty, or what does not fit.
[[nodiscard]] std::string give_everybody_a_row(Mission& mission);

}  // namespace hirosco::descriptor
