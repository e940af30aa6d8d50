// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervisor.hpp"

#include <algorithm>
#include <utility>

#include "supervisor/composition.hpp"

namespace hirosco::supervisor {

namespace {
/// How often processes, hangs and time limits are looked at: the supervisor's own cycle.
constexpr Duration watch_period = Guard::observation_period;
constexpr Duration ground_pace = 1ms;
/// What came for the supervisor itself behind its turn waits so long, as for somebody who must not be let spin.
constexpr Duration own_pace = 1ms;
}  // namespace

Supervisor::Supervisor(const Parts& parts) : parts_{std::make_unique<SupervisorParts>(parts)} {}
Supervisor::~Supervisor() = default;

void Supervisor::start() {
  Craft& craft = parts_->craft;
  craft.now = craft.platform.clock.now();
  parts_->own.start(craft.mode_epoch);
  craft.guard.beat();
  parts_->stored.begin();
  parts_->processes.start_all();
  parts_->commissioning.start([this] { request_shutdown("commissioning, which failed"); });
}

void Supervisor::adopt(bool stop_asked) {
  Craft& craft = parts_->craft;
  craft.now = craft.platform.clock.now();
  parts_->own.start(craft.mode_epoch);
  craft.guard.beat();
  parts_->adoption.begin(stop_asked);
  // Whoever is found dead, or dies before this one has carried it out, is not brought back by what was commanded before.
  if (parts_->adoption.stop_asked()) parts_->commanded.all_stopped();
  parts_->own.enter_mode(craft.mode_epoch);
  parts_->subscriptions.go_on();
  values_to_read_ = true;
}

TimePoint Supervisor::step(TimePoint now) {
  Craft& craft = parts_->craft;
  craft.now = now;
  craft.guard.beat();
  // A disk that stands still holds this loop up, as the guard then finds. Nobody is started, heard or brought back before it.
  if (std::exchange(values_to_read_, false)) parts_->stored.begin();
  parts_->processes.take_guard_findings();
  const std::uint64_t beat = parts_->own.beats() + 1;
  parts_->own.beat(beat);
  for (Member& member : craft.members) member.beat(beat, now);

  parts_->ground_route.begin_step(now);
  for (Member& member : craft.members) parts_->reception.read(member);
  parts_->processes.watch_closed();
  parts_->safe_all.ground_hears(!parts_->adoption.waits() && parts_->telemetry.ground_hears());
  parts_->safe_all.follow();
  parts_->telecommands.forward_durable();
  TimePoint wake = parts_->own.step(now);
  parts_->reception.read_own();

  if (now >= next_watch_) {
    next_watch_ = now + watch_period;
    for (Watch* watch : parts_->watches) watch->watch(now);
  }
  parts_->shutdown.enforce(now);
  parts_->telemetry.serve_ground();  // all that this step had to say, together
  if (!parts_->telemetry.ground().waiting()) {
    parts_->unanswered.delivered();
    parts_->safe_all.delivered();
  }
  note();
  if (parts_->telemetry.ground().waiting()) wake = std::min(wake, now + ground_pace);
  // Where nothing wakes, it is looked at as often anyway.
  if (craft.platform.wakes && parts_->own.has_work()) wake = std::min(wake, now + own_pace);
  return std::min(wake, next_watch_);
}

void Supervisor::note() {
  noted_ = parts_->memory.note();
  if (noted_ || std::exchange(not_noted_told_, true)) return;
  parts_->craft.tell(
      "what this supervisor knows is too long for its journal: if it dies while that is so, all that moves is stopped",
      supervisor_apid);
  parts_->own.announce("JOURNAL_FULL");
}

void Supervisor::request_shutdown(std::string_view by) { parts_->shutdown.request(by); }

void Supervisor::keeper_stands_still() {
  parts_->craft.tell("the keeper stands still: nobody would end the devices and subsystems if this supervisor died",
                     supervisor_apid);
  parts_->own.announce("KEEPER_STILL");
}

void Supervisor::keeper_lost() {
  parts_->craft.tell(
      "the keeper is gone: if this supervisor dies, too, nobody goes on for it, and what moves stops by itself",
      supervisor_apid);
  parts_->own.announce("KEEPER_LOST");
}

bool Supervisor::finished() const noexcept { return parts_->shutdown.finished(); }
bool Supervisor::succeeded() const noexcept { return !parts_->craft.failed(); }
bool Supervisor::commissioned() const noexcept { return parts_->commissioning.succeeded(); }
std::string Supervisor::waiting_for() const {
  return parts_->craft.shutting_down ? parts_->shutdown.waiting_for() : parts_->commissioning.waiting_for();
}
const std::vector<Member>& Supervisor::members() const noexcept { return parts_->craft.members; }
const descriptor::Mission& Supervisor::mission() const noexcept { return parts_->craft.mission; }
const descriptor::Mode& Supervisor::mode() const noexcept { return *parts_->craft.mode; }
const LinkGraph& Supervisor::links() const noexcept { return parts_->links.graph(); }
descriptor::State Supervisor::own_state() const noexcept { return parts_->own.state(); }
MemberStatistics Supervisor::own_statistics() const noexcept { return parts_->own.statistics(); }
bool Supervisor::reads(const Member& member) const { return parts_->reception.reads(member); }

}  // namespace hirosco::supervisor
