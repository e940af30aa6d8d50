// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_supervisor.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::simulation {
namespace {

[[nodiscard]] std::uint16_t first_count(std::uint64_t seed) {
  constexpr std::uint64_t multiplier = 0x9E37'79B9'7F4A'7C15;
  return static_cast<std::uint16_t>((seed * multiplier) >> 50);
}

}  // namespace

SimulatedSupervisor::SimulatedSupervisor(Parts parts) : parts_{std::move(parts)} { make(1); }

void SimulatedSupervisor::make(std::uint32_t first_epoch) {
  parts_.keeper.count_start();
  guard_.emplace(supervisor::Guard::Parts{.clock = clock_,
                                          .flows = parts_.platform.flows,
                                          .first_epoch = first_epoch,
                                          .notes = supervisor::InhibitNotes{parts_.mission, parts_.keeper.page()},
                                          .on_finding = [this] {
                                            if (supervisor_wake_ != never) supervisor_wake_ = clock_.now();
                                          }});
  guard_wake_ = clock_.now();
  supervisor_ = std::make_unique<supervisor::Supervisor>(
      supervisor::Supervisor::Parts{.mission = parts_.mission,
                                    .platform = parts_.platform,
                                    .launcher = parts_.processes,
                                    .guard = *guard_,
                                    .log = parts_.stores.log(),
                                    .open_database = parts_.stores.open_database(),
                                    .observer = parts_.observer,
                                    .first_sequence_count = first_count(parts_.seed + parts_.keeper.starts() - 1),
                                    .journal = parts_.keeper.journal(),
                                    .values = &parts_.stores.values(),
                                    .log_readings = parts_.stores.begin_log_readings(),
                                    .readings = &parts_.stores.readings()});
  supervisor_wake_ = clock_.now();
}

// --- virtual time ------------------------------------------------------------------------------------------------------

TimePoint SimulatedSupervisor::next_wake() const noexcept {
  return std::min({supervisor_due(), guard_wake_, revive_at_.value_or(never), ended_at()});
}

void SimulatedSupervisor::step(TimePoint now) {
  if (ended_at() <= now) kill();
  if (revive_at_ && *revive_at_ <= now) revive(now);
  if (guard_wake_ <= now) guard_wake_ = guard_ ? guard_->step(now) : parts_.keeper.step(now);
  if (supervisor_due() <= now) step_supervisor(now);
}

void SimulatedSupervisor::step_supervisor(TimePoint now) {
  const std::uint64_t stops_heard_of = parts_.keeper.stops().carried_out();
  if (on_step_) on_step_(Moment::Begins);
  supervisor_wake_ = supervisor_->step(now);
  if (!last_moment_ && supervisor_->remembers()) parts_.keeper.stops().taken(stops_heard_of);
  if (last_moment_) {
    std::exchange(last_moment_, nullptr)->put_back();
    kill();
  }
  if (on_step_) on_step_(Moment::Ends);
}

void SimulatedSupervisor::stop(bool stopped) {
  if (!supervisor_) return;  // what is due then is the keeper's
  supervisor_wake_ = guard_wake_ = stopped ? never : clock_.now();
}

void SimulatedSupervisor::hang(Duration span) {
  if (!supervisor_) return;
  const TimePoint now = clock_.now();
  if (hangs_until_ <= now) patience_over_ = now + supervisor::supervisor_patience;
  hangs_until_ = std::max(hangs_until_, now + span);
}

TimePoint SimulatedSupervisor::ended_at() const noexcept {
  return parts_.keeper.revives() && hangs_until_ > patience_over_ ? patience_over_ : never;
}

void SimulatedSupervisor::stop_beside_flight() {
  supervisor::AskedStops& stops = parts_.keeper.stops();
  stops.count();
  if (guard_) stops.carry_out([&](bool) { return guard_->stop_all(supervisor::GuardFinding::Kind::StopAsked); });
  else parts_.keeper.stop_all();
}

// --- its death ---------------------------------------------------------------------------------------------------------

void SimulatedSupervisor::kill(std::optional<Duration> pause) {
  if (!supervisor_) return;
  ++deaths_;
  const std::uint32_t highest = guard_->highest_epoch();
  parts_.processes.keep_channels(true);
  supervisor_.reset();
  guard_.reset();
  parts_.processes.keep_channels(false);
  supervisor_wake_ = guard_wake_ = never;
  hangs_until_ = patience_over_ = {};
  const auto next_one = parts_.keeper.lose_supervisor(clock_.now(), pause);
  if (!next_one) return;
  next_first_epoch_ = highest + 1;
  guard_wake_ = clock_.now();
  revive_at_ = next_one;
}

void SimulatedSupervisor::die_here() {
  if (!last_moment_) last_moment_ = std::make_unique<LastMoment>(parts_.processes, parts_.keeper);
}

void SimulatedSupervisor::revive(TimePoint now) {
  revive_at_.reset();
  parts_.keeper.give_back(now);
  make(next_first_epoch_);
  parts_.keeper.stops().carry_out([&](bool any) {
    supervisor_->adopt(any);
    return any;
  });
}

}  // namespace hirosco::simulation
