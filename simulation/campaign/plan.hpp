// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// What happens in one flight of the campaign, as text that can be read, edited and flown again. One action a line:
///   SECONDS VERB WORD...            what stands behind a '#' is a remark
/// and before the actions lines without a time:
///   seed N | mode NAME (to commission) | finale SECONDS (from when on all faults are over)
///   ends MODE... (in the first whose members all live, or else in the last, with those that do; by itself the one that is commissioned)
namespace hirosco::campaign {

/// Where the spacecraft's clock begins.
inline constexpr TimePoint start_of_flight{std::chrono::seconds{1}};

struct Action {
  Duration at{};  ///< since the start of the flight
  std::vector<std::string> words;  ///< the verb first
  std::string line;  ///< as written
};

struct FlightPlan {
  std::uint64_t seed{1};
  std::string mode;  ///< empty: that of the mission
  Duration finale{std::chrono::seconds{24}};
  std::vector<std::string> ends;  ///< modes
  std::vector<Action> actions;  ///< by time; of equal times as written
};

/// Malformed: `value` is the number of the line.
[[nodiscard]] Result<FlightPlan> read_plan(std::istream& text);
/// Malformed: not an even number of hexadecimal digits.
[[nodiscard]] Result<std::vector<std::byte>> octets_of_hex(std::string_view text);
[[nodiscard]] std::string hex_of(Octets octets);
[[nodiscard]] Result<std::uint64_t> number_of(std::string_view text);

}  // namespace hirosco::campaign
