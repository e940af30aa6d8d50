// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/script_player/script_run.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace hirosco::script_player {
namespace {

using RequestStage = RequestReport::Stage;

/// The test is the world: it answers what was asked.
struct ScriptRunTest : ::testing::Test, Stage {
  pus::Script script;
  ScriptRun run;
  TimePoint now{};
  std::vector<std::size_t> asked;  ///< lines
  std::optional<double> number;
  std::set<std::size_t> events;
  std::optional<Error> refuses;

  Result<std::uint32_t> ask(std::size_t line) override {
    if (refuses) return std::unexpected{*refuses};
    asked.push_back(line);
    return static_cast<std::uint32_t>(asked.size());
  }
  std::optional<double> number_in(std::size_t, Octets) override { return number; }
  bool was_heard(std::size_t line) override { return events.contains(line); }
  void forget_events() override { events.clear(); }

  void play(std::string_view text) {
    auto reading = pus::read_script("S", text);
    ASSERT_TRUE(reading.problems.empty());
    script = std::move(reading.script);
    run.begin(script, now);
    run.step(now, *this);
  }
  void pass(double s) {
    constexpr double step_s = 0.01;
    for (double gone = 0; gone < s - step_s / 2; gone += step_s) {
      now += std::chrono::milliseconds{10};
      run.step(now, *this);
    }
  }
  /// Of the last that was asked.
  void answer(RequestStage stage, std::string_view reason = {}) {
    RequestReport report{.stage = stage, .request = static_cast<std::uint32_t>(asked.size())};
    report.reason = reason;
    run.hear(report, now, *this);
  }
};

TEST_F(ScriptRunTest, EachTelecommandWaitsForTheEndOfTheOneBefore) {
  play("LAMP FADE 1\nLAMP OFF");
  EXPECT_EQ(asked, (std::vector<std::size_t>{0}));
  for (const auto stage : {RequestStage::Accepted, RequestStage::Started, RequestStage::Progressed}) answer(stage);
  pass(1);
  EXPECT_EQ(asked.size(), 1U);
  EXPECT_EQ(run.line(), 1);
  answer(RequestStage::Completed);
  EXPECT_EQ(asked, (std::vector<std::size_t>{0, 1})) << "at once";
  answer(RequestStage::Completed);
  EXPECT_EQ(run.progress(), Progress::Ended);
  EXPECT_EQ(run.done(), 2U);
}

TEST_F(ScriptRunTest, EndsAtTheFirstThatIsRefusedAndSaysWhichAndWhy) {
  play("# a comment\nLAMP FADE 1\nLAMP OFF");
  answer(RequestStage::Refused, "not permitted in this mode");
  EXPECT_EQ(run.progress(), Progress::Failed);
  EXPECT_EQ(run.why(), "line 2: LAMP FADE: not permitted in this mode");
  pass(1);
  EXPECT_EQ(asked.size(), 1U) << "nothing more is sent";
  answer(RequestStage::Completed);
  EXPECT_EQ(run.progress(), Progress::Failed);
}

TEST_F(ScriptRunTest, ATelecommandThatNobodyEndsFailsAtItsLimit) {
  play("limit 2\nLAMP FADE 1");
  pass(1.9);
  EXPECT_EQ(run.progress(), Progress::Playing);
  pass(0.2);
  EXPECT_EQ(run.why(), "line 2: LAMP FADE: no end within 2 s");
}

TEST_F(ScriptRunTest, WaitsItsTimeAndLooksAtTheClockOfTheScript) {
  play("wait 0.5\n@2 LAMP OFF");
  pass(1.9);
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(run.done(), 1U);
  pass(0.2);
  EXPECT_EQ(asked.size(), 1U);
  // Who is late goes on at once.
  play("wait 1\n@0.5 LAMP OFF");
  pass(1.02);
  EXPECT_EQ(asked.size(), 2U);
}

TEST_F(ScriptRunTest, LooksAtAParameterFiveTimesASecondUntilItIsAsItIsWanted) {
  number = 1;
  play("until LAMP MOVING == 0 within 3");
  const auto answered = [this] {
    answer(RequestStage::Answered);
    answer(RequestStage::Completed);
  };
  answered();
  for (int i = 0; i < 5; ++i) {
    pass(0.2);
    answered();
  }
  EXPECT_EQ(asked.size(), 6U);
  number = 0;
  pass(0.2);
  answered();
  EXPECT_EQ(run.progress(), Progress::Ended);
}

TEST_F(ScriptRunTest, SaysWhatAParameterIsThatDoesNotBecomeWhatIsWanted) {
  number = 0.25;
  play("until LAMP BRIGHTNESS > 0.5 within 1");
  answer(RequestStage::Answered);
  answer(RequestStage::Completed);
  pass(1.1);
  EXPECT_EQ(run.why(), "line 1: LAMP BRIGHTNESS: not within 1 s: it is 0.25");
  play("until LAMP BRIGHTNESS > 0.5 within 1");
  pass(1.1);
  EXPECT_EQ(run.why(), "line 1: LAMP BRIGHTNESS: not within 1 s: nobody answered");
}

TEST_F(ScriptRunTest, AnEventCountsThatCameSinceTheLastTelecommand) {
  play("LAMP FADE 1\nevent LAMP FADED within 1\nLAMP OFF\nevent LAMP FADED within 1");
  events.insert(1);  // while the telecommand is under way
  answer(RequestStage::Completed);
  EXPECT_EQ(asked.size(), 2U);
  answer(RequestStage::Completed);
  EXPECT_EQ(run.line(), 4);
  pass(1.1);
  EXPECT_EQ(run.why(), "line 4: LAMP FADED: not heard within 1 s") << "the old one is no answer to this telecommand";
}

TEST_F(ScriptRunTest, HeldItEndsWhatIsUnderWayAndItsTimeStands) {
  play("LAMP FADE 1\n@1 LAMP OFF");
  run.hold();
  EXPECT_EQ(run.progress(), Progress::Held);
  answer(RequestStage::Completed);
  pass(5);
  EXPECT_EQ(asked.size(), 1U);
  EXPECT_NEAR(run.time_s(), 0, 0.02);
  run.resume();
  pass(0.9);
  EXPECT_EQ(asked.size(), 1U);
  pass(0.2);
  EXPECT_EQ(asked.size(), 2U);
}

TEST_F(ScriptRunTest, StoppedItSendsNothingMore) {
  play("LAMP FADE 1\nLAMP OFF");
  run.stop(Progress::Aborted, "aborted");
  answer(RequestStage::Completed);
  pass(1);
  EXPECT_EQ(asked.size(), 1U);
  EXPECT_EQ(run.progress(), Progress::Aborted);
}

TEST_F(ScriptRunTest, ASupervisorThatIsBehindIsAskedAgainWithinTheLimit) {
  refuses = Error{ErrorCode::ResourceExhausted, "requests under way", 16};
  play("limit 1\nLAMP OFF");
  pass(0.5);
  EXPECT_EQ(run.progress(), Progress::Playing);
  refuses.reset();
  pass(0.01);
  EXPECT_EQ(asked.size(), 1U);
  refuses = Error{ErrorCode::ResourceExhausted, "requests under way", 16};
  play("limit 1\nLAMP OFF");
  pass(1.1);
  EXPECT_EQ(run.why(), "line 2: LAMP OFF: requests under way");
}

TEST_F(ScriptRunTest, ManyLinesThatTakeNoTimeAreOneStep) {
  std::string text;
  for (int i = 0; i < 199; ++i) text += "limit 5\n";
  play(text + "LAMP OFF");
  EXPECT_EQ(asked.size(), 1U);
}

}  // namespace
}  // namespace hirosco::script_player
