// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/restart_schedule.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class GroundLinkCare;
class GroundLoss;
class LinkCommands;
class OwnTelecommands;
class Reactions;
class Reception;
class Restoration;
class ResourceHandling;
class SafeAll;
class StoredValues;
class Telecommands;
class Replacement;

/// Starts the processes of the subsystems, sees them end or hang, and starts them again (paper 4.3 subsystem handling).
/// Thread: the supervisor's.
class Processes final : public Watch {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    Reception& reception;
    Reactions& reactions;
    SafeAll& safe_all;
    LinkCommands& links;
    Telecommands& telecommands;
    OwnTelecommands& desk;
    GroundLinkCare& ground_link;
    GroundLoss& ground_loss;
    Restarts& restarts;
    Restoration& restoration;
    ResourceHandling& resources;
    Replacement& replacement;
    StoredValues& stored;
  };
  explicit Processes(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  void start_all();
  /// One that is down: by the ground, however often it died. Otherwise why it could not be started.
  Result<> start(std::uint16_t apid);
  /// One that runs since the supervisor before; empty: it does not, or cannot be held. The guard holds the devices of one that has run and
  /// does no longer: they may be coming to rest still, and a stop asks them.
  /// \return its new permit page, which it has to be handed.
  [[nodiscard]] std::optional<MemoryHandle> adopt(Member& member, std::string_view against);
  /// It ran when the supervisor before died, and does no longer; one that was ended in the place of its adoption has died when it has gone,
  /// and hangs until then.
  void found_dead(Member& member);
  /// One in Offline: its channel is closed, so that it ends by itself, and nobody reacts to that.
  void let_go(Member& member);
  void take_guard_findings();
  /// Those whose channel is closed: how they ended is known at once.
  void watch_closed() { watch_ends(Whom::Closed); }
  void watch(TimePoint now) override;

 private:
  enum class Whom : std::uint8_t { All, Closed };
  /// Ended in the place of its adoption.
  struct Leaving {
    std::uint32_t process{0};  ///< 0: it has gone
    bool missed{false};  ///< it was found dead before it had gone
  };
  void watch_leaving();
  void tell_not_kept(const Member& member, std::string_view why);
  Result<> launch(Member& member);
  void watch_ends(Whom whom);
  void hear_of(Member& member, const GuardFinding& finding);
  void died(Member& member, const ProcessEnd& end);

  Parts parts_;
  Craft& craft_;
  std::map<std::uint16_t, Leaving> leaving_;
};

}  // namespace hirosco::supervisor
