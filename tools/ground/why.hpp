// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
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

/// `story` as GET /api/why answers it; `archive`: where it was found. Control characters in what the archive has are shown as spaces.
[[nodiscard]] std::string why_text(const nlohmann::json& story, const std::string& mission, const std::string& archive,
                                   WhyStyle style);
/// "2026-11-24 13:42:09.123 UTC" of seconds of TAI since 1958, with the leap seconds of the systems' clocks (37 s).
[[nodiscard]] std::string utc_text(double onboard_s);

}  // namespace hirosco::ground
