// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// A running function whose author tells of a step that failed: TM[1,6], and it goes on.
namespace hirosco {
namespace {

using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::SizeIs;

struct FailedSteps : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
};

TEST_F(FailedSteps, AreToldWithTheReasonAndTheFunctionGoesOn) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE");
  rig.settle();
  probe.failed_step_due = 2;
  rig.settle();
  const auto told = rig.reports(1, 6);
  ASSERT_THAT(told, SizeIs(1));
  // Request, step, "device unavailable", then the author's words and number.
  EXPECT_EQ(told[0].substr(8, 4), "0002");
  EXPECT_THAT(told[0], ::testing::EndsWith("776574"));
  EXPECT_THAT(told[0], ::testing::HasSubstr("000000000000002a"));
  probe.step_due = 3;
  rig.settle();
  EXPECT_THAT(rig.reports(1, 5), SizeIs(1)) << "it runs";
  probe.finish_due = true;
  rig.settle();
  EXPECT_TRUE(rig.outcome(request).ends_with(" 7")) << rig.outcome(request);
}

TEST_F(FailedSteps, OfWhatHasEndedAreToldToNobody) {
  rig.bring_to(State::Operational);
  static_cast<void>(rig.call("MOVE"));
  rig.settle();
  const Call ended = probe.move.value();
  probe.finish_due = true;
  rig.settle();
  probe.finish_due = false;
  probe.move = ended;
  probe.failed_step_due = 1;
  rig.settle();
  EXPECT_THAT(rig.reports(1, 6), SizeIs(0));
}

}  // namespace
}  // namespace hirosco
