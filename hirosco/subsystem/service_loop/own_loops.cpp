// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// The loops of services of its own that a subsystem has (adr 0096), as its service loop sees them.
namespace hirosco {
namespace {

/// Of what passes between two looks: while the whole computer stood nobody hung.
constexpr Duration most_passed_a_look = 100ms;

}  // namespace

std::vector<std::unique_ptr<OwnLoop>> GenericSubsystem::make_loops() {
  std::vector<std::unique_ptr<OwnLoop>> loops;
  for (const descriptor::ServiceLoop& declared : descriptor_.service_loops)
    loops.push_back(std::make_unique<OwnLoop>(OwnLoop::Parts{.declared = declared,
                                                             .subsystem = *this,
                                                             .vital = vital_,
                                                             .permit = *permit_,
                                                             .clock = platform_.clock,
                                                             .dictionary = dictionary_,
                                                             .writes = writes_,
                                                             .meter = loop_meter_,
                                                             .place = loops.size()}));
  return loops;
}

OwnLoop* GenericSubsystem::loop_of(std::uint8_t type) noexcept {
  if (loops_.empty()) return nullptr;
  const int loop = descriptor_.loop_of(type);
  return loop < 0 ? nullptr : loops_[static_cast<std::size_t>(loop)].get();
}

pus::ServiceHome& GenericSubsystem::home_of(std::uint8_t type) noexcept {
  if (OwnLoop* const loop = loop_of(type)) return *loop;
  return *this;
}

bool GenericSubsystem::has_reports() const noexcept {
  return rings_.reports_wait() || std::ranges::any_of(loops_, [](const auto& loop) { return loop->has_reports(); });
}

void GenericSubsystem::take_loop_reports() {
  if (loops_.empty()) return;
  const OwnLoop::Listener listener{
      .has_room = [this] { return backlog_.answers_have_room(); },
      .report = [this](std::uint8_t service, std::uint8_t subtype, std::uint16_t destination,
                       Octets data) { report(service, subtype, destination, data); },
      .event = [this](std::uint16_t event, Octets auxiliary) { raise_event(event, auxiliary); }};
  for (const auto& loop : loops_) loop->tell(listener);
}

bool GenericSubsystem::loops_move(TimePoint now) {
  const Duration passed = std::min(now - std::exchange(loops_looked_at_, now), most_passed_a_look);
  bool all = true;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (!loops_[i]->hangs(passed)) continue;
    all = false;
    if (!loops_[i]->newly_hangs()) continue;
    const std::array<double, 2> arguments{static_cast<double>(i), static_cast<double>(loops_[i]->stands_for() / 1ms)};
    raise_in_service(descriptor::framework_event::service_loop_hangs, arguments);
  }
  return all;
}

Result<> GenericSubsystem::store(const ParameterCell& parameter, Octets big_endian) {
  for (std::size_t i = 0; i < dictionary_.size(); ++i) {
    if (dictionary_.cell(i) != &parameter) continue;
    const ParameterWrite write{static_cast<std::uint16_t>(i), -1, big_endian};
    HIROSCO_TRY(writes_.enqueue(dictionary_, {&write, 1}));
    if (cycle_rests()) writes_.apply(dictionary_);
    return ok();
  }
  return fail(ErrorCode::NotFound, "the parameter is not published");
}

Result<> GenericSubsystem::raise(std::string_view event, Octets auxiliary) {
  raise_named(event, auxiliary);
  return ok();
}

}  // namespace hirosco
