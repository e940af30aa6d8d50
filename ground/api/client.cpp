// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/client.hpp"

#include <algorithm>

#include "ground/api/views.hpp"
#include "ground/model/json.hpp"
#include "hirosco/utilities/version.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration status_period = 1s;
constexpr double greatest_speed = 100.0;
/// A long pause of the server is not caught up in one leap.
constexpr Duration longest_step = 500ms;
/// Events in one step of a replay.
constexpr std::size_t most_events = 1000;
constexpr std::uint16_t try_again_later = 1013;

}  // namespace

Client::Client(Session& session, Peer& peer, std::string id, bool is_operator)
    : session_{session}, peer_{peer}, id_{std::move(id)} {
  const auto extent = session_.archive().extent();
  send({{"type", "hello"},
        {"t", json_time(session_.now())},
        {"version", std::string{version}},
        {"client", id_},
        {"operator", is_operator},
        {"archive_from", extent ? json(json_time(extent->from)) : json(nullptr)}});
  tick(session_.parts_.clock.now());
}

void Client::send(const json& message) {
  if (closing_) return;
  if (peer_.pending_octets() > most_pending_octets) {
    closing_ = true;
    return peer_.close(try_again_later, "this client takes too little");
  }
  peer_.send(to_string(message));
}

void Client::tell(const json& message) {
  if (replay_ == nullptr) send(message);
}

void Client::tick(TimePoint now) {
  if (closing_) return;
  if (replay_ != nullptr) return play(now);
  if (peer_.pending_octets() > busy_octets) return;
  if (session_.connected_ != connected_told_) status_due_ = true;
  connected_told_ = session_.connected_;
  show(session_.model(), session_.now(), now, false);
}

void Client::show(const Model& model, OnboardTime at, TimePoint now, bool replay) {
  if (status_due_ || model.status_revision() != status_told_ || now - status_at_ >= status_period) {
    json status = status_json(session_.catalogue(), model, at);
    status["type"] = "status";
    status["link"] = session_.link_json();
    status["commandable"] = session_.connected_ && !replay;
    if (replay) status["replay"] = true;
    send(status);
    status_due_ = false;
    status_told_ = model.status_revision();
    status_at_ = now;
  }
  if (model.revision() == values_told_) return;
  json set = values_json(session_.catalogue(), model, values_told_);
  values_told_ = model.revision();
  if (set.empty()) return;
  json message{{"type", "values"}, {"t", json_time(model.newest())}, {"set", std::move(set)}};
  if (replay) message["replay"] = true;
  send(message);
}

void Client::received(const std::string& text) {
  const json message = parsed_request(text);
  const auto number = [&](const char* name) {
    const auto found = message.find(name);
    return message.is_object() && found != message.end() && found->is_number() ? std::optional{found->get<double>()}
                                                                               : std::nullopt;
  };
  const std::string type = text_of(message, "type");
  if (const auto at = number("at"); type == "replay" && at) return begin_replay(*at, number("speed").value_or(1.0));
  if (type == "live") {
    replay_.reset();
    values_told_ = 0;
    status_due_ = true;
    send({{"type", "replay"}, {"at", json_time(session_.now())}, {"speed", 1}, {"state", "live"}});
    return tick(session_.parts_.clock.now());
  }
  send({{"type", "error"}, {"error", "understood are {type:\"replay\", at, speed} and {type:\"live\"}"}});
}

void Client::begin_replay(double at, double speed) {
  const auto extent = session_.archive().extent();
  if (!extent) return send({{"type", "error"}, {"error", "the archive is empty"}});
  auto replay = std::make_unique<Replay>(session_.catalogue());
  replay->at = std::clamp(onboard_time(at), extent->from, extent->to);
  replay->end = extent->to;
  replay->speed = std::isfinite(speed) ? std::clamp(speed, 0.0, greatest_speed) : 1.0;
  replay->last = session_.parts_.clock.now();
  std::vector<StoredPacket> newest;
  for (const Report& report : session_.catalogue().reports())
    if (auto packet = session_.archive().last_of(report.apid, report.sid, replay->at))
      newest.push_back(std::move(*packet));
  // In order of time, or an old report would be taken for a clock that went back.
  std::ranges::sort(newest, {}, &StoredPacket::t);
  for (const StoredPacket& packet : newest)
    if (const auto view = pus::TelemetryView::parse(packet.octets)) static_cast<void>(replay->model.take(*view));
  replay_ = std::move(replay);
  values_told_ = 0;
  status_due_ = true;
  announce_replay(replay_->last);
  play(replay_->last);
}

void Client::announce_replay(TimePoint now) {
  const char* state = replay_->ended ? "ended" : replay_->speed == 0.0 ? "paused" : "playing";
  send({{"type", "replay"},
        {"at", json_time(replay_->at)},
        {"speed", replay_->speed},
        {"state", state},
        {"replay", true}});
  replay_->announced = now;
}

void Client::play(TimePoint now) {
  if (peer_.pending_octets() > busy_octets) {
    replay_->last = now;  // the past waits for whoever looks at it
    return;
  }
  const Duration step = std::min(now - replay_->last, longest_step);
  replay_->last = now;
  const OnboardTime before = replay_->at;
  const auto ahead = Duration{static_cast<std::int64_t>(static_cast<double>(step.count()) * replay_->speed)};
  if (!replay_->ended && ahead > Duration{0}) {
    replay_->at = step_end({before + Duration{1}, std::min(before + ahead, replay_->end)});
    replay_->ended = replay_->at == replay_->end;
    tell_past({before + Duration{1}, replay_->at});
  }
  const bool playing = replay_->speed > 0.0 && before != replay_->at;
  if (playing && (replay_->ended || now - replay_->announced >= status_period)) announce_replay(now);
  show(replay_->model, replay_->at, now, true);
}

OnboardTime Client::step_end(const Span& span) const {
  const auto events =
      session_.archive().events({.span = span, .text = {}, .limit = most_events, .newest_first = false});
  return events.size() < most_events ? span.to : events.back().t;
}

void Client::tell_past(const Span& span) {
  Archive& archive = session_.archive();
  archive.packets(span, [&](const StoredPacket& packet) {
    if (const auto view = pus::TelemetryView::parse(packet.octets)) static_cast<void>(replay_->model.take(*view));
    return true;
  });
  const auto past = [this](json message, const char* type) {
    message["type"] = type;
    message["replay"] = true;
    send(message);
  };
  constexpr std::size_t no_limit = 1'000'000;
  const Archive::Filter all{.span = span, .text = {}, .limit = no_limit, .newest_first = false};
  for (const auto& event : archive.events(all)) past(event_json(event), "event");
  for (auto& command : archive.commands(all)) {
    command.stage = "sent";
    command.code.reset();
    command.reason.clear();
    past(command_json(command), "command");
  }
  for (const auto& [number, report] : archive.reports_in(span)) {
    auto command = archive.command(number);
    if (!command) continue;
    command->t = report.t;
    command->stage = report.stage;
    command->code = report.code;
    command->reason = report.reason;
    past(command_json(*command), "command");
  }
  for (const auto& fault : archive.faults(span))
    past({{"t", json_time(fault.t)}, {"device", fault.device}, {"line", fault.line}, {"answer", fault.answer}},
         "fault");
  for (const auto& gap : archive.gaps(span))
    if (gap.to >= span.from && gap.to <= span.to)
      past({{"from", json_time(gap.from)}, {"to", json_time(gap.to)}}, "gap");
}

}  // namespace hirosco::ground
