// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "supervisor/supervision/testing/played_desk.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using OnFailure = Sequence::OnFailure;

struct SequenceTest : ::testing::Test {
  testing::PlayedDesk desk;
  Sequence sequence{desk};
  std::vector<std::string> ends;
  Sequence::Finished finished() {
    return [this](bool success, const std::string& why) { ends.push_back(success ? "success" : why); };
  }
  static Sequence::Command command(std::uint16_t apid, int argument) {
    return {apid, apid == 10 ? "ARM" : "HAND", "SET_STATE", argument, "state " + std::to_string(argument)};
  }
  const std::vector<Sequence::Stage> two_stages{{command(10, 3), command(11, 3)}, {command(10, 4)}};
};

TEST_F(SequenceTest, AStageIsSentAtOnceTheNextWaitsForItsLastAnswer) {
  sequence.start(two_stages, OnFailure::Stop, finished());
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 3", "11 SET_STATE 3"));
  EXPECT_EQ(sequence.waiting_for(), "ARM: state 3, HAND: state 3");
  desk.answers[1](true, "");
  EXPECT_EQ(sequence.waiting_for(), "ARM: state 3");
  EXPECT_EQ(desk.sent.size(), 2u);
  desk.answers[0](true, "");
  EXPECT_EQ(desk.sent.back(), "10 SET_STATE 4");
  EXPECT_TRUE(sequence.running());
  desk.answers[2](true, "");
  EXPECT_FALSE(sequence.running());
  EXPECT_EQ(sequence.waiting_for(), "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(SequenceTest, AFailureEndsItWithWhoAndWhy) {
  sequence.start(two_stages, OnFailure::Stop, finished());
  desk.answers[1](false, "link absent");
  EXPECT_THAT(ends, ElementsAre("HAND state 3: link absent"));
  EXPECT_FALSE(sequence.running());
  desk.answers[0](true, "");  // too late to matter
  EXPECT_EQ(desk.sent.size(), 2u);
  EXPECT_EQ(ends.size(), 1u);
}

TEST_F(SequenceTest, IfToldToItGoesOnAndNamesTheFirstFailureAtTheEnd) {
  sequence.start(two_stages, OnFailure::GoOn, finished());
  desk.answers[1](false, "link absent");
  desk.answers[0](false, "another");
  EXPECT_EQ(desk.sent.size(), 3u);
  desk.answers[2](true, "");
  EXPECT_THAT(ends, ElementsAre("HAND state 3: link absent"));
}

TEST_F(SequenceTest, AnswersMayComeBeforeTheCommandReturns) {
  desk.at_once = true;
  sequence.start(two_stages, OnFailure::Stop, finished());
  EXPECT_EQ(desk.sent.size(), 3u);
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(SequenceTest, AFailureAtOnceKeepsTheRestOfItsStageFromBeingSent) {
  desk.at_once = false;
  sequence.start(two_stages, OnFailure::Stop, finished());
  EXPECT_EQ(desk.sent.size(), 1u);
  EXPECT_THAT(ends, ElementsAre("ARM state 3: at once"));
}

TEST_F(SequenceTest, EmptyStagesAreSkippedAndNothingToDoIsASuccess) {
  sequence.start({{}, {command(10, 3)}, {}}, OnFailure::Stop, finished());
  EXPECT_EQ(desk.sent.size(), 1u);
  desk.answers[0](true, "");
  sequence.start({}, OnFailure::Stop, finished());
  EXPECT_THAT(ends, ElementsAre("success", "success"));
}

TEST_F(SequenceTest, ACancelledOneSaysNothingMore) {
  sequence.start(two_stages, OnFailure::Stop, finished());
  sequence.cancel();
  EXPECT_FALSE(sequence.running());
  desk.answers[0](true, "");
  desk.answers[1](false, "late");
  EXPECT_EQ(desk.sent.size(), 2u);
  EXPECT_TRUE(ends.empty());
}

TEST_F(SequenceTest, AnswersToAReplacedOneDoNotCountForTheNext) {
  sequence.start(two_stages, OnFailure::Stop, finished());
  sequence.start({{command(10, 0)}}, OnFailure::Stop, finished());
  desk.answers[0](false, "late");
  desk.answers[1](true, "");
  EXPECT_TRUE(sequence.running());
  desk.answers[2](true, "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(SequenceTest, AnAnswerGivenTwiceCountsOnce) {
  sequence.start(two_stages, OnFailure::Stop, finished());
  desk.answers[0](true, "");
  desk.answers[0](true, "");
  EXPECT_EQ(desk.sent.size(), 2u);
}

TEST_F(SequenceTest, TheNextMayBeStartedFromTheEndOfThis) {
  sequence.start({{command(10, 3)}}, OnFailure::Stop,
                 [&](bool, const std::string&) { sequence.start({{command(10, 4)}}, OnFailure::Stop, finished()); });
  desk.answers[0](true, "");
  EXPECT_TRUE(sequence.running());
  desk.answers[1](true, "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

}  // namespace
}  // namespace hirosco::supervisor
