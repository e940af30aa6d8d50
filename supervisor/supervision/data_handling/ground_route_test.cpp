// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/ground_route.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/channel_pair.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Sent = GroundRoute::Kind;

class GroundRouteTest : public ::testing::Test {
 protected:
  void send(int number, Sent kind, TimePoint now = {}) {
    const std::array packet{static_cast<std::byte>(number)};
    route_.send(channels_.supervisor_end(), packet, kind, now);
  }
  /// What the link reads, at most so many packets.
  std::vector<int> read(std::size_t most = 1000) {
    std::vector<int> packets;
    MessageBuffer buffer;
    while (packets.size() < most) {
      const auto found = channels_.subsystem_end().receive(buffer);
      if (!found || found->flow == Flow::None) return packets;
      packets.push_back(std::to_integer<int>(found->message.packet[0]));
    }
    return packets;
  }
  void flush(TimePoint now = {}) { route_.flush(channels_.supervisor_end(), now); }

  ChannelPair channels_{2};
  GroundRoute route_{{.busy = 3, .reports_octets = 6, .housekeeping = 2, .patience = 100ms}};
};

TEST_F(GroundRouteTest, KeepsTheOrderOfReportsAndHousekeepingWhileTheLinkIsBehind) {
  for (int i = 1; i <= 6; ++i) send(i, i % 2 == 0 ? Sent::Housekeeping : Sent::Report);
  std::vector<int> got;
  while (got.size() < 6) {
    const auto more = read();
    ASSERT_FALSE(more.empty());
    got.insert(got.end(), more.begin(), more.end());
    flush();
  }
  EXPECT_THAT(got, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_FALSE(route_.waiting());
  EXPECT_EQ(route_.lost(), GroundRoute::Lost{});
}

TEST_F(GroundRouteTest, IsBehindOnceTheLinkDidNotTakeAllThatItWasGiven) {
  send(1, Sent::Report);
  flush();
  EXPECT_FALSE(route_.behind());
  for (int i = 2; i <= 4; ++i) send(i, Sent::Report);
  flush();
  EXPECT_TRUE(route_.behind());
  while (!read().empty()) flush();
  EXPECT_FALSE(route_.behind());
}

TEST_F(GroundRouteTest, DropsTheOldestHousekeepingAndNoReport) {
  send(1, Sent::Report);
  send(2, Sent::Report);   // the channel is full
  for (int i = 10; i < 20; ++i) send(i, Sent::Housekeeping);
  send(3, Sent::Report);
  EXPECT_EQ(route_.lost().housekeeping, 8U);
  EXPECT_EQ(route_.lost().reports, 0U);
  EXPECT_THAT(read(), ElementsAre(1, 2));
  flush();
  EXPECT_THAT(read(), ElementsAre(18, 19));
  flush();
  EXPECT_THAT(read(), ElementsAre(3));
}

TEST_F(GroundRouteTest, ReadsNoTelecommandWhileReportsWaitAndTheLinkTakesSome) {
  for (int i = 1; i <= 4; ++i) send(i, Sent::Report);
  EXPECT_TRUE(route_.takes_telecommands(TimePoint{}));
  send(5, Sent::Report);
  EXPECT_FALSE(route_.takes_telecommands(TimePoint{}));
  read(1);
  flush(TimePoint{50ms});
  EXPECT_TRUE(route_.takes_telecommands(TimePoint{50ms}));
}

TEST_F(GroundRouteTest, ReadsOnWhenTheLinkHasTakenNothingForAWhile) {
  for (int i = 1; i <= 5; ++i) send(i, Sent::Report, TimePoint{1s});
  EXPECT_FALSE(route_.takes_telecommands(TimePoint{1s} + 99ms));
  EXPECT_TRUE(route_.takes_telecommands(TimePoint{1s} + 100ms));
}

TEST_F(GroundRouteTest, CountsEachReportThatALinkThatIsStuckCannotBeKept) {
  for (int i = 1; i <= 20; ++i) send(i, Sent::Report);
  EXPECT_EQ(route_.lost().reports, 20U - 2U - 6U);
  EXPECT_THAT(read(), ElementsAre(1, 2));
  route_.clear();
  EXPECT_EQ(route_.lost().reports, 18U);
  flush();
  EXPECT_THAT(read(), IsEmpty());
}

TEST_F(GroundRouteTest, ReadsTheTelecommandsOfAStepNowAndThenWhileReportsWaitWhoeverBringsThem) {
  TimePoint now{1s};
  int steps_that_read = 0;
  // The link takes one report a step, somebody on board brings two.
  for (int step = 0; step < 1000; ++step, now += 1ms) {
    route_.begin_step(now);
    if (step > 10 && route_.takes_telecommands(now)) ++steps_that_read;
    for (int i = 0; i < 2; ++i) send(i, Sent::Report, now);
    read(1);
    flush(now);
  }
  EXPECT_GE(steps_that_read, 45);
  EXPECT_LE(steps_that_read, 55) << "each would bring more";
}

}  // namespace
}  // namespace hirosco::supervisor
