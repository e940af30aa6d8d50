// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/alarms.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr OnboardTime noon{std::chrono::seconds{2'145'916'900}};

[[nodiscard]] StoredEvent event(OnboardTime t, int severity = 4, std::uint16_t id = 7) {
  return {.t = t,
          .apid = 11,
          .subsystem = "CAMERA",
          .id = id,
          .name = id == 7 ? "LOST" : "OTHER",
          .severity = severity,
          .text = "",
          .values = "{}"};
}
[[nodiscard]] json request(const char* action) {
  return {{"subsystem", "CAMERA"}, {"event", "LOST"}, {"action", action}, {"note", "cable"}};
}

class AnOperator : public ::testing::Test {
 protected:
  void happens(const StoredEvent& one) {
    archive->add(one);
    alarms.hear(one);
  }
  [[nodiscard]] static json first_of(const Alarms& list) {
    const json found = list.list()["alarms"];
    return found.empty() ? json{} : found[0];
  }
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  Alarms alarms{*archive, noon};
};

TEST_F(AnOperator, IsCalledByEventsOfMediumAndHighSeverityAlone) {
  EXPECT_FALSE(alarms.hear(event(noon, 1)));
  EXPECT_FALSE(alarms.hear(event(noon, 2)));
  EXPECT_TRUE(alarms.hear(event(noon, 3)));
  EXPECT_EQ(alarms.list()["alarms"].size(), 1U);
}

TEST_F(AnOperator, AcknowledgesWithNameAndNoteAndIsCalledAgainWhenItHappensAgain) {
  happens(event(noon + 1s));
  happens(event(noon + 2s));
  EXPECT_EQ(first_of(alarms)["fresh"], 2);
  EXPECT_EQ(first_of(alarms)["calls"], true);
  const auto done = alarms.act(request("acknowledge"), "anna", noon + 3s);
  ASSERT_TRUE(done);
  EXPECT_EQ((*done)["calls"], false);
  EXPECT_EQ((*done)["acknowledged"]["who"], "anna");
  EXPECT_EQ((*done)["acknowledged"]["note"], "cable");
  happens(event(noon + 4s));
  EXPECT_EQ(first_of(alarms)["fresh"], 1);
  EXPECT_EQ(first_of(alarms)["count"], 3);
  EXPECT_EQ(first_of(alarms)["calls"], true);
}

TEST_F(AnOperator, IsCalledByWhatIsHeardLateAndSeesTheNewestStill) {
  happens(event(noon + 10s));
  ASSERT_TRUE(alarms.act(request("acknowledge"), "anna", noon + 11s));
  happens(event(noon + 1s));  // while there was no link
  const json alarm = first_of(alarms);
  EXPECT_EQ(alarm["calls"], true);
  EXPECT_EQ(alarm["count"], 2);
  EXPECT_EQ(alarm["first"], json_time(noon + 1s));
  EXPECT_EQ(alarm["t"], json_time(noon + 10s));
}

TEST_F(AnOperator, IsNotCalledByWhatIsShelvedUntilItsTimeIsOver) {
  happens(event(noon + 1s));
  json shelve = request("shelve");
  EXPECT_EQ(alarms.act(shelve, "anna", noon + 2s).error().status, 400U) << "for how long?";
  for (const json& wrong : {json(0), json(-1), json(86401), json("1"), json(nullptr)}) {
    shelve["for_s"] = wrong;
    EXPECT_EQ(alarms.act(shelve, "anna", noon + 2s).error().status, 400U) << wrong;
  }
  shelve["for_s"] = 600;
  EXPECT_EQ(alarms.act(shelve, "anna", noon + 2s).value()["calls"], false);
  happens(event(noon + 3s));
  EXPECT_EQ(first_of(alarms)["calls"], false);
  EXPECT_TRUE(alarms.expire(noon + 601s).empty());
  const auto over = alarms.expire(noon + 602s);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0]["calls"], true);
  EXPECT_TRUE(over[0]["shelved"].is_null());
  EXPECT_TRUE(alarms.expire(noon + 603s).empty());
}

TEST_F(AnOperator, TakesItOffTheShelfBeforehand) {
  happens(event(noon + 1s));
  json shelve = request("shelve");
  shelve["for_s"] = 600;
  ASSERT_TRUE(alarms.act(shelve, "anna", noon + 2s));
  EXPECT_EQ(alarms.act(request("unshelve"), "ben", noon + 3s).value()["calls"], true);
}

TEST_F(AnOperator, FindsAllOfItAgainAtAnotherStationOfTheSameArchive) {
  happens(event(noon + 1s));
  ASSERT_TRUE(alarms.act(request("acknowledge"), "anna", noon + 2s));
  happens(event(noon + 3s));
  happens(event(noon + 3s, 3, 8));
  json shelve = request("shelve");
  shelve["event"] = "OTHER";
  shelve["for_s"] = 60;
  ASSERT_TRUE(alarms.act(shelve, "ben", noon + 4s));
  const Alarms again{*archive, noon};
  EXPECT_EQ(again.list(), alarms.list());
  EXPECT_EQ(first_of(again)["acknowledged"]["who"], "anna");
  EXPECT_EQ(again.list()["alarms"][1]["shelved"]["who"], "ben");
}

TEST_F(AnOperator, HasNothingOfTheFlightBefore) {
  happens(event(noon + 1s));
  ASSERT_TRUE(alarms.act(request("acknowledge"), "anna", noon + 2s));
  alarms.begin(noon + 10s);
  EXPECT_TRUE(alarms.list()["alarms"].empty());
  EXPECT_EQ(alarms.act(request("acknowledge"), "anna", noon + 11s).error().status, 404U);
  happens(event(noon + 12s));
  EXPECT_EQ(first_of(alarms)["count"], 1);
  EXPECT_TRUE(first_of(alarms)["acknowledged"].is_null());
}

TEST_F(AnOperator, AcknowledgesAllOfItAtOnceButNotWhatComesAfter) {
  happens(event(noon + 1s));
  happens(event(noon + 2s, 3, 8));
  EXPECT_TRUE(alarms.list()["seen_until"].is_null());
  const auto done = alarms.act({{"subsystem", "*"}, {"action", "acknowledge"}, {"note", "seen"}}, "anna", noon + 3s);
  ASSERT_TRUE(done);
  for (const json& one : (*done)["alarms"]) EXPECT_EQ(one["acknowledged"]["note"], "seen");
  EXPECT_EQ((*done)["seen_until"], 2'145'916'903);
  happens(event(noon + 4s));
  EXPECT_EQ(first_of(alarms)["calls"], true);
  EXPECT_EQ(Alarms(*archive, noon).list(), alarms.list());
  EXPECT_EQ(alarms.act({{"subsystem", "*"}, {"action", "shelve"}, {"for_s", 60}}, "a", noon).error().status, 400U);
}

TEST_F(AnOperator, IsRefusedWhatThereIsNot) {
  happens(event(noon + 1s));
  EXPECT_EQ(alarms.act({{"subsystem", "LAMP"}, {"event", "LOST"}, {"action", "acknowledge"}}, "a", noon).error().status,
            404U);
  EXPECT_EQ(alarms.act(request("delete"), "a", noon).error().status, 400U);
  json longer = request("acknowledge");
  longer["note"] = std::string(201, 'x');
  EXPECT_EQ(alarms.act(longer, "a", noon).error().status, 400U);
}

TEST_F(AnOperator, SeesWhatCallsFirstAndAFloodOfKindsHasAnEnd) {
  for (unsigned i = 0; i < Alarms::most_alarms + 100; ++i) {
    auto one = event(noon + Duration{i}, 3, static_cast<std::uint16_t>(i));
    one.name = std::to_string(i);
    alarms.hear(one);
  }
  EXPECT_EQ(alarms.list()["alarms"].size(), Alarms::most_alarms);
  alarms.hear(event(noon + 1s, 4, 9));
  EXPECT_EQ(first_of(alarms)["severity"], "high");
}

}  // namespace
}  // namespace hirosco::ground
