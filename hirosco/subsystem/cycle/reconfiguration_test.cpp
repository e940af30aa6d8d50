// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/reconfiguration.hpp"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

/// The values of another configuration, set by the cycle: all of them or none. What comes of it is in bumpless_test.cpp.
namespace hirosco {
namespace {

struct LimitsOfAJoint {
  double low;
  double high;
};

/// A joint whose limits and gain the other configuration sets.
struct AnotherConfiguration : ::testing::Test {
  Dictionary dictionary =
      Dictionary::make(
          std::array{
              ParameterSpec{
                  "LIMITS", {10, Type::Struct, 0}, {{"LOW", Type::Double, 1}, {"HIGH", Type::Double, 1}}, true},
              ParameterSpec{"KP", {10, Type::Double, 0}, {{"KP", Type::Double, 1}}},
          })
          .value();
  Parameter<LimitsOfAJoint> limits;
  Parameter<double> kp;
  descriptor::Configuration from, to;
  descriptor::Bumpless terms;

  void SetUp() override {
    ASSERT_TRUE(dictionary.publish("LIMITS", limits));
    limits.store({-5, 5});
    kp.store(8);
  }
  void publish_gain() { ASSERT_TRUE(dictionary.publish("KP", kp)); }
  void sets(std::uint16_t parameter, std::optional<std::uint16_t> member, std::vector<Value> values) {
    descriptor::ParameterRef place;
    place.parameter = parameter;
    place.member = member;
    to.initial.push_back({place, std::move(values)});
  }
  [[nodiscard]] Reconfiguration made() const { return Reconfiguration::make(from, to, terms, dictionary); }
  void expect(double low, double high, double gain) {
    EXPECT_EQ(limits.load().low, low);
    EXPECT_EQ(limits.load().high, high);
    EXPECT_EQ(kp.load(), gain);
  }
};

TEST_F(AnotherConfiguration, SetsWholeStructuresMembersAndValuesAndTakesThemBack) {
  publish_gain();
  sets(0, std::nullopt, {-1.0, 1.0});
  sets(0, 1, {2.0});
  sets(1, std::nullopt, {3.0});
  Reconfiguration wanted = made();
  ASSERT_TRUE(wanted.set_values(dictionary));
  expect(-1, 2, 3);
  wanted.restore_values(dictionary);
  expect(-5, 5, 8);
}

TEST_F(AnotherConfiguration, OfWhichOneValueDoesNotFitSetsNone) {
  publish_gain();
  sets(0, 0, {-1.0});
  sets(1, std::nullopt, {3.0, 4.0});
  sets(0, 1, {2.0});
  Reconfiguration wanted = made();
  EXPECT_FALSE(wanted.set_values(dictionary));
  expect(-5, 5, 8);
}

TEST_F(AnotherConfiguration, OfWhichOneValueCouldNotBeTakenBackSetsNoneAndSaysSo) {
  sets(0, std::nullopt, {-1.0, 1.0});
  sets(1, std::nullopt, {3.0});
  Reconfiguration wanted = made();
  const auto set = wanted.set_values(dictionary);
  ASSERT_FALSE(set) << "nobody holds the gain";
  EXPECT_EQ(set.error().code, ErrorCode::Mismatch);
  EXPECT_STREQ(set.error().text, "an initial value");
  expect(-5, 5, 8);
}

}  // namespace
}  // namespace hirosco
