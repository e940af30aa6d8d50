// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/telecommand/called_function.hpp"

#include <gtest/gtest.h>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using testing::arm;

TEST(CalledFunction, IsReadFromTheFunctionServiceOnly) {
  const auto packet = testing::telecommand(arm, 8, 1, testing::call_data("SET_STATE", 5));
  const auto view = pus::TelecommandView::parse(packet).value();
  const auto called = called_function(view);
  ASSERT_TRUE(called);
  EXPECT_EQ(called->name, "SET_STATE");
  EXPECT_EQ(called->first_argument, 5);
  const auto other = testing::telecommand(arm, 20, 1, testing::call_data("SET_STATE", 5));
  EXPECT_FALSE(called_function(pus::TelecommandView::parse(other).value()));
  for (const std::uint8_t subtype : {std::uint8_t{0}, std::uint8_t{2}}) {
    const auto of_none = testing::telecommand(arm, 8, subtype, testing::call_data("SET_STATE", 5));
    EXPECT_FALSE(called_function(pus::TelecommandView::parse(of_none).value())) << int{subtype};
  }
  const auto without = testing::telecommand(arm, 8, 1, testing::call_data("HOLD"));
  EXPECT_FALSE(called_function(pus::TelecommandView::parse(without).value())->first_argument);
}

TEST(CalledFunction, IsNamedBySixteenOctetsWhateverIsMissingBehindThem) {
  const auto whole = testing::call_data("SAFE_ALL");
  const auto bare = testing::telecommand(arm, 8, 1, Octets{whole}.first(16));
  const auto called = called_function(pus::TelecommandView::parse(bare).value());
  ASSERT_TRUE(called);
  EXPECT_EQ(called->name, "SAFE_ALL");
  EXPECT_FALSE(called->first_argument);
  const auto cut = testing::telecommand(arm, 8, 1, Octets{whole}.first(15));
  EXPECT_FALSE(called_function(pus::TelecommandView::parse(cut).value()));
}

}  // namespace
}  // namespace hirosco::supervisor
