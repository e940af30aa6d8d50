// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {

/// Telecommands that have left and may change persistent values, until their end is told: beyond the death of a supervisor, too, as the
/// end may come to the next one (docs/adr/0168).
/// Bounded: `most` of them, `most_octets` as they are noted. Thread: the supervisor's.
class AwaitedChanges {
 public:
  static constexpr std::size_t most = 256;
  static constexpr std::size_t most_octets = std::size_t{64} << 10;

  using Ids = std::set<std::uint32_t>;
  struct Change {
    std::uint16_t apid{};  ///< whose values
    std::uint32_t request{};
    std::uint16_t source{};
    Ids ids;
    std::vector<std::byte> values{};  ///< application data of TC[20,3]; empty: a function's
  };

  /// False: there is no room for it.
  [[nodiscard]] bool add(Change change);
  /// The one whose end this report of service 1 is, told by whom it was for; it is awaited no more.
  [[nodiscard]] std::optional<Change> take(std::uint16_t from, const pus::TelemetryView& end);
  /// The one whose end the supervisor has told, as nobody knows it. Its own report may come yet. Null: there is none.
  [[nodiscard]] const Change* told_as_unknown(const pus::TelemetryView& end) const;
  /// What functions of one that has died may have changed; nothing of it is awaited any more.
  [[nodiscard]] Ids take_all_of(std::uint16_t apid);

  void note(OctetWriter& writer) const;
  void recall(OctetReader& reader);

 private:
  std::deque<Change> changes_;
};

}  // namespace hirosco::supervisor
