// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/client.hpp"

#include "ground/model/json.hpp"
#include "ground/model/views.hpp"
#include "hirosco/utilities/version.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration status_period = 1s;
constexpr std::uint16_t try_again_later = 1013;

}  // namespace

Client::Client(Session& session, Peer& peer, Who who) : session_{session}, peer_{peer}, who_{std::move(who)} {
  const auto extent = session_.archive().extent();
  send({{"type", "hello"},
        {"t", json_time(session_.now())},
        {"version", std::string{version}},
        {"client", who_.id},
        {"operator", who_.is_operator},
        {"authority", session_.authority()},
        {"flight", session_.flights().present()},
        {"archive_from", extent ? json(json_time(extent->from)) : json(nullptr)}});
  tick(session_.clock().now());
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
  if (!replay_) send(message);
}

void Client::tick(TimePoint now) {
  if (closing_) return;
  if (replay_) return play(now);
  if (peer_.pending_octets() > busy_octets) return;
  if (session_.connected() != connected_told_) status_due_ = true;
  connected_told_ = session_.connected();
  show(session_.model(), session_.now(), now, false);
}

void Client::show(const Model& model, OnboardTime at, TimePoint now, bool replay) {
  if (status_due_ || model.status_revision() != status_told_ || now - status_at_ >= status_period) {
    json status = status_json(session_.catalogue(), model, at);
    status["type"] = "status";
    status["link"] = session_.link_json();
    status["commandable"] = session_.connected() && !replay;
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
    return tick(session_.clock().now());
  }
  if (type == "name") {
    who_.name = text_of(message, "name").substr(0, Authority::longest_name);
    return;
  }
  send({{"type", "error"},
        {"error", "understood are {type:\"replay\", at, speed}, {type:\"live\"} and {type:\"name\", name}"}});
}

void Client::begin_replay(double at, double speed) {
  const auto extent = session_.archive().extent();
  if (!extent) return send({{"type", "error"}, {"error", "the archive is empty"}});
  const TimePoint now = session_.clock().now();
  replay_.emplace(session_.catalogue(), session_.archive(), *extent, onboard_time(at), speed, now);
  values_told_ = 0;
  status_due_ = true;
  announce_replay(now);
  play(now);
}

void Client::announce_replay(TimePoint now) {
  send({{"type", "replay"},
        {"at", json_time(replay_->at())},
        {"speed", replay_->speed()},
        {"state", replay_->state()},
        {"replay", true}});
  replay_announced_ = now;
}

void Client::play(TimePoint now) {
  if (peer_.pending_octets() > busy_octets) return replay_->wait(now);
  const OnboardTime before = replay_->at();
  replay_->play(now, [this](json message) {
    message["replay"] = true;
    send(message);
  });
  const bool playing = replay_->speed() > 0.0 && before != replay_->at();
  if (playing && (replay_->ended() || now - replay_announced_ >= status_period)) announce_replay(now);
  show(replay_->model(), replay_->at(), now, true);
}

}  // namespace hirosco::ground
