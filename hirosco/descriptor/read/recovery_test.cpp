// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/descriptor/testing.hpp"

/// What a mission says of who crashed (docs/adr/0076) and of lost links (docs/adr/0077), as it is read.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::rendered;

const std::string good_call = R"(<Do action="command" subsystem="FLYWHEEL" function="SET_FORCE_SCALE" arguments="0.1")";

TEST(MissionRecovery, ARestartSaysAsFarAsItComesBack) {
  for (const auto& [word, state] :
       {std::pair{"Offline", State::Offline}, std::pair{"PreOperational", State::PreOperational},
        std::pair{"SafeOperational", State::SafeOperational}, std::pair{"commanded", State::Operational}}) {
    const std::string plan = std::string{R"(<When event="PROCESS_DIED"/><Do action="restart" to=")"} + word + R"("/>)";
    const auto reading =
        read_mission(data / "mission.xml",
                     overlay({{"mission.xml", changed(R"(<When severity="low info"/><Do action="log"/>)", plan)}}));
    ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
    EXPECT_EQ(reading.value->plans.at(2).steps.at(0).values.at(3), static_cast<std::int64_t>(state)) << word;
  }
}

TEST(MissionRecovery, APlanForTheLossOfTheGroundMayNameTheGroundLinkWhetherThatHasTheEventOrNot) {
  for (const char* named : {"GROUNDSTATION", "SUPERVISOR"}) {
    const std::string plan =
        std::string{R"(<When subsystem=")"} + named + R"(" event="GROUND_LINK_LOST"/><Do action="log"/>)";
    const auto reading =
        read_mission(data / "mission.xml",
                     overlay({{"mission.xml", changed(R"(<When severity="low info"/><Do action="log"/>)", plan)}}));
    EXPECT_TRUE(reading.value) << named << rendered(reading.problems, file_system());
  }
}

TEST(MissionRecovery, APlanHasAPriorityAndAStepMayNameWhomItMoves) {
  const auto reading = read_mission(
      data / "mission.xml",
      overlay({{"mission.xml", changed(R"(<Plan name="note"><When severity="low info"/><Do action="log"/>)",
                                       R"(<Plan name="note" priority="255"><When severity="low info"/>)"
                                       R"(<Do action="set_state" state="Offline" subsystem="FLYWHEEL"/>)"
                                       R"(<Do action="shut_down_network"/>)")}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.value->plans.at(0).priority, default_plan_priority) << "what is not said is as it always was";
  const Plan& plan = reading.value->plans.at(2);
  EXPECT_EQ(plan.priority, 255);
  EXPECT_EQ(plan.steps.at(0).subsystem, "FLYWHEEL");
  EXPECT_EQ(plan.steps.at(1).subsystem, "") << "whose event it is";
}

TEST(MissionRecovery, StepsNameWhatIsLookedUpForThem) {
  const auto reading = read_mission(
      data / "mission.xml",
      overlay(
          {{"mission.xml",
            changed(
                R"(<Plan name="note"><When severity="low info"/><Do action="log"/>)",
                R"(<Plan name="note"><When severity="low info" subsystem="CORONAGRAPH"/>)"
                R"(<Do action="configure" configuration="COUPLED"/><Do action="link" link="1"/><Do action="fence"/>)"
                R"(<Do action="wait_for" state="Operational" of="FLYWHEEL" within_ms="250"/>)"
                R"(<Do action="run" plan="to-safe"/><Do action="kill" subsystem="FLYWHEEL"/>)")}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const Mission& mission = *reading.value;
  const auto& steps = mission.plans.at(2).steps;
  ASSERT_EQ(steps.size(), 6U);
  const auto* coronagraph = mission.find_subsystem("CORONAGRAPH");
  EXPECT_EQ(steps[0].values.at(0), coronagraph->subsystem.find_configuration("COUPLED")->id);
  EXPECT_EQ(steps[0].words, std::vector<std::string>{"COUPLED"});
  EXPECT_EQ(steps[1].values, std::vector<std::int64_t>{1});
  EXPECT_EQ(steps[3].values, (std::vector<std::int64_t>{static_cast<std::int64_t>(State::Operational),
                                                        mission.find_subsystem("FLYWHEEL")->subsystem.id, 250}));
  EXPECT_EQ(steps[4].kind, "set_state") << "the other plan's step stands in the place of the one that runs it";
  EXPECT_EQ(steps[4].values, std::vector<std::int64_t>{static_cast<std::int64_t>(State::SafeOperational)});
  EXPECT_EQ(steps[5].subsystem, "FLYWHEEL");
}

TEST(MissionRecovery, ACommandSaysHowLongItMayTakeAndWhereItDoesNotItIsAsLongAsForAny) {
  const auto reading = read_mission(
      data / "mission.xml", overlay({{"mission.xml", changed(R"(<When severity="low info"/><Do action="log"/>)",
                                                             R"(<When severity="low info"/>)" + good_call + "/>" +
                                                                 good_call + R"( done_within_s="120"/>)")}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const auto& steps = reading.value->plans.at(2).steps;
  EXPECT_EQ(steps.at(0).values.at(command_done_within_s), 15);
  EXPECT_EQ(steps.at(1).values.at(command_done_within_s), 120);
  EXPECT_EQ(steps.at(1).arguments, std::vector<double>{0.1});
}

TEST(MissionRecovery, AStepThatNamesWhatThereIsNotOrDoesNotFitIsRefused) {
  struct Case {
    std::string code, good, bad;
  };
  for (const Case& each : std::vector<Case>{
           {"E0372", R"(<Do action="log"/>)", R"(<Do action="command" function="STOW"/>)"},
           {"E0310", R"(<Do action="log"/>)", R"(<Do action="command" subsystem="FLYWHEEL" function="SET_STATE"/>)"},
           {"E0372", R"(<Do action="log"/>)", R"(<Do action="configure" configuration="SPUN"/>)"},
           {"E0372", R"(<Do action="log"/>)",
            R"(<Do action="command" subsystem="FLYWHEEL" function="SET_FORCE_SCALE"/>)"},
           {"E0372", R"(<Do action="log"/>)",
            R"(<Do action="command" subsystem="FLYWHEEL" function="SET_FORCE_SCALE" arguments="0.2"/>)"},
           {"E0372", R"(<Do action="log"/>)",
            R"(<Do action="command" subsystem="FLYWHEEL" function="SET_FORCE_SCALE" arguments="x"/>)"},
           {"E0112", R"(<Do action="log"/>)", good_call + R"( done_within_s="14"/>)"},
           {"E0112", R"(<Do action="log"/>)", good_call + R"( done_within_s="601"/>)"},
           {"E0111", R"(<Do action="log"/>)", good_call + R"( done_within_s="1 min"/>)"},
           {"E0317", R"(<Do action="log"/>)", R"(<Do action="log" done_within_s="30"/>)"},
           {"E0316", R"(<Do action="log"/>)",
            R"(<Do action="configure" subsystem="FLYWHEEL" configuration="COUPLE"/>)"},
           {"E0309", R"(<Do action="log"/>)", R"(<Do action="link" link="99"/>)"},
           {"E0309", R"(<Do action="log"/>)", R"(<Do action="unlink" link="a"/>)"},
           {"E0309", R"(<Do action="log"/>)", R"(<Do action="unlink" link="1 "/>)"},
           {"E0112", R"(<Do action="log"/>)", R"(<Do action="link" link="257"/>)"},
           {"E0304", R"(<Do action="log"/>)", R"(<Do action="wait_for" state="Offline" of="FLYWHEELS"/>)"},
           {"E0306", R"(<Do action="log"/>)", R"(<Do action="wait_for" state="SoftwareInit"/>)"},
           {"E0304", R"(<Do action="log"/>)", R"(<Do action="hand_over" receiver="FLYWHEELS" configuration="SPUN"/>)"},
           {"E0372", R"(<Do action="log"/>)",
            R"(<Do action="hand_over" receiver="FLYWHEEL" configuration="COUPLED"/>)"},
           {"E0316", R"(<When severity="low info"/><Do action="log"/>)",
            R"(<When subsystem="CORONAGRAPH"/><Do action="hand_over" receiver="FLYWHEEL" configuration="COUPLE"/>)"},
           {"E0310", R"(<Do action="log"/>)", R"(<Do action="notify_network" function="NOBODY_HAS_IT"/>)"},
           {"E0112", R"(<Do action="log"/>)", R"(<Do action="power" budget_W="0"/>)"},
           {"E0373", R"(<Plan name="note">)",
            R"(<Plan name="again"><When severity="low"/><Do action="run" plan="nothing"/></Plan><Plan name="note">)"},
           {"E0373", R"(<Plan name="note">)",
            R"(<Plan name="again"><When severity="low"/><Do action="run" plan="again"/></Plan><Plan name="note">)"}}) {
    const auto reading = read_mission(data / "mission.xml", overlay({{"mission.xml", changed(each.good, each.bad)}}));
    ASSERT_FALSE(reading.problems.empty()) << each.bad;
    EXPECT_EQ(reading.problems.front().code, each.code) << each.bad;
    EXPECT_EQ(reading.problems.size(), 1U) << each.bad << rendered(reading.problems, file_system());
  }
}

TEST(MissionRecovery, WhatIsToldOfPlansHasTheirNames) {
  const std::string supervisor = file_system()(data / "supervisor.xml").value();
  const auto reading = read_mission(
      data / "mission.xml",
      overlay({{"supervisor.xml", changed("<EventService>",
                                          R"(<Enumeration name="PLANS"><Text value="0">default</Text></Enumeration>)"
                                          R"(<ParamRef name="PLAN" id="99" type="UINT8" enumeration="PLANS"/>)"
                                          "<EventService>",
                                          supervisor)}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const auto& texts = reading.value->supervisor.enumerations.at(0).texts;
  ASSERT_EQ(texts.size(), 1 + reading.value->plans.size());
  EXPECT_EQ(texts.at(2).value, 2);
  EXPECT_EQ(texts.at(2).text, "to-safe");
}

TEST(MissionRecovery, ALinkSaysWhatItsLossDoes) {
  const std::string flywheel = file_system()(data / "flywheel.xml").value();
  const auto reading = read_mission(
      data / "mission.xml",
      overlay(
          {{"mission.xml",
            changed(R"(to="FLYWHEEL.PLATE_STATE"/>)", R"(to="FLYWHEEL.PLATE_STATE" on_loss="hold" hold_ms="250"/>)")},
           {"flywheel.xml", changed(R"(<Requires name="PLATE_STATE" from="CORONAGRAPH">)",
                                    R"(<Requires name="PLATE_STATE" from="CORONAGRAPH" missing="hold">)", flywheel)}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const MissionLink& link = reading.value->links.at(0);
  EXPECT_EQ(link.on_loss, OnLoss::Hold);
  EXPECT_EQ(link.hold, std::chrono::milliseconds{250});
  EXPECT_EQ(reading.value->links.at(1).on_loss, OnLoss::Down) << "what is not said is as it always was";
}

}  // namespace
}  // namespace hirosco::descriptor
