// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_memory.hpp"

#include <utility>

namespace hirosco::supervisor {

const LinkMechanism* LinkMemory::mechanism_for(const pus::st128::Agreement& agreement) const {
  return find_link_mechanism(mechanisms_, agreement.method, agreement.kind);
}

Result<LinkMemory::Shared> LinkMemory::share(const descriptor::MissionLink& link,
                                             const pus::st128::Agreement& agreement, std::uint32_t epoch,
                                             const std::function<bool(std::uint8_t link)>& lends_still) {
  Shared shared{{}, epoch};
  const bool lends = agreement.kind == LinkKind::Loaned;
  if (lends)
    for (const auto& [id, lent] : lent_) {
      const descriptor::MissionLink& other = *mission_.find_link(id);
      const bool of_set = id != link.id && other.from == link.from && other.provides == link.provides;
      if (!of_set || !lends_still(id) || lent.layout_hash != agreement.layout_hash()) continue;
      shared = lent.shared;
      break;
    }
  if (shared.made == epoch) {
    HIROSCO_TRY_LET(shared.memory, mechanism_for(agreement)->establish(memory_, agreement.layout(epoch)));
  }
  if (lends) lent_.insert_or_assign(link.id, Lent{shared, agreement.layout_hash()});
  return shared;
}

void LinkMemory::lend_no_more(std::uint32_t made) {
  std::erase_if(lent_, [&](const auto& entry) { return entry.second.shared.made == made; });
}

std::unique_ptr<LinkView> LinkMemory::look(const pus::st128::Agreement& agreement, const MemoryHandle& shared) const {
  auto view = mechanism_for(agreement)->look(memory_, shared);
  return view ? std::move(*view) : nullptr;
}

}  // namespace hirosco::supervisor
