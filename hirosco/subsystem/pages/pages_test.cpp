// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/pages/pages.hpp"

#include <gtest/gtest.h>

#include <cstring>

/// What decides over actuators survives damage (hazard SF19): every flip of one bit is tried.
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

TEST(CheckedWord, GivesBackWhatItWasMadeOfGivenOrStored) {
  CheckedWord word{0xFFFF};
  EXPECT_EQ(word.load(), 0xFFFFu);
  word = 258;
  EXPECT_EQ(word.load(), 258u);
  word.store(3);
  EXPECT_EQ(word.load(), 3u);
  EXPECT_GT(CheckedWord::damaged, 0xFFFFu) << "larger than every value";
}

TEST(Pages, BeginWithTheirNameAndTheirVersion) {
  EXPECT_EQ(page_magic, std::uint32_t{'H'} << 24 | 'I' << 16 | 'R' << 8 | 'C');
  EXPECT_EQ(VitalPage{}.magic, page_magic);
  EXPECT_EQ(PermitPage{}.magic, page_magic);
  EXPECT_EQ(VitalPage{}.version, page_version);
  EXPECT_EQ(PermitPage{}.version, page_version);
}

TEST(VitalPage, AsItIsMadeTellsOfNothing) {
  const VitalPage page{};
  EXPECT_EQ(page.state.load(), 0u);
  EXPECT_EQ(page.configuration.load(), 0u);
  EXPECT_EQ(page.realtime.load(), 0u);
  EXPECT_EQ(page.cycling.load(), 0u);
  for (const auto* number : {&page.inhibited, &page.seen_epoch, &page.latency_max_ns, &page.execution_max_ns,
                             &page.execution_mean_ns, &page.lost_reports})
    EXPECT_EQ(number->load(), 0u);
  for (const auto* number :
       {&page.period_ns, &page.cycles, &page.service_steps, &page.overruns, &page.missed, &page.inhibited_at_cycle})
    EXPECT_EQ(number->load(), 0u);
  for (const IncomingLink& link : page.incoming)
    for (const auto* number :
         {&link.link, &link.lost, &link.latency_mean_ns, &link.latency_max_ns, &link.jitter_ns, &link.age_us})
      EXPECT_EQ(number->load(), 0u);
  for (const LinkLatencies& link : page.latencies) {
    EXPECT_EQ(link.period_ns.load(), 0u);
    for (const auto& count : link.counts) EXPECT_EQ(count.load(), 0u);
  }
  for (const auto& judged : page.judged) EXPECT_EQ(judged.load(), link_not_judged);
}

TEST(LatencyBin, BoundsDoubleUpToTwoPeriodsAndBelongToTheBinBelow) {
  constexpr Duration period = 640us;
  std::size_t bin = 0;
  for (const Duration bound : {10us, 20us, 40us, 80us, 160us, 320us, 640us, 1280us}) {
    EXPECT_EQ(latency_bin(bound, period), bin) << bin;
    EXPECT_EQ(latency_bin(bound + 1ns, period), ++bin);
  }
  EXPECT_EQ(bin + 1, latency_bins);
  EXPECT_EQ(latency_bin(500us, 500us), latency_bin(640us, period)) << "a period is within itself, divisible or not";
}

TEST(LatencyBin, WhateverAStampSaysIsInOneOfThem) {
  EXPECT_EQ(latency_bin(Duration::max(), 500us), latency_bins - 1);
  EXPECT_EQ(latency_bin(Duration::max(), Duration{0}), latency_bins - 1);
  EXPECT_EQ(latency_bin(Duration::min(), 500us), 0u);
  EXPECT_EQ(latency_bin(Duration{0}, Duration{0}), 0u);
  EXPECT_EQ(latency_bin(1us, Duration::max()), 0u);
}

TEST(VitalPage, HasABitOfItsOwnForEachReasonToInhibit) {
  constexpr std::array reasons{inhibited_by_stop,      inhibited_by_link,    inhibited_by_device,
                               inhibited_by_author,    inhibited_by_failure, inhibited_by_supervisor,
                               inhibited_while_awaited};
  for (std::size_t i = 0; i < reasons.size(); ++i) EXPECT_EQ(reasons[i], 1u << i) << "ground reads them as numbers";
}

TEST(Power, OfThePermitPageIsTheNumberThatOthersKnow) {
  EXPECT_EQ(std::uint32_t{power_off}, 0u) << "as the page of one without switches says from its beginning on";
  EXPECT_EQ(std::uint32_t{power_on}, 1u);
  EXPECT_EQ(std::uint32_t{power_changes}, 2u);
  EXPECT_EQ(std::uint32_t{power_unknown_version}, 3u);
}

TEST(VitalPage, IsOfTheVersionThatDecodersOfOthersKnow) {
  EXPECT_EQ(VitalPage{}.version, 8u) << "tests/endtoend/pages.py";
  EXPECT_EQ(PermitPage{}.version, 8u);
}

/// The finisher of SplitMix64 (Steele, Lea, Flood 2014): its first numbers of the seeds 0 and 1, as others print them.
TEST(PermissionWord, IsTheFirstNumberOfSplitMix64FromTheEpoch) {
  EXPECT_EQ(permission_word(0), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(permission_word(1), 0x910A2DEC89025CC1u);
}

TEST(PermitPage, TellsDisplaysOfAStopAndCountsAnEpochWithEachFenceAndRelease) {
  PermitPage page;
  EXPECT_EQ(page.epoch.load(), 1u);
  EXPECT_EQ(page.stop.load(), 0u);
  EXPECT_EQ(page.mode_epoch.load(), 0u);
  EXPECT_EQ(page.heartbeat.load(), 0u);
  EXPECT_EQ(page.stopped_at_cycle.load(), 0u);
  page.fence();
  EXPECT_EQ(page.epoch.load(), 2u);
  EXPECT_EQ(page.stop.load(), 1u);
  EXPECT_EQ(page.go.load(), 0u);
  page.release();
  EXPECT_EQ(page.epoch.load(), 3u);
  EXPECT_EQ(page.stop.load(), 0u);
  EXPECT_EQ(page.go.load(), permission_word(3));
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
