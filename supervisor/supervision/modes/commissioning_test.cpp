// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/commissioning.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

struct CommissioningTest : PartsTest {
  PlayedDesk desk;
  Commissioning commissioning{means_with(desk)};
  int failures{0};
  void start() {
    start_all(Offline);
    auto& mode = craft.mission.modes.front();
    mode.commission = {{.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}},
                       {.subsystem = "CAMERA", .configuration = "ONLY", .state = SafeOperational, .at = {}}};
    mode.establish = {1};
    commissioning.start([this] { ++failures; });
  }
  /// As the mode wants them.
  void all_are_there() {
    set(arm, Operational, 2);
    set(camera, SafeOperational);
    parts.graph.set_up(1, true);
  }
  void answer_all() {
    while (!desk.answers.empty()) desk.answer(true);
  }
};

TEST_F(CommissioningTest, TheSupervisorComesFirstThenAllMembersStageByStageThenTheMode) {
  start();
  for (unsigned own = 0; own < 4; ++own) {
    EXPECT_EQ(desk.sent.size(), own + 1);
    desk.answer(true);
  }
  all_are_there();
  answer_all();
  desk.sent.erase(desk.sent.begin(), desk.sent.begin() + 4);
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 3", "12 SET_STATE 3", "10 CONFIGURE 2", "12 CONFIGURE 1", "1 LINK 1",
                                     "10 SET_STATE 4", "12 SET_STATE 4", "10 SET_STATE 5", "1 ENTER_MODE 1"));
  EXPECT_TRUE(commissioning.succeeded());
  EXPECT_TRUE(was_told("commissioned: mode open"));
  EXPECT_FALSE(craft.failed());
}

TEST_F(CommissioningTest, WhoWasTakenDownAfterItsOwnStepIsMissed) {
  start();
  all_are_there();
  set(camera, ErrorOperational);
  answer_all();
  EXPECT_FALSE(commissioning.succeeded());
  EXPECT_TRUE(was_told("commissioning stopped: CAMERA is not SafeOperational"));
  EXPECT_TRUE(craft.failed());
}

TEST_F(CommissioningTest, WhoIsInAnotherConfigurationOrHasLostItsLinkAgainIsMissedToo) {
  start();
  all_are_there();
  set(arm, Operational, 1);
  parts.graph.set_up(1, false);
  answer_all();
  EXPECT_FALSE(commissioning.succeeded());
  EXPECT_TRUE(was_told("commissioning stopped: ARM is not in configuration COUPLED; link 1 is not up"));
}

TEST_F(CommissioningTest, AMemberThatFailsEndsIt) {
  start();
  for (int own = 0; own < 4; ++own) desk.answer(true);
  desk.answer(false, "no hardware");
  answer_all();
  EXPECT_FALSE(commissioning.running());
  EXPECT_TRUE(was_told("no hardware"));
  EXPECT_TRUE(craft.failed());
  EXPECT_EQ(failures, 0) << "the others can be commanded";
}

TEST_F(CommissioningTest, ASelfTestThatFailsEndsItWithItsReasonBeforeAnybodyIsOperational) {
  craft.mission.subsystems.front().subsystem.configurations.front().self_test = descriptor::SelfTest::Required;
  start();
  while (!desk.answers.empty() && desk.sent.back() != "10 TC[17,128] 10000 ms") desk.answer(true);
  ASSERT_EQ(desk.sent.back(), "10 TC[17,128] 10000 ms");
  EXPECT_EQ(commissioning.waiting_for(), "ARM: self test");
  desk.answer(false, "execution error: torque of joint has the wrong sign 2");
  EXPECT_FALSE(commissioning.running());
  EXPECT_TRUE(was_told("commissioning stopped: ARM self test: execution error: torque of joint has the wrong sign 2"));
  EXPECT_TRUE(craft.failed());
  EXPECT_EQ(std::ranges::count(desk.sent, "10 SET_STATE 5"), 0);
}

TEST_F(CommissioningTest, ASupervisorThatCannotStartEndsTheFlight) {
  start();
  desk.answer(false, "no memory");
  EXPECT_EQ(failures, 1);
  EXPECT_TRUE(was_told("supervisor cannot start: "));
}

TEST_F(CommissioningTest, ItIsCancelledOnceWithAReasonAndNotDuringTheShutdown) {
  start();
  EXPECT_EQ(commissioning.cancel("SAFE_ALL"), Cancelled::ForGood);
  EXPECT_TRUE(was_told("commissioning stopped: SAFE_ALL"));
  EXPECT_EQ(commissioning.cancel("SAFE_ALL"), Cancelled::Nothing);
  start();
  craft.shutting_down = true;
  EXPECT_EQ(commissioning.cancel("plan"), Cancelled::Nothing);
  EXPECT_TRUE(commissioning.running());
  commissioning.drop();
  EXPECT_FALSE(commissioning.running());
}

}  // namespace
}  // namespace hirosco::supervisor
