// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/deliveries.hpp"

#include <utility>

namespace hirosco::supervisor {

namespace {
constexpr Duration heard_loss_period = 1s;
}

void Deliveries::give(const Member& member, Octets packet) {
  Queue& queue = queue_of(member);
  flush(member, queue);
  if (queue.waiting.empty() && member.channel()->send({.packet = packet})) return;
  if (queue.waiting.size() == most_waiting) ++queue.lost;
  else queue.waiting.emplace_back(packet.begin(), packet.end());
}

Deliveries::Queue& Deliveries::queue_of(const Member& member) {
  Queue& queue = queues_[member.apid()];
  if (queue.process != member.process()) queue = {.process = member.process()};
  return queue;
}

void Deliveries::flush(const Member& member, Queue& queue) {
  while (!queue.waiting.empty() && member.channel()->send({.packet = queue.waiting.front()})) queue.waiting.pop_front();
}

void Deliveries::watch(TimePoint now) {
  for (auto& [apid, queue] : queues_) {
    const Member& member = *craft_.member(apid);
    if (!member.alive() || queue.process != member.process()) {
      queue.waiting.clear();
      continue;
    }
    flush(member, queue);
    if (queue.lost == queue.lost_told || now < queue.next_told) continue;
    queue.next_told = now + heard_loss_period;
    lost_(member, queue.lost - std::exchange(queue.lost_told, queue.lost));
  }
}

}  // namespace hirosco::supervisor
