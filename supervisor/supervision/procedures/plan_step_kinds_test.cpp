// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

/// What each kind of step of a recovery plan does, from the event to the octets. ARM tells BROKEN and LATE; ARM and HAND are joined by
/// real-time links; CAMERA is the ground link in the others' tests, and not here.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

constexpr std::uint16_t broken = 2000, late = 2001;

struct PlanStepKinds : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    craft.mission.ground.subsystem.clear();
    for (auto& member : craft.mission.subsystems) {
      for (const auto& [name, id] : {std::pair{"BROKEN", broken}, std::pair{"LATE", late}}) {
        descriptor::Event event;
        event.name = name;
        event.id = id;
        event.severity = Severity::Low;
        member.subsystem.events.push_back(event);
      }
      descriptor::Function stow = function("STOW", in_states({Operational}));
      descriptor::Function::Argument angle;
      angle.field.name = "ANGLE";
      angle.field.type = Type::Double;
      stow.arguments.push_back(angle);
      member.subsystem.functions.push_back(stow);
      descriptor::Function notice = function("PARTNER_FAILED", in_states({Operational}));
      descriptor::Function::Argument who;
      who.field.name = "WHO";
      who.field.type = Type::Uint16;
      notice.arguments.push_back(who);
      if (member.subsystem.id == hand) member.subsystem.functions.push_back(notice);
    }
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand, camera}) let_go(apid);
    start_supervisor();
    for (const std::uint16_t apid : {arm, hand, camera}) received(apid);
    story.clear();
  }
  /// As the ground's SET_STATE Operational does.
  void let_go(std::uint16_t apid) {
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    craft.member(apid)->fences_when_free = guard.fences(apid);
  }
  void plan(std::vector<descriptor::PlanStep> steps, std::string event = "BROKEN") {
    descriptor::Plan made;
    made.name = "test";
    made.event = std::move(event);
    made.steps = std::move(steps);
    craft.mission.plans.push_back(std::move(made));
  }
  void happens(std::uint16_t id = broken) { event(arm, id, Severity::Low); }
  static descriptor::PlanStep to_be(State state) { return {"set_state", {static_cast<std::int64_t>(state)}}; }
  /// Everybody and the supervisor do what they are told, until nothing more comes.
  void all_obey() {
    for (int turn = 0; turn < 60; ++turn) {
      for (const std::uint16_t apid : {arm, hand, camera})
        for (const Received& each : received(apid)) {
          sent.push_back(craft.name_of(apid) + " " + each.text);
          if (each.text.starts_with("SET_STATE ")) set(apid, static_cast<State>(std::stoi(each.text.substr(10))));
          if (each.text.starts_with("CONFIGURE "))
            played[apid].vital->configuration = static_cast<std::uint8_t>(std::stoi(each.text.substr(10)));
          verify(apid, each.request, 7);
        }
      own_step();
      parts.waiting.watch(clock.now());
    }
  }
  /// As many as one of the supervisor's own functions takes.
  void some_steps() {
    for (int step = 0; step < 30; ++step) own_step();
  }
  std::vector<std::string> sent;
};

TEST_F(PlanStepKinds, CommandCallsAFunctionWithItsNumbers) {
  plan({{"command", {2, 1, 15}, {}, {"STOW", "0.5"}, {0.5}}});
  happens();
  EXPECT_THAT(texts(arm), ElementsAre("STOW"));
  EXPECT_TRUE(was_told("plan test: ARM STOW 0.5 because of BROKEN"));
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(PlanStepKinds, ACommandThatFailsEscalatesOnceAndIsTold) {
  plan({{"command", {2, 1, 15}, {}, {"STOW", "0.5"}, {0.5}}, to_be(PreOperational)});
  happens();
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  verify(arm, begun[0].request, 8, pus::FailureCode::ExecutionError);
  EXPECT_TRUE(was_told("plan failed (execution error): escalating"));
  EXPECT_TRUE(guard.fenced(arm)) << "the plan for high severity: down with its network";
  EXPECT_EQ(std::ranges::count_if(story, [](const std::string& line) { return line.find("escalating") != line.npos; }),
            1);
}

TEST_F(PlanStepKinds, ACommandMayTakeAsLongAsItsStepSaysOnceItHasBegun) {
  plan({{"command", {2, 1, 30}, {}, {"STOW", "0.5"}, {0.5}}, {"command", {2, 1, 15}, {}, {"STOW", "0.7"}, {0.7}}});
  happens();
  EXPECT_TRUE(was_told("plan test: ARM STOW 0.5 within 30 s because of BROKEN"));
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  verify(arm, begun[0].request, 1);
  verify(arm, begun[0].request, 3);
  wait(20s);
  parts.own_telecommands.watch(clock.now());
  EXPECT_FALSE(was_told("escalating"));
  verify(arm, begun[0].request, 7);
  EXPECT_THAT(texts(arm), ElementsAre("STOW")) << "the next step";
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(PlanStepKinds, ACommandThatTakesLongerThanItsStepSaysEscalates) {
  plan({{"command", {2, 1, 30}, {}, {"STOW", "0.5"}, {0.5}}});
  happens();
  verify(arm, received(arm).at(0).request, 3);
  wait(30s - 1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_FALSE(was_told("escalating"));
  wait(1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(was_told("plan failed (begun, and not completed within 30 s): escalating"));
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(PlanStepKinds, ACommandThatDoesNotBeginEscalatesAsSoonAsAnyHoweverLongItMayTake) {
  plan({{"command", {2, 1, 600}, {}, {"STOW", "0.5"}, {0.5}}});
  happens();
  verify(arm, received(arm).at(0).request, 1);
  wait(CommandDesk::answer_limit);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(was_told("plan failed (no answer): escalating")) << "accepted is not begun";
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(PlanStepKinds, ConfigureAndThenAState) {
  plan({to_be(SafeOperational), to_be(PreOperational), {"configure", {2}, {}, {"COUPLED"}}});
  happens();
  all_obey();
  EXPECT_THAT(sent, ElementsAre("ARM SET_STATE 4", "ARM SET_STATE 3", "ARM CONFIGURE 2"));
}

TEST_F(PlanStepKinds, LinkBeginsTheHandshakeOfTheSupervisor) {
  plan({{"link", {1}}});
  happens();
  some_steps();
  EXPECT_THAT(texts(hand), Contains("TC[128,1]"));
  EXPECT_FALSE(was_told("escalating"));
}

TEST_F(PlanStepKinds, UnlinkIsTheSupervisorsAndDoneOnceThoughAPlanIsForAll) {
  plan({{"unlink", {1}}}, "LOG_DAMAGED");
  parts.own.announce("LOG_DAMAGED", {1});
  some_steps();
  EXPECT_EQ(std::ranges::count_if(story, [](const std::string& line) { return line.find("UNLINK") != line.npos; }), 1)
      << "link 1 is not up: refused, told";
}

TEST_F(PlanStepKinds, FenceStopsTheActuatorsAndNothingElse) {
  plan({{"fence"}});
  happens();
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_FALSE(guard.fenced(hand));
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_TRUE(was_told("plan test: ARM fenced because of BROKEN"));
}

TEST_F(PlanStepKinds, FenceOfAnotherLeavesWhoseEventItIs) {
  plan({{"fence", {}, "HAND"}});
  happens();
  EXPECT_FALSE(guard.fenced(arm));
  EXPECT_TRUE(guard.fenced(hand));
}

TEST_F(PlanStepKinds, WhatFencesDoesSoBeforeTheFirstStepBegins) {
  plan({{"command", {2, 1, 15}, {}, {"STOW", "0.5"}, {0.5}}, {"kill"}});
  happens();
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_THAT(killed, IsEmpty()) << "the command runs";
  all_obey();
  EXPECT_THAT(killed, ElementsAre(played[arm].process));
  EXPECT_TRUE(was_told("plan test: ARM is ended because of BROKEN"));
}

TEST_F(PlanStepKinds, WaitForHoldsTheNextStepUntilSomebodyIsThere) {
  plan({{"wait_for", {static_cast<int>(PreOperational), hand, 5000}, {}, {"", "HAND"}}, to_be(SafeOperational)});
  happens();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_TRUE(guard.fenced(arm)) << "what stops does not wait";
  wait(4s);
  parts.waiting.watch(clock.now());
  EXPECT_THAT(texts(arm), IsEmpty());
  set(hand, PreOperational);
  parts.waiting.watch(clock.now());
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

TEST_F(PlanStepKinds, WaitForFailsAtItsTimeAndSoDoesItsPlan) {
  plan({{"wait_for", {static_cast<int>(Offline), 0, 5000}}, to_be(SafeOperational)});
  happens();
  wait(5s);
  parts.waiting.watch(clock.now());
  EXPECT_TRUE(was_told("plan failed (not in its time): escalating"));
}

TEST_F(PlanStepKinds, NotifyNetworkTellsItsMembersAndTakesNobodyDown) {
  parts.graph.set_up(1, true);
  plan({{"notify_network", {0}, {}, {"PARTNER_FAILED"}}});
  happens();
  EXPECT_THAT(texts(hand), ElementsAre("PARTNER_FAILED"));
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(texts(camera), IsEmpty()) << "it is in no network";
  for (const std::uint16_t apid : {arm, hand}) EXPECT_FALSE(guard.fenced(apid));
  EXPECT_TRUE(was_told("plan test: PARTNER_FAILED to HAND because of BROKEN of ARM"));
}

TEST_F(PlanStepKinds, NotifyNetworkWhereNobodyCanHearIsToldAndHoldsUpNobody) {
  plan({{"notify_network", {0}, {}, {"PARTNER_FAILED"}}, to_be(SafeOperational)});
  happens();
  EXPECT_THAT(texts(hand), IsEmpty()) << "no link joins them";
  EXPECT_TRUE(was_told("plan test: PARTNER_FAILED to nobody because of BROKEN of ARM"));
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

TEST_F(PlanStepKinds, ShutDownNetworkTakesDownAllThatLinksJoinToItByErrorOperationalAndNobodyElse) {
  parts.graph.set_up(1, true);
  plan({{"shut_down_network"}});
  happens();
  EXPECT_FALSE(guard.fenced(camera));
  EXPECT_TRUE(was_told("plan test: network {ARM, HAND} to ErrorOperational and down"));
  all_obey();
  EXPECT_THAT(sent, ElementsAre("ARM SET_STATE 6", "HAND SET_STATE 6", "ARM SET_STATE 0", "HAND SET_STATE 0"));
  for (const std::uint16_t apid : {arm, hand}) {
    EXPECT_TRUE(guard.fenced(apid));
    EXPECT_FALSE(craft.member(apid)->recovery.running());
  }
}

TEST_F(PlanStepKinds, ShutDownNetworkLeavesTheGroundLinkThoughALinkJoinsIt) {
  parts.graph.set_up(1, true);
  craft.mission.ground.subsystem = "HAND";
  plan({{"shut_down_network"}});
  happens();
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_FALSE(guard.fenced(hand));
  EXPECT_TRUE(was_told("plan test: network {ARM} to ErrorOperational and down"));
}

/// What was switched off by two telecommands, in Pre-Operational.
struct Recalling : PlanStepKinds {
  PlayedDesk desk;
  std::string end;
  void recall_in(State in) {
    const ProcedureStep made = step("recall", arm, {static_cast<std::int64_t>(in)});
    made.kind->run(made, means_with(desk),
                   [this](bool success, const std::string& why) { end = success ? "done" : why; });
  }
  void want_two_settings() {
    CommandedState commanded;
    const std::array data{std::byte{2}, std::byte{0}, std::byte{4}, std::byte{0}, std::byte{5}};
    const auto packet = telecommand(arm, 5, 6, data);
    commanded.completed(pus::TelecommandView::parse(packet).value(), craft.member(arm)->descriptor());
    parts.commanded.want(arm, commanded);
  }
};

TEST_F(Recalling, SendsWhatIsWantedOneAfterTheOther) {
  want_two_settings();
  recall_in(PreOperational);
  EXPECT_THAT(desk.sent, ElementsAre("10 TC[5,6] 0 ms"));
  desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 2U);
  EXPECT_EQ(end, "") << "the last has not answered";
  desk.answer(true);
  EXPECT_EQ(end, "done");
}

TEST_F(Recalling, EndsWithTheFirstThatIsRefused) {
  want_two_settings();
  recall_in(PreOperational);
  desk.answer(false, "wrong state");
  EXPECT_EQ(end, "wrong state");
  EXPECT_EQ(desk.sent.size(), 1U);
}

TEST_F(Recalling, IsDoneAtOnceWhereThereIsNothingToSend) {
  recall_in(PreOperational);
  EXPECT_EQ(std::exchange(end, {}), "done") << "nothing is wanted of it";
  want_two_settings();
  recall_in(SafeOperational);
  EXPECT_EQ(end, "done") << "nothing in that state";
  EXPECT_THAT(desk.sent, IsEmpty());
}

TEST_F(PlanStepKinds, PowerIsTheCraftsBudget) {
  plan({{"power", {400}}});
  happens();
  some_steps();
  EXPECT_EQ(parts.power.ledger().budget_mw(), 400'000U);
}

// --- hand_over: ARM's task to CAMERA ------------------------------------------------------------------------------------

struct HandingOver : PlanStepKinds {
  void SetUp() override {
    PlanStepKinds::SetUp();
    set(camera, Offline);
    plan({{"hand_over", {camera, 1}, {}, {"CAMERA", "ONLY"}}});
  }
};

TEST_F(HandingOver, TheGiverStopsAndTheReceiverComesUpFromWhereItIs) {
  happens();
  EXPECT_TRUE(guard.fenced(arm)) << "before anybody obeys";
  all_obey();
  EXPECT_THAT(sent, ElementsAre("ARM SET_STATE 4", "CAMERA SET_STATE 3", "CAMERA CONFIGURE 1", "CAMERA SET_STATE 4",
                                "CAMERA SET_STATE 5"));
  EXPECT_FALSE(guard.fenced(camera));
  EXPECT_TRUE(was_told("the task of ARM is with CAMERA"));
  EXPECT_FALSE(was_told("escalating"));
}

TEST_F(HandingOver, AGiverThatDoesNotObeyHoldsUpNobody) {
  happens();
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  verify(arm, begun[0].request, 8, pus::FailureCode::ExecutionError);
  all_obey();
  EXPECT_EQ(craft.member(camera)->state(), Operational);
}

TEST_F(HandingOver, ItGoesOnBehindTheWayDownOfTheGiversNetwork) {
  parts.graph.set_up(1, true);
  craft.mission.plans.back().steps.insert(craft.mission.plans.back().steps.begin(), {"shut_down_network"});
  happens();
  all_obey();
  for (const std::uint16_t apid : {arm, hand}) {
    EXPECT_TRUE(guard.fenced(apid));
    EXPECT_EQ(craft.member(apid)->state(), Offline);
  }
  EXPECT_EQ(craft.member(camera)->state(), Operational);
  EXPECT_FALSE(guard.fenced(camera));
}

/// No plan lets go who was stopped: by a stop of everything, by another plan, by a fence of whatever origin.
TEST_F(HandingOver, WhoWasStoppedReceivesNothingUntilSomebodyLetItGo) {
  parts.safe_all.asked();
  ASSERT_TRUE(guard.fenced(camera));
  set(arm, Operational);
  received(arm);
  happens();
  all_obey();
  EXPECT_TRUE(guard.fenced(camera));
  EXPECT_NE(craft.member(camera)->state(), Operational);
  EXPECT_TRUE(was_told("CAMERA was stopped, and nobody has let it go since"));
  EXPECT_TRUE(was_told("escalating"));
}

/// At each moment of the way up.
TEST_F(HandingOver, AStopOnTheWayUpEndsIt) {
  for (int steps = 0; steps < 5; ++steps) {
    SCOPED_TRACE(steps);
    set(camera, Offline);
    set(arm, Operational);
    craft.member(arm)->recovery.started();
    let_go(camera);
    craft.member(camera)->fences_when_free = guard.fences(camera);
    happens();
    for (int step = 0; step < steps; ++step) {
      for (const std::uint16_t apid : {arm, camera})
        for (const Received& each : received(apid)) {
          if (each.text.starts_with("SET_STATE ")) set(apid, static_cast<State>(std::stoi(each.text.substr(10))));
          verify(apid, each.request, 7);
        }
      own_step();
    }
    parts.safe_all.asked();
    all_obey();
    EXPECT_TRUE(guard.fenced(camera));
    EXPECT_TRUE(guard.fenced(arm));
    wait(30s);
    parts.own_telecommands.watch(clock.now());
  }
}

TEST_F(HandingOver, AGiverThatDoesNotActIsAskedForNothing) {
  set(arm, SafeOperational);
  happens();
  all_obey();
  EXPECT_THAT(sent,
              ElementsAre("CAMERA SET_STATE 3", "CAMERA CONFIGURE 1", "CAMERA SET_STATE 4", "CAMERA SET_STATE 5"));
  EXPECT_TRUE(guard.fenced(arm)) << "whatever it does next";
}

TEST_F(HandingOver, AReceiverThatIsThereAlreadyIsLeftAsItIs) {
  set(camera, Operational);
  happens();
  all_obey();
  EXPECT_THAT(sent, ElementsAre("ARM SET_STATE 4"));
  EXPECT_TRUE(was_told("the task of ARM is with CAMERA"));
}

TEST_F(HandingOver, AReceiverThatRefusesAStepEndsIt) {
  happens();
  verify(arm, received(arm).front().request, 7);
  const auto begun = received(camera);
  ASSERT_EQ(begun.size(), 1U);
  verify(camera, begun[0].request, 8, pus::FailureCode::ExecutionError);
  EXPECT_TRUE(was_told("nobody takes over the task of ARM: CAMERA PreOperational: execution error"));
  EXPECT_TRUE(was_told("escalating"));
}

TEST_F(HandingOver, WhatIsAgainstItIsSaidBeforeAnythingIsDone) {
  const auto against = [this](std::uint16_t receiver) {
    ProcedureStep made = step("hand_over", arm, {receiver, 1});
    return made.kind->against(made, parts.means);
  };
  EXPECT_EQ(against(camera), "");
  EXPECT_EQ(against(arm), "ARM has it");
  craft.changing_to = craft.mode;
  EXPECT_EQ(against(camera), "the mode changes");
  craft.shutting_down = true;
  EXPECT_EQ(against(camera), "the craft shuts down");
  craft.shutting_down = false;
  craft.changing_to = nullptr;
  Member& member = *craft.member(camera);
  member.recovery.plan_begins(Severity::Low);
  EXPECT_EQ(against(camera), "CAMERA is in a recovery");
  member.recovery.started();
  member.closed_at = clock.now();
  EXPECT_EQ(against(camera), "CAMERA is in a recovery");
  member.closed_at.reset();
  played[camera].vital->state = 77;
  EXPECT_EQ(against(camera), "CAMERA does not say where it is");
  set(camera, Offline);
  guard.fence(camera);
  EXPECT_EQ(against(camera), "CAMERA was stopped, and nobody has let it go since");
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(HandingOver, ItFailsWhereNobodyCanReceive) {
  ends[played[camera].process] = {};
  parts.processes.watch(clock.now());
  happens();
  all_obey();
  EXPECT_TRUE(was_told("plan failed (CAMERA is down): escalating"));
}

}  // namespace
}  // namespace hirosco::supervisor
