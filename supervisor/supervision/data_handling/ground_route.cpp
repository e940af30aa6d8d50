// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/ground_route.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {

void GroundRoute::send(Channel& link, Octets packet, Kind kind, TimePoint now) {
  if (!waiting()) moved_ = now;
  // The link is asked before anything is dropped for want of room.
  if (reports_.size() + housekeeping_.size() >= std::min(together, limits_.housekeeping)) flush(link, now);
  keep(packet, kind);
}

void GroundRoute::keep(Octets packet, Kind kind) {
  auto& queue = kind == Kind::Housekeeping ? housekeeping_ : reports_;
  Packet& kept = queue.emplace_back(order_++);
  if (!spare_.empty()) {
    kept.octets = std::move(spare_.back());
    spare_.pop_back();
  }
  kept.octets.assign(packet.begin(), packet.end());
  if (housekeeping_.size() > limits_.housekeeping) {
    drop(housekeeping_);
    ++lost_.housekeeping;
  }
  if (kind == Kind::Report) reports_octets_ += packet.size();
  while (reports_octets_ > limits_.reports_octets) {
    reports_octets_ -= reports_.front().octets.size();
    drop(reports_);
    ++lost_.reports;
  }
}

void GroundRoute::drop(std::deque<Packet>& queue) {
  // What a long one has had is given back: in place of many short ones it would be more than the route may hold.
  constexpr std::size_t longest_kept = 1024;
  if (spare_.size() < together && queue.front().octets.capacity() <= longest_kept)
    spare_.push_back(std::move(queue.front().octets));
  queue.pop_front();
}

void GroundRoute::begin_step(TimePoint now) noexcept {
  if (reports_.size() < limits_.busy) next_breath_ = now + limits_.breath;
  if (now < next_breath_) return;
  breath_ = now;
  next_breath_ = now + limits_.breath;
}

void GroundRoute::flush(Channel& link, TimePoint now) {
  if (!waiting()) moved_ = now;
  std::array<Message, together> messages;
  while (waiting()) {
    const std::size_t ready = next(messages);
    const std::size_t sent = link.send_all(std::span{messages}.first(ready));
    if (sent != 0) moved_ = now;
    drop_sent(sent);
    behind_ = sent < ready;
    if (behind_) return;
  }
}

std::size_t GroundRoute::next(std::span<Message, together> messages) const {
  auto report = reports_.begin();
  auto sample = housekeeping_.begin();
  std::size_t count = 0;
  while (count < together && (report != reports_.end() || sample != housekeeping_.end())) {
    const bool report_first =
        sample == housekeeping_.end() || (report != reports_.end() && report->order < sample->order);
    messages[count++] = {.packet = report_first ? (report++)->octets : (sample++)->octets};
  }
  return count;
}

void GroundRoute::drop_sent(std::size_t count) {
  for (; count > 0; --count) {
    const bool report_first =
        housekeeping_.empty() || (!reports_.empty() && reports_.front().order < housekeeping_.front().order);
    if (report_first) reports_octets_ -= reports_.front().octets.size();
    drop(report_first ? reports_ : housekeeping_);
  }
}

void GroundRoute::clear() noexcept {
  lost_.housekeeping += static_cast<std::uint32_t>(housekeeping_.size());
  lost_.reports += static_cast<std::uint32_t>(reports_.size());
  housekeeping_.clear();
  reports_.clear();
  reports_octets_ = 0;
  behind_ = false;
}

}  // namespace hirosco::supervisor
