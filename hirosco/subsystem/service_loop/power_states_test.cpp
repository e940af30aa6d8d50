// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// The states at whose doors the power of devices is asked for (adr 0079), and configurations with fall-backs; the test plays the
/// supervisor's side.
namespace hirosco {
namespace {

using ::testing::HasSubstr;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

std::string lamp_with(const std::string& from, const std::string& to) {
  std::string text = probe_descriptor;
  return text.replace(text.find(from), from.size(), to);
}

struct PowerStates : ::testing::Test {
  Probe probe;
  Rig rig{probe,
          lamp_with("<Device name=\"LAMP\">", "<Device name=\"LAMP\"><Power transfer=\"unix\" address=\"power\"/>")};
  void bring_up() {
    rig.permit.powered = power_on;
    ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  }
};

TEST_F(PowerStates, HardwareInitWaitsForTheSwitchesBeforeItsAuthorIsAsked) {
  for (const Power said : {power_off, power_changes}) {
    rig.permit.powered = said;
    static_cast<void>(rig.set_state(State::PreOperational));
    rig.settle();
    EXPECT_EQ(rig.state(), State::HardwareInit);
    EXPECT_EQ(probe.nodes[State::HardwareInit].calls, 0);
  }
  rig.permit.powered = power_on;
  rig.settle();
  EXPECT_EQ(rig.state(), State::PreOperational);
  EXPECT_EQ(probe.nodes[State::HardwareInit].calls, 1);
}

TEST_F(PowerStates, ADeviceThatIsNotSwitchedOnFailsHardwareInitInItsTimeAndSaysSo) {
  const auto up = rig.set_state(State::PreOperational);
  rig.settle();
  rig.advance(power_limit);
  rig.service();
  EXPECT_EQ(rig.state(), State::HardwareInit) << "it has this long";
  rig.advance(1ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.outcome(up), ::testing::StartsWith("1 3 8:"));
  ASSERT_FALSE(rig.explanations.empty());
  EXPECT_THAT(rig.explanations.front(), HasSubstr("a device is not switched on"));
}

TEST_F(PowerStates, APowerSwitchOfAnotherVersionFailsHardwareInitAtOnceAndSaysSo) {
  const auto up = rig.set_state(State::PreOperational);
  rig.permit.powered = power_unknown_version;
  rig.settle();
  rig.permit.powered = power_off;
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.outcome(up), ::testing::StartsWith("1 3 8:"));
  ASSERT_FALSE(rig.explanations.empty());
  EXPECT_THAT(rig.explanations.front(), HasSubstr("of another version: build both from one hirosco"));
}

TEST_F(PowerStates, OfflineIsReachedWhenTheSwitchesHaveSaidOff) {
  bring_up();
  const auto down = rig.set_state(State::Offline);
  rig.settle();
  EXPECT_EQ(rig.state(), State::SoftwareDeinit) << "where the supervisor's side switches";
  rig.permit.powered = power_changes;
  rig.settle();
  EXPECT_EQ(rig.state(), State::SoftwareDeinit);
  rig.permit.powered = power_off;
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(rig.outcome(down), "1 3 7");
  EXPECT_EQ(rig.heard(descriptor::framework_event::state_failed), 0);
}

TEST_F(PowerStates, ASwitchThatDoesNotGoOffKeepsNobodyFromOfflineAndIsTold) {
  bring_up();
  static_cast<void>(rig.set_state(State::Offline));
  rig.settle();
  rig.advance(power_limit + 1ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(rig.heard(descriptor::framework_event::state_failed), 1);
}

TEST(WithoutAPowerSwitch, NobodyAsks) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.permit.powered = power_changes;
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
}

constexpr auto fell_back = descriptor::framework_event::fell_back(1);

/// The lamp by two ways; somebody else may have them.
struct FallBackStates : ::testing::Test {
  Probe probe;
  Rig rig{probe, lamp_with("address=\"lamp\"/>",
                           "address=\"lamp\"><FallBack transfer=\"unix\" address=\"lamp2\"/></Endnode>")};
};

/// The test plays arm, lamp and the lamp's fall-back, and is the consumer of a link.
struct LinkedDevices : ::testing::Test {
  static std::string text() {
    std::string text = lamp_with(R"("LAMP"><Endnode transfer="shared_memory" address="lamp"/>)",
                                 R"("LAMP" silence="20"><Endnode transfer="shared_memory" address="lamp">
                                      <FallBack transfer="unix" address="lamp2"/></Endnode>)");
    const std::string link =
        R"(<RealTimeLinkService><Provides name="ARM_STATE"><ParamRef name="SEEN"/></Provides></RealTimeLinkService>)";
    return text.insert(text.find("<Device name=\"ARM\" silence"), link);
  }
  std::unique_ptr<DataFlow> open(const char* address, Transfer transfer = Transfer::SharedMemory) {
    return std::move(craft.flows.open({transfer, address}, FlowSide::Device)).value();
  }
  static void answer(DataFlow& flow, std::size_t octets) {
    std::array<std::byte, max_frame_octets> frame{};
    const auto received = flow.receive(frame);
    if (!received || received->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(received->octets)).value();
    std::array<std::byte, max_frame_octets> status{};
    const std::array<std::byte, 8> payload{};
    static_cast<void>(flow.send(
        write_status(status,
                     {.epoch = command.epoch, .sequence = command.sequence, .payload = Octets{payload}.first(octets)})
            .value()));
  }
  void SetUp() override {
    craft.bring_to(State::PreOperational, 3);
    attached.emplace(craft.attach(2, pus::st128::Role::Producer, "ARM_STATE", {{"SEEN", Type::Double, 1}}));
  }
  /// Whether the consumer has a new sample after it.
  bool cycle() {
    craft.service();
    craft.cycle();
    if (arm_speaks) answer(*arm, 8);
    if (lamp_speaks) answer(*lamp, 1);
    if (spare_speaks) answer(*spare, 1);
    std::array<std::byte, 8> payload{};
    return attached->reader.read(payload).flow == Flow::New;
  }
  void enter(State state) {
    static_cast<void>(craft.set_state(state));
    for (int i = 0; i < 4; ++i) cycle();
    ASSERT_EQ(craft.state(), state);
  }
  Probe probe;
  Rig craft{probe, text()};
  std::unique_ptr<DataFlow> lamp = open("lamp"), spare = open("lamp2", Transfer::Unix), arm = open("arm");
  std::optional<Rig::Partner> attached;
  bool arm_speaks{true}, lamp_speaks{true}, spare_speaks{false};
};

TEST_F(LinkedDevices, TheEntryIntoControlWaitsForTheFirstAnswerOfEachDeviceAndUntilThenNoSampleGoesOut) {
  lamp_speaks = false;
  const auto entry = craft.set_state(State::SafeOperational);
  for (int i = 0; i < 100; ++i) {
    const bool came = cycle();
    EXPECT_FALSE(came && i > 0) << "what was sent before is of no device";
    ASSERT_EQ(craft.state(), State::PreOperational);
  }
  EXPECT_EQ(craft.outcome(entry), "1 3");
  lamp_speaks = true;
  EXPECT_FALSE(cycle()) << "it has been asked";
  EXPECT_TRUE(cycle()) << "and has answered";
  for (int i = 0; i < 2; ++i) cycle();
  EXPECT_EQ(craft.outcome(entry), "1 3 7");
  EXPECT_EQ(craft.inhibited(), 0U);
  EXPECT_EQ(craft.heard(descriptor::framework_event::device_lost(1)), 0);
}

TEST_F(LinkedDevices, WhoWaitsForADeviceIsTakenDownAllTheSame) {
  arm_speaks = false;
  static_cast<void>(craft.set_state(State::SafeOperational));
  for (int i = 0; i < 3; ++i) cycle();
  static_cast<void>(craft.set_state(State::ErrorOperational));
  for (int i = 0; i < 3; ++i) cycle();
  EXPECT_EQ(craft.state(), State::ErrorOperational);
}

TEST_F(LinkedDevices, TheWayIntoControlFailsByTheNameOfADeviceThatNeverAnswers) {
  arm_speaks = false;
  const auto entry = craft.set_state(State::SafeOperational);
  cycle();
  craft.advance(first_answer_limit);
  int cycles = 0;
  for (; craft.heard(testing::arm_lost) == 0 && cycles < 50; ++cycles) {
    EXPECT_EQ(craft.outcome(entry), "1 3");
    cycle();
  }
  EXPECT_LT(cycles, 8) << "what it may be silent, and the steps around it";
  for (int i = 0; i < 4; ++i) cycle();
  EXPECT_THAT(craft.outcome(entry), StartsWith("1 3 8:"));
  EXPECT_THAT(craft.explanations.back(),
              HasSubstr("SafeOperational failed: device ARM: never heard (shared_memory arm)"));
  EXPECT_EQ(craft.state(), State::ErrorOperational);
  EXPECT_NE(craft.inhibited() & inhibited_by_device, 0U);
}

TEST_F(LinkedDevices, AFallBackThatAnswersInPlaceOfADeviceThatNeverDidIsEnoughForTheWayIntoControl) {
  lamp_speaks = false;
  spare_speaks = true;
  const auto entry = craft.set_state(State::SafeOperational);
  cycle();
  craft.advance(first_answer_limit);
  for (int i = 0; i < 40; ++i) cycle();
  EXPECT_EQ(craft.outcome(entry), "1 3 7");
  EXPECT_EQ(craft.state(), State::SafeOperational);
  EXPECT_EQ(craft.heard(fell_back), 1);
}

TEST_F(LinkedDevices, WhoWaitsInControlForTheFirstAnswerIsTakenDownAllTheSame) {
  lamp_speaks = false;
  static_cast<void>(craft.set_state(State::SafeOperational));
  cycle();
  craft.advance(first_answer_limit);
  for (int i = 0; i < 4; ++i) cycle();
  const auto down = craft.set_state(State::ErrorOperational);
  for (int i = 0; i < 3; ++i) cycle();
  EXPECT_EQ(craft.outcome(down), "1 3 7");
  EXPECT_EQ(craft.state(), State::ErrorOperational);
}

TEST_F(LinkedDevices, WhileAFallBackHasNotAnsweredNoSampleGoesOutAndTheActuatorsAreInhibited) {
  enter(State::SafeOperational);
  enter(State::Operational);
  ASSERT_EQ(craft.inhibited(), 0U);
  ASSERT_TRUE(cycle());
  lamp_speaks = false;
  int sent = 0;
  while (craft.inhibited() == 0 && sent < 50) sent += cycle() ? 1 : 0;
  EXPECT_EQ(craft.inhibited(), inhibited_while_awaited);
  EXPECT_EQ(craft.heard(fell_back), 0) << "told with the next step of the service loop";
  EXPECT_FALSE(cycle());
  EXPECT_EQ(craft.heard(fell_back), 1);
  spare_speaks = true;
  EXPECT_FALSE(cycle()) << "it has been asked";
  EXPECT_TRUE(cycle()) << "and has answered";
  EXPECT_EQ(craft.inhibited(), 0U) << "the lamp is no actuator: nothing is left that could obey";
  EXPECT_EQ(craft.state(), State::Operational);
  EXPECT_EQ(craft.heard(descriptor::framework_event::device_lost(1)), 0);
}

TEST_F(LinkedDevices, FromOperationalTheWayToSafeOperationalWaitsForNoAnswerOfAFallBack) {
  enter(State::SafeOperational);
  enter(State::Operational);
  lamp_speaks = false;
  for (int cycles = 0; craft.inhibited() == 0 && cycles < 50; ++cycles) cycle();
  ASSERT_EQ(craft.inhibited(), inhibited_while_awaited);
  const auto down = craft.set_state(State::SafeOperational);
  craft.service();
  craft.cycle();
  craft.service();
  EXPECT_EQ(craft.outcome(down), "1 3 7") << "the cycle is there";
  EXPECT_EQ(craft.state(), State::SafeOperational);
}

TEST_F(FallBackStates, APreferredEndnodeThatCannotBeOpenedIsPassedOverAndTold) {
  const auto other = rig.flows.open({Transfer::SharedMemory, "lamp"}, FlowSide::Subsystem);
  rig.bring_to(State::PreOperational, 3);
  ASSERT_EQ(rig.heard(fell_back), 1);
  const auto told = std::ranges::find(rig.raised, fell_back, &testing::Raised::id);
  const std::vector<std::byte> expected{std::byte{7}, {}, std::byte{1}, {}, {}, {}, {}};  // not opened, left 0, taken 1
  EXPECT_EQ(told->auxiliary, expected);
  EXPECT_EQ(probe.lamp.endnode(), 1);
}

TEST_F(FallBackStates, AFallBackThatCannotBeOpenedIsToldAndThePreferredOneUsed) {
  const auto other = rig.flows.open({Transfer::Unix, "lamp2"}, FlowSide::Subsystem);
  rig.bring_to(State::PreOperational, 3);
  EXPECT_EQ(rig.heard(fell_back), 1);
  EXPECT_EQ(probe.lamp.endnode(), 0);
}

TEST_F(FallBackStates, AConfigurationWhoseEndnodesCannotAllBeOpenedIsRefused) {
  const auto one = rig.flows.open({Transfer::SharedMemory, "lamp"}, FlowSide::Subsystem);
  const auto other = rig.flows.open({Transfer::Unix, "lamp2"}, FlowSide::Subsystem);
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.configure_now(3), ::testing::StartsWith("1 3 8:"));
  EXPECT_EQ(rig.heard(descriptor::framework_event::configuration_failed), 1);
}

TEST_F(FallBackStates, AConfigurationWithAllItsEndnodesTellsNothing) {
  rig.bring_to(State::PreOperational, 3);
  EXPECT_EQ(rig.heard(fell_back), 0);
  EXPECT_EQ(probe.lamp.endnode(), 0);
}

}  // namespace
}  // namespace hirosco
