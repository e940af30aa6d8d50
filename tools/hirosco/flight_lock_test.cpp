// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/flight_lock.hpp"

#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

using namespace std::chrono_literals;

TEST(FlightLock, IsReadAsItIsWritten) {
  const std::string text = lock_text({.keeper = 4711, .limit = 2500ms, .mission = "CRAFT"});
  EXPECT_EQ(text, "4711 2500 CRAFT 1\n");
  const auto lock = lock_from_text(text);
  ASSERT_TRUE(lock);
  EXPECT_EQ(lock->keeper, 4711);
  EXPECT_EQ(lock->limit, 2500ms);
  EXPECT_EQ(lock->mission, "CRAFT");
}

TEST(FlightLock, OfAFlightBeforeItHadAVersionIsOfTheFirst) {
  const auto lock = lock_from_text("4711 2500 CRAFT\n");
  ASSERT_TRUE(lock);
  EXPECT_EQ(lock->keeper, 4711);
}

TEST(FlightLock, OfAnotherVersionIsNotGoneBy) {
  const auto lock = lock_from_text("4711 2500 CRAFT 2\n");
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error(), "it is of version 2, this program's of version 1");
}

TEST(FlightLock, ThatIsNoneIsNotGoneBy) {
  for (const char* text : {"", "\n", "4711\n", "4711 2500\n", "x 2500 CRAFT 1\n", "0 2500 CRAFT 1\n",
                           "-1 2500 CRAFT 1\n", "4711 -1 CRAFT 1\n", "4711 2500ms CRAFT 1\n", "4711 2500 CRAFT one\n",
                           "4711 2500 CRAFT 1 more\n", "99999999999 2500 CRAFT 1\n"})
    EXPECT_FALSE(lock_from_text(text)) << text;
}

TEST(FlightLock, MakesNobodyWaitLongerThanTwoMinutes) {
  const auto lock = lock_from_text("4711 999999999 CRAFT 1\n");
  ASSERT_TRUE(lock);
  EXPECT_EQ(lock->limit, 120s);
}

}  // namespace
}  // namespace hirosco::tools
