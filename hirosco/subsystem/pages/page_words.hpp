// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/channel/stream_channel.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

/// How the two pages of a member get across where they are not shared: each side has both, the words of one are told and
/// those of the other are copied into the own one. What a page cannot be damaged into it cannot be copied into: damage of the
/// one is damage of the other, and a permission holds for its epoch only.
namespace hirosco {

/// The supervisor's side: tells the permit page, keeps a copy of the vital page.
class SupervisorWords final : public StreamWords {
 public:
  SupervisorWords(VitalPage& copy, const PermitPage& permit) noexcept : copy_{copy}, permit_{permit} {}
  [[nodiscard]] StreamFrameKind told_kind() const noexcept override { return StreamFrameKind::Permit; }
  [[nodiscard]] StreamFrameKind heard_kind() const noexcept override { return StreamFrameKind::Vital; }
  void tell(OctetWriter& words) noexcept override;
  [[nodiscard]] std::size_t urgent_octets() const noexcept override;
  [[nodiscard]] Result<> hear(Octets words) override;

 private:
  VitalPage& copy_;
  const PermitPage& permit_;
};

/// The member's side: tells the vital page, keeps a copy of the permit page.
class MemberWords final : public StreamWords {
 public:
  MemberWords(const VitalPage& vital, PermitPage& copy) noexcept : vital_{vital}, copy_{copy} {}
  [[nodiscard]] StreamFrameKind told_kind() const noexcept override { return StreamFrameKind::Vital; }
  [[nodiscard]] StreamFrameKind heard_kind() const noexcept override { return StreamFrameKind::Permit; }
  void tell(OctetWriter& words) noexcept override;
  [[nodiscard]] std::size_t urgent_octets() const noexcept override;
  [[nodiscard]] Result<> hear(Octets words) override;

  /// Nobody can be asked whether the actuators may still move: they may not, until a later permission comes.
  void shut() noexcept;
  /// How often words came.
  [[nodiscard]] std::uint64_t heard() const noexcept { return heard_; }

 private:
  const VitalPage& vital_;
  PermitPage& copy_;
  std::uint64_t heard_{0};
  std::uint32_t shut_epoch_{0};  ///< a permission of this epoch is over
};

}  // namespace hirosco
