// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ground/api/application.hpp"
#include "ground/api/page_files.hpp"
#include "ground/api/session.hpp"
#include "ground/api/target.hpp"

/// ground/api/README.md as code: who may ask, what is asked, what is answered. No I/O but reading the page's files.
namespace hirosco::ground {

/// One edge of the ten states' table, which belongs to the generic subsystem.
struct Transition {
  descriptor::State from{};
  descriptor::State to{};
  bool failure{false};  ///< taken only when the state it leaves has failed
};

/// A line that a simulated device takes, for a button of the page.
struct FaultText {
  std::string line;
  std::string text;
};
/// By the names of the devices, which tell them themselves.
using FaultTexts = std::map<std::string, std::vector<FaultText>>;

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
  void received(const Peer& peer, const std::string& text) override { session_.received(peer, text); }
  void closed(const Peer& peer) override { session_.closed(peer); }
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
  void post(const HttpRequest& request, const Target& target, Role role,
            const std::function<void(HttpResponse)>& respond);
  [[nodiscard]] HttpResponse get(const Target& target);
  [[nodiscard]] HttpResponse history(const Target& target);
  [[nodiscard]] HttpResponse csv(const Target& target);
  [[nodiscard]] nlohmann::json timeline(const Target& target);
  [[nodiscard]] nlohmann::json log(const Target& target);
  [[nodiscard]] Span span_of(const Target& target, double last_s) const;
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

/// GET /api/mission.
[[nodiscard]] nlohmann::json mission_json(const Catalogue& catalogue, std::span<const Transition> transitions,
                                          const FaultTexts& faults);

/// Samples of one column in a span, oldest first. Calls `take(t, value)`. False: there were `most` or more.
[[nodiscard]] bool samples(Session& session, std::size_t column, const Span& span, std::size_t most,
                           const std::function<void(OnboardTime, double)>& take);

}  // namespace hirosco::ground
