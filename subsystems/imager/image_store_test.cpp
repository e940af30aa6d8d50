// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/image_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace hirosco::imager {
namespace {

using Numbers = std::array<std::uint32_t, ImageStore::places>;
constexpr Window small{0, 0, 64, 2, 1};

/// An image whose pixels are its number.
bool keep(ImageStore& store, std::uint32_t number) {
  const MutableOctets place = store.begin();
  if (place.empty()) return false;
  std::fill_n(place.begin(), small.pixels(), static_cast<std::byte>(number));
  store.keep({.number = number, .window = small});
  return true;
}

TEST(ImageStore, KeepsTheNewestFour) {
  ImageStore store;
  EXPECT_EQ(store.numbers(), Numbers{});
  EXPECT_FALSE(store.hold(0));
  for (std::uint32_t number = 1; number <= 6; ++number) ASSERT_TRUE(keep(store, number));
  EXPECT_EQ(store.numbers(), (Numbers{3, 4, 5, 6}));
  EXPECT_FALSE(store.hold(2));
  EXPECT_EQ(store.hold(0)->taken().number, 6u);
  EXPECT_EQ(store.hold(4)->pixels().size(), 128u);
  EXPECT_EQ(store.hold(4)->pixels().back(), std::byte{4});
}

TEST(ImageStore, WhatIsHeldStaysAndTheOthersGoRound) {
  ImageStore store;
  for (std::uint32_t number = 1; number <= 4; ++number) ASSERT_TRUE(keep(store, number));
  {
    const auto held = store.hold(1);
    for (std::uint32_t number = 5; number <= 9; ++number) ASSERT_TRUE(keep(store, number));
    EXPECT_EQ(store.numbers(), (Numbers{1, 7, 8, 9}));
    EXPECT_EQ(held->pixels().front(), std::byte{1});
  }
  ASSERT_TRUE(keep(store, 10));
  EXPECT_EQ(store.numbers(), (Numbers{7, 8, 9, 10}));
}

TEST(ImageStore, WhatIsBeingMadeIsNoImageAndOneThatWasGivenUpTakesNoSecondPlace) {
  ImageStore store;
  for (std::uint32_t number = 1; number <= 4; ++number) ASSERT_TRUE(keep(store, number));
  const MutableOctets begun = store.begin();
  EXPECT_EQ(store.numbers(), (Numbers{2, 3, 4, 0}));
  EXPECT_EQ(store.begin().data(), begun.data());
  EXPECT_FALSE(store.hold(1));
}

TEST(ImageStore, WithAllHeldThereIsNoPlace) {
  ImageStore store;
  std::vector<ImageStore::Held> held;
  for (std::uint32_t number = 1; number <= 4; ++number) {
    ASSERT_TRUE(keep(store, number));
    held.push_back(std::move(*store.hold(number)));
  }
  EXPECT_FALSE(keep(store, 5));
  EXPECT_EQ(store.numbers(), (Numbers{1, 2, 3, 4}));
  held.clear();
  EXPECT_TRUE(keep(store, 5));
}

/// The cycle makes images as fast as it can beside a reader.
TEST(ImageStore, WhoReadsSeesOneImageWhole) {
  ImageStore store;
  std::atomic<bool> ends{false};
  std::thread cycle{[&] {
    for (std::uint32_t number = 1; number <= 20'000; ++number) keep(store, number);
    ends.store(true);
  }};
  std::size_t seen = 0, mixed = 0;
  while (!ends.load() || seen == 0) {
    const auto held = store.hold(0);
    if (!held) continue;
    ++seen;
    const auto expected = static_cast<std::byte>(held->taken().number);
    if (!std::ranges::all_of(held->pixels(), [&](std::byte pixel) { return pixel == expected; })) ++mixed;
  }
  cycle.join();
  EXPECT_EQ(mixed, 0u);
}

}  // namespace
}  // namespace hirosco::imager
