// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/history.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using testing::opening;

class AHistory : public testing::ArchiveOfAWorkshop {
 protected:
  /// In the report that only one configuration has; the other one has the depths, too.
  void runs_at(OnboardTime t, double speed) {
    hears(testing::housekeeping(catalogue, testing::drill_apid, 71, {{"DRILL.SPEED", speed}}, t));
  }
  void bores(OnboardTime t, double speed, double depth) {
    hears(testing::housekeeping(catalogue, testing::drill_apid, 70,
                                {{"DRILL.SPEED", speed}, {"DRILL.DEPTHS[1]", depth}}, t));
  }
  [[nodiscard]] nlohmann::json speeds(std::size_t points = 1000) {
    const auto answer = history_json(catalogue, *archive, "DRILL.SPEED", {opening, opening + 100s}, points);
    EXPECT_TRUE(answer);
    return answer.value_or(nlohmann::json{});
  }
  [[nodiscard]] Answered<std::string> csv(const std::vector<std::string>& parameters) {
    return history_csv(catalogue, *archive, parameters, {{}, opening + 100s});
  }
};

TEST_F(AHistory, IsOfAllReportsThatHaveTheParameterInOrderOfTime) {
  runs_at(opening - 1s, 9.5);
  runs_at(opening, 1.5);
  bores(opening + 1s, 2.5, 0);
  runs_at(opening + 2s, 3.5);
  runs_at(opening + 101s, 9.5);
  const auto told = speeds();
  EXPECT_EQ(told["v"], (nlohmann::json{1.5, 2.5, 3.5}));
  EXPECT_EQ(told["t"], (nlohmann::json{2'145'916'900, 2'145'916'901, 2'145'916'902}));
  EXPECT_EQ(told["parameter"], "DRILL.SPEED");
  EXPECT_EQ(told["unit"], "rad/s");
  EXPECT_EQ(told["complete"], true);
}

TEST_F(AHistory, OfWhatHasNoCurveOrIsNotThereIsRefused) {
  const Span span{opening, opening + 1s};
  EXPECT_EQ(history_json(catalogue, *archive, "DRILL.COLOUR", span, 10).error().status, 404U);
  EXPECT_EQ(history_json(catalogue, *archive, "DRILL.LABEL", span, 10).error().status, 400U);
  EXPECT_EQ(csv({"DRILL.SPEED", "DRILL.COLOUR"}).error().status, 404U);
  EXPECT_EQ(csv({"DRILL.LABEL"}).error().status, 400U);
  EXPECT_EQ(csv({}).error().status, 400U);
  EXPECT_TRUE(csv(std::vector<std::string>(64, "DRILL.SPEED")));
  EXPECT_EQ(csv(std::vector<std::string>(65, "DRILL.SPEED")).error().status, 400U);
}

TEST_F(AHistory, OfMoreSamplesThanAreWantedHasTheLeastAndGreatestOfEqualParts) {
  for (int i = 0; i < 100; ++i) runs_at(opening + i * 1s, i);
  const auto told = speeds(10);
  EXPECT_FALSE(told.contains("v"));
  ASSERT_EQ(told["t"].size(), 10U);
  EXPECT_NEAR(told["t"][0].get<double>(), 2'145'916'900 + 99 / 20.0, 1e-3) << "the middle of each";
  EXPECT_EQ(told["min"][0], 0);
  EXPECT_EQ(told["max"][0], 9);
  EXPECT_EQ(told["min"][9], 90);
  EXPECT_EQ(told["max"][9], 99) << "the last sample is in the last part";
  EXPECT_TRUE(speeds(100).contains("v")) << "as many as are wanted are told one by one";
}

TEST_F(AHistory, LeavesOutPartsWithoutSamplesAndKeepsNumbersBesideWhatIsNone) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const double speed : {none, 2.0, 1.0, none}) runs_at(opening, speed);
  for (int i = 0; i < 8; ++i) runs_at(opening + 50s, none);
  runs_at(opening + 100s, 7);
  const auto told = speeds(10);
  EXPECT_EQ(told["min"], (nlohmann::json{1, "NaN", 7}));
  EXPECT_EQ(told["max"], (nlohmann::json{2, "NaN", 7}));
}

TEST_F(AHistory, TellsWhereALineMayNotBeDrawn) {
  runs_at(opening, 1);
  archive->add(StoredGap{opening + 1s, opening + 2s});
  const nlohmann::json gap = nlohmann::json::array({{{"from", 2'145'916'901}, {"to", 2'145'916'902}}});
  EXPECT_EQ(speeds()["gaps"], gap);
  for (int i = 0; i < 20; ++i) runs_at(opening + 3s, i);
  EXPECT_EQ(speeds(10)["gaps"], gap);
}

TEST_F(AHistory, SaysWhenThereAreMoreSamplesThanItTakes) {
  for (int i = 0; i < 3; ++i) runs_at(opening + i * 1s, i);
  const auto column = catalogue.find_column("DRILL.SPEED");
  ASSERT_TRUE(column);
  std::vector<double> taken;
  const auto take = [&](OnboardTime, double value) { taken.push_back(value); };
  EXPECT_FALSE(samples(catalogue, *archive, *column, {}, 2, take));
  EXPECT_EQ(taken, (std::vector<double>{0, 1})) << "the newest are missing";
  EXPECT_TRUE(samples(catalogue, *archive, *column, {}, 4, take));
}

TEST_F(AHistory, AsATableHasALineForEachTimeAndNothingWhereOneWasNotSampled) {
  bores(OnboardTime{100s}, 0.5, 0.25);
  runs_at(opening, 1.5);
  bores(opening + 250ms, 2.5, 0.75);
  EXPECT_EQ(csv({"DRILL.SPEED", "DRILL.DEPTHS[1]"}).value(),
            "t,utc,DRILL.SPEED,DRILL.DEPTHS[1]\n"
            "100.000000,,0.5,0.25\n"
            "2145916900.000000,2026-01-01T00:01:03.000000Z,1.5,\n"
            "2145916900.250000,2026-01-01T00:01:03.250000Z,2.5,0.75\n")
      << "on virtual time there is no calendar";
}

}  // namespace
}  // namespace hirosco::ground
