// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/api/application.hpp"
#include "ground/api/mission_json.hpp"
#include "ground/api/page_files.hpp"
#include "ground/api/session.hpp"
#include "ground/api/target.hpp"

/// Who may ask; what is asked and answered stands in routes.hpp. No I/O but reading the page's files.
namespace hirosco::ground {

class Api final : public Application {
 public:
  struct Options {
    std::string token;
    std::string observer_token;  ///< empty = no observers
    std::uint16_t port{8080};
    std::filesystem::path page;  ///< folder of the page's files
    std::filesystem::path mission_page{};  ///< of those that the mission shows of itself
    std::vector<Transition> transitions;
    FaultTexts faults{};
  };
  Api(Session& session, Options options)
      : session_{session}, options_{std::move(options)}, page_{options_.page, options_.mission_page} {}

  void handle(const HttpRequest& request, std::function<void(HttpResponse)> respond) override;
  [[nodiscard]] std::optional<HttpResponse> refuse_socket(const HttpRequest& request) override;
  void opened(const HttpRequest& request, Peer& peer) override;
  void received(const Peer& peer, const std::string& text) override { session_.pages().received(peer, text); }
  void closed(const Peer& peer) override { session_.pages().closed(peer); }
  void link_up() override { session_.link_up(); }
  void link_down() override { session_.link_down(); }
  void not_sent(Octets packet) override { session_.not_sent(packet); }
  [[nodiscard]] bool link_received(Octets octets) override { return session_.receive(octets); }
  void tick() override;

 private:
  enum class Role { Nobody, Observer, Operator };
  [[nodiscard]] Role role_of(const HttpRequest& request, const Target& target) const;
  [[nodiscard]] bool from_here(const HttpRequest& request) const;
  /// 401; from the sixth wrong token in a minute on each is answered a second after the one before. What keeps guessers out is the length of
  /// the token; this keeps them from taking the processor, and shows. Right ones never wait.
  void refuse_token(std::function<void(HttpResponse)> respond);
  [[nodiscard]] HttpResponse page_file(const HttpRequest& request, const std::string& path) const;

  struct Late {
    std::uint64_t tick{0};
    std::function<void()> answer;
  };
  static constexpr std::uint64_t ticks_of_delay = 20, ticks_to_forget = 60 * ticks_of_delay;

  Session& session_;
  Options options_;
  PageFiles page_;
  std::uint64_t tick_{0};
  std::uint64_t calm_at_{0};  ///< wrong tokens before it count
  unsigned wrong_tokens_{0};
  std::deque<Late> late_;
};

}  // namespace hirosco::ground
