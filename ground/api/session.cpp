// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/session.hpp"

#include <algorithm>
#include <array>

#include "ground/api/client.hpp"
#include "ground/api/views.hpp"
#include "ground/commands/foreign_command.hpp"
#include "ground/model/json.hpp"
#include "hirosco/pus/packet/failure.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/st129_supervision/supervision.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration question_limit = 2s;
/// No function of the shipped subsystems runs longer; what comes later is still in the archive as a packet.
constexpr Duration command_limit = 600s;
constexpr Duration housekeeping_period = 1s;
constexpr std::uint16_t count_modulo = 16'384;
constexpr std::size_t longest_sender = 32;
constexpr std::size_t most_open_commands = 10'000;
/// Of the supervisor's own telecommands (decision 27).
constexpr std::uint16_t supervisor_source = 1;

[[nodiscard]] std::string hex_of(Octets octets) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (const std::byte octet : octets) {
    text += digits[std::to_integer<std::size_t>(octet) >> 4];
    text += digits[std::to_integer<std::size_t>(octet) & 15];
  }
  return text;
}

[[nodiscard]] std::unexpected<Refusal> refuse(unsigned status, std::string text) {
  return std::unexpected{Refusal{status, std::move(text)}};
}

[[nodiscard]] std::string number_text(double number) { return to_string(json_number(number)); }

/// One value of an argument: a number, or the name of an entry of its enumeration.
[[nodiscard]] Answered<double> value_of(const json& given, const std::vector<descriptor::EnumerationText>& texts,
                                        const std::string& argument) {
  // A whole number that a double does not hold would be sent as its neighbour.
  constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;
  const bool inexact = (given.is_number_unsigned() && given.get<std::uint64_t>() > largest_exact) ||
                       (!given.is_number_unsigned() && given.is_number_integer() &&
                        given.get<std::int64_t>() < -static_cast<std::int64_t>(largest_exact));
  if (inexact) return refuse(400, argument + ": whole numbers are sent exactly up to 2^53 only");
  if (given.is_number()) return given.get<double>();
  if (given.is_string())
    for (const auto& entry : texts)
      if (lower_case(entry.text) == lower_case(given.get<std::string>())) return static_cast<double>(entry.value);
  return refuse(400, argument + ": neither a number nor a name that it knows");
}

[[nodiscard]] Answered<void> check_range(double value, const descriptor::Field& field) {
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  if (!std::isfinite(value)) return refuse(400, field.name + ": not a finite number");
  if (field.minimum && value < *field.minimum)
    return refuse(
        400, field.name + ": " + number_text(value) + " is below its minimum " + number_text(*field.minimum) + unit);
  if (field.maximum && value > *field.maximum)
    return refuse(
        400, field.name + ": " + number_text(value) + " is above its maximum " + number_text(*field.maximum) + unit);
  return {};
}

}  // namespace

Session::Session(Parts parts) : parts_{std::move(parts)}, model_{parts_.catalogue}, count_{parts_.first_count} {
  if (const auto extent = parts_.archive.extent()) last_known_ = extent->to;
}

Session::~Session() { parts_.archive.commit(); }

OnboardTime Session::now() const {
  if (model_.newest() == OnboardTime{}) return parts_.clock.onboard();
  return model_.newest() + (parts_.clock.now() - newest_received_);
}

// --- the link --------------------------------------------------------------------------------------------------------

void Session::link_up() {
  connected_ = true;
  fresh_link_ = true;
  stream_.clear();
  expected_.clear();
}

void Session::link_down() {
  connected_ = false;
  if (model_.newest() != OnboardTime{}) last_known_ = model_.newest();
  parts_.archive.commit();
}

void Session::not_sent(Octets packet) {
  const auto header = pus::read_primary_header(packet);
  const auto found = header ? open_commands_.find({parts_.source, header->request_id}) : open_commands_.end();
  if (found == open_commands_.end()) return;  // a question: it expires
  StoredCommand command = std::move(found->second.command);
  open_commands_.erase(found);
  command.t = now();
  command.stage = "failed";
  command.reason = "not sent: the link was lost";
  parts_.archive.add(command.number, StoredReport{command.t, command.stage, std::nullopt, command.reason});
  json message = command_json(command);
  message["type"] = "command";
  broadcast(message);
}

bool Session::receive(Octets octets) {
  stream_.insert(stream_.end(), octets.begin(), octets.end());
  std::size_t used = 0;
  bool good = true;
  while (stream_.size() - used >= pus::primary_header_octets) {
    const Octets rest = Octets{stream_}.subspan(used);
    const std::size_t size = pus::announced_octets(rest);
    const auto header = pus::read_primary_header(rest);
    good = size <= pus::max_telemetry_octets && header && !header->telecommand && header->version == 0;
    if (!good || rest.size() < size) break;
    take_packet(rest.first(size));
    used += size;
  }
  stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(used));
  // What the link delivered survives the end of this process from here on.
  parts_.archive.commit();
  return good;
}

void Session::take_packet(Octets octets) {
  const auto packet = pus::TelemetryView::parse(octets);
  if (!packet) {
    ++damaged_;
    return;
  }
  ++received_;
  if (fresh_link_ && last_known_ && packet->time() > *last_known_) add_gap(*last_known_, packet->time());
  fresh_link_ = false;
  count_lost(*packet);
  const Heard heard = model_.take(*packet);
  newest_received_ = parts_.clock.now();
  StoredPacket stored{.t = packet->time(), .apid = packet->apid(), .octets = {}};
  stored.service = packet->service();
  stored.subtype = packet->subtype();
  stored.sid = heard.sid;
  parts_.archive.add(stored, octets);
  for (const StoredChange& change : heard.changes) parts_.archive.add(change);
  if (heard.event) {
    parts_.archive.add(*heard.event);
    json message = event_json(*heard.event);
    message["type"] = "event";
    broadcast(message);
  }
  if (!heard.telecommand.empty()) take_copy(heard.telecommand, packet->time());
  if (heard.verdict) take_verdict(*heard.verdict, packet->time());
  if (heard.answer) take_answer(*heard.answer);
}

void Session::count_lost(const pus::TelemetryView& packet) {
  const auto next = static_cast<std::uint16_t>((packet.sequence_count() + 1) % count_modulo);
  const auto [known, first] = expected_.try_emplace(packet.apid(), next, packet.time());
  if (first) return;
  const auto missing =
      static_cast<std::uint16_t>((packet.sequence_count() + count_modulo - known->second.first) % count_modulo);
  // Half of the numbers back is a process that began again, or an old packet: nothing was lost.
  if (missing != 0 && missing < count_modulo / 2) {
    lost_ += missing;
    if (packet.time() > known->second.second) add_gap(known->second.second, packet.time());
  }
  known->second = {next, packet.time()};
}

void Session::add_gap(OnboardTime from, OnboardTime to) {
  parts_.archive.add(StoredGap{from, to});
  broadcast({{"type", "gap"}, {"from", json_time(from)}, {"to", json_time(to)}});
}

void Session::take_verdict(const Verdict& verdict, OnboardTime t) {
  const auto key = std::pair{verdict.destination, verdict.request_id};
  auto found = open_commands_.find(key);
  if (found == open_commands_.end()) {
    // The supervisor's own are its business; of ours that have ended, nothing more is wanted.
    if (verdict.destination == supervisor_source || verdict.destination == parts_.source) return;
    if (open_commands_.size() >= most_open_commands) return;
    found = open_commands_.emplace(key, add_foreign(verdict, t)).first;
  }
  StoredCommand& command = found->second.command;
  parts_.archive.add(command.number, StoredReport{t, verdict.stage, verdict.code, verdict.reason});
  command.t = t;
  command.stage = verdict.stage;
  command.code = verdict.code;
  command.reason = verdict.reason;
  json message = command_json(command);
  message["type"] = "command";
  broadcast(message);
  if (verdict.last) open_commands_.erase(found);
}

void Session::take_copy(Octets packet, OnboardTime t) {
  const auto telecommand = pus::TelecommandView::parse(packet);
  if (!telecommand || telecommand->source() == parts_.source || open_commands_.size() >= most_open_commands) return;
  StoredCommand command = command_of(parts_.catalogue, *telecommand);
  command.t = t;
  command.number = parts_.archive.add(command);
  open_commands_[{telecommand->source(), telecommand->request_id()}] = {command, parts_.clock.now()};
  json message = command_json(command);
  message["type"] = "command";
  broadcast(message);
}

Session::Open Session::add_foreign(const Verdict& verdict, OnboardTime t) {
  constexpr std::uint16_t apid_mask = 0x7FF;
  StoredCommand command;
  command.t = t;
  command.sender = sender_of(verdict.destination);
  command.apid = static_cast<std::uint16_t>(verdict.request_id >> 16 & apid_mask);
  command.subsystem = parts_.catalogue.name_of(command.apid);
  command.function = "?";
  command.arguments = "{}";
  command.stage = "sent";
  command.number = parts_.archive.add(command);
  return {std::move(command), parts_.clock.now()};
}

void Session::take_answer(const PermissionAnswer& answer) {
  if (answer.destination != parts_.source) return;
  const auto found = questions_.find(answer.request_id);
  if (found == questions_.end()) return;
  const Question question = std::move(found->second);
  questions_.erase(found);
  json result{{"octets", question.octets}, {"permitted", answer.permitted}, {"code", nullptr}, {"reason", nullptr}};
  if (!answer.permitted) {
    const auto code = static_cast<pus::FailureCode>(answer.code);
    result["code"] = answer.code;
    std::string reason{to_text(code)};
    if (code == pus::FailureCode::WrongMode) reason += " (" + model_.mode() + ")";
    result["reason"] = reason.empty() ? "code " + std::to_string(answer.code) : reason;
  }
  question.done(std::move(result));
}

void Session::tick() {
  const TimePoint now = parts_.clock.now();
  expire(now);
  for (const auto& client : clients_) client->tick(now);
  parts_.archive.commit();
  if (now >= next_housekeeping_) {
    parts_.archive.keep_within_limit();
    next_housekeeping_ = now + housekeeping_period;
  }
}

void Session::expire(TimePoint now) {
  std::erase_if(open_commands_, [&](const auto& entry) { return now - entry.second.since > command_limit; });
  std::vector<Question> unanswered;
  std::erase_if(questions_, [&](auto& entry) {
    if (now - entry.second.since <= question_limit) return false;
    unanswered.push_back(std::move(entry.second));
    return true;
  });
  for (const Question& question : unanswered)
    question.done(json{{"octets", question.octets},
                       {"permitted", nullptr},
                       {"code", nullptr},
                       {"reason", "the supervisor did not answer"}});
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

Answered<Session::Prepared> Session::prepare(const json& body) const {
  const std::string name = text_of(body, "subsystem");
  const auto* subsystem = parts_.catalogue.find(std::string_view{name});
  if (subsystem == nullptr) return refuse(400, "no subsystem '" + name + "'");
  const std::string wanted = text_of(body, "function");
  const auto functions = parts_.catalogue.functions_of(*subsystem);
  const auto function = std::ranges::find(functions, wanted, &descriptor::Function::name);
  if (function == functions.end()) return refuse(400, name + " has no function '" + wanted + "'");
  const json none = json::object();
  const auto named = body.find("arguments");
  const json& given = named != body.end() ? *named : none;
  if (!given.is_object()) return refuse(400, "arguments: an object {name: value} is wanted");
  for (const auto& [argument, unused] : given.items())
    if (std::ranges::none_of(function->arguments, [&](const auto& known) { return known.field.name == argument; }))
      return refuse(400, wanted + " has no argument '" + argument + "'");

  json sent = json::object();
  std::vector<std::optional<double>> values;
  for (const auto& argument : function->arguments) {
    const auto& field = argument.field;
    const auto found = given.find(field.name);
    if (found == given.end() || found->is_null()) {
      if (!argument.fallback) return refuse(400, field.name + ": a value is wanted");
      values.insert(values.end(), field.count, std::nullopt);
      sent[field.name] = json_number(*argument.fallback);
      continue;
    }
    const json list = found->is_array() ? *found : json::array({*found});
    if (list.size() != field.count)
      return refuse(400, field.name + ": " + std::to_string(field.count) + " values are wanted");
    const auto texts = parts_.catalogue.texts_of(*subsystem, *function, field);
    for (const json& entry : list) {
      const auto value = value_of(entry, texts, field.name);
      if (!value) return std::unexpected{value.error()};
      if (const auto fits = check_range(*value, field); !fits) return std::unexpected{fits.error()};
      values.push_back(*value);
    }
    sent[field.name] = *found;
  }
  Prepared prepared;
  prepared.subsystem = subsystem;
  prepared.function = wanted;
  prepared.arguments = to_string(sent);
  prepared.service = function->service;
  prepared.subtype = function->subtype;
  auto data = pus::encode_request(*function, std::span<const std::optional<double>>{values});
  if (!data) return refuse(400, wanted + ": " + data.error().text);
  prepared.data = std::move(*data);
  if (pus::goes_alone(*function)) prepared.way = Way::Alone;
  return prepared;
}

Answered<std::vector<std::byte>> Session::packet_of(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype,
                                                    std::uint8_t ack, Octets data, std::uint16_t count) const {
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = apid,
                                              .sequence_count = count,
                                              .ack = ack,
                                              .service = service,
                                              .subtype = subtype,
                                              .source = parts_.source},
                                             data);
  if (!packet) return refuse(400, packet.error().text);
  return std::vector<std::byte>{packet->begin(), packet->end()};
}

std::uint16_t Session::next_count() {
  const std::uint16_t count = count_;
  count_ = static_cast<std::uint16_t>((count_ + 1) % count_modulo);
  return count;
}

Answered<json> Session::command(const json& body) {
  const auto prepared = prepare(body);
  if (!prepared) return std::unexpected{prepared.error()};
  if (!connected_ && prepared->way == Way::InTurn) return refuse(503, "no link to the spacecraft");
  const std::uint16_t count = next_count();
  const auto packet =
      packet_of(prepared->subsystem->id, prepared->service, prepared->subtype, pus::ack_all, prepared->data, count);
  if (!packet) return std::unexpected{packet.error()};
  StoredCommand command;
  command.t = now();
  command.sender = text_of(body, "sender").substr(0, longest_sender);
  if (command.sender.empty()) command.sender = "operator";
  command.apid = prepared->subsystem->id;
  command.subsystem = prepared->subsystem->name;
  command.function = prepared->function;
  command.arguments = prepared->arguments;
  command.stage = "sent";
  // Before it leaves: what was sent is known even if this process ends now.
  command.number = parts_.archive.add(command);
  parts_.archive.commit();
  const std::uint32_t request_id = pus::read_primary_header(*packet)->request_id;
  open_commands_[{parts_.source, request_id}] = {command, parts_.clock.now()};
  if (!parts_.outside.send(*packet, prepared->way)) {
    open_commands_.erase({parts_.source, request_id});
    parts_.archive.add(command.number, StoredReport{command.t, "failed", std::nullopt, "not sent: no link"});
    return refuse(503, "no link to the spacecraft");
  }
  ++sent_;
  json message = command_json(command);
  message["type"] = "command";
  broadcast(message);
  return json{{"id", command.number}, {"apid", command.apid}, {"count", count}, {"octets", hex_of(*packet)}};
}

void Session::preview(const json& body, std::function<void(Answered<json>)> done) {
  const auto prepared = prepare(body);
  if (!prepared) return done(std::unexpected{prepared.error()});
  const auto asked =
      packet_of(prepared->subsystem->id, prepared->service, prepared->subtype, pus::ack_all, prepared->data, count_);
  if (!asked) return done(std::unexpected{asked.error()});
  const std::string octets = hex_of(*asked);
  // No reports but the answer itself.
  const auto query = packet_of(parts_.catalogue.mission().supervisor.id, pus::st129::service_type,
                               pus::st129::permission_question, 0, *asked, next_count());
  const bool sent = connected_ && query && parts_.outside.send(*query, Way::InTurn);
  if (!sent)
    return done(
        json{{"octets", octets}, {"permitted", nullptr}, {"code", nullptr}, {"reason", "no link to the spacecraft"}});
  ++sent_;
  questions_.emplace(pus::read_primary_header(*asked)->request_id,
                     Question{octets, std::move(done), parts_.clock.now()});
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
  parts_.outside.ask_device(
      device, line, [this, device, line, done = std::move(done)](std::optional<std::string> answer) {
        if (!answer) return done(refuse(503, "the device does not answer"));
        const StoredFault fault{now(), device, line, *answer};
        parts_.archive.add(fault);
        broadcast(
            {{"type", "fault"}, {"t", json_time(fault.t)}, {"device", device}, {"line", line}, {"answer", *answer}});
        done(json{{"answer", *answer}});
      });
}

json Session::link_json() const {
  const bool heard = model_.newest() != OnboardTime{};
  return {{"connected", connected_},
          {"age_s", heard ? json(seconds(parts_.clock.now() - newest_received_)) : json(nullptr)},
          {"rx", received_},
          {"tx", sent_},
          {"lost", lost_},
          {"damaged", damaged_},
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
    values[parts_.catalogue.columns()[i].name] = {
        {"v", json_number(value.number)}, {"t", json_time(value.t)}, {"age_s", seconds(now() - value.t)}};
  }
  status["values"] = std::move(values);
  return status;
}

}  // namespace hirosco::ground
