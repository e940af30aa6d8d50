// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include "hirosco/utilities/time.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/terminal/heard_overview.hpp"

namespace hirosco::tools {

/// Long enough for every structure of the shipped missions to come once that tells how somebody does; what somebody takes comes as seldom as
/// every ten seconds.
inline constexpr Duration listening = std::chrono::milliseconds{1500};

/// Housekeeping as it came by, the newest of each name.
struct Listened {
  std::map<std::uint16_t, terminal::HeardValues> values;
  std::map<std::uint16_t, std::size_t> packets;
  std::map<std::uint16_t, OnboardTime> at;  ///< of the newest report
};

/// Until the time is over or `enough` says so. False: the link is closed.  Blocks.
[[nodiscard]] bool listen(const descriptor::Mission& mission, GroundConnection& link, Listened& listened,
                          const std::function<bool()>& enough);

}  // namespace hirosco::tools
