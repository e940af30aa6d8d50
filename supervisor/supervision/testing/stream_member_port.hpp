// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "hirosco/subsystem/pages/page_words.hpp"
#include "supervisor/platform/launch/member_port.hpp"

namespace hirosco::supervisor::testing {

/// A member that shares no memory with the supervisor: everything goes over a stream of octets, whose other end is a
/// StreamSubsystemPort. Its pages are copies of this side, for the guard, too. A fence leaves with the next step, ahead of every
/// message; a member that hears nothing for a second stops by itself, and so does one whose stream is closed. Here, as no launcher makes one: who starts
/// members on another computer is not there yet (docs/adr/0066), and the tests show that such a member is one like all others.
class StreamMemberPort final : public MemberPort {
 public:
  /// `stream` does not block.
  explicit StreamMemberPort(FileDescriptor stream) : StreamMemberPort{std::make_unique<Wire>(std::move(stream))} {}

  /// For LaunchedSubsystem.
  [[nodiscard]] Mapping vital_page() const { return wire_->vital(); }
  [[nodiscard]] Mapping permit_page() const { return wire_->permit(); }

 private:
  struct Pages {
    VitalPage vital;
    PermitPage permit;
  };
  struct Wire {
    explicit Wire(FileDescriptor stream)
        : pages{std::make_shared<Pages>()}, words{pages->vital, pages->permit}, channel{std::move(stream), words} {}
    [[nodiscard]] Mapping vital() const {
      return {pages, {reinterpret_cast<std::byte*>(&pages->vital), sizeof(VitalPage)}};
    }
    [[nodiscard]] Mapping permit() const {
      return {pages, {reinterpret_cast<std::byte*>(&pages->permit), sizeof(PermitPage)}};
    }
    std::shared_ptr<Pages> pages;  ///< the guard may look at them a little longer than there is a stream
    SupervisorWords words;
    StreamChannel channel;
  };
  explicit StreamMemberPort(std::unique_ptr<Wire> wire)
      : MemberPort{wire->channel, wire->vital(), wire->permit()}, wire_{std::move(wire)} {}
  void take_across(TimePoint now) override { wire_->channel.step(now); }
  std::unique_ptr<Wire> wire_;
};

}  // namespace hirosco::supervisor::testing
