// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// What link handling asks of the supervisor around it.
class LinkOperator {
 public:
  /// An end answers what it was sent in this time: that is one packet there and one back, so a second is plenty, also beside a busy core.
  static constexpr Duration answer_limit = 2s;

  virtual ~LinkOperator() = default;
  /// Sends TC[128,subtype] through permit, route and log; memory travels beside it.
  virtual void send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) = 0;
  /// A link came up, was taken down or could not be made; `text` says what was agreed or why not.
  virtual void link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) = 0;
};

}  // namespace hirosco::supervisor
