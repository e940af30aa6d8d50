// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/own_loops.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"

namespace hirosco {
namespace {

/// Of what passes between two looks: while the whole computer stood nobody hung.
constexpr Duration most_passed_a_look = 100ms;

}  // namespace

OwnLoops::OwnLoops(const Parts& parts)
    : descriptor_{parts.descriptor}, subsystem_{parts.subsystem}, clock_{parts.clock}, looked_at_{parts.clock.now()} {
  const std::uint32_t reports_octets = descriptor_.resources.queues.loop_reports_octets;
  for (const descriptor::ServiceLoop& declared : descriptor_.service_loops)
    loops_.push_back(std::make_unique<OwnLoop>(OwnLoop::Parts{.declared = declared,
                                                              .subsystem = parts.subsystem,
                                                              .vital = parts.vital,
                                                              .permit = parts.permit,
                                                              .clock = parts.clock,
                                                              .dictionary = parts.values.dictionary(),
                                                              .writes = parts.values.writes(),
                                                              .meter = parts.meter,
                                                              .place = loops_.size(),
                                                              .reports_octets = reports_octets}));
}

OwnLoop* OwnLoops::of(std::uint8_t type) noexcept {
  if (loops_.empty()) return nullptr;
  const int loop = descriptor_.loop_of(type);
  return loop < 0 ? nullptr : loops_[static_cast<std::size_t>(loop)].get();
}

pus::ServiceHome& OwnLoops::home_of(std::uint8_t type) noexcept {
  if (OwnLoop* const loop = of(type)) return *loop;
  return subsystem_;
}

const std::vector<pus::Service*>& OwnLoops::in_none(const std::vector<pus::Service*>& services) {
  for (; sorted_ < services.size(); ++sorted_)
    if (pus::Service* const service = services[sorted_]; of(service->type()) == nullptr) in_none_.push_back(service);
  return in_none_;
}

void OwnLoops::follow(const descriptor::Configuration* in_force) noexcept {
  const TimePoint now = clock_.now();
  for (std::size_t i = 0; i < loops_.size(); ++i) loops_[i]->follow(descriptor_.loop_in_force(i, in_force), now);
}

void OwnLoops::take_permit(const PermitPage& page) noexcept {
  for (const auto& loop : loops_) loop->take_permit(page);
}

bool OwnLoops::has_reports() const noexcept {
  return std::ranges::any_of(loops_, [](const auto& loop) { return loop->has_reports(); });
}

void OwnLoops::tell(Reports& reports) {
  if (loops_.empty()) return;
  const OwnLoop::Listener listener{
      .has_room = [&] { return reports.answers_have_room(); },
      .report = [&](std::uint8_t service, std::uint8_t subtype, std::uint16_t destination,
                    Octets data) { reports.report(service, subtype, destination, data); },
      .event = [&](std::uint16_t event, Octets auxiliary) { reports.raise_encoded(event, auxiliary); }};
  for (const auto& loop : loops_) loop->tell(listener);
}

std::uint64_t OwnLoops::lost() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& loop : loops_) sum += loop->lost();
  return sum;
}

AllocationCount OwnLoops::take_heap_uses() noexcept {
  AllocationCount sum;
  for (const auto& loop : loops_) sum += loop->heap_uses();
  const AllocationCount before = std::exchange(told_uses_, sum);
  return {.allocations = sum.allocations - before.allocations, .frees = sum.frees - before.frees};
}

OwnLoop::Fills OwnLoops::take_fills() noexcept {
  OwnLoop::Fills fullest;
  const auto take = [](QueueFill& so_far, const QueueFill& found) {
    if (so_far.room == 0 || std::uint64_t{found.most} * so_far.room > std::uint64_t{so_far.most} * found.room)
      so_far = found;
  };
  for (const auto& loop : loops_) {
    const OwnLoop::Fills found = loop->take_fills();
    take(fullest.requests, found.requests);
    take(fullest.reports, found.reports);
    if (found.judged.room != 0) take(fullest.judged, found.judged);
  }
  return fullest;
}

bool OwnLoops::move(TimePoint now, Reports& reports) {
  const Duration passed = std::min(now - std::exchange(looked_at_, now), most_passed_a_look);
  bool all = true;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (!loops_[i]->hangs(passed)) continue;
    all = false;
    if (!loops_[i]->newly_hangs()) continue;
    const std::array<double, 2> arguments{static_cast<double>(i), static_cast<double>(loops_[i]->stands_for() / 1ms)};
    reports.raise(descriptor::framework_event::service_loop_hangs, arguments);
  }
  return all;
}

}  // namespace hirosco
