// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/inheritance.hpp"

#include <cerrno>
#include <utility>

#include "hirosco/utilities/os/life.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::supervisor {

Inheritance::Inheritance() {
  if (auto mapped = MappedMemory::map(keeper_page_descriptor, sizeof(KeeperPage), MapMode::ReadWrite)) {
    page_memory_ = std::move(*mapped);
    page_ = reinterpret_cast<KeeperPage*>(page_memory_.octets().data());
  } else {
    const Error& why = mapped.error();
    page_unreadable_ = why.code != ErrorCode::SystemFailure || why.value != EBADF;
  }
  if (auto mapped = MappedMemory::map(keeper_journal_descriptor, journal_octets, MapMode::ReadWrite)) {
    journal_memory_ = std::move(*mapped);
    journal_.emplace(journal_memory_.octets());
  }
  if (auto mapped = MappedMemory::map(keeper_texts_descriptor, texts_octets, MapMode::ReadWrite)) {
    texts_memory_ = std::move(*mapped);
    texts_.emplace(texts_memory_.octets());
  }
}

StoreClient Inheritance::store() const noexcept {
  return StoreClient{page_ != &own_ ? keeper_store_descriptor : -1, page_};
}

TimePoint Inheritance::flight_began(TimePoint now) noexcept {
  std::int64_t none = 0;
  page_->flight_began.compare_exchange_strong(none, now.time_since_epoch().count());
  return TimePoint{Duration{page_->flight_began.load()}};
}

descriptor::FileSource Inheritance::source() const {
  auto texts = goes_on() && texts_ ? texts_->newest() : TextsInForce::Texts{};
  if (texts.empty()) return descriptor::file_system();
  return [texts = std::move(texts)](const std::filesystem::path& asked) -> Result<std::string> {
    const auto known = texts.find(asked);
    if (known == texts.end()) return fail(ErrorCode::NotFound, "is no file of this flight");
    return *known->second;
  };
}

void Inheritance::add_kept_texts(descriptor::Mission& mission) const {
  if (!goes_on() || !texts_) return;
  auto kept = texts_->newest();
  mission.texts.merge(kept);
}

void Inheritance::watch_this_thread() const noexcept {
  // In this order: until it is held the word tells of the end of the guard before, which must not be taken for this one's.
  if (hold_life(page_->guard_life)) page_->guarded.store(page_->starts.load(), std::memory_order_release);
}

void Inheritance::take_inhibits(const Clock& clock) const {
  constexpr Duration longest = std::chrono::milliseconds{100};
  const std::uint32_t start = page_->starts.load();
  page_->wants_inhibits.store(start, std::memory_order_release);
  for (const TimePoint limit = clock.now() + longest; page_->left_inhibits.load() < start && clock.now() < limit;)
    sleep_until(clock.now() + std::chrono::microseconds{500});
}

}  // namespace hirosco::supervisor
