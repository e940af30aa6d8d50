// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/session.hpp"

#include <algorithm>

#include "ground/api/client.hpp"
#include "ground/model/json.hpp"
#include "ground/model/views.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration housekeeping_period = 1s;
constexpr Duration injections_period = 200ms;

}  // namespace

Session::Session(Parts parts)
    : parts_{std::move(parts)},
      model_{parts_.catalogue},
      downlink_{{.packet = [this](const pus::TelemetryView& packet, Octets octets) { take(packet, octets); },
                 .gap = [this](OnboardTime from, OnboardTime to) { add_gap(from, to); }}},
      commands_{{.catalogue = parts_.catalogue,
                 .archive = parts_.archive,
                 .model = model_,
                 .clock = parts_.clock,
                 .now = [this] { return now(); },
                 .connected = [this] { return connected_; },
                 .send = parts_.outside.send,
                 .tell = [this](const StoredCommand& command) { tell_command(command); },
                 .source = parts_.source,
                 .first_count = parts_.first_count}} {
  if (const auto extent = parts_.archive.extent()) archived_until_ = extent->to;
}

Session::~Session() { parts_.archive.commit(); }

OnboardTime Session::now() const {
  if (model_.newest() == OnboardTime{}) return parts_.clock.onboard();
  return model_.newest() + (parts_.clock.now() - newest_received_);
}

// --- the link --------------------------------------------------------------------------------------------------------

void Session::link_up() {
  connected_ = true;
  downlink_.begin(model_.newest() != OnboardTime{} ? std::optional{model_.newest()} : archived_until_);
}

void Session::link_down() {
  connected_ = false;
  parts_.archive.commit();
}

bool Session::receive(Octets octets) {
  const bool good = downlink_.receive(octets);
  // What the link delivered survives the end of this process from here on.
  parts_.archive.commit();
  return good;
}

void Session::take(const pus::TelemetryView& packet, Octets octets) {
  const Heard heard = model_.take(packet);
  newest_received_ = parts_.clock.now();
  StoredPacket stored{.t = packet.time(), .apid = packet.apid(), .octets = {}};
  stored.service = packet.service();
  stored.subtype = packet.subtype();
  stored.sid = heard.sid;
  parts_.archive.add(stored, octets);
  for (const StoredChange& change : heard.changes) parts_.archive.add(change);
  if (heard.event) {
    parts_.archive.add(*heard.event);
    json message = event_json(*heard.event);
    message["type"] = "event";
    broadcast(message);
  }
  commands_.hear(heard, packet.time());
}

void Session::add_gap(OnboardTime from, OnboardTime to) {
  parts_.archive.add(StoredGap{from, to});
  broadcast({{"type", "gap"}, {"from", json_time(from)}, {"to", json_time(to)}});
}

void Session::tell_command(const StoredCommand& command) {
  json message = command_json(command);
  message["type"] = "command";
  broadcast(message);
}

void Session::tick() {
  const TimePoint now = parts_.clock.now();
  commands_.expire(now);
  for (const auto& client : clients_) client->tick(now);
  if (now >= next_injections_) {
    take_injections();
    next_injections_ = now + injections_period;
  }
  parts_.archive.commit();
  if (now >= next_housekeeping_) {
    parts_.archive.keep_within_limit();
    next_housekeeping_ = now + housekeeping_period;
  }
}

// --- clients ---------------------------------------------------------------------------------------------------------

std::string Session::opened(Peer& peer, bool is_operator) {
  std::string id = "c" + std::to_string(next_client_++);
  clients_.push_back(std::make_unique<Client>(*this, peer, id, is_operator));
  return id;
}

void Session::received(const Peer& peer, const std::string& text) {
  for (const auto& client : clients_)
    if (&client->peer() == &peer) return client->received(text);
}

void Session::closed(const Peer& peer) {
  std::erase_if(clients_, [&](const auto& client) { return &client->peer() == &peer; });
}

bool Session::in_replay(const std::string& client) const {
  return std::ranges::any_of(clients_, [&](const auto& c) { return c->id() == client && c->in_replay(); });
}

void Session::broadcast(const json& message) {
  for (const auto& client : clients_) client->tell(message);
}

// --- requests --------------------------------------------------------------------------------------------------------

Answered<json> Session::command(const json& body) { return commands_.send(body); }

void Session::mode_preview(const json& body, std::function<void(Answered<json>)> done) {
  commands_.mode_preview(body, std::move(done));
}

void Session::preview(const json& body, std::function<void(Answered<json>)> done) {
  commands_.preview(body, std::move(done));
}

void Session::fault(const json& body, std::function<void(Answered<json>)> done) {
  const std::string device = text_of(body, "device");
  const std::string line = text_of(body, "line");
  const auto& devices = parts_.catalogue.mission().devices;
  // The name becomes part of a path: only what the mission declares gets there.
  if (std::ranges::none_of(devices, [&](const auto& known) { return known.name == device; }))
    return done(refuse(404, "the mission has no simulated device '" + device + "'"));
  constexpr std::size_t longest_line = 255;
  if (line.empty() || line.size() > longest_line || std::ranges::any_of(line, [](char c) { return c >= 0 && c < ' '; }))
    return done(refuse(400, "line: one line of text is wanted"));
  constexpr std::size_t most_own = 100;
  if (parts_.outside.injected) own_faults_.emplace_back(device, line);
  if (own_faults_.size() > most_own) own_faults_.pop_front();
  parts_.outside.ask_device(device, line,
                            [this, device, line, done = std::move(done)](std::optional<std::string> answer) {
                              if (answer != "ok")
                                static_cast<void>(is_own_fault(device, line));  // nothing was injected
                              if (!answer) return done(refuse(503, "the device does not answer"));
                              tell_fault({now(), device, line, *answer});
                              done(json{{"answer", *answer}});
                            });
}

void Session::tell_fault(const StoredFault& fault) {
  parts_.archive.add(fault);
  broadcast({{"type", "fault"},
             {"t", json_time(fault.t)},
             {"device", fault.device},
             {"line", fault.line},
             {"answer", fault.answer}});
}

void Session::take_injections() {
  if (!parts_.outside.injected) return;
  for (const StoredFault& fault : parts_.outside.injected())
    if (!is_own_fault(fault.device, fault.line)) tell_fault(fault);
}

bool Session::is_own_fault(const std::string& device, const std::string& line) {
  const auto own = std::ranges::find(own_faults_, std::pair{device, line});
  if (own == own_faults_.end()) return false;
  own_faults_.erase(own);
  return true;
}

json Session::link_json() const {
  const bool heard = model_.newest() != OnboardTime{};
  return {{"connected", connected_},
          {"age_s", heard ? json(seconds(parts_.clock.now() - newest_received_)) : json(nullptr)},
          {"rx", downlink_.received()},
          {"tx", commands_.sent()},
          {"lost", downlink_.lost()},
          {"damaged", downlink_.damaged()},
          {"archive_failures", parts_.archive.failures()}};
}

json Session::status() const {
  json status = status_json(parts_.catalogue, model_, now());
  status["link"] = link_json();
  status["commandable"] = connected_;
  json values = json::object();
  for (std::size_t i = 0; i < model_.values().size(); ++i) {
    const Value& value = model_.values()[i];
    if (value.revision == 0) continue;
    const Column& column = parts_.catalogue.columns()[i];
    values[column.name] = {
        {"v", value_json(column, value)}, {"t", json_time(value.t)}, {"age_s", seconds(now() - value.t)}};
  }
  status["values"] = std::move(values);
  return status;
}

}  // namespace hirosco::ground
