// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/descriptor/model/resources.hpp"
#include "hirosco/resource/block_pools.hpp"

namespace hirosco {

/// What a subsystem has to say while its supervisor does not take it: three queues with pools of their own, sent in the
/// order of their worth, each in the order in which it was filled. A full queue, or one whose pools have no block for the next,
/// loses its oldest messages and counts them.
/// Thread: the service loop. Realtime: no heap; a system call for each message that is sent.
class Backlog {
 public:
  enum class Worth : std::uint8_t {
    Answer,  ///< somebody waits for it, or reacts to it
    Event,
    Housekeeping,
  };

  /// As its descriptor says. Throws std::bad_alloc when there is no memory for the pools.
  explicit Backlog(const descriptor::Waiting& most = descriptor::Resources{}.waiting);
  /// Sends at once when nothing of the same or more worth waits, else keeps a copy. Memory handles are not kept.
  void send(Channel& channel, const Message& message, Worth worth);
  void flush(Channel& channel);
  [[nodiscard]] bool empty() const noexcept;
  /// False while so many answers wait that those to one more telecommand could crowd out older ones: it is to stay where
  /// it is. Answers that nobody will ever take are no reason to wait.
  [[nodiscard]] bool answers_have_room() const noexcept;
  /// Messages of this worth that were never sent.
  [[nodiscard]] std::uint64_t lost(Worth worth) const noexcept { return queue(worth).lost; }

  /// How often the channel had no room for what was to be sent.
  [[nodiscard]] std::uint64_t channel_refusals() const noexcept { return channel_refusals_; }
  /// How many of each kind have waited at once since this was asked last.
  [[nodiscard]] descriptor::Waiting take_most_waiting() noexcept;

 private:
  /// At the begin of its block; the message's octets stand behind it.
  struct Unsent {
    Unsent* next{nullptr};
    std::uint32_t octets{0};
    MessageKind kind{MessageKind::Packet};
  };
  struct Queue {
    std::unique_ptr<LocalBlockPools> pools;
    Unsent* oldest{nullptr};
    Unsent* newest{nullptr};
    std::size_t most{0};
    std::size_t waiting{0};
    std::size_t most_since{0};  ///< take_most_waiting()
    std::uint64_t lost{0};
  };
  [[nodiscard]] static Message message_of(const Unsent& unsent) noexcept;
  static void keep(Queue& queue, const Message& message);
  static void drop_oldest(Queue& queue) noexcept;
  [[nodiscard]] Result<> try_send(Channel& channel, const Message& message);
  [[nodiscard]] const Queue& queue(Worth worth) const noexcept { return queues_[static_cast<std::size_t>(worth)]; }
  std::array<Queue, 3> queues_;
  bool peer_gone_{false};
  std::uint64_t channel_refusals_{0};
};

}  // namespace hirosco
