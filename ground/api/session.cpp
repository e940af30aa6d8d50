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

/// Who a client says that it is.
[[nodiscard]] Authority::Seat seat_of(const json& body) {
  std::string name = text_of(body, "sender").substr(0, Authority::longest_name);
  return {.id = text_of(body, "seat").substr(0, Authority::longest_seat), .name = name.empty() ? "operator" : name};
}

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
                 .first_count = parts_.first_count}},
      catch_up_{{.catalogue = parts_.catalogue,
                 .archive = parts_.archive,
                 .clock = parts_.clock,
                 .source = parts_.source,
                 .ask =
                     [this](const pus::st129::Retrieve& wanted) {
                       return commands_.ask(pus::st129::retrieve, pus::st129::write_retrieve(wanted));
                     },
                 .heard = [this](const Heard& heard, OnboardTime t) { take_past(heard, t); },
                 .filled =
                     [this](OnboardTime from, OnboardTime to) {
                       broadcast({{"type", "filled"}, {"from", json_time(from)}, {"to", json_time(to)}});
                     }}},
      flights_{parts_.catalogue, parts_.archive},
      alarms_{parts_.archive, flights_.began()},
      stacks_{parts_.archive},
      authority_{[this](const StoredMark& mark) { keep(mark); }} {
  if (const auto extent = parts_.archive.extent()) archived_until_ = extent->to;
  // What the station before this one had not fetched yet.
  for (const StoredGap& gap : parts_.archive.gaps({.from = flights_.began()}))
    catch_up_.missing(gap.from, gap.to,
                      gap.from <= flights_.began() ? CatchUp::After::TheBegin : CatchUp::After::APacket);
}

Session::~Session() { parts_.archive.commit(); }

OnboardTime Session::now() const {
  if (model_.newest() == OnboardTime{}) return parts_.clock.onboard();
  return model_.newest() + (parts_.clock.now() - newest_received_);
}

// --- the link --------------------------------------------------------------------------------------------------------

void Session::link_up() {
  connected_ = true;
  catch_up_.link_up();
  downlink_.begin(model_.newest() != OnboardTime{} ? std::optional{model_.newest()} : archived_until_);
}

void Session::link_down() {
  connected_ = false;
  catch_up_.link_down();
  parts_.archive.commit();
}

bool Session::receive(Octets octets) {
  const bool good = downlink_.receive(octets);
  // What the link delivered survives the end of this process from here on.
  parts_.archive.commit();
  return good;
}

void Session::take(const pus::TelemetryView& packet, Octets octets) {
  if (catch_up_.hear(packet)) return;
  if (model_.newest() == OnboardTime{} && !archived_until_) first_heard_ = packet.time();
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
    tell_event(*heard.event);
  }
  if (flights_.hear(model_)) begin_flight();
  commands_.hear(heard, packet.time());
}

void Session::tell_event(const StoredEvent& event) {
  json message = event_json(event);
  message["type"] = "event";
  broadcast(message);
  if (auto alarm = alarms_.hear(event)) tell_alarm(std::move(*alarm));
}

void Session::take_past(const Heard& heard, OnboardTime t) {
  if (heard.event && heard.event->t >= flights_.began()) tell_event(*heard.event);
  commands_.hear(heard, t);
}

void Session::begin_flight() {
  alarms_.begin(flights_.began());
  if (const auto first = std::exchange(first_heard_, std::nullopt))
    add_gap(flights_.began(), *first, CatchUp::After::TheBegin);
  json message = flights_.present();
  message["type"] = "flight";
  broadcast(message);
}

void Session::keep(const StoredMark& mark) {
  parts_.archive.add(mark);
  parts_.archive.commit();
  json message = authority();
  message["type"] = "authority";
  message["did"] = mark_json(mark);
  broadcast(message);
}

Authority::Now Session::both_times() const { return {.ground = parts_.clock.now(), .onboard = now()}; }

void Session::tell_alarm(json alarm) {
  alarm["type"] = "alarm";
  broadcast(alarm);
}

void Session::add_gap(OnboardTime from, OnboardTime to, CatchUp::After after) {
  if (to <= from) return;
  parts_.archive.add(StoredGap{from, to});
  catch_up_.missing(from, to, after);
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
  catch_up_.tick();
  for (const auto& client : clients_) client->tick(now);
  if (now >= next_injections_) {
    take_injections();
    next_injections_ = now + injections_period;
  }
  if (others_changed_) tell_who_is_here();
  parts_.archive.commit();
  if (now >= next_housekeeping_) {
    parts_.archive.keep_within_limit();
    std::set<std::string> present;
    for (const auto& client : clients_) present.insert(client->seat());
    authority_.see(std::move(present), both_times());
    for (json& alarm : alarms_.expire(this->now())) tell_alarm(std::move(alarm));
    next_housekeeping_ = now + housekeeping_period;
  }
}

// --- clients ---------------------------------------------------------------------------------------------------------

std::string Session::opened(Peer& peer, bool is_operator, const std::string& seat) {
  std::string id = "c" + std::to_string(next_client_++);
  // An observer's page cannot hold what it cannot take.
  clients_.push_back(std::make_unique<Client>(
      *this, peer,
      Client::Who{
          .id = id, .seat = is_operator ? seat.substr(0, Authority::longest_seat) : "", .is_operator = is_operator}));
  others_changed_ = true;
  return id;
}

void Session::received(const Peer& peer, const std::string& text) {
  for (const auto& client : clients_)
    if (&client->peer() == &peer) {
      client->received(text);
      others_changed_ = true;
      return;
    }
}

void Session::closed(const Peer& peer) {
  std::erase_if(clients_, [&](const auto& client) { return &client->peer() == &peer; });
  others_changed_ = true;
}

json Session::present() const {
  json pages = json::array();
  std::size_t operators = 0;
  for (const auto& client : clients_) {
    operators += client->is_operator() ? 1 : 0;
    if (pages.size() == most_present) continue;
    pages.push_back({{"client", client->id()},
                     {"seat", client->seat()},
                     {"name", client->name()},
                     {"operator", client->is_operator()},
                     {"replay", client->in_replay()}});
  }
  return {{"pages", std::move(pages)}, {"operators", operators}, {"observers", clients_.size() - operators}};
}

void Session::tell_who_is_here() {
  others_changed_ = false;
  json message = present();
  message["type"] = "present";
  broadcast(message);
}

bool Session::in_replay(const std::string& client) const {
  return std::ranges::any_of(clients_, [&](const auto& c) { return c->id() == client && c->in_replay(); });
}

void Session::broadcast(const json& message) {
  for (const auto& client : clients_) client->tell(message);
}

// --- requests --------------------------------------------------------------------------------------------------------

Answered<json> Session::command(const json& body) {
  const auto request = request_of(parts_.catalogue, body);
  if (!request) return std::unexpected{request.error()};
  // What leads towards safety is refused to nobody, and waits for nobody.
  if (!request->essential) {
    const auto confirmed = body.find("confirmed");
    const bool is_confirmed = confirmed != body.end() && confirmed->is_boolean() && confirmed->get<bool>();
    if (request->confirm && !is_confirmed)
      return refuse(409, request->function + " is to be confirmed: send it once more with confirmed: true");
    if (const auto may = authority_.may_command(seat_of(body), both_times()); !may) return std::unexpected{may.error()};
  }
  return commands_.send(body);
}

json Session::authority() const { return authority_.json(parts_.clock.now()); }

Answered<json> Session::authority(const json& body) {
  const std::string action = text_of(body, "action");
  const Authority::Seat seat = seat_of(body);
  Answered<void> done = refuse(400, "action: take, keep or hand_over is wanted");
  if (action == "take") done = authority_.take(seat, both_times());
  if (action == "keep") done = authority_.keep(seat, both_times());
  if (action == "hand_over") done = authority_.hand_over(seat, both_times());
  if (!done) return std::unexpected{done.error()};
  return authority();
}

Answered<json> Session::alarm(const json& body) {
  auto done = alarms_.act(body, seat_of(body).name, now());
  if (!done) return done;
  json message = *done;
  message["type"] = message.contains("alarms") ? "alarms" : "alarm";
  broadcast(message);
  return alarms_.list();
}

Answered<json> Session::keep_stack(const json& body) {
  auto done = stacks_.keep(body, seat_of(body).name, now());
  if (!done) return done;
  json message = *done;
  message["type"] = "stacks";
  broadcast(message);
  return done;
}

Answered<json> Session::tell_of_flight(const json& body) {
  const std::string who = seat_of(body).name;
  if (!body.contains("note")) return flights_.name(body, who, now());
  auto done = flights_.note(body, who, now());
  if (!done) return done;
  json message = *done;
  message["type"] = "notes";
  broadcast(message);
  return done;
}

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
  if (line.empty() || line.size() > longest_line || std::ranges::any_of(line, [](unsigned char c) { return c < ' '; }))
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
