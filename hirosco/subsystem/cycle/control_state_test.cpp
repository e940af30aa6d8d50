// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/control_state.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

TEST(ControlState, IsActiveInOperationalAloneAndOnlyWithoutAReason) {
  ControlState control;
  for (const State state : {State::PreOperational, State::SafeOperational, State::ErrorOperational}) {
    control.enter(state);
    EXPECT_FALSE(control.active()) << to_text(state);
    EXPECT_EQ(control.controlling(), state == State::SafeOperational) << to_text(state);
    EXPECT_EQ(control.state(), state);
  }
  control.enter(State::Operational);
  EXPECT_TRUE(control.active());
  EXPECT_TRUE(control.controlling());
  control.inhibit(inhibited_by_author);
  EXPECT_FALSE(control.active());
  EXPECT_TRUE(control.controlling()) << "it goes on to look at what it has lost";
}

TEST(ControlState, KeepsEachReasonThroughStatesUntilItIsCleared) {
  ControlState control;
  control.enter(State::Operational);
  control.inhibit(inhibited_by_stop);
  control.inhibit(inhibited_by_link);
  EXPECT_FALSE(control.failed());
  control.inhibit(inhibited_by_failure);
  control.enter(State::SafeOperational);
  EXPECT_EQ(control.inhibited(), inhibited_by_stop | inhibited_by_link | inhibited_by_failure);
  EXPECT_TRUE(control.failed());
  control.clear();
  EXPECT_EQ(control.inhibited(), 0u);
  EXPECT_FALSE(control.failed());
  EXPECT_EQ(control.state(), State::SafeOperational);
}

TEST(ControlState, WhatIsAwaitedPassesByItselfAndNothingElse) {
  ControlState control;
  control.inhibit(inhibited_while_awaited);
  control.inhibit(inhibited_by_device);
  control.clear_awaited();
  EXPECT_EQ(control.inhibited(), static_cast<std::uint32_t>(inhibited_by_device));
}

TEST(ControlState, BeginsInPreOperationalWithoutAReason) {
  ControlState control;
  control.enter(State::Operational);
  control.inhibit(inhibited_by_supervisor);
  control.begin();
  EXPECT_EQ(control.state(), State::PreOperational);
  EXPECT_EQ(control.inhibited(), 0u);
}

}  // namespace
}  // namespace hirosco
