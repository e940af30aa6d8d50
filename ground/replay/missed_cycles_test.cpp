// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/missed_cycles.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "ground/replay/story.hpp"
#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using testing::opening;

class MissedCycles : public testing::ArchiveOfAWorkshop {
 protected:
  /// As the supervisor tells it of DRILL.
  void missed(double cycles, OnboardTime t) {
    hears(testing::overview(catalogue, {.more = {{"SUPERVISOR.SUBSYSTEMS.MISSED[1]", cycles}}}, t));
  }
  void loses_spindle(OnboardTime t) {
    hears(testing::event_packet(catalogue, "DRILL", "SPINDLE_A_LOST", t,
                                testing::in_octets(static_cast<std::uint8_t>(descriptor::DeviceLoss::Silent),
                                                   std::uint32_t{3}, std::uint32_t{0}, std::uint32_t{0})));
  }
  [[nodiscard]] std::string advice() { return newest_story(catalogue, *archive, OnboardTime::max())["advice"]; }
};

TEST_F(MissedCycles, AreThoseOfTheSecondBeforeAndOfNobodyElse) {
  missed(5, opening - 1500ms);
  missed(40, opening + 200ms);
  EXPECT_EQ(missed_around(catalogue, *archive, "DRILL", opening), 35U);
  EXPECT_EQ(missed_around(catalogue, *archive, "LAMP", opening), 0U);
  EXPECT_EQ(missed_around(catalogue, *archive, "DRILL", opening + 5s), 0U) << "none since";
  EXPECT_EQ(missed_around(catalogue, *archive, "DRILL", opening - 1h), 0U) << "nothing was told yet";
}

TEST_F(MissedCycles, AreNamedInTheStoryOfADeviceThatWasLostAndWhatToDoIsNotToMendIt) {
  missed(5, opening - 1500ms);
  loses_spindle(opening);
  missed(40, opening + 200ms);
  EXPECT_EQ(advice(),
            "Less other work, or real-time rights (hirosco doctor), as 35 cycles were missed; the device SPINDLE.A may "
            "be well. Then bring work up.");
  const auto story = newest_story(catalogue, *archive, OnboardTime::max());
  EXPECT_EQ(story["causes"][0]["text"], "DRILL missed 35 cycles around it");
}

TEST_F(MissedCycles, WhereNoneIsMissedTheDeviceIsToBeMended) {
  missed(5, opening - 1500ms);
  loses_spindle(opening);
  missed(5, opening + 200ms);
  EXPECT_EQ(advice(), "Mend or plug in the device SPINDLE.A, then bring work up.");
}

}  // namespace
}  // namespace hirosco::ground
