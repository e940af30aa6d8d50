// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/open_pages.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "ground/api/client.hpp"
#include "ground/api/session.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

}  // namespace

OpenPages::OpenPages(Session& session) : session_{session} {}
OpenPages::~OpenPages() = default;

std::string OpenPages::opened(Peer& peer, bool is_operator, const std::string& seat) {
  std::string id = "c" + std::to_string(next_client_++);
  // An observer's page cannot hold what it cannot take.
  clients_.push_back(std::make_unique<Client>(
      session_, peer,
      Client::Who{
          .id = id, .seat = is_operator ? seat.substr(0, Authority::longest_seat) : "", .is_operator = is_operator}));
  changed_ = true;
  return id;
}

void OpenPages::received(const Peer& peer, const std::string& text) {
  for (const auto& client : clients_)
    if (&client->peer() == &peer) {
      client->received(text);
      changed_ = true;
      return;
    }
}

void OpenPages::closed(const Peer& peer) {
  std::erase_if(clients_, [&](const auto& client) { return &client->peer() == &peer; });
  changed_ = true;
}

void OpenPages::tell(const json& message) {
  for (const auto& client : clients_) client->tell(message);
}

void OpenPages::tell_who_is_here() {
  if (!std::exchange(changed_, false)) return;
  json message = present();
  message["type"] = "present";
  tell(message);
}

void OpenPages::tick(TimePoint now) {
  for (const auto& client : clients_) client->tick(now);
}

json OpenPages::present() const {
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

std::set<std::string> OpenPages::seats() const {
  std::set<std::string> seats;
  for (const auto& client : clients_) seats.insert(client->seat());
  return seats;
}

bool OpenPages::in_replay(const std::string& client) const {
  return std::ranges::any_of(clients_, [&](const auto& c) { return c->id() == client && c->in_replay(); });
}

}  // namespace hirosco::ground
