// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hirosco::pus::st129 {
namespace {

ModePreview small() { return {.mode = 3, .against = {"ARM is down"}, .steps = {{1, 10, "Pre"}, {2, 258, ""}}}; }

TEST(ModePreview, StandsAsItsShapeSaysOctetByOctet) {
  std::vector<std::byte> buffer(max_preview_octets);
  const Octets written = write_mode_preview(buffer, small());
  std::vector<int> octets;
  for (const std::byte each : written) octets.push_back(std::to_integer<int>(each));
  const std::vector<int> expected{3,   1, 11, 'A', 'R', 'M', ' ', 'i', 's', ' ', 'd', 'o', 'w',
                                  'n', 2, 1,  0,   10,  3,   'P', 'r', 'e', 2,   1,   2,   0};
  EXPECT_EQ(octets, expected);
}

TEST(ModePreview, IsReadAsItWasWrittenAndNothingElseIs) {
  std::vector<std::byte> buffer(max_preview_octets);
  const Octets written = write_mode_preview(buffer, small());
  const auto read = read_mode_preview(written);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, 3);
  EXPECT_EQ(read->against, small().against);
  ASSERT_EQ(read->steps.size(), 2U);
  EXPECT_EQ(read->steps[0].what, "Pre");
  EXPECT_EQ(read->steps[1].subject, 258);
  for (std::size_t octets = 0; octets < written.size(); ++octets)
    EXPECT_FALSE(read_mode_preview(written.first(octets))) << octets;
  std::vector<std::byte> longer{written.begin(), written.end()};
  longer.push_back(std::byte{0});
  EXPECT_FALSE(read_mode_preview(longer));
}

TEST(ModePreview, StepsThatFindNoRoomAreLeftOutAndNotCountedReasonsStay) {
  ModePreview preview = small();
  preview.steps.assign(300, {1, 10, std::string(100, 'x')});
  std::vector<std::byte> buffer(max_preview_octets);
  const auto read = read_mode_preview(write_mode_preview(buffer, preview));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->against.size(), 1U);
  EXPECT_EQ(read->steps.size(), (max_preview_octets - 15) / 104);
  preview.steps.assign(300, {1, 10, ""});
  EXPECT_EQ(read_mode_preview(write_mode_preview(buffer, preview))->steps.size(), 255U);
}

}  // namespace
}  // namespace hirosco::pus::st129
