// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/own_subsystem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/descriptor/testing.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

/// By itself, with an author that counts: one function, one event, a cycle each 10 ms. It is stepped each millisecond.
namespace hirosco::supervisor {
namespace {

using testing::call_data;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using testing::telecommand;
using enum descriptor::State;

constexpr Duration own_period = 10ms;
const std::string own_descriptor_text = R"(<Subsystem name="SUPERVISOR" id="1">
  <EventService>
    <Event name="HEARD_OF" id="100" severity="low"><Argument name="APID" type="UINT16"/></Event>
  </EventService>
  <FunctionService><Function name="ASK" states="Operational"/></FunctionService>
  <Configuration name="RUN" id="1" sampling_us="10000"/>
</Subsystem>
)";

struct CountingAuthor final : OwnSubsystem::Author {
  void provide(OwnSubsystem& own) override {
    ++provided;
    own.on_function("ASK", [this]() -> Result<> {
      ++asked;
      return ok();
    });
  }
  void show() noexcept override { ++shown; }
  int provided{0}, asked{0}, shown{0};
};

struct OwnSubsystemTest : ::testing::Test {
  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  Platform platform{.clock = clock, .memory = memory, .flows = flows, .wakes = true};
  CountingAuthor author;
  descriptor::SubsystemDescriptor described = descriptor::testing::read_text(own_descriptor_text).value.value();
  OwnSubsystem own{described, platform, author};
  std::vector<std::uint16_t> counts;  ///< sequence counts of its reports
  TimePoint due{};  ///< as its newest step said

  void SetUp() override {
    clock.set(TimePoint{10s});
    own.start(1);
  }
  static void send(OwnSubsystem& to, std::uint8_t service, std::uint8_t subtype, Octets data, std::uint32_t epoch = 0) {
    const auto packet = telecommand(supervisor_apid, service, subtype, data);
    ASSERT_TRUE(to.channel().send({.epoch = epoch, .packet = packet}));
  }
  void step() {
    clock.advance(1ms);
    due = own.step(clock.now());
  }
  void steps(int many) {
    for (; many > 0; --many) {
      own.beat(own.beats() + 1);
      step();
    }
  }
  /// "17.2", "1.2 13", "event 100 low 00 0a".
  std::vector<std::string> said(OwnSubsystem& by) {
    std::vector<std::string> all;
    MessageBuffer buffer;
    for (;;) {
      const auto next = by.channel().receive(buffer);
      if (!next || next->flow == Flow::None) return all;
      if (next->message.kind == MessageKind::Event) {
        const auto event = pus::read_event_message(next->message.packet);
        all.push_back("event " + std::to_string(event->id) + " " + std::string{to_text(event->severity)});
        for (const std::byte octet : event->auxiliary) all.back() += " " + std::to_string(std::to_integer<int>(octet));
        continue;
      }
      const auto report = pus::TelemetryView::parse(next->message.packet);
      EXPECT_EQ(report->apid(), supervisor_apid);
      counts.push_back(report->sequence_count());
      all.push_back(std::to_string(report->service()) + "." + std::to_string(report->subtype()));
      OctetReader reader{report->source_data()};
      static_cast<void>(reader.get<std::uint32_t>());
      if (report->service() == 1 && report->subtype() % 2 == 0)
        all.back() += " " + std::to_string(reader.get<std::uint16_t>());
    }
  }
  std::vector<std::string> said() { return said(own); }
  std::vector<std::string> ask(std::uint8_t service, std::uint8_t subtype, Octets data) {
    said();
    send(own, service, subtype, data);
    steps(60);
    return said();
  }
  void bring_up() {
    for (const auto& call : {call_data("SET_STATE", static_cast<int>(PreOperational)), call_data("CONFIGURE", 1),
                             call_data("SET_STATE", static_cast<int>(SafeOperational)),
                             call_data("SET_STATE", static_cast<int>(Operational))})
      ASSERT_THAT(ask(8, 1, call), Contains("1.7"));
    ASSERT_EQ(own.state(), Operational);
  }
};

TEST_F(OwnSubsystemTest, ATelecommandToItselfIsAnsweredInItsNextStep) {
  said();
  EXPECT_FALSE(own.has_work());
  send(own, 17, 1, {});
  EXPECT_TRUE(own.has_work()) << "to read";
  step();
  EXPECT_TRUE(own.has_work()) << "to be read";
  EXPECT_THAT(said(), ElementsAre("1.1", "1.3", "17.2", "1.7"));
  EXPECT_FALSE(own.has_work());
}

TEST_F(OwnSubsystemTest, WhatItsAuthorProvidesIsThereOnceItIsInitialisedAndCarriedOutInItsCycle) {
  EXPECT_EQ(author.provided, 0);
  bring_up();
  EXPECT_EQ(author.provided, 1);
  EXPECT_EQ(own.configuration(), 1);
  EXPECT_THAT(ask(8, 1, call_data("ASK")), IsSupersetOf({"1.1", "1.3", "1.7"}));
  EXPECT_EQ(author.asked, 1);
}

TEST_F(OwnSubsystemTest, ItShowsOnceInEachOfItsCyclesAndSaysWhenTheNextIsDue) {
  EXPECT_EQ(author.shown, 0) << "none runs yet";
  bring_up();
  EXPECT_EQ(own.statistics().missed, 0U) << "the first was due when it began";
  const int before = author.shown;
  steps(100);
  EXPECT_EQ(author.shown, before + 10);
  for (int until = author.shown + 1; author.shown < until;) step();
  const TimePoint cycle = clock.now();
  for (Duration since = 1ms; since < own_period; since += 1ms) {
    step();
    EXPECT_GT(due, clock.now());
    EXPECT_LE(due, cycle + own_period);
  }
}

TEST_F(OwnSubsystemTest, WhileItIsBeatenItStaysOperationalAndNotLonger) {
  EXPECT_EQ(own.beats(), 1U);
  bring_up();
  steps(3000);
  EXPECT_EQ(own.state(), Operational);
  for (int i = 0; i < 3000; ++i) step();
  EXPECT_NE(own.state(), Operational);
}

TEST_F(OwnSubsystemTest, AnEventIsAnnouncedByItsNameToWhoReactsAndToTheGround) {
  own.announce("HEARD_OF", {10});
  own.announce("OF_NO_DESCRIPTOR", {10});
  step();
  EXPECT_THAT(said(), ElementsAre("event 100 low 0 10", "5.2"));
}

TEST_F(OwnSubsystemTest, WhatWasPermittedInAnotherModeIsRefused) {
  const std::string refused = "1.2 " + std::to_string(static_cast<int>(pus::FailureCode::WrongMode));
  send(own, 17, 1, {}, 2);
  step();
  EXPECT_THAT(said(), ElementsAre(refused));
  own.enter_mode(2);
  send(own, 17, 1, {}, 2);
  step();
  EXPECT_THAT(said(), Contains("1.7"));
  send(own, 17, 1, {}, 1);
  step();
  EXPECT_THAT(said(), ElementsAre(refused));
}

// --- the counts of its packets --------------------------------------------------------------------------------------

struct CountsOfItsPackets : OwnSubsystemTest {
  std::array<std::byte, 2048> room{};
  OwnSubsystem successor{described, platform, author};
  /// After some reports of this one.
  Octets noted() {
    send(own, 17, 1, {});
    step();
    said();
    OctetWriter writer{room};
    own.note(writer);
    EXPECT_TRUE(writer.good());
    return writer.written();
  }
  void successor_answers() {
    counts.clear();
    successor.start(1);
    send(successor, 17, 1, {});
    successor.step(clock.now());
    said(successor);
  }
};

TEST_F(CountsOfItsPackets, GoOnWithWhoeverGoesOnForIt) {
  OctetReader reader{noted()};
  ASSERT_FALSE(counts.empty());
  const int newest = counts.back();
  successor.recall(reader);
  EXPECT_TRUE(reader.exhausted()) << "what others noted behind it is found";
  successor_answers();
  ASSERT_FALSE(counts.empty());
  EXPECT_EQ(counts.front(), newest + 1);
}

TEST_F(CountsOfItsPackets, BeginAnewWhereTheNoteIsTooShort) {
  const Octets whole = noted();
  OctetReader reader{whole.first(whole.size() - 1)};
  successor.recall(reader);
  EXPECT_FALSE(reader.good());
  successor_answers();
  ASSERT_FALSE(counts.empty());
  EXPECT_EQ(counts.front(), 0);
}

}  // namespace
}  // namespace hirosco::supervisor
