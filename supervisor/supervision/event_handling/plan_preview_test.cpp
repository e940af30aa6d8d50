// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// TC[129,6]: what a plan would do now, asked in flight. Nothing comes of it but the answer.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using enum descriptor::State;
namespace st129 = pus::st129;

constexpr std::uint16_t joint_hot = 2000;

struct PlanPreviewTest : PartsTest {
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    descriptor::Event event;
    event.name = "HOT";
    event.id = joint_hot;
    event.severity = Severity::Medium;
    craft.mission.subsystems.front().subsystem.events.push_back(event);
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    parts.graph.set_up(1, true);
    parts.own.start(craft.mode_epoch);
    own_step();
    story.clear();
  }
  void plan(std::string name, std::vector<descriptor::PlanStep> steps, std::string event = "HOT") {
    descriptor::Plan made;
    made.name = std::move(name);
    made.event = std::move(event);
    made.steps = std::move(steps);
    craft.mission.plans.push_back(std::move(made));
  }
  std::optional<st129::PlanPreview> ask(std::uint16_t apid, std::uint16_t event) {
    std::array<std::byte, 4> data;
    OctetWriter{data}.put(apid).put(event);
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = supervisor_apid,
                                                .sequence_count = count++,
                                                .ack = pus::ack_all,
                                                .service = st129::service_type,
                                                .subtype = st129::plan_question,
                                                .source = 7},
                                               data);
    EXPECT_TRUE(played[camera].channel.subsystem_end().send(
        {.kind = MessageKind::GroundTelecommand, .link = 5, .packet = *packet}));
    last_routed.erase(st129::service_type);
    parts.reception.read(*craft.member(camera));
    own_step();
    return st129::read_plan_preview(last_routed[st129::service_type]);
  }
  static std::vector<std::string> words(const st129::PlanPreview& preview) {
    std::vector<std::string> all;
    for (const auto& step : preview.steps)
      all.push_back(std::to_string(step.stage) + " " + std::to_string(step.subject) + " " + step.what);
    return all;
  }
  /// Nobody was sent anything, told anything or fenced.
  void nothing_was_done() {
    for (const std::uint16_t apid : {arm, hand}) {
      EXPECT_THAT(texts(apid), IsEmpty());
      EXPECT_FALSE(guard.fenced(apid));
      EXPECT_FALSE(craft.member(apid)->recovery.running());
    }
    EXPECT_THAT(story, IsEmpty());
    EXPECT_THAT(killed, IsEmpty());
  }
};

TEST_F(PlanPreviewTest, TellsThePlanItsNumberAndItsStepsInTheirOrder) {
  plan("other", {{"log"}}, "PROCESS_DIED");
  plan("cool", {{"set_state", {static_cast<int>(SafeOperational)}}, {"fence", {}, "HAND"}, {"kill"}});
  const auto preview = ask(arm, joint_hot);
  ASSERT_TRUE(preview);
  EXPECT_EQ(preview->subsystem, arm);
  EXPECT_EQ(preview->event, joint_hot);
  EXPECT_EQ(preview->severity, 3);
  EXPECT_EQ(preview->plan, 2);
  EXPECT_EQ(preview->name, "cool");
  EXPECT_THAT(preview->against, IsEmpty());
  EXPECT_THAT(words(*preview), ElementsAre("1 10 SafeOperational", "2 10 kill", "1 11 fence"));
  nothing_was_done();
}

TEST_F(PlanPreviewTest, WhatThereIsNothingToDoForIsNoStep) {
  EXPECT_THAT(words(*ask(arm, joint_hot)), ElementsAre("1 10 SafeOperational")) << "the default";
  set(arm, PreOperational);
  const auto preview = ask(arm, joint_hot);
  ASSERT_TRUE(preview);
  EXPECT_EQ(preview->plan, 0);
  EXPECT_EQ(preview->name, "default");
  EXPECT_THAT(preview->steps, IsEmpty()) << "who is not Operational is not made safe";
}

TEST_F(PlanPreviewTest, ASupervisorsEventOfASubsystemIsAskedUnderThatOnesId) {
  const auto preview = ask(arm, 101);  // PROCESS_DIED
  ASSERT_TRUE(preview);
  EXPECT_THAT(words(*preview), ElementsAre("1 10 shut_down_network"));
  plan("full", {{"set_state", {static_cast<int>(SafeOperational)}}}, "LOG_DAMAGED");
  const auto own = ask(supervisor_apid, 109);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->name, "full");
  EXPECT_THAT(words(*own), ElementsAre("1 10 SafeOperational", "1 11 SafeOperational"));
  nothing_was_done();
}

TEST_F(PlanPreviewTest, TellsWhatIsAgainstIt) {
  plan("down",
       {{"set_state", {static_cast<int>(ErrorOperational)}}, {"set_state", {static_cast<int>(PostOperational)}}},
       "BURNING");
  descriptor::Event event;
  event.name = "BURNING";
  event.id = joint_hot + 1;
  event.severity = Severity::High;
  craft.mission.subsystems.front().subsystem.events.push_back(event);
  this->event(arm, joint_hot + 1, Severity::High);
  const auto preview = ask(arm, joint_hot);
  ASSERT_TRUE(preview);
  EXPECT_THAT(preview->against, ElementsAre("ARM: plan down runs"));
  craft.shutting_down = true;
  EXPECT_THAT(ask(arm, joint_hot)->against, ElementsAre("the craft shuts down"));
}

TEST_F(PlanPreviewTest, AStepSaysItself) {
  plan("hand-over", {{"hand_over", {hand, 1}, {}, {"HAND", "ONLY"}}});
  guard.fence(hand);
  const auto preview = ask(arm, joint_hot);
  ASSERT_TRUE(preview);
  EXPECT_THAT(words(*preview), ElementsAre("1 10 task to HAND in ONLY"));
  EXPECT_THAT(preview->against,
              ElementsAre("ARM, task to HAND in ONLY: HAND was stopped, and nobody has let it go since"));
}

TEST_F(PlanPreviewTest, ACommandSaysHowLongItMayTakeWhereThatIsLongerThanForAny) {
  plan("out", {{"command", {0, 0, 120}, {}, {"BRAKE"}}, {"command", {0, 0, 15}, {}, {"BRAKE"}}});
  EXPECT_THAT(words(*ask(arm, joint_hot)), ElementsAre("1 10 BRAKE within 120 s", "2 10 BRAKE"));
  nothing_was_done();
}

TEST_F(PlanPreviewTest, OfALinkThatTheMissionSpeaksOfItTellsThat) {
  for (auto& link : craft.mission.links)
    if (link.id == 1) link.on_loss = descriptor::OnLoss::Ignore;
  descriptor::Event stale;
  stale.name = "ARM_STATE_STALE";
  stale.id = 2100;
  stale.severity = Severity::High;
  craft.mission.subsystems[1].subsystem.events.push_back(stale);
  const auto preview = ask(hand, 2100);
  ASSERT_TRUE(preview);
  EXPECT_EQ(preview->plan, 65'535);
  EXPECT_EQ(preview->name, "loss of link 1");
  EXPECT_THAT(words(*preview), ElementsAre("1 11 ignore"));
  nothing_was_done();
}

TEST_F(PlanPreviewTest, OfNoSuchEventThereIsNoAnswer) {
  EXPECT_FALSE(ask(arm, 9999));
  EXPECT_FALSE(ask(99, joint_hot));
  EXPECT_FALSE(ask(supervisor_apid, 101)) << "a death is somebody's";
  EXPECT_FALSE(ask(arm, 109)) << "the log is nobody's";
  EXPECT_FALSE(ask(supervisor_apid, 126)) << "what tells of plans has none";
}

}  // namespace
}  // namespace hirosco::supervisor
