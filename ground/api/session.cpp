// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/session.hpp"

#include <algorithm>

#include "ground/commands/question_source.hpp"
#include "ground/model/json.hpp"
#include "ground/model/views.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration housekeeping_period = 1s;

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
                 .source = question_source(parts_.source),
                 .ask =
                     [this](const pus::st129::Retrieve& wanted) {
                       return commands_.ask(pus::st129::retrieve, pus::st129::write_retrieve(wanted));
                     },
                 .heard = [this](const Heard& heard, OnboardTime t) { take_past(heard, t); },
                 .filled =
                     [this](OnboardTime from, OnboardTime to) {
                       pages_.tell({{"type", "filled"}, {"from", json_time(from)}, {"to", json_time(to)}});
                     }}},
      flights_{parts_.catalogue, parts_.archive},
      alarms_{parts_.archive, flights_.began()},
      stacks_{parts_.archive},
      authority_{[this](const StoredMark& mark) { keep(mark); }},
      pages_{*this},
      faults_{{.ask_device = parts_.outside.ask_device,
               .injected = parts_.outside.injected,
               .catalogue = parts_.catalogue,
               .archive = parts_.archive,
               .now = [this] { return now(); },
               .tell = [this](const json& message) { pages_.tell(message); }}} {
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
  pages_.tell(message);
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
  pages_.tell(message);
}

void Session::keep(const StoredMark& mark) {
  parts_.archive.add(mark);
  parts_.archive.commit();
  json message = authority();
  message["type"] = "authority";
  message["did"] = mark_json(mark);
  pages_.tell(message);
}

Authority::Now Session::both_times() const { return {.ground = parts_.clock.now(), .onboard = now()}; }

void Session::tell_alarm(json alarm) {
  alarm["type"] = "alarm";
  pages_.tell(alarm);
}

void Session::add_gap(OnboardTime from, OnboardTime to, CatchUp::After after) {
  if (to <= from) return;
  parts_.archive.add(StoredGap{from, to});
  catch_up_.missing(from, to, after);
  pages_.tell({{"type", "gap"}, {"from", json_time(from)}, {"to", json_time(to)}});
}

void Session::tell_command(const StoredCommand& command) {
  json message = command_json(command);
  message["type"] = "command";
  pages_.tell(message);
}

void Session::tick() {
  const TimePoint now = parts_.clock.now();
  commands_.expire(now);
  catch_up_.tick();
  pages_.tick(now);
  faults_.tick(now);
  pages_.tell_who_is_here();
  parts_.archive.commit();
  if (now >= next_housekeeping_) {
    parts_.archive.keep_within_limit();
    authority_.see(pages_.seats(), both_times());
    for (json& alarm : alarms_.expire(this->now())) tell_alarm(std::move(alarm));
    next_housekeeping_ = now + housekeeping_period;
  }
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
  pages_.tell(message);
  return alarms_.list();
}

Answered<json> Session::keep_stack(const json& body) {
  auto done = stacks_.keep(body, seat_of(body).name, now());
  if (!done) return done;
  json message = *done;
  message["type"] = "stacks";
  pages_.tell(message);
  return done;
}

Answered<json> Session::tell_of_flight(const json& body) {
  const std::string who = seat_of(body).name;
  if (!body.contains("note")) return flights_.name(body, who, now());
  auto done = flights_.note(body, who, now());
  if (!done) return done;
  json message = *done;
  message["type"] = "notes";
  pages_.tell(message);
  return done;
}

void Session::mode_preview(const json& body, std::function<void(Answered<json>)> done) {
  commands_.mode_preview(body, std::move(done));
}

void Session::preview(const json& body, std::function<void(Answered<json>)> done) {
  commands_.preview(body, std::move(done));
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
