// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/data_transfer/channel/channel.hpp"

namespace hirosco {

/// A control channel inside one process: two bounded queues of deep copies.
/// Thread: each end one per direction. Realtime: allocates.
class ChannelPair {
 public:
  static constexpr std::size_t default_capacity = 256;

  /// `capacity`: messages that wait in one direction before send() answers ResourceExhausted.
  explicit ChannelPair(std::size_t capacity = default_capacity);
  ChannelPair(ChannelPair&&) noexcept;
  ChannelPair& operator=(ChannelPair&&) noexcept;
  ~ChannelPair();

  [[nodiscard]] Channel& supervisor_end() noexcept;
  [[nodiscard]] Channel& subsystem_end() noexcept;

  /// Neither end has anything to read.
  [[nodiscard]] bool empty() const noexcept;

  /// What the death of a side's process does: the other end reads what was sent, then Unavailable.
  void close_supervisor_end() noexcept;
  void close_subsystem_end() noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hirosco
