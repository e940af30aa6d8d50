// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "hirosco/data_transfer/control/channel.hpp"

namespace hirosco {

/// What a subsystem has to say while its supervisor does not take it: three queues with room of their own, sent in the
/// order of their worth, each in the order in which it was filled. A full queue loses its oldest message and counts it.
/// Thread: the service loop. Realtime: allocates.
class Backlog {
 public:
  enum class Worth : std::uint8_t {
    Answer,  ///< somebody waits for it, or reacts to it
    Event,
    Housekeeping,
  };

  /// Sends at once when nothing of the same or more worth waits, else keeps a copy. Memory handles are not kept.
  void send(Channel& channel, const Message& message, Worth worth);
  void flush(Channel& channel);
  [[nodiscard]] bool empty() const noexcept;
  /// False while so many answers wait that those to one more telecommand could crowd out older ones: it is to stay where
  /// it is. Answers that nobody will ever take are no reason to wait.
  [[nodiscard]] bool answers_have_room() const noexcept {
    return queue(Worth::Answer).waiting.size() < most_waiting / 2 || peer_gone_;
  }
  /// Messages of this worth that were never sent.
  [[nodiscard]] std::uint64_t lost(Worth worth) const noexcept { return queue(worth).lost; }

  static constexpr std::size_t most_waiting = 1024;

 private:
  struct Unsent {
    MessageKind kind{MessageKind::Packet};
    std::vector<std::byte> packet;
  };
  struct Queue {
    std::deque<Unsent> waiting;
    std::uint64_t lost{0};
  };
  [[nodiscard]] Result<> try_send(Channel& channel, const Message& message);
  [[nodiscard]] const Queue& queue(Worth worth) const noexcept { return queues_[static_cast<std::size_t>(worth)]; }
  std::array<Queue, 3> queues_;
  bool peer_gone_{false};
};

}  // namespace hirosco
