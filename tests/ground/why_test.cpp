// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "tests/ground/station.hpp"

/// What a station says of why a flying spacecraft stopped (GET /api/why).
namespace hirosco::testing {
namespace {

TEST_F(GroundStation, WhyTellsTheCauseFirstThenWhatItBroughtAbout) {
  commission();
  EXPECT_EQ(station.get("/api/why")["causes"].size(), 0U);
  for (int step = 0; step < 30; ++step) {
    EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "hand target 0.01 0"}})["answer"], "ok");
    station.run(50ms);
  }
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(2s);
  const json why = station.get("/api/why");
  std::string story;
  for (const json& cause : why["causes"]) story += cause["text"].get<std::string>() + "\n";
  std::size_t at = 0;
  for (const char* part : {"Fault injected: joystick unplug", "JOYSTICK lost its device: ",
                           "MANIPULATOR and JOYSTICK: plan network-down wants Error-Operational",
                           "MANIPULATOR and JOYSTICK → Error-Operational", "MANIPULATOR and JOYSTICK → Offline"}) {
    at = story.find(part, at);
    ASSERT_NE(at, std::string::npos) << part << " in\n" << story;
  }
  EXPECT_EQ(story.find("hand"), std::string::npos) << "what the hand did before has nothing to do with it:\n" << story;
  EXPECT_LE(why["causes"].size(), 9U) << story;
  EXPECT_TRUE(why["causes"][0]["after_ms"].is_null()) << "nobody on board saw the cable go";
  EXPECT_EQ(why["causes"][1]["after_ms"], 0.0);
  EXPECT_EQ(why["causes"][1]["severity"], "high");
  EXPECT_EQ(why["severity"], "high");
  EXPECT_EQ(why["plan"], "network-down");
  EXPECT_EQ(why["mode"], "telepresence");
  EXPECT_THAT(why["title"].get<std::string>(),
              ::testing::ContainsRegex("^JOYSTICK lost its device: [a-z ]+. JOYSTICK and MANIPULATOR were stopped.$"))
      << "a reason in words, no counters";
  EXPECT_THAT(
      why["detail"].get<std::string>(),
      ::testing::ContainsRegex("JOYSTICK and MANIPULATOR went Offline within [0-9.]+ ms, by plan network-down"));
  EXPECT_THAT(why["detail"].get<std::string>(), ::testing::HasSubstr("COMMUNICATION"));
  EXPECT_EQ(station.get("/api/why?to=1")["causes"].size(), 0U) << "a replay of before knows nothing of it";
}

TEST_F(GroundStation, WhyKnowsWhatWasInjectedPastTheStationAndCountsOnceWhatWasInjectedHere) {
  commission();
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "delay 1"}})["answer"], "ok");
  EXPECT_NE(station.post("/api/faults", {{"device", "joystick"}, {"line", "no such thing"}})["answer"], "ok");
  station.run(3s);  // what was done longer ago than 2 s before a stop is not its cause
  const auto told = [&] {
    std::string all;
    for (const auto& fault : station.session().archive().faults({{}, OnboardTime::max()}))
      all += fault.line + " " + fault.answer.substr(0, 2) + "; ";
    return all;
  };
  EXPECT_NE(told().find("delay 1 ok; "), std::string::npos);
  EXPECT_EQ(told().find("delay 1 ok; "), told().rfind("delay 1 ok; ")) << told();
  ASSERT_TRUE(station.inject("joystick", "unplug"));
  station.run(2s);
  EXPECT_NE(told().find("unplug ok; "), std::string::npos) << told();
  EXPECT_EQ(station.get("/api/why")["causes"][0]["text"], "Fault injected: joystick unplug");
}

TEST_F(GroundStation, WhyNamesWhoLostItsDeviceAndNotWhoSawTheEffectInTheSameInstant) {
  const auto event = [](std::uint16_t id) {
    std::vector<std::byte> data(40);
    data[0] = static_cast<std::byte>(id >> 8);
    data[1] = static_cast<std::byte>(id & 0xFF);
    return data;
  };
  const auto stale = descriptor::framework_event::set_stale(0), lost = descriptor::framework_event::device_lost(0);
  ASSERT_TRUE(station.session().receive(telemetry(10, 5, 3, noon, event(stale))));
  ASSERT_TRUE(station.session().receive(telemetry(11, 5, 4, noon + 300us, event(lost))));
  const json why = station.get("/api/why");
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::StartsWith("JOYSTICK lost its device"));
  EXPECT_EQ(why["severity"], "high");
  ASSERT_EQ(why["causes"].size(), 2U);
  EXPECT_THAT(why["causes"][0]["text"].get<std::string>(), ::testing::StartsWith("JOYSTICK lost its device"));
  EXPECT_EQ(why["causes"][1]["text"], "MANIPULATOR misses samples of JOYSTICK_STATE")
      << "no age of what was taken away";
}

TEST_F(GroundStation, WhyCallsADeviceThatHungUpByWhatThatMeans) {
  std::vector<std::byte> data(40);
  const auto lost = descriptor::framework_event::device_lost(0);
  data[0] = static_cast<std::byte>(lost >> 8), data[1] = static_cast<std::byte>(lost & 0xFF);
  data[2] = static_cast<std::byte>(descriptor::DeviceLoss::HungUp);
  ASSERT_TRUE(station.session().receive(telemetry(11, 5, 4, noon, data)));
  EXPECT_EQ(station.get("/api/why")["title"], "JOYSTICK lost its device: the connection was closed.");
}

TEST_F(GroundStation, WhyFoldsTheStepsOfAHandThatTrippedTheLimit) {
  commission();
  for (int step = 0; step < 20; ++step) {
    station.post("/api/faults", {{"device", "joystick"}, {"line", "hand ramp 0.065 0 0.04"}});
    station.run(50ms);
  }
  station.run(2s);
  const json why = station.get("/api/why");
  ASSERT_GE(why["causes"].size(), 2U);
  EXPECT_THAT(why["causes"][0]["text"].get<std::string>(), ::testing::ContainsRegex("^The hand moved .[0-9]+ steps.$"));
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::StartsWith("MANIPULATOR: torque limit exceeded (joint "));
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::HasSubstr("limit 12 N m"));
  EXPECT_EQ(why["plan"], "to-safe");
  EXPECT_EQ(why["severity"], "medium");
}

TEST_F(GroundStation, WhyTellsOfASafeAllToo) {
  commission();
  EXPECT_EQ(station.command("SUPERVISOR", "SAFE_ALL")["stage"], "completed");
  const json why = station.get("/api/why");
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::StartsWith("SAFE ALL"));
  EXPECT_EQ(why["detail"], "By telecommand of operator.");
  ASSERT_GE(why["causes"].size(), 1U);
  EXPECT_EQ(why["causes"][0]["text"], "SAFE ALL by operator, completed");
}

TEST_F(GroundStation, WhyTellsAStopOnTheComputerOfTheFlightAndNotTheOneBeforeIt) {
  commission();
  ASSERT_TRUE(station.inject("joystick", "unplug"));
  station.run(2s);
  EXPECT_THAT(station.get("/api/why")["title"].get<std::string>(), ::testing::StartsWith("JOYSTICK lost its device"));
  station.run(5s);
  flight.craft().guard().stop_all(supervisor::GuardFinding::Kind::StopAsked);
  station.run(1s);
  const json why = station.get("/api/why");
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::StartsWith("SAFE ALL"));
  EXPECT_THAT(why["detail"].get<std::string>(), ::testing::HasSubstr("hirosco safe"));
  ASSERT_EQ(why["causes"].size(), 1U) << why.dump(1);
  EXPECT_EQ(why["causes"][0]["text"], "SAFE ALL on the computer of the flight");
  EXPECT_EQ(why["stopped"], json::array({"all"}));
}

TEST_F(GroundStation, WhyTellsWhatASafeAllBroughtAboutAndWhatWasBeforeItAsItsStory) {
  commission();
  ASSERT_TRUE(station.inject("joystick", "unplug"));
  station.run(1s);
  EXPECT_EQ(station.command("SUPERVISOR", "SAFE_ALL")["stage"], "failed") << "who is unplugged confirms no stop";
  const std::vector<std::byte> data = [] {
    std::vector<std::byte> event(40);
    const auto stale = descriptor::framework_event::set_stale(0);
    event[0] = static_cast<std::byte>(stale >> 8), event[1] = static_cast<std::byte>(stale & 0xFF);
    return event;
  }();
  const auto now = OnboardTime{} + std::chrono::duration_cast<Duration>(
                                       std::chrono::duration<double>(station.get("/api/why")["t"].get<double>() + 0.1));
  ASSERT_TRUE(station.session().receive(telemetry(10, 5, 3, now, data)));
  const json why = station.get("/api/why");
  EXPECT_THAT(why["title"].get<std::string>(), ::testing::StartsWith("SAFE ALL"));
  EXPECT_THAT(why["causes"][0]["text"].get<std::string>(), ::testing::StartsWith("JOYSTICK lost its device"));
  EXPECT_TRUE(why["causes"][0]["after_ms"].is_null());
  EXPECT_EQ(why["causes"].back()["text"], "MANIPULATOR misses samples of JOYSTICK_STATE") << why.dump(1);
}

TEST(GroundStationWhereNobodyIsRestarted, WhyNamesWhoHasToBeStartedAgainBeforeTheMode) {
  simulation::Plan plan = rokviss();
  plan.edit = [edit = plan.edit](auto& mission) {
    edit(mission);
    std::erase_if(mission.plans, [](const descriptor::Plan& each) { return each.event == "PROCESS_DIED"; });
  };
  simulation::Flight flight{plan};
  Station station{flight};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  station.run(1s);
  flight.craft().kill("JOYSTICK");
  station.run(2s);
  const json why = station.get("/api/why");
  EXPECT_EQ(why["title"], "The process of JOYSTICK died. MANIPULATOR was stopped.") << why.dump(1);
  EXPECT_EQ(why["down"], json::array({"JOYSTICK"}));
  EXPECT_EQ(station.command("JOYSTICK", "SET_STATE", {{"STATE", 0}})["stage"], "completed");
  station.run(2s);
  EXPECT_EQ(station.get("/api/why")["down"], json::array());
}

}  // namespace
}  // namespace hirosco::testing
