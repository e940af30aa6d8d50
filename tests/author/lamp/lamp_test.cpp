// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <hirosco/data_transfer/device/device_frame.hpp>
#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>
#include <string>
#include <utility>

#include "lamp.hpp"

using namespace hirosco;

namespace {

std::string lamp_xml() { return descriptor::file_system()("lamp.xml").value(); }

constexpr std::uint8_t nominal = 1, night = 2;

/// The test plays the supervisor, the clock and the lamp.
struct Lamp {
  explicit Lamp(descriptor::SubsystemDescriptor described = hirosco::testing::read_descriptor(lamp_xml()))
      : rig{*author, std::move(described)} {}
  void cycle(int count) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      std::array<std::byte, max_device_frame_octets> frame{}, answer{};
      const auto found = device->receive(frame);
      if (!found || found->flow != Flow::New) continue;
      const auto command = read_command(Octets{frame}.first(found->octets)).value();
      current_a =
          command.mode == DeviceMode::Active ? OctetReader{command.payload, std::endian::little}.get<double>() : 0.0;
      most_a = std::max(most_a, current_a);
      const std::array<std::byte, 8> dark{};
      static_cast<void>(
          device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = dark}).value()));
    }
    rig.service();
  }
  std::string do_now(const hirosco::testing::Sent& request) {
    cycle(10);
    return rig.outcome(request);
  }
  /// From Offline or Safe-Operational.
  void bring_to_operational(std::uint8_t configuration) {
    rig.bring_to(State::PreOperational, configuration);
    ASSERT_EQ(do_now(rig.set_state(State::SafeOperational)), "1 3 7");
    ASSERT_EQ(current_a, 0.0);
    ASSERT_EQ(do_now(rig.set_state(State::Operational)), "1 3 7");
  }

  std::unique_ptr<Subsystem> author = make_lamp();
  hirosco::testing::Rig rig;
  std::unique_ptr<DataFlow> device = rig.flows.open({Transfer::SharedMemory, "lamp"}, FlowSide::Device).value();
  double current_a{0};
  double most_a{0};  ///< since the test has set it to 0
};

}  // namespace

TEST(Lamp, FadesToWhatItIsToldAndNotBeyond) {
  Lamp lamp;
  lamp.bring_to_operational(nominal);
  EXPECT_EQ(lamp.do_now(lamp.rig.call("DIM", {0.8})), "1 3 7");
  lamp.cycle(400);
  EXPECT_NEAR(lamp.current_a, 0.4, 0.03);
  lamp.cycle(600);
  EXPECT_EQ(lamp.current_a, 0.8);
  EXPECT_EQ(lamp.do_now(lamp.rig.call_with("PROGRAM", {UINT64_MAX, 2, "a note", 0.25, 0.5, 1.0})), "1 3 7");
  EXPECT_THAT(lamp.rig.reports(5, 1), ::testing::Contains("12c1"
                                                          "ffffffffffffffff"
                                                          "02"
                                                          "06"
                                                          "3e8000003f0000003f800000"));
}

/// BRIGHTEST is a setting of its device: each configuration has its own.
TEST(Lamp, IsNoBrighterThanTheConfigurationInForceSays) {
  Lamp lamp;
  lamp.bring_to_operational(nominal);
  EXPECT_EQ(lamp.do_now(lamp.rig.call("DIM", {0.8})), "1 3 7");
  lamp.cycle(1000);
  EXPECT_EQ(lamp.current_a, 0.8);

  ASSERT_EQ(lamp.do_now(lamp.rig.set_state(State::SafeOperational)), "1 3 7");
  lamp.most_a = 0;
  lamp.bring_to_operational(night);
  lamp.cycle(1000);
  EXPECT_EQ(lamp.current_a, 0.1) << "as bright as it may be, as it was told to be brighter";
  EXPECT_EQ(lamp.most_a, 0.1) << "nor was it on its way";
  for (const char* function : {"DIM", "FADE"})
    EXPECT_TRUE(lamp.do_now(lamp.rig.call(function, {0.11})).starts_with("1 4:")) << function;
  EXPECT_EQ(lamp.do_now(lamp.rig.call("DIM", {0.05})), "1 3 7");
  lamp.cycle(1000);
  EXPECT_EQ(lamp.current_a, 0.05);

  ASSERT_EQ(lamp.do_now(lamp.rig.set_state(State::SafeOperational)), "1 3 7");
  lamp.bring_to_operational(nominal);
  EXPECT_EQ(lamp.do_now(lamp.rig.call("DIM", {0.11})), "1 3 7") << "by day it may";
}

TEST(Lamp, IsNotConfiguredByABrightestThatIsNone) {
  for (const char* wrong : {"", "bright", "0", "-0.5", "1.01", "nan", "0.5 "}) {
    auto described = hirosco::testing::read_descriptor(lamp_xml());
    described.configurations[0].devices[0].settings[0].value = wrong;
    Lamp lamp{std::move(described)};
    lamp.rig.bring_to(State::PreOperational, 0);
    EXPECT_TRUE(lamp.rig.configure_now(nominal).starts_with("1 3 8:")) << wrong;
    EXPECT_EQ(lamp.rig.configure_now(night), "1 3 7") << "the other one is as it was";
  }
}
