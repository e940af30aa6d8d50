// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// The supervisor's end of a member's channel. Whoever finds it full is refused, but for what the supervisor itself says towards
/// safety: that is kept here, and nothing that is said later goes before it. So no flood, and no answers to one, keep a recovery from
/// whom it is for, whatever carries the channel and however few places become free at a time.
/// Thread: the supervisor's.
class MemberChannel final : public Channel {
 public:
  static constexpr std::size_t most_kept = 32;
  /// Longer than this nobody waits for its outcome.
  static constexpr Duration patience = std::chrono::seconds{15};

  explicit MemberChannel(Channel& channel) noexcept : channel_{channel} {}

  /// ResourceExhausted: the member does not read, and as many are kept already.
  [[nodiscard]] Result<> send_or_keep(const Message& message, TimePoint now);
  /// Once in each step of the supervisor: what is kept leaves, or is given up after its time.
  void step(TimePoint now);

  [[nodiscard]] Result<> send(const Message& message) override;
  [[nodiscard]] std::size_t send_all(std::span<const Message> messages) override;
  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override { return channel_.receive(buffer); }
  [[nodiscard]] int wait_descriptor() const noexcept override { return channel_.wait_descriptor(); }

 private:
  struct Kept {
    Message message;  ///< without its packet
    std::vector<std::byte> packet;
    TimePoint until{};
  };
  /// False: some still wait.
  bool send_kept();

  Channel& channel_;
  std::deque<Kept> kept_;
};

}  // namespace hirosco::supervisor
