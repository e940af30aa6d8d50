// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/routes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// What is asked and answered behind who may ask.
class ARoute : public testing::PlayedStation {
 protected:
  /// The answer, if it has come.
  std::optional<HttpResponse> asks(const std::string& address, Route::Method method, const nlohmann::json& body) {
    const auto target = read_target(address);
    const Route* route = target ? find_route(target->path, method) : nullptr;
    if (route == nullptr) {
      ADD_FAILURE() << "no route " << address;
      return std::nullopt;
    }
    responses.clear();
    route->answer({session, *target, body, edges, faults},
                  [this](HttpResponse response) { responses.push_back(std::move(response)); });
    return responses.empty() ? std::nullopt : std::optional{responses.front()};
  }
  nlohmann::json get(const std::string& address) {
    const auto response = asks(address, Route::Method::Get, nlohmann::json::object());
    return response ? nlohmann::json::parse(response->body) : nlohmann::json{};
  }
  unsigned post(const std::string& address, const nlohmann::json& body) {
    const auto response = asks(address, Route::Method::Post, body);
    return response ? response->status : 0;
  }
  void says_each_second(int seconds) {
    for (int i = 0; i < seconds; ++i) hears(testing::torque_high(catalogue, opening + i * 1s));
  }
  std::vector<Transition> edges{{descriptor::State::Offline, descriptor::State::SoftwareInit, false}};
  FaultTexts faults;
  std::vector<HttpResponse> responses;
};

TEST_F(ARoute, IsFoundByItsPathAndMethod) {
  EXPECT_NE(find_route("/api/status", Route::Method::Get), nullptr);
  EXPECT_EQ(find_route("/api/status", Route::Method::Post), nullptr);
  EXPECT_EQ(find_route("/api/status/", Route::Method::Get), nullptr);
  EXPECT_NE(find_route("/api/alarms", Route::Method::Get), find_route("/api/alarms", Route::Method::Post));
}

TEST_F(ARoute, OfHistoryTellsTheLastMinuteUnlessASpanIsNamed) {
  for (int i = 0; i <= 100; ++i) runs_at(opening + i * 1s, i);
  const std::string history = "/api/history?parameter=DRILL.SPEED";
  EXPECT_EQ(get(history)["v"].front(), 40);
  EXPECT_EQ(get(history)["v"].back(), 100);
  EXPECT_EQ(get(history + "&last=10")["v"].front(), 90);
  EXPECT_EQ(get(history + "&to=2145916910&last=5")["v"], (nlohmann::json{5, 6, 7, 8, 9, 10}));
  EXPECT_EQ(get(history + "&from=2145916902&to=2145916903&last=50")["v"], (nlohmann::json{2, 3})) << "`from` counts";
  EXPECT_EQ(get(history + "&from=0&points=1")["t"].size(), 10U) << "ten points are the fewest";
  EXPECT_EQ(asks("/api/history?parameter=NOTHING", Route::Method::Get, {})->status, 404U);
}

TEST_F(ARoute, OfExportsIsAFileOfTheParametersInTheirOrder) {
  runs_at(opening, 1.5);
  const auto response =
      asks("/api/export.csv?parameter=DRILL.TOOL&parameter=DRILL.SPEED", Route::Method::Get, nlohmann::json::object());
  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 200U);
  EXPECT_THAT(response->type, StartsWith("text/csv"));
  EXPECT_THAT(response->body, StartsWith("t,utc,DRILL.TOOL,DRILL.SPEED\n2145916900.000000,"));
  EXPECT_EQ(response->headers.front().first, "Content-Disposition");
  EXPECT_EQ(asks("/api/export.csv", Route::Method::Get, {})->status, 400U);
}

TEST_F(ARoute, OfEventsTakesSpanSeverityTextAndLimit) {
  says_each_second(5);
  hears(testing::state_changed(catalogue, "LAMP", descriptor::State::Operational, opening + 5s));
  EXPECT_THAT(get("/api/events")["events"], SizeIs(6));
  EXPECT_THAT(get("/api/events?severity=medium")["events"], SizeIs(5));
  EXPECT_THAT(get("/api/events?severity=high")["events"], IsEmpty());
  EXPECT_THAT(get("/api/events?text=lamp")["events"], SizeIs(1));
  EXPECT_THAT(get("/api/events?from=2145916901&to=2145916902")["events"], SizeIs(2));
  const auto newest = get("/api/events?limit=1")["events"];
  ASSERT_THAT(newest, SizeIs(1));
  EXPECT_EQ(newest[0]["subsystem"], "LAMP");
  EXPECT_THAT(get("/api/events?limit=-3")["events"], IsEmpty());
}

TEST_F(ARoute, OfTheLogGoesOnWhereItEndedAndHasHousekeepingOnRequest) {
  says_each_second(3);
  runs_at(opening + 3s, 1);
  EXPECT_THAT(get("/api/log")["packets"], SizeIs(3));
  EXPECT_THAT(get("/api/log?housekeeping=1")["packets"], SizeIs(4));
  const auto first = get("/api/log?limit=2&text=torque&to=2145916902");
  ASSERT_THAT(first["packets"], SizeIs(2));
  const auto rest = get("/api/log?before=" + std::to_string(first["before"].get<std::int64_t>()));
  ASSERT_THAT(rest["packets"], SizeIs(1));
  EXPECT_EQ(rest["packets"][0]["t"], 2'145'916'900);
  EXPECT_THAT(get("/api/log?limit=0")["packets"], SizeIs(1)) << "one line is the fewest";
}

TEST_F(ARoute, OfWhyLooksNoFurtherThanItIsAsked) {
  says_each_second(1);
  EXPECT_EQ(get("/api/why")["severity"], "medium");
  EXPECT_THAT(get("/api/why?to=2145916899")["causes"], IsEmpty());
}

TEST_F(ARoute, OfATimelineBeginsTenMinutesAgo) {
  says_each_second(1);
  clock.advance(600s);
  EXPECT_THAT(get("/api/timeline")["events"], SizeIs(1));
  clock.advance(1s);
  EXPECT_THAT(get("/api/timeline")["events"], IsEmpty());
  EXPECT_THAT(get("/api/timeline?last=700")["events"], SizeIs(1));
}

TEST_F(ARoute, OfMarksHasTheNewestFirst) {
  ASSERT_EQ(post("/api/authority", {{"action", "take"}, {"seat", "a"}, {"sender", "anna"}}), 200U);
  ASSERT_EQ(post("/api/stacks", {{"name", "home"}, {"text", "hirosco tc DRILL WIPE"}}), 200U);
  const auto marks = get("/api/marks")["marks"];
  ASSERT_THAT(marks, SizeIs(2));
  EXPECT_EQ(marks[0]["kind"], "stack");
  EXPECT_EQ(marks[1]["kind"], "authority");
  EXPECT_THAT(get("/api/marks?limit=1")["marks"], SizeIs(1));
}

TEST_F(ARoute, AnswersWithTheStatusOfWhatBecameOfIt) {
  EXPECT_EQ(post("/api/commands", bore()), 503U);
  session.link_up();
  EXPECT_EQ(post("/api/commands", bore()), 202U);
  EXPECT_EQ(post("/api/commands", {{"subsystem", "SAW"}}), 400U);
  EXPECT_EQ(post("/api/alarms", {{"subsystem", "DRILL"}, {"event", "X"}, {"action", "acknowledge"}}), 404U);
  EXPECT_EQ(post("/api/faults", {{"device", "saw"}, {"line", "unplug"}}), 404U);
  EXPECT_EQ(post("/api/flights", {{"flight", 1}, {"name", "x"}}), 404U);
}

TEST_F(ARoute, AnswersLaterWhereSomebodyElseIsAsked) {
  session.link_up();
  EXPECT_EQ(post("/api/faults", {{"device", "spindle"}, {"line", "unplug"}}), 0U);
  asked.at(0).answer("ok");
  ASSERT_THAT(responses, SizeIs(1));
  EXPECT_EQ(responses[0].body, R"({"answer":"ok"})");
  EXPECT_EQ(post("/api/commands/preview", bore()), 0U);
  pass(3s);
  ASSERT_THAT(responses, SizeIs(1));
  EXPECT_EQ(responses[0].status, 200U);
  EXPECT_TRUE(nlohmann::json::parse(responses[0].body)["permitted"].is_null());
  EXPECT_EQ(post("/api/modes/preview", {{"mode", "work"}}), 0U);
  pass(3s);
  ASSERT_THAT(responses, SizeIs(1));
  EXPECT_EQ(responses[0].status, 503U);
}

TEST_F(ARoute, TellsWhatTheStationKnows) {
  hears(testing::overview(catalogue, {}, opening));
  says_each_second(1);
  session.link_up();
  ASSERT_EQ(post("/api/commands", bore("a")), 202U);
  EXPECT_EQ(get("/api/mission")["transitions"][0]["to"], "SoftwareInit");
  EXPECT_EQ(get("/api/status")["mode"], "work");
  EXPECT_EQ(get("/api/commands")["commands"][0]["function"], "BORE");
  EXPECT_THAT(get("/api/commands?text=wipe")["commands"], IsEmpty());
  EXPECT_EQ(get("/api/alarms")["alarms"][0]["name"], "TORQUE_HIGH");
  EXPECT_EQ(get("/api/authority")["holder"]["seat"], "a");
  EXPECT_EQ(get("/api/present")["operators"], 0);
  EXPECT_EQ(get("/api/flights")["flights"][0]["id"], 1);
  EXPECT_EQ(get("/api/stacks")["stacks"], nlohmann::json::array());
  EXPECT_TRUE(get("/api/openapi.json").contains("paths"));
}

}  // namespace
}  // namespace hirosco::ground
