// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/quota.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace hirosco {
namespace {

TEST(Quota, RefusesWhatIsBeyondItWithTheReasonAndCountsThat) {
  Quota ports{"all ports are held", 2};
  auto first = ports.take();
  auto second = ports.take();
  ASSERT_TRUE(first && second);
  const auto third = ports.take();
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, ErrorCode::ResourceExhausted);
  EXPECT_STREQ(third.error().text, "all ports are held");
  EXPECT_EQ(third.error().value, 2);
  EXPECT_EQ(ports.used(), 2u);
  EXPECT_EQ(ports.refused(), 1u);
  first = Quota::Held{};
  EXPECT_TRUE(ports.take()) << "one was given back";
}

TEST(Quota, TakesBackWithTheEndOfWhoHoldsItAndRemembersTheMost) {
  Quota files{"all files are held", std::nullopt};
  {
    std::vector<Quota::Held> held;
    for (int i = 0; i < 5; ++i) held.push_back(files.take().value());
    Quota::Held moved = std::move(held.back());
    held.pop_back();
    EXPECT_TRUE(moved);
    EXPECT_EQ(files.used(), 5u);
  }
  EXPECT_EQ(files.used(), 0u);
  EXPECT_EQ(files.high(), 5u);
}

TEST(Quota, MayEndBeforeWhatIsHeldOfIt) {
  auto ports = std::make_unique<Quota>("held", 2);
  auto held = ports->take();
  ASSERT_TRUE(held);
  ports.reset();
  EXPECT_TRUE(*held) << "what is given back now goes nowhere; a sanitizer would say where it went before";
}

TEST(Quota, IsNeverOverdrawnByThreadsThatTakeAtOnce) {
  constexpr std::uint32_t most = 3;
  Quota ports{"held", most};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int turn = 0; turn < 20'000; ++turn) {
        const auto held = ports.take();
        if (ports.used() > most) std::abort();
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(ports.used(), 0u);
  EXPECT_LE(ports.high(), most);
}

}  // namespace
}  // namespace hirosco
