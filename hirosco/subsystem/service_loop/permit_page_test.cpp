// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <new>
#include <optional>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// A supervisor that goes on for one that died hands over a permit page of its own (docs/adr/0093).
namespace hirosco {
namespace {

using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

enum class Sealed { Yes, No };

struct PagesOfSupervisors : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};

  /// The page of the next supervisor: permitted under `epoch`, or not.
  PermitPage& hand_over(std::uint32_t epoch, bool permitted, Sealed sealed = Sealed::Yes,
                        std::size_t octets = sizeof(PermitPage)) {
    const auto memory = rig.memory.create("permit", octets).value();
    pages.push_back(rig.memory.map(memory, Access::ReadWrite).value());
    auto& page = *::new (pages.back().octets.data()) PermitPage;
    page.epoch.store(epoch);
    if (permitted) page.go.store(permission_word(epoch));
    if (sealed == Sealed::Yes) {
      EXPECT_TRUE(rig.memory.seal_writers(memory));
    }
    EXPECT_TRUE(rig.channels.supervisor_end().send({.kind = MessageKind::PermitPage, .memory = memory}));
    return page;
  }
  /// It says that it looks at the page that it was handed.
  [[nodiscard]] bool says_so() {
    MessageBuffer buffer;
    while (const auto found = rig.channels.supervisor_end().receive(buffer)) {
      if (found->flow == Flow::None) return false;
      if (found->message.kind == MessageKind::PermitPage) return true;
    }
    return false;
  }
  void step() { static_cast<void>(rig.subsystem.service_step(rig.clock.now())); }
  [[nodiscard]] std::uint32_t epoch() const { return rig.permit.epoch.load(); }

  std::vector<Mapping> pages;
};

TEST_F(PagesOfSupervisors, WhatThePageBeforePermittedGoesOnUnderTheSameEpoch) {
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;
  PermitPage& page = hand_over(epoch(), true);
  step();
  EXPECT_FALSE(says_so()) << "the cycle has not looked";
  rig.cycle();
  step();
  EXPECT_TRUE(says_so());
  EXPECT_EQ(rig.inhibited(), 0u);
  EXPECT_TRUE(probe.last.active);
  page.fence();
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop) << "it is this page that counts";
}

TEST_F(PagesOfSupervisors, ThePageBeforeCountsNoMore) {
  rig.bring_to(State::Operational);
  static_cast<void>(hand_over(epoch(), true));
  step();
  rig.cycle();
  rig.permit.fence();
  rig.cycle(3);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(PagesOfSupervisors, UnderAnyOtherEpochOrWithoutAPermissionNothingGoesOn) {
  for (const auto& [raised, permitted] : {std::pair{0u, false}, {1u, true}, {1u, false}}) {
    Probe another;
    Rig fresh{another, probe_descriptor};
    fresh.bring_to(State::Operational);
    const auto memory = fresh.memory.create("permit", sizeof(PermitPage)).value();
    const auto mapped = fresh.memory.map(memory, Access::ReadWrite).value();
    auto& page = *::new (mapped.octets.data()) PermitPage;
    page.epoch.store(fresh.permit.epoch.load() + raised);
    if (permitted) page.go.store(permission_word(page.epoch.load()));
    ASSERT_TRUE(fresh.memory.seal_writers(memory));
    ASSERT_TRUE(fresh.channels.supervisor_end().send({.kind = MessageKind::PermitPage, .memory = memory}));
    static_cast<void>(fresh.subsystem.service_step(fresh.clock.now()));
    fresh.cycle();
    EXPECT_EQ(fresh.inhibited(), inhibited_by_stop) << raised << permitted;
    EXPECT_FALSE(another.last.active);
  }
}

TEST_F(PagesOfSupervisors, WhoIsInhibitedStaysSoWhateverTheNewPagePermits) {
  rig.bring_to(State::Operational);
  const auto before = epoch();
  rig.permit.fence();
  rig.cycle();
  static_cast<void>(hand_over(before, true));
  step();
  rig.cycle(3);
  EXPECT_NE(rig.inhibited(), 0u);
}

TEST_F(PagesOfSupervisors, ItsHeartbeatIsTheSignOfLifeFromThenOn) {
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;
  const auto limit = static_cast<int>(2s / rig.subsystem.cycle_demand().period);
  rig.cycle(limit - 10);
  PermitPage& page = hand_over(epoch(), true);
  page.heartbeat.store(1000);
  step();
  rig.cycle(5);
  EXPECT_EQ(rig.inhibited(), 0u);
  page.heartbeat.store(1001);
  rig.cycle(limit);
  EXPECT_EQ(rig.inhibited(), 0u);
  rig.cycle(5);
  EXPECT_EQ(rig.inhibited(), inhibited_by_supervisor);
}

TEST_F(PagesOfSupervisors, ANewPageAloneIsNoSignOfLife) {
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;
  const auto limit = static_cast<int>(2s / rig.subsystem.cycle_demand().period);
  rig.cycle(limit - 10);
  hand_over(epoch(), true).heartbeat.store(1000);
  step();
  rig.cycle(20);
  EXPECT_EQ(rig.inhibited(), inhibited_by_supervisor);
}

TEST_F(PagesOfSupervisors, OneThatOthersCouldWriteOrThatIsNoneIsNotTaken) {
  rig.bring_to(State::Operational);
  static_cast<void>(hand_over(epoch() + 1, true, Sealed::No));
  static_cast<void>(hand_over(epoch() + 1, true, Sealed::Yes, sizeof(PermitPage) + 64));
  hand_over(epoch() + 1, true).magic = 0;
  hand_over(epoch() + 1, true).version = page_version + 1;
  ASSERT_TRUE(rig.channels.supervisor_end().send({.kind = MessageKind::PermitPage}));
  for (int i = 0; i < 5; ++i) {
    step();
    rig.cycle();
  }
  EXPECT_FALSE(says_so());
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(PagesOfSupervisors, WhileTheCycleRestsItCountsAtOnce) {
  static_cast<void>(hand_over(epoch(), false));
  step();
  EXPECT_TRUE(says_so());
  PermitPage& page = hand_over(epoch() + 7, false);
  step();
  EXPECT_TRUE(says_so()) << "as often as a supervisor dies";
  page.release();
  rig.supervisor_silent = true;
  rig.bring_to(State::SafeOperational);
  rig.set_state(State::Operational);
  for (int i = 0; i < 4; ++i) {
    step();
    rig.cycle();
  }
  EXPECT_EQ(rig.state(), State::Operational);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(PagesOfSupervisors, WhileTheCycleRestsTheNewestOfThoseThatComeTogetherCounts) {
  static_cast<void>(hand_over(epoch(), true));
  PermitPage& newest = hand_over(epoch() + 7, false);
  step();
  for (int each = 0; each < 2; ++each) EXPECT_TRUE(says_so()) << each;
  newest.release();
  rig.supervisor_silent = true;
  rig.bring_to(State::Operational);
  EXPECT_EQ(rig.inhibited(), 0u);
  newest.fence();
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop);
}

TEST_F(PagesOfSupervisors, ASecondOneWaitsUntilTheCycleLooksAtTheFirst) {
  rig.bring_to(State::Operational);
  static_cast<void>(hand_over(epoch(), true));
  static_cast<void>(hand_over(epoch() + 1, false));
  step();
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), 0u) << "the first";
  step();
  EXPECT_TRUE(says_so());
  static_cast<void>(hand_over(epoch() + 1, false));
  step();
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop) << "handed over again";
}

}  // namespace
}  // namespace hirosco
