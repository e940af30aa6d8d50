// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "supervisor/guard/guarded_member.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"

namespace hirosco::supervisor {

/// Whom the guard holds: each member of the mission with the second inhibits and power switches of its devices. Nobody leaves it; whose process has
/// ended stays, as its devices stay inhibited.  Thread: under the guard's mutex, but for open().
class GuardRoster {
 public:
  /// \param first_epoch Of every permit page; higher than any that a device may have seen.
  /// \param notes What would go on being told to devices if this guard died.
  GuardRoster(FlowFactory& flows, std::uint32_t first_epoch, InhibitNotes notes)
      : flows_{flows}, first_epoch_{first_epoch}, notes_{std::move(notes)} {}

  /// One that is still to be added.  Thread: the supervisor's loop. Error: one of its endnodes cannot be opened.
  [[nodiscard]] Result<GuardedMember> open(const descriptor::MissionSubsystem& described, bool spared) const;
  void add(GuardedMember member);

  [[nodiscard]] GuardedMember* find(std::uint16_t apid) noexcept;
  [[nodiscard]] const GuardedMember* find(std::uint16_t apid) const noexcept;
  /// In the order in which they were added.
  [[nodiscard]] std::span<GuardedMember> members() noexcept { return members_; }
  [[nodiscard]] std::span<const GuardedMember> members() const noexcept { return members_; }
  [[nodiscard]] std::uint32_t first_epoch() const noexcept { return first_epoch_; }
  /// Of all pages.
  [[nodiscard]] std::uint32_t highest_epoch() const noexcept;

 private:
  /// Each way to what the supervisor's side holds, the preferred one first.
  [[nodiscard]] Result<std::vector<std::unique_ptr<DataFlow>>> open_all(const descriptor::Endnode& preferred,
                                                                        const descriptor::HeldTerms& terms) const;
  void add_way(WatchedDevice& device, std::uint16_t apid, std::unique_ptr<DataFlow> flow) const;

  FlowFactory& flows_;
  std::uint32_t first_epoch_;
  InhibitNotes notes_;
  std::vector<GuardedMember> members_;
};

}  // namespace hirosco::supervisor
