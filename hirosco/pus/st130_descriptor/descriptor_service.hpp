// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco::pus {

/// Whose descriptor it is.  Thread: the service loop.
class DescriptorOwner {
 public:
  virtual ~DescriptorOwner() = default;
  /// Reads the text and keeps it until take() or the next judge(); nothing changes. The notice: why it would not take it.
  [[nodiscard]] virtual std::optional<FailureNotice> judge(std::size_t octets, const MemoryHandle& text) = 0;
  /// What was judged last is in force from now on, or nothing changes and the notice says why.
  [[nodiscard]] virtual std::optional<FailureNotice> take() = 0;
};

/// ST[130], ours: the supervisor hands over the text of a descriptor that has changed (docs/adr/0095). Of those that fly one file all
/// have to agree to it before one takes it.  Thread: the service loop.
///
///   TC[130,1]  would you take this text?  its octets u32; the text in sealed memory beside the telecommand
///   TC[130,2]  take what you were asked about
class DescriptorService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 130;
  enum Subtype : std::uint8_t { judge_text = 1, take_text = 2 };

  DescriptorService(Verification& verification, DescriptorOwner& owner) : verification_{verification}, owner_{owner} {}
  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;
  void accompany(const MemoryHandle& memory) override { memory_ = memory; }

 private:
  void answer(const Request& request, const std::optional<FailureNotice>& refused);

  Verification& verification_;
  DescriptorOwner& owner_;
  MemoryHandle memory_;
};

}  // namespace hirosco::pus
