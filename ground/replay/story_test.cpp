// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/story.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"
#include "hirosco/pus/packet/failure_code.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;

class AStory : public testing::ArchiveOfAWorkshop {
 protected:
  using State = descriptor::State;

  [[nodiscard]] nlohmann::json why(OnboardTime to = OnboardTime::max()) {
    return newest_story(catalogue, *archive, to);
  }
  [[nodiscard]] static std::vector<std::string> lines(const nlohmann::json& story) {
    std::vector<std::string> texts;
    for (const auto& cause : story["causes"]) texts.push_back(cause["text"].get<std::string>());
    return texts;
  }
  void in_mode(const char* mode) { archive->add(StoredChange{opening - 60s, "mode", "", mode}); }
  void loses_spindle(OnboardTime t, descriptor::DeviceLoss reason) {
    hears(testing::event_packet(
        catalogue, "DRILL", "SPINDLE_A_LOST", t,
        testing::in_octets(static_cast<std::uint8_t>(reason), std::uint32_t{3}, std::uint32_t{0}, std::uint32_t{0})));
  }
  void misses_speed(OnboardTime t, std::uint32_t age) {
    hears(testing::event_packet(catalogue, "LAMP", "SPEED_STALE", t, testing::in_octets(age)));
  }
  void torque(OnboardTime t) { hears(testing::torque_high(catalogue, t)); }
  void becomes(const char* subsystem, State state, OnboardTime t) {
    hears(testing::state_changed(catalogue, subsystem, state, t));
  }
  void plan_wants(std::uint16_t apid, State state, OnboardTime t) {
    hears(testing::event_packet(catalogue, "SUPERVISOR", "RECOVERY_STEP", t,
                                testing::in_octets(apid, static_cast<std::uint8_t>(state))));
  }
  void injected(const char* line, OnboardTime t, const char* answer = "ok") {
    archive->add(StoredFault{t, "spindle", line, answer});
  }
};

TEST_F(AStory, IsNoneWhereNothingStopped) {
  becomes("DRILL", State::Operational, opening);
  EXPECT_EQ(why(), (nlohmann::json{{"causes", nlohmann::json::array()}}));
}

TEST_F(AStory, TellsTheCauseFirstAndThenWhatItBroughtAboutWithThoseTogetherThatDidTheSame) {
  in_mode("work");
  for (const char* subsystem : {"SUPERVISOR", "DRILL", "LAMP"}) becomes(subsystem, State::Operational, opening - 50s);
  injected("unplug", opening - 125ms);
  loses_spindle(opening, descriptor::DeviceLoss::Silent);
  plan_wants(testing::drill_apid, State::ErrorOperational, opening + 125ms);
  plan_wants(testing::lamp_apid, State::ErrorOperational, opening + 125ms);
  becomes("DRILL", State::ErrorOperational, opening + 250ms);
  becomes("LAMP", State::ErrorOperational, opening + 375ms);
  becomes("DRILL", State::PostOperational, opening + 500ms);
  becomes("DRILL", State::Offline, opening + 625ms);
  becomes("LAMP", State::Offline, opening + 1s);
  hears(testing::overview(catalogue, {.drill = 255, .lamp = 0, .link_up = 0}, opening + 2s));

  const auto story = why();
  EXPECT_THAT(lines(story), ElementsAre("Fault injected: spindle unplug", "DRILL lost its device SPINDLE.A: silent",
                                        "DRILL and LAMP: plan network-down wants Error-Operational",
                                        "DRILL and LAMP → Error-Operational", "DRILL and LAMP → Offline",
                                        "Link 1 down, as housekeeping tells"));
  EXPECT_TRUE(story["causes"][0]["after_ms"].is_null()) << "nobody on board knows when";
  EXPECT_EQ(story["causes"][1]["after_ms"], 0);
  EXPECT_EQ(story["causes"][2]["after_ms"], 125);
  EXPECT_EQ(story["causes"][3]["after_ms"], 375) << "when all have reached it";
  EXPECT_EQ(story["causes"][4]["after_ms"], 1000);
  EXPECT_EQ(story["causes"][1]["severity"], "high");
  EXPECT_EQ(story["title"], "DRILL lost its device SPINDLE.A: silent. DRILL and LAMP were stopped.");
  EXPECT_EQ(story["detail"], "DRILL and LAMP went Offline within 1.0 s, by plan network-down. SUPERVISOR goes on.");
  EXPECT_EQ(story["advice"], "Mend or plug in the device SPINDLE.A, then bring work up.");
  EXPECT_EQ(story["t"], 2'145'916'900);
  EXPECT_EQ(story["severity"], "high");
  EXPECT_EQ(story["mode"], "work");
  EXPECT_EQ(story["stopped"], (nlohmann::json{"DRILL", "LAMP"}));
  EXPECT_EQ(story["down"], nlohmann::json::array({"DRILL"})) << "the process of LAMP runs, Offline";
}

TEST_F(AStory, HasTheGravestEventOfOneInstantAsItsCause) {
  misses_speed(opening, 4);
  loses_spindle(opening + 1ms, descriptor::DeviceLoss::HungUp);
  const auto story = why();
  EXPECT_EQ(story["title"], "DRILL lost its device SPINDLE.A: the connection was closed.");
  EXPECT_THAT(lines(story), ElementsAre("DRILL lost its device SPINDLE.A: the connection was closed",
                                        "LAMP misses samples of SPEED (the newest is 4 cycles old)"));
}

TEST_F(AStory, HasTheFirstEventAsItsCauseWhereAGraverOneComesLater) {
  misses_speed(opening, 0);
  loses_spindle(opening + 125ms, descriptor::DeviceLoss::HungUp);
  const auto story = why();
  EXPECT_EQ(story["title"], "LAMP misses samples of SPEED.") << "one that was taken away has no age";
  EXPECT_EQ(story["severity"], "medium");
  EXPECT_EQ(story["advice"], "Look into it, then bring work up.");
}

/// As of a flight that was not commissioned: `dark` is the initial mode, which commissions nobody.
TEST_F(AStory, BeginsInAnyModeAndIsBroughtUpByOneThatCommissionsSomebody) {
  in_mode("dark");
  becomes("DRILL", State::Operational, opening - 50s);
  loses_spindle(opening, descriptor::DeviceLoss::Silent);
  hears(testing::overview(catalogue, {.drill = 255, .lamp = 0, .link_up = 0}, opening + 2s));
  const auto story = why();
  EXPECT_EQ(story["mode"], "dark");
  EXPECT_EQ(story["mode_up"], "work");
  EXPECT_EQ(story["advice"], "Mend or plug in the device SPINDLE.A, then bring work up.");
  EXPECT_EQ(story["down"], nlohmann::json::array({"DRILL"}));
}

TEST_F(AStory, IsOneAsLongAsLessThanThreeSecondsPassFromEventToEvent) {
  for (const Duration after : {0s, 2s, 4s, 10s}) torque(opening + after);
  const auto newest = why();
  EXPECT_EQ(newest["t"], 2'145'916'910);
  EXPECT_THAT(newest["causes"], SizeIs(1));
  const auto before = why(opening + 9s);
  EXPECT_EQ(before["t"], 2'145'916'900);
  EXPECT_THAT(before["causes"], SizeIs(3));
  EXPECT_THAT(why(opening - 1s)["causes"], IsEmpty()) << "a replay of before knows nothing of it";
}

TEST_F(AStory, TellsArgumentsWithTheirUnits) {
  torque(opening);
  EXPECT_EQ(why()["title"], "DRILL: torque high (joint 2, value 12.5 N m).");
  hears(testing::event_packet(catalogue, "SUPERVISOR", "PROCESS_DIED", opening + 20s,
                              testing::in_octets(testing::drill_apid)));
  EXPECT_EQ(why()["title"], "The process of DRILL died.");
  hears(testing::event_packet(catalogue, "SUPERVISOR", "HANG", opening + 40s, testing::in_octets(testing::lamp_apid)));
  EXPECT_EQ(why()["title"], "LAMP does not cycle any more.");
}

TEST_F(AStory, EndsWhereSomebodyComesUpAgain) {
  torque(opening);
  becomes("DRILL", State::SafeOperational, opening + 250ms);
  becomes("DRILL", State::PreOperational, opening + 1s);
  torque(opening + 2s);
  const auto story = why();
  EXPECT_THAT(lines(story), ElementsAre("DRILL: torque high (joint 2, value 12.5 N m)", "DRILL → Safe-Operational"));
  EXPECT_EQ(story["detail"], "DRILL went Safe-Operational within 250 ms, by plan to-safe.");
}

TEST_F(AStory, FoldsTheStepsOfAHandAndForgetsThemWhereAFaultWasInjected) {
  torque(opening);
  for (int step = 1; step <= 3; ++step) injected("hand target 0 0", opening - step * 125ms);
  injected("no such thing", opening - 125ms, "unknown");
  injected("unplug", opening - 3s);
  injected("unplug", opening + 1s);
  EXPECT_EQ(lines(why()).at(0), "The hand moved (3 steps)")
      << "too early, too late or refused, the others are no cause";
  injected("delay 1", opening + 250ms);
  EXPECT_THAT(lines(why()),
              ElementsAre("Fault injected: spindle delay 1", "DRILL: torque high (joint 2, value 12.5 N m)"))
      << "a fault is timed by its answer, which may come behind the event";
}

TEST_F(AStory, OfASafeAllNamesWhoSentIt) {
  in_mode("dark");
  reported(commanded("SAFE_ALL", opening), opening + 1s, "completed");
  becomes("DRILL", State::SafeOperational, opening + 250ms);
  const auto story = why();
  EXPECT_EQ(story["title"], "SAFE ALL: the actuators of all subsystems are inhibited.");
  EXPECT_EQ(story["detail"], "By telecommand of anna.");
  EXPECT_THAT(lines(story), ElementsAre("SAFE ALL by anna, completed", "DRILL → Safe-Operational"));
  EXPECT_EQ(story["advice"], "Bring work up again when all is clear.") << "dark has nobody up";
  EXPECT_TRUE(story["plan"].is_null());
  EXPECT_EQ(story["stopped"], nlohmann::json::array({"all"}));
}

TEST_F(AStory, OfASafeAllThatWasRefusedThereIsNone) {
  reported(commanded("SAFE_ALL", opening), opening + 1s, "failed", static_cast<int>(pus::FailureCode::WrongState));
  commanded("BORE", opening + 2s, "SAFE_ALL");
  EXPECT_THAT(why()["causes"], IsEmpty());
  reported(commanded("SAFE_ALL", opening + 3s), opening + 4s, "failed",
           static_cast<int>(pus::FailureCode::DeviceError));
  EXPECT_THAT(lines(why()), ElementsAre("SAFE ALL by anna, failed"))
      << "who does not confirm it was stopped all the same";
}

TEST_F(AStory, OfAStopOnTheComputerOfTheFlightHasWhatWasBeforeIt) {
  torque(opening);
  hears(testing::event_packet(catalogue, "SUPERVISOR", "LOCAL_STOP", opening + 1s));
  const auto story = why();
  EXPECT_EQ(story["detail"], "On the computer of the flight: `hirosco safe`, a key or a signal.");
  EXPECT_THAT(lines(story),
              ElementsAre("DRILL: torque high (joint 2, value 12.5 N m)", "SAFE ALL on the computer of the flight"));
  EXPECT_TRUE(story["causes"][0]["after_ms"].is_null());
  EXPECT_EQ(story["causes"][1]["after_ms"], 0);
}

TEST_F(AStory, BelongsToNoSafeAllOfLongBefore) {
  commanded("SAFE_ALL", opening - 10s);
  torque(opening);
  EXPECT_EQ(why()["title"], "DRILL: torque high (joint 2, value 12.5 N m).");
  commanded("SAFE_ALL", opening + 10s);
  EXPECT_EQ(why()["detail"], "By telecommand of anna.");
  EXPECT_THAT(why()["causes"], SizeIs(1)) << "what was 10 s before it is another story";
}

TEST(APlan, IsToldAsTheSupervisorChoosesTheMostSpecificOne) {
  auto mission = testing::workshop();
  descriptor::Plan of_drill, of_event, of_other_mode;
  of_drill.name = "of-drill";
  of_drill.subsystem = "DRILL";
  of_event.name = "of-event";
  of_event.event = "TORQUE_HIGH";
  of_other_mode.name = "of-other-mode";
  of_other_mode.event = "TORQUE_HIGH";
  of_other_mode.mode = "dark";
  const auto told = [](const descriptor::Mission& flown) {
    const Catalogue catalogue{flown};
    const auto archive = std::move(*Archive::open(":memory:"));
    archive->add(StoredChange{opening - 1s, "mode", "", "work"});
    archive->add(StoredEvent{.t = opening,
                             .apid = testing::drill_apid,
                             .subsystem = "DRILL",
                             .id = 7,
                             .name = "TORQUE_HIGH",
                             .severity = 3,
                             .text = "",
                             .values = "{}"});
    return newest_story(catalogue, *archive, OnboardTime::max())["plan"].get<std::string>();
  };
  EXPECT_EQ(told(mission), "to-safe") << "by the severity";
  mission.plans.push_back(of_drill);
  EXPECT_EQ(told(mission), "of-drill");
  mission.plans.push_back(of_event);
  EXPECT_EQ(told(mission), "of-event");
  mission.plans.push_back(of_other_mode);
  EXPECT_EQ(told(mission), "of-event");
  of_event.name = "of-event-again";
  mission.plans.push_back(of_event);
  EXPECT_EQ(told(mission), "of-event") << "of equal ones the first";
  mission.plans.clear();
  EXPECT_EQ(told(mission), "default");
}

}  // namespace
}  // namespace hirosco::ground
