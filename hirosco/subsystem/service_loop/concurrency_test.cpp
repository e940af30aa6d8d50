// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <thread>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/told.hpp"
#include "hirosco/utilities/os/clock.hpp"

/// Service loop and cycle of one subsystem in threads of their own, at full speed and without any sleep: whatever they
/// share must be handed over properly (architecture, rule 1). Run under the thread sanitizer by ./check.
namespace hirosco {
namespace {

using testing::Probe;

/// The supervisor's side of one threaded subsystem; it lives in the service thread.
class Threaded {
 public:
  Threaded()
      : subsystem_{probe_,
                   testing::read_descriptor(testing::probe_descriptor),
                   {.clock = clock_, .memory = memory_, .flows = flows_, .realtime = true, .explain = {}},
                   channels_.subsystem_end(),
                   vital_,
                   permit_},
        cycle_{[this] { run_cycle(); }} {
    permit_.release();
  }
  ~Threaded() {
    ending_ = true;
    cycle_.join();
  }

  void send(std::string_view function, double argument) {
    const auto common = pus::common_functions();
    const descriptor::Function* found = subsystem_.descriptor().find_function(function);
    for (const auto& candidate : common)
      if (candidate.name == function) found = &candidate;
    const auto data = pus::encode_call(*found, std::span{&argument, 1}).value();
    send(8, 1, data);
  }
  void send(std::uint8_t service, std::uint8_t subtype, Octets data) {
    std::array<std::byte, 256> buffer{};
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = 10,
                                                .sequence_count = ++count_,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    ASSERT_TRUE(channels_.supervisor_end().send({.packet = packet.value()}));
  }
  /// Steps the service loop until the state is reached.
  void until(State state) {
    while (subsystem_.state() != state) step();
  }
  void step() {
    permit_.heartbeat.fetch_add(1);
    static_cast<void>(subsystem_.service_step(clock_.now()));
    told.hear(channels_.supervisor_end());
  }
  [[nodiscard]] std::uint64_t cycles() const { return vital_.cycles.load(); }

  testing::Told told;

 private:
  void run_cycle() {
    while (!ending_) {
      const auto demand = subsystem_.cycle_demand();
      if (demand.wanted) {
        static_cast<void>(subsystem_.cycle_step(clock_.now()));
      } else {
        subsystem_.cycle_parked(demand.ticket);
        std::this_thread::yield();
      }
    }
  }

  SystemClock clock_;
  HeapMemory memory_;
  LocalFlows flows_;
  ChannelPair channels_{4096};
  VitalPage vital_{};
  PermitPage permit_{};
  Probe probe_;
  GenericSubsystem subsystem_;
  std::atomic<bool> ending_{false};
  std::uint16_t count_{0};
  std::thread cycle_;
};

TEST(TwoLoops, SurviveTwoHundredRoundsOfStartConfigureAndStop) {
  Threaded threaded;
  constexpr int rounds = 200;
  constexpr int commands_per_round = 7;
  std::array<std::byte, 13> write{};
  OctetWriter{write}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 2}.wire()).put(7.0);
  for (int round = 0; round < rounds; ++round) {
    threaded.send("SET_STATE", 3);
    threaded.until(State::PreOperational);
    threaded.send("CONFIGURE", 1);
    threaded.step();
    threaded.send("SET_STATE", 4);
    threaded.until(State::SafeOperational);
    threaded.send("SET_STATE", 5);
    threaded.until(State::Operational);
    const std::uint64_t before = threaded.cycles();
    threaded.send("SET_GOAL", 0.5);
    threaded.send(20, 3, write);
    while (threaded.cycles() < before + 5) threaded.step();
    threaded.send("SET_STATE", 6);
    threaded.until(State::ErrorOperational);
    threaded.send("SET_STATE", 0);
    threaded.until(State::Offline);
  }
  threaded.step();
  EXPECT_EQ(threaded.told.failures, 0);
  EXPECT_EQ(threaded.told.completions, rounds * (commands_per_round + 1));
}

TEST(TwoLoops, AConfigurationMayBeCalledOffBeforeTheCycleSawIt) {
  Threaded threaded;
  for (int round = 0; round < 200; ++round) {
    threaded.send("SET_STATE", 3);
    threaded.until(State::PreOperational);
    threaded.send("CONFIGURE", 1 + round % 3);
    threaded.send("SET_STATE", 7);
    threaded.until(State::PostOperational);
    threaded.send("SET_STATE", 0);
    threaded.until(State::Offline);
  }
  EXPECT_EQ(threaded.told.failures, 0);
}

TEST(TwoLoops, TelemetryFlowsWhileTheCycleRunsAtFullSpeed) {
  Threaded threaded;
  threaded.send("SET_STATE", 3);
  threaded.until(State::PreOperational);
  threaded.send("CONFIGURE", 1);
  while (threaded.told.housekeeping < 20) threaded.step();
  EXPECT_EQ(threaded.told.failures, 0);
}

}  // namespace
}  // namespace hirosco
