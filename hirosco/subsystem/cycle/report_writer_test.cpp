// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/report_writer.hpp"

#include <gtest/gtest.h>

#include <vector>

/// Who gets the room of a ring that fills.
namespace hirosco {
namespace {

struct ReportsOfACycle : ::testing::Test {
  std::vector<descriptor::Event> events;
  LoopRings rings;
  ReportWriter writer{events, rings};
};

TEST_F(ReportsOfACycle, ProgressWithoutEndTakesHalfOfTheRoomAndLeavesTheOtherToAnswers) {
  writer.report(ReportKind::Progressed, 1, {});
  const std::size_t each = rings.answers.used(), half = rings.answers.capacity() / 2;
  writer.fail_step(1, pus::FailureCode::ExecutionError, {}, {ErrorCode::Timeout, "not there yet"});
  ASSERT_NE((half - rings.answers.used()) % each, 0U) << "the next ones do not end at the half by chance";
  for (std::size_t steps = 1; steps <= 2 * half / each; ++steps) writer.report(ReportKind::Progressed, 2, {});
  EXPECT_GT(rings.lost_progress.load(), 0U);
  EXPECT_GT(rings.answers.used(), half - each);
  EXPECT_LE(rings.answers.used(), half + each);
  for (std::size_t answers = 0; answers < half / each - 1; ++answers) writer.report(ReportKind::Finished, 0, {});
  EXPECT_EQ(rings.answers.dropped(), 0U) << "who waits for an end hears of it";
}

}  // namespace
}  // namespace hirosco
