// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_commands.hpp"

#include <array>
#include <utility>

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

namespace hirosco::supervisor {

void LinkCommands::provide() {
  own_.on_function("LINK", [this](double number, Call call) -> Outcome {
    const auto link = static_cast<std::uint8_t>(number);
    if (handshakes_.releases(link))
      return refused(pus::FailureCode::WrongStatus, "an end has not let go since UNLINK of link", link);
    if (const auto ours = renewing_.find(link); ours != renewing_.end()) {
      ours->second.push_back(call);
      return running;
    }
    if (renewed_.erase(link) != 0 && graph_.is_up(link)) return Outcome{Outcome::Kind::Done};
    renewals_.drop(link);
    const bool begun = handshakes_.establish(link, craft_.now, [this, call](bool success) {
      if (success) own_.finish(call);
      else own_.abort(call, pus::FailureCode::ExecutionError);
    });
    return begun ? running : refused(pus::FailureCode::WrongStatus);
  });
  own_.on_function("UNLINK", [this](double link, Call call) -> Outcome {
    using enum LinkReleases::Released;
    renewals_.drop(static_cast<std::uint8_t>(link));
    const bool begun = handshakes_.release(static_cast<std::uint8_t>(link), [=, this](LinkReleases::Released how) {
      if (how == ByBoth) return own_.finish(call);
      const auto code = how == Refused ? pus::FailureCode::ExecutionError : pus::FailureCode::Timeout;
      own_.abort(call, code, "an end has not let go of link", static_cast<std::int64_t>(link));
    });
    return begun ? running : refused(pus::FailureCode::WrongStatus);
  });
}

void LinkCommands::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (report.service() != pus::st128::service_type) return;
  const Octets data = report.source_data();
  const bool leaves = report.subtype() == pus::st128::detached && !data.empty();
  const auto link = leaves ? std::to_integer<std::uint8_t>(data[0]) : std::uint8_t{0};
  const bool was_up = leaves && graph_.is_up(link);
  if (leaves) renewals_.let_go(link, from);
  handshakes_.handle(from, report);
  if (!was_up || graph_.is_up(link) || handshakes_.releases(link) || craft_.shutting_down) return;
  const descriptor::MissionLink& left = *craft_.mission.find_link(link);
  const auto apid_of = [&](const std::string& name) { return craft_.mission.find_subsystem(name)->subsystem.id; };
  renewals_.left(link, apid_of(left.from) == from ? apid_of(left.to) : apid_of(left.from));
}

/// Whom a fence reaches ends with what it is for: who has left a link by the way of its states is joined to nobody by it, though
/// the other end holds on to its memory until its own configuration ends, or never says that it has let go.
void LinkCommands::watch(TimePoint now) {
  for (const LinkGraph::HalfHeld& half : graph_.half_held())
    if (has_left(half.gone, half.link) || has_left(half.holder, half.link)) graph_.forget(half.link);
  handshakes_.step(now);
  renew();
}

LinkRenewals::End LinkCommands::end_of(const std::string& name) const {
  const auto* described = craft_.mission.find_subsystem(name);
  const Member* member = described == nullptr ? nullptr : std::as_const(craft_).member(described->subsystem.id);
  if (member == nullptr || !member->alive() || !member->state()) return {};
  const descriptor::State state = *member->state();
  using enum descriptor::State;
  return {.described = &member->descriptor(),
          .there = state != Offline,
          .settled = (state == PreOperational || state == SafeOperational || state == Operational) &&
                     !member->recovery.running(),
          .configuration = member->configuration()};
}

/// A mode says which links there are, and a shutdown that there are none.
void LinkCommands::renew() {
  if (craft_.changing_to != nullptr || craft_.shutting_down) return renewals_.drop_all();
  renewals_.for_each([&](std::uint8_t id) {
    if (graph_.is_up(id)) return renewals_.drop(id);
    if (renewing_.contains(id) || handshakes_.releases(id)) return;
    const descriptor::MissionLink& link = *craft_.mission.find_link(id);
    const auto judged = renewals_.judge(link, end_of(link.from), end_of(link.to));
    switch (judged.next) {
      case LinkRenewals::Next::Wait: break;
      case LinkRenewals::Next::Establish: renew(id); break;
      case LinkRenewals::Next::Refused:
        link_changed(link, false, judged.why);
        take_back(id);
        break;
      case LinkRenewals::Next::Over: renewals_.drop(id); break;
    }
  });
}

void LinkCommands::renew(std::uint8_t link) {
  renewing_.try_emplace(link);
  if (!handshakes_.establish(link, craft_.now, [this, link](bool success) { renewed(link, success); }))
    renewing_.erase(link);  // somebody else's handshake of it is under way
}

void LinkCommands::renewed(std::uint8_t link, bool success) {
  const auto waited = renewing_.extract(link);
  if (success) {
    renewals_.drop(link);
    renewed_.insert(link);
  } else {
    take_back(link);
  }
  if (waited.empty()) return;
  for (const Call& call : waited.mapped()) {
    renewed_.erase(link);
    if (success) own_.finish(call);
    else own_.abort(call, pus::FailureCode::ExecutionError);
  }
}

/// Who held on has the link as it was agreed by a configuration that is in force no more.
void LinkCommands::take_back(std::uint8_t link) {
  const std::uint16_t holder = renewals_.holder(link);
  if (holder == 0) return;
  renewals_.let_go(link, holder);
  send_link_command(holder, pus::st128::detach, std::array{std::byte{link}}, {});
}

void LinkCommands::forget(std::uint16_t apid) {
  for (const descriptor::MissionLink& link : craft_.mission.links) {
    const auto is = [&](const std::string& name) { return craft_.mission.find_subsystem(name)->subsystem.id == apid; };
    if (is(link.from) || is(link.to)) renewals_.drop(link.id);
  }
  handshakes_.forget(apid);
}

void LinkCommands::note(OctetWriter& writer) const {
  writer.put(handshakes_.epoch()).put(static_cast<std::uint16_t>(craft_.mission.links.size()));
  for (const auto& link : craft_.mission.links) writer.put(link.id).put(graph_.standing(link.id));
  auto between = handshakes_.under_way();
  between.insert(between.end(), broken_.begin(), broken_.end());
  writer.put(static_cast<std::uint16_t>(between.size()));
  for (const std::uint8_t link : between) writer.put(link);
  writer.put(static_cast<std::uint16_t>(configurations_.size()));
  for (const auto& [end, configuration] : configurations_) writer.put(end.first).put(end.second).put(configuration);
}

void LinkCommands::recall(OctetReader& reader) {
  handshakes_.go_on_from(reader.get<std::uint32_t>());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto link = reader.get<std::uint8_t>();
    graph_.stand(link, reader.get<std::uint8_t>());
  }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left)
    broken_.push_back(reader.get<std::uint8_t>());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto link = reader.get<std::uint8_t>();
    const auto apid = reader.get<std::uint16_t>();
    configurations_[{link, apid}] = reader.get<std::uint8_t>();
  }
}

/// Of an end that let go while nobody listened, or told it to a supervisor that died before it could note that, no word comes
/// any more.
void LinkCommands::end_what_was_begun() {
  for (const auto& link : craft_.mission.links)
    for (const Member& member : craft_.members)
      if (graph_.holds(link.id, member.apid()) && (has_left(member.apid(), link.id) || member.configuration() == 0))
        graph_.let_go(link.id, member.apid());
  for (const LinkGraph::HalfHeld& half : graph_.half_held()) handshakes_.break_off(half.link);
  for (const std::uint8_t link : std::exchange(broken_, {})) handshakes_.break_off(link);
}

bool LinkCommands::has_left(std::uint16_t apid, std::uint8_t link) const {
  const Member* end = std::as_const(craft_).member(apid);
  if (end == nullptr || !end->alive() || end->state() == State::Offline) return true;
  const auto when_up = configurations_.find({link, apid});
  const std::uint8_t now = end->configuration();
  return when_up != configurations_.end() && now != 0 && now != when_up->second;
}

void LinkCommands::send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data,
                                     const MemoryHandle& memory) {
  const auto link = data.empty() ? std::uint8_t{0} : std::to_integer<std::uint8_t>(data[0]);
  const auto done = [=, this](bool success, const std::string& why) {
    if (!success) handshakes_.failed(apid, subtype, link, craft_.name_of(apid) + ": " + why);
  };
  desk_.send(apid, pus::st128::service_type, subtype, data, memory, done, Duration{0});
}

void LinkCommands::link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) {
  if (!up) renewed_.erase(link.id);
  for (const Member& member : craft_.members)
    if (const auto& name = member.descriptor().name; up && (name == link.from || name == link.to))
      configurations_[{link.id, member.apid()}] = member.configuration();
  craft_.tell("link " + std::to_string(link.id) + " " + link.from + "." + link.provides + " -> " + link.to +
              (up ? " up: " : " down: ") + text);
}

}  // namespace hirosco::supervisor
