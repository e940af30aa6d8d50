// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>
#include <vector>

#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guard_roster.hpp"
#include "supervisor/guard/guard_time.hpp"
#include "supervisor/guard/stop_number.hpp"

namespace hirosco::supervisor {

/// The processes of the members, from the taking over of their pages to their ends: under which epoch one begins or goes on, and who is fenced
/// when the system says that one has ended (docs/adr/0093, docs/adr/0102). No two processes of a member begin under one epoch.
/// Thread: under the guard's mutex, but for changes().
class GuardedProcesses {
 public:
  struct Parts {
    const Clock& clock;
    GuardRoster& guarded;
    StopNumber& number;
    const GuardTime& time;
    GuardFindings& findings;
  };
  explicit GuardedProcesses(const Parts& parts) : parts_{parts} {}

  /// It was started: its pages are taken over, nothing is permitted.
  void started(std::uint16_t apid, const LaunchedSubsystem& launched);
  /// Its pages were taken over by started(): it goes on as it did under the guard before.
  /// \param against Why it may not go on; empty: it may.
  /// \return why it is not permitted; empty: it is.
  [[nodiscard]] std::string_view go_on(std::uint16_t apid, const AdoptedSubsystem& adopted, std::string_view against);
  /// It has said so, of the page that it was given in go_on().
  void looks_at_its_page(std::uint16_t apid) noexcept;
  /// It had ended already under the guard before.
  void ended_before(std::uint16_t apid);
  /// It has ended: its devices stay inhibited.
  void forget(std::uint16_t apid);

  /// Who is fenced with it at once when its process ends; the newest word counts.
  void falls_with(std::uint16_t apid, std::vector<std::uint16_t> others);
  /// A member whose process may end, by the word that the system marks then.
  struct WatchedLife {
    std::uint16_t apid{0};
    Mapping memory;  ///< keeps the word
    const std::atomic<std::uint32_t>* word{nullptr};
    std::uint32_t seen{0};
  };
  /// Changes with whom lives() names, and who waits on it is woken.  Thread: any.
  [[nodiscard]] const std::atomic<std::uint32_t>& changes() const noexcept { return changes_; }
  [[nodiscard]] std::vector<WatchedLife> lives() const;
  /// Its word has changed. When it says that the process has ended, or what none that lives says, the member is fenced with those that fall with
  /// it; from then on lives() leaves it out, so that no word can keep a thread busy.
  void life_changed(std::uint16_t apid);

 private:
  void lives_changed() noexcept;

  Parts parts_;
  std::atomic<std::uint32_t> changes_{0};
};

}  // namespace hirosco::supervisor
