// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/modes.hpp"

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

struct ModesTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
    start_supervisor();
  }
  static constexpr int narrow = 2;
  /// ENTER_MODE of the ground has been read, and is still to be carried out.
  void ask_to_enter(int mode) {
    last_routed.erase(1);
    parts.telecommands.take(
        {.packet = telecommand(supervisor_apid, 8, 1, call_data("ENTER_MODE", mode)), .origin = Origin::ground()});
  }
  /// ENTER_MODE of the ground: the code of its failure; empty: it was done.
  std::optional<pus::FailureCode> enter_by_hand(int mode) {
    ask_to_enter(mode);
    for (int step = 0; step < 20; ++step) own_step();
    OctetReader reader{last_routed[1]};
    static_cast<void>(reader.get<std::uint32_t>());
    const auto code = reader.get<std::uint16_t>();
    return reader.good() ? std::optional{static_cast<pus::FailureCode>(code)} : std::nullopt;
  }
};

/// A lock on a mode.
descriptor::Interlock lock_on(descriptor::Interlock::Kind kind, std::string subsystem, State state) {
  return {.kind = kind, .subsystem = std::move(subsystem), .states = {state}, .configuration = {}, .at = {}};
}
using Lock = descriptor::Interlock::Kind;

TEST_F(ModesTest, AModeHoldsForAllFromTheSameMomentOn) {
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(call_own("SET_MODE", narrow), "done");
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_GT(craft.mode_epoch, before) << "what was permitted in the last mode is void";
  for (auto& [apid, member] : played) EXPECT_EQ(member.permit->mode_epoch.load(), craft.mode_epoch) << apid;
  EXPECT_TRUE(was_told("mode narrow"));
}

TEST_F(ModesTest, AModeThatTheMissionDoesNotHaveChangesNothing) {
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(call_own("SET_MODE", 9), to_text(pus::FailureCode::UnknownIdentifier));
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_EQ(craft.mode_epoch, before);
}

TEST_F(ModesTest, AModeWhoseMembersAreDeadIsRefusedUntilTheyLiveAgain) {
  craft.mission.modes[1].commission = {{.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}},
                                       {.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}}};
  craft.member(hand)->died();
  EXPECT_EQ(call_own("SET_MODE", narrow), "wrong status: reasons against it, all of them in TM[129,5]: 1");
  EXPECT_EQ(craft.mode->name, "open");
  parts.restarts.plan(hand, {.limit = 1, .within = 1s, .pause = 0s}, clock.now());
  parts.processes.watch(clock.now());
  EXPECT_EQ(call_own("SET_MODE", narrow), "") << "it has begun";
  EXPECT_NE(craft.changing_to, nullptr);
}

TEST_F(ModesTest, EnteringAModeMovesNobodyWhateverItCommissions) {
  craft.mission.modes[1].commission = {
      {.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}}};
  EXPECT_EQ(enter_by_hand(narrow), std::nullopt);
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_TRUE(texts(arm).empty());
  EXPECT_EQ(call_own("SET_MODE", 1), "done");
  EXPECT_EQ(enter_by_hand(9), pus::FailureCode::UnknownIdentifier);
}

TEST_F(ModesTest, WhatAModeIsEnteredFromNeedsAndExcludesHoldsForWhoEntersItByHandToo) {
  descriptor::Mode& wanted = craft.mission.modes[1];
  wanted.from = {"narrow"};
  wanted.interlocks = {lock_on(Lock::Excludes, "ARM", SafeOperational), lock_on(Lock::Needs, "HAND", Operational)};
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(enter_by_hand(narrow), pus::FailureCode::WrongStatus);
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_EQ(craft.mode_epoch, before) << "nothing that was permitted is void";
  EXPECT_TRUE(
      was_told("mode narrow is impossible: it is not entered from mode open; it excludes ARM in SafeOperational; "
               "it needs HAND in Operational"));
  const auto told = pus::st129::read_mode_preview(last_routed[129]);
  ASSERT_TRUE(told) << "the reasons are telemetry";
  EXPECT_EQ(told->against.size(), 3U);
  wanted.from = {"open"};
  set(hand, Operational);
  EXPECT_EQ(enter_by_hand(narrow), pus::FailureCode::WrongStatus) << "one that is left is enough";
  set(arm, PreOperational);
  EXPECT_EQ(enter_by_hand(narrow), std::nullopt);
  EXPECT_EQ(craft.mode->name, "narrow");
}

/// ARM in one of its states: a supervisor that nobody's loop keeps alive goes down by itself after a second.
struct InterlockInState : ModesTest, ::testing::WithParamInterface<State> {};

INSTANTIATE_TEST_SUITE_P(OfArm, InterlockInState,
                         ::testing::Values(Offline, SoftwareInit, HardwareInit, PreOperational, SafeOperational,
                                           Operational, ErrorOperational, PostOperational, HardwareDeinit,
                                           SoftwareDeinit),
                         [](const auto& info) { return std::string{to_text(info.param)}; });

TEST_P(InterlockInState, IsOneInEachStateOfAnotherAndAModeIsEnteredByHandWhereItWouldBeSetAndNowhereElse) {
  descriptor::Mode& wanted = craft.mission.modes[1];
  wanted.interlocks = {lock_on(Lock::Excludes, "ARM", Operational), lock_on(Lock::Needs, "HAND", SafeOperational)};
  set(arm, GetParam());
  for (const auto& of_hand : EnumTexts<State>::table) {
    set(hand, of_hand.value);
    craft.mode = &craft.mission.modes[0];
    const bool may = GetParam() != Operational && of_hand.value == SafeOperational;
    EXPECT_EQ(call_own("SET_MODE", narrow) == "done", may) << of_hand.text;
    craft.mode = &craft.mission.modes[0];
    EXPECT_EQ(!enter_by_hand(narrow), may) << of_hand.text;
    EXPECT_EQ(craft.mode->name, may ? "narrow" : "open");
  }
}

TEST_F(ModesTest, NoModeIsEnteredOnTheWayDown) {
  ask_to_enter(narrow);
  parts.shutdown.request();
  for (int step = 0; step < 20; ++step) own_step();
  EXPECT_EQ(craft.mode->name, "open");
}

/// On its way into its start mode `narrow`, which has ARM Operational: nobody has answered yet.
struct BeingCommissioned : ModesTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Offline);
    craft.mission.start_mode = "narrow";
    craft.mission.modes[1].commission = {
        {.subsystem = "ARM", .configuration = "COUPLED", .state = SafeOperational, .at = {}}};
    craft.mission.links.clear();
    craft.mission.subsystems[0].subsystem.configurations.front().requires_.clear();
    parts.own.start(craft.mode_epoch);
    parts.commissioning.start([] {});
    for (int step = 0; step < 200 && received_by_arm.empty(); ++step) {
      own_step();
      hear_arm();
    }
    ASSERT_FALSE(received_by_arm.empty());
  }
  std::vector<Received> received_by_arm;
  void hear_arm() {
    for (const Received& each : received(arm)) received_by_arm.push_back(each);
  }
  /// It does what it is told next.
  void answer() {
    const Received next = received_by_arm.front();
    received_by_arm.erase(received_by_arm.begin());
    constexpr std::string_view to_state = "SET_STATE ";
    if (next.text.starts_with(to_state))
      set(arm, static_cast<State>(std::stoi(next.text.substr(to_state.size()))), craft.member(arm)->configuration());
    else played[arm].vital->configuration = 2;
    verify(arm, next.request, 7);
    hear_arm();
  }
  /// Until its last step has been said, and nobody has read that.
  void go_to_the_last_step() {
    while (!received_by_arm.empty()) answer();
    ASSERT_EQ(parts.commissioning.waiting_for(), "SUPERVISOR: mode narrow");
  }
  void end() {
    for (int step = 0; step < 20; ++step) own_step();
  }
};

TEST_F(BeingCommissioned, NobodyEntersAModeBesideIt) {
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(enter_by_hand(1), pus::FailureCode::Busy);
  EXPECT_EQ(craft.mode_epoch, before);
  go_to_the_last_step();
  end();
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_TRUE(parts.commissioning.succeeded());
}

TEST_F(BeingCommissioned, WhomItExcludesAndSomebodyHasBroughtUpMeanwhileEndsIt) {
  craft.mission.modes[1].interlocks = {lock_on(Lock::Excludes, "CAMERA", Operational),
                                       lock_on(Lock::Needs, "ARM", Offline)};
  set(camera, Operational);
  go_to_the_last_step();
  end();
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_TRUE(craft.failed());
  EXPECT_TRUE(was_told("mode narrow is impossible: it excludes CAMERA in Operational"));
  EXPECT_FALSE(was_told("it needs ARM")) << "that was so before it brought ARM up";
}

TEST_F(BeingCommissioned, WhoseLastStepIsReadWhenItHasBeenStoppedEntersNoMode) {
  go_to_the_last_step();
  EXPECT_EQ(parts.under_way.cancel("SAFE_ALL"), Cancelled::ForGood);
  end();
  EXPECT_EQ(craft.mode->name, "open");
}

/// Changes of the whole craft: mode `narrow` has ARM and HAND Operational, `open` permits all and commissions nobody.
struct ModeChangeTest : ModesTest {
  std::string end;
  void SetUp() override {
    ModesTest::SetUp();
    craft.mission.links.clear();
    for (auto& wanted : craft.mission.subsystems[0].subsystem.configurations) wanted.requires_.clear();
    craft.mission.modes[1].commission = {
        {.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}},
        {.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}}};
    set(arm, Operational, 2);
    set(hand, PreOperational);
  }
  void begin() {
    parts.own_telecommands.command(supervisor_apid, "SET_MODE", narrow,
                                   [this](bool success, const std::string& why) { end = success ? "done" : why; });
    for (int step = 0; step < 40 && craft.changing_to == nullptr && end.empty(); ++step) own_step();
  }
  /// Members obey until the change has ended or nothing happens any more.
  void go_on() {
    for (int step = 0; step < 60 && end.empty(); ++step) {
      for (const std::uint16_t apid : {arm, hand})
        if (craft.member(apid)->alive()) obey(apid);
      own_step();
    }
  }
  /// So many telecommands of the change are obeyed, one at a time; the next one was sent, and nobody has answered it.
  void obey_some(int number) {
    std::map<std::uint16_t, std::vector<Received>> open;
    for (int obeyed = 0; end.empty();) {
      for (const std::uint16_t apid : {arm, hand})
        for (const Received& each : received(apid)) open[apid].push_back(each);
      const auto next = std::ranges::find_if(open, [](const auto& entry) { return !entry.second.empty(); });
      if (next == open.end() || obeyed++ == number) return;
      const Received answered = next->second.front();
      next->second.erase(next->second.begin());
      constexpr std::string_view to_state = "SET_STATE ";
      if (answered.text.starts_with(to_state))
        set(next->first, static_cast<State>(std::stoi(answered.text.substr(to_state.size()))),
            craft.member(next->first)->configuration());
      if (answered.text.starts_with("CONFIGURE")) played[next->first].vital->configuration = next->first == arm ? 2 : 1;
      verify(next->first, answered.request, 7);
      own_step();
    }
  }
  [[nodiscard]] bool fenced(std::uint16_t apid) { return played[apid].permit->stop.load() != 0; }
};

TEST_F(ModeChangeTest, OneTelecommandBringsTheWholeCraftIntoTheModeAndItsEndSaysSo) {
  begin();
  EXPECT_EQ(craft.changing_to, &craft.mission.modes[1]);
  EXPECT_EQ(craft.mode->name, "open") << "the old one holds until the end";
  go_on();
  EXPECT_EQ(end, "done");
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_EQ(craft.changing_to, nullptr);
  EXPECT_EQ(craft.member(hand)->state(), Operational);
  EXPECT_TRUE(was_told("change from mode open to narrow: 5 stages, moves HAND"));
}

TEST_F(ModeChangeTest, OfWhichThePlanThatCancelsItHearsThatTheFlightGoesOn) {
  begin();
  EXPECT_EQ(parts.under_way.cancel("a plan"), Cancelled::Ended);
  EXPECT_EQ(parts.under_way.cancel("a plan"), Cancelled::Nothing);
}

TEST_F(ModeChangeTest, ASecondChangeWaitsForTheEndOfTheFirst) {
  begin();
  EXPECT_EQ(call_own("SET_MODE", narrow), "busy: another change of mode is under way");
  go_on();
  EXPECT_EQ(end, "done");
}

TEST_F(ModeChangeTest, AnImpossibleOneIsRefusedAsAWholeAndEveryReasonIsTold) {
  craft.member(hand)->died();
  craft.mission.modes[1].from = {"narrow"};
  EXPECT_EQ(call_own("SET_MODE", narrow), "wrong status: reasons against it, all of them in TM[129,5]: 2");
  EXPECT_TRUE(was_told(
      "mode narrow is impossible: it is not entered from mode open; HAND is down: SET_STATE Offline starts it again"));
  EXPECT_TRUE(texts(arm).empty());
  EXPECT_THAT(routed_services, ::testing::Contains(129)) << "the reasons are telemetry, too";
}

TEST_F(ModeChangeTest, WhoeverFailsOnTheWayEndsItInTheInitialModeWithEverybodyOfItStopped) {
  set(arm, PreOperational, 1);
  begin();
  const auto sent = received(hand);
  ASSERT_FALSE(sent.empty());
  verify(hand, sent.front().request, 8, pus::FailureCode::DeviceError);
  go_on();
  EXPECT_EQ(end, "execution error: mode narrow not reached: HAND PostOperational; hirosco log");
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_EQ(craft.changing_to, nullptr);
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(fenced(apid)) << apid;
  EXPECT_TRUE(was_told("the change to mode narrow stopped: HAND PostOperational: "));
}

/// A reason has 64 octets: of what does not fit whole words are left out, and what to do never is.
TEST_F(ModeChangeTest, WhoAskedIsToldWhichModeWasNotReachedBecauseOfWhomAndWhatToDoHoweverLongTheNamesAre) {
  const auto told = [&](std::size_t letters, std::string_view why) {
    TearDown();
    std::destroy_at(this);
    std::construct_at(this);
    SetUp();
    craft.mission.modes[1].name.assign(letters, 'm');
    begin();
    static_cast<void>(parts.under_way.cancel(why));
    go_on();
    return end.substr(std::string_view{"execution error: "}.size());
  };
  EXPECT_EQ(told(6, "SAFE_ALL"), "mode mmmmmm not reached: SAFE_ALL; hirosco log");
  EXPECT_EQ(told(9, "CORONAGRAPH SafeOperational: timeout"), "mode mmmmmmmmm not reached: CORONAGRAPH; hirosco log");
  EXPECT_EQ(told(9, "plan network-down because of SIX ARM_LOST"),
            "mode mmmmmmmmm not reached: SIX ARM_LOST; hirosco log");
  EXPECT_EQ(told(34, "ARM Operational: timeout"), "mode " + std::string(34, 'm') + " not reached; hirosco log");
  for (std::size_t letters = 1; letters <= 64; ++letters) {
    const std::string words = told(letters, "one of several reasons; and another one");
    EXPECT_LE(words.size(), pus::FailureNotice::max_reason_text_octets) << words;
    EXPECT_THAT(words, ::testing::EndsWith("; hirosco log"));
  }
}

TEST_F(ModeChangeTest, WhoFellBackToAnotherConfigurationOnTheWayIsNotWhereTheModeWantsIt) {
  begin();
  for (int step = 0; step < 60 && end.empty(); ++step) {
    for (const Received& each : received(hand)) {
      if (each.text.starts_with("SET_STATE")) set(hand, static_cast<State>(each.text.back() - '0'), 9);
      verify(hand, each.request, 7);
    }
    own_step();
  }
  EXPECT_NE(end, "done");
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_TRUE(fenced(hand));
  EXPECT_TRUE(was_told("the change to mode narrow stopped: HAND is not in configuration ONLY"));
}

TEST_F(ModeChangeTest, ItEndsInTheOldModeTheNewOneOrSafeWhateverHappensAtAnyOfItsSteps) {
  using Disturb = void (*)(ModeChangeTest&);
  const std::pair<const char*, Disturb> disturbances[]{
      {"a member dies",
       [](ModeChangeTest& t) {
         t.ends[hand + 1000U] = {};
         t.parts.processes.watch(t.clock.now());
       }},
      {"a member fails",
       [](ModeChangeTest& t) {
         t.set(hand, ErrorOperational, 1);
         t.event(hand, 1, Severity::High);
       }},
      {"a stop by signal", [](ModeChangeTest& t) { t.parts.safe_all.asked(); }},
      {"a plan cancels", [](ModeChangeTest& t) { static_cast<void>(t.parts.under_way.cancel("a plan")); }},
      {"shutdown", [](ModeChangeTest& t) { t.parts.shutdown.request(); }},
      {"nobody answers", [](ModeChangeTest& t) {
         t.wait(60s);
         t.parts.own_telecommands.watch(t.clock.now());
       }}};
  int new_ones = 0, safe_ones = 0;
  for (const auto& [says, disturb] : disturbances)
    for (int at = 0; at < 10; ++at) {
      TearDown();
      std::destroy_at(this);
      std::construct_at(this);
      SetUp();
      set(arm, Operational, 1);  // in another configuration: it stops, goes down, and comes up again
      set(hand, Offline);
      begin();
      obey_some(at);
      disturb(*this);
      go_on();
      EXPECT_FALSE(parts.modes.running()) << says << " at " << at;
      EXPECT_EQ(craft.changing_to, nullptr) << says << " at " << at;
      EXPECT_FALSE(end.empty()) << says << " at " << at << ": whoever asked hears how it ended";
      const bool is_new = craft.mode->name == "narrow" && end == "done";
      const bool is_safe =
          craft.mode->name == "open" && end != "done" && (!craft.member(hand)->alive() || fenced(hand));
      EXPECT_TRUE(is_new || is_safe) << says << " at " << at << ": " << craft.mode->name << ", " << end;
      new_ones += is_new ? 1 : 0;
      safe_ones += is_safe ? 1 : 0;
    }
  EXPECT_EQ(new_ones, static_cast<int>(std::size(disturbances)))
      << "what comes after the ninth telecommand comes too late";
  EXPECT_EQ(safe_ones, 9 * static_cast<int>(std::size(disturbances)));
}

TEST_F(ModesTest, WhoIsStartedLaterIsInTheModeThatHoldsThen) {
  EXPECT_EQ(call_own("SET_MODE", narrow), "done");
  craft.member(hand)->died();
  parts.restarts.plan(hand, {.limit = 1, .within = 1s, .pause = 0s}, clock.now());
  parts.processes.watch(clock.now());
  EXPECT_EQ(played[hand].permit->mode_epoch.load(), craft.mode_epoch);
}

}  // namespace
}  // namespace hirosco::supervisor
