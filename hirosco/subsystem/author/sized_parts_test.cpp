// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// A subsystem whose descriptor says how many axes it has: parameters, housekeeping, links, device and functions follow.
namespace hirosco {
namespace {

using pus::st128::Role;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using testing::Rig;

constexpr std::string_view axes_descriptor = R"(<Subsystem name="AXES" id="12">
  <Parameters>
    <StructRef name="CUR_VALUES" id="0" type="STRUCT">
      <ParamRef name="STATE" id="0" type="INT32"/>
      <ParamRef name="ANGLE" id="100" type="DOUBLE" count="#"/>
    </StructRef>
    <ParamRef name="GOAL" id="1" type="DOUBLE" count="#" minimum="-9" maximum="9" writable="PreOperational Operational"/>
  </Parameters>
  <FunctionService>
    <Function name="MOVE" states="PreOperational SafeOperational Operational">
      @
    </Function>
  </FunctionService>
  <Device name="MOTORS" actuator="yes">
    <Input><Field name="ANGLE" type="DOUBLE" count="#"/></Input>
    <Output><Field name="TORQUE" type="DOUBLE" count="#" safe="~"/><Field name="LAMP" type="UINT8" safe="0"/></Output>
  </Device>
  <Configuration name="ALONE" id="1" priority="80" sampling_us="500">
    <HKService id="4711" interval="1"><SampledOnce><ParamRef name="CUR_VALUES.ANGLE"/></SampledOnce></HKService>
    <RealTimeLinkService>
      <Provides name="STATE"><ParamRef name="CUR_VALUES.ANGLE"/></Provides>
      <Requires name="HAND" age="3" age_reduced="10" missing="hold"><Field name="ANGLE" type="DOUBLE" count="#"/></Requires>
    </RealTimeLinkService>
    <Device name="MOTORS" silence="3" silence_reduced="40"><Endnode transfer="shared_memory" address="motors"/></Device>
  </Configuration>
</Subsystem>
)";

std::string with_axes(std::size_t count) {
  std::string text, arguments, zeros;
  for (std::size_t i = 1; i <= count; ++i) {
    arguments += "<Argument name=\"G" + std::to_string(i) + "\" type=\"DOUBLE\" minimum=\"-9\" maximum=\"9\"/>";
    zeros += "0 ";
  }
  zeros.pop_back();
  for (const char character : axes_descriptor)
    if (character == '#') text += std::to_string(count);
    else if (character == '@') text += arguments;
    else if (character == '~') text += zeros;
    else text += character;
  return text;
}

/// Follows its goal, in code that knows no number of axes.
struct AxesSubsystem final : Subsystem {
  using Angles = Sized<double, 6>;
  struct CurrentValues {
    std::int32_t state;
    Angles angle;
  };
  struct Angle {
    Angles angle;
  };
  struct Drive {
    Angles torque;
    std::uint8_t lamp;
  };
  Parameter<CurrentValues> current;
  Parameter<Angles> goal;
  LinkInput<Angle> hand;
  DevicePort<Angle, Drive> motors;

 protected:
  Result<Step> software_init() override {
    publish("CUR_VALUES", current);
    publish("GOAL", goal);
    require_link("HAND", hand);
    use_device("MOTORS", motors);
    on_function("MOVE", [this](const FunctionValues& values) -> Result<> {
      goal.store(Angles::of(values));
      return ok();
    });
    return done;
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override { return operational(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return operational(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override {
    current.store({static_cast<std::int32_t>(cycle.state), motors.input().angle});
    motors.output() = {.torque = goal.load(), .lamp = 7};
    return ok();
  }
};

struct SizedParts : ::testing::TestWithParam<std::size_t> {
  std::size_t n = GetParam();
  AxesSubsystem axes;
  Rig rig{axes, with_axes(n)};
  std::unique_ptr<DataFlow> device =
      std::move(rig.flows.open({Transfer::SharedMemory, "motors"}, FlowSide::Device)).value();
  std::vector<double> numbers;

  void SetUp() override {
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(0.5 + static_cast<double>(i));
    rig.bring_to(State::PreOperational);
  }
  [[nodiscard]] std::vector<std::byte> encoded(std::endian order) const {
    std::vector<std::byte> octets(8 * n);
    OctetWriter writer{octets, order};
    for (const double number : numbers) writer.put(number);
    return octets;
  }
  [[nodiscard]] static std::vector<double> decoded(Octets octets, std::size_t count, std::endian order) {
    OctetReader reader{octets, order};
    std::vector<double> values(count);
    for (double& value : values) value = reader.get<double>();
    return values;
  }
  /// ST[20]: id 1 of the subsystem, a DOUBLE.
  [[nodiscard]] std::vector<std::byte> about_goal(Octets value) const {
    std::vector<std::byte> data(5 + value.size());
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{12, Type::Double, 1}.wire()).put(value);
    return data;
  }
  void sense() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto payload = encoded(std::endian::little);
    static std::uint32_t sequence = 0;
    static_cast<void>(
        device->send(write_status(frame, {.epoch = 1, .sequence = ++sequence, .payload = payload}).value()));
    rig.cycle();
  }
};

TEST_P(SizedParts, ParametersAreWrittenAndReadInTheirLength) {
  const auto write = rig.send(20, 3, about_goal(encoded(std::endian::big)));
  rig.settle();
  EXPECT_EQ(rig.outcome(write), "1 3 7");
  EXPECT_THAT(axes.goal.load(), ElementsAreArray(numbers));
  rig.send(20, 1, about_goal({}));
  rig.settle();
  ASSERT_EQ(rig.reports(20, 2).size(), 1u);
  EXPECT_EQ(rig.reports(20, 2)[0], testing::hex(about_goal(encoded(std::endian::big))));
}

TEST_P(SizedParts, AFunctionTakesAsManyNumbersAsItsDescriptorDeclares) {
  const auto data = pus::encode_call(*rig.descriptor().find_function("MOVE"), numbers).value();
  const auto call = rig.send(8, 1, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(call), "1 3 7");
  EXPECT_THAT(axes.goal.load(), ElementsAreArray(numbers));
}

TEST_P(SizedParts, WhatADeviceSaysAndIsToldHasItsLength) {
  axes.goal.store(AxesSubsystem::Angles::of(numbers));
  const auto hand = rig.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, static_cast<std::uint16_t>(n)}});
  for (const State state : {State::SafeOperational, State::Operational}) {
    rig.set_state(state);
    for (int i = 0; i < 4; ++i) {
      rig.service();
      sense();
    }
  }
  ASSERT_EQ(rig.state(), State::Operational);
  EXPECT_THAT(axes.current.load().angle, ElementsAreArray(numbers));
  EXPECT_EQ(axes.motors.output().torque.size(), n);
  std::array<std::byte, max_device_frame_octets> frame{};
  std::size_t octets = 0;
  for (auto found = device->receive(frame); found && found->flow == Flow::New; found = device->receive(frame))
    octets = found->octets;
  const auto command = read_command(Octets{frame}.first(octets)).value();
  ASSERT_EQ(command.payload.size(), 8 * n + 1);
  EXPECT_EQ(decoded(command.payload, n, std::endian::little), numbers);
  EXPECT_EQ(command.payload.back(), std::byte{7}) << "right behind the last axis";
}

TEST_P(SizedParts, LinksCarryTheirLength) {
  const auto count = static_cast<std::uint16_t>(n);
  auto hand = rig.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, count}});
  auto state = rig.attach(2, Role::Producer, "STATE", {{"ANGLE", Type::Double, count}});
  ASSERT_TRUE(hand.writer && state.reader);
  hand.writer.write(encoded(std::endian::little), rig.clock.now(), LinkStatus::Valid);
  sense();
  sense();
  EXPECT_THAT(axes.hand.value().angle, ElementsAreArray(numbers));
  std::vector<std::byte> payload(8 * n);
  ASSERT_EQ(state.reader.read(payload).flow, Flow::New);
  EXPECT_EQ(decoded(payload, n, std::endian::little), numbers);
}

TEST_P(SizedParts, HousekeepingReportsTheirLength) {
  sense();
  rig.cycle(4);
  rig.service();
  const auto reports = rig.reports(3, 25);
  ASSERT_FALSE(reports.empty());
  EXPECT_THAT(reports.back(), ::testing::EndsWith(testing::hex(encoded(std::endian::big))));
}

INSTANTIATE_TEST_SUITE_P(Axes, SizedParts, ::testing::Values(1, 2, 6));

TEST(SizedParameter, HasTheInitialValuesOfAnOverride) {
  auto text = with_axes(3);
  text.replace(text.find(" minimum"), 0, R"( init="9 9 9")");
  auto described = testing::read_descriptor(text);
  EXPECT_FALSE(descriptor::apply_override(described, "GOAL=1 2"));
  ASSERT_TRUE(descriptor::apply_override(described, "GOAL=1 2 3"));
  EXPECT_THAT(described.parameters[1].init, ElementsAre(Value{1}, Value{2}, Value{3}));
  text.replace(text.find("9 9 9"), 5, "1 2 3");  // what the supervisor hands to the subsystem then
  AxesSubsystem axes;
  Rig rig{axes, text};
  rig.bring_to(State::PreOperational);
  EXPECT_THAT(axes.goal.load(), ElementsAre(1, 2, 3));
}

TEST(SizedParameter, LongerThanItsTypeFailsSoftwareInit) {
  AxesSubsystem axes;
  Rig rig{axes, with_axes(7)};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(
      rig.explanations,
      ElementsAre("AXES: SoftwareInit failed: CUR_VALUES.ANGLE (member 2): the C++ type is Sized<double, 6>, the "
                  "descriptor declares DOUBLE[7], which are more than 6",
                  "AXES: SoftwareInit failed: GOAL: the C++ type is Sized<double, 6>, the descriptor declares "
                  "DOUBLE[7], which are more than 6",
                  "AXES: SoftwareInit failed: parameters declared but not published: CUR_VALUES, GOAL",
                  ::testing::HasSubstr("require_link HAND: field ANGLE: C++ has DOUBLE[at most 6], the descriptor "
                                       "declares DOUBLE[7]"),
                  ::testing::HasSubstr("use_device MOTORS: input, field ANGLE: C++ has DOUBLE[at most 6], the "
                                       "descriptor declares DOUBLE[7]; output, field TORQUE: C++ has")));
}

}  // namespace
}  // namespace hirosco
