// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "hirosco/data_transfer/channel/channel.hpp"

namespace hirosco {

/// One end of a control channel between two threads of one process, which can wait for it: two queues in memory that is taken when
/// the channel is made. Its destructor is what the death of a process is to a socket: the other end reads what was sent, then Unavailable.
/// Thread: each end one per direction. Realtime: a lock that nobody holds for longer than a copy, one system call, no heap.
class ThreadChannel final : public Channel {
 public:
  static constexpr std::uint32_t default_kb = 256;

  /// `kb`: of all packets that wait in one direction, and as many messages. SystemFailure: no descriptor is left to wait by.
  [[nodiscard]] static Result<std::pair<std::unique_ptr<ThreadChannel>, std::unique_ptr<ThreadChannel>>> make_pair(
      std::uint32_t kb = default_kb);
  ~ThreadChannel() override;

  [[nodiscard]] Result<> send(const Message& message) override;
  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override;
  /// Messages or octets, whichever is nearer to its end.
  [[nodiscard]] Fill outbound() noexcept override;
  /// Readable while there is something that receive() has not told.
  [[nodiscard]] int wait_descriptor() const noexcept override;
  /// Readable from when the peer took something, after a send() that found no room, until the next such.
  [[nodiscard]] int room_descriptor() const noexcept;

 private:
  struct Queue;
  ThreadChannel(std::shared_ptr<Queue> out, std::shared_ptr<Queue> in) noexcept
      : out_{std::move(out)}, in_{std::move(in)} {}
  std::shared_ptr<Queue> out_, in_;
};

}  // namespace hirosco
