// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/backlog.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace hirosco {
namespace {

/// A message that is refused for what it is would be refused for ever: it must not hold up those behind it.
[[nodiscard]] bool worth_another_try(const Error& error) noexcept {
  return error.code == ErrorCode::ResourceExhausted || error.code == ErrorCode::Unavailable;
}

}  // namespace

Backlog::Backlog(const descriptor::Waiting& most) {
  static_assert(descriptor::waiting_pools(1)[2].block_octets == sizeof(Unsent) + max_packet_octets);
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    Queue& queue = queues_[i];
    queue.most = most[i];
    std::array<PoolSpec, 3> pools;
    std::ranges::transform(descriptor::waiting_pools(most[i]), pools.begin(),
                           [](const descriptor::Pool& pool) { return PoolSpec{pool.block_octets, pool.blocks}; });
    auto made = LocalBlockPools::create(pools, {.warning_percent = 0, .on_warning = {}, .on_refusal = {}});
    if (!made) throw std::bad_alloc{};
    queue.pools = std::move(*made);
  }
}

void Backlog::send(Channel& channel, const Message& message, Worth worth) {
  const auto own = static_cast<std::size_t>(worth);
  const bool free = std::all_of(queues_.begin(), queues_.begin() + static_cast<std::ptrdiff_t>(own) + 1,
                                [](const Queue& queue) { return queue.waiting == 0; });
  Queue& queue = queues_[own];
  if (free) {
    const auto sent = try_send(channel, message);
    if (sent) return;
    if (!worth_another_try(sent.error())) {
      ++queue.lost;
      return;
    }
  }
  keep(queue, message);
}

void Backlog::keep(Queue& queue, const Message& message) {
  const std::size_t octets = sizeof(Unsent) + message.packet.size();
  while (queue.waiting >= queue.most) {
    drop_oldest(queue);
    ++queue.lost;
  }
  void* block = queue.pools->allocate(octets);
  while (block == nullptr && queue.waiting != 0 && octets <= queue.pools->largest_block()) {
    drop_oldest(queue);
    ++queue.lost;
    block = queue.pools->allocate(octets);
  }
  if (block == nullptr) {
    ++queue.lost;
    return;
  }
  auto* const unsent =
      ::new (block) Unsent{.octets = static_cast<std::uint32_t>(message.packet.size()), .kind = message.kind};
  if (!message.packet.empty()) std::memcpy(unsent + 1, message.packet.data(), message.packet.size());
  (queue.newest != nullptr ? queue.newest->next : queue.oldest) = unsent;
  queue.newest = unsent;
  ++queue.waiting;
  queue.most_since = std::max(queue.most_since, queue.waiting);
}

void Backlog::drop_oldest(Queue& queue) noexcept {
  Unsent* const oldest = queue.oldest;
  queue.oldest = oldest->next;
  if (queue.oldest == nullptr) queue.newest = nullptr;
  --queue.waiting;
  static_cast<void>(queue.pools->deallocate(oldest));
}

Message Backlog::message_of(const Unsent& unsent) noexcept {
  return {.kind = unsent.kind, .packet = {reinterpret_cast<const std::byte*>(&unsent + 1), unsent.octets}};
}

void Backlog::flush(Channel& channel) {
  for (Queue& queue : queues_)
    while (queue.waiting != 0) {
      const auto sent = try_send(channel, message_of(*queue.oldest));
      if (!sent && worth_another_try(sent.error())) return;
      if (!sent) ++queue.lost;
      drop_oldest(queue);
    }
}

Result<> Backlog::try_send(Channel& channel, const Message& message) {
  auto sent = channel.send(message);
  peer_gone_ = !sent && sent.error().code == ErrorCode::Unavailable;
  if (!sent && sent.error().code == ErrorCode::ResourceExhausted) ++channel_refusals_;
  return sent;
}

descriptor::Waiting Backlog::take_most_waiting() noexcept {
  descriptor::Waiting most{};
  std::ranges::transform(queues_, most.begin(), [](Queue& queue) {
    return static_cast<std::uint32_t>(std::exchange(queue.most_since, queue.waiting));
  });
  return most;
}

bool Backlog::empty() const noexcept {
  return std::ranges::all_of(queues_, [](const Queue& queue) { return queue.waiting == 0; });
}

bool Backlog::answers_have_room() const noexcept {
  const Queue& answers = queue(Worth::Answer);
  const PoolUsage longest = answers.pools->usage(answers.pools->size() - 1);
  return peer_gone_ || (answers.waiting < answers.most / 2 && longest.used < longest.count / 2);
}

}  // namespace hirosco
