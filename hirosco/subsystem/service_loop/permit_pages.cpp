// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/permit_pages.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/subsystem/pages/supervisor_silence.hpp"

namespace hirosco {

/// The supervisor died, and another one goes on in its place: it cannot write the page of the one before (hazard SF13). What is no
/// permit page is not taken, nor is one before the cycle looks at the last: then it comes again.
void PermitPages::take(const MemoryHandle& memory) {
  if (!parts_.cycle.permit().looks_at_offered() || !parts_.memory.verify(memory, sizeof(PermitPage), true)) return;
  auto mapped = parts_.memory.map(memory, Access::ReadOnly);
  if (!mapped) return;
  const auto* page = reinterpret_cast<const PermitPage*>(mapped->octets.data());
  if (page->magic != page_magic || page->version != page_version) return;
  before_ = std::exchange(memory_, std::move(*mapped));
  page_ = page;
  last_heartbeat_ = page->heartbeat.load(std::memory_order_acquire);
  parts_.cycle.permit().offer(*page);
  parts_.loops.take_permit(*page);
  owed_ = true;
  confirm();
}

void PermitPages::confirm() {
  if (!owed_) return;
  if (parts_.orders.rests()) parts_.cycle.permit().take_offered();
  if (!parts_.cycle.permit().looks_at_offered()) return;
  owed_ = !parts_.channel.send({.kind = MessageKind::PermitPage});
}

void PermitPages::watch(TimePoint now) {
  const std::uint64_t heartbeat = page_->heartbeat.load(std::memory_order_acquire);
  // While the whole computer stood nobody was silent: of what passes between two looks only so much counts.
  silent_for_ += std::min(now - std::exchange(watched_at_, now), most_silence_a_look);
  if (std::exchange(last_heartbeat_, heartbeat) != heartbeat) silent_for_ = Duration{0};
}

bool PermitPages::unheard() const noexcept { return gone_ || silent_for_ > supervisor_silence_limit; }

}  // namespace hirosco
