// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/output_parameter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// What is put out, or would be, as a parameter (adr 0073).
namespace hirosco {
namespace {

using testing::Probe;
using testing::Rig;

TEST(OutputParameter, HoldsFieldsOfAnyTypeInEitherByteOrder) {
  descriptor::Device device;
  device.name = "ARM";
  device.actuator = true;
  const auto add = [&](const char* name, Type type, std::uint32_t count) {
    descriptor::Device::Output output;
    output.field.name = name;
    output.field.type = type;
    output.field.count = count;
    device.output.push_back(output);
  };
  add("BRAKE", Type::Uint8, 3);
  add("TORQUE", Type::Double, 2);
  add("STEP", Type::Int16, 1);
  OutputParameter parameter{device};
  EXPECT_EQ(parameter.name(), "ARM_OUTPUT");
  EXPECT_TRUE(parameter.is_struct());
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::array<std::byte, 3 + 16 + 2> payload{}, seen{};
    OctetWriter writer{payload, order};
    writer.put(std::uint8_t{1}).put(std::uint8_t{2}).put(std::uint8_t{3}).put(1.5).put(-2.5).put(std::int16_t{-7});
    parameter.show(payload, order);
    ASSERT_EQ(parameter.snapshot_encode(parameter.fields(), seen), seen.size());
    OctetReader reader{seen};
    EXPECT_EQ(testing::hex(reader.get(3)), "010203");
    EXPECT_EQ(reader.get<double>(), 1.5);
    EXPECT_EQ(reader.get<double>(), -2.5);
    EXPECT_EQ(reader.get<std::int16_t>(), -7);
  }
  parameter.clear();
  std::array<std::byte, 21> seen{};
  ASSERT_EQ(parameter.snapshot_encode(parameter.fields(), seen), seen.size());
  EXPECT_THAT(seen, ::testing::Each(std::byte{}));
}

/// ARM of the probe: its author wants 5 N m in every state, -1 is safe, and no more than 3 goes out.
struct Outputs : ::testing::Test {
  static std::string bounded() {
    std::string text = testing::probe_descriptor;
    const std::string from = R"(<Field name="TORQUE" type="DOUBLE" safe="-1"/>)";
    text.replace(text.find(from), from.size(), R"(<Field name="TORQUE" type="DOUBLE" maximum="3" safe="-1"/>)");
    return text.insert(
        text.find("<Configuration name=\"ALONE\""),
        R"(<HKService id="9" interval="1"><SampledOnce><ParamRef name="ARM_OUTPUT.TORQUE"/></SampledOnce></HKService>)");
  }
  Probe probe;
  Rig rig{probe, bounded()};
  std::unique_ptr<DataFlow> arm = open("arm");
  std::unique_ptr<DataFlow> lamp = open("lamp");
  double sent{0};

  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig.flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
  }
  void exchange() {
    rig.service();
    rig.cycle();
    for (DataFlow* flow : {arm.get(), lamp.get()}) {
      std::array<std::byte, max_device_frame_octets> frame{}, buffer{};
      const auto found = flow->receive(frame);
      if (!found || found->flow != Flow::New) continue;
      const auto command = read_command(Octets{frame}.first(found->octets)).value();
      if (flow == arm.get()) sent = OctetReader{command.payload, std::endian::little}.get<double>();
      const std::array<std::byte, 8> payload{};
      static_cast<void>(flow->send(write_status(buffer, {.epoch = command.epoch,
                                                         .sequence = command.sequence,
                                                         .payload = Octets{payload}.first(flow == arm.get() ? 8 : 1)})
                                       .value()));
    }
    rig.service();
  }
  void go(State state) {
    const auto request = rig.set_state(state);
    for (int i = 0; i < 4; ++i) exchange();
    ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  /// By ST[20], which asks from outside of the cycle.
  double read() {
    std::array<std::byte, 5> data{};
    const auto& parameter = *rig.descriptor().find_parameter("ARM_OUTPUT");
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Struct, parameter.id}.wire());
    rig.forget_telemetry();
    static_cast<void>(rig.send(20, 1, data));
    rig.service();
    for (const auto& report : rig.telemetry)
      if (report.service == 20 && report.subtype == 2) return OctetReader{Octets{report.data}.subspan(5)}.get<double>();
    return -999;
  }
  double sampled() {
    rig.forget_telemetry();
    exchange();
    for (const auto& report : rig.telemetry)
      if (report.service == 3 && report.subtype == 25) return OctetReader{Octets{report.data}.subspan(2)}.get<double>();
    return -999;
  }
};

TEST_F(Outputs, AreTheAuthorsWishOutsideOfOperationalAndWhatIsPutOutInIt) {
  go(State::PreOperational);
  const auto configured = rig.configure(3);
  for (int i = 0; i < 3; ++i) exchange();
  ASSERT_EQ(rig.outcome(configured), "1 3 7");
  const auto expect = [&](double shown, double put_out, const char* when) {
    exchange();
    EXPECT_EQ(sent, put_out) << when;
    EXPECT_EQ(read(), shown) << when;
    EXPECT_EQ(sampled(), shown) << when;
  };
  expect(3, -1, "Pre-Operational");
  go(State::SafeOperational);
  expect(3, -1, "Safe-Operational");
  go(State::Operational);
  expect(3, 3, "Operational");
  probe.inhibits = true;
  expect(-1, -1, "inhibited");
  probe.inhibits = false;
  go(State::SafeOperational);
  expect(3, -1, "Safe-Operational again");
  go(State::ErrorOperational);
  expect(3, -1, "Error-Operational");
}

TEST_F(Outputs, AreZeroWhereTheConfigurationDoesNotUseTheDevice) {
  go(State::PreOperational);
  static_cast<void>(rig.configure(3));
  for (int i = 0; i < 3; ++i) exchange();
  EXPECT_EQ(read(), 3);
  go(State::PostOperational);
  go(State::PreOperational);
  static_cast<void>(rig.configure(1));
  for (int i = 0; i < 3; ++i) exchange();
  EXPECT_EQ(read(), 0);
}

}  // namespace
}  // namespace hirosco
