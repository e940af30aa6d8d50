// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/ground_link.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::communication {

void Deframer::collect(Octets& octets, std::size_t wanted) noexcept {
  const std::size_t count = std::min(wanted - size_, octets.size());
  std::ranges::copy(octets.first(count), packet_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += count;
  octets = octets.subspan(count);
}

std::optional<CloseReason> Deframer::judge_header() noexcept {
  const auto header = pus::read_primary_header(Octets{packet_}.first(size_));
  if (!header || header->version != 0) return CloseReason::Version;
  if (!header->telecommand) return CloseReason::NotTelecommand;
  whole_ = pus::announced_octets(packet_);
  is_idle_ = header->apid == pus::idle_apid;
  // An idle packet has neither secondary header nor checksum: any length that fits is plausible.
  if (whole_ > pus::max_telecommand_octets || (!is_idle_ && whole_ < pus::telecommand_overhead_octets))
    return CloseReason::Length;
  return std::nullopt;
}

std::optional<CloseReason> Deframer::check(TimePoint now) noexcept {
  if (!spoilt_ && size_ != 0 && now - begun_ >= limit_) spoilt_ = CloseReason::Incomplete;
  return spoilt_;
}

std::optional<TimePoint> Deframer::deadline() const noexcept {
  if (spoilt_ || size_ == 0) return std::nullopt;
  return begun_ + limit_;
}

GroundClients::GroundClients(const Limits& limits)
    : limits_{limits},
      clients_(std::clamp<std::size_t>(limits.clients, 1, most_clients), Client{limits.incomplete}),
      ring_(std::max(limits.backlog_octets, pus::max_telemetry_octets)) {}

GroundClients::Client* GroundClients::find(ClientId client) noexcept {
  return const_cast<Client*>(std::as_const(*this).find(client));
}

const GroundClients::Client* GroundClients::find(ClientId client) const noexcept {
  const std::size_t place = place_of(client);
  if (client == 0 || place >= clients_.size() || clients_[place].id != client) return nullptr;
  return &clients_[place];
}

GroundClients::Client* GroundClients::free_place() noexcept {
  const auto place = std::ranges::find(clients_, ClientId{0}, &Client::id);
  return place == clients_.end() ? nullptr : &*place;
}

GroundClients::Client* GroundClients::oldest_silent() noexcept {
  Client* oldest = nullptr;
  for (Client& client : clients_)
    if (client.id != 0 && client.counters.valid_packets == 0 && (oldest == nullptr || client.order < oldest->order))
      oldest = &client;
  return oldest;
}

Result<GroundClients::Admission> GroundClients::admit(GroundPort port, TimePoint now) {
  Admission admission;
  Client* place = free_place();
  if (place == nullptr) {
    place = oldest_silent();
    if (place == nullptr) {
      ++counters_.refused;
      return fail(ErrorCode::ResourceExhausted, "ground clients", std::ssize(clients_));
    }
    admission.evicted = place->id;
    remove(place->id, CloseReason::Evicted);
  }
  const auto generation = static_cast<std::uint8_t>(place->generation % 255 + 1);
  *place = Client{limits_.incomplete};
  place->generation = generation;
  place->id = static_cast<ClientId>(generation * most_clients + static_cast<std::size_t>(place - clients_.data()));
  place->order = next_order_++;
  place->read_to = written_;
  place->counters.port = port;
  place->counters.admitted = now;
  ++counters_.admitted;
  ++counters_.clients;
  admission.client = place->id;
  return admission;
}

void GroundClients::received(ClientId id, Octets octets, TimePoint now, GroundTraffic& traffic) {
  Client* client = find(id);
  if (client == nullptr || client->condemned) return;
  client->counters.octets_received += octets.size();
  const std::uint64_t idle_before = client->deframer.idle_packets();
  client->condemned = client->deframer.feed(octets, now, [&](Octets packet) {
    ++client->counters.packets;
    ++counters_.packets;
    if (pus::TelecommandView::parse(packet)) {
      ++client->counters.valid_packets;
      ++counters_.valid_packets;
    }
    traffic.telecommand(id, packet);
  });
  counters_.idle_packets += client->deframer.idle_packets() - idle_before;
}

Result<> GroundClients::telemetry(Octets packet) {
  if (packet.size() > ring_.size())
    return fail(ErrorCode::ResourceExhausted, "telemetry longer than the backlog", std::ssize(packet));
  for (Client& client : clients_) {
    if (client.id == 0 || client.condemned || client.counters.port != GroundPort::TelemetryAndTelecommands) continue;
    if (written_ + packet.size() - client.read_to > ring_.size()) client.condemned = CloseReason::Slow;
  }
  const std::size_t start = written_ % ring_.size();
  const std::size_t first_part = std::min(packet.size(), ring_.size() - start);
  std::ranges::copy(packet.first(first_part), ring_.begin() + static_cast<std::ptrdiff_t>(start));
  std::ranges::copy(packet.subspan(first_part), ring_.begin());
  written_ += packet.size();
  ++counters_.telemetry_packets;
  return ok();
}

Octets GroundClients::output(ClientId id) const noexcept {
  const Client* client = find(id);
  if (client == nullptr || client->condemned || client->counters.port != GroundPort::TelemetryAndTelecommands)
    return {};
  const std::size_t start = client->read_to % ring_.size();
  const std::size_t waiting = static_cast<std::size_t>(written_ - client->read_to);
  return Octets{ring_}.subspan(start, std::min(waiting, ring_.size() - start));
}

void GroundClients::sent(ClientId id, std::size_t octets) noexcept {
  Client* client = find(id);
  if (client == nullptr) return;
  client->read_to += octets;
  client->counters.octets_sent += octets;
}

std::optional<TimePoint> GroundClients::step(TimePoint now) noexcept {
  std::optional<TimePoint> next;
  for (Client& client : clients_) {
    if (client.id == 0 || client.condemned) continue;
    client.condemned = client.deframer.check(now);
    const auto deadline = client.deframer.deadline();
    if (deadline && (!next || *deadline < *next)) next = deadline;
  }
  return next;
}

std::optional<CloseReason> GroundClients::condemned(ClientId id) const noexcept {
  const Client* client = find(id);
  return client == nullptr ? std::nullopt : client->condemned;
}

void GroundClients::remove(ClientId id, CloseReason reason) noexcept {
  Client* client = find(id);
  if (client == nullptr) return;
  ++counters_.closed[std::to_underlying(client->condemned.value_or(reason))];
  --counters_.clients;
  client->id = 0;
}

const ClientCounters* GroundClients::counters_of(ClientId id) const noexcept {
  const Client* client = find(id);
  return client == nullptr ? nullptr : &client->counters;
}

}  // namespace hirosco::communication
