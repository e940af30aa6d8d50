// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/mode_plan.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

/// ARM and HAND coupled by two links, CAMERA beside them; CAMERA is not the ground link here.
struct ModePlanTest : PartsTest {
  descriptor::Mode& coupled = craft.mission.modes[0];
  descriptor::Mode& watching = craft.mission.modes[1];
  PowerLedger power{std::nullopt};

  void SetUp() override {
    PartsTest::SetUp();
    craft.mission.ground.subsystem.clear();
    coupled.commission = {commissioned("ARM", "COUPLED"), commissioned("HAND", "ONLY")};
    coupled.establish = {1, 2};
    watching.commission = {commissioned("CAMERA", "ONLY")};
    start_all(Offline);
  }
  static descriptor::CommissionStep commissioned(std::string subsystem, std::string configuration) {
    return {
        .subsystem = std::move(subsystem), .configuration = std::move(configuration), .state = Operational, .at = {}};
  }
  void couple() {
    set(arm, Operational, 2);
    set(hand, Operational, 1);
    for (const std::uint8_t link : {std::uint8_t{1}, std::uint8_t{2}}) parts.graph.set_up(link, true);
  }
  ModePlan plan(const descriptor::Mode& mode) { return plan_mode(craft, parts.graph, power, mode); }
  static std::vector<std::string> texts_of(const Craft& craft, const ModePlan& plan) {
    std::vector<std::string> texts;
    for (const Stage& stage : plan.stages) {
      std::string text;
      for (const ProcedureStep& step : stage)
        text += (text.empty() ? "" : ", ") + craft.name_of(step.subject) + " " + text_of(step, craft.mission);
      texts.push_back(text);
    }
    return texts;
  }
  std::vector<std::string> texts(const descriptor::Mode& mode) { return texts_of(craft, plan(mode)); }
};

TEST_F(ModePlanTest, WhoIsThereAlreadyIsNotMoved) {
  couple();
  EXPECT_TRUE(plan(coupled).stages.empty());
  EXPECT_TRUE(plan(coupled).moved.empty());
}

/// In all states, configurations and standings of a link.
TEST_F(ModePlanTest, TheModeIsThereWhereNobodyWouldHaveToMoveIntoItAndNowhereElse) {
  int there = 0;
  for (const auto& state : EnumTexts<State>::table)
    for (const std::uint8_t configuration : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}})
      for (const bool up : {false, true}) {
        couple();
        set(arm, state.value, configuration);
        parts.graph.set_up(2, up);
        const std::string missing = missing_from(craft, parts.graph, coupled);
        EXPECT_EQ(missing.empty(), plan(coupled).moved.empty())
            << state.text << " " << +configuration << " " << missing;
        there += missing.empty() ? 1 : 0;
      }
  EXPECT_EQ(there, 1);
}

TEST_F(ModePlanTest, AllThatIsMissingOfAModeIsNamed) {
  couple();
  EXPECT_EQ(missing_from(craft, parts.graph, coupled), "");
  set(arm, Operational, 1);
  set(hand, SafeOperational);
  parts.graph.set_up(1, false);
  EXPECT_EQ(missing_from(craft, parts.graph, coupled),
            "ARM is not in configuration COUPLED; HAND is not Operational; link 1 is not up");
  craft.member(hand)->died();
  EXPECT_NE(missing_from(craft, parts.graph, coupled).find("HAND is not Operational"), std::string::npos);
}

TEST_F(ModePlanTest, WhoIsToBeOperationalIsLetMoveAndNobodyElseWhoMoves) {
  EXPECT_THAT(plan(coupled).released, ElementsAre(arm, hand));
  coupled.commission[0].state = SafeOperational;
  const ModePlan one_of_two = plan(coupled);
  EXPECT_THAT(one_of_two.moved, ElementsAre(arm, hand));
  EXPECT_THAT(one_of_two.released, ElementsAre(hand));
}

TEST_F(ModePlanTest, AModeThatCommissionsNobodyMovesNobody) {
  couple();
  watching.commission.clear();
  EXPECT_TRUE(plan(watching).stages.empty());
}

TEST_F(ModePlanTest, WhoIsNotOfTheModeGoesOfflineWithWhatJoinsThem) {
  couple();
  EXPECT_THAT(
      texts(watching),
      ElementsAre("ARM SafeOperational, HAND SafeOperational", "ARM Offline, HAND Offline, CAMERA PreOperational",
                  "CAMERA configuration ONLY", "CAMERA SafeOperational", "CAMERA Operational"));
}

TEST_F(ModePlanTest, TheGroundLinkStaysWhereAModeDoesNotNameIt) {
  craft.mission.ground.subsystem = "CAMERA";
  set(camera, Operational);
  couple();
  EXPECT_TRUE(plan(coupled).stages.empty());
}

TEST_F(ModePlanTest, ANetworkMovesAsAWholeAlsoForALinkThatIsMissing) {
  couple();
  parts.graph.set_up(2, false);
  parts.graph.forget(2);
  EXPECT_THAT(texts(coupled),
              ElementsAre("ARM SafeOperational, HAND SafeOperational", "ARM PreOperational, HAND PreOperational",
                          "ARM configuration COUPLED, HAND configuration ONLY", "SUPERVISOR link 1, SUPERVISOR link 2",
                          "ARM SafeOperational, HAND SafeOperational", "ARM Operational, HAND Operational"));
}

TEST_F(ModePlanTest, ALinkThatTheModeDoesNotEstablishIsGivenBack) {
  couple();
  coupled.establish = {1};
  EXPECT_THAT(plan(coupled).moved, ElementsAre(arm, hand));
  EXPECT_THAT(texts(coupled), ::testing::Contains("SUPERVISOR link 1"));
}

TEST_F(ModePlanTest, WhoFailedComesBackByTheWayDown) {
  couple();
  set(arm, ErrorOperational, 2);
  EXPECT_EQ(texts(coupled)[0], "HAND SafeOperational");
  EXPECT_EQ(texts(coupled)[1], "ARM PostOperational");
}

TEST_F(ModePlanTest, EveryReasonAgainstItIsNamedAtOnce) {
  couple();
  coupled.from = {"narrow"};
  coupled.interlocks = {{.kind = descriptor::Interlock::Kind::Excludes,
                         .subsystem = "ARM",
                         .states = {Operational, SafeOperational},
                         .configuration = "COUPLED",
                         .at = {}},
                        {.kind = descriptor::Interlock::Kind::Needs,
                         .subsystem = "CAMERA",
                         .states = {Operational},
                         .configuration = {},
                         .at = {}},
                        {.kind = descriptor::Interlock::Kind::Needs,
                         .subsystem = "ARM",
                         .states = {Operational},
                         .configuration = {},
                         .at = {}}};
  craft.mode = &craft.mission.modes[1];
  coupled.from = {"open"};
  craft.member(hand)->died();
  set(arm, SoftwareInit);
  power.set_budget(10);
  EXPECT_THAT(plan(coupled).against,
              ElementsAre("it is not entered from mode narrow", "it needs CAMERA in Operational",
                          "it needs ARM in Operational", "ARM is on its way between two states",
                          "HAND is down: SET_STATE Offline starts it again", "ARM needs 60 W, 10 W of 10 W are free"));
}

TEST_F(ModePlanTest, WhoeverIsToComeUpNeedsPowerAndWhoeverGoesDownDoesNot) {
  couple();
  for (const std::uint16_t each : {arm, hand}) power.observe(each, Operational, each == arm ? 60 : 20, clock.now());
  power.set_budget(100);
  EXPECT_TRUE(plan(watching).against.empty());
  power.set_grantable(19.5, "dusk");
  EXPECT_THAT(plan(watching).against, ElementsAre("CAMERA needs 20 W, 19.5 W of 19.5 W are free: dusk"));
  EXPECT_TRUE(plan(coupled).against.empty()) << "they are there";
  set(arm, SafeOperational, 2);
  EXPECT_THAT(plan(coupled).against, ElementsAre("ARM needs 60 W, 19.5 W of 19.5 W are free: dusk",
                                                 "HAND needs 20 W, 0 W of 19.5 W are free: dusk"))
      << "it would act again, and who is coupled to it";
  watching.commission.clear();
  EXPECT_TRUE(plan(watching).against.empty());
}

TEST_F(ModePlanTest, EachForWhomPowerIsShortIsNamedAndNotTheFirstAlone) {
  power.set_budget(50);
  EXPECT_THAT(plan(coupled).against,
              ElementsAre("ARM needs 60 W, 50 W of 50 W are free", "HAND needs 20 W, 0 W of 50 W are free"));
  power.set_budget(70);
  EXPECT_THAT(plan(coupled).against, ElementsAre("HAND needs 20 W, 10 W of 70 W are free"));
  power.set_budget(80);
  EXPECT_TRUE(plan(coupled).against.empty());
}

TEST_F(ModePlanTest, AnInterlockIsJudgedByStateAndConfiguration) {
  couple();
  auto& lock = watching.interlocks.emplace_back();
  lock = {.kind = descriptor::Interlock::Kind::Excludes,
          .subsystem = "ARM",
          .states = {Operational, SafeOperational},
          .configuration = "COUPLED",
          .at = {}};
  EXPECT_THAT(plan(watching).against, ElementsAre("it excludes ARM in Operational or SafeOperational with COUPLED"));
  set(arm, PreOperational, 2);
  EXPECT_TRUE(plan(watching).against.empty());
  set(arm, Operational, 1);
  EXPECT_TRUE(plan(watching).against.empty());
}

TEST_F(ModePlanTest, WhoIsNotOfTheModeMayBeDead) {
  couple();
  craft.member(camera)->died();
  EXPECT_TRUE(plan(coupled).against.empty());
  EXPECT_FALSE(plan(watching).against.empty());
}

TEST_F(ModePlanTest, AModeMayBeEnteredAnewFromItself) {
  coupled.from = {"narrow"};
  craft.mode = &coupled;
  EXPECT_TRUE(plan(coupled).against.empty()) << "that is how what has fallen comes up again";
}

}  // namespace
}  // namespace hirosco::supervisor
