// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/subscriber.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"

namespace hirosco {
namespace {

namespace st129 = pus::st129;
using What = st129::Subscribed::What;

constexpr std::uint8_t most_severe = 4;

[[nodiscard]] std::string list(std::span<const NativeField> fields) {
  std::string text;
  for (const NativeField& field : fields) text.append(text.empty() ? "" : ", ").append(cpp_text(field));
  return text.empty() ? "nothing" : text;
}
[[nodiscard]] std::string list(const std::vector<descriptor::Field>& fields) {
  std::string text;
  for (const auto& field : fields)
    text.append(text.empty() ? "" : ", ").append(descriptor_text(field.type, field.elements()));
  return text.empty() ? "nothing" : text;
}

}  // namespace

std::string Subscriber::use(SubscriptionPort& port) {
  const std::string who = "use_subscription " + std::string{port.subsystem()} + " " + std::string{port.name()} + ": ";
  const auto subscribes =
      std::ranges::find(descriptor_.subscribes, port.subsystem(), &descriptor::Subscribes::subsystem);
  if (subscribes == descriptor_.subscribes.end()) return who + "the descriptor has no <Subscribes> of this subsystem";
  const bool event = port.what() == SubscriptionPort::What::Event;
  const auto kind = event ? descriptor::Thing::Kind::Event : descriptor::Thing::Kind::Housekeeping;
  const auto thing = std::ranges::find_if(
      subscribes->things, [&](const descriptor::Thing& each) { return each.kind == kind && each.name == port.name(); });
  if (thing == subscribes->things.end()) return who + "<Subscribes> does not name it";
  if (subscribes->apid == 0) return who + "no mission says who that is";
  const bool same = !port.fields() ||
                    std::ranges::equal(*port.fields(), thing->fields, [](const NativeField& n, const auto& declared) {
                      return n.type == declared.type && n.count == declared.elements();
                    });
  if (!same)
    return who + "its values are (" + list(*port.fields()) + "), the descriptor of " + std::string{port.subsystem()} +
           " declares (" + list(thing->fields) + ")";
  if (std::ranges::find(bound_, &port, &Bound::port) != bound_.end()) return who + "named twice";
  port.active_ = false;
  port.received_ = port.unreadable_ = 0;
  bound_.push_back(
      {.port = &port,
       .what = {subscribes->apid, event ? What::Event : What::Structure, static_cast<std::uint16_t>(thing->id)}});
  return {};
}

Result<> Subscriber::set(SubscriptionPort& port, bool wanted) {
  const auto bound = std::ranges::find(bound_, &port, &Bound::port);
  if (bound == bound_.end()) return fail(ErrorCode::NotPermitted, "not bound: use_subscription() in software_init()");
  bound->wanted = wanted;
  bound->refused = false;
  bound->again = {};
  return ok();
}

bool Subscriber::ask(Bound& bound) {
  std::array<std::byte, max_packet_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = pus::supervisor_apid,
                                              .sequence_count = next_count_,
                                              .ack = pus::ack_completion,
                                              .service = st129::service_type,
                                              .subtype = bound.wanted ? st129::subscribe : st129::unsubscribe,
                                              .source = descriptor_.id},
                                             st129::write_subscribed(bound.what));
  if (!packet || !channel_.send({.packet = *packet})) return false;
  next_count_ = static_cast<std::uint16_t>((next_count_ + 1) % Requester::first_count);
  bound.request = pus::read_primary_header(*packet)->request_id;
  return true;
}

bool Subscriber::wanted_by_another(const Bound& bound) const noexcept {
  return std::ranges::any_of(
      bound_, [&](const Bound& each) { return &each != &bound && each.what == bound.what && each.wanted; });
}

void Subscriber::step(TimePoint now) {
  for (Bound& bound : bound_) {
    if (bound.wanted == bound.port->active_ || bound.refused || now < bound.again) continue;
    if (!bound.wanted && wanted_by_another(bound)) {
      bound.port->active_ = false;
      continue;
    }
    if (!ask(bound)) return;  // the supervisor is behind
    bound.again = now + patience;
  }
}

bool Subscriber::hear(const pus::TelemetryView& report) {
  if (bound_.empty()) return false;
  const bool to_this = report.destination() == descriptor_.id;
  if (report.service() == pus::Verification::service_type && report.apid() == pus::supervisor_apid && to_this) {
    hear_verification(report);
    return false;
  }
  if (report.service() == pus::HousekeepingService::service_type &&
      report.subtype() == pus::HousekeepingService::parameter_report) {
    hear_values(report, What::Structure);
    return false;
  }
  // An event is told to each who hears it: what is addressed to nobody is the report to the ground.
  return report.service() == pus::EventService::service_type && report.subtype() <= most_severe && to_this &&
         hear_values(report, What::Event);
}

void Subscriber::hear_verification(const pus::TelemetryView& report) {
  OctetReader reader{report.source_data()};
  const auto id = reader.get<std::uint32_t>();
  const auto bound = std::ranges::find_if(bound_, [&](const Bound& each) { return each.request == id; });
  if (!reader.good() || id == 0 || bound == bound_.end()) return;
  constexpr std::uint8_t completed = 7;
  if (report.subtype() == completed) bound->port->active_ = bound->wanted;
  else if (report.subtype() % 2 == 0) bound->refused = true;
  else return;
  bound->request = 0;
}

bool Subscriber::hear_values(const pus::TelemetryView& report, What what) {
  OctetReader reader{report.source_data()};
  const st129::Subscribed heard{report.apid(), what, reader.get<std::uint16_t>()};
  if (!reader.good()) return false;
  const Octets values = reader.rest();
  bool taken = false;
  for (const Bound& bound : bound_) {
    if (bound.what != heard || !bound.wanted) continue;
    SubscriptionPort& port = *bound.port;
    ++port.received_;
    if (!port.take(values)) ++port.unreadable_;
    taken = true;
  }
  return taken;
}

void Subscriber::forget() {
  for (Bound& bound : bound_) {
    if (std::exchange(bound.wanted, false)) static_cast<void>(ask(bound));
    bound.port->active_ = false;
  }
  bound_.clear();
}

}  // namespace hirosco
