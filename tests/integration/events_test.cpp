// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "hirosco/descriptor/framework_events.hpp"
#include "tests/integration/flight.hpp"
#include "tests/stand_in.hpp"

/// Recovery hears events, not telemetry (adr 0020): what ground switches off is recovered all the same.
namespace hirosco::testing {
namespace {

using descriptor::State;

/// TC[5,6] of one event, by its name.
std::vector<std::byte> silence(const descriptor::Subsystem& subsystem, std::string_view event, std::uint16_t count) {
  std::array<std::byte, 3> data{};
  OctetWriter{data}.put(std::uint8_t{1}).put(subsystem.find_event(event)->id);
  std::array<std::byte, 64> buffer;
  const auto packet = pus::write_telecommand(
      buffer,
      {.apid = subsystem.id, .sequence_count = count, .ack = pus::ack_all, .service = 5, .subtype = 6, .source = 0},
      data);
  return {packet->begin(), packet->end()};
}

TEST(Events, SwitchedOffByGroundStillTakeBothMachinesDown) {
  for (const auto& [subsystem, device] : {std::pair{"JOYSTICK", "joystick"}, {"MANIPULATOR", "robot"}}) {
    Flight flight{{}};
    ASSERT_TRUE(flight.commission());
    const auto& described = flight.mission().find_subsystem(subsystem)->subsystem;
    const std::string event = std::string{device == std::string_view{"robot"} ? "ROBOT" : "JOYSTICK"} + "_LOST";
    std::uint16_t count = 900;
    for (const std::string& name : {event, std::string{"STATE_FAILED"}, std::string{"CYCLE_OVERRUNS"}})
      ASSERT_EQ(flight.send(silence(described, name, ++count)).subtype, 7);
    int reports = 0;
    flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
      if (packet.apid() == described.id && packet.service() == 5 && packet.subtype() == 4) ++reports;
    };
    ASSERT_TRUE(flight.craft().device(device)->fault("unplug"));
    EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 3s)) << flight.story().text();
    EXPECT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 3s)) << flight.story().text();
    EXPECT_EQ(reports, 0) << "it was to be silent";
    EXPECT_EQ(flight.story().missing_in_order(
                  {std::string{subsystem} + " high " + event + " REASON=hung up", "plan network-down", " is Offline"}),
              "")
        << flight.story().text();
  }
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

}  // namespace
}  // namespace hirosco::testing
