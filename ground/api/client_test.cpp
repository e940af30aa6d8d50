// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;

class AClient : public testing::PlayedStation {
 protected:
  void opens() { session.pages().opened(page, true, "a"); }
  void says(const std::string& text) { session.pages().received(page, text); }
  /// Without who is here, which changes at each of a page's words.
  [[nodiscard]] std::vector<std::string> told() const {
    auto types = page.types();
    std::erase(types, "present");
    return types;
  }
  testing::PlayedPage page;
};

TEST_F(AClient, IsToldEverythingAtOnce) {
  hears(testing::overview(catalogue, {}, opening));
  runs_at(opening + 1s, 2.5);
  opens();
  EXPECT_THAT(told(), ElementsAre("hello", "status", "values"));
  const auto hello = page.last("hello");
  EXPECT_EQ(hello["client"], "c1");
  EXPECT_EQ(hello["operator"], true);
  EXPECT_EQ(hello["archive_from"], 2'145'916'900);
  EXPECT_EQ(hello["flight"]["id"], 1);
  EXPECT_EQ(page.last("status")["mode"], "work");
  EXPECT_FALSE(page.last("status").contains("values"));
  EXPECT_EQ(page.last("values")["set"]["DRILL.SPEED"], (nlohmann::json{2.5, 2'145'916'901}));
  EXPECT_EQ(page.last("values")["set"]["SUPERVISOR.MODE"][0], 2) << "the first holds all";
  EXPECT_FALSE(page.last("values").contains("replay"));
}

TEST_F(AClient, OfAnEmptyArchiveKnowsNoBeginning) {
  opens();
  EXPECT_THAT(told(), ElementsAre("hello", "status"));
  EXPECT_TRUE(page.last("hello")["archive_from"].is_null());
}

TEST_F(AClient, IsToldInEachBatchWhatHasChangedAndNothingElse) {
  hears(testing::overview(catalogue, {}, opening));
  opens();
  calm({&page});
  pass(batch);
  EXPECT_THAT(told(), IsEmpty());
  runs_at(opening + 1s, 1);
  runs_at(opening + 2s, 2);
  pass(batch);
  EXPECT_THAT(told(), ElementsAre("values")) << "one for both";
  EXPECT_EQ(page.last("values")["set"]["DRILL.SPEED"][0], 2);
  EXPECT_FALSE(page.last("values")["set"].contains("SUPERVISOR.MODE"));
}

TEST_F(AClient, IsToldHowItIsWhenThatChangesAndOnceASecond) {
  opens();
  calm({&page});
  hears(testing::overview(catalogue, {.mode = 1}, opening));
  pass(batch);
  EXPECT_EQ(page.last("status")["mode"], "dark");
  session.link_up();
  pass(batch);
  EXPECT_EQ(page.last("status")["commandable"], true);
  calm({&page});
  pass(2s);
  EXPECT_EQ(page.count("status"), 2U);
}

TEST_F(AClient, WhoseNetworkIsBusyLosesHousekeepingButNoEvent) {
  opens();
  calm({&page});
  page.pending = Client::busy_octets + 1;
  runs_at(opening, 1);
  hears(testing::torque_high(catalogue, opening));
  runs_at(opening + 1s, 2);
  pass(batch);
  EXPECT_THAT(told(), ElementsAre("event", "alarm"));
  page.pending = Client::busy_octets;
  pass(batch);
  EXPECT_EQ(page.last("values")["set"]["DRILL.SPEED"][0], 2) << "the latest";
  EXPECT_EQ(page.count("values"), 1U);
}

TEST_F(AClient, WhoTakesTooLittleIsDisconnectedOnceAndToldNothingMore) {
  opens();
  calm({&page});
  page.pending = Client::most_pending_octets;
  hears(testing::torque_high(catalogue, opening));
  EXPECT_THAT(page.closed_with, IsEmpty());
  page.messages.clear();
  page.pending = Client::most_pending_octets + 1;
  for (int i = 1; i < 4; ++i) hears(testing::torque_high(catalogue, opening + i * 1s));
  page.pending = 0;
  pass(2s);
  EXPECT_THAT(page.closed_with, ElementsAre(1013));
  EXPECT_THAT(page.messages, IsEmpty());
}

TEST_F(AClient, LooksAtThePastAndIsToldNothingOfThePresent) {
  runs_at(opening, 1);
  hears(testing::torque_high(catalogue, opening + 1s));
  runs_at(opening + 10s, 2);
  opens();
  calm({&page});
  says(R"({"type":"replay","at":2145916900.5,"speed":10})");
  EXPECT_THAT(told(), ElementsAre("replay", "status", "values"));
  EXPECT_EQ(page.last("replay")["state"], "playing");
  EXPECT_EQ(page.last("values")["set"]["DRILL.SPEED"][0], 1);
  EXPECT_EQ(page.last("status")["commandable"], false);
  EXPECT_EQ(page.last("status")["t"], 2'145'916'900.5);
  hears(testing::torque_high(catalogue, opening + 20s));
  EXPECT_EQ(page.count("event"), 0U) << "that is now";
  pass(2 * batch);
  EXPECT_EQ(page.count("event"), 1U);
  EXPECT_EQ(page.last("event")["t"], 2'145'916'901);
  EXPECT_EQ(page.count("alarm"), 0U);
  for (const auto& message : page.messages) {
    if (message["type"] != "present") {
      EXPECT_TRUE(message.value("replay", false)) << message.dump();
    }
  }
}

TEST_F(AClient, IsToldWhereItIsOnceASecondAndWhenThePastIsOver) {
  runs_at(opening, 1);
  runs_at(opening + 4s, 2);
  opens();
  says(R"({"type":"replay","at":2145916900})");
  EXPECT_EQ(page.last("replay")["speed"], 1);
  page.messages.clear();
  pass(2s);
  EXPECT_EQ(page.count("replay"), 2U);
  EXPECT_EQ(page.last("replay")["at"], 2'145'916'902);
  pass(2s);
  EXPECT_EQ(page.last("replay")["state"], "ended");
  const auto count = page.count("replay");
  pass(2s);
  EXPECT_EQ(page.count("replay"), count);
}

TEST_F(AClient, WhoReplaysAndTakesNothingFindsThePastWhereItWas) {
  runs_at(opening, 1);
  runs_at(opening + 60s, 2);
  opens();
  says(R"({"type":"replay","at":2145916900})");
  page.pending = Client::busy_octets + 1;
  pass(10s);
  page.pending = 0;
  page.messages.clear();
  pass(batch);
  EXPECT_NEAR(page.last("replay")["at"].get<double>(), 2'145'916'900.05, 1e-3);
}

TEST_F(AClient, ComesBackToThePresentWithAllOfIt) {
  runs_at(opening, 1);
  opens();
  says(R"({"type":"replay","at":2145916900,"speed":0})");
  EXPECT_EQ(page.last("replay")["state"], "paused");
  page.messages.clear();
  says(R"({"type":"live"})");
  EXPECT_THAT(told(), ElementsAre("replay", "status", "values"));
  EXPECT_EQ(page.last("replay")["state"], "live");
  EXPECT_FALSE(page.last("status").contains("replay"));
}

TEST_F(AClient, SaysWhatItDoesNotUnderstand) {
  opens();
  calm({&page});
  for (const char* text :
       {"", "[]", "{", R"({"type":"replay"})", R"({"type":"replay","at":"1"})", R"({"type":"live","type":"live"})"})
    says(text);
  EXPECT_EQ(page.count("error"), 6U);
  EXPECT_THAT(told(), SizeIs(6));
  says(R"({"type":"replay","at":1})");
  EXPECT_EQ(page.last("error")["error"], "the archive is empty");
}

TEST_F(AClient, IsCalledAsItsPageSaysAsFarAsThereIsRoom) {
  opens();
  says(R"({"type":"name","name":")" + std::string(40, 'x') + R"("})");
  EXPECT_EQ(session.pages().present()["pages"][0]["name"], std::string(Authority::longest_name, 'x'));
  says(R"({"type":"name"})");
  EXPECT_EQ(session.pages().present()["pages"][0]["name"], "");
}

}  // namespace
}  // namespace hirosco::ground
