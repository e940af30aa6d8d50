// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/subscriptions.hpp"

#include <fmt/format.h>

#include <array>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"

namespace hirosco::supervisor {

using What = pus::st129::Subscribed::What;

Subscriptions::Subscriptions(Craft& craft, OwnSubsystem& own)
    : craft_{craft},
      own_{own},
      deliveries_{craft, [&craft, &own](const Member& member, std::uint32_t lost) {
                    craft.tell(
                        fmt::format("{} does not read what it hears: {} reports lost", member.descriptor().name, lost),
                        member.apid());
                    own.announce("HEARD_LOST", {static_cast<double>(member.apid()), static_cast<double>(lost)});
                  }} {}

void Subscriptions::answer(const pus::Request& asked, Octets data, bool begins) {
  pus::Verification& verification = own_.verification();
  const auto what = pus::st129::read_subscribed(data);
  const Member* member = craft_.member(asked.source);
  if (!what || member == nullptr || !member->alive())
    return verification.rejected(asked, pus::FailureNotice{pus::FailureCode::IllegalField});
  Subscriber& subscriber = subscribers_[asked.source];
  if (subscriber.process != member->process()) subscriber = {.process = member->process()};
  if (begins && !subscriber.heard.contains(*what) && heard() == most_heard)
    return verification.rejected(asked, pus::FailureNotice{pus::FailureCode::QueueFull});
  if (begins) subscriber.heard.insert(*what);
  else subscriber.heard.erase(*what);
  // Before it is told: who was told asks no more, whichever supervisor is there.
  craft_.remember();
  verification.accepted(asked);
  verification.started(asked);
  verification.completed(asked);
}

std::size_t Subscriptions::heard() const {
  std::size_t sum = 0;
  for (const auto& [apid, subscriber] : subscribers_) sum += subscriber.heard.size();
  return sum;
}

template <class Give>
void Subscriptions::each_of(const pus::st129::Subscribed& what, Give&& give) {
  for (auto& [apid, subscriber] : subscribers_) {
    const Member& member = *craft_.member(apid);
    const bool hears = member.alive() && member.process() == subscriber.process && subscriber.heard.contains(what);
    if (!hears) continue;
    if (craft_.now - subscriber.window >= 1s) {
      subscriber.window = craft_.now;
      subscriber.in_window = 0;
    }
    if (subscriber.in_window == most_a_second) deliveries_.lose(member);
    else {
      ++subscriber.in_window;
      give(member);
    }
  }
}

void Subscriptions::hear(std::uint16_t from, const pus::TelemetryView& report) {
  using Housekeeping = pus::HousekeepingService;
  if (subscribers_.empty() || report.service() != Housekeeping::service_type ||
      report.subtype() != Housekeeping::parameter_report)
    return;
  OctetReader reader{report.source_data()};
  const auto structure = reader.get<std::uint16_t>();
  if (!reader.good()) return;
  each_of({from, What::Structure, structure}, [&](const Member& member) {
    if (craft_.is_ground_link(member)) return;  // it has all reports anyway
    deliveries_.give(member, report.packet());
  });
}

void Subscriptions::hear_event(std::uint16_t from, Octets message) {
  if (subscribers_.empty()) return;
  const auto event = pus::read_event_message(message);
  if (!event) return;
  each_of({from, What::Event, event->id}, [&](const Member& member) {
    std::array<std::byte, max_packet_octets> buffer;
    const auto packet = pus::write_telemetry(buffer,
                                             {.apid = from,
                                              .sequence_count = events_,
                                              .service = pus::EventService::service_type,
                                              .subtype = static_cast<std::uint8_t>(event->severity),
                                              .destination = member.apid(),
                                              .time = craft_.platform.clock.onboard()},
                                             message.subspan(pus::event_message_id_at));
    events_ = static_cast<std::uint16_t>((events_ + 1) % pus::sequence_counts);
    if (packet) deliveries_.give(member, *packet);
  });
}

void Subscriptions::watch(TimePoint now) {
  deliveries_.watch(now);
  std::erase_if(subscribers_, [this](const auto& entry) {
    const Member& member = *craft_.member(entry.first);
    return !member.alive() || member.process() != entry.second.process || entry.second.heard.empty();
  });
}

void Subscriptions::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint16_t>(subscribers_.size()));
  for (const auto& [apid, subscriber] : subscribers_) {
    writer.put(apid).put(static_cast<std::uint16_t>(subscriber.heard.size()));
    for (const auto& what : subscriber.heard) writer.put(Octets{pus::st129::write_subscribed(what)});
  }
}

void Subscriptions::recall(OctetReader& reader) {
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto apid = reader.get<std::uint16_t>();
    for (auto more = reader.get<std::uint16_t>(); more > 0 && reader.good(); --more)
      if (const auto what = pus::st129::read_subscribed(reader.get(pus::st129::subscribed_octets)))
        subscribers_[apid].heard.insert(*what);
  }
}

void Subscriptions::go_on() {
  std::erase_if(subscribers_, [this](const auto& entry) {
    const Member* member = craft_.member(entry.first);
    return member == nullptr || !member->alive();
  });
  for (auto& [apid, subscriber] : subscribers_) subscriber.process = craft_.member(apid)->process();
}

}  // namespace hirosco::supervisor
