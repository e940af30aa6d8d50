// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/pages/page_words.hpp"

namespace hirosco {

/// A subsystem's way to a supervisor with which it shares no memory (docs/adr/0066): what a program on its computer holds
/// between its two pages and the stream. Its channel and pages are what a GenericSubsystem takes.
/// Thread: one.
class StreamSubsystemPort {
 public:
  /// So long the supervisor's own loop may stand still before its guard fences all; the same holds for a stream in which
  /// nothing comes, for no fence could.
  static constexpr Duration silence_limit = std::chrono::seconds{1};

  /// `stream` does not block. The pages outlive this.
  StreamSubsystemPort(FileDescriptor stream, const VitalPage& vital, PermitPage& permit)
      : words_{vital, permit}, channel_{std::move(stream), words_} {}

  /// At least once in StreamChannel::words_period.
  void step(TimePoint now) {
    channel_.step(now);
    if (heard_ != words_.heard() || !heard_at_) heard_at_ = now;
    heard_ = words_.heard();
    if (channel_.closed() || now - *heard_at_ > silence_limit) words_.shut();
  }
  [[nodiscard]] Channel& channel() noexcept { return channel_; }
  /// The supervisor is gone, or what it said is not understood.
  [[nodiscard]] bool closed() const noexcept { return channel_.closed(); }

 private:
  MemberWords words_;
  StreamChannel channel_;
  std::uint64_t heard_{0};
  std::optional<TimePoint> heard_at_;
};

}  // namespace hirosco
