// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/cycle_meter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// What a cycle does that real time forbids, and what it spins, as they are told. Its times are in overrun_test.cpp.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct MeteredCycle : ::testing::Test {
  descriptor::SubsystemDescriptor descriptor = [] {
    auto made = testing::read_descriptor(
        R"(<Subsystem name="ARM" id="10"><Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)");
    descriptor::add_framework_events(made);
    return made;
  }();
  ManualClock clock;
  LoopRings rings;
  ReportWriter reports{descriptor.events, rings};
  std::unique_ptr<VitalPage> vital = std::make_unique<VitalPage>();
  ResourceMeter resources{descriptor.resources};
  LoopMeter loops{{}};
  CycleMeter meter{{clock, rings, *vital, true, resources, loops, reports}};

  void begin(Duration spin = {}) { meter.begin(descriptor.configurations[0], spin); }
  void account_spun(Duration spun) {
    meter.account_spin(spun);
    clock.use_processor(spun);
    meter.account({.execution = 0us, .latency = 0us, .late = 0us, .count = 1, .inhibited = 0}, {});
  }
  /// Arguments of each event with this number, since it was asked last.
  std::vector<std::string> told(std::uint16_t event) {
    std::vector<std::string> all;
    for (; const auto record = rings.answers.front(); rings.answers.pop()) {
      CycleReport head;
      std::memcpy(&head, record->data(), sizeof head);
      if (head.kind == ReportKind::Event && head.index == event)
        all.push_back(testing::hex(Octets{*record}.subspan(sizeof head)));
    }
    return all;
  }
};

TEST_F(MeteredCycle, ThatDoesWhatRealTimeForbidsIsToldWithAllThatItDidAndOneThatKeepsToItIsNot) {
  begin();
  for (int cycle = 0; cycle < 10; ++cycle) meter.hold_to_realtime({});
  EXPECT_THAT(told(descriptor::framework_event::cycle_not_realtime), IsEmpty());
  meter.hold_to_realtime({.heap = 2, .locks = 1, .outputs = 3});
  EXPECT_THAT(told(descriptor::framework_event::cycle_not_realtime), ElementsAre("000000020000000100000003"));
  for (int cycle = 0; cycle < 10; ++cycle) meter.hold_to_realtime({});
  EXPECT_THAT(told(descriptor::framework_event::cycle_not_realtime), IsEmpty()) << "once";
}

TEST_F(MeteredCycle, TellsWhatChangesSlowlyInEverySixteenthCycleAndNotInBetween) {
  const std::vector<descriptor::ServiceLoop> declared{{.name = "SLOW", .period = 20ms}};
  LoopMeter some{declared};
  CycleMeter with_loops{{clock, rings, *vital, true, resources, some, reports}};
  with_loops.begin(descriptor.configurations[0], {});
  for (std::uint64_t count = 1; count <= 40; ++count) {
    some.account(0, 1us, 1);
    with_loops.note_service_heap(count);
    with_loops.account({.execution = 0us, .latency = 0us, .late = 0us, .count = count, .inhibited = 0}, {});
    const std::uint64_t told_at = (count - 1) / 16 * 16 + 1;
    EXPECT_EQ(with_loops.heap_uses().load().service, told_at) << count;
    const std::uint64_t loops_told_at = count < 2 ? 0 : (count - 2) / 16 * 16 + 2;
    EXPECT_EQ(with_loops.loop_statistics().load().missed[0], loops_told_at) << count;
  }
}

TEST_F(MeteredCycle, ThatMaySpinTellsTheLongestAndHowOftenItSpunForLonger) {
  begin(80us);
  for (const Duration spun : {80us, 81us, 20us, 100us}) account_spun(spun);
  const CycleSpin spin = meter.spin().load();
  EXPECT_EQ(spin.spin_us, 80.0F);
  EXPECT_EQ(spin.longest_us, 100.0F);
  EXPECT_EQ(spin.exceeded, 2U);
  EXPECT_EQ(meter.budget().load().longest_us, 0.0F) << "none of it is its work";
}

}  // namespace
}  // namespace hirosco
