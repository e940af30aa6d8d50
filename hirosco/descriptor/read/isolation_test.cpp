// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

/// Users of the system that a mission gives its subsystems (docs/adr/0177).
namespace hirosco::descriptor {
namespace {

using namespace testing;

/// The mission of the test data, of three subsystems, where the coronagraph's device is reached so.
Reading<Mission> with_users(const std::string& users, const std::string& robots = "") {
  const std::string element = "<Isolation users=\"" + users + "\"/>\n  <Power";
  std::string robot = file_system()(data / "coronagraph.xml").value();
  if (!robots.empty()) robot = changed(R"(transfer="udp" address="127.0.0.1:5001")", robots, robot);
  return read_mission(data / "mission.xml",
                      overlay({{"mission.xml", changed("<Power", element)}, {"coronagraph.xml", robot}}));
}

std::string first_problem(const Reading<Mission>& reading) {
  return reading.problems.empty() ? "" : reading.problems[0].code + " " + reading.problems[0].message;
}

TEST(OwnUsers, AreGivenInTheOrderOfTheMissionAndToNobodyWhereNoneAreNamed) {
  const auto given = with_users("60600-60602");
  ASSERT_TRUE(given.value) << first_problem(given);
  EXPECT_EQ(given.value->users, (UserNumbers{60'600, 60'602}));
  ASSERT_EQ(given.value->subsystems.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(given.value->subsystems[i].user, 60'600 + i);
  const auto none = read_mission(data / "mission.xml", file_system());
  EXPECT_FALSE(none.value->users);
  for (const auto& member : none.value->subsystems) EXPECT_FALSE(member.user);
}

TEST(OwnUsers, AreARangeOfNumbersThatNobodyElseHasAndEnoughForAll) {
  for (const char* bad : {"60600", "60602-60600", "0-100", "999-1005", "60600-", "-60600", "60600-x", "root-adm",
                          "2147483640-2147483647", "1000-99999999999999999999"}) {
    const auto reading = with_users(bad);
    EXPECT_FALSE(reading.value) << bad;
    EXPECT_TRUE(first_problem(reading).starts_with("E0366 ")) << bad;
    EXPECT_FALSE(reading.problems.at(0).hint.empty());
  }
  EXPECT_EQ(first_problem(with_users("65000-66000")), "E0366 user 65534 is nobody's to have");
  EXPECT_EQ(first_problem(with_users("60600-60601")), "E0366 2 numbers of users for 3 subsystems");
  EXPECT_EQ(with_users("60600-60601").problems[0].hint, "each has one: 60600-60602");
}

TEST(OwnUsers, AreRefusedWhereADeviceIsReachedByWhatBelongsToNoUser) {
  const std::string range = "60600-60602";
  for (const char* good : {R"(transfer="shared_memory" address="robot")", R"(transfer="tcp" address="127.0.0.1:5001")",
                           R"(transfer="serial" address="/dev/ttyS0@115200")", R"(transfer="unix" address="robot")"})
    EXPECT_TRUE(with_users(range, good).value) << good;
  EXPECT_EQ(first_problem(with_users(range, R"(transfer="message_queue" address="robot")")),
            "E0367 'CORONAGRAPH' cannot be a user of its own: its device 'PLATE' is not for it alone: by message_queue "
            "nothing is known of whose it is");
  EXPECT_TRUE(first_problem(with_users(range, R"(transfer="serial" address="robot@115200")")).starts_with("E0367 "));
}

}  // namespace
}  // namespace hirosco::descriptor
