// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

namespace hirosco::supervisor {

/// The memory that both ends of a link share: made for it, or, of a set that is lent to somebody else already, that one's.
/// Thread: the supervisor's.
class LinkMemory {
 public:
  struct Shared {
    MemoryHandle memory;
    std::uint32_t made{};  ///< epoch for which it was made
  };
  LinkMemory(const descriptor::Mission& mission, MemoryProvider& memory, LinkMechanisms mechanisms)
      : mission_{mission}, memory_{memory}, mechanisms_{mechanisms} {}

  /// Nullptr: nothing here carries what was agreed.
  [[nodiscard]] const LinkMechanism* mechanism_for(const pus::st128::Agreement& agreement) const;
  /// For what a mechanism carries. `lends_still`: that link's producer has not let go of what it lends.
  [[nodiscard]] Result<Shared> share(const descriptor::MissionLink& link, const pus::st128::Agreement& agreement,
                                     std::uint32_t epoch, const std::function<bool(std::uint8_t link)>& lends_still);
  /// It is handed to nobody else any more.
  void lend_no_more(std::uint32_t made);
  /// Nullptr: it cannot be looked at from here.
  [[nodiscard]] std::unique_ptr<LinkView> look(const pus::st128::Agreement& agreement,
                                               const MemoryHandle& shared) const;

 private:
  const descriptor::Mission& mission_;
  MemoryProvider& memory_;
  LinkMechanisms mechanisms_;
  /// Memory that a set is lent in, by the links that have it. One whose producer has let go of it lends nothing any more.
  struct Lent {
    Shared shared;
    std::uint64_t layout_hash{};
  };
  std::map<std::uint8_t, Lent> lent_;
};

}  // namespace hirosco::supervisor
