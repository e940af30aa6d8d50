// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/api.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;

class AnApi : public testing::PlayedStation {
 protected:
  [[nodiscard]] static HttpRequest request(const std::string& method, const std::string& target,
                                           const std::string& token = "right", const std::string& body = "{}") {
    HttpRequest made{method, target, {{"host", "127.0.0.1:8080"}}, body};
    if (!token.empty()) made.headers["authorization"] = "Bearer " + token;
    return made;
  }
  /// The status of the answer; 0: it has not come yet.
  unsigned ask(const HttpRequest& asked_for) {
    const std::size_t before = responses.size();
    api.handle(asked_for, [this](HttpResponse response) { responses.push_back(std::move(response)); });
    return responses.size() > before ? responses.back().status : 0;
  }
  unsigned ask_from(const char* host, const char* origin) {
    HttpRequest from = request("GET", "/api/status");
    from.headers["host"] = host;
    if (*origin != '\0') from.headers["origin"] = origin;
    return ask(from);
  }
  void tick(int times) {
    for (int i = 0; i < times; ++i) api.tick();
  }
  [[nodiscard]] std::vector<unsigned> statuses() const {
    std::vector<unsigned> all;
    for (const HttpResponse& response : responses) all.push_back(response.status);
    return all;
  }
  std::vector<HttpResponse> responses;
  Api api{session,
          {.token = "right", .observer_token = "looks", .page = ::testing::TempDir() + "no_page", .transitions = {}}};
  testing::PlayedPage page;
};

TEST_F(AnApi, AnswersWhoHasTheTokenAndNobodyElse) {
  EXPECT_EQ(ask(request("GET", "/api/status")), 200U);
  EXPECT_EQ(ask(request("GET", "/api/status?token=right", "")), 200U);
  EXPECT_EQ(ask(request("HEAD", "/api/status")), 200U);
  EXPECT_EQ(ask(request("GET", "/api/status", "")), 401U);
  EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 401U);
  EXPECT_EQ(ask(request("GET", "/api/status", "righ")), 401U);
  EXPECT_EQ(ask(request("GET", "/api/status?token=right", "wrong")), 401U) << "the header counts where there is one";
}

TEST_F(AnApi, LetsAnObserverReadAndNotCommand) {
  EXPECT_EQ(ask(request("GET", "/api/status", "looks")), 200U);
  EXPECT_EQ(ask(request("POST", "/api/commands", "looks")), 403U);
  Api without{session, {.token = "right", .observer_token = "", .page = {}, .transitions = {}}};
  without.handle(request("GET", "/api/status", ""), [](const HttpResponse& response) {
    EXPECT_EQ(response.status, 401U) << "where there are no observers no token is none of theirs";
  });
}

TEST_F(AnApi, AnswersOnlyWhoAsksThisStationFromItsOwnPage) {
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"}) {
    EXPECT_EQ(ask_from(host, ""), 200U) << host;
    EXPECT_EQ(ask_from(host, (std::string{"http://"} + host).c_str()), 200U) << host;
  }
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:8081", "evil.example:8080", "localhost:8080.evil.example"})
    EXPECT_EQ(ask_from(host, ""), 403U) << host;
  for (const char* origin :
       {"null", "https://127.0.0.1:8080", "http://evil.example", "http://127.0.0.1:8081", "http://127.0.0.1:8080/"})
    EXPECT_EQ(ask_from("127.0.0.1:8080", origin), 403U) << origin;
}

TEST_F(AnApi, SaysWhatIsNotThereAndWhatIsNotDone) {
  EXPECT_EQ(ask(request("GET", "/api/nothing")), 404U);
  EXPECT_EQ(ask(request("POST", "/api/status")), 404U);
  EXPECT_EQ(ask(request("DELETE", "/api/status")), 405U);
  EXPECT_EQ(ask(request("POST", "/index.html")), 405U);
  EXPECT_EQ(ask(request("GET", "/nothing.js", "")), 404U);
  EXPECT_EQ(ask(request("GET", "/", "")), 200U) << "the page itself needs no token";
  EXPECT_EQ(ask(request("GET", "/api/%zz")), 400U);
  EXPECT_EQ(ask(request("GET", "/ws?token=right", "")), 426U);
  EXPECT_EQ(ask(request("GET", "/api/events?limit=many")), 400U);
}

TEST_F(AnApi, TakesAnObjectInWhichNoKeyStandsTwice) {
  for (const char* body : {"", "[]", "1", "{", R"({"mode":"work","mode":"work"})"})
    EXPECT_EQ(ask(request("POST", "/api/modes/preview", "right", body)), 400U) << body;
  EXPECT_EQ(ask(request("POST", "/api/modes/preview", "right", R"({"mode":"work"})")), 503U) << "that is understood";
}

TEST_F(AnApi, RefusesCommandsOfAPageThatLooksAtThePast) {
  hears(testing::torque_high(catalogue, opening));
  api.opened(request("GET", "/ws?token=right&seat=a", ""), page);
  auto post = request("POST", "/api/authority", "right", R"({"action":"take","seat":"a"})");
  post.headers["x-client"] = page.last("hello")["client"].get<std::string>();
  EXPECT_EQ(ask(post), 200U);
  api.received(page, R"({"type":"replay","at":2145916900,"speed":0})");
  EXPECT_EQ(ask(post), 409U);
  EXPECT_EQ(ask(request("GET", "/api/status")), 200U);
}

TEST_F(AnApi, OpensASocketForWhoMayReadAndKnowsWhoMayCommand) {
  EXPECT_EQ(api.refuse_socket(request("GET", "/ws?token=right", "")), std::nullopt);
  EXPECT_EQ(api.refuse_socket(request("GET", "/ws?token=looks", "")), std::nullopt);
  EXPECT_EQ(api.refuse_socket(request("GET", "/ws?token=wrong", ""))->status, 401U);
  EXPECT_EQ(api.refuse_socket(request("GET", "/socket?token=right", ""))->status, 404U);
  auto foreign = request("GET", "/ws?token=right", "");
  foreign.headers["origin"] = "http://evil.example";
  EXPECT_EQ(api.refuse_socket(foreign)->status, 403U);
  testing::PlayedPage observer;
  api.opened(request("GET", "/ws?token=right&seat=a", ""), page);
  api.opened(request("GET", "/ws?token=looks&seat=b", ""), observer);
  EXPECT_EQ(page.last("hello")["operator"], true);
  EXPECT_EQ(observer.last("hello")["operator"], false);
  EXPECT_EQ(session.pages().present()["pages"][0]["seat"], "a");
  api.closed(observer);
  EXPECT_EQ(session.pages().count(), 1U);
}

TEST_F(AnApi, AnswersTheSixthWrongTokenInAMinuteASecondLaterOneAfterTheOther) {
  for (int i = 0; i < 5; ++i) EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 401U);
  EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 0U);
  EXPECT_EQ(ask(request("GET", "/ws?token=wrong", "")), 0U);
  EXPECT_EQ(ask(request("GET", "/api/status")), 200U) << "right ones never wait";
  responses.clear();
  tick(19);
  EXPECT_THAT(responses, IsEmpty());
  tick(1);
  EXPECT_THAT(statuses(), ElementsAre(401U));
  tick(19);
  EXPECT_THAT(responses, SizeIs(1));
  tick(1);
  EXPECT_THAT(statuses(), ElementsAre(401U, 401U));
}

TEST_F(AnApi, LetsNoMoreThanSomeOfThemWait) {
  for (int i = 0; i < 5 + 16; ++i) static_cast<void>(ask(request("GET", "/api/status", "wrong")));
  EXPECT_THAT(responses, SizeIs(5));
  EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 429U);
  responses.clear();
  tick(16 * 20);
  EXPECT_THAT(responses, SizeIs(16));
  EXPECT_THAT(statuses(), Each(401U));
}

TEST_F(AnApi, ForgetsWrongTokensAfterAMinuteWithoutOne) {
  for (int i = 0; i < 5; ++i) static_cast<void>(ask(request("GET", "/api/status", "wrong")));
  tick(60 * 20 - 1);
  EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 0U) << "the minute is not over, and begins anew";
  tick(60 * 20);
  EXPECT_EQ(ask(request("GET", "/api/status", "wrong")), 401U);
}

}  // namespace
}  // namespace hirosco::ground
