// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/link_losses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "supervisor/supervision/procedures/steps/shut_down_network.hpp"
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor {

using descriptor::OnLoss;

Member& LinkLosses::consumer_of(const descriptor::MissionLink& link) {
  return *craft_.member(craft_.mission.find_subsystem(link.to)->subsystem.id);
}

void LinkLosses::lost(std::uint8_t id) {
  const descriptor::MissionLink& link = *craft_.mission.find_link(id);
  Member& consumer = consumer_of(link);
  // Who goes down anyway needs no word, nor who is told already.
  if (link.on_loss == OnLoss::Down || craft_.shutting_down || !consumer.alive() || consumer.recovery.running()) return;
  if (holds_.contains(id) || leads(consumer.apid())) return;
  // A change of mode has its members in hand: what is missed after it still is found then (watch()). The cycle inhibits meanwhile.
  if (link.on_loss == OnLoss::Fallback && craft_.changing_to != nullptr) return;
  own_.announce("LINK_LOST", {static_cast<double>(id), static_cast<double>(consumer.apid())});
  craft_.tell(fmt::format("{} has lost {} of {}: {}", link.to, link.requires_, link.from, to_text(link.on_loss)),
              consumer.apid());
  if (link.on_loss == OnLoss::Hold) holds_[id] = craft_.now + link.hold;
  if (link.on_loss == OnLoss::Ignore) holds_[id] = TimePoint::max();  // told once
  if (link.on_loss == OnLoss::Fallback) fall_back(link, consumer);
}

/// The event of the consumer's own cycle: its producer may live and say nothing, or this be quicker than its end.
bool LinkLosses::answers(std::uint16_t apid, std::string_view event) {
  const std::uint8_t id = answered_link(apid, event);
  if (id != 0) lost(id);
  return id != 0;
}

std::uint8_t LinkLosses::answered_link(std::uint16_t apid, std::string_view event) const {
  constexpr std::string_view stale = "_STALE";
  if (!event.ends_with(stale)) return 0;
  const std::uint8_t id = means_.links.link_into(apid, event.substr(0, event.size() - stale.size()));
  const auto* link = craft_.mission.find_link(id);
  return link == nullptr || link->on_loss == OnLoss::Down ? std::uint8_t{0} : id;
}

void LinkLosses::fall_back(const descriptor::MissionLink& link, Member& consumer) {
  const auto* configuration = consumer.descriptor().find_configuration(link.fallback);
  const auto state = consumer.state();
  const bool acts = state == State::SafeOperational || state == State::Operational;
  if (!acts || consumer.configuration() == configuration->id) return;
  const std::uint16_t apid = consumer.apid();
  // With what is lost nobody goes on acting, whoever obeys and whenever.
  const std::uint64_t own_fence = craft_.guard.fence(apid);
  // Who was stopped before stays so: its way ends where it lets nobody move.
  const bool stopped = own_fence - 1 != consumer.fences_when_free;
  lead_there(link, own_fence, stopped ? State::SafeOperational : *state, Begun::Now);
}

void LinkLosses::lead_there(const descriptor::MissionLink& link, std::uint64_t own_fence, State to, Begun begun) {
  const Member& consumer = consumer_of(link);
  const std::uint16_t apid = consumer.apid();
  WayThere way;
  way.add(consumer.descriptor(), *consumer.descriptor().find_configuration(link.fallback),
          {consumer.state(), consumer.configuration()}, to);
  Fallback& fallback = fallbacks_.try_emplace(apid, means_).first->second;
  fallback.fences = own_fence;
  fallback.link = link.id;
  fallback.begins = true;
  // Between the two configurations nobody would bring it any further, or tell of it.
  craft_.remember();
  fallback.begins = false;
  fallback.runner.start(
      {.stages = way.stages(),
       .finished =
           [this, &link, apid, own_fence, begun](const ProcedureEnd& end) {
             if (!craft_.member(apid)->alive() || craft_.shutting_down) return;
             // A change of mode that began meanwhile has it in hand.
             if (means_.under_way.moving(apid) != Moving::No) return;
             if (!end.success) return bring_down(link, end.text());
             const bool rests = begun == Begun::Before || craft_.guard.fences(apid) != own_fence;
             craft_.tell(
                 fmt::format("{} {} configuration {}", link.to, rests ? "was stopped in" : "goes on in", link.fallback),
                 apid);
           },
       .begins =
           [this, apid](std::size_t) {
             const auto found = fallbacks_.find(apid);
             const bool stopped_since = found != fallbacks_.end() && craft_.guard.fences(apid) != found->second.fences;
             const bool other = craft_.changing_to != nullptr || craft_.member(apid)->recovery.running();
             if (found != fallbacks_.end() && (stopped_since || other)) found->second.runner.cancel();
           },
       .knows_of_no_stop = true});
}

std::uint32_t LinkLosses::judgement_of(const descriptor::MissionLink& link) {
  const Member& consumer = consumer_of(link);
  const std::uint8_t in_use = means_.links.link_into(consumer.apid(), link.requires_);
  const auto statistics = consumer.statistics();
  if (!statistics || !means_.links.is_up(in_use)) return link_not_judged;
  const auto found = std::ranges::find(statistics->incoming, in_use, &MemberStatistics::Incoming::link);
  return found != statistics->incoming.end() ? found->judged : std::uint32_t{link_not_judged};
}

bool LinkLosses::is_back(const descriptor::MissionLink& link) {
  if (judgement_of(link) != link_valid) return false;
  const auto& in_use = *craft_.mission.find_link(means_.links.link_into(consumer_of(link).apid(), link.requires_));
  return !craft_.member(craft_.mission.find_subsystem(in_use.from)->subsystem.id)->recovery.going_down();
}

/// No plan may have taken its producer down, which may have left in good order, and the event of a consumer that says so may have come
/// while nobody could answer it. Whom somebody has stopped misses nothing that is there and old: it goes where that leads it.
bool LinkLosses::is_missed(const descriptor::MissionLink& link) {
  const Member& consumer = consumer_of(link);
  if (consumer.state() != State::Operational || !is_needed(link)) return false;
  // The time of its hold was over on its way out: that was told.
  if (craft_.guard.fenced(consumer.apid()) && means_.under_way.moving(consumer.apid()) == Moving::ToItsStop)
    return false;
  if (!means_.links.is_up(means_.links.link_into(consumer.apid(), link.requires_))) return true;
  return judgement_of(link) == link_stale && !craft_.guard.fenced(consumer.apid());
}

/// Its consumer may have another configuration by now, or have gone down in good order.
bool LinkLosses::is_needed(const descriptor::MissionLink& link) {
  const Member& consumer = consumer_of(link);
  const auto* configuration = consumer.descriptor().find_configuration(consumer.configuration());
  return configuration != nullptr &&
         std::ranges::any_of(configuration->requires_, [&](const auto& set) { return set.name == link.requires_; });
}

void LinkLosses::watch(TimePoint now) {
  std::erase_if(fallbacks_, [](const auto& entry) { return !entry.second.runner.running(); });
  if (ends_what_was_begun_) end_what_was_begun();
  for (const descriptor::MissionLink& link : craft_.mission.links)
    if (link.on_loss != OnLoss::Down && is_missed(link)) lost(link.id);
  std::vector<std::uint8_t> over;
  std::erase_if(holds_, [&](const auto& entry) {
    const descriptor::MissionLink& link = *craft_.mission.find_link(entry.first);
    if (is_back(link) || is_made_anew(link)) return true;
    if (now < entry.second) return false;
    over.push_back(entry.first);
    return true;
  });
  for (const std::uint8_t id : over) held_long_enough(*craft_.mission.find_link(id));
}

/// A change of mode has taken its consumer out of Operational and makes what that needs anew, or leads it where it needs nothing: what is
/// missed behind that is another loss.
bool LinkLosses::is_made_anew(const descriptor::MissionLink& link) {
  const Member& consumer = consumer_of(link);
  return means_.under_way.moving(consumer.apid()) == Moving::Beyond && consumer.state() != State::Operational;
}

void LinkLosses::held_long_enough(const descriptor::MissionLink& link) {
  if (!is_needed(link)) return;
  const Member& consumer = consumer_of(link);
  const std::string why = fmt::format("{} did not come back in time", link.requires_);
  // From here on it does not act with what is lost, and a change that stops it anyway needs no end for that.
  if (means_.under_way.moving(consumer.apid()) != Moving::ToItsStop) return bring_down(link, why);
  means_.under_way.stop_now(consumer.apid());
  craft_.tell(fmt::format("{}: {}: it is stopped, and the change of mode goes on", link.to, why), consumer.apid());
}

void LinkLosses::bring_down(const descriptor::MissionLink& link, const std::string& why) {
  const Member& consumer = consumer_of(link);
  const bool can = consumer.alive() && consumer.state() && *consumer.state() != State::Offline;
  if (!can || craft_.shutting_down || consumer.recovery.running()) return;
  craft_.tell(fmt::format("{}: {}", link.to, why), consumer.apid());
  ProcedureStep down = step("shut_down_network", consumer.apid(), {});
  down.occasion.plan = fmt::format("on loss of link {}", link.id);
  if (craft_.changing_to != nullptr) {
    // Who asked for the change hears of the link; whoever is about to go down stands before anything is told.
    for (const std::uint16_t apid : steps::network::members(down, means_)) craft_.guard.fence(apid);
    static_cast<void>(means_.under_way.cancel(fmt::format("link {}: {}: {}", link.id, link.to, why)));
  }
  ProcedureRunner{means_}.start({.stages = {{down}}});
}

void LinkLosses::end_what_was_begun() {
  ends_what_was_begun_ = true;
  std::erase_if(begun_before_, [this](std::uint8_t id) { return goes_to_rest(*craft_.mission.find_link(id)); });
}

/// Nobody knows whether its consumer was stopped meanwhile by somebody else: it goes where it was led, and lets nobody move there.
bool LinkLosses::goes_to_rest(const descriptor::MissionLink& link) {
  const Member& consumer = consumer_of(link);
  const auto state = consumer.state();
  if (!consumer.alive() || consumer.recovery.running() || leads(consumer.apid()) || state == State::Offline)
    return true;
  using enum State;
  const bool between = state != PreOperational && state != SafeOperational && state != Operational &&
                       state != ErrorOperational && state != PostOperational;
  if (between) return false;
  const auto* configuration = consumer.descriptor().find_configuration(link.fallback);
  const bool there = configuration == nullptr || consumer.configuration() == configuration->id;
  if (there && state == Operational) return true;
  const bool rests = there && state == SafeOperational;
  const std::string why = fmt::format("was on its way to configuration {} when the supervisor died", link.fallback);
  if (state == ErrorOperational) {
    bring_down(link, why);
    return true;
  }
  craft_.tell(fmt::format("{} {}: it {} there", link.to, why, rests ? "rests" : "comes to rest"), consumer.apid());
  if (!rests) lead_there(link, craft_.guard.fence(consumer.apid()), SafeOperational, Begun::Before);
  return true;
}

bool LinkLosses::leads(std::uint16_t apid) const {
  const auto found = fallbacks_.find(apid);
  return found != fallbacks_.end() && found->second.runner.running();
}

void LinkLosses::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint16_t>(holds_.size()));
  for (const auto& [link, until] : holds_) writer.put(link).put(until.time_since_epoch().count());
  std::set<std::uint8_t> led = begun_before_;
  for (const auto& [apid, fallback] : fallbacks_)
    if (fallback.begins || fallback.runner.running()) led.insert(fallback.link);
  writer.put(static_cast<std::uint16_t>(led.size()));
  for (const std::uint8_t link : led) writer.put(link);
}

void LinkLosses::recall(OctetReader& reader) {
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto id = reader.get<std::uint8_t>();
    const TimePoint until{Duration{reader.get<std::int64_t>()}};
    if (craft_.mission.find_link(id) != nullptr) holds_[id] = until;
  }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto id = reader.get<std::uint8_t>();
    if (craft_.mission.find_link(id) != nullptr) begun_before_.insert(id);
  }
}

Cancelled LinkLosses::cancel(std::string_view why) {
  std::erase_if(fallbacks_, [](const auto& entry) { return !entry.second.runner.running(); });
  std::set<std::uint16_t> ended;
  for (auto& [apid, fallback] : fallbacks_) {
    fallback.runner.cancel();
    ended.insert(apid);
  }
  for (const std::uint8_t id : begun_before_) ended.insert(consumer_of(*craft_.mission.find_link(id)).apid());
  for (const std::uint16_t apid : ended)
    craft_.tell(fmt::format("{} does not go on in another configuration: {}", craft_.name_of(apid), why), apid);
  fallbacks_.clear();
  begun_before_.clear();
  return ended.empty() ? Cancelled::Nothing : Cancelled::Ended;
}

}  // namespace hirosco::supervisor
