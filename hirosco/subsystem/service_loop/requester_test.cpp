// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/requester.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "hirosco/subsystem/testing/inside.hpp"

/// What a subsystem asks of another one, from its author's words to the end that they hear.
namespace hirosco {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::hex;
using ::testing::IsEmpty;
using testing::read_descriptor;
using testing::Rig;
using Stage = RequestReport::Stage;

constexpr const char* bell_descriptor = R"(<Subsystem name="BELL" id="11">
  <CustomService name="RINGING" type="200">
    <Request name="COUNT_RINGS" subtype="1"/>
    <Report name="RINGS" subtype="2"><Field name="COUNT" type="UINT32"/></Report>
  </CustomService>
  <Configuration name="ONE" id="1" sampling_us="1000">
    <FunctionService>
      <Function name="RING"><Argument name="TIMES" type="UINT8" minimum="1" maximum="5"/><Argument name="PITCH" type="DOUBLE" minimum="0" maximum="1"/></Function>
      <Function name="MELT"/>
    </FunctionService>
  </Configuration>
</Subsystem>)";
constexpr const char* porter_descriptor = R"(<Subsystem name="PORTER" id="10">
  <Commands subsystem="BELL" functions="RING COUNT_RINGS"/>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

struct Porter : Subsystem {
  Request<std::uint8_t, double> ring{"BELL", "RING"};
  Request<> count_rings{"BELL", "COUNT_RINGS"};
  std::vector<std::string> heard;
  std::vector<std::uint32_t> numbers;
  bool again{false};

  Result<Step> software_init() override {
    const auto hear = [this](const RequestReport& report) {
      std::string text{std::to_string(static_cast<int>(report.stage))};
      if (report.step != 0) text += " step " + std::to_string(report.step);
      if (report.stage == Stage::Answered) text += " " + std::to_string(report.subtype) + " " + hex(report.data);
      if (!report.reason.empty())
        text += " " + std::to_string(static_cast<int>(report.code)) + " " + std::string{report.reason};
      if (report.number != 0) text += " " + std::to_string(report.number);
      heard.push_back(text);
      numbers.push_back(report.request);
      if (again && report.is_end()) {
        again = false;
        EXPECT_TRUE(request(ring, 1, 0.5));
      }
    };
    use_request(ring, hear);
    use_request(count_rings, hear, std::chrono::seconds{1});
    return done;
  }
  using Subsystem::request;
};

struct Requesting : ::testing::Test {
  Porter porter;
  Rig rig{porter, read_descriptor(porter_descriptor, {bell_descriptor})};

  void SetUp() override { rig.bring_to(State::PreOperational); }
  /// What went to the supervisor for it.
  testing::Asked ring() {
    EXPECT_TRUE(porter.request(porter.ring, 3, 0.5));
    rig.service();
    return rig.asked.back();
  }
};

TEST_F(Requesting, GoesUnderItsOwnIdInTheFormThatTheOthersDescriptorDeclaresAndWantsEveryReport) {
  const auto number = porter.request(porter.ring, 3, 0.5);
  ASSERT_TRUE(number);
  rig.service();
  ASSERT_EQ(rig.asked.size(), 1U);
  const testing::Asked& asked = rig.asked.front();
  EXPECT_EQ(asked.id, *number);
  EXPECT_EQ(asked.apid, 11);
  EXPECT_EQ(asked.source, 10);
  EXPECT_EQ(asked.ack, pus::ack_all);
  EXPECT_EQ(std::pair(asked.service, asked.subtype), std::pair(std::uint8_t{8}, std::uint8_t{1}));
  // RING, two arguments: id 1 with 3, id 2 with 0.5.
  EXPECT_EQ(hex(asked.data),
            "52494e47000000000000000000000000"
            "02"
            "0103"
            "023fe0000000000000");
}

TEST_F(Requesting, HearsEachStageAndOneEnd) {
  const auto asked = ring();
  const std::array step{std::byte{0}, std::byte{7}};
  rig.verify(asked, 1);
  rig.verify(asked, 3);
  rig.verify(asked, 5, step);
  rig.verify(asked, 7);
  rig.verify(asked, 7);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("0", "1", "2 step 7", "4"));
  EXPECT_THAT(porter.numbers, ::testing::Each(asked.id));
}

TEST_F(Requesting, HearsWhyItWasRefusedOrFailed) {
  const std::array wrong_mode{std::byte{0}, std::byte{13}, std::byte{2}};
  rig.verify(ring(), 2, wrong_mode);
  std::vector<std::byte> broken(2 + 1 + 1 + 8 + 3);
  OctetWriter{broken}
      .put(std::uint16_t{0x0202})
      .put(std::uint8_t{0xFF})
      .put(std::uint8_t{11})
      .put(std::int64_t{42})
      .put(std::as_bytes(std::span{"wet", 3}));
  rig.verify(ring(), 8, broken);
  const std::array own_code{std::byte{0x80}, std::byte{1}};
  rig.verify(ring(), 4, own_code);
  rig.service();
  EXPECT_THAT(porter.heard,
              ElementsAre("5 13 not permitted in this mode", "6 514 wet 42", "5 32769 a failure code of its own"));
}

TEST_F(Requesting, HearsOfAStepThatFailedAndOfTheEndAllTheSame) {
  const auto asked = ring();
  std::vector<std::byte> wet(2 + 2 + 1 + 1 + 8 + 3);
  OctetWriter{wet}
      .put(std::uint16_t{7})
      .put(std::uint16_t{0x0202})
      .put(std::uint8_t{0xFF})
      .put(std::uint8_t{11})
      .put(std::int64_t{42})
      .put(std::as_bytes(std::span{"wet", 3}));
  rig.verify(asked, 6, wet);
  rig.verify(asked, 7);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("8 step 7 514 wet 42", "4"));
}

TEST_F(Requesting, TheSupervisorMaySayThatItWasRefusedAndNobodyElseWhoWasNotAsked) {
  const auto asked = ring();
  std::array<std::byte, 6> undeclared{};
  OctetWriter{undeclared}.put(asked.id).put(std::uint16_t{18});
  rig.answer(12, 1, 2, undeclared);
  rig.answer(11, 1, 2, undeclared, std::uint16_t{9});
  rig.service();
  EXPECT_THAT(porter.heard, IsEmpty());
  rig.answer(1, 1, 2, undeclared);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("5 18 not declared by its sender's descriptor"));
}

TEST_F(Requesting, TheReportOfAServiceThatWasAskedIsHeard) {
  ASSERT_TRUE(porter.request(porter.count_rings));
  rig.service();
  EXPECT_EQ(rig.asked.back().service, 200);
  EXPECT_THAT(rig.asked.back().data, IsEmpty());
  rig.answer(11, 201, 2, {});
  const std::array rings{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{9}};
  rig.answer(11, 200, 2, rings);
  rig.verify(rig.asked.back(), 7);
  rig.answer(11, 200, 2, rings);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("3 2 00000009", "4"));
}

TEST_F(Requesting, SaysTheStopThatWasKnownWhenTheServiceLoopBeganItsStep) {
  rig.permit.newest_stop = 5;
  rig.service();
  rig.permit.newest_stop = 6;  // behind the begin of the step, in which it is said
  EXPECT_EQ(ring().known_stop, 5u);
  EXPECT_EQ(ring().known_stop, 6u);
}

TEST_F(Requesting, WhatNobodyAnswersEndsInItsTimeAndALateAnswerIsNone) {
  ASSERT_TRUE(porter.request(porter.count_rings));
  rig.service();
  rig.verify(rig.asked.back(), 1);
  rig.advance(std::chrono::milliseconds{999});
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("0"));
  rig.advance(std::chrono::milliseconds{1});
  rig.service();
  rig.verify(rig.asked.back(), 7);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("0", "7 515 nobody said how it ended"));
}

TEST_F(Requesting, AHandlerMayAskAgain) {
  porter.again = true;
  const auto first = ring();
  rig.verify(first, 7);
  rig.settle();
  ASSERT_EQ(rig.asked.size(), 2U);
  EXPECT_NE(rig.asked[1].id, first.id);
  rig.verify(rig.asked[1], 7);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("4", "4"));
}

TEST_F(Requesting, NoMoreThanSixteenAreUnderWayAndAHundredGoInASecond) {
  for (std::size_t sent = 0; sent < Requester::most_a_second; ++sent) {
    if (sent >= Requester::most_open) {
      EXPECT_EQ(porter.request(porter.ring, 1, 0).error().code, ErrorCode::ResourceExhausted) << sent;
      rig.verify(rig.asked[sent - Requester::most_open], 7);
      rig.service();
    }
    ASSERT_TRUE(porter.request(porter.ring, 1, 0)) << sent;
    rig.service();
  }
  for (std::size_t place = Requester::most_open; place > 0; --place) rig.verify(rig.asked[rig.asked.size() - place], 7);
  rig.service();
  EXPECT_EQ(porter.request(porter.ring, 1, 0).error().code, ErrorCode::ResourceExhausted);
  rig.advance(std::chrono::seconds{1});
  EXPECT_TRUE(porter.request(porter.ring, 1, 0));
}

TEST_F(Requesting, ArgumentsOutsideTheirRangeAreNotSent) {
  EXPECT_EQ(porter.request(porter.ring, 6, 0.5).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(porter.request(porter.ring, 1, std::numeric_limits<double>::quiet_NaN()).error().code,
            ErrorCode::InvalidArgument);
  rig.service();
  EXPECT_THAT(rig.asked, IsEmpty());
}

TEST_F(Requesting, EndsWhenWhoAskedIsTakenDownAndWorksAgainAfterIt) {
  ring();
  EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
  EXPECT_THAT(porter.heard, ElementsAre("7 516 who asked was taken down"));
  EXPECT_EQ(porter.request(porter.ring, 1, 0.5).error().code, ErrorCode::NotPermitted);
  rig.bring_to(State::PreOperational);
  EXPECT_TRUE(porter.request(porter.ring, 1, 0.5));
}

/// Of who passes on what others have written: named in flight, judged by the other's descriptor.
struct Forwarder final : Subsystem {
  std::unique_ptr<OpenRequest> ring;
  Result<Step> software_init() override {
    ring = std::make_unique<OpenRequest>(std::string{"BELL"}, Ask::Function, std::string{named});
    use_request(*ring, {});
    return done;
  }
  using Subsystem::request;
  std::string named{"RING"};
};

TEST(OpenRequests, TakeWhateverTheOthersDescriptorDeclaresAndNothingElse) {
  Forwarder forwarder;
  Rig rig{forwarder, read_descriptor(porter_descriptor, {bell_descriptor})};
  rig.bring_to(State::PreOperational);
  const std::array<std::optional<Value>, 2> values{Value{Number{3}}, Value{Number{0.5}}};
  ASSERT_TRUE(forwarder.request(*forwarder.ring, values));
  rig.service();
  EXPECT_EQ(hex(rig.asked.back().data), "52494e47000000000000000000000000020103023fe0000000000000");
  const std::array<std::optional<Value>, 2> too_many_times{Value{Number{6}}, Value{Number{0.5}}};
  EXPECT_EQ(forwarder.request(*forwarder.ring, too_many_times).error().code, ErrorCode::OutOfRange);
  Forwarder undeclared;
  undeclared.named = "MELT";
  Rig other{undeclared, read_descriptor(porter_descriptor, {bell_descriptor})};
  EXPECT_NE(other.set_state_now(State::PreOperational), "1 3 7") << "<Commands> does not name it";
}

TEST(Requests, OfAnotherLifeAreNumberedElsewhere) {
  const auto first_number = [](Duration born) {
    ChannelPair channel;
    const descriptor::SubsystemDescriptor porter = read_descriptor(porter_descriptor, {bell_descriptor});
    Requester requester{porter, channel.subsystem_end(), TimePoint{born}};
    const Request<> count_rings{"BELL", "COUNT_RINGS"};
    EXPECT_EQ(requester.use(count_rings, {}, std::chrono::seconds{1}), "");
    return requester.send(count_rings, {}, TimePoint{born}, 0).value();
  };
  EXPECT_NE(first_number(std::chrono::seconds{1}), first_number(std::chrono::seconds{2}));
}

/// A subscription is asked of the supervisor, which may be asked for its functions, too: what is told of the one is never taken for the other's.
TEST(Requests, AreCountedInAHalfThatNoSubscriptionIsCountedIn) {
  const descriptor::SubsystemDescriptor porter = read_descriptor(porter_descriptor, {bell_descriptor});
  constexpr int sent = 4;
  for (const int born_ms : {0, 1, 8189, 8191, 8192, 16'381, 16'383, 1'000'000}) {
    ChannelPair channel;
    const TimePoint now{std::chrono::milliseconds{born_ms}};
    Requester requester{porter, channel.subsystem_end(), now};
    const Request<> count_rings{"BELL", "COUNT_RINGS"};
    ASSERT_EQ(requester.use(count_rings, {}, std::chrono::seconds{1}), "");
    std::set<std::uint32_t> counts;
    for (int i = 0; i < sent; ++i)
      counts.insert(requester.send(count_rings, {}, now, 0).value() % pus::sequence_counts);
    EXPECT_EQ(counts.size(), std::size_t{sent});
    EXPECT_GE(*counts.begin(), Requester::first_count) << born_ms;
  }
}

enum class Tune : std::uint8_t { Angelus = 3 };
struct Composer final : Subsystem {
  Request<std::uint64_t, std::array<std::int64_t, 2>, Tune, bool, std::string_view> compose{"BELL", "COMPOSE"};
  Result<Step> software_init() override {
    use_request(compose, {});
    return done;
  }
  using Subsystem::request;
};
constexpr const char* carillon_descriptor = R"(<Subsystem name="BELL" id="11">
  <Enumeration name="TUNES"><Text value="3">angelus</Text></Enumeration>
  <FunctionService>
    <Function name="COMPOSE">
      <Argument name="SERIAL" type="UINT64" minimum="0" maximum="18446744073709551615"/>
      <Argument name="PITCHES" type="INT64" count="2" minimum="-9223372036854775808" maximum="9223372036854775807"/>
      <Argument name="TUNE" type="UINT8" enumeration="TUNES"/>
      <Argument name="LOUD" type="BOOL"/>
      <Argument name="TITLE" type="TEXT" octets="8"/>
    </Function>
  </FunctionService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";
constexpr const char* composer_descriptor = R"(<Subsystem name="COMPOSER" id="10">
  <Commands subsystem="BELL" functions="COMPOSE"/>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

TEST(Requests, CarryEveryTypeOfTheOthersDescriptorWithoutLosingADigit) {
  Composer composer;
  Rig rig{composer, read_descriptor(composer_descriptor, {carillon_descriptor})};
  rig.bring_to(State::PreOperational);
  ASSERT_TRUE(composer.request(composer.compose, (std::uint64_t{1} << 53) + 1,
                               {INT64_MIN, -(std::int64_t{1} << 53) - 1}, Tune::Angelus, true, "\u20ac"));
  rig.service();
  EXPECT_EQ(hex(rig.asked.back().data),
            "434f4d504f5345000000000000000000"
            "05"
            "010020000000000001"
            "028000000000000000ffdfffffffffffff"
            "0303"
            "0401"
            "050003e282ac");
  EXPECT_EQ(composer.request(composer.compose, 0, {0, 0}, Tune{4}, true, "").error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(composer.request(composer.compose, 0, {0, 0}, Tune::Angelus, true, "nine octets").error().code,
            ErrorCode::OutOfRange);
  EXPECT_EQ(composer.request(composer.compose, 0, {0, 0}, Tune::Angelus, true, "\xff").error().code,
            ErrorCode::InvalidArgument);
}

struct Tuneless final : Subsystem {
  Request<std::uint64_t, std::array<std::int64_t, 2>, std::uint8_t, std::uint8_t, double> compose{"BELL", "COMPOSE"};
  Result<Step> software_init() override {
    use_request(compose, {});
    return done;
  }
};

TEST(Requests, OfOtherTypesThanTheOthersDescriptorHasAreToldWithBothLists) {
  Tuneless author;
  Rig rig{author, read_descriptor(composer_descriptor, {carillon_descriptor})};
  rig.set_state_now(State::PreOperational);
  ASSERT_FALSE(rig.explanations.empty());
  EXPECT_THAT(rig.explanations.front(),
              HasSubstr("its arguments are (std::uint64_t, std::array<std::int64_t, 2>, std::uint8_t, std::uint8_t, "
                        "double), the descriptor of BELL declares (UINT64, INT64[2], UINT8, BOOL, TEXT of 8 octets)"));
}

struct Forgetful final : Subsystem {
  Request<> melt{"BELL", "MELT"};
  Request<> wink{"LAMP", "WINK"};
  Request<std::uint16_t> ring{"BELL", "RING"};
  Result<Step> software_init() override {
    for (RequestPort* port : std::array<RequestPort*, 3>{&melt, &wink, &ring}) use_request(*port, {});
    return done;
  }
};

TEST(Requests, AllMistakesOfAnAuthorAreToldInTheSameSoftwareInit) {
  Forgetful author;
  Rig rig{author, read_descriptor(porter_descriptor, {bell_descriptor})};
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.state(), State::Offline);
  std::string all;
  for (const auto& text : rig.explanations) all += text;
  EXPECT_THAT(
      all, AllOf(HasSubstr("use_request BELL MELT: <Commands> does not name this function"),
                 HasSubstr("use_request LAMP WINK: the descriptor has no <Commands> of this subsystem"),
                 HasSubstr("use_request BELL RING: its arguments are (std::uint16_t), the descriptor of BELL declares "
                           "(UINT8, DOUBLE)")));
}

TEST(Requests, WithoutAMissionNobodyKnowsWhoIsAsked) {
  Porter author;
  Rig rig{author, porter_descriptor};
  rig.set_state_now(State::PreOperational);
  ASSERT_FALSE(rig.explanations.empty());
  EXPECT_THAT(rig.explanations.front(), HasSubstr("use_request BELL RING: no mission says who that is"));
}

}  // namespace
}  // namespace hirosco
