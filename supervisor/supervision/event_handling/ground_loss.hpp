// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// The loss of the ground where who carries the ground link cannot tell it (docs/adr/0165): it is dead, was Offline or stands still, or it is there
/// again and nobody has come back to it. Of clients that go while it lives it tells itself. Thread: the supervisor's.
class GroundLoss final : public Watch, public Remembered {
 public:
  /// Without anybody, who had been there. The ground link of the framework waits as long for its clients.
  static constexpr Duration patience = std::chrono::seconds{2};

  GroundLoss(Craft& craft, OwnSubsystem& own, Reactions& reactions) : craft_{craft}, own_{own}, reactions_{reactions} {}

  /// Somebody on ground is there: what was sent came in, or the ground link says so.
  void heard() noexcept;
  /// What the ground link says of its clients and of itself.
  void hear_event(std::uint16_t from, Octets message);
  /// It has stood still for that long; who is connected to it may be so still.
  void stands_still(const Member& member, Duration span);
  void moves_again(const Member& member) noexcept;
  void watch(TimePoint now) override;
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  void away_from(TimePoint since, bool cut) noexcept;
  void nobody_any_more() noexcept;
  void tell(Member& link);

  Craft& craft_;
  OwnSubsystem& own_;
  Reactions& reactions_;
  bool somebody_{false};  ///< was there, and nobody has told of a loss since
  std::optional<TimePoint> away_since_;  ///< only of somebody
  bool cut_{false};  ///< what was connected then is so no more
};

}  // namespace hirosco::supervisor
