// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "hirosco/utilities/time.hpp"

/// The story of a stop (ground/replay/story.hpp) as `hirosco why` prints it: the sentences are those of the page.
namespace hirosco::ground {

/// For whom it is written.
enum class WhyStyle : std::uint8_t {
  Lines,     ///< a person at a terminal
  Coloured,  ///< the same with what is grave in colour
  Markdown,  ///< a report
};

/// Beginnings of flights, in seconds of TAI since 1958.
struct WhichFlight {
  std::optional<double> story_s{};  ///< of the one that the story is of; empty: the archive does not tell
  std::optional<double> since_s{};  ///< of the newest one, of which the archive has nothing
};

/// "PAIR has flown since ...": of a flight that no ground station has kept; empty: there is none.
[[nodiscard]] std::string flown_since(const std::string& mission, const WhichFlight& which);
/// `story` as GET /api/why answers it; `archive`: where it was found. Control characters in what the archive has are shown as spaces.
[[nodiscard]] std::string why_text(const nlohmann::json& story, const std::string& mission, const std::string& archive,
                                   WhyStyle style, const WhichFlight& which);
/// `flights` as GET /api/flights answers it: the beginning of the one in which that was.
[[nodiscard]] std::optional<double> flight_of(const nlohmann::json& flights, const nlohmann::json& story);
/// "2026-11-24 13:42:09.123 UTC" of seconds of TAI since 1958, with the leap seconds of the systems' clocks (37 s).
[[nodiscard]] std::string utc_text(double onboard_s);

}  // namespace hirosco::ground
