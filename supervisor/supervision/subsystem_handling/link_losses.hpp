// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/realtime_links/link_commands.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What the mission says of a link whose set is lost to its consumer (docs/adr/0077): it goes on for a while, or without it, or in another
/// configuration. None of it lets anybody move: the cycle's own inhibit, and the guard, are not asked. Thread: the supervisor's.
class LinkLosses final : public Watch, public Undertaking, public LossHandling {
 public:
  LinkLosses(const Means& means, OwnSubsystem& own, const LinkCommands& links)
      : means_{means}, craft_{means.craft}, own_{own}, links_{links} {}

  void lost(std::uint8_t link) override;
  bool answers(std::uint16_t apid, std::string_view event) override;
  [[nodiscard]] std::uint8_t answered_link(std::uint16_t apid, std::string_view event) const override;
  /// Those that are held over, and those on their way to another configuration.
  void watch(TimePoint now) override;
  bool cancel(std::string_view why) override;
  void all_stopped(std::string_view why) override { static_cast<void>(cancel(why)); }

 private:
  struct Fallback {
    explicit Fallback(const Means& means) : runner{means} {}
    ProcedureRunner runner;
    std::uint64_t fences{0};  ///< when it began
  };
  struct Hold {
    TimePoint since{};
    TimePoint until{};
  };
  [[nodiscard]] Member& consumer_of(const descriptor::MissionLink& link);
  void fall_back(const descriptor::MissionLink& link, Member& consumer);
  /// Its set is there again, newer than the loss.
  [[nodiscard]] bool is_back(std::uint8_t link, TimePoint since) const;
  [[nodiscard]] bool is_needed(const descriptor::MissionLink& link);
  void bring_down(const descriptor::MissionLink& link, const std::string& why);

  Means means_;
  Craft& craft_;
  OwnSubsystem& own_;
  const LinkCommands& links_;
  std::map<std::uint8_t, Hold> holds_;  ///< by link; of what is ignored without an end
  std::map<std::uint16_t, Fallback> fallbacks_;  ///< that run, by consumer
};

}  // namespace hirosco::supervisor
