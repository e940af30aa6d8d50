// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ground/api/responses.hpp"
#include "ground/api/routes.hpp"
#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// In a time that does not tell how much of it was right.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view secret) {
  if (secret.empty() || given.size() != secret.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(secret[i]);
  return difference == 0;
}

[[nodiscard]] std::string header(const HttpRequest& request, const char* name) {
  const auto found = request.headers.find(name);
  return found != request.headers.end() ? found->second : std::string{};
}

}  // namespace

// --- who may ---------------------------------------------------------------------------------------------------------

bool Api::from_here(const HttpRequest& request) const {
  const std::array<std::string, 3> hosts{fmt::format("127.0.0.1:{}", options_.port),
                                         fmt::format("localhost:{}", options_.port),
                                         fmt::format("[::1]:{}", options_.port)};
  const auto ours = [&](const std::string& host) { return std::ranges::find(hosts, host) != hosts.end(); };
  if (!ours(header(request, "host"))) return false;
  const std::string origin = header(request, "origin");
  constexpr std::string_view scheme = "http://";
  return origin.empty() || (origin.starts_with(scheme) && ours(origin.substr(scheme.size())));
}

Api::Role Api::role_of(const HttpRequest& request, const Target& target) const {
  constexpr std::string_view scheme = "Bearer ";
  const std::string authorization = header(request, "authorization");
  const std::string given =
      authorization.starts_with(scheme) ? authorization.substr(scheme.size()) : target.text("token").value_or("");
  if (same_secret(given, options_.token)) return Role::Operator;
  return same_secret(given, options_.observer_token) ? Role::Observer : Role::Nobody;
}

void Api::handle(const HttpRequest& request, std::function<void(HttpResponse)> respond) {
  const auto target = read_target(request.target);
  if (!target) return respond(error(400, "the address is not understood"));
  if (!from_here(request)) return respond(error(403, "Host or Origin is not this station"));
  const bool reading = request.method == "GET" || request.method == "HEAD";
  if (target->path == "/ws") {
    const auto refusal = refuse_socket(request);
    if (refusal && refusal->status == 401) return refuse_token(std::move(respond));
    return respond(refusal ? *refusal : error(426, "a WebSocket is at /ws"));
  }
  if (!target->path.starts_with("/api/")) {
    if (!reading) return respond(error(405, "only GET"));
    return respond(page_file(request, target->path));
  }
  const Role role = role_of(request, *target);
  if (role == Role::Nobody) return refuse_token(std::move(respond));
  if (!reading && request.method != "POST") return respond(error(405, "only GET and POST"));
  if (!reading && role != Role::Operator) return respond(error(403, "observers do not command"));
  const Route* route = find_route(target->path, reading ? Route::Method::Get : Route::Method::Post);
  if (route == nullptr) return respond(error(404, reading ? "nothing is there" : "nothing takes POSTs there"));
  json body = json::object();
  if (!reading) {
    if (session_.pages().in_replay(header(request, "x-client")))
      return respond(error(409, "this page replays the past"));
    body = parsed_request(request.body);
    if (!body.is_object()) return respond(error(400, "a JSON object is wanted, with each key once"));
  }
  if (const std::string wrong = senseless(*route, *target); !wrong.empty()) return respond(error(400, wrong));
  route->answer({session_, *target, body, options_.transitions, options_.faults}, respond);
}

void Api::refuse_token(std::function<void(HttpResponse)> respond) {
  constexpr unsigned free_tries = 5;
  constexpr std::size_t most_waiting = 16;
  const HttpResponse refusal = error(401, "the token is missing or wrong");
  calm_at_ = tick_ + ticks_to_forget;
  if (++wrong_tokens_ <= free_tries) return respond(refusal);
  // One after the other, whoever asks. More of them would take the connections that others need.
  if (late_.size() >= most_waiting) return respond(error(429, "too many wrong tokens"));
  const std::uint64_t after = late_.empty() ? tick_ : late_.back().tick;
  late_.push_back({after + ticks_of_delay, [respond = std::move(respond), refusal] { respond(refusal); }});
}

void Api::tick() {
  ++tick_;
  if (tick_ >= calm_at_) wrong_tokens_ = 0;
  while (!late_.empty() && late_.front().tick <= tick_) {
    const auto answer = std::move(late_.front().answer);
    late_.pop_front();
    answer();
  }
  session_.tick();
}

std::optional<HttpResponse> Api::refuse_socket(const HttpRequest& request) {
  const auto target = read_target(request.target);
  if (!target || target->path != "/ws") return error(404, "WebSockets are at /ws");
  if (!from_here(request)) return error(403, "Host or Origin is not this station");
  if (role_of(request, *target) == Role::Nobody) return error(401, "the token is missing or wrong");
  return std::nullopt;
}

void Api::opened(const HttpRequest& request, Peer& peer) {
  const auto target = read_target(request.target);
  static_cast<void>(session_.pages().opened(peer, target && role_of(request, *target) == Role::Operator,
                                            target ? target->text("seat").value_or("") : std::string{}));
}

// --- the page --------------------------------------------------------------------------------------------------------

HttpResponse Api::page_file(const HttpRequest& request, const std::string& path) const {
  auto file =
      page_.file(path, {.accepts = header(request, "accept-encoding"), .has = header(request, "if-none-match")});
  return file ? with_headers(std::move(*file)) : error(404, "nothing is there");
}

}  // namespace hirosco::ground
