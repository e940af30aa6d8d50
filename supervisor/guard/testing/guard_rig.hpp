// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <new>
#include <vector>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/guard/guard.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// A guard with three members whose processes, cycles and devices the test plays.
namespace hirosco::supervisor::testing {

struct FakeProcess final : ProcessGrip {
  void take_realtime() noexcept override { realtime = loops_realtime = false; }
  void take_loops_realtime() noexcept override { loops_realtime = false; }
  void give_realtime() noexcept override { realtime = loops_realtime = true; }
  LoopTime loop_time() noexcept override { return loops; }
  Duration processor_time() noexcept override { return had; }
  void kill() noexcept override { killed = true; }
  bool realtime{true};
  bool loops_realtime{true};
  LoopTime loops;
  bool killed{false};
  Duration had{};
};

struct Life {
  Mapping vital_memory, permit_memory;
  VitalPage* vital{nullptr};
  PermitPage* permit{nullptr};
  std::shared_ptr<FakeProcess> process = std::make_shared<FakeProcess>();
};

/// ARM with a device that can be asked, HAND without; CAMERA is the ground link and spared.
struct GuardTest : ::testing::Test {
  ManualClock clock;
  LocalFlows flows;
  HeapMemory memory;
  descriptor::Mission mission = [] {
    auto made = small_mission();
    descriptor::Device device;
    device.name = "MOTOR";
    device.actuator = true;
    device.stop = descriptor::StopKind::Controlled;
    device.stop_within = 200ms;
    device.enable = descriptor::Endnode{};
    device.enable->address = "motor-enable";
    made.subsystems[0].subsystem.devices = {device};
    for (auto& configuration : made.subsystems[0].subsystem.configurations) configuration.devices.emplace_back();
    return made;
  }();
  Guard guard{{.clock = clock, .flows = flows, .first_epoch = 1000, .on_finding = {}}};
  std::map<std::uint16_t, Life> lives;
  std::unique_ptr<DataFlow> motor;
  EnableCommand told{};
  bool looks{true};  ///< cycles look at their permit pages

  void SetUp() override {
    clock.set(TimePoint{10s});
    for (const auto& described : mission.subsystems)
      ASSERT_TRUE(guard.add(described, described.subsystem.id == camera));
    for (const std::uint16_t apid : {arm, hand, camera}) start(apid);
    motor = flows.open({Transfer::SharedMemory, "motor-enable"}, FlowSide::Device).value();
    guard.beat();
  }
  void start(std::uint16_t apid) {
    Life& life = lives[apid] = Life{};
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    LaunchedSubsystem launched;
    launched.vital = life.vital_memory = page(sizeof(VitalPage));
    launched.permit = life.permit_memory = page(sizeof(PermitPage));
    launched.grip = life.process;
    life.vital = new (launched.vital.octets.data()) VitalPage{};
    life.permit = new (launched.permit.octets.data()) PermitPage{};
    life.vital->realtime = 1;
    guard.started(apid, launched);
  }
  void cycling(std::uint16_t apid, State state = State::Operational) {
    lives[apid].vital->state = static_cast<std::uint32_t>(state);
    lives[apid].vital->cycling = 1;
  }
  /// The guard's steps; who is named in `moves` makes cycles, all make service steps, the motor answers with `output`.
  void run(Duration span, std::initializer_list<std::uint16_t> moves = {arm, hand, camera},
           std::optional<DeviceOutput> output = DeviceOutput::Off) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; clock.advance(Guard::period)) {
      guard.beat();
      for (const std::uint16_t apid : moves) {
        ++lives[apid].vital->cycles;
        if (looks) lives[apid].vital->seen_epoch = lives[apid].permit->epoch.load();
      }
      for (auto& [apid, life] : lives) ++life.vital->service_steps;
      static_cast<void>(guard.step(clock.now()));
      std::array<std::byte, enable_frame_octets> frame;
      const auto received = motor->receive(frame);
      if (!received || received->flow != Flow::New) continue;
      told = read_enable_command(frame).value();
      if (!output) continue;
      std::array<std::byte, enable_frame_octets> answer;
      static_cast<void>(motor->send(
          *write_enable_status(answer, {.output = *output, .flags = 0, .epoch = 0, .sequence = told.sequence})));
    }
  }
  std::vector<GuardFinding::Kind> kinds(std::uint16_t apid) {
    std::vector<GuardFinding::Kind> found;
    for (const auto& finding : guard.take_findings())
      if (finding.apid == apid) found.push_back(finding.kind);
    return found;
  }
  [[nodiscard]] bool may_move(std::uint16_t apid) {
    const PermitPage& page = *lives[apid].permit;
    return page.permits(page.epoch.load());
  }
};

/// What may become of a word of shared memory: one flipped bit, and whole words that damage leaves behind.
inline std::vector<std::uint32_t> damages(std::uint32_t word) {
  std::vector<std::uint32_t> damaged{0, ~0U, ~word, 0x5555'5555, 0xAAAA'AAAA, word + 1, word - 1};
  for (unsigned bit = 0; bit < 32; ++bit) damaged.push_back(word ^ 1U << bit);
  std::erase(damaged, word);
  return damaged;
}

}  // namespace hirosco::supervisor::testing
