// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/device_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// A motor and a lamp: what is inhibited and told when one of them falls silent, in each state that has cycles.
namespace hirosco::losses {
namespace {

using descriptor::DeviceLoss;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::array cyclic_states{State::PreOperational, State::SafeOperational, State::Operational,
                                   State::ErrorOperational};
constexpr const char* motor_and_lamp = R"(<Subsystem name="ARM" id="10">
  <Device name="MOTOR" actuator="yes"><Input><Field name="ANGLE" type="UINT16"/></Input><Output><Field name="CURRENT" type="UINT16" safe="0"/></Output></Device>
  <Device name="LAMP"><Input><Field name="LIT" type="UINT16"/></Input><Output><Field name="LIT" type="UINT16"/></Output></Device>
  <Configuration name="ONE" id="1" sampling_us="1000">
    <Device name="MOTOR" silence="3"><Endnode transfer="shared_memory" address="motor"><FallBack transfer="shared_memory" address="motor-b"/></Endnode></Device>
    <Device name="LAMP" silence="3"><Endnode transfer="shared_memory" address="lamp"/></Device>
  </Configuration>
</Subsystem>)";

struct Word {
  std::uint16_t word;
};

/// Event and reason.
using Told = std::pair<std::uint16_t, int>;
[[nodiscard]] Told lost(std::size_t device, DeviceLoss reason) {
  return {descriptor::framework_event::device_lost(device), static_cast<int>(reason)};
}
[[nodiscard]] Told fell_back(std::size_t device, DeviceLoss reason) {
  return {descriptor::framework_event::fell_back(device), static_cast<int>(reason)};
}

/// Three silent cycles are too many. The test plays both devices.
struct TwoDevices {
  descriptor::SubsystemDescriptor descriptor = [] {
    auto made = testing::read_descriptor(motor_and_lamp);
    descriptor::add_framework_events(made);
    return made;
  }();
  LocalFlows flows;
  std::map<std::string, std::unique_ptr<DataFlow>> played;
  DevicePort<Word, Word> motor, lamp;
  CyclePlan plan;
  ControlState control;
  LoopRings rings;
  ReportWriter reports{descriptor.events, rings};
  SelfTestRun self_test{reports};
  DeviceInputs devices{{descriptor, plan, control, self_test, reports}};
  std::uint32_t sequence{0};

  explicit TwoDevices(State state, bool with_fall_back = false) {
    for (const char* address : {"motor", "motor-b", "lamp"})
      played[address] = std::move(flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
    add(0, motor, with_fall_back ? std::vector{"motor", "motor-b"} : std::vector{"motor"});
    add(1, lamp, {"lamp"});
    control.enter(state);
    devices.begin();
  }
  void add(std::size_t device, DevicePortBase& port, const std::vector<const char*>& addresses) {
    std::vector<DeviceSlot::Way> ways;
    for (const char* address : addresses)
      ways.push_back({std::move(flows.open({Transfer::SharedMemory, address}, FlowSide::Subsystem)).value(),
                      static_cast<std::uint8_t>(ways.size())});
    plan.devices.emplace_back(descriptor.devices[device], descriptor.configurations[0].devices[device], port,
                              std::move(ways), 1ms, true);
    plan.device_lost_events.push_back(descriptor::framework_event::device_lost(device));
    plan.fell_back_events.push_back(descriptor::framework_event::fell_back(device));
  }
  void say(const char* address) {
    const std::array<std::byte, 2> payload{};
    std::array<std::byte, max_device_frame_octets> buffer{};
    static_cast<void>(
        played[address]->send(write_status(buffer, {.epoch = 0, .sequence = ++sequence, .payload = payload}).value()));
  }
  /// In which these have answered.
  void cycle(const std::vector<const char*>& answering, bool counts = true) {
    for (const char* address : answering) say(address);
    control.clear_awaited();
    devices.read(counts);
  }
  /// Events since it was asked last.
  [[nodiscard]] std::vector<Told> told() {
    std::vector<Told> events;
    while (const auto record = rings.answers.front()) {
      CycleReport head;
      std::memcpy(&head, record->data(), sizeof head);
      if (head.kind == ReportKind::Event) events.emplace_back(head.index, std::to_integer<int>((*record)[sizeof head]));
      rings.answers.pop();
    }
    return events;
  }
  [[nodiscard]] std::uint32_t where_it_controls(Inhibition reason) const {
    return control.controlling() ? std::uint32_t{reason} : 0U;
  }
};

TEST(LostDevices, AreToldOnceInEachStateAndInhibitWhereTheSubsystemControls) {
  for (const State state : cyclic_states) {
    TwoDevices craft{state};
    craft.cycle({"motor", "lamp"});
    EXPECT_FALSE(craft.devices.awaits_first_answer());
    for (int silent = 1; silent < 3; ++silent) craft.cycle({"lamp"});
    EXPECT_THAT(craft.told(), IsEmpty()) << to_text(state);
    EXPECT_EQ(craft.control.inhibited(), 0u) << to_text(state);
    craft.cycle({"lamp"});
    EXPECT_THAT(craft.told(), ElementsAre(lost(0, DeviceLoss::Silent))) << to_text(state);
    EXPECT_EQ(craft.control.inhibited(), craft.where_it_controls(inhibited_by_device)) << to_text(state);
    EXPECT_FALSE(craft.control.active());
    for (int silent = 0; silent < 5; ++silent) craft.cycle({"lamp"});
    craft.cycle({"motor", "lamp"});
    EXPECT_THAT(craft.told(), IsEmpty()) << to_text(state);
    EXPECT_EQ(craft.control.inhibited(), craft.where_it_controls(inhibited_by_device))
        << "it is back, and nobody goes on";
    EXPECT_FALSE(craft.devices.never_answered()) << "it was heard before";
  }
}

TEST(LostDevices, AreWaitedForUntilTheyAnswerAndAreLateOnlyWhereTheSubsystemControls) {
  for (const State state : cyclic_states) {
    TwoDevices craft{state};
    for (int silent = 1; silent < 3; ++silent) {
      craft.cycle({"lamp"});
      EXPECT_TRUE(craft.devices.awaits_first_answer()) << to_text(state);
      EXPECT_TRUE(craft.devices.awaits_device()) << to_text(state);
      EXPECT_EQ(craft.control.inhibited(), craft.where_it_controls(inhibited_while_awaited)) << to_text(state);
      EXPECT_FALSE(craft.control.active());
    }
    craft.cycle({"lamp"});
    const bool late = craft.control.controlling();
    EXPECT_EQ(craft.devices.awaits_first_answer(), !late) << to_text(state);
    EXPECT_EQ(craft.devices.awaits_device(), !late) << to_text(state);
    EXPECT_EQ(craft.control.inhibited(), craft.where_it_controls(inhibited_by_device)) << to_text(state);
    if (!late) {
      EXPECT_THAT(craft.told(), IsEmpty()) << to_text(state);
      EXPECT_FALSE(craft.devices.never_answered()) << to_text(state);
      continue;
    }
    EXPECT_THAT(craft.told(), ElementsAre(lost(0, DeviceLoss::NeverHeard))) << to_text(state);
    ASSERT_TRUE(craft.devices.never_answered()) << to_text(state);
    EXPECT_EQ(craft.devices.never_answered()->device, 0);
    EXPECT_EQ(craft.devices.never_answered()->reason, DeviceLoss::NeverHeard);
  }
}

TEST(LostDevices, OfSeveralThatNeverAnsweredTheFirstIsNamedUntilAnotherPlanBegins) {
  TwoDevices craft{State::SafeOperational};
  craft.cycle({"motor"});
  for (int silent = 0; silent < 2; ++silent) craft.cycle({});
  EXPECT_THAT(craft.told(), ElementsAre(lost(1, DeviceLoss::NeverHeard)));
  craft.cycle({});
  EXPECT_THAT(craft.told(), ElementsAre(lost(0, DeviceLoss::Silent)));
  EXPECT_EQ(craft.devices.never_answered()->device, 1);
  craft.devices.begin();
  EXPECT_FALSE(craft.devices.never_answered());
  EXPECT_TRUE(craft.devices.awaits_first_answer());
  craft.plan.devices.clear();
  craft.devices.begin();
  EXPECT_FALSE(craft.devices.awaits_first_answer()) << "nobody is there to wait for";

  TwoDevices silent{State::SafeOperational};
  for (int cycle = 0; cycle < 3; ++cycle) silent.cycle({});
  EXPECT_THAT(silent.told(), ElementsAre(lost(0, DeviceLoss::NeverHeard), lost(1, DeviceLoss::NeverHeard)));
  EXPECT_EQ(silent.devices.never_answered()->device, 0);
}

TEST(LostDevices, ThatHaveAnotherWayFallBackFirstAndHoldTheActuatorsMeanwhile) {
  TwoDevices craft{State::Operational, true};
  craft.cycle({"motor", "lamp"});
  EXPECT_TRUE(craft.control.active());
  for (int silent = 0; silent < 3; ++silent) craft.cycle({"lamp"});
  EXPECT_THAT(craft.told(), ElementsAre(fell_back(0, DeviceLoss::Silent)));
  EXPECT_EQ(craft.control.inhibited(), std::uint32_t{inhibited_while_awaited});
  EXPECT_TRUE(craft.devices.awaits_device());
  for (int silent = 0; silent < 3; ++silent) craft.cycle({"lamp"});
  EXPECT_THAT(craft.told(), ElementsAre(lost(0, DeviceLoss::Silent)));
  EXPECT_EQ(craft.control.inhibited(), std::uint32_t{inhibited_by_device});
  EXPECT_FALSE(craft.devices.awaits_device());
}

TEST(LostDevices, EndASelfTestThatRuns) {
  TwoDevices craft{State::SafeOperational};
  craft.cycle({"motor", "lamp"});
  craft.self_test.begin({}, 1s);
  for (int silent = 1; silent < 3; ++silent) craft.cycle({"motor"});
  EXPECT_TRUE(craft.self_test.running());
  craft.cycle({"motor"});
  EXPECT_FALSE(craft.self_test.running());
}

TEST(LostDevices, AreNotCountedSilentInCyclesInWhichNoLimitGoesOn) {
  TwoDevices craft{State::Operational};
  craft.cycle({"motor", "lamp"});
  for (int cycle = 0; cycle < 20; ++cycle) craft.cycle({}, false);
  EXPECT_THAT(craft.told(), IsEmpty());
  EXPECT_TRUE(craft.control.active());
}

}  // namespace
}  // namespace hirosco::losses
