// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hirosco/data_transfer/device/device_frame.hpp>
#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>

#include "lamp.hpp"

using namespace hirosco;

/// The test plays the supervisor, the clock and the lamp.
TEST(Lamp, FadesToWhatItIsToldAndNotBeyond) {
  const auto lamp = make_lamp();
  hirosco::testing::Rig rig{*lamp, descriptor::file_system()("lamp.xml").value()};
  const auto device = std::move(rig.flows.open({Transfer::SharedMemory, "lamp"}, FlowSide::Device)).value();
  double current_a = 0;
  const auto cycle = [&](int count) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      std::array<std::byte, max_device_frame_octets> frame{}, answer{};
      const auto found = device->receive(frame);
      if (!found || found->flow != Flow::New) continue;
      const auto command = read_command(Octets{frame}.first(found->octets)).value();
      current_a =
          command.mode == DeviceMode::Active ? OctetReader{command.payload, std::endian::little}.get<double>() : 0.0;
      const std::array<std::byte, 8> dark{};
      static_cast<void>(
          device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = dark}).value()));
    }
    rig.service();
  };
  const auto do_now = [&](const hirosco::testing::Sent& request) {
    cycle(5);
    return rig.outcome(request);
  };
  rig.bring_to(State::PreOperational);
  cycle(5);
  EXPECT_EQ(do_now(rig.set_state(State::SafeOperational)), "1 3 7");
  EXPECT_EQ(current_a, 0.0);
  EXPECT_EQ(do_now(rig.set_state(State::Operational)), "1 3 7");
  EXPECT_EQ(do_now(rig.call("DIM", {0.8})), "1 3 7");
  cycle(400);
  EXPECT_NEAR(current_a, 0.4, 0.02);
  cycle(600);
  EXPECT_EQ(current_a, 0.8);
  EXPECT_EQ(do_now(rig.call_with("PROGRAM", {UINT64_MAX, 2, "a note", 0.25, 0.5, 1.0})), "1 3 7");
  EXPECT_THAT(rig.reports(5, 1), ::testing::Contains("12c1"
                                                     "ffffffffffffffff"
                                                     "02"
                                                     "06"
                                                     "3e8000003f0000003f800000"));
}
