// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/hear_safe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"

/// A real connection, whose other end is a guard in whatever condition.
namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Stop = supervisor::SafeAnswer::Stop;
using namespace std::chrono_literals;

struct HearSafeTest : ::testing::Test {
  FileDescriptor ours, guards;
  std::vector<std::string> printed;

  void SetUp() override {
    std::array<int, 2> ends{-1, -1};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
    ours.reset(ends[0]);
    guards.reset(ends[1]);
  }
  void says(std::string_view message) const {
    ASSERT_EQ(::send(guards.get(), message.data(), message.size(), MSG_NOSIGNAL), static_cast<ssize_t>(message.size()));
  }
  [[nodiscard]] HeardSafe heard(std::chrono::milliseconds patience = 10s) {
    return hear_safe(ours.get(), std::chrono::steady_clock::now() + patience,
                     [this](std::string_view words) { printed.emplace_back(words); });
  }
};

TEST_F(HearSafeTest, AllHaveStoppedWhereTheAnswerIsWhole) {
  says("STOPPED MOTOR stopped 3 ms, says the device\n");
  says("STOPPED HAND stopped 0 ms\n");
  says("END 1 2\n");
  guards.reset();
  const HeardSafe how = heard();
  EXPECT_EQ(how.stop, Stop::All);
  EXPECT_EQ(how.why_not_whole, "");
  EXPECT_THAT(printed, ElementsAre("MOTOR stopped 3 ms, says the device", "HAND stopped 0 ms"));
}

TEST_F(HearSafeTest, WhoDidNotConfirmIsNotAllThoughTheAnswerIsWhole) {
  says("UNCONFIRMED MOTOR did not confirm that it stopped\n");
  says("END 1 1\n");
  guards.reset();
  const HeardSafe how = heard();
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_EQ(how.why_not_whole, "");
}

TEST_F(HearSafeTest, AGuardThatDiesBetweenTheLinesOfTwoDevicesHasNotSaidThatAllHaveStopped) {
  says("STOPPED MOTOR stopped 3 ms, says the device\n");
  guards.reset();
  const HeardSafe how = heard();
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_EQ(how.why_not_whole, "it has no end (the connection ended)");
}

TEST_F(HearSafeTest, AGuardThatSaysNoMoreInTimeHasNotSaidThatAllHaveStopped) {
  says("STOPPED MOTOR stopped 3 ms, says the device\n");
  const HeardSafe how = heard(0ms);
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_EQ(how.why_not_whole, "it has no end (no more came in time)");
}

TEST_F(HearSafeTest, AnErrorOfTheConnectionIsNoEndOfAnAnswer) {
  // Who ends with something unread resets its connection: the error is heard in the place of an end.
  ASSERT_EQ(::send(ours.get(), "SAFE", 4, MSG_NOSIGNAL), 4);
  says("STOPPED MOTOR stopped 3 ms\n");
  const HeardSafe how = hear_safe(ours.get(), std::chrono::steady_clock::now() + 10s, [this](std::string_view words) {
    printed.emplace_back(words);
    guards.reset();
  });
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_EQ(how.why_not_whole, "it has no end (Connection reset by peer)");
}

TEST_F(HearSafeTest, AnOlderGuardHasNotSaidThatAllHaveStopped) {
  says("MOTOR stopped 0 ms, says the device\n");
  says("HAND stopped 0 ms\n");
  guards.reset();
  const HeardSafe how = heard();
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_THAT(how.why_not_whole, HasSubstr("another version of hirosco"));
  EXPECT_THAT(printed, ElementsAre("MOTOR stopped 0 ms, says the device", "HAND stopped 0 ms"))
      << "who reads it sees what it said";
}

TEST_F(HearSafeTest, AGuardOfAnotherWordingHasNotSaidThatAllHaveStopped) {
  says("MOTOR is still moving\n");
  says("END 1 1\n");
  guards.reset();
  EXPECT_EQ(heard().stop, Stop::NotAll);
}

TEST_F(HearSafeTest, AWrongCountHasNotSaidThatAllHaveStopped) {
  says("STOPPED MOTOR stopped 3 ms\n");
  says("END 1 2\n");
  guards.reset();
  const HeardSafe how = heard();
  EXPECT_EQ(how.stop, Stop::NotAll);
  EXPECT_THAT(how.why_not_whole, HasSubstr("counts others than were named"));
}

TEST_F(HearSafeTest, ALineThatDoesNotFitHasNotSaidThatAllHaveStopped) {
  says("STOPPED MOTOR " + std::string(600, 'x') + "\n");
  says("END 1 1\n");
  guards.reset();
  EXPECT_EQ(heard().stop, Stop::NotAll);
}

TEST_F(HearSafeTest, WhoSaysNothingIsNobody) {
  EXPECT_EQ(heard(0ms).stop, Stop::Nobody);
  guards.reset();
  EXPECT_EQ(heard().stop, Stop::Nobody);
}

}  // namespace
}  // namespace hirosco::tools
