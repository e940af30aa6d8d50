// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What the ten states promise, shown by a subsystem that does its best to break it (docs/paper_map.md, S2).
#include <set>

#include <gtest/gtest.h>

#include "tests/integration/greedy.hpp"

namespace hirosco::testing {
namespace {

using descriptor::State;

class TenStates : public ::testing::Test {
 protected:
  void go(State state) {
    const auto outcome = flight.set_state("GREEDY", state);
    ASSERT_TRUE(outcome.completed) << to_text(state) << ": "
                                   << (outcome.failure ? to_text(*outcome.failure) : "no answer");
    ASSERT_EQ(flight.state("GREEDY"), state);
  }
  /// All that a spacecraft can do with a subsystem, each state for a while.
  void visit_all_states() {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    flight.craft().run(50ms);
    for (const State state : {State::SafeOperational, State::Operational, State::ErrorOperational,
                              State::PostOperational, State::Offline, State::PreOperational}) {
      go(state);
      flight.craft().run(50ms);
    }
    ASSERT_TRUE(flight.configure("GREEDY", "NOMINAL").completed);
    for (const State state : {State::SafeOperational, State::PostOperational, State::Offline}) {
      flight.craft().run(50ms);
      go(state);
    }
    flight.craft().run(50ms);
  }

  GreedyTrace trace;
  Flight flight{greedy_plan(trace)};
};

TEST_F(TenStates, TheMotorHearsTheSafeValueInAllStatesButOperational) {
  std::array<int, 10> frames{};
  flight.craft().on_cycle([&](std::string_view subsystem, TimePoint) {
    if (subsystem != "GREEDY" || trace.frames.empty()) return;
    const GreedyTrace::Frame last = trace.frames.back();
    ++frames[static_cast<std::size_t>(trace.node)];
    if (trace.node == State::Operational) {
      EXPECT_EQ(last.torque, greedy_torque);
      EXPECT_EQ(last.mode, DeviceMode::Active);
    } else {
      EXPECT_EQ(last.torque, greedy_safe_torque) << to_text(trace.node);
      EXPECT_EQ(last.mode, trace.node == State::ErrorOperational ? DeviceMode::Stop : DeviceMode::Off)
          << to_text(trace.node);
    }
  });
  visit_all_states();
  for (std::size_t state = 0; state < 10; ++state) {
    EXPECT_GT(trace.node_runs[state], 0) << "never was in " << to_text(static_cast<State>(state));
    if (is_cyclic(static_cast<State>(state))) {
      EXPECT_GT(frames[state], 30) << to_text(static_cast<State>(state));
    }
  }
  // Nobody looked between cycles: the sum over all frames must tell the same.
  for (const auto& frame : trace.frames) EXPECT_EQ(frame.torque == greedy_torque, frame.mode == DeviceMode::Active);
}

TEST_F(TenStates, NoFrameReachesTheMotorWithoutACycle) {
  ASSERT_TRUE(flight.commission());
  for (const State state : {State::SafeOperational, State::PostOperational, State::Offline}) {
    go(state);
    if (state == State::SafeOperational) continue;
    const auto before = trace.frames.size();
    const auto cycles = flight.cycles("GREEDY");
    flight.craft().run(100ms);
    EXPECT_EQ(trace.frames.size(), before) << to_text(state);
    EXPECT_EQ(flight.cycles("GREEDY"), cycles) << to_text(state);
  }
}

TEST_F(TenStates, HousekeepingComesFromPreOperationalOnOnly) {
  std::array<int, 10> reports{};
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.apid() == 20 && packet.service() == 3) ++reports[static_cast<std::size_t>(flight.state("GREEDY"))];
  };
  visit_all_states();
  for (std::size_t state = 0; state < 10; ++state) {
    const bool expected = is_cyclic(static_cast<State>(state));
    EXPECT_EQ(reports[state] > 0, expected) << to_text(static_cast<State>(state)) << ": " << reports[state];
  }
}

TEST_F(TenStates, OfflineHoldsNoDevice) {
  ASSERT_TRUE(flight.commission());
  flight.craft().run(20ms);
  EXPECT_TRUE(trace.flow_open);
  ASSERT_NO_FATAL_FAILURE(go(State::SafeOperational));
  ASSERT_NO_FATAL_FAILURE(go(State::PostOperational));
  flight.craft().run(20ms);
  EXPECT_FALSE(trace.flow_open) << "Post-Operational gives the device back";
  ASSERT_NO_FATAL_FAILURE(go(State::Offline));
  flight.craft().run(20ms);
  EXPECT_FALSE(trace.flow_open);
  EXPECT_EQ(flight.craft().vital("GREEDY")->cycling.load(), 0u);
  EXPECT_EQ(flight.craft().vital("GREEDY")->configuration.load(), 0u);
}

TEST(TenStatesOfANetwork, OfflineHoldsNoLink) {
  Flight flight{{}};
  ASSERT_TRUE(flight.commission());
  ASSERT_EQ(flight.craft().supervisor().links().up_count(), 2u);
  for (const State state : {State::SafeOperational, State::PostOperational, State::Offline})
    ASSERT_TRUE(flight.set_state("JOYSTICK", state).completed) << to_text(state);
  flight.craft().run(20ms);
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 0u) << "of both its links one end is gone";
  EXPECT_TRUE(flight.story().has("link 1 MANIPULATOR.ROBOT_STATE -> JOYSTICK down: detached by 11"));
  EXPECT_TRUE(flight.story().has("link 2 JOYSTICK.JOYSTICK_STATE -> MANIPULATOR down: detached by 11"));
}

TEST_F(TenStates, OnlyEdgesOfTheTableAreTaken) {
  ASSERT_TRUE(flight.commission());
  // From Operational neither down past Safe-Operational nor into a transient state.
  for (const State state : {State::Operational, State::PreOperational, State::PostOperational, State::Offline,
                            State::SoftwareInit, State::HardwareDeinit}) {
    const auto outcome = flight.set_state("GREEDY", state);
    EXPECT_FALSE(outcome.completed) << to_text(state);
    EXPECT_EQ(outcome.failure, pus::FailureCode::WrongState) << to_text(state);
    EXPECT_EQ(flight.state("GREEDY"), State::Operational);
  }
}

}  // namespace
}  // namespace hirosco::testing
