// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/log_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;

class ALog : public testing::ArchiveOfAWorkshop {
 protected:
  [[nodiscard]] nlohmann::json search(const LogQuery& query) { return search_log(catalogue, *archive, query); }
  /// Seconds after the opening at which the lines were said.
  [[nodiscard]] static std::vector<int> when(const nlohmann::json& found) {
    std::vector<int> all;
    for (const auto& one : found["packets"]) all.push_back(static_cast<int>(one["t"].get<double>() - 2'145'916'900));
    return all;
  }
  void torque(int after_s) { hears(testing::torque_high(catalogue, opening + after_s * 1s)); }
};

TEST_F(ALog, TellsEachPacketInWordsNewestFirst) {
  hears(testing::state_changed(catalogue, "LAMP", descriptor::State::Operational, opening));
  torque(1);
  const auto found = search({.text = ""});
  EXPECT_THAT(when(found), ElementsAre(1, 0));
  const auto& newest = found["packets"][0];
  EXPECT_EQ(newest["text"], "TM[5,3] DRILL medium TORQUE_HIGH JOINT=2 VALUE=12.5 N m");
  EXPECT_EQ(newest["apid"], testing::drill_apid);
  EXPECT_EQ(newest["subsystem"], "DRILL");
  EXPECT_EQ(newest["service"], 5);
  EXPECT_EQ(newest["subtype"], 3);
  EXPECT_TRUE(found["before"].is_null()) << "nothing is older";
}

TEST_F(ALog, FindsEachWordAnywhereWithoutRegardToCase) {
  hears(testing::state_changed(catalogue, "LAMP", descriptor::State::Operational, opening));
  hears(testing::state_changed(catalogue, "DRILL", descriptor::State::Operational, opening + 1s));
  torque(2);
  EXPECT_THAT(when(search({.text = "oper drill"})), ElementsAre(1));
  EXPECT_THAT(when(search({.text = "  DRILL  "})), ElementsAre(2, 1));
  EXPECT_THAT(when(search({.text = "lamp torque"})), IsEmpty()) << "all of them in one line";
}

TEST_F(ALog, LeavesHousekeepingOutUnlessItIsWanted) {
  hears(testing::housekeeping(catalogue, testing::drill_apid, 71, {}, opening));
  torque(1);
  EXPECT_THAT(when(search({.text = ""})), ElementsAre(1));
  EXPECT_THAT(when(search({.text = "", .housekeeping = Archive::Housekeeping::Included})), ElementsAre(1, 0));
}

TEST_F(ALog, GoesOnWhereAnAnswerEnded) {
  for (const int after_s : {0, 1, 1, 2, 3}) torque(after_s);
  auto found = search({.text = "", .limit = 2});
  EXPECT_THAT(when(found), ElementsAre(3, 2));
  const auto next = found["before"].get<std::int64_t>();
  EXPECT_EQ(found["packets"][1]["number"], next);
  found = search({.text = "", .before = next, .limit = 2});
  EXPECT_THAT(when(found), ElementsAre(1, 1)) << "of one time, too, each once";
  found = search({.text = "", .before = found["before"].get<std::int64_t>(), .limit = 2});
  EXPECT_THAT(when(found), ElementsAre(0));
  EXPECT_TRUE(found["before"].is_null());
}

TEST_F(ALog, BeginsWhereSomebodyLooks) {
  for (const int after_s : {0, 1, 2}) torque(after_s);
  EXPECT_THAT(when(search({.text = "", .to = opening + 1s})), ElementsAre(1, 0));
}

TEST_F(ALog, SaysWhatCanBeSaidOfADamagedPacket) {
  auto octets = testing::torque_high(catalogue, opening);
  octets.back() ^= std::byte{1};
  StoredPacket stored;
  stored.t = opening;
  stored.apid = 77;
  archive->add(stored, octets);
  const auto found = search({.text = ""});
  EXPECT_EQ(found["packets"][0]["text"], "TM damaged");
  EXPECT_EQ(found["packets"][0]["subsystem"], "APID 77");
}

TEST_F(ALog, LooksAtNoMoreThanTwentyThousandPacketsAtATime) {
  torque(0);
  const auto ping = testing::packet_of({.apid = testing::lamp_apid, .service = 17, .subtype = 2, .time = opening}, {});
  StoredPacket stored;
  stored.t = opening + 1s;
  for (int i = 0; i < 20'000; ++i) archive->add(stored, ping);
  const auto found = search({.text = "torque"});
  EXPECT_THAT(found["packets"], IsEmpty());
  ASSERT_TRUE(found["before"].is_number()) << "there is more";
  EXPECT_THAT(when(search({.text = "torque", .before = found["before"].get<std::int64_t>()})), ElementsAre(0));
}

}  // namespace
}  // namespace hirosco::ground
