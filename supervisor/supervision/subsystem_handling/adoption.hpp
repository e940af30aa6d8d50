// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/succession/succession.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class Commissioning;
class LinkCommands;
class LinkLosses;
class Modes;
class OwnTelecommands;
class Processes;
class Reactions;
class SafeAll;
class Shutdown;
class Telecommands;

/// A supervisor that goes on for one that died (docs/adr/0093): what runs is taken over with the permission that it had, unless
/// something was under way that was to stop it or would have moved it: that ends stopped. What happens in which order, and where: supervisor/README.md.
/// Thread: the supervisor's.
class Adoption final : public Watch, public Remembered, public Succession {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    Processes& processes;
    OwnTelecommands& desk;
    Telecommands& telecommands;
    LinkCommands& links;
    Modes& modes;
    Commissioning& commissioning;
    Reactions& reactions;
    SafeAll& safe_all;
    Shutdown& shutdown;
    LinkLosses& losses;
    Memory& memory;
  };
  /// What a member may take to look at its new permit page: less than it goes on without a supervisor.
  static constexpr Duration longest_change = std::chrono::seconds{1};
  static constexpr Duration asked_again_after = std::chrono::milliseconds{100};
  /// What this supervisor may take until it is Operational itself; what is said to it waits so long.
  static constexpr Duration longest_start = std::chrono::seconds{2};

  /// From the first word of this guard to a device until its answer is there.
  static constexpr Duration devices_answer = std::chrono::milliseconds{50};

  explicit Adoption(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  /// In the place of a start. `stop_asked`: somebody asked for a stop when nobody was there to carry it out.
  void begin(bool stop_asked);
  /// Of now, or of one that the supervisor before had begun and not ended.
  [[nodiscard]] bool stop_asked() const noexcept { return stop_asked_; }
  [[nodiscard]] bool waits() const noexcept override { return waits_; }
  void confirmed(std::uint16_t apid) override;
  void watch(TimePoint now) override;
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  struct Before {
    bool alive{false};
    bool recovering{false};
    bool started{false};  ///< at some time of the flight
    bool stopped{false};  ///< and nobody has let it go since
  };
  struct Page {
    MemoryHandle memory;
    TimePoint since{};
    TimePoint again{};
    bool given_up{false};
  };
  [[nodiscard]] Before before(const Member& member) const;
  void take_over(Member& member);
  void hand_over(Member& member, Page& page);
  /// Why it is not let go on; empty: it is.
  [[nodiscard]] std::string_view against(const Member& member) const;
  void go_on();
  void ask_devices();
  void finish_what_was_begun();
  void recover_the_living();
  void fail_plan_of(Member& member);

  Parts parts_;
  Craft& craft_;
  std::optional<TimePoint> asked_devices_at_;
  bool remembered_{false};
  bool waits_{false};
  bool owes_{false};  ///< the end of what the supervisor before had begun
  TimePoint waits_until_{};
  // Of the supervisor before.
  std::map<std::uint16_t, Before> before_;
  std::set<std::uint16_t> stopped_;  ///< with the networks of those that were being recovered, unless that begins anew
  bool commissioning_{false};
  bool shutting_down_{false};
  bool stop_asked_{false};
  std::map<std::uint16_t, Page> pages_;  ///< that are not confirmed
};

}  // namespace hirosco::supervisor
