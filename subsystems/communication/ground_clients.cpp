// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/ground_clients.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

namespace hirosco::communication {
namespace {

/// Who is silent for so long gives way first.
constexpr Duration settling = 100ms;
/// Who sends no more than ten packets at once and twenty in a second sends little.
constexpr Duration little_period = 50ms;
constexpr Duration little_burst = 500ms;

/// The reason for which a header is none of a telecommand that may come.
[[nodiscard]] std::optional<CloseReason> implausible(const pus::PrimaryHeader& header, std::size_t octets) noexcept {
  if (header.version != 0) return CloseReason::Version;
  if (!header.telecommand) return CloseReason::NotTelecommand;
  // An idle packet has neither secondary header nor checksum: any length that fits is plausible.
  const std::size_t shortest = header.apid == pus::idle_apid ? 0 : pus::telecommand_overhead_octets;
  if (octets > pus::max_telecommand_octets || octets < shortest) return CloseReason::Length;
  return std::nullopt;
}

}  // namespace

// --- Deframer ----------------------------------------------------------------------------------------------------------

MutableOctets Deframer::room() noexcept {
  if (spoilt_ || ended_) return {};
  if (begin_ != 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  return MutableOctets{buffer_}.subspan(end_);
}

void Deframer::put(std::size_t octets, TimePoint now) noexcept {
  if (spoilt_ || ended_ || octets == 0) return;
  if (begin_ == end_) begun_ = now;
  end_ += std::min(octets, capacity - end_);
  look(now);
}

void Deframer::end() noexcept {
  ended_ = true;
  look(begun_);
}

void Deframer::pop(TimePoint now) noexcept {
  if (whole_ == 0) return;
  begin_ += std::exchange(whole_, 0);
  begun_ = now;
  look(now);
}

std::size_t Deframer::waiting() const noexcept {
  Deframer rest = *this;
  std::size_t packets = 0;
  for (; !rest.front().empty(); ++packets) rest.pop(begun_);
  return packets;
}

void Deframer::look(TimePoint now) noexcept {
  while (whole_ == 0 && !spoilt_ && begin_ != end_) {
    const Octets rest = Octets{buffer_}.subspan(begin_, end_ - begin_);
    const auto header = pus::read_primary_header(rest);
    if (header) {
      const std::size_t octets = pus::announced_octets(rest);
      if (const auto reason = implausible(*header, octets)) return spoil(*reason);
      if (octets <= rest.size() && header->apid != pus::idle_apid) {
        whole_ = octets;
        return;
      }
      if (octets <= rest.size()) {
        ++idle_;
        begin_ += octets;
        begun_ = now;
        continue;
      }
    }
    if (ended_) spoil(CloseReason::Incomplete);
    return;
  }
}

void Deframer::spoil(CloseReason reason) noexcept {
  spoilt_ = reason;
  end_ = begin_;
}

void Deframer::check(TimePoint now) noexcept {
  const auto limit = deadline();
  if (limit && now >= *limit) spoil(CloseReason::Incomplete);
}

std::optional<TimePoint> Deframer::deadline() const noexcept {
  if (spoilt_ || whole_ != 0 || begin_ == end_) return std::nullopt;
  return begun_ + limit_;
}

// --- GroundClients -----------------------------------------------------------------------------------------------------

GroundClients::GroundClients(const Limits& limits)
    : limits_{limits},
      clients_(std::clamp<std::size_t>(limits.clients, 1, most_clients), Client{limits.incomplete}),
      ring_(std::max(limits.backlog_octets, pus::max_telemetry_octets)) {
  limits_.reserve = std::min(limits_.reserve, clients_.size() / 8);
}

GroundClients::Client* GroundClients::find(ClientId client) noexcept {
  return const_cast<Client*>(std::as_const(*this).find(client));
}

const GroundClients::Client* GroundClients::find(ClientId client) const noexcept {
  const std::size_t place = place_of(client);
  if (client == 0 || place >= clients_.size() || clients_[place].id != client) return nullptr;
  return &clients_[place];
}

bool GroundClients::has_free_place(GroundPort port) const noexcept {
  if (port == GroundPort::TelemetryAndTelecommands && listeners_ >= clients_.size() - limits_.reserve) return false;
  return counters_.clients < clients_.size();
}

GroundClients::Client* GroundClients::free_place(GroundPort port) noexcept {
  return has_free_place(port) ? &*std::ranges::find(clients_, ClientId{0}, &Client::id) : nullptr;
}

bool GroundClients::admissible(GroundPort port) const noexcept {
  if (has_free_place(port)) return true;
  const auto can_give_way = [&](const Client& client) { return client.id != 0 && !permanent(client, port); };
  // With nobody at all who ever could, admit() refuses at once: that is an answer, too.
  return std::ranges::none_of(clients_, can_give_way) ||
         std::ranges::any_of(clients_, [&](const Client& client) { return can_give_way(client) && !client.waits(); });
}

/// Whether a newcomer on this port cannot take the client's place, whatever else is taken.
bool GroundClients::permanent(const Client& client, GroundPort newcomer) const noexcept {
  const bool listener = client.counters.port == GroundPort::TelemetryAndTelecommands;
  // The places that listeners may have are all taken by listeners: only one of them can give way to another.
  const bool listeners_only =
      newcomer == GroundPort::TelemetryAndTelecommands && listeners_ == clients_.size() - limits_.reserve;
  if (!listener) return listeners_only;
  return client.counters.valid_packets != 0;
}

/// Who has had time to speak and did not; then who was quiet for longest. Newcomers have a moment: one that is about to
/// say something essential must not give way to the next before it could.
GroundClients::Client* GroundClients::who_gives_way(GroundPort port, TimePoint now) noexcept {
  const auto rank = [now](const Client& client) {
    const bool silent = client.counters.valid_packets == 0 && now - client.counters.admitted >= settling;
    return std::tuple{silent ? 0 : 1, client.counters.heard, client.order};
  };
  Client* chosen = nullptr;
  for (Client& client : clients_) {
    if (client.id == 0 || client.waits() || permanent(client, port)) continue;
    if (chosen == nullptr || rank(client) < rank(*chosen)) chosen = &client;
  }
  return chosen;
}

Result<GroundClients::Admission> GroundClients::admit(GroundPort port, TimePoint now) {
  Admission admission;
  const bool listener = port == GroundPort::TelemetryAndTelecommands;
  Client* place = free_place(port);
  if (place == nullptr) {
    place = who_gives_way(port, now);
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
  place->read_to = ring_.written();
  place->counters.port = port;
  place->counters.admitted = now;
  place->counters.heard = now;
  if (listener) ++listeners_;
  ++counters_.admitted;
  ++counters_.clients;
  admission.client = place->id;
  return admission;
}

MutableOctets GroundClients::room(ClientId id) noexcept {
  Client* client = find(id);
  return client == nullptr || client->dismissed ? MutableOctets{} : client->deframer.room();
}

void GroundClients::received(ClientId id, std::size_t octets, TimePoint now) noexcept {
  Client* client = find(id);
  if (client == nullptr || client->dismissed) return;
  client->counters.octets_received += octets;
  const std::uint64_t idle_before = client->deframer.idle_packets();
  client->deframer.put(octets, now);
  counters_.idle_packets += client->deframer.idle_packets() - idle_before;
  queue(*client);
}

void GroundClients::all_stopped() noexcept {
  for (Client& client : clients_) client.settled = false;
}

void GroundClients::all_stopped(ClientId id) noexcept {
  if (Client* client = find(id)) client->settled = false;
}

void GroundClients::settled(ClientId id) noexcept {
  Client* client = find(id);
  if (client == nullptr || client->settled) return;
  client->settled = true;
  client->settled_at = client->counters.octets_received;
}

bool GroundClients::is_settled(ClientId id) const noexcept {
  const Client* client = find(id);
  return client == nullptr || client->settled;
}

void GroundClients::queue(Client& client) noexcept {
  if (client.queued || !client.waits()) return;
  client.queued = true;
  turns_.join(static_cast<std::uint8_t>(place_of(client.id)));
}

bool GroundClients::somebody_catches_up(TimePoint now) noexcept {
  bool found = false;
  for (Client& client : clients_) {
    if (!client.listens()) continue;
    const std::uint64_t backlog = ring_.written() - client.read_to;
    if (backlog <= limits_.behind_octets / 2) client.behind_since.reset();
    const bool begins = !client.behind_since && backlog > limits_.behind_octets;
    const bool progresses = client.behind_since && client.read_to - client.behind_from >= limits_.progress_octets;
    if (begins || progresses) {
      client.behind_since = now;
      client.behind_from = client.read_to;
    }
    found = found || (client.behind_since && now - *client.behind_since < limits_.patience);
  }
  return found;
}

bool GroundClients::hand_over(GroundTraffic& traffic, TimePoint now) {
  const bool held = somebody_catches_up(now);
  std::size_t passed_over = 0;
  for (int left = packets_per_turn; left > 0 && turns_.size() > passed_over; --left) {
    Client& client = clients_[turns_.first()];
    if (held && client.allowance > now + little_burst) {
      // Its turn comes again when the listener has.
      turns_.pass_over();
      ++passed_over;
      continue;
    }
    const Octets packet = client.deframer.front();
    const bool valid = pus::TelecommandView::parse(packet).has_value();
    const std::uint64_t begins = client.counters.octets_received - client.deframer.held_octets();
    const bool before = !client.settled || begins < client.settled_at;
    if (traffic.telecommand(client.id, packet, before ? Said::PerhapsBefore : Said::Since) == Taken::Later) {
      ++counters_.held_back;
      return false;
    }
    // What was sent while nobody was behind is no debt: within one period of silence even a flood has a turn again.
    client.allowance = std::min(std::max(client.allowance, now), now + little_burst) + little_period;
    client.counters.heard = now;
    ++client.counters.packets;
    ++counters_.packets;
    client.counters.valid_packets += valid ? 1 : 0;
    counters_.valid_packets += valid ? 1 : 0;
    const std::uint64_t idle_before = client.deframer.idle_packets();
    client.deframer.pop(now);
    counters_.idle_packets += client.deframer.idle_packets() - idle_before;
    turns_.done();
    client.queued = false;
    queue(client);
  }
  return turns_.size() == 0;
}

std::size_t GroundClients::waiting_packets() const noexcept {
  std::size_t packets = 0;
  for (const Client& client : clients_)
    if (client.id != 0) packets += client.deframer.waiting();
  return packets;
}

Result<> GroundClients::telemetry(Octets packet) {
  if (packet.size() > ring_.size())
    return fail(ErrorCode::ResourceExhausted, "telemetry longer than the backlog", std::ssize(packet));
  for (Client& client : clients_)
    if (client.listens() && ring_.written() + packet.size() - client.read_to > ring_.size())
      client.dismissed = CloseReason::Slow;
  ring_.put(packet);
  ++counters_.telemetry_packets;
  return ok();
}

Octets GroundClients::output(ClientId id) const noexcept {
  const Client* client = find(id);
  if (client == nullptr || !client->listens()) return {};
  return ring_.after(client->read_to);
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
    if (client.id == 0 || client.dismissed) continue;
    client.deframer.check(now);
    const auto deadline = client.deframer.deadline();
    if (deadline && (!next || *deadline < *next)) next = deadline;
  }
  return next;
}

void GroundClients::end_input(ClientId id) noexcept {
  if (Client* client = find(id)) client->deframer.end();
}

void GroundClients::dismiss(ClientId id, CloseReason reason) noexcept {
  Client* client = find(id);
  if (client == nullptr || client->dismissed) return;
  client->dismissed = reason;
  client->deframer.end();
}

std::optional<CloseReason> GroundClients::condemned(ClientId id) const noexcept {
  const Client* client = find(id);
  if (client == nullptr || client->waits()) return std::nullopt;
  if (client->dismissed == CloseReason::Slow) return CloseReason::Slow;
  return client->deframer.spoilt() ? client->deframer.spoilt() : client->dismissed;
}

void GroundClients::remove(ClientId id, CloseReason reason) noexcept {
  Client* client = find(id);
  if (client == nullptr) return;
  if (client->queued) {
    // What it left is nobody's any more; only the end of the whole link gets here.
    turns_.leave(static_cast<std::uint8_t>(place_of(id)));
    client->queued = false;
  }
  ++counters_.closed[std::to_underlying(condemned(id).value_or(reason))];
  --counters_.clients;
  if (client->counters.port == GroundPort::TelemetryAndTelecommands) --listeners_;
  client->id = 0;
}

const ClientCounters* GroundClients::counters_of(ClientId id) const noexcept {
  const Client* client = find(id);
  return client == nullptr ? nullptr : &client->counters;
}

}  // namespace hirosco::communication
