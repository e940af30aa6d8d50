// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/replies.hpp"

#include <fmt/format.h>

#include <utility>

namespace hirosco::supervisor {

namespace {
constexpr Duration reply_loss_period = 1s;
}

void Replies::hear(std::uint16_t from, const pus::TelemetryView& report) {
  const std::uint16_t to = report.destination();
  if (to == 0 || to == supervisor_apid || to == from) return;
  const Member* asker = craft_.member(to);
  if (asker == nullptr || !asker->alive() || craft_.is_ground_link(*asker)) return;  // that has all reports anyway
  if (from != supervisor_apid && !unanswered_.answers(report)) return;
  Queue& queue = queue_of(*asker);
  flush(*asker, queue);
  if (queue.waiting.empty() && asker->channel()->send({.packet = report.packet()})) return;
  if (queue.waiting.size() == most_waiting) ++queue.lost;
  else queue.waiting.emplace_back(report.packet().begin(), report.packet().end());
}

Replies::Queue& Replies::queue_of(const Member& member) {
  Queue& queue = queues_[member.apid()];
  if (queue.process != member.process()) queue = {.process = member.process()};
  return queue;
}

void Replies::flush(const Member& member, Queue& queue) {
  while (!queue.waiting.empty() && member.channel()->send({.packet = queue.waiting.front()})) queue.waiting.pop_front();
}

void Replies::watch(TimePoint now) {
  for (auto& [apid, queue] : queues_) {
    const Member& member = *craft_.member(apid);
    if (!member.alive() || queue.process != member.process()) {
      queue.waiting.clear();
      continue;
    }
    flush(member, queue);
    if (queue.lost == queue.lost_told || now < queue.next_told) continue;
    queue.next_told = now + reply_loss_period;
    craft_.tell(fmt::format("{} does not read what it asked for: {} reports lost", member.descriptor().name,
                            queue.lost - std::exchange(queue.lost_told, queue.lost)),
                apid);
  }
}

}  // namespace hirosco::supervisor
