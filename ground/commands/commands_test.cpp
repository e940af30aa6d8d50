// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/commands.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/commands/question_source.hpp"
#include "ground/testing/workshop.hpp"
#include "hirosco/pus/packet/failure_code.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ACommander : public ::testing::Test {
 protected:
  static constexpr std::uint16_t own = 0x2001, elsewhere = 0x4001;
  struct Sent {
    std::vector<std::byte> octets;
    Way way;
    std::size_t known;  ///< telecommands in the archive when it left
  };

  [[nodiscard]] static nlohmann::json bore(double depth = 2.5) {
    return {{"subsystem", "DRILL"}, {"function", "BORE"}, {"arguments", {{"DEPTH", depth}}}, {"sender", "anna"}};
  }
  [[nodiscard]] pus::TelecommandView sent_as(std::size_t place) const {
    return *pus::TelecommandView::parse(sent.at(place).octets);
  }
  [[nodiscard]] static std::string in_hex(Octets octets) {
    std::string text;
    for (const std::byte octet : octets) text += fmt::format("{:02X}", std::to_integer<unsigned>(octet));
    return text;
  }
  /// A report on the telecommand that was sent in this place.
  void reports(std::size_t place, const std::string& stage, bool last = false, std::optional<int> code = {}) {
    reports_on(sent_as(place).request_id(), own, stage, last, code);
  }
  void reports_on(std::uint32_t request_id, std::uint16_t destination, const std::string& stage, bool last = false,
                  std::optional<int> code = {}) {
    Heard heard;
    heard.verdict.emplace();
    heard.verdict->destination = destination;
    heard.verdict->request_id = request_id;
    heard.verdict->stage = stage;
    heard.verdict->code = code;
    heard.verdict->reason = code ? "because" : "";
    heard.verdict->last = last;
    commands.hear(heard, clock.onboard());
  }
  void copied(const std::vector<std::byte>& telecommand) {
    Heard heard;
    heard.telecommand = telecommand;
    commands.hear(heard, clock.onboard());
  }
  /// The supervisor's answer to the question in this place; 0: it is permitted.
  void judged(std::size_t place, std::uint16_t code, std::uint16_t destination = question_source(own)) {
    const auto asked = pus::read_primary_header(sent_as(place).application_data());
    ASSERT_TRUE(asked);
    Heard heard;
    heard.answer = PermissionAnswer{destination, asked->request_id, code == 0, code};
    commands.hear(heard, clock.onboard());
  }
  void previewed(std::uint8_t mode, std::uint16_t destination = question_source(own)) {
    Heard heard;
    heard.mode_answer = ModeAnswer{destination, {mode, {"LAMP is down"}, {{1, testing::drill_apid, "CONFIGURE RUN"}}}};
    commands.hear(heard, clock.onboard());
  }
  void pass(Duration span) {
    clock.advance(span);
    commands.expire(clock.now());
  }
  [[nodiscard]] auto keep_answer() {
    return [this](Answered<nlohmann::json> answer) { answers.push_back(std::move(answer)); };
  }
  [[nodiscard]] std::vector<std::string> stages_told() const {
    std::vector<std::string> stages;
    for (const StoredCommand& command : told) stages.push_back(command.stage);
    return stages;
  }

  Catalogue catalogue{testing::workshop()};
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  Model model{catalogue};
  ManualClock clock;
  bool link{true}, leaves{true};
  std::vector<Sent> sent;
  std::vector<StoredCommand> told;
  std::vector<Answered<nlohmann::json>> answers;
  Commands commands{{.catalogue = catalogue,
                     .archive = *archive,
                     .model = model,
                     .clock = clock,
                     .now = [this] { return clock.onboard(); },
                     .connected = [this] { return link; },
                     .send =
                         [this](Octets octets, Way way) {
                           sent.push_back({{octets.begin(), octets.end()},
                                           way,
                                           static_cast<std::size_t>(archive->count_commands({}))});
                           return leaves;
                         },
                     .tell = [this](const StoredCommand& command) { told.push_back(command); },
                     .source = own,
                     .first_count = 16'383}};
};

TEST_F(ACommander, SendsWhatIsAskedForUnderItsOwnNameAndSaysWhatWasSent) {
  const auto answer = commands.send(bore());
  ASSERT_TRUE(answer) << answer.error().text;
  ASSERT_THAT(sent, SizeIs(1));
  const auto packet = sent_as(0);
  EXPECT_EQ(packet.apid(), testing::drill_apid);
  EXPECT_EQ(packet.service(), 8);
  EXPECT_EQ(packet.subtype(), 1);
  EXPECT_EQ(packet.source(), own);
  EXPECT_EQ(packet.ack(), pus::ack_all);
  EXPECT_EQ(packet.sequence_count(), 16'383);
  EXPECT_EQ((*answer)["apid"], testing::drill_apid);
  EXPECT_EQ((*answer)["count"], 16'383);
  EXPECT_EQ((*answer)["octets"], in_hex(sent[0].octets));
  const auto kept = archive->command((*answer)["id"].get<std::int64_t>());
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->sender, "anna");
  EXPECT_EQ(kept->function, "BORE");
  EXPECT_EQ(kept->stage, "sent");
  EXPECT_EQ(sent[0].known, 1U) << "it is in the archive before it leaves";
  EXPECT_THAT(stages_told(), ElementsAre("sent"));
  ASSERT_TRUE(commands.send(bore()));
  EXPECT_EQ(sent_as(1).sequence_count(), 0) << "behind 16,383 the counts begin again";
  EXPECT_EQ(commands.sent(), 2U);
}

TEST_F(ACommander, CallsWhoSaysNothingTheOperatorAndCutsWhoSaysMuch) {
  auto body = bore();
  body.erase("sender");
  ASSERT_TRUE(commands.send(body));
  body["sender"] = std::string(40, 'x');
  ASSERT_TRUE(commands.send(body));
  EXPECT_EQ(told[0].sender, "operator");
  EXPECT_EQ(told[1].sender, std::string(32, 'x'));
}

TEST_F(ACommander, RefusesWhatFitsNoDescriptorAndSendsNothing) {
  const auto answer = commands.send(bore(500));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().status, 400U);
  EXPECT_THAT(sent, IsEmpty());
  EXPECT_EQ(archive->count_commands({}), 0);
}

TEST_F(ACommander, FollowsATelecommandToItsLastReportAndNoFurther) {
  const auto answer = commands.send(bore());
  ASSERT_TRUE(answer);
  clock.advance(1s);
  reports(0, "accepted");
  clock.advance(1s);
  reports(0, "failed", true, 13);
  reports(0, "completed", true);
  EXPECT_THAT(stages_told(), ElementsAre("sent", "accepted", "failed"));
  EXPECT_EQ(told[1].code, std::nullopt);
  EXPECT_EQ(told[2].code, 13);
  EXPECT_EQ(told[2].reason, "because");
  EXPECT_EQ(told[2].t, told[0].t + 2s) << "the time of the report";
  const auto number = (*answer)["id"].get<std::int64_t>();
  EXPECT_EQ(archive->command(number)->stage, "failed");
  EXPECT_THAT(archive->reports(number), SizeIs(2));
  EXPECT_EQ(archive->count_commands({}), 1) << "its own late report is nobody else's telecommand";
}

TEST_F(ACommander, WithoutALinkRefusesWhatWouldWaitForItAndTriesWhatIsEssential) {
  link = false;
  EXPECT_EQ(commands.send(bore()).error().status, 503U);
  EXPECT_THAT(sent, IsEmpty());
  EXPECT_EQ(archive->count_commands({}), 0);
  ASSERT_TRUE(commands.send({{"subsystem", "SUPERVISOR"}, {"function", "SAFE_ALL"}}));
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_EQ(sent[0].way, Way::Alone);
}

TEST_F(ACommander, KeepsThatOneDidNotLeave) {
  leaves = false;
  EXPECT_EQ(commands.send(bore()).error().status, 503U);
  EXPECT_EQ(sent.at(0).way, Way::InTurn);
  const auto kept = archive->commands({.span = {}, .text = {}});
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].stage, "failed");
  EXPECT_EQ(kept[0].reason, "not sent: no link");
  EXPECT_EQ(commands.sent(), 0U);
  EXPECT_THAT(told, IsEmpty()) << "who asked has the answer";
}

TEST_F(ACommander, TellsWhenOneCouldNotLeaveAfterAll) {
  ASSERT_TRUE(commands.send(bore()));
  clock.advance(3s);
  commands.not_sent(sent[0].octets);
  commands.not_sent(sent[0].octets);
  EXPECT_THAT(stages_told(), ElementsAre("sent", "failed"));
  EXPECT_EQ(told[1].reason, "not sent: the link was lost");
  EXPECT_EQ(told[1].t, clock.onboard());
  EXPECT_EQ(archive->command(told[1].number)->reason, "not sent: the link was lost");
  commands.not_sent(Octets{sent[0].octets}.first(3));
  EXPECT_THAT(told, SizeIs(2)) << "a part of one is none";
}

TEST_F(ACommander, KnowsATelecommandOfAnotherGroundByItsCopyAndItsReportsBelongToIt) {
  const auto foreign = testing::telecommand_of(
      {.apid = testing::lamp_apid, .sequence_count = 5, .service = 17, .subtype = 1, .source = elsewhere}, {});
  copied(foreign);
  reports_on(pus::read_primary_header(foreign)->request_id, elsewhere, "completed", true);
  EXPECT_THAT(stages_told(), ElementsAre("sent", "completed"));
  EXPECT_EQ(told[1].function, "PING");
  EXPECT_EQ(told[1].sender, "hirosco tc (16385)");
  const auto kept = archive->commands({.span = {}, .text = {}});
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].stage, "completed");
  ASSERT_TRUE(commands.send(bore()));
  copied(sent[0].octets);
  EXPECT_EQ(archive->count_commands({}), 2) << "a copy of its own is known";
  copied(testing::in_octets(std::uint32_t{7}));
  EXPECT_EQ(archive->count_commands({}), 2) << "nor is a damaged one known";
}

TEST_F(ACommander, OfAForeignTelecommandWithoutACopyTellsWhomItWentToAndWhatBecameOfIt) {
  constexpr std::uint32_t to_drill = 0x180A'C003, to_nobody = 0x184D'C004;
  reports_on(to_drill, elsewhere, "accepted");
  reports_on(to_drill, elsewhere, "completed", true);
  reports_on(to_nobody, elsewhere, "failed", true, 1);
  ASSERT_THAT(told, SizeIs(3));
  EXPECT_EQ(told[0].subsystem, "DRILL");
  EXPECT_EQ(told[0].function, "?");
  EXPECT_EQ(told[1].number, told[0].number);
  EXPECT_EQ(told[2].subsystem, "APID 77");
  reports_on(to_drill, pus::supervisor_apid, "completed", true);
  EXPECT_THAT(told, SizeIs(3)) << "the supervisor's own are its business";
}

/// Each asks by itself for what was said before it came, and asks again; its own are answered by themselves.
TEST_F(ACommander, AStationsQuestionIsNoTelecommandOfAnybodyWhateverItWasRefusedFor) {
  constexpr std::uint32_t to_supervisor = 0x1801'C005;
  for (const std::uint16_t station : {std::uint16_t{0x2000}, std::uint16_t{0x3FFF}, own})
    for (const auto code : {pus::FailureCode::Busy, pus::FailureCode::QueueFull, pus::FailureCode::NotPermittedNow})
      reports_on(to_supervisor, question_source(station), "failed", true, static_cast<int>(code));
  EXPECT_THAT(told, IsEmpty());
}

TEST_F(ACommander, WhoTakesASourceIdOfQuestionsForATelecommandToASubsystemIsKnownAllTheSame) {
  constexpr std::uint32_t to_drill = 0x180A'C006;
  reports_on(to_drill, 0xFFFF, "failed", true, static_cast<int>(pus::FailureCode::Busy));
  EXPECT_THAT(stages_told(), ElementsAre("failed"));
  EXPECT_EQ(told.at(0).sender, "another ground (65535)");
}

TEST_F(ACommander, AnotherStationsTelecommandThatFoundTheSupervisorBusyIsKnownThoughTheLinkLostItsCopy) {
  constexpr std::uint32_t to_supervisor = 0x1801'C005;
  constexpr std::uint16_t station = 0x2002;
  reports_on(to_supervisor, station, "failed", true, static_cast<int>(pus::FailureCode::Busy));
  EXPECT_THAT(stages_told(), ElementsAre("failed"));
  EXPECT_EQ(told.at(0).sender, "another ground station (8194)");
  EXPECT_EQ(told.at(0).apid, pus::supervisor_apid);
}

TEST(AQuestionsSource, IsAnotherOneThanThatOfAnybodysTelecommands) {
  for (const std::uint32_t source : {0x0U, 0x1000U, 0x2000U, 0x3FFFU, 0x4000U, 0x7FFFU, 0x8000U, 0xBFFFU})
    EXPECT_FALSE(is_question_source(static_cast<std::uint16_t>(source))) << source;
  EXPECT_EQ(question_source(0x2000), 0xE000);
  EXPECT_EQ(question_source(0x3FFF), 0xFFFF);
  EXPECT_TRUE(is_question_source(question_source(0x2000)));
  EXPECT_TRUE(is_question_source(question_source(0x3FFF)));
}

TEST_F(ACommander, ForgetsOneOfWhichNothingIsHeardForTenMinutes) {
  ASSERT_TRUE(commands.send(bore()));
  pass(600s);
  reports(0, "progress");
  EXPECT_THAT(told, SizeIs(2));
  pass(1ns);
  reports(0, "completed", true);
  EXPECT_THAT(told, SizeIs(2));
}

TEST_F(ACommander, AsksTheSupervisorWhetherOneWouldBePermittedWithoutReportsOnTheQuestion) {
  commands.preview(bore(), keep_answer());
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_EQ(sent_as(0).apid(), pus::supervisor_apid);
  EXPECT_EQ(sent_as(0).service(), 129);
  EXPECT_EQ(sent_as(0).subtype(), 1);
  EXPECT_EQ(sent_as(0).ack(), 0);
  EXPECT_EQ(sent_as(0).source(), question_source(own));
  const auto asked = pus::TelecommandView::parse(sent_as(0).application_data());
  ASSERT_TRUE(asked) << "the whole packet is asked about";
  EXPECT_EQ(asked->apid(), testing::drill_apid);
  EXPECT_EQ(asked->source(), own) << "as it would be sent";
  EXPECT_THAT(answers, IsEmpty());
  judged(0, 0, elsewhere);
  judged(0, 0, own);
  EXPECT_THAT(answers, IsEmpty()) << "that was for another ground";
  judged(0, 0);
  ASSERT_THAT(answers, SizeIs(1));
  const nlohmann::json expected{
      {"octets", in_hex(asked->packet())}, {"permitted", true}, {"code", nullptr}, {"reason", nullptr}};
  EXPECT_EQ(answers[0].value(), expected);
  EXPECT_EQ(archive->count_commands({}), 0) << "nothing was commanded";
}

TEST_F(ACommander, SaysWhyOneWouldNotBePermittedWithTheModeThatIsInTheWay) {
  const auto everybody = testing::overview(catalogue, {.mode = 1}, testing::opening);
  static_cast<void>(model.take(*pus::TelemetryView::parse(everybody)));
  for (int i = 0; i < 3; ++i) commands.preview(bore(), keep_answer());
  judged(0, static_cast<std::uint16_t>(pus::FailureCode::WrongMode));
  judged(1, static_cast<std::uint16_t>(pus::FailureCode::WrongState));
  judged(2, 999);
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ((*answers[0])["permitted"], false);
  EXPECT_EQ((*answers[0])["code"], 13);
  EXPECT_EQ((*answers[0])["reason"], "not permitted in this mode (dark)");
  EXPECT_EQ((*answers[1])["reason"], "not permitted in this state");
  EXPECT_EQ((*answers[2])["reason"], "code 999");
}

TEST_F(ACommander, WaitsTwoSecondsForTheAnswerAndThenSaysThatThereIsNone) {
  commands.preview(bore(), keep_answer());
  pass(2s);
  EXPECT_THAT(answers, IsEmpty());
  pass(1ms);
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_TRUE((*answers[0])["permitted"].is_null());
  EXPECT_EQ((*answers[0])["reason"], "the supervisor did not answer");
  judged(0, 0);
  EXPECT_THAT(answers, SizeIs(1)) << "each is answered once";
  link = false;
  commands.preview(bore(), keep_answer());
  ASSERT_THAT(answers, SizeIs(2));
  EXPECT_EQ((*answers[1])["reason"], "no link to the spacecraft");
  EXPECT_EQ((*answers[1])["octets"].get<std::string>().substr(0, 4), "180A")
      << "what would be sent is known all the same";
  commands.preview(bore(500), keep_answer());
  EXPECT_EQ(answers.at(2).error().status, 400U);
}

TEST_F(ACommander, AsksWhatAModeWouldTakeAndWhoAskedTheSameHasTheSameAnswer) {
  commands.mode_preview({{"mode", "work"}}, keep_answer());
  commands.mode_preview({{"mode", "work"}}, keep_answer());
  commands.mode_preview({{"mode", "dark"}}, keep_answer());
  ASSERT_THAT(sent, SizeIs(3));
  EXPECT_EQ(sent_as(0).subtype(), 4);
  EXPECT_THAT(sent_as(0).application_data(), ElementsAre(std::byte{2}));
  previewed(2, elsewhere);
  EXPECT_THAT(answers, IsEmpty());
  previewed(2);
  ASSERT_THAT(answers, SizeIs(2));
  const nlohmann::json expected{
      {"mode", "work"},
      {"against", {"LAMP is down"}},
      {"steps", nlohmann::json::array({{{"stage", 1}, {"subsystem", "DRILL"}, {"what", "CONFIGURE RUN"}}})}};
  EXPECT_EQ(answers[0].value(), expected);
  EXPECT_EQ(answers[1].value(), expected);
  pass(2s + 1ms);
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[2].error().status, 503U);
  EXPECT_EQ(answers[2].error().text, "the supervisor did not answer");
}

TEST_F(ACommander, DoesNotAskForAModeThatThereIsNotOrWithoutALink) {
  commands.mode_preview({{"mode", "bright"}}, keep_answer());
  EXPECT_EQ(answers.at(0).error().status, 400U);
  EXPECT_EQ(answers.at(0).error().text, "no mode 'bright'");
  link = false;
  commands.mode_preview({{"mode", "work"}}, keep_answer());
  EXPECT_EQ(answers.at(1).error().status, 503U);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(ACommander, AQuestionOfTheStationHasItsRequestIdAndNoneWhereItDoesNotLeave) {
  const auto asked = commands.ask(11, {});
  ASSERT_TRUE(asked);
  EXPECT_EQ(*asked, pus::read_primary_header(sent.at(0).octets)->request_id);
  leaves = false;
  EXPECT_EQ(commands.ask(11, {}), std::nullopt);
}

}  // namespace
}  // namespace hirosco::ground
