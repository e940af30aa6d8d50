// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/ground_loss.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"

namespace hirosco::supervisor {

namespace {

[[nodiscard]] bool says_offline(const pus::EventMessage& event) noexcept {
  return event.id == descriptor::framework_event::state_changed && !event.auxiliary.empty() &&
         std::to_integer<std::uint8_t>(event.auxiliary.front()) == static_cast<std::uint8_t>(State::Offline);
}

/// Its transport is closed on the way down, and opened when a configuration is applied on the way up.
[[nodiscard]] bool is_cut_off(const Member& link) noexcept {
  const auto state = link.state();
  return !state || link.closed_at || state == State::Offline || is_transient(*state);
}

}  // namespace

void GroundLoss::heard() noexcept {
  somebody_ = true;
  away_since_.reset();
  cut_ = false;
}

void GroundLoss::nobody_any_more() noexcept {
  somebody_ = cut_ = false;
  away_since_.reset();
}

void GroundLoss::away_from(TimePoint since, bool cut) noexcept {
  if (!somebody_) return;
  if (!away_since_) away_since_ = since;
  cut_ = cut_ || cut;
}

void GroundLoss::hear_event(std::uint16_t from, Octets message) {
  const Member* link = craft_.ground_link();
  if (link == nullptr || link->apid() != from) return;
  const auto event = pus::read_event_message(message);
  if (!event) return;
  // It may be up again before anybody has looked.
  if (says_offline(*event)) return away_from(craft_.now, true);
  const auto& declared = link->descriptor().events;
  const auto found = std::ranges::find(declared, event->id, &descriptor::Event::id);
  if (found == declared.end()) return;
  if (found->name == descriptor::event_of_ground_back) heard();
  if (found->name == descriptor::event_of_ground_lost) nobody_any_more();
}

void GroundLoss::stands_still(const Member& member, Duration span) {
  if (craft_.is_ground_link(member)) away_from(craft_.now - span, false);
}

void GroundLoss::moves_again(const Member& member) noexcept {
  if (craft_.is_ground_link(member) && !cut_) away_since_.reset();
}

void GroundLoss::watch(TimePoint now) {
  Member* link = craft_.ground_link();
  if (link == nullptr || craft_.shutting_down) return;
  if (is_cut_off(*link)) away_from(now, true);
  if (away_since_ && now - *away_since_ > patience) tell(*link);
}

/// As if the ground link had told it: whatever the mission plans for that begins.
void GroundLoss::tell(Member& link) {
  nobody_any_more();
  own_.announce(descriptor::event_of_ground_lost, {static_cast<double>(link.apid())});
  const auto* its_own = link.descriptor().find_event(descriptor::event_of_ground_lost);
  reactions_.react(link, descriptor::event_of_ground_lost,
                   its_own != nullptr ? its_own->severity : descriptor::Severity::Medium);
}

void GroundLoss::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(somebody_ ? 1 : 0)).put(static_cast<std::uint8_t>(cut_ ? 1 : 0));
  writer.put(static_cast<std::uint8_t>(away_since_ ? 1 : 0));
  writer.put(away_since_.value_or(TimePoint{}).time_since_epoch().count());
}

void GroundLoss::recall(OctetReader& reader) {
  const auto flag = [&] { return reader.get<std::uint8_t>() != 0; };
  const bool somebody = flag(), cut = flag(), away = flag();
  const TimePoint since{Duration{reader.get<std::int64_t>()}};
  if (!reader.good()) return;
  somebody_ = somebody;
  cut_ = cut;
  if (away) away_since_ = since;
}

}  // namespace hirosco::supervisor
