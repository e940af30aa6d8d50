// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "switch.hpp"

#include <gtest/gtest.h>

#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>

using namespace hirosco;

/// The test plays the supervisor and the lamp.
TEST(Switch, IsDoneWithAPressWhenTheLampIsAndSaysWhyNot) {
  const auto files = descriptor::file_system();
  const auto author = make_switch();
  hirosco::testing::Rig rig{
      *author, hirosco::testing::read_descriptor(files("switch.xml").value(), {files("lamp.xml").value()})};
  rig.bring_to(State::PreOperational);
  std::vector<std::byte> bright(sizeof(double));
  OctetWriter{bright}.put(0.75);

  const auto first = rig.send(201, 1, bright);
  rig.settle();
  ASSERT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(rig.outcome(first), "1 3");
  rig.verify(rig.asked[0], 1);
  rig.verify(rig.asked[0], 7);
  rig.settle();
  EXPECT_EQ(rig.outcome(first), "1 3 7");

  const auto second = rig.send(201, 1, bright);
  rig.settle();
  const std::array wrong_state{std::byte{0}, std::byte{10}, std::byte{4}};
  rig.verify(rig.asked.at(1), 2, wrong_state);
  rig.settle();
  const std::string words = "not permitted in this state";
  EXPECT_NE(rig.outcome(second).find(hirosco::testing::hex(std::as_bytes(std::span{words}))), std::string::npos);
}
