// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "tests/ground/station.hpp"

/// What the archive tells of the past: history, replay, gaps, timeline, exports.
namespace hirosco::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(GroundStation, HistoryIsWhatTheLiveViewShowedAndLongOnesKeepTheirExtremes) {
  commission();
  Page page;
  station.session().pages().opened(page, true);
  const double from = station.get("/api/status")["t"].get<double>();
  station.run(2s);
  const std::string name = "MANIPULATOR.CUR_VALUES.TORQUE[1]";
  std::map<double, double> live;
  for (const json& message : page.of_type("values"))
    if (message["set"].contains(name))
      live[message["set"][name][1].get<double>()] = message["set"][name][0].get<double>();
  const json history = station.get("/api/history?parameter=" + name + "&from=" + std::to_string(from));
  std::map<double, double> past;
  for (std::size_t i = 0; i < history["t"].size(); ++i)
    past[history["t"][i].get<double>()] = history["v"][i].get<double>();
  EXPECT_GE(live.size(), 35U);  // 20 a second, in batches of the same rate
  for (const auto& [t, value] : live)
    if (t >= from) {
      EXPECT_EQ(past.at(t), value);
    }
  EXPECT_EQ(history["unit"], "N m");

  const json few = station.get("/api/history?parameter=" + name + "&points=10&from=" + std::to_string(from));
  EXPECT_LE(few["t"].size(), 10U);
  const auto all = history["v"].get<std::vector<double>>();
  EXPECT_EQ(few["min"].size(), few["max"].size());
  EXPECT_EQ(std::ranges::min(few["min"].get<std::vector<double>>()), std::ranges::min(all));
  EXPECT_EQ(std::ranges::max(few["max"].get<std::vector<double>>()), std::ranges::max(all));
}

TEST_F(GroundStation, PlacesOfNumbersAgreeWithTheDecoderOfHousekeepingInAllReports) {
  std::size_t compared = 0;
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.service() != 3 || packet.subtype() != 25) return;
    const auto* subsystem = station.catalogue().find(packet.apid());
    const auto decoded = pus::HousekeepingDecoder{*subsystem}.decode(packet.source_data());
    const auto* report = station.catalogue().report_of(packet.apid(), packet.source_data());
    ASSERT_TRUE(decoded && report != nullptr);
    std::map<std::string, double> expected;
    for (const auto& value : *decoded)
      for (std::size_t i = 0; i < value.values.size(); ++i)
        expected[subsystem->name + "." + value.name + (value.values.size() == 1 ? "" : "[" + std::to_string(i) + "]")] =
            value.values[i];
    EXPECT_EQ(report->places.size(), expected.size());
    for (const auto& place : report->places) {
      const auto& column = station.catalogue().columns()[place.column];
      EXPECT_EQ(station.catalogue().read(place, packet.source_data()), expected.at(column.name)) << column.name;
      ++compared;
    }
  };
  commission();
  station.run(1s);
  EXPECT_GT(compared, 2000U);
}

TEST_F(GroundStation, ReplayTellsTheSameStoryAndLocksCommanding) {
  commission();
  const double from = station.get("/api/status")["t"].get<double>();
  Page live;
  station.session().pages().opened(live, true);
  station.run(50ms);
  station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}});
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(2s);
  const double to = station.get("/api/status")["t"].get<double>();

  Page page;
  const std::string client = station.session().pages().opened(page, true);
  page.messages.clear();
  station.session().pages().received(page, json{{"type", "replay"}, {"at", from}, {"speed", 10}}.dump());
  EXPECT_EQ(page.messages.front()["type"], "replay");
  const json first = page.last("status");
  EXPECT_EQ(subsystem_of(first, "JOYSTICK")["state"], "Operational");
  EXPECT_EQ(first["replay"], true);
  const auto refused =
      station.ask("POST", "/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "CENTRE"}}, {{"x-client", client}});
  EXPECT_EQ(refused.status, 409U);
  ASSERT_TRUE(station.run_until([&] { return page.last("replay")["state"] == "ended"; }));
  const auto texts = [&](const Page& who) {
    std::vector<std::string> list;
    for (const json& message : who.messages) {
      if (message.contains("t") && message["t"].is_number() && message["t"].get<double>() > to) continue;
      if (message["type"] == "event")
        list.push_back(message["subsystem"].get<std::string>() + message["text"].get<std::string>());
    }
    return list;
  };
  EXPECT_EQ(texts(page), texts(live));
  EXPECT_GT(texts(page).size(), 5U);
  EXPECT_EQ(page.of_type("command").size(), live.of_type("command").size());
  EXPECT_EQ(page.of_type("fault").size(), 1U);
  EXPECT_EQ(subsystem_of(page.last("status"), "JOYSTICK")["state"], "Offline");

  station.session().pages().received(page, R"({"type":"live"})");
  EXPECT_EQ(page.last("replay")["state"], "live");
  EXPECT_FALSE(page.last("status").contains("replay"));
  EXPECT_EQ(station
                .ask("POST", "/api/commands/preview", {{"subsystem", "JOYSTICK"}, {"function", "PING"}},
                     {{"x-client", client}})
                .status,
            200U);
}

TEST_F(GroundStation, ALinkThatWasAwayIsAGapAndValuesGrowOldMeanwhile) {
  commission();
  Page page;
  station.session().pages().opened(page, true);
  station.cut_link();
  station.run(3s);
  const json away = station.get("/api/status");
  EXPECT_EQ(away["link"]["connected"], false);
  EXPECT_NEAR(away["link"]["age_s"].get<double>(), 3.0, 0.1);
  EXPECT_NEAR(away["values"]["MANIPULATOR.TIP_FORCE[0]"]["age_s"].get<double>(), 3.0, 0.2);
  EXPECT_EQ(station.ask("POST", "/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}}).status, 503U);
  station.join_link();
  station.run(500ms);
  ASSERT_EQ(page.of_type("gap").size(), 1U);
  const json gap = page.last("gap");
  EXPECT_NEAR(gap["to"].get<double>() - gap["from"].get<double>(), 3.0, 0.2);
  // Until it was fetched from the log on board.
  ASSERT_TRUE(station.run_until([&] { return !page.of_type("filled").empty(); }));
  const json history = station.get("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=10");
  EXPECT_EQ(history["gaps"].size(), 0U);
  const auto within = [&](double t) { return t > gap["from"].get<double>() && t < gap["to"].get<double>(); };
  EXPECT_GE(std::ranges::count_if(history["t"], within), 10) << "four a second were said in these three seconds";
}

TEST_F(GroundStation, WhatWasSaidBeforeItsFirstLinkIsToldAsIfItHadHeardIt) {
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.craft().supervisor().commissioned(); }, 60s));
  flight.craft().run(2s);
  Page page;
  station.session().pages().opened(page, true);
  station.join_link();
  ASSERT_TRUE(station.run_until([&] {
    return !page.of_type("filled").empty() && station.get("/api/timeline?from=0&to=4000000000")["gaps"].empty();
  }));
  const json timeline = station.get("/api/timeline?from=0&to=4000000000");
  std::map<std::string, std::vector<std::string>> way_up;
  for (const json& state : timeline["states"]) way_up[state["subsystem"]].push_back(state["state"]);
  for (const char* one : {"MANIPULATOR", "JOYSTICK"})
    EXPECT_THAT(way_up[one], ::testing::IsSupersetOf(
                                 {"SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational"}))
        << one;
  // Nothing old is taken for new.
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "MANIPULATOR")["state"], "Operational");
  EXPECT_EQ(station.command("JOYSTICK", "PING")["stage"], "completed");
}

TEST_F(GroundStation, AVerdictAndAnAlarmThatWereMissedReachTheirTelecommandAndTheOperator) {
  commission();
  Page page;
  station.session().pages().opened(page, true);
  station.post("/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}});
  station.cut_link();  // it has left, its reports find nobody
  flight.craft().run(500ms);
  ASSERT_TRUE(station.inject("robot", "unplug"));
  station.run(3s);
  const auto alarms = [&] { return station.get("/api/alarms")["alarms"].size(); };
  EXPECT_EQ(alarms(), 0U);
  EXPECT_NE(station.get("/api/commands")["commands"][0]["stage"], "completed");
  station.join_link();
  ASSERT_TRUE(station.run_until([&] { return !page.of_type("filled").empty(); }));
  EXPECT_EQ(station.get("/api/commands")["commands"][0]["stage"], "completed");
  EXPECT_GE(alarms(), 1U);
  EXPECT_GE(page.of_type("alarm").size(), 1U) << "somebody is called";
}

TEST_F(GroundStation, AReplayBeginsWithTheNewestValuesHoweverOldThoseOfOthersAre) {
  const ground::Report& other = station.catalogue().reports().back();
  ASSERT_NE(other.apid, 10);
  std::vector<std::byte> data(other.octets);
  OctetWriter{data}.put(other.sid);
  ASSERT_TRUE(station.session().receive(telemetry(other.apid, 3, 25, noon - 1h, data)));
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  Page page;
  station.session().pages().opened(page, true);
  station.session().pages().received(page, json{{"type", "replay"}, {"at", 2'145'916'900.0}, {"speed", 0}}.dump());
  EXPECT_EQ(page.last("values")["replay"], true);
  EXPECT_EQ(page.last("values")["set"][first_joint][1], 2'145'916'900.0);
}

TEST_F(GroundStation, AReplayLeavesOutNoEventOfABurst) {
  const std::vector<std::byte> event(2);
  constexpr std::size_t burst = 3500;
  for (std::size_t i = 0; i < burst; ++i)
    ASSERT_TRUE(station.session().receive(telemetry(11, 5, 1, noon + 1s + i * 10us, event)));
  ASSERT_TRUE(station.session().receive(joints(noon + 3s, 1.0)));
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  Page page;
  station.session().pages().opened(page, true);
  page.messages.clear();
  station.session().pages().received(page, json{{"type", "replay"}, {"at", 2'145'916'900.0}, {"speed", 100}}.dump());
  ASSERT_TRUE(station.run_until([&] { return page.last("replay")["state"] == "ended"; }));
  EXPECT_EQ(page.of_type("event").size(), burst);
}

TEST_F(GroundStation, ATimelineWithTooManyEventsHasTheNewest) {
  const std::vector<std::byte> event(2);
  for (int i = 0; i < 10'500; ++i) ASSERT_TRUE(station.session().receive(telemetry(11, 5, 1, noon + i * 1ms, event)));
  const json events = station.get("/api/timeline?from=2145916800&to=2145917000")["events"];
  ASSERT_EQ(events.size(), 10'000U);
  EXPECT_NEAR(events.front()["t"].get<double>(), 2'145'916'900.5, 0.001);
  EXPECT_NEAR(events.back()["t"].get<double>(), 2'145'916'910.499, 0.001);
}

TEST_F(GroundStation, TheLogTellsEveryPacketInWordsNewestFirst) {
  commission();
  EXPECT_EQ(station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}})["stage"], "completed");
  const auto lines = [&](const std::string& query) {
    std::vector<std::string> texts;
    const json answer = station.get("/api/log?" + query);
    for (const json& packet : answer["packets"]) texts.push_back(packet["text"]);
    return texts;
  };
  const auto found = lines("text=Set_Force+joystick");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found.front(), HasSubstr("TM[129,3] SUPERVISOR copy of TC[8,1] JOYSTICK"));
  EXPECT_THAT(found.front(), HasSubstr("SET_FORCE_SCALE SCALE=0.05"));
  EXPECT_THAT(lines("text=completed&limit=1").front(), HasSubstr("TM[1,7] JOYSTICK completed JOYSTICK"));
  EXPECT_TRUE(lines("text=housekeeping").empty());
  EXPECT_FALSE(lines("text=housekeeping&housekeeping=1").empty());
  EXPECT_TRUE(lines("text=no+such+words").empty());
  EXPECT_TRUE(lines("to=1").empty());
}

TEST_F(GroundStation, TheLogGoesOnWhereAnAnswerEnded) {
  commission();
  const json whole = station.get("/api/log?limit=2000");
  EXPECT_TRUE(whole["before"].is_null());
  json pages = json::array();
  std::string before;
  for (json page; page.empty() || !page["before"].is_null();) {
    page = station.get("/api/log?limit=7" + before);
    before = "&before=" + page["before"].dump();
    for (const json& packet : page["packets"]) pages.push_back(packet);
    ASSERT_LE(pages.size(), whole["packets"].size());
  }
  EXPECT_EQ(pages, whole["packets"]);
}

TEST_F(GroundStation, AnExportThatWouldHoldUpTheLiveViewIsRefused) {
  // As many columns as a request may have: each of them is a reading of the whole span.
  for (int i = 0; i < 20'000; ++i) ASSERT_TRUE(station.session().receive(joints(noon + i * 10ms, 1.0)));
  std::string target = "/api/export.csv?from=2145916800&to=2145917200";
  for (int i = 0; i < 64; ++i) target += "&parameter=" + std::string{first_joint};
  EXPECT_EQ(station.ask("GET", target).status, 413U);
  const auto one =
      station.ask("GET", "/api/export.csv?from=2145916800&to=2145917200&parameter=" + std::string{first_joint});
  EXPECT_EQ(one.status, 200U);
  EXPECT_EQ(std::ranges::count(one.body, '\n'), 20'001);
  // 1958-01-01 TAI and 37 leap seconds: by Python's datetime.
  EXPECT_TRUE(
      one.body.starts_with("t,utc," + std::string{first_joint} + "\n2145916900.000000,2026-01-01T00:01:03.000000Z,1\n"))
      << one.body.substr(0, 200);
}

}  // namespace
}  // namespace hirosco::testing
