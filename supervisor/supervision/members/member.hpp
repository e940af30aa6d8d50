// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/supervision/members/member_recovery.hpp"

/// One started subsystem as the supervisor sees it: its port, whether it lives. Whether it moves, and
/// whether it may move anything, is the guard's.
namespace hirosco::supervisor {

class Member {
 public:
  explicit Member(const descriptor::MissionSubsystem& described) : described_{&described} {}

  void started(LaunchedSubsystem launched);
  void died();

  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const noexcept { return described_->subsystem; }
  [[nodiscard]] const descriptor::MissionSubsystem& described() const noexcept { return *described_; }
  [[nodiscard]] std::uint16_t apid() const noexcept { return described_->subsystem.id; }
  [[nodiscard]] bool alive() const noexcept { return launched_.port != nullptr; }
  [[nodiscard]] MemberChannel* channel() const noexcept { return alive() ? &launched_.port->channel() : nullptr; }
  [[nodiscard]] std::uint32_t process() const noexcept { return launched_.process; }
  /// As it says itself; empty when it does not run or what it says holds no state.
  [[nodiscard]] std::optional<State> state() const noexcept { return alive() ? launched_.port->state() : std::nullopt; }
  [[nodiscard]] std::uint8_t configuration() const noexcept { return alive() ? launched_.port->configuration() : 0; }
  /// Empty when it does not run or what it says is damaged.
  [[nodiscard]] std::optional<MemberStatistics> statistics() const noexcept;
  /// How long the samples of an incoming link took, by its place in MemberStatistics::incoming; nothing when it does not run.
  [[nodiscard]] MemberLatencies latencies(std::size_t place) const noexcept {
    return alive() ? launched_.port->latencies(place) : MemberLatencies{};
  }
  [[nodiscard]] std::uint64_t stopped_at_cycle() const noexcept;
  void enter_mode(std::uint32_t epoch) noexcept;
  /// Once in each step of the supervisor.
  void beat(std::uint64_t heartbeat, TimePoint now);

  /// What it is in the middle of.
  MemberRecovery recovery;
  /// Since when its channel is closed. A process that ends closes it a moment before its handle says so; one that
  /// lives on without it can be neither commanded nor heard.
  std::optional<TimePoint> closed_at;
  /// The guard's count of its fences when it was first started, or let go last: another count, and it was stopped since. Empty: it was
  /// stopped under a supervisor before, or may have been.
  std::optional<std::uint64_t> fences_when_free{0};
  bool was_started{false};
  /// Its process ends for another version of it, or has: nobody else starts it.
  bool exchanged{false};
  /// The version that takes its place, or is on trial, has a text of its own: nobody else changes that (docs/adr/0214).
  bool brings_text{false};
  /// Another text of its descriptor is on its way to it: nothing is permitted that the old one would judge.
  bool descriptor_changes{false};
  /// In how many steps in a row the operating system refused to read its channel.
  std::uint32_t refused{0};
  /// Messages of it that could not be read or are not of a kind that it may send, those that were told, and when again.
  std::uint32_t unreadable{0};
  std::uint32_t unreadable_told{0};
  Error why_unreadable{};  ///< of the newest that its channel refused to read
  TimePoint next_unreadable_told{};

 private:
  const descriptor::MissionSubsystem* described_;
  LaunchedSubsystem launched_;
};

}  // namespace hirosco::supervisor
