// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/ground_route.hpp"

namespace hirosco::supervisor {

void GroundRoute::send(Channel& link, Octets packet, Kind kind, TimePoint now) {
  flush(link, now);
  if (!waiting() && link.send({.packet = packet})) return;
  keep(packet, kind);
}

void GroundRoute::keep(Octets packet, Kind kind) {
  auto& queue = kind == Kind::Housekeeping ? housekeeping_ : reports_;
  queue.push_back({order_++, {packet.begin(), packet.end()}});
  if (housekeeping_.size() > limits_.housekeeping) {
    housekeeping_.pop_front();
    ++lost_.housekeeping;
  }
  if (kind == Kind::Report) reports_octets_ += packet.size();
  while (reports_octets_ > limits_.reports_octets) {
    reports_octets_ -= reports_.front().octets.size();
    reports_.pop_front();
    ++lost_.reports;
  }
}

void GroundRoute::flush(Channel& link, TimePoint now) {
  if (!waiting()) moved_ = now;
  while (waiting()) {
    const bool report_first =
        housekeeping_.empty() || (!reports_.empty() && reports_.front().order < housekeeping_.front().order);
    auto& queue = report_first ? reports_ : housekeeping_;
    if (!link.send({.packet = queue.front().octets})) return;
    moved_ = now;
    if (report_first) reports_octets_ -= queue.front().octets.size();
    queue.pop_front();
  }
}

void GroundRoute::clear() noexcept {
  lost_.housekeeping += static_cast<std::uint32_t>(housekeeping_.size());
  lost_.reports += static_cast<std::uint32_t>(reports_.size());
  housekeeping_.clear();
  reports_.clear();
  reports_octets_ = 0;
}

}  // namespace hirosco::supervisor
