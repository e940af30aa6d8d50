// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// A subsystem asks the supervisor, and hears it (docs/adr/0216): HAND's descriptor says SET_MODE, ENTER_MODE, MODE, structure 4701 and HEARD_LOST. The mode
/// "open" permits it all, "narrow" nothing. CAMERA is the ground link.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;
namespace st129 = pus::st129;

struct AskedOfSupervisor : PartsTest {
  static constexpr int open = 1, narrow = 2;
  static constexpr std::uint16_t structure = 4701, heard_lost = 144;
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    const std::uint32_t mode_id = ParameterId{supervisor_apid, Type::Uint8, 0}.wire();
    using Kind = descriptor::Thing::Kind;
    for (auto& member : craft.mission.subsystems) {
      if (member.subsystem.id != hand) continue;
      member.subsystem.commands = {{.subsystem = "SUPERVISOR",
                                    .functions = {"SET_MODE", "ENTER_MODE", "SHUTDOWN"},
                                    .things = {{Kind::Read, "MODE", mode_id, {}}},
                                    .at = {},
                                    .apid = supervisor_apid}};
      member.subsystem.subscribes = {
          {.subsystem = "SUPERVISOR",
           .things = {{Kind::Housekeeping, "4701", structure, {}}, {Kind::Event, "HEARD_LOST", heard_lost, {}}},
           .at = {},
           .apid = supervisor_apid}};
    }
    craft.mission.modes[0].permits.push_back({.subsystem = "SUPERVISOR",
                                              .functions = {"*"},
                                              .services = {20},
                                              .parameters = {},
                                              .at = {},
                                              .from = {"HAND"}});
    start_all(SafeOperational);
    start_supervisor();
    heard();
  }
  /// HAND sends this to the supervisor, as its own telecommand.
  void send(std::uint8_t service, std::uint8_t subtype, Octets data, std::uint8_t ack = pus::ack_all) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = supervisor_apid,
                                                .sequence_count = count++,
                                                .ack = ack,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = hand},
                                               data);
    // With the newest stop: it knows of that.
    const Message message{.kind = MessageKind::Packet, .epoch = guard.newest_stop(), .packet = *packet};
    ASSERT_TRUE(played[hand].channel.subsystem_end().send(message));
    parts.reception.read(*craft.member(hand));
  }
  void ask_for_mode(int mode, const char* function = "SET_MODE") { send(8, 1, call_data(function, mode)); }
  void ask_by_ground(int mode) {
    const auto asked = telecommand(supervisor_apid, 8, 1, call_data("SET_MODE", mode));
    parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  }
  /// Steps of a supervisor whose loop goes on.
  void settle(int steps = 20) {
    for (int step = 0; step < steps; ++step) {
      parts.own.beat(parts.own.beats() + 1);
      own_step();
    }
  }
  /// What HAND was given since it was asked last: "1.7", "1.2 code 13", "3.25", "5.2", with the source that it is of.
  std::vector<std::string> heard() {
    std::vector<std::string> found;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[hand].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      const auto report = pus::TelemetryView::parse(next->message.packet);
      if (!report) continue;
      EXPECT_EQ(report->apid(), supervisor_apid);
      std::string text = std::to_string(report->service()) + "." + std::to_string(report->subtype());
      OctetReader reader{report->source_data()};
      static_cast<void>(reader.get<std::uint32_t>());
      if (report->service() == 1 && report->subtype() % 2 == 0)
        text += " code " + std::to_string(reader.get<std::uint16_t>());
      found.push_back(text);
    }
  }
};

TEST_F(AskedOfSupervisor, ASubsystemIsToldHowItEndedLikeOfEveryOtherMember) {
  ask_for_mode(narrow);
  EXPECT_EQ(craft.mode->name, "open") << "it waits its turn";
  settle();
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_THAT(heard(), ElementsAre("1.1", "1.3", "1.7"));
  ask_for_mode(open);
  settle();
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_THAT(heard(), ElementsAre("1.2 code 13")) << "this mode permits it nothing";
}

TEST_F(AskedOfSupervisor, ItReadsWhatItDeclaresAndNothingElse) {
  std::vector<std::byte> data(5);
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{supervisor_apid, Type::Uint8, 0}.wire());
  send(20, 1, data);
  settle();
  EXPECT_THAT(heard(), Contains("20.2"));
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{supervisor_apid, Type::Struct, 3}.wire());
  send(20, 1, data);
  settle();
  EXPECT_THAT(heard(), ElementsAre("1.2 code 18"));
}

TEST_F(AskedOfSupervisor, WhatADescriptorDeclaresInVainIsRefusedWithWords) {
  send(8, 1, call_data("SHUTDOWN"));
  settle();
  EXPECT_THAT(heard(), ElementsAre("1.2 code 263"));
  EXPECT_FALSE(craft.shutting_down);
}

TEST_F(AskedOfSupervisor, AModeThatLetsSomebodyMoveIsNotItsToAskForAndTheGroundsIs) {
  craft.mission.modes[1].commission = {
      {.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}},
      {.subsystem = "HAND", .configuration = "ONLY", .state = SafeOperational, .at = {}}};
  craft.mission.subsystems[0].subsystem.configurations[0].requires_.clear();
  const std::uint64_t fences = guard.fences(arm);
  ask_for_mode(narrow);
  settle();
  EXPECT_EQ(craft.changing_to, nullptr);
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_TRUE(was_told("mode narrow is impossible: it lets ARM move, which the ground may ask for and no subsystem"));
  EXPECT_THAT(heard(), ElementsAre("1.1", "129.5", "1.4 code 259"));
  EXPECT_TRUE(texts(arm).empty()) << "nobody is moved";
  EXPECT_EQ(guard.fences(arm), fences);
  craft.mission.modes[1].commission[0].state = SafeOperational;
  ask_for_mode(narrow);
  settle();
  EXPECT_NE(craft.changing_to, nullptr) << "nobody is let move";
}

TEST_F(AskedOfSupervisor, AModeThatMovesTheGroundLinkIsNotItsToAskForAndTheGroundsIs) {
  craft.mission.modes[1].commission = {
      {.subsystem = "CAMERA", .configuration = "ONLY", .state = PreOperational, .at = {}},
      {.subsystem = "HAND", .configuration = "ONLY", .state = SafeOperational, .at = {}}};
  ask_for_mode(narrow);
  settle();
  EXPECT_EQ(craft.changing_to, nullptr);
  EXPECT_TRUE(was_told("it moves CAMERA, the ground link, which the ground may ask for and no subsystem"));
  EXPECT_THAT(heard(), Contains("1.4 code 259"));
  EXPECT_TRUE(texts(camera).empty());
  ask_by_ground(narrow);
  settle();
  EXPECT_NE(craft.changing_to, nullptr);
}

/// Each change voids what was permitted before it, what the ground said as well, by which it would take the permit away.
TEST_F(AskedOfSupervisor, OneThatAsksForModesWithoutEndIsGivenOneInAPauseAndTheGroundIsNotHeldUp) {
  auto& permits = craft.mission.modes[1].permits;
  permits.push_back(craft.mission.modes[0].permits.back());
  permits.push_back({.subsystem = "SUPERVISOR", .functions = {"SET_MODE"}, .services = {}, .parameters = {}, .at = {}});
  ask_for_mode(narrow);
  settle();
  ASSERT_EQ(craft.mode->name, "narrow");
  heard();
  const std::uint32_t epoch = craft.mode_epoch;
  constexpr int times = 20;
  for (int i = 0; i < times; ++i) {
    ask_for_mode(i % 4 < 2 ? open : narrow, i % 2 == 0 ? "SET_MODE" : "ENTER_MODE");
    settle(50);
  }
  EXPECT_EQ(craft.mode_epoch, epoch) << "nothing that the ground was permitted is void";
  const auto told = heard();
  EXPECT_EQ(std::ranges::count(told, "1.4 code 264"), times);
  ask_by_ground(open);
  settle();
  EXPECT_EQ(craft.mode->name, "open") << "the ground waits for no pause";
  settle(static_cast<int>(Modes::pause_of_subsystems / 1ms));
  ask_for_mode(narrow, "ENTER_MODE");
  settle();
  EXPECT_EQ(craft.mode->name, "narrow");
  ask_for_mode(open);
  settle();
  EXPECT_EQ(craft.mode->name, "narrow") << "behind a mode that it entered it waits, too";
}

TEST_F(AskedOfSupervisor, BehindAChangeThatFailedItWaitsToo) {
  craft.mission.modes[1].commission = {
      {.subsystem = "HAND", .configuration = "ONLY", .state = PreOperational, .at = {}}};
  ask_for_mode(narrow);
  settle();
  ASSERT_NE(craft.changing_to, nullptr);
  parts.modes.cancel("a test");
  settle();
  ASSERT_EQ(craft.changing_to, nullptr);
  heard();
  ask_for_mode(narrow, "ENTER_MODE");
  settle();
  EXPECT_THAT(heard(), ElementsAre("1.1", "1.4 code 264"));
}

TEST_F(AskedOfSupervisor, WhatItSaidBeforeAStopIsNotCarriedOutBehindIt) {
  ask_for_mode(narrow);
  parts.under_way.all_stopped("a test");
  settle();
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_THAT(heard(), Not(Contains("1.7")));
}

TEST_F(AskedOfSupervisor, ASubsystemThatIsNotSoundAsksForNothing) {
  set(hand, ErrorOperational);
  ask_for_mode(narrow);
  settle();
  EXPECT_THAT(heard(), ElementsAre("1.2 code 10"));
}

/// As many as of every other addressee: what waits for the supervisor's turn is the ground's place, too.
TEST_F(AskedOfSupervisor, MoreThanItMayHaveUnderWayAreRefusedAndAStopNever) {
  for (std::size_t i = 0; i < Requester::most_open + 4; ++i) ask_for_mode(9);
  settle();
  auto told = heard();
  EXPECT_EQ(std::ranges::count(told, "1.2 code 11"), 4);
  EXPECT_EQ(std::ranges::count(told, "1.4 code 257"), static_cast<std::ptrdiff_t>(Requester::most_open));
  settle(1000);  // the next second begins
  for (std::size_t i = 0; i < Requester::most_a_second + 10; ++i) {
    ask_for_mode(9);
    settle(2);
  }
  told = heard();
  EXPECT_EQ(std::ranges::count(told, "1.2 code 11"), 10) << "in one second";
  send(8, 1, call_data("SAFE_ALL"));
  settle();
  EXPECT_THAT(heard(), Contains("1.1"));
  EXPECT_TRUE(was_told("every actuator inhibited"));
}

/// It stops the craft as often as it says so. Of so many at once it is told the outcome of the first ones.
TEST_F(AskedOfSupervisor, AStopThatIsSaidWithoutEndIsCarriedOutEachTimeAndKeptForBoundedlyMany) {
  const std::uint32_t before = guard.newest_stop();
  constexpr std::uint32_t times = SafeAll::most_waiting + 10;
  for (std::uint32_t i = 0; i < times; ++i) send(8, 1, call_data("SAFE_ALL"));
  EXPECT_EQ(guard.newest_stop(), before + times);
  settle(1);
  const auto told = heard();
  EXPECT_EQ(std::ranges::count(told, "1.3"), static_cast<std::ptrdiff_t>(times));
  EXPECT_EQ(std::ranges::count(told, "1.8 code 514"), 10) << "carried out, and no outcome of its own";
  std::vector<std::byte> noted(4096);
  OctetWriter writer{noted};
  parts.safe_all.note(writer);
  constexpr std::size_t counts = 2 * sizeof(std::uint16_t);
  EXPECT_LE(writer.size(), counts + SafeAll::most_waiting * 8);
}

TEST_F(AskedOfSupervisor, WhatNobodyWaitsForTheEndOfIsRefused) {
  send(8, 1, call_data("SET_MODE", narrow), pus::ack_acceptance);
  settle();
  EXPECT_THAT(heard(), ElementsAre("1.2 code 9"));
}

TEST_F(AskedOfSupervisor, ItsHousekeepingAndEventsAreHeardByWhoDeclaresThat) {
  using What = st129::Subscribed::What;
  for (const auto& what : {st129::Subscribed{supervisor_apid, What::Structure, structure},
                           st129::Subscribed{supervisor_apid, What::Event, heard_lost}}) {
    send(129, st129::subscribe, st129::write_subscribed(what), pus::ack_completion);
    settle(1);
    EXPECT_THAT(heard(), ElementsAre("1.7"));
  }
  send(129, st129::subscribe, st129::write_subscribed({supervisor_apid, What::Structure, structure + 1}),
       pus::ack_completion);
  settle(1);
  EXPECT_THAT(heard(), ElementsAre("1.2 code 18"));
  settle(2500);
  const auto told = heard();
  EXPECT_GE(std::ranges::count(told, "3.25"), 2) << "each second, and of other structures none";
  EXPECT_LE(std::ranges::count(told, "3.25"), 3);
  parts.own.announce("HEARD_LOST", {double{arm}, 3.0});
  settle();
  EXPECT_THAT(heard(), Contains("5.2"));
  parts.own.announce("LOCAL_STOP");
  settle();
  EXPECT_THAT(heard(), Not(Contains("5.3")));
}

}  // namespace
}  // namespace hirosco::supervisor
