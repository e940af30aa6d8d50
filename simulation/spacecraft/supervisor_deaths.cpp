// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <new>

#include "simulation/spacecraft/member.hpp"

/// The supervisor of a simulated spacecraft dies, and another one goes on with what runs (docs/adr/0093).
namespace hirosco::simulation {

namespace {

/// The supervisor's end of a simulated channel: closing it ends the subsystem, as the end of a process would.
class ChannelEnd final : public Channel {
 public:
  /// `kept`: by the keeper, while the supervisor dies.
  ChannelEnd(ChannelPair& pair, const bool& kept) : pair_{pair}, kept_{kept} {}
  ~ChannelEnd() override {
    if (!kept_) pair_.close_supervisor_end();
  }
  Result<> send(const Message& message) override { return pair_.supervisor_end().send(message); }
  Result<Found> receive(MessageBuffer& buffer) override { return pair_.supervisor_end().receive(buffer); }

 private:
  ChannelPair& pair_;
  const bool& kept_;
};

}  // namespace

void Spacecraft::kill_supervisor() {
  if (!supervisor_) return;
  ++supervisor_deaths_;
  const std::uint32_t highest = guard_->highest_epoch();
  supervisor_dies_ = true;
  supervisor_.reset();
  guard_.reset();
  supervisor_dies_ = false;
  supervisor_wake_ = guard_wake_ = never;
  if (!bridge_) return;
  next_first_epoch_ = highest + 1;
  bridge_->begin_at(clock_.now());
  guard_wake_ = clock_.now();
  revive_at_ = clock_.now() + *parts_.revives_after;
}

void Spacecraft::revive_supervisor() {
  revive_at_.reset();
  kept_->wants_inhibits.store(kept_->starts.load() + 1);
  static_cast<void>(bridge_->step(clock_.now()));
  make_supervisor(next_first_epoch_);
  stops_->carry_out([&](bool any) {
    supervisor_->adopt(any);
    return any;
  });
}

void Spacecraft::stop_beside_flight() {
  stops_->count();
  if (guard_) stops_->carry_out([&](bool) { return guard_->stop_all(supervisor::GuardFinding::Kind::StopAsked); });
  else bridge_->stop();
}

void Spacecraft::supervisor_dies_here() {
  if (last_moment_) return;
  auto moment = std::make_unique<LastMoment>();
  for (const auto& member : members_) {
    PermitPage& page = member->newest_permit();
    moment->pages.push_back({&page, page.epoch, page.stop, page.mode_epoch, page.newest_stop, page.powered.load(),
                             page.go, page.heartbeat});
  }
  moment->journal = journal_memory_;
  for (std::size_t i = 0; i < moment->enabled.size(); ++i) moment->enabled[i] = kept_->inhibits[i].go;
  last_moment_ = std::move(moment);
}

void Spacecraft::step_supervisor() {
  const std::uint64_t stops_heard_of = stops_->carried_out();
  supervisor_wake_ = supervisor_->step(clock_.now());
  if (!last_moment_ && supervisor_->remembers()) stops_->taken(stops_heard_of);
  if (!last_moment_) return;
  const std::unique_ptr<LastMoment> moment = std::move(last_moment_);
  for (const LastMoment::Page& then : moment->pages) {
    then.page->epoch = then.epoch;
    then.page->stop = then.stop;
    then.page->mode_epoch = then.mode_epoch;
    then.page->newest_stop = then.newest_stop;
    then.page->powered = then.powered;
    then.page->go = then.go;
    then.page->heartbeat = then.heartbeat;
  }
  std::ranges::copy(moment->journal, journal_memory_.begin());
  for (std::size_t i = 0; i < moment->enabled.size(); ++i) kept_->inhibits[i].go = moment->enabled[i];
  kill_supervisor();
}

Spacecraft::~Spacecraft() = default;

std::unique_ptr<Channel> Spacecraft::supervisor_end(Member& member) {
  std::unique_ptr<Channel> channel = std::make_unique<ChannelEnd>(member.channels, supervisor_dies_);
  return parts_.wrap_channel ? parts_.wrap_channel(member.described->subsystem.name, std::move(channel))
                             : std::move(channel);
}

std::expected<supervisor::AdoptedSubsystem, supervisor::NotAdopted> Spacecraft::adopt(
    const descriptor::MissionSubsystem& described) {
  const auto found = std::ranges::find_if(members_, [&](const auto& member) {
    return member->described->subsystem.id == described.subsystem.id && member->engine.has_value();
  });
  if (found == members_.end()) return std::unexpected{supervisor::NotAdopted{}};
  Member& member = **found;
  const PermitPage& before = member.newest_permit();
  supervisor::AdoptedSubsystem adopted;
  adopted.epoch = before.epoch.load();
  adopted.permitted = before.permits(adopted.epoch);
  adopted.stopped = before.stop.load() != 0;
  adopted.powered = before.powered.load();
  auto handle = memory_.create("permit", sizeof(PermitPage));
  auto page = memory_.map(*handle, Access::ReadWrite);
  auto& fresh = *::new (page->octets.data()) PermitPage;
  fresh.epoch = adopted.epoch;
  fresh.stop = adopted.stopped ? 1 : 0;
  fresh.powered = adopted.powered;
  fresh.newest_stop = before.newest_stop.load();
  static_cast<void>(memory_.seal_writers(*handle));
  member.permits.push_back(*page);
  adopted.permit = std::move(*handle);
  adopted.launched.vital = mapping_of(member.vital);
  adopted.launched.permit = std::move(*page);
  adopted.launched.port = std::make_unique<supervisor::LocalMemberPort>(supervisor_end(member), adopted.launched.vital,
                                                                        adopted.launched.permit);
  adopted.launched.process = static_cast<std::uint32_t>(found - members_.begin() + 1);
  adopted.launched.grip = std::make_shared<Grip>(*this, static_cast<std::size_t>(found - members_.begin()));
  return adopted;
}

}  // namespace hirosco::simulation
