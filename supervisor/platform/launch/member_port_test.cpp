// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/member_port.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "hirosco/data_transfer/memory/heap_memory.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

/// A channel that notes what is done with it, and has no room while it is full.
struct NotingChannel final : Channel {
  explicit NotingChannel(std::vector<std::string>& to) : notes{to} {}
  ~NotingChannel() override { notes.emplace_back("gone"); }
  Result<> send(const Message&) override {
    if (full) return fail(ErrorCode::ResourceExhausted, "full");
    notes.emplace_back("sent");
    return ok();
  }
  Result<Found> receive(MessageBuffer&) override { return Found{}; }
  std::vector<std::string>& notes;
  bool full{false};
};

/// A member that shares no memory: what it says is taken across in each step.
struct FarPort final : MemberPort {
  FarPort(NotingChannel& to, Mapping vital, Mapping permit)
      : MemberPort{to, std::move(vital), std::move(permit)}, notes{to.notes} {}
  std::vector<std::string>& notes;
  TimePoint taken_across{};

 private:
  void take_across(TimePoint now) override {
    notes.emplace_back("across");
    taken_across = now;
  }
};

struct MemberPortTest : ::testing::Test {
  HeapMemory memory;
  Mapping vital_memory = mapping(sizeof(VitalPage)), permit_memory = mapping(sizeof(PermitPage));
  VitalPage& vital = *new (vital_memory.octets.data()) VitalPage{};
  PermitPage& permit = *new (permit_memory.octets.data()) PermitPage{};
  std::vector<std::string> notes;
  NotingChannel* channel{nullptr};
  std::unique_ptr<MemberPort> port = make(vital_memory, permit_memory);
  TimePoint now{10s};

  [[nodiscard]] Mapping mapping(std::size_t octets) {
    return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
  }
  [[nodiscard]] std::unique_ptr<MemberPort> make(Mapping of_vital, Mapping of_permit) {
    auto made = std::make_unique<NotingChannel>(notes);
    channel = made.get();
    return std::make_unique<LocalMemberPort>(std::move(made), std::move(of_vital), std::move(of_permit));
  }
  void expect_says_nothing() {
    EXPECT_FALSE(port->state());
    EXPECT_EQ(port->configuration(), 0);
    EXPECT_FALSE(port->statistics());
    EXPECT_EQ(port->latencies(0).period_ns, 0U);
  }
  void say_something() {
    vital.state = static_cast<std::uint32_t>(State::Operational);
    vital.configuration = 2;
    vital.latencies[0].period_ns = 1'000'000;
  }
};

TEST_F(MemberPortTest, SaysWhatTheMemberSaysAtThisInstant) {
  EXPECT_EQ(port->state(), State::Offline);
  say_something();
  EXPECT_EQ(port->state(), State::Operational);
  EXPECT_EQ(port->configuration(), 2);
}

TEST_F(MemberPortTest, AStateThatDoesNotExistIsNone) {
  vital.state = static_cast<std::uint32_t>(State::SoftwareDeinit);
  EXPECT_EQ(port->state(), State::SoftwareDeinit);
  vital.state = static_cast<std::uint32_t>(State::SoftwareDeinit) + 1;
  EXPECT_FALSE(port->state());
}

TEST_F(MemberPortTest, APageThatIsNoneOfOursSaysNothing) {
  say_something();
  ++vital.magic;
  expect_says_nothing();
  --vital.magic;
  ++vital.version;
  expect_says_nothing();
  --vital.version;
  EXPECT_EQ(port->state(), State::Operational);
}

TEST_F(MemberPortTest, PagesThatAreTooSmallSayNothingAndAreNotWritten) {
  say_something();
  permit.stopped_at_cycle = 8;
  const auto shorter = [](Mapping page) {
    page.octets = page.octets.first(page.octets.size() - 1);
    return page;
  };
  vital_memory = Mapping{vital_memory.keep, vital_memory.octets.first(sizeof(VitalPage))};
  permit_memory = Mapping{permit_memory.keep, permit_memory.octets.first(sizeof(PermitPage))};
  port = make(shorter(vital_memory), shorter(permit_memory));
  expect_says_nothing();
  port->beat(7, now);
  port->enter_mode(9);
  EXPECT_EQ(permit.heartbeat.load(), 0U);
  EXPECT_EQ(permit.mode_epoch.load(), 0U);
  EXPECT_EQ(port->stopped_at_cycle(), 0U);
}

TEST_F(MemberPortTest, StatisticsAreThoseOfItsCycle) {
  vital.inhibited = 4;
  vital.realtime = 1;
  vital.period_ns = 1'000'000;
  vital.cycles = 5'000'000'000;
  vital.overruns = 6;
  vital.missed = 7;
  vital.latency_max_ns = 8;
  vital.execution_max_ns = 88;
  vital.execution_mean_ns = 9;
  vital.inhibited_at_cycle = 10;
  const MemberStatistics found = port->statistics().value();
  EXPECT_EQ(found.inhibited, 4U);
  EXPECT_TRUE(found.realtime);
  EXPECT_FALSE(found.cycling);
  EXPECT_EQ(found.period_ns, 1'000'000U);
  EXPECT_EQ(found.cycles, 5'000'000'000U);
  EXPECT_EQ(found.overruns, 6U);
  EXPECT_EQ(found.missed, 7U);
  EXPECT_EQ(found.latency_max_ns, 8U);
  EXPECT_EQ(found.execution_mean_ns, 9U);
  EXPECT_EQ(found.inhibited_at_cycle, 10U);
  vital.realtime = 0;
  vital.cycling = 1;
  EXPECT_FALSE(port->statistics()->realtime);
  EXPECT_TRUE(port->statistics()->cycling);
}

TEST_F(MemberPortTest, StatisticsOfEachIncomingLinkStandInItsPlace) {
  for (std::uint32_t i = 0; i < told_incoming_links; ++i) {
    IncomingLink& link = vital.incoming[i];
    link.link = 10 * i + 1;
    link.lost = 10 * i + 2;
    link.latency_mean_ns = 10 * i + 3;
    link.latency_max_ns = 10 * i + 4;
    link.jitter_ns = 10 * i + 5;
    link.age_us = 10 * i + 6;
    vital.judged[i] = 10 * i + 7;
  }
  const MemberStatistics found = port->statistics().value();
  for (std::uint32_t i = 0; i < told_incoming_links; ++i) {
    const auto& link = found.incoming[i];
    EXPECT_THAT((std::array{link.link, link.lost, link.latency_mean_ns, link.latency_max_ns, link.jitter_ns,
                            link.age_us, link.judged}),
                ElementsAre(10 * i + 1, 10 * i + 2, 10 * i + 3, 10 * i + 4, 10 * i + 5, 10 * i + 6, 10 * i + 7));
  }
}

TEST_F(MemberPortTest, LatenciesAreThoseOfOneLinkAndBeyondTheLastThereAreNone) {
  LinkLatencies& last = vital.latencies[told_incoming_links - 1];
  last.period_ns = 2'000'000;
  for (std::uint32_t bin = 0; bin < latency_bins; ++bin) last.counts[bin] = bin + 1;
  const MemberLatencies found = port->latencies(told_incoming_links - 1);
  EXPECT_EQ(found.period_ns, 2'000'000U);
  EXPECT_THAT(found.counts, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(port->latencies(told_incoming_links - 2).period_ns, 0U);
  EXPECT_EQ(port->latencies(told_incoming_links).period_ns, 0U);
}

TEST_F(MemberPortTest, ItsPermitPageIsToldTheHeartbeatAndTheModeAndSaysWhereItWasStopped) {
  port->beat(7, now);
  EXPECT_EQ(permit.heartbeat.load(), 7U);
  port->enter_mode(9);
  EXPECT_EQ(permit.mode_epoch.load(), 9U);
  EXPECT_EQ(permit.heartbeat.load(), 7U);
  permit.stopped_at_cycle = 4711;
  EXPECT_EQ(port->stopped_at_cycle(), 4711U);
  EXPECT_FALSE(permit.permits(permit.epoch.load())) << "nobody but the guard lets it move";
}

TEST_F(MemberPortTest, WithEachStepWhatItsChannelKeptLeaves) {
  channel->full = true;
  ASSERT_TRUE(port->channel().send_or_keep({}, now));
  port->beat(1, now);
  EXPECT_THAT(notes, ElementsAre());
  channel->full = false;
  port->beat(2, now);
  EXPECT_THAT(notes, ElementsAre("sent"));
  port->beat(3, now);
  EXPECT_THAT(notes, ElementsAre("sent")) << "once";
}

TEST_F(MemberPortTest, WhatIsNotSharedIsTakenAcrossOnceInEachStepBeforeWhatWasKeptLeaves) {
  std::vector<std::string> done;
  NotingChannel to{done};
  FarPort far{to, vital_memory, permit_memory};
  to.full = true;
  ASSERT_TRUE(far.channel().send_or_keep({}, now));
  to.full = false;
  far.beat(1, now + 5ms);
  EXPECT_THAT(done, ElementsAre("across", "sent"));
  EXPECT_EQ(far.taken_across, now + 5ms);
}

TEST_F(MemberPortTest, TheChannelOfAMemberOfThisComputerGoesWithItsPort) {
  port.reset();
  EXPECT_THAT(notes, ElementsAre("gone"));
}

TEST_F(MemberPortTest, ItsPagesLiveAsLongAsItsPort) {
  say_something();
  const std::weak_ptr<void> page = vital_memory.keep;
  vital_memory = permit_memory = Mapping{};
  EXPECT_FALSE(page.expired());
  EXPECT_EQ(port->state(), State::Operational);
  port.reset();
  EXPECT_TRUE(page.expired());
}

}  // namespace
}  // namespace hirosco::supervisor
