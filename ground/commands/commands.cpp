// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/commands.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "ground/commands/foreign_command.hpp"
#include "ground/commands/question_source.hpp"
#include "ground/model/json.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration question_limit = 2s;
/// No function of the shipped subsystems runs longer; what comes later is still in the archive as a packet.
constexpr Duration command_limit = 600s;
constexpr std::uint16_t count_modulo = 16'384;
constexpr std::size_t longest_sender = 32;
constexpr std::size_t most_open = 10'000;

constexpr std::uint16_t asked_apid(std::uint32_t request_id) {
  return static_cast<std::uint16_t>(request_id >> 16 & 0x7FF);
}

/// Of whichever station: no telecommand of anybody. Questions go to the supervisor alone; a program beyond our ranges may have such a source
/// id, too.
constexpr bool is_on_question(const Verdict& verdict) {
  return is_question_source(verdict.destination) && asked_apid(verdict.request_id) == pus::supervisor_apid;
}

[[nodiscard]] std::string hex_of(Octets octets) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (const std::byte octet : octets) {
    text += digits[std::to_integer<std::size_t>(octet) >> 4];
    text += digits[std::to_integer<std::size_t>(octet) & 15];
  }
  return text;
}

struct Address {
  std::uint16_t apid{};
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint8_t ack{};
};

[[nodiscard]] Answered<std::vector<std::byte>> make_telecommand(const Address& to, std::uint16_t source,
                                                                std::uint16_t count, Octets data) {
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = to.apid,
                                              .sequence_count = count,
                                              .ack = to.ack,
                                              .service = to.service,
                                              .subtype = to.subtype,
                                              .source = source},
                                             data);
  if (!packet) return refuse(400, packet.error().text);
  return std::vector<std::byte>{packet->begin(), packet->end()};
}

}  // namespace

Answered<std::vector<std::byte>> Commands::packet_of(const Request& request, std::uint16_t count) const {
  return make_telecommand({request.subsystem->id, request.service, request.subtype, pus::ack_all}, parts_.source, count,
                          request.data);
}

std::uint16_t Commands::next_count() {
  const std::uint16_t count = count_;
  count_ = static_cast<std::uint16_t>((count_ + 1) % count_modulo);
  return count;
}

Answered<json> Commands::send(const json& body) {
  const auto request = request_of(parts_.catalogue, body);
  if (!request) return std::unexpected{request.error()};
  if (!parts_.connected() && request->way == Way::InTurn) return refuse(503, "no link to the spacecraft");
  const std::uint16_t count = next_count();
  const auto packet = packet_of(*request, count);
  if (!packet) return std::unexpected{packet.error()};
  StoredCommand command;
  command.t = parts_.now();
  command.sender = text_of(body, "sender").substr(0, longest_sender);
  if (command.sender.empty()) command.sender = "operator";
  command.apid = request->subsystem->id;
  command.subsystem = request->subsystem->name;
  command.function = request->function;
  command.arguments = request->arguments;
  command.stage = "sent";
  // Before it leaves: what was sent is known even if this process ends now.
  command.number = parts_.archive.add(command);
  parts_.archive.commit();
  const std::uint32_t request_id = pus::read_primary_header(*packet)->request_id;
  open_[{parts_.source, request_id}] = {command, parts_.clock.now()};
  if (!parts_.send(*packet, request->way)) {
    open_.erase({parts_.source, request_id});
    parts_.archive.add(command.number, StoredReport{command.t, "failed", std::nullopt, "not sent: no link"});
    return refuse(503, "no link to the spacecraft");
  }
  ++sent_;
  parts_.tell(command);
  return json{{"id", command.number}, {"apid", command.apid}, {"count", count}, {"octets", hex_of(*packet)}};
}

void Commands::preview(const json& body, std::function<void(Answered<json>)> done) {
  const auto request = request_of(parts_.catalogue, body);
  if (!request) return done(std::unexpected{request.error()});
  const auto asked = packet_of(*request, count_);
  if (!asked) return done(std::unexpected{asked.error()});
  const std::string octets = hex_of(*asked);
  // No reports but the answer itself.
  if (!ask(pus::st129::permission_question, *asked))
    return done(
        json{{"octets", octets}, {"permitted", nullptr}, {"code", nullptr}, {"reason", "no link to the spacecraft"}});
  ++sent_;
  questions_.emplace(pus::read_primary_header(*asked)->request_id,
                     Question{octets, std::move(done), parts_.clock.now()});
}

std::optional<std::uint32_t> Commands::ask(std::uint8_t subtype, Octets data) {
  const auto query = make_telecommand({parts_.catalogue.mission().supervisor.id, pus::st129::service_type, subtype, 0},
                                      question_source(parts_.source), next_count(), data);
  if (!parts_.connected() || !query || !parts_.send(*query, Way::InTurn)) return std::nullopt;
  return pus::read_primary_header(*query)->request_id;
}

void Commands::mode_preview(const json& body, std::function<void(Answered<json>)> done) {
  const descriptor::Mission& mission = parts_.catalogue.mission();
  const std::string name = text_of(body, "mode");
  const auto wanted = std::ranges::find(mission.modes, name, &descriptor::Mode::name);
  if (wanted == mission.modes.end()) return done(refuse(400, "no mode '" + name + "'"));
  const std::array data{std::byte{wanted->id}};
  if (!ask(pus::st129::mode_question, data)) return done(refuse(503, "no link to the spacecraft"));
  ++sent_;
  mode_questions_.push_back({wanted->id, std::move(done), parts_.clock.now()});
}

void Commands::not_sent(Octets packet) {
  const auto header = pus::read_primary_header(packet);
  const auto found = header ? open_.find({parts_.source, header->request_id}) : open_.end();
  if (found == open_.end()) return;  // a question: it expires
  StoredCommand command = std::move(found->second.command);
  open_.erase(found);
  command.t = parts_.now();
  command.stage = "failed";
  command.reason = "not sent: the link was lost";
  parts_.archive.add(command.number, StoredReport{command.t, command.stage, std::nullopt, command.reason});
  parts_.tell(command);
}

void Commands::hear(const Heard& heard, OnboardTime t) {
  if (!heard.telecommand.empty()) take_copy(heard.telecommand, t);
  if (heard.verdict) take_verdict(*heard.verdict, t);
  if (heard.answer) take_answer(*heard.answer);
  if (heard.mode_answer) take_answer(*heard.mode_answer);
}

void Commands::take_verdict(const Verdict& verdict, OnboardTime t) {
  const auto key = std::pair{verdict.destination, verdict.request_id};
  auto found = open_.find(key);
  if (found == open_.end()) {
    // The supervisor's own are its business; of ours that have ended, nothing more is wanted.
    if (verdict.destination == pus::supervisor_apid || verdict.destination == parts_.source || is_on_question(verdict))
      return;
    if (open_.size() >= most_open) return;
    found = open_.emplace(key, add_foreign(verdict, t)).first;
  }
  StoredCommand& command = found->second.command;
  parts_.archive.add(command.number, StoredReport{t, verdict.stage, verdict.code, verdict.reason});
  command.t = t;
  command.stage = verdict.stage;
  command.code = verdict.code;
  command.reason = verdict.reason;
  parts_.tell(command);
  if (verdict.last) open_.erase(found);
}

void Commands::take_copy(Octets packet, OnboardTime t) {
  const auto telecommand = pus::TelecommandView::parse(packet);
  if (!telecommand || telecommand->source() == parts_.source || open_.size() >= most_open) return;
  StoredCommand command = command_of(parts_.catalogue, *telecommand);
  command.t = t;
  command.number = parts_.archive.add(command);
  open_[{telecommand->source(), telecommand->request_id()}] = {command, parts_.clock.now()};
  parts_.tell(command);
}

Commands::Open Commands::add_foreign(const Verdict& verdict, OnboardTime t) {
  StoredCommand command;
  command.t = t;
  command.sender = sender_of(verdict.destination);
  command.apid = asked_apid(verdict.request_id);
  command.subsystem = parts_.catalogue.name_of(command.apid);
  command.function = "?";
  command.arguments = "{}";
  command.stage = "sent";
  command.number = parts_.archive.add(command);
  return {std::move(command), parts_.clock.now()};
}

void Commands::take_answer(const PermissionAnswer& answer) {
  if (answer.destination != question_source(parts_.source)) return;
  const auto found = questions_.find(answer.request_id);
  if (found == questions_.end()) return;
  const Question question = std::move(found->second);
  questions_.erase(found);
  json result{{"octets", question.octets}, {"permitted", answer.permitted}, {"code", nullptr}, {"reason", nullptr}};
  if (!answer.permitted) {
    const auto code = static_cast<pus::FailureCode>(answer.code);
    result["code"] = answer.code;
    std::string reason{to_text(code)};
    if (reason == no_enumerator) reason = "code " + std::to_string(answer.code);
    if (code == pus::FailureCode::WrongMode) reason += " (" + parts_.model.mode() + ")";
    result["reason"] = std::move(reason);
  }
  question.done(std::move(result));
}

void Commands::take_answer(const ModeAnswer& answer) {
  if (answer.destination != question_source(parts_.source)) return;
  const descriptor::Mission& mission = parts_.catalogue.mission();
  const auto mode = std::ranges::find(mission.modes, answer.preview.mode, &descriptor::Mode::id);
  json result{{"mode", mode != mission.modes.end() ? mode->name : ""},
              {"against", answer.preview.against},
              {"steps", json::array()}};
  for (const auto& step : answer.preview.steps)
    result["steps"].push_back(
        {{"stage", step.stage}, {"subsystem", parts_.catalogue.name_of(step.subject)}, {"what", step.what}});
  // Who asked the same meanwhile has the same answer.
  std::vector<ModeQuestion> answered;
  std::erase_if(mode_questions_, [&](ModeQuestion& one) {
    if (one.mode != answer.preview.mode) return false;
    answered.push_back(std::move(one));
    return true;
  });
  for (const ModeQuestion& one : answered) one.done(result);
}

void Commands::expire(TimePoint now) {
  std::erase_if(open_, [&](const auto& entry) { return now - entry.second.since > command_limit; });
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
  std::vector<ModeQuestion> late;
  std::erase_if(mode_questions_, [&](ModeQuestion& one) {
    if (now - one.since <= question_limit) return false;
    late.push_back(std::move(one));
    return true;
  });
  for (const ModeQuestion& one : late) one.done(refuse(503, "the supervisor did not answer"));
}

}  // namespace hirosco::ground
