// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/words/describe.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// Events are no telemetry (adr 0020): the supervisor hears of each, whatever ground has switched off.
namespace hirosco {
namespace {

namespace framework = descriptor::framework_event;
using ::testing::IsEmpty;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

struct Events : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};

  /// TC[5,5] or TC[5,6] of one event.
  void switch_report(std::uint8_t subtype, std::uint16_t event) {
    std::array<std::byte, 3> data{};
    OctetWriter{data}.put(std::uint8_t{1}).put(event);
    const auto request = rig.send(5, subtype, data);
    rig.service();
    ASSERT_EQ(rig.outcome(request), "1 3 7");
  }
};

TEST_F(Events, ReachTheSupervisorThoughTheirReportIsSwitchedOff) {
  for (const std::uint16_t event : {framework::state_changed, framework::state_failed, std::uint16_t{7}})
    switch_report(6, event);
  probe.raises = true;
  rig.bring_to(State::Operational);
  probe.nodes[State::Operational].fails = true;
  rig.settle();
  EXPECT_THAT(rig.reports(5, 1), IsEmpty());
  EXPECT_THAT(rig.reports(5, 2), IsEmpty());
  EXPECT_THAT(rig.reports(5, 4), IsEmpty());
  EXPECT_GT(rig.heard(framework::state_changed), 0);
  EXPECT_EQ(rig.heard(framework::state_failed), 1);
  EXPECT_GT(rig.heard(7), 0);
  for (const auto& event : rig.raised) EXPECT_EQ(event.reported, pus::Reported::No) << event.id;
}

TEST_F(Events, SayWhetherTheirReportFollowsAndHowSevereTheyAre) {
  switch_report(6, framework::state_changed);
  switch_report(5, framework::state_changed);
  rig.bring_to(State::PreOperational);
  ASSERT_EQ(static_cast<std::size_t>(rig.heard(framework::state_changed)), rig.reports(5, 1).size());
  EXPECT_EQ(rig.raised.front().reported, pus::Reported::Yes);
  EXPECT_EQ(rig.raised.front().severity, descriptor::Severity::Info);
}

TEST_F(Events, OfTheFrameworkAreThereThoughTheDescriptorDeclaresNone) {
  struct Bare : Subsystem {
    Result<> operational(const Cycle&) noexcept override { return fail(ErrorCode::Internal, "sensor is broken", 42); }
  } author;
  Rig bare{author,
           R"(<Subsystem name="BARE" id="10"><Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)"};
  bare.bring_to(State::Operational);
  bare.settle();
  EXPECT_EQ(bare.heard(framework::state_failed), 1);
  EXPECT_EQ(bare.state(), State::ErrorOperational);
}

TEST_F(Events, OfAFailedStateCarryTheAuthorsWordsAndNumber) {
  struct Broken : Subsystem {
    Result<> operational(const Cycle&) noexcept override { return fail(ErrorCode::Internal, "sensor is broken", 42); }
  } author;
  Rig broken{author,
             R"(<Subsystem name="BARE" id="10"><Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)"};
  broken.bring_to(State::Operational);
  broken.settle();
  const auto failed = std::ranges::find(broken.raised, framework::state_failed, &testing::Raised::id);
  ASSERT_NE(failed, broken.raised.end());
  OctetReader reader{failed->auxiliary};
  EXPECT_EQ(reader.get<std::uint8_t>(), static_cast<std::uint8_t>(State::Operational));
  EXPECT_EQ(reader.get<std::uint8_t>(), static_cast<std::uint8_t>(ErrorCode::Internal));
  EXPECT_EQ(reader.get<std::int64_t>(), 42);
  EXPECT_EQ(pus::text_of(reader.get(framework::text_octets)), "sensor is broken");
  EXPECT_TRUE(reader.exhausted());
}

TEST_F(Events, WithArrayArgumentsArriveWhole) {
  struct Arrays : Subsystem {
    Event<std::array<std::uint16_t, 3>, std::uint8_t> forces{"FORCES"};
    Result<Step> software_init() override {
      use_event(forces);
      return done;
    }
    Result<> pre_operational(const Cycle& cycle) noexcept override {
      if (cycle.first) raise(forces, {1, 2, 3}, 4);
      return ok();
    }
    void service(TimePoint) override {
      if (state() == State::SafeOperational) raise_in_service(forces, {5, 6, 7}, 8);
    }
  } author;
  Rig arrays{author, R"(<Subsystem name="ARRAYS" id="10">
    <EventService><Event name="FORCES" id="7" severity="low">
      <Argument name="F" type="UINT16" count="3"/><Argument name="AXIS" type="UINT8"/></Event></EventService>
    <Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)"};
  arrays.bring_to(State::PreOperational);
  arrays.settle();
  EXPECT_THAT(arrays.reports(5, 2), ::testing::ElementsAre("000700010002000304"));
  EXPECT_EQ(arrays.heard(7), 1);
  arrays.set_state_now(State::SafeOperational);
  EXPECT_EQ(arrays.reports(5, 2).at(1), "000700050006000708") << "from the service loop, too";
}

TEST_F(Events, TellWordsThatAreCutWhereTheyAreLonger) {
  struct Words : Subsystem {
    Event<Text<6>, std::uint8_t> near{"NEAR"};
    Result<Step> software_init() override {
      use_event(near);
      return done;
    }
    Result<> pre_operational(const Cycle& cycle) noexcept override {
      if (cycle.first) raise(near, Text<6>{std::string_view{"arm"}}, 4);
      if (cycle.first) raise(near, Text<6>{std::string_view{"forearm"}}, 5);
      return ok();
    }
  } author;
  Rig words{author, R"(<Subsystem name="WORDS" id="10">
    <EventService><Event name="NEAR" id="7" severity="low">
      <Argument name="WHO" type="TEXT" octets="6"/><Argument name="AXIS" type="UINT8"/></Event></EventService>
    <Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)"};
  words.bring_to(State::PreOperational);
  words.settle();
  EXPECT_THAT(words.reports(5, 2), ::testing::ElementsAre("000761726d00000004", "0007666f7265617205"));
}

TEST(TypedEvents, ThatAreNotTheDescriptorsFailSoftwareInitAllAtOnce) {
  struct Wrong : Subsystem {
    Event<> none{"NONE"};
    Event<std::uint16_t> axis{"AXIS_STUCK"};
    Event<std::uint8_t, double> force{"FORCE"};
    Event<Text<6>> near{"NEAR"};
    Result<Step> software_init() override {
      use_event(near);
      use_event(none);
      use_event(axis);
      use_event(force);
      return done;
    }
  } author;
  Rig rig{author, R"(<Subsystem name="WRONG" id="10"><EventService>
      <Event name="AXIS_STUCK" id="7" severity="low"><Argument name="AXIS" type="UINT8"/></Event>
      <Event name="FORCE" id="8" severity="low"><Argument name="AXIS" type="UINT8"/></Event>
      <Event name="NEAR" id="9" severity="low"><Argument name="WHO" type="TEXT" octets="5"/></Event></EventService>
    <Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)"};
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.state(), State::Offline);
  std::string all;
  for (const auto& text : rig.explanations) all += text;
  EXPECT_THAT(
      all, ::testing::AllOf(::testing::HasSubstr("declares no event 'NONE'"),
                            ::testing::HasSubstr("AXIS_STUCK: its arguments are (std::uint16_t), the descriptor "
                                                 "declares (UINT8)"),
                            ::testing::HasSubstr("FORCE: its arguments are (std::uint8_t, double)"),
                            ::testing::HasSubstr("NEAR: its arguments are (Text<6>), the descriptor declares (TEXT of "
                                                 "5 octets)")));
}

/// Raises as many events as one cycle can, and reports progress without end.
struct Talkative : Probe {
  int events{0};
  int steps{0};
  Result<> work(const Cycle& cycle) noexcept override {
    for (int i = 0; i < events; ++i) raise(own, 1.0 * i);
    if (move)
      for (int i = 0; i < steps; ++i) progress(*move, 1);
    return Probe::work(cycle);
  }
};

TEST(Rings, FullOfAnAuthorsEventsAndProgressLoseNoAnswerAndTellWhatTheyLost) {
  Talkative author;
  Rig rig{author, probe_descriptor};
  rig.bring_to(State::SafeOperational);
  author.events = 5'000;
  author.steps = 5'000;
  EXPECT_EQ(rig.set_state_now(State::Operational), "1 3 7");
  const auto move = rig.call("MOVE");
  const auto goal = rig.call("SET_GOAL", {0.5});
  rig.service();
  rig.cycle(3);
  rig.service();
  EXPECT_EQ(rig.outcome(goal), "1 3 7");
  author.finish_due = true;
  rig.cycle(2);
  rig.service();
  EXPECT_TRUE(rig.outcome(move).starts_with("1 3 5"));
  EXPECT_TRUE(rig.outcome(move).ends_with(" 7"));
  author.events = author.steps = 0;
  rig.advance(2s);
  rig.service();
  ASSERT_GT(rig.heard(framework::reports_lost), 0);
  const auto newest =
      std::ranges::find(rig.raised.rbegin(), rig.raised.rend(), framework::reports_lost, &testing::Raised::id);
  OctetReader reader{newest->auxiliary};
  const auto answers = reader.get<std::uint32_t>();
  const auto events = reader.get<std::uint32_t>();
  EXPECT_GT(answers, 0u) << "progress";
  EXPECT_GT(events, 20'000u);
  EXPECT_EQ(rig.vital.lost_reports.load(), answers + events);
}

TEST(Rings, FullOfAnAuthorsEventsStillTellThatADeviceIsLost) {
  // Remarks have half of the ring, what an author calls severe has all of it.
  for (const std::string severity : {"low", "high"}) {
    Talkative author;
    std::string text = probe_descriptor;
    const std::string own_event = R"(name="OWN" id="7" severity=")";
    text.replace(text.find(own_event), own_event.size() + 3, own_event + severity);
    Rig rig{author, text};
    rig.bring_to(State::PreOperational, 3);
    rig.set_state(State::SafeOperational);
    rig.service();
    rig.advance(first_answer_limit + 1ms);
    author.events = 5'000;
    rig.service();
    rig.cycle(6);
    rig.settle();
    EXPECT_EQ(rig.heard(testing::arm_lost), 1) << severity;
    EXPECT_EQ(rig.events(testing::arm_lost), 1) << severity;
  }
}

TEST(Rings, KeepAnswersAndEventsInTheOrderInWhichTheCycleMadeThem) {
  Talkative author;
  Rig rig{author, probe_descriptor};
  rig.bring_to(State::SafeOperational);
  author.events = 1;
  rig.forget_telemetry();
  rig.set_state(State::Operational);
  rig.service();
  rig.cycle(2);  // enters, and then raises, twice
  rig.service();
  std::string order;
  for (const auto& report : rig.telemetry)
    order += std::to_string(report.service) + "." + std::to_string(report.subtype) + " ";
  EXPECT_EQ(order, "1.1 1.3 5.1 1.7 5.2 5.2 ");
}

}  // namespace
}  // namespace hirosco
