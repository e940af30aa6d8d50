// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"

/// The log: every packet of the archive in words, searched by words.
namespace hirosco::ground {

struct LogQuery {
  std::string text;                  ///< words, each anywhere in the line, without regard to case
  OnboardTime to{OnboardTime::max()};
  std::int64_t before{0};            ///< number of a packet, 0 = none
  Archive::Housekeeping housekeeping{Archive::Housekeeping::LeftOut};
  std::size_t limit{200};            ///< lines
};

/// {packets:[{number, t, apid, subsystem, service, subtype, text}], before}, newest first. Of 20,000 packets it looks at no
/// more: `before` is where to go on, null at the end of the archive.
[[nodiscard]] nlohmann::json search_log(const Catalogue& catalogue, Archive& archive, const LogQuery& query);

}  // namespace hirosco::ground
