// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/pages.hpp"

#include <gtest/gtest.h>

#include <cstring>

/// What decides over actuators survives damage (reliability 5, SF19): every flip of one bit is tried.
namespace hirosco {
namespace {

TEST(CheckedWord, NoFlipOfABitTurnsOneValueIntoAnother) {
  for (std::uint32_t value = 0; value < 300; ++value) {
    for (unsigned bit = 0; bit < 32; ++bit) {
      CheckedWord word{value};
      std::uint32_t raw;
      std::memcpy(&raw, &word, sizeof raw);
      raw ^= 1U << bit;
      std::memcpy(static_cast<void*>(&word), &raw, sizeof raw);
      EXPECT_EQ(word.load(), CheckedWord::damaged);
    }
  }
}

TEST(PermitPage, AsItIsMadeAndAfterAFencePermitsNothingWhateverBitFlips) {
  for (const bool fenced : {false, true}) {
    for (std::size_t bit = 0; bit < sizeof(PermitPage) * 8; ++bit) {
      PermitPage page;
      if (fenced) {
        page.release();
        page.fence();
      }
      reinterpret_cast<unsigned char*>(&page)[bit / 8] ^= static_cast<unsigned char>(1U << bit % 8);
      EXPECT_FALSE(page.permits(page.epoch.load())) << bit;
    }
  }
}

TEST(PermitPage, AReleaseHoldsForItsOwnEpochOnly) {
  PermitPage page;
  page.release();
  const std::uint32_t epoch = page.epoch.load();
  EXPECT_TRUE(page.permits(epoch));
  for (unsigned bit = 0; bit < 32; ++bit) EXPECT_FALSE(page.permits(epoch ^ 1U << bit)) << bit;
  page.fence();
  EXPECT_FALSE(page.permits(epoch));
  EXPECT_FALSE(page.permits(page.epoch.load()));
}

}  // namespace
}  // namespace hirosco
