// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/commanded_members.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"

namespace hirosco::supervisor {
namespace {

/// The state that it asks for; empty: it asks for none.
[[nodiscard]] std::optional<State> state_asked(const pus::TelecommandView& telecommand) {
  const auto call = called_function(telecommand);
  if (!call || call->name != "SET_STATE" || !call->first_argument) return std::nullopt;
  return static_cast<State>(*call->first_argument);
}

/// Of ST[03] and ST[05] a list, each of which may fail for itself; all others are done whole or not.
[[nodiscard]] unsigned instructions_of(const pus::TelecommandView& telecommand) {
  const bool defines = telecommand.service() == 3 && (telecommand.subtype() == 1 || telecommand.subtype() == 29);
  const bool is_list = (telecommand.service() == 3 && !defines) || telecommand.service() == 5;
  return is_list && !telecommand.application_data().empty()
             ? std::to_integer<unsigned>(telecommand.application_data().front())
             : 1;
}

/// The states are not numbered by how far up they are: Error-Operational is below what moves.
[[nodiscard]] bool is_above(State state, State most) {
  if (state == State::Operational) return most != State::Operational;
  const bool higher = most == State::SafeOperational || most == State::Operational;
  return state == State::SafeOperational ? !higher : state == State::PreOperational && most == State::Offline;
}

/// Nobody is lowered by what its own recovery asks for: what it was commanded to before is what it comes back to.
[[nodiscard]] bool is_of_a_loss(std::string_view event) {
  return event == descriptor::event_of_death || event == "HANG";
}

}  // namespace

bool CommandedMembers::in_use() const {
  const auto brings_back = [](const descriptor::PlanStep& step) {
    return step.kind == "restart" && step.values.at(descriptor::restart_to) != 0;
  };
  return std::ranges::any_of(
      craft_.mission.plans, [&](const descriptor::Plan& plan) { return std::ranges::any_of(plan.steps, brings_back); });
}

void CommandedMembers::forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand, const Origin& origin) {
  const auto* subsystem = craft_.mission.find_member(apid);
  if (subsystem == nullptr || !CommandedState::concerns(telecommand, *subsystem)) return;
  if (apid != supervisor_apid && !in_use()) return;
  const auto call = called_function(telecommand);
  const bool steers = call && (call->name == "SET_STATE" || call->name == "CONFIGURE");
  if (steers && !origin.is_supervisor()) overrule(apid);
  if (const auto state = state_asked(telecommand)) lower_record(apid, *state);
  if ((telecommand.ack() & pus::ack_completion) == 0 || !has_room_for(telecommand.packet().size())) {
    members_[apid].commanded.may_have_set(telecommand, *subsystem);
    return tell_not_kept(apid, telecommand.service(), telecommand.subtype());
  }
  open_.push_back({apid, pus::request_of(telecommand), {telecommand.packet().begin(), telecommand.packet().end()}});
}

bool CommandedMembers::has_room_for(std::size_t octets) const {
  for (const Open& each : open_) octets += each.packet.size();
  return open_.size() < most_open && octets <= most_open_octets;
}

void CommandedMembers::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (report.service() != 1 || open_.empty()) return;
  const auto id = OctetReader{report.source_data()}.get<std::uint32_t>();
  const bool failed = report.subtype() % 2 == 0 && report.subtype() != 6;
  if (!failed && report.subtype() != 7) return;
  const auto found = std::ranges::find_if(open_, [&](const Open& each) {
    return each.apid == from && each.request.id == id && each.request.source == report.destination();
  });
  if (found == open_.end()) return;
  // One of several instructions has not begun: unless none has, the end comes yet.
  if (report.subtype() == 4 && ++found->refused < instructions_of(*pus::TelecommandView::parse(found->packet))) return;
  const Open ended = std::move(*found);
  open_.erase(found);
  const auto telecommand = *pus::TelecommandView::parse(ended.packet);
  const auto& subsystem = *craft_.mission.find_member(from);
  bool kept = true;
  if (!failed) {
    kept = members_[from].commanded.completed(telecommand, subsystem) != Kept::NoRoom;
  } else if (report.subtype() == 8) {  // part of it may be in force
    members_[from].commanded.may_have_set(telecommand, subsystem);
    kept = telecommand.service() == 8;
  }
  if (!kept) tell_not_kept(from, telecommand.service(), telecommand.subtype());
}

void CommandedMembers::lower(std::uint16_t apid, State most, std::string_view event) {
  if (is_of_a_loss(event)) return;
  if (Member& member = members_[apid]; event.ends_with("_STALE") && !is_just_now(member)) {
    member.before_loss = member.commanded;
    member.loss_at = craft_.now;
  }
  lower_record(apid, most);
  if (const auto wanted = wanted_.find(apid); wanted != wanted_.end()) wanted->second.lower(most);
}

void CommandedMembers::lower_record(std::uint16_t apid, State most) {
  members_[apid].commanded.lower(most);
  std::erase_if(open_, [&](const Open& each) {
    if (each.apid != apid) return false;
    const auto asked = state_asked(*pus::TelecommandView::parse(each.packet));
    return asked && is_above(*asked, most);
  });
}

void CommandedMembers::all_stopped() {
  for (const supervisor::Member& member : craft_.members) {
    if (craft_.is_ground_link(member)) continue;
    lower_record(member.apid(), State::SafeOperational);
    members_[member.apid()].before_loss.reset();
  }
}

void CommandedMembers::ended(std::uint16_t apid) {
  members_.erase(apid);
  std::erase_if(open_, [apid](const Open& each) { return each.apid == apid; });
}

void CommandedMembers::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint16_t>(members_.size()));
  for (const auto& [apid, member] : members_) {
    writer.put(apid);
    // Whoever goes on for one that has not done so yet begins where that did.
    if (own_before_ && apid == supervisor_apid) own_before_->commanded.note(writer);
    else member.commanded.note(writer);
  }
  const std::size_t before = own_before_ ? own_before_->open.size() : 0;
  const auto since = static_cast<std::size_t>(std::ranges::count_if(open_, is_handed_on));
  writer.put(static_cast<std::uint16_t>(before + since));
  const auto put = [&writer](const Open& each) {
    writer.put(each.apid)
        .put(each.refused)
        .put(static_cast<std::uint16_t>(each.packet.size()))
        .put(Octets{each.packet});
  };
  if (own_before_) std::ranges::for_each(own_before_->open, put);
  for (const Open& each : open_)
    if (is_handed_on(each)) put(each);
}

void CommandedMembers::recall(OctetReader& reader) {
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left)
    members_[reader.get<std::uint16_t>()].commanded.recall(reader);
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    Open each;
    each.apid = reader.get<std::uint16_t>();
    each.refused = reader.get<unsigned>();
    const Octets packet = reader.get(reader.get<std::uint16_t>());
    const auto telecommand = pus::TelecommandView::parse(packet);
    if (!reader.good() || !telecommand) continue;
    each.request = pus::request_of(*telecommand);
    each.packet.assign(packet.begin(), packet.end());
    open_.push_back(std::move(each));
  }
  take_own_before();
  // What is not whole says nothing for certain of the supervisor itself.
  if (!reader.exhausted()) own_before_.reset();
  if (own_before_) own_.keep_silent(own_before_->commanded.silent_events());
}

/// The record of this supervisor itself begins with its own way up.
void CommandedMembers::take_own_before() {
  OwnBefore& before = own_before_.emplace();
  before.commanded = std::exchange(members_[supervisor_apid].commanded, {});
  for (Open& each : open_)
    if (each.apid == supervisor_apid) before.open.push_back(std::move(each));
  std::erase_if(open_, [](const Open& each) { return each.apid == supervisor_apid; });
}

std::vector<SettingCommand> CommandedMembers::own_settings(State in) const {
  if (!own_before_) return {};
  auto all = own_before_->commanded.settings_for(in, craft_.mission.supervisor);
  if (in != State::PreOperational) return all;
  for (const Open& each : own_before_->open) {
    const auto telecommand = *pus::TelecommandView::parse(each.packet);
    const Octets data = telecommand.application_data();
    const bool sets = telecommand.service() != 8;  // a function is done once or not at all
    if (sets) all.push_back({telecommand.service(), telecommand.subtype(), {data.begin(), data.end()}});
  }
  return all;
}

CommandedState CommandedMembers::of(std::uint16_t apid) const {
  const auto found = members_.find(apid);
  CommandedState state = found != members_.end() ? found->second.commanded : CommandedState{};
  // Who dies with it has perhaps done it, and nobody will say so any more.
  const auto* member = craft_.mission.find_subsystem(apid);
  for (const Open& each : open_)
    if (each.apid == apid && member != nullptr)
      state.may_have_set(*pus::TelecommandView::parse(each.packet), member->subsystem);
  return state;
}

CommandedState CommandedMembers::of_partner(std::uint16_t apid) const {
  const auto found = members_.find(apid);
  if (found == members_.end() || !is_just_now(found->second)) return of(apid);
  CommandedState state = *found->second.before_loss;
  state.may_have_set(of(apid));
  return state;
}

bool CommandedMembers::is_just_now(const Member& member) const {
  return member.before_loss && craft_.now - member.loss_at <= loss_before_death;
}

const CommandedState* CommandedMembers::wanted(std::uint16_t apid) const {
  const auto found = wanted_.find(apid);
  return found != wanted_.end() ? &found->second : nullptr;
}

void CommandedMembers::tell_not_kept(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype) {
  own_.announce("COMMAND_NOT_KEPT",
                {static_cast<double>(apid), static_cast<double>(service), static_cast<double>(subtype)});
}

void CommandedMembers::tell_own_not_kept(const SettingCommand& command) {
  tell_not_kept(supervisor_apid, command.service, command.subtype);
}

void CommandedMembers::tell_own_lost() {
  craft_.tell("what ground had set of the supervisor itself is not known: it is as its descriptor says",
              supervisor_apid);
  own_.announce("NOT_RESTORED", {static_cast<double>(supervisor_apid)});
}

}  // namespace hirosco::supervisor
