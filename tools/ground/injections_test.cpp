// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/ground/injections.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace hirosco::ground {
namespace {

class FixedClock final : public Clock {
  [[nodiscard]] TimePoint do_now() const noexcept override { return TimePoint{100s}; }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return OnboardTime{5000s}; }
  [[nodiscard]] Duration do_processor() const noexcept override { return {}; }
};

struct InjectionsTest : ::testing::Test {
  InjectionsTest() {
    folder = std::filesystem::temp_directory_path() / ("hirosco-injections-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  ~InjectionsTest() override { std::filesystem::remove_all(folder); }
  void write(const std::string& text) { std::ofstream{folder / "arm.injected", std::ios::app} << text; }

  std::filesystem::path folder;
  const FixedClock clock;
};

TEST_F(InjectionsTest, ToldOnceWithTheInstantAtWhichTheyWereMade) {
  write("90000000000 plug\n");
  Injections injections{folder, {"arm", "hand"}, clock};
  EXPECT_TRUE(injections.poll().empty()) << "of before";
  write("99000000000 unplug\n99500000000 delay 20\n");
  const auto found = injections.poll();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].device, "arm");
  EXPECT_EQ(found[0].line, "unplug");
  EXPECT_EQ(found[0].answer, "ok");
  EXPECT_EQ(found[0].t, OnboardTime{4999s});
  EXPECT_EQ(found[1].t, OnboardTime{4999s + 500ms});
  EXPECT_TRUE(injections.poll().empty());
}

TEST_F(InjectionsTest, HalfALineWaitsForItsOtherHalf) {
  Injections injections{folder, {"arm"}, clock};
  write("99000000000 unp");
  EXPECT_TRUE(injections.poll().empty());
  write("lug\n");
  ASSERT_EQ(injections.poll().size(), 1U);
}

TEST_F(InjectionsTest, WhatIsNoLineOfADeviceIsPassedOverAndSteersNothing) {
  Injections injections{folder, {"arm"}, clock};
  write("\nnonsense\n12\n99000000000 \x1b[2J\n" + std::string(70'000, 'x'));
  auto found = injections.poll();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].line, "?[2J");
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(injections.poll().empty());
  std::filesystem::remove(folder / "arm.injected");
  write("99000000000 plug\n");  // another flight
  found = injections.poll();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].line, "plug");
}

}  // namespace
}  // namespace hirosco::ground
