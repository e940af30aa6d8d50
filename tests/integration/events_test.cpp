// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "tests/integration/flight.hpp"
#include "tests/stand_in.hpp"

/// Recovery hears events, not telemetry (adr 0020): what ground switches off is recovered all the same; what safety rests on it
/// does not switch off (adr 0091).
namespace hirosco::testing {
namespace {

using descriptor::State;

/// TC[5,6] of one event, by its name.
std::vector<std::byte> silence(const descriptor::SubsystemDescriptor& subsystem, std::string_view event,
                               std::uint16_t count) {
  std::array<std::byte, 3> data{};
  OctetWriter{data}.put(std::uint8_t{1}).put(subsystem.find_event(event)->id);
  std::array<std::byte, 64> buffer;
  const auto packet = pus::write_telecommand(
      buffer,
      {.apid = subsystem.id, .sequence_count = count, .ack = pus::ack_all, .service = 5, .subtype = 6, .source = 0},
      data);
  return {packet->begin(), packet->end()};
}

TEST(Events, ThatGroundWantsToSwitchOffStillTakeBothMachinesDownAndAreTold) {
  for (const auto& [subsystem, device] : {std::pair{"JOYSTICK", "joystick"}, {"MANIPULATOR", "robot"}}) {
    Flight flight{{}};
    ASSERT_TRUE(flight.commission());
    const auto& described = flight.mission().find_subsystem(subsystem)->subsystem;
    const std::string event = std::string{device == std::string_view{"robot"} ? "ROBOT" : "JOYSTICK"} + "_LOST";
    std::uint16_t count = 900;
    for (const std::string& name : {event, std::string{"STATE_FAILED"}, std::string{"CYCLE_OVERRUNS"}})
      ASSERT_EQ(flight.send(silence(described, name, ++count)).subtype, 2) << "safety rests on it";
    int reports = 0;
    flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
      if (packet.apid() == described.id && packet.service() == 5 && packet.subtype() == 4) ++reports;
    };
    ASSERT_TRUE(flight.craft().device(device)->fault("unplug"));
    EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 3s)) << flight.story().text();
    EXPECT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 3s)) << flight.story().text();
    EXPECT_GE(reports, 1) << "nobody could make it silent";
    EXPECT_EQ(flight.story().missing_in_order(
                  {std::string{subsystem} + " high " + event + " REASON=hung up", "plan network-down", " is Offline"}),
              "")
        << flight.story().text();
  }
}

TEST(Events, SwitchedOffByGroundAreAnsweredAllTheSame) {
  Flight flight{{}};
  ASSERT_TRUE(flight.commission());
  const auto& described = flight.mission().find_subsystem("MANIPULATOR")->subsystem;
  ASSERT_EQ(flight.send(silence(described, "TEMPERATURE_CRITICAL", 900)).subtype, 7);
  int reports = 0;
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.apid() == described.id && packet.service() == 5 && packet.subtype() == 3) ++reports;
  };
  ASSERT_TRUE(flight.craft().device("robot")->fault("temperature 1 72"));
  EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::SafeOperational, 1s)) << flight.story().text();
  EXPECT_EQ(reports, 0) << "it was to be silent";
}

/// HELLO with a sensor that breaks.
class Failing final : public StandIn {
  Result<> operational(const Cycle& cycle) noexcept override {
    return cycle.count > 500 ? fail(ErrorCode::Unavailable, "sensor is broken", 42) : ok();
  }
};

TEST(Events, OfASubsystemThatDeclaresNoneStartItsRecovery) {
  Plan plan;
  plan.mission = "hello";
  plan.subsystems["hirosco-hello"] = [] { return std::make_unique<Failing>(); };
  Flight flight{std::move(plan)};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  ASSERT_TRUE(flight.run_until_state("HELLO", State::Offline, 3s)) << flight.story().text();
  EXPECT_EQ(flight.story().missing_in_order(
                {"HELLO high STATE_FAILED STATE=Operational ERROR=unavailable NUMBER=42 TEXT='sensor is broken'",
                 "plan default: network {HELLO}", "HELLO is Offline"}),
            "")
      << flight.story().text();
}

// --- plans for what the supervisor tells -------------------------------------------------------------------------------

/// Stores in memory until it is told to fail.
struct FailingStore final : supervisor::Database {
  explicit FailingStore(const std::atomic<bool>& fails) : fails_{fails} {}
  Result<> do_append(std::span<const supervisor::LogRecord>) override {
    return fails_ ? fail(ErrorCode::SystemFailure, "disk", 5) : ok();
  }
  Result<supervisor::LogPage> do_read(const supervisor::LogQuery&) override { return supervisor::LogPage{}; }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "memory"; }
  const std::atomic<bool>& fails_;
};

descriptor::Plan to_safe(std::string subsystem, std::string event) {
  descriptor::Plan plan;
  plan.name = "of ours";
  plan.subsystem = std::move(subsystem);
  plan.event = std::move(event);
  plan.steps = {{"set_state", {static_cast<std::int64_t>(State::SafeOperational)}}};
  return plan;
}

TEST(PlansForTheSupervisorsOwnEvents, TakeAllThatActsToSafeOperationalWhenTheLogFails) {
  for (const char* subsystem : {"", "SUPERVISOR"})
    for (const char* event : {"", "LOG_STORE"}) {
      const bool named = *subsystem != '\0' || *event != '\0';
      std::atomic<bool> fails{false};
      auto mission = Flight{{}}.mission();
      hand_rests(mission);
      auto added = to_safe(subsystem, event);
      added.severities = {descriptor::Severity::Medium};
      mission.plans.insert(mission.plans.begin(), std::move(added));
      const auto modules = simulation::load_modules(mission);
      supervisor::MemoryDatabase unused;
      Story story;
      simulation::Spacecraft craft{{.mission = mission,
                                    .subsystems = modules.subsystems,
                                    .devices = modules.devices,
                                    .log = unused,
                                    .observer = story,
                                    .make_log = [&](const Clock& clock) -> std::unique_ptr<supervisor::PacketLog> {
                                      return std::make_unique<supervisor::DirectPacketLog>(
                                          clock, std::make_unique<FailingStore>(fails));
                                    }}};
      ASSERT_TRUE(craft.run_until([&] { return story.has("commissioned: mode telepresence"); }, 5s)) << story.text();
      fails = true;
      craft.run(1s);
      EXPECT_TRUE(story.has("SUPERVISOR medium LOG_STORE"));
      const auto state_of = [&](const char* name) { return static_cast<State>(craft.vital(name)->state.load()); };
      for (const char* acting : {"MANIPULATOR", "JOYSTICK"})
        EXPECT_EQ(state_of(acting), named ? State::SafeOperational : State::Operational)
            << acting << ": a plan for everything of medium severity means the subsystems";
      EXPECT_EQ(state_of("COMMUNICATION"), State::Operational);
      EXPECT_EQ(story.has("plan of ours: all subsystems because of LOG_STORE"), named) << story.text();
    }
}

TEST(PlansForTheSupervisorsOwnEvents, AboutASubsystemBeginWhetherTheyNameThatOneOrTheSupervisor) {
  for (const char* subsystem : {"", "SUPERVISOR", "MANIPULATOR", "JOYSTICK"}) {
    const bool meant = std::string_view{subsystem} != "JOYSTICK";
    Flight dying{{.edit = [&](descriptor::Mission& mission) {
      auto plan = to_safe(subsystem, "PROCESS_DIED");
      plan.steps = {{"shut_down_network"}};
      mission.plans = {std::move(plan)};
    }}};
    ASSERT_TRUE(dying.commission());
    dying.craft().kill("MANIPULATOR");
    dying.craft().run(1s);
    EXPECT_EQ(dying.story().has("plan of ours: network"), meant) << subsystem;
    EXPECT_EQ(dying.story().has("plan default: network"), !meant) << subsystem;

    Flight powerless{{.edit = [&](descriptor::Mission& mission) {
      hand_rests(mission);
      auto plan = to_safe(subsystem, "POWER_REFUSED");
      plan.steps = {{"set_state", {static_cast<std::int64_t>(State::ErrorOperational)}}};
      mission.plans.push_back(std::move(plan));
    }}};
    ASSERT_TRUE(powerless.commission());
    ASSERT_TRUE(powerless.set_mode("commissioning").completed);
    for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
      ASSERT_TRUE(powerless.set_state("MANIPULATOR", state).completed);
    ASSERT_TRUE(powerless.configure("MANIPULATOR", "STANDALONE").completed);
    ASSERT_TRUE(powerless.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {104.9}).completed);
    EXPECT_FALSE(powerless.set_state("MANIPULATOR", State::SafeOperational).completed);
    powerless.craft().run(100ms);
    EXPECT_EQ(powerless.state("MANIPULATOR"), meant ? State::ErrorOperational : State::PreOperational) << subsystem;
  }
}

}  // namespace
}  // namespace hirosco::testing
