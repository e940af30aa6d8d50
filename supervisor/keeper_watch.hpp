// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/time.hpp"
#include "supervisor/keeper/kept.hpp"

namespace hirosco::supervisor {

/// The keeper of this supervisor, as that sees it: it moves, stands still, or is gone. With one that is gone the flight goes on, and what it had
/// counted and can hand on no more is the supervisor's to do (docs/adr/0217). Thread: the supervisor's.
class KeeperWatch {
 public:
  enum class Keeper : std::uint8_t {
    Nobody,  ///< there never was one
    Here,
    Gone,
  };
  /// What there is to do now, each once.
  struct Finding {
    bool still{false};  ///< it stands still, from now on: to be told
    bool lost{false};  ///< it is gone: to be told
    bool stop{
        false};  ///< it had counted a stop that nobody has noted: it may have told no guard of it, so all is to be stopped
    std::uint32_t end{
        0};  ///< the end of the flight is asked for, by whom as KeeperPage::end_asked says it; 0: it is not
  };

  /// \param page The keeper's, and outlives this.
  KeeperWatch(const KeeperPage& page, Keeper keeper) noexcept : page_{page}, keeper_{keeper} {}

  /// Its pipe has ended.
  void gone() noexcept { keeper_ = Keeper::Gone; }
  [[nodiscard]] bool lost() const noexcept { return keeper_ == Keeper::Gone; }
  /// There is one that starts another supervisor where this one ends.
  [[nodiscard]] bool here() const noexcept { return keeper_ == Keeper::Here; }
  [[nodiscard]] Finding look(TimePoint now) noexcept;

 private:
  const KeeperPage& page_;
  Keeper keeper_;
  Progress progress_;
  bool still_{false}, lost_told_{false}, end_told_{false};
};

}  // namespace hirosco::supervisor
