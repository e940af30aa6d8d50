// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/shared_memory.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"
#include "supervisor/keeper/kept_store.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/succession/texts_in_force.hpp"

namespace hirosco::supervisor {

/// What the keeper holds for this supervisor and for one after it; where there is none, memory of our own. Thread: the supervisor's, but
/// for watch_this_thread().
class Inheritance {
 public:
  Inheritance();
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;

  [[nodiscard]] KeeperPage& page() noexcept { return *page_; }
  /// False: the keeper is of another build, and nothing of what it holds can be told.
  [[nodiscard]] bool fits() const noexcept {
    return !page_unreadable_ && page_->layout.load() == KeeperPage::layout_now;
  }
  /// There was a supervisor before this one.
  [[nodiscard]] bool goes_on() const noexcept { return page_->starts.load() > 1; }
  [[nodiscard]] StoreClient store() const noexcept;
  /// When the first supervisor of this flight began its steps: that is now where it is this one, or where none came so far. A flight is as old
  /// as that, whichever of its supervisors tells it.
  [[nodiscard]] TimePoint flight_began(TimePoint now) noexcept;
  /// Null: nobody would read it.
  [[nodiscard]] Journal* journal() noexcept { return journal_ ? &*journal_ : nullptr; }
  [[nodiscard]] InhibitNotes notes(const descriptor::Mission& mission) const { return InhibitNotes{mission, *page_}; }
  /// By what the supervisor before flew: its files may say something else by now, and nobody has judged that.
  [[nodiscard]] descriptor::FileSource source() const;
  /// Those beside the mission's files that the supervisor before kept to go back to (docs/adr/0214).
  void add_kept_texts(descriptor::Mission& mission) const;
  /// False: they have no room. The next supervisor reads the files.
  bool note(const TextsInForce::Texts& texts) { return !texts_ || texts_->note(texts); }
  /// The keeper hears of the end of the calling thread before the system has given this process's memory back (docs/adr/0135).
  void watch_this_thread() const noexcept;
  /// From the keeper, which has told the devices what the guard before had told them. Waits 100 ms at most.
  void take_inhibits(const Clock& clock) const;

 private:
  MappedMemory page_memory_, journal_memory_, texts_memory_;
  KeeperPage own_;
  KeeperPage* page_{&own_};
  bool page_unreadable_{false};  ///< there is one, and it is shorter than ours
  std::optional<Journal> journal_;
  std::optional<TextsInForce> texts_;
};

}  // namespace hirosco::supervisor
