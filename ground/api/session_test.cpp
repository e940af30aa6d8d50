// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using testing::opening;
using testing::PlayedPage;
using ::testing::SizeIs;

class ASession : public testing::PlayedStation {
 protected:
  PlayedPage page, other;
};

TEST_F(ASession, KnowsTheTimeOnBoardByTheNewestPacketAndWhatHasPassedSince) {
  EXPECT_EQ(session.now(), clock.onboard()) << "as far as anybody can tell";
  hears(testing::torque_high(catalogue, opening + 1h));
  clock.advance(3s);
  EXPECT_EQ(session.now(), opening + 1h + 3s);
}

TEST_F(ASession, KeepsEachPacketAndWhatItSaidAndTellsItsPages) {
  session.pages().opened(page, true);
  session.pages().opened(other, false);
  hears(testing::torque_high(catalogue, opening));
  for (const PlayedPage* one : {&page, &other}) {
    EXPECT_EQ(one->last("event")["name"], "TORQUE_HIGH");
    EXPECT_EQ(one->last("alarm")["count"], 1) << "it is an alarm, too";
  }
  EXPECT_EQ(archive->extent().value_or(Span{}).from, opening);
  EXPECT_THAT(archive->events({.span = {}, .text = {}}), SizeIs(1));
  hears(testing::state_changed(catalogue, "DRILL", descriptor::State::Operational, opening + 1s));
  EXPECT_THAT(archive->changes({}), SizeIs(1));
  EXPECT_EQ(page.count("alarm"), 1U) << "a change of state is none";
}

TEST_F(ASession, TellsWhatWasLostBetweenTwoLinks) {
  session.pages().opened(page, true);
  session.link_up();
  hears(testing::torque_high(catalogue, opening));
  session.link_down();
  session.link_up();
  EXPECT_EQ(page.count("gap"), 0U);
  hears(testing::torque_high(catalogue, opening + 60s));
  EXPECT_EQ(page.last("gap")["from"], 2'145'916'900);
  EXPECT_EQ(page.last("gap")["to"], 2'145'916'960);
  ASSERT_THAT(archive->gaps({}), SizeIs(1));
  pass(batch);
  ASSERT_FALSE(sent.empty());
  const auto question = pus::TelecommandView::parse(sent.back());
  EXPECT_EQ(question->subtype(), pus::st129::retrieve) << "and asks the log on board";
  const auto missed = testing::torque_high(catalogue, opening + 30s);
  std::array<std::byte, pus::max_telemetry_octets> data{};
  hears(testing::packet_of({.apid = pus::supervisor_apid,
                            .service = pus::st129::service_type,
                            .subtype = pus::st129::retrieved,
                            .destination = question->source(),
                            .time = opening + 61s},
                           pus::st129::write_retrieved(data, {1, missed})));
  pass(batch);
  EXPECT_EQ(page.last("event")["t"], 2'145'916'930) << "what comes to the source id of its question is its own";
}

TEST_F(ASession, OfAStreamThatIsNoTelemetryWantsAnotherLink) {
  const std::vector<std::byte> junk(64, std::byte{0xFF});
  EXPECT_FALSE(session.receive(junk));
}

TEST_F(ASession, TellsOfAnotherFlight) {
  session.pages().opened(page, true);
  hears(testing::overview(catalogue, {.more = {{"SUPERVISOR.SUBSYSTEMS.CYCLES[0]", 500}}}, opening));
  EXPECT_EQ(page.last("flight")["id"], 1);
  hears(testing::overview(catalogue, {.more = {{"SUPERVISOR.SUBSYSTEMS.CYCLES[0]", 100}}}, opening + 60s));
  EXPECT_EQ(page.last("flight")["id"], 2) << "its cycles begin anew";
  EXPECT_EQ(page.count("flight"), 2U);
}

TEST_F(ASession, FollowsATelecommandForEverybody) {
  session.pages().opened(page, true);
  session.pages().opened(other, false);
  session.link_up();
  ASSERT_TRUE(session.command(bore("a")));
  hears(verdict(0, 7, opening));
  EXPECT_EQ(other.last("command")["stage"], "completed");
  EXPECT_EQ(other.last("command")["sender"], "anna");
  ASSERT_TRUE(session.command(bore("a")));
  session.not_sent(sent.back());
  EXPECT_EQ(page.last("command")["reason"], "not sent: the link was lost");
}

TEST_F(ASession, LetsOneSeatCommandAndNobodyIsRefusedAStop) {
  session.link_up();
  ASSERT_TRUE(session.command(bore("a", "anna")));
  const auto refused = session.command(bore("b", "ben"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, 409U);
  EXPECT_THAT(sent, SizeIs(1));
  EXPECT_TRUE(session.command({{"subsystem", "SUPERVISOR"}, {"function", "SAFE_ALL"}, {"seat", "b"}}));
  EXPECT_EQ(session.command({{"subsystem", "DRILL"}, {"function", "SAW"}, {"seat", "b"}}).error().status, 400U)
      << "what is no telecommand is said first";
}

TEST_F(ASession, AsksOnceMoreWhatIsToBeConfirmed) {
  session.link_up();
  nlohmann::json wipe{{"subsystem", "DRILL"}, {"function", "WIPE"}, {"seat", "a"}};
  EXPECT_EQ(session.command(wipe).error().status, 409U);
  wipe["confirmed"] = "true";
  EXPECT_EQ(session.command(wipe).error().status, 409U) << "a text is no yes";
  EXPECT_TRUE(session.authority()["holder"].is_null()) << "who is asked once more has not commanded yet";
  wipe["confirmed"] = true;
  EXPECT_TRUE(session.command(wipe));
}

TEST_F(ASession, TellsEverybodyWhoCommandsAndKeepsIt) {
  session.pages().opened(page, true, "b");
  EXPECT_EQ(session.authority({{"action", "grab"}, {"seat", "a"}}).error().status, 400U);
  const auto taken = session.authority({{"action", "take"}, {"seat", "a"}, {"sender", "anna"}});
  ASSERT_TRUE(taken);
  EXPECT_EQ((*taken)["holder"]["name"], "anna");
  EXPECT_EQ(page.last("authority")["holder"]["seat"], "a");
  EXPECT_EQ(page.last("authority")["did"]["action"], "took");
  EXPECT_THAT(archive->marks("authority", {}), SizeIs(1));
  pass(Authority::absence_limit + 2s);
  EXPECT_TRUE(session.authority()["holder"].is_null()) << "no page of that seat is open";
}

TEST_F(ASession, TellsEverybodyOfStacksNotesAndAcknowledgedAlarms) {
  hears(testing::overview(catalogue, {}, opening));
  hears(testing::torque_high(catalogue, opening));
  session.pages().opened(page, true);
  ASSERT_TRUE(session.keep_stack({{"name", "home"}, {"text", "hirosco tc DRILL WIPE"}, {"sender", "anna"}}));
  EXPECT_EQ(page.last("stacks")["stacks"][0]["who"], "anna");
  ASSERT_TRUE(session.tell_of_flight({{"flight", 1}, {"note", "loud"}}));
  EXPECT_EQ(page.last("notes")["notes"][0]["who"], "operator") << "who does not say who it is";
  const auto named = session.tell_of_flight({{"flight", 1}, {"name", "the wall"}});
  ASSERT_TRUE(named);
  EXPECT_EQ((*named)["name"], "the wall");
  const auto alarms = session.alarm({{"subsystem", "DRILL"}, {"event", "TORQUE_HIGH"}, {"action", "acknowledge"}});
  ASSERT_TRUE(alarms);
  EXPECT_EQ((*alarms)["alarms"][0]["fresh"], 0);
  EXPECT_EQ(page.last("alarm")["fresh"], 0);
  ASSERT_TRUE(session.alarm({{"subsystem", "*"}, {"action", "acknowledge"}}));
  EXPECT_EQ(page.count("alarms"), 1U);
}

TEST_F(ASession, SaysHowItIsWithTheAgeOfEachValue) {
  session.link_up();
  runs_at(opening, 2.5);
  clock.advance(3s);
  const auto told = session.status();
  EXPECT_EQ(told["commandable"], true);
  EXPECT_EQ(told["values"]["DRILL.SPEED"], (nlohmann::json{{"v", 2.5}, {"t", 2'145'916'900}, {"age_s", 3}}));
  EXPECT_FALSE(told["values"].contains("DRILL.LABEL")) << "nobody has told it";
  EXPECT_EQ(told["link"]["connected"], true);
  EXPECT_EQ(told["link"]["age_s"], 3);
  EXPECT_EQ(told["link"]["rx"], 1);
  EXPECT_EQ(told["link"]["archive_failures"], 0);
  session.link_down();
  EXPECT_EQ(session.status()["commandable"], false);
}

TEST_F(ASession, OfTheNextStationGoesOnWhereTheArchiveEnds) {
  hears(testing::torque_high(catalogue, opening));
  Session next{{.catalogue = catalogue, .archive = *archive, .clock = clock, .outside = {{}, {}, {}}}};
  next.pages().opened(page, true);
  EXPECT_TRUE(next.link_json()["age_s"].is_null()) << "it has heard nothing itself";
  next.link_up();
  EXPECT_TRUE(next.receive(testing::torque_high(catalogue, opening + 60s)));
  EXPECT_EQ(page.last("gap")["from"], 2'145'916'900);
}

}  // namespace
}  // namespace hirosco::ground
