// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "ground/api/api.hpp"
#include "ground/testing/played_station.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What reaches a ground station from whatever text comes: requests of HTTP as its server hands them on, messages of a page, octets of the
/// spacecraft's stream. Each request is answered once, what is said is JSON, and what is sent is a telecommand for somebody of the mission.
/// In an input they stand one after the other, an empty line between them: "GET /api/status", "POST /api/commands" with its body in the next
/// line, "WS {...}", "TM ...".
namespace {

using namespace hirosco;
using namespace hirosco::ground;
using fuzz::expect;
using Json = nlohmann::json;

class Station final : public ground::testing::PlayedStation {
 public:
  Station() {
    session.link_up();
    hears(ground::testing::overview(catalogue, {}, ground::testing::opening));
    runs_at(ground::testing::opening, 7);
    hears(ground::testing::torque_high(catalogue, ground::testing::opening));
    api.opened(from_here("GET", "/ws"), page);
    pass(batch);
  }
  ~Station() override { api.closed(page); }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  void take(std::string_view message) {
    const std::string_view line = message.substr(0, message.find('\n'));
    const std::string_view rest = message.substr(std::min(line.size() + 1, message.size()));
    const std::string_view kind = line.substr(0, line.find(' '));
    const std::string_view behind = message.substr(std::min(kind.size() + 1, message.size()));
    if (kind == "WS") api.received(page, std::string{behind});
    else if (kind == "TM") static_cast<void>(api.link_received(std::as_bytes(std::span{behind})));
    else
      ask(from_here(std::string{kind}, std::string{line.substr(std::min(kind.size() + 1, line.size()))},
                    std::string{rest}));
    check_sent();
  }

 private:
  void TestBody() override {}

  [[nodiscard]] static HttpRequest from_here(const std::string& method, const std::string& target,
                                             const std::string& body = "{}") {
    return {method, target, {{"host", "127.0.0.1:8080"}, {"authorization", "Bearer right"}}, body};
  }

  void ask(const HttpRequest& request) {
    int answers = 0;
    api.handle(request, [&answers](const HttpResponse& response) {
      ++answers;
      expect(response.status >= 200 && response.status < 600, "an answer has a status");
      const bool json = response.type.starts_with("application/json");
      if (json) expect(!Json::parse(response.body, nullptr, false).is_discarded(), "an answer is JSON");
      if (json && response.status < 300) fuzz::taken();
    });
    for (auto& each : std::exchange(asked, {}))
      each.answer(each.line.size() % 2 == 0 ? std::optional{"ok"} : std::nullopt);
    if (answers == 0) pass(3s);
    expect(answers == 1, "a request is answered once");
  }

  void check_sent() {
    for (const auto& octets : std::exchange(sent, {})) {
      const auto telecommand = pus::TelecommandView::parse(octets);
      expect(telecommand && catalogue.find(telecommand->apid()) != nullptr,
             "what is sent is a telecommand for somebody of the mission");
    }
  }

  Api api{session, {.token = "right", .observer_token = "", .page = "no_page", .transitions = {}}};
  ground::testing::PlayedPage page;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Nobody runs tests here: what the station's own checks find ends the process, too.
  GTEST_FLAG_SET(throw_on_failure, true);
  constexpr int most_messages = 12;
  std::string_view rest = fuzz::text_of(data, size);
  Station station;
  for (int count = 0; !rest.empty() && count < most_messages; ++count) {
    const std::string_view message = rest.substr(0, rest.find("\n\n"));
    rest.remove_prefix(std::min(message.size() + 2, rest.size()));
    station.take(message);
  }
  return 0;
}
