// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// What a persistent parameter begins with each time its subsystem comes from Offline (docs/adr/0087).
namespace hirosco {
namespace {

using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

/// The probe's KD is persistent.
[[nodiscard]] std::string with_persistent_kd() {
  std::string text = probe_descriptor;
  const std::string kd = R"(<ParamRef name="KD" id="3" )";
  return text.insert(text.find(kd) + kd.size(), R"(persistent="yes" )");
}

struct PersistentTest : ::testing::Test {
  Probe probe;
  Rig rig{probe, with_persistent_kd()};
  void set(std::uint8_t id, double value) {
    std::vector<std::byte> data(13);
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, id}.wire()).put(value);
    const auto request = rig.send(20, 3, data);
    rig.settle();
    ASSERT_EQ(rig.outcome(request), "1 3 7");
  }
  void through_offline() {
    ASSERT_EQ(rig.set_state_now(State::Offline), "1 3 7");
    ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  }
};

TEST_F(PersistentTest, BeginsAsItWasLeftAndOthersBeginAsDeclared) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kd.load(), 4.0);
  set(2, 11);
  set(3, 12);
  through_offline();
  EXPECT_EQ(probe.kd.load(), 12.0);
  EXPECT_EQ(probe.kp.load(), 3.0);
  through_offline();
  EXPECT_EQ(probe.kd.load(), 12.0) << "as long as nobody sets it";
}

TEST_F(PersistentTest, BeginsWithWhatAFunctionMadeOfIt) {
  rig.bring_to(State::Operational);
  set(3, 12);
  probe.kd.store(2);
  rig.set_state_now(State::SafeOperational);
  through_offline();
  EXPECT_EQ(probe.kd.load(), 2.0);
}

TEST_F(PersistentTest, WhatCouldNotBeSetIsNotTakenAlong) {
  rig.set_state_now(State::PreOperational);
  set(3, 12);
  through_offline();
  probe.kd.store(100.5);
  through_offline();
  EXPECT_EQ(probe.kd.load(), 12.0);
}

/// Publishes all, and then one that its descriptor does not know.
struct PublishesNobodys : Probe {
  bool mistaken{false};
  Parameter<double> nobodys;
  Result<Step> software_init() override {
    const auto step = Probe::software_init();
    if (mistaken) publish("NOBODYS", nobodys);
    return step;
  }
};

TEST(Persistent, IsNotTakenFromASoftwareInitThatGaveItNoValueYet) {
  PublishesNobodys probe;
  Rig rig{probe, with_persistent_kd()};
  probe.mistaken = true;
  probe.kd.store(0);
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(rig.state(), State::Offline);
  probe.mistaken = false;
  ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_EQ(probe.kd.load(), 4.0);
}

}  // namespace
}  // namespace hirosco
