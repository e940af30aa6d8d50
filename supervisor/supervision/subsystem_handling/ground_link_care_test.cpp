// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/ground_link_care.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct GroundLinkCareTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    craft.mission.modes.front().commission = {
        {.subsystem = "CAMERA", .configuration = "ONLY", .state = Operational, .at = {}}};
    start_all(Operational);
  }
  /// The supervisor looks every 10 ms.
  void look_for(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; wait(10ms)) parts.ground_link.watch(clock.now());
  }
};

TEST_F(GroundLinkCareTest, OneThatHearsTheGroundIsLeftAlone) {
  look_for(5s);
  EXPECT_THAT(texts(camera), IsEmpty());
}

TEST_F(GroundLinkCareTest, AfterASecondInOfflineItIsBroughtBackToWhatItsModeAsksFor) {
  set(camera, Offline);
  look_for(1s);
  EXPECT_THAT(texts(camera), IsEmpty());
  look_for(20ms);
  const auto first = received(camera);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].text, to(PreOperational));
  EXPECT_TRUE(craft.restoring_ground_link);
  set(camera, PreOperational);
  verify(camera, first[0].request, 7);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1"));
}

TEST_F(GroundLinkCareTest, WithoutAConfigurationItIsDeafInWhateverState) {
  set(camera, PreOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1")) << "it is in Pre-Operational already";
}

TEST_F(GroundLinkCareTest, FromErrorOperationalTheWayGoesThroughPostOperational) {
  set(camera, ErrorOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre(to(PostOperational)));
}

TEST_F(GroundLinkCareTest, EachVainAttemptIsFollowedByTwiceThePauseTenSecondsAtMost) {
  set(camera, Offline);
  for (const Duration pause : {1s, 2s, 4s, 8s, 10s, 10s}) {
    look_for(pause - 50ms);
    EXPECT_THAT(texts(camera), IsEmpty()) << seconds(pause);
    look_for(100ms);
    const auto sent = received(camera);
    ASSERT_EQ(sent.size(), 1U) << seconds(pause);
    verify(camera, sent[0].request, 2, pus::FailureCode::WrongState);
    EXPECT_FALSE(craft.restoring_ground_link);
    wait(-50ms);
  }
  EXPECT_TRUE(was_told("the ground link did not come back"));
}

TEST_F(GroundLinkCareTest, NobodyCaresForItDuringTheShutdownOrAfterItsDeath) {
  set(camera, Offline);
  craft.shutting_down = true;
  look_for(2s);
  craft.shutting_down = false;
  craft.member(camera)->died();
  look_for(2s);
  EXPECT_FALSE(craft.restoring_ground_link);
}

TEST_F(GroundLinkCareTest, WithLinksDownThatItsConfigurationRequiresItComesBackWithOneThatRequiresNone) {
  auto& subsystem = craft.mission.subsystems[2].subsystem;
  descriptor::Configuration remote;
  remote.name = "REMOTE";
  remote.id = 7;
  descriptor::Requires wanted;
  wanted.name = "HAND_STATE";
  remote.requires_ = {wanted};
  subsystem.configurations.insert(subsystem.configurations.begin(), remote);
  craft.mission.modes.front().commission.front().configuration = "REMOTE";
  set(camera, PreOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1"));
}

}  // namespace
}  // namespace hirosco::supervisor
