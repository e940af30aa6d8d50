// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/backlog.hpp"

#include <algorithm>

namespace hirosco {
namespace {

/// A message that is refused for what it is would be refused for ever: it must not hold up those behind it.
[[nodiscard]] bool worth_another_try(const Error& error) noexcept {
  return error.code == ErrorCode::ResourceExhausted || error.code == ErrorCode::Unavailable;
}

}  // namespace

void Backlog::send(Channel& channel, const Message& message, Worth worth) {
  const auto own = static_cast<std::size_t>(worth);
  const bool free = std::all_of(queues_.begin(), queues_.begin() + static_cast<std::ptrdiff_t>(own) + 1,
                                [](const Queue& queue) { return queue.waiting.empty(); });
  Queue& queue = queues_[own];
  if (free) {
    const auto sent = try_send(channel, message);
    if (sent) return;
    if (!worth_another_try(sent.error())) {
      ++queue.lost;
      return;
    }
  }
  if (queue.waiting.size() == most_waiting) {
    queue.waiting.pop_front();
    ++queue.lost;
  }
  queue.waiting.push_back({message.kind, {message.packet.begin(), message.packet.end()}});
}

void Backlog::flush(Channel& channel) {
  for (Queue& queue : queues_)
    while (!queue.waiting.empty()) {
      const Unsent& next = queue.waiting.front();
      const auto sent = try_send(channel, {.kind = next.kind, .packet = next.packet});
      if (!sent && worth_another_try(sent.error())) return;
      if (!sent) ++queue.lost;
      queue.waiting.pop_front();
    }
}

Result<> Backlog::try_send(Channel& channel, const Message& message) {
  auto sent = channel.send(message);
  peer_gone_ = !sent && sent.error().code == ErrorCode::Unavailable;
  return sent;
}

bool Backlog::empty() const noexcept {
  return std::ranges::all_of(queues_, [](const Queue& queue) { return queue.waiting.empty(); });
}

}  // namespace hirosco
