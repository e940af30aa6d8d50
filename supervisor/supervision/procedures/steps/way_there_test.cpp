// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/way_there.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

struct WayThereTest : PartsTest {
  PlayedDesk desk;
  WayThere way;
  const descriptor::SubsystemDescriptor& subsystem = craft.mission.subsystems.front().subsystem;
  const descriptor::Configuration& coupled = subsystem.configurations.front();

  std::vector<std::string> commands() {
    desk.at_once = true;
    ProcedureRunner runner{means_with(desk)};
    runner.start({.stages = way.stages()});
    return desk.sent;
  }
};

TEST_F(WayThereTest, FromOfflineItGoesThroughEachStateInItsOrder) {
  way.add(subsystem, coupled, {Offline}, Operational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 3", "10 CONFIGURE 2", "10 SET_STATE 4", "10 SET_STATE 5"));
}

TEST_F(WayThereTest, ItEndsWhereTheModeWantsIt) {
  way.add(subsystem, coupled, {Offline}, PreOperational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 3", "10 CONFIGURE 2"));
}

TEST_F(WayThereTest, WhatIsThereAlreadyIsLeftOut) {
  way.add(subsystem, coupled, {PreOperational}, SafeOperational);
  EXPECT_THAT(commands(), ElementsAre("10 CONFIGURE 2", "10 SET_STATE 4"));
}

TEST_F(WayThereTest, FromErrorOperationalItLeadsThroughPostOperational) {
  way.add(subsystem, coupled, {ErrorOperational}, SafeOperational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 7", "10 SET_STATE 3", "10 CONFIGURE 2", "10 SET_STATE 4"));
}

TEST_F(WayThereTest, TheSelfTestThatAConfigurationRequiresIsRunBehindSafeOperational) {
  descriptor::Configuration wary = coupled;
  wary.self_test = descriptor::SelfTest::Required;
  way.add(subsystem, wary, {Offline}, Operational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 3", "10 CONFIGURE 2", "10 SET_STATE 4", "10 TC[17,128] 10000 ms",
                                      "10 SET_STATE 5"))
      << "10 s is what its configuration gives it";
}

TEST_F(WayThereTest, ItIsNotRunWhereNothingWaitsForIt) {
  descriptor::Configuration wary = coupled;
  wary.self_test = descriptor::SelfTest::Required;
  way.add(subsystem, wary, {Offline}, SafeOperational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 3", "10 CONFIGURE 2", "10 SET_STATE 4"));
}

TEST_F(WayThereTest, LinksAreMadeBetweenPreOperationalAndSafeOperationalAndTheModeComesLast) {
  way.enter(craft.mission.modes.front());
  way.link(1);
  way.add(subsystem, coupled, {Offline}, SafeOperational);
  EXPECT_THAT(commands(),
              ElementsAre("10 SET_STATE 3", "10 CONFIGURE 2", "1 LINK 1", "10 SET_STATE 4", "1 ENTER_MODE 1"));
}

TEST_F(WayThereTest, WhatAConfigurationHoldsIsGivenBackOnTheWayToThatOrAnother) {
  way.add(subsystem, coupled, {PreOperational, 1}, SafeOperational);
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 7", "10 SET_STATE 3", "10 CONFIGURE 2", "10 SET_STATE 4"));
}

TEST_F(WayThereTest, WhoControlsStopsBeforeAnybodyGivesItsLinksBack) {
  const descriptor::SubsystemDescriptor& other = craft.mission.subsystems[1].subsystem;
  way.add(subsystem, coupled, {Operational}, Operational);
  way.down(other, {Operational});
  EXPECT_THAT(commands(), ElementsAre("10 SET_STATE 4", "11 SET_STATE 4", "10 SET_STATE 3", "11 SET_STATE 0",
                                      "10 CONFIGURE 2", "10 SET_STATE 4", "10 SET_STATE 5"));
}

}  // namespace
}  // namespace hirosco::supervisor
