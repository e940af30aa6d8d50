// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/resource_ledger.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

namespace hirosco {
namespace {

constexpr SubsystemId arm{10};
constexpr SubsystemId camera{11};

class Ledger : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ledger_.declare("power_mw", 100));
    ASSERT_TRUE(ledger_.declare("port", 4));
  }
  ResourceLedger ledger_;
};

TEST_F(Ledger, RefusesTheSecondOfTwoClaimsThatFitAloneButNotTogether) {
  EXPECT_TRUE(ledger_.claim(arm, "power_mw", 60));
  const Result<> refused = ledger_.claim(camera, "power_mw", 60);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  EXPECT_EQ(refused.error().value, 40);
  EXPECT_EQ(ledger_.usage("power_mw")->used, 60U);
  EXPECT_TRUE(ledger_.claim(camera, "power_mw", 40));
}

TEST_F(Ledger, DoesNotOverflow) {
  EXPECT_TRUE(ledger_.claim(arm, "power_mw", 1));
  EXPECT_FALSE(ledger_.claim(arm, "power_mw", std::numeric_limits<std::uint64_t>::max()));
  EXPECT_EQ(ledger_.held(arm, "power_mw"), 1U);
}

TEST_F(Ledger, ClaimsAllOrNothing) {
  const std::array wanted{ResourceAmount{"power_mw", 50}, ResourceAmount{"port", 5}};
  EXPECT_FALSE(ledger_.claim(arm, wanted));
  EXPECT_EQ(ledger_.held(arm, "power_mw"), 0U);
  EXPECT_EQ(ledger_.usage("power_mw")->high_water, 0U);
  const std::array modest{ResourceAmount{"power_mw", 50}, ResourceAmount{"port", 1}};
  EXPECT_TRUE(ledger_.claim(arm, modest));
  EXPECT_EQ(ledger_.held(arm, "port"), 1U);
}

TEST_F(Ledger, ReleasesNoMoreThanIsHeld) {
  EXPECT_TRUE(ledger_.claim(arm, "port", 2));
  EXPECT_EQ(ledger_.release(arm, "port", 3).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(ledger_.release(camera, "port", 1).error().code, ErrorCode::OutOfRange);
  EXPECT_TRUE(ledger_.release(arm, "port", 2));
  EXPECT_EQ(ledger_.usage("port")->used, 0U);
  EXPECT_EQ(ledger_.usage("port")->high_water, 2U);
}

TEST_F(Ledger, TakesEverythingBackFromAHolderThatEnded) {
  EXPECT_TRUE(ledger_.claim(arm, "port", 2));
  EXPECT_TRUE(ledger_.claim(arm, "power_mw", 70));
  EXPECT_TRUE(ledger_.claim(camera, "port", 1));
  ledger_.release_all(arm);
  EXPECT_EQ(ledger_.usage("port")->used, 1U);
  EXPECT_EQ(ledger_.usage("power_mw")->used, 0U);
}

TEST_F(Ledger, KnowsOnlyDeclaredKinds) {
  EXPECT_EQ(ledger_.claim(arm, "file", 1).error().code, ErrorCode::NotFound);
  EXPECT_EQ(ledger_.usage("file").error().code, ErrorCode::NotFound);
  EXPECT_EQ(ledger_.declare("port", 9).error().code, ErrorCode::AlreadyExists);
  EXPECT_EQ(ledger_.kinds(), (std::vector<std::string_view>{"power_mw", "port"}));
}

TEST_F(Ledger, LimitDoesNotFallBelowWhatIsGranted) {
  EXPECT_TRUE(ledger_.claim(arm, "port", 3));
  EXPECT_EQ(ledger_.change_limit("port", 2).error().code, ErrorCode::NotPermitted);
  EXPECT_TRUE(ledger_.change_limit("port", 3));
  EXPECT_FALSE(ledger_.claim(arm, "port", 1));
}

TEST_F(Ledger, SumOfGrantsNeverExceedsTheLimit) {
  std::mt19937 random{3};
  for (int i = 0; i < 20'000; ++i) {
    const SubsystemId holder{static_cast<std::uint16_t>(random() % 5)};
    const std::uint64_t amount = random() % 60;
    if (random() % 2 == 0) (void)ledger_.claim(holder, "power_mw", amount);
    else (void)ledger_.release(holder, "power_mw", amount);
    std::uint64_t sum = 0;
    for (std::uint16_t id = 0; id < 5; ++id) sum += ledger_.held(SubsystemId{id}, "power_mw");
    ASSERT_EQ(sum, ledger_.usage("power_mw")->used);
    ASSERT_LE(sum, 100U);
  }
}

}  // namespace
}  // namespace hirosco
