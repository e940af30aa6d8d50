// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "newpart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>

using namespace hirosco;

/// The test plays the supervisor and the clock.
TEST(NewPart, GoesToWhereItIsToldAndSaysWhenItIsThere) {
  const auto newpart = make_newpart();
  hirosco::testing::Rig rig{*newpart, descriptor::file_system()("newpart.xml").value()};
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
    }
    rig.service();
  };
  const auto do_now = [&](const hirosco::testing::Sent& request) {
    cycles(5);
    return rig.outcome(request);
  };
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(do_now(rig.set_state(State::SafeOperational)), "1 3 7");
  EXPECT_EQ(do_now(rig.set_state(State::Operational)), "1 3 7");
  const auto request = rig.call("GO_TO", {0.5});
  cycles(400);
  EXPECT_EQ(rig.outcome(request), "1 3") << "it takes half a second";
  cycles(200);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  const auto told = rig.reports(5, 1);
  EXPECT_EQ(std::ranges::count(told, "13893fe0000000000000"), 1) << "event 5001 with the value 0.5, once";
  EXPECT_EQ(do_now(rig.set("RATE", 10)), "1 3 7")
      << "a parameter, by its name, as `hirosco tc newpart SET:RATE 10` does";
  const auto faster = rig.call("GO_TO", {1.5});
  cycles(150);
  EXPECT_EQ(rig.outcome(faster), "1 3 7") << "it takes a tenth of a second";
}
