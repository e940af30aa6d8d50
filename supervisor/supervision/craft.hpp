// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "supervisor/guard/guard.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/supervision/members/member.hpp"
#include "supervisor/supervision/observer.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What every part of the supervisor looks at: the mission, its members, the mode, the time, and whom to tell. It decides
/// nothing. Thread: the supervisor's.
struct Craft {
  Craft(const descriptor::Mission& described, const Platform& outside, ProcessLauncher& processes, Guard& watcher,
        PacketLog& packets, Observer& who);
  Craft(const Craft&) = delete;
  Craft& operator=(const Craft&) = delete;

  /// Nullptr: nobody has this APID, or only the supervisor.
  [[nodiscard]] Member* member(std::uint16_t apid);
  [[nodiscard]] const Member* member(std::uint16_t apid) const;
  [[nodiscard]] bool is_ground_link(const Member& member) const;
  /// Nullptr: the mission has none.
  [[nodiscard]] Member* ground_link();
  [[nodiscard]] std::string name_of(std::uint16_t apid) const;
  /// One line of the story, into the log and to the observer; `subject` is whom it is about.
  void tell(std::string_view line, std::uint16_t subject = 0);

  descriptor::Mission mission;
  Platform platform;
  ProcessLauncher& launcher;
  Guard& guard;  ///< stepped by its own thread, or by who steps the supervisor
  PacketLog& log;
  Observer& observer;
  std::vector<Member> members;
  const descriptor::Mode* mode;
  const descriptor::Mode* changing_to{nullptr};  ///< while a change of mode is under way (docs/adr/0075)
  std::uint32_t mode_epoch{1};
  TimePoint now{};
  bool shutting_down{false};
  bool restoring_ground_link{false};
  bool taking_over{false};  ///< for a supervisor that died: this one is on its own way up

  /// What outlives this supervisor is noted now, not at the end of its step: before something is done that must not be done by halves.
  void remember() const {
    if (remembers) remembers();
  }
  std::function<void()> remembers{};
  /// Whether somebody measures now what electrical power there is; nothing: that is no matter here.
  std::function<bool()> power_known{};

  /// Commissioning failed, or something that the end is not orderly without: nothing takes that back.
  void fail() noexcept { failed_ = true; }
  [[nodiscard]] bool failed() const noexcept { return failed_; }

 private:
  bool failed_{false};
};

}  // namespace hirosco::supervisor
