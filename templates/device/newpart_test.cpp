// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "newpart.hpp"

#include <gtest/gtest.h>

#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>

#include "newpart_device.hpp"

using namespace hirosco;

/// The test plays the supervisor and the clock; the device is the simulated one, on the rig's flows. It has no enable endnode here: the
/// supervisor's side would hold it.
struct NewPartTest : ::testing::Test {
  NewPartTest() {
    if (!plate.plug()) ADD_FAILURE() << "it cannot be plugged in";
  }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      plate.step(rig.clock.now());
    }
    rig.service();
  }
  /// Sends, and what became of it.
  std::string go(State state) {
    const auto request = rig.set_state(state);
    cycles(10);
    return rig.outcome(request);
  }
  void bring_to_operational() {
    rig.bring_to(State::PreOperational);
    cycles(5);
    ASSERT_EQ(go(State::SafeOperational), "1 3 7");
    ASSERT_EQ(go(State::Operational), "1 3 7");
  }

  std::unique_ptr<Subsystem> newpart = make_newpart();
  hirosco::testing::Rig rig{*newpart, descriptor::file_system()("newpart.xml").value()};
  NewPartDevice plate{rig.flows, {Transfer::SharedMemory, "newpart"}, {.cycle = 1ms, .actuator = true}};
};

TEST_F(NewPartTest, HeatsThePlateOnlyInOperational) {
  rig.bring_to(State::PreOperational);
  cycles(5);
  ASSERT_EQ(go(State::SafeOperational), "1 3 7");
  EXPECT_FALSE(plate.active());
  ASSERT_EQ(go(State::Operational), "1 3 7");
  EXPECT_TRUE(plate.active());
}

/// A lost device inhibits at once and is told; the state stays: who goes on from there is the supervisor, by the mission's plans.
TEST_F(NewPartTest, LetsGoWhenItsDeviceIsLost) {
  bring_to_operational();
  EXPECT_EQ(rig.inhibited(), 0U);
  ASSERT_TRUE(plate.fault("unplug"));
  cycles(10);
  EXPECT_NE(rig.inhibited(), 0U);
  EXPECT_EQ(rig.state(), State::Operational);
}
