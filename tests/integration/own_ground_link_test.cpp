// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "hirosco/subsystem/author/ground_link.hpp"
#include "hirosco/subsystem/author/module.hpp"
#include "tests/integration/flight.hpp"

/// A mission whose ground link is somebody else's than the one that comes along (docs/adr/0154).
namespace hirosco::testing {
namespace {

constexpr auto radio_mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="RADIO_ONLY">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/radio.db"/>
    <Ground subsystem="RADIO" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="radio" descriptor="radio.xml"/>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="RADIO" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
    </Mode>
  </Modes>
  <Recovery><Plan name="note"><When severity="low info"/><Do action="log"/></Plan></Recovery>
</Mission>
)";

/// Packets both ways, and nothing else.
class Radio final : public Subsystem {
 public:
  explicit Radio(OpenGroundTransport open) : ground_{*this, std::move(open)} {}

 private:
  Result<> configure(const descriptor::Configuration&) override { return ground_.open(); }
  Result<Step> hardware_deinit() override {
    ground_.close();
    return done;
  }
  void service(TimePoint now) override { ground_.step(now); }
  void telemetry(Octets packet) override { ground_.telemetry(packet); }

  GroundLink ground_;
};

std::unique_ptr<Subsystem> make_radio_on(OpenGroundTransport open) { return std::make_unique<Radio>(std::move(open)); }
std::unique_ptr<Subsystem> make_radio() {
  return make_radio_on([](GroundTraffic&) -> Result<std::unique_ptr<GroundTransport>> {
    return fail(ErrorCode::Unavailable, "no antenna");
  });
}

Plan radio_only(const SubsystemModule& module) {
  return {
      .mission = "hello",  // its folder: the texts stand in for the files there
      .subsystems = {{"radio", module}},
      .files = {
          {"mission.xml", radio_mission_text},
          {"radio.xml",
           R"(<Subsystem name="RADIO" id="20"><Configuration name="NOMINAL" id="1" sampling_us="10000"/></Subsystem>)"}}};
}

TEST(OwnGroundLink, CarriesTelecommandsAndReportsOfTheSimulatedGround) {
  Flight flight{radio_only({make_radio, make_radio_on})};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  const auto outcome = flight.craft().command("RADIO", "SET_STATE", {static_cast<double>(State::SafeOperational)});
  EXPECT_TRUE(outcome.completed) << flight.story().text();
  EXPECT_EQ(flight.state("RADIO"), State::SafeOperational);
}

TEST(OwnGroundLink, ThatCannotBeMadeOnATransportIsNotStartedAndSaysWhatItLacks) {
  Flight flight{radio_only({make_radio, nullptr})};
  EXPECT_FALSE(flight.commission());
  EXPECT_TRUE(flight.story().has(
      "cannot start RADIO: it cannot hold a simulated ground link: its module has no maker on a transport"))
      << flight.story().text();
}

}  // namespace
}  // namespace hirosco::testing
