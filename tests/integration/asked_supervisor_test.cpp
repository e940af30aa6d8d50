// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "tests/integration/flight.hpp"

/// An adviser that asks the supervisor for modes, and hears it (docs/adr/0216). In mode "open" it may, in "rest", where a wheel stands, only
/// the ground may.
namespace hirosco::testing {
namespace {

constexpr auto advised_mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="ADVISED">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/advised.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  <Subsystem executable="wheel" descriptor="wheel.xml"/>
  <Subsystem executable="adviser" descriptor="adviser.xml"/>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="WHEEL" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="ADVISER" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
      <Permit subsystem="SUPERVISOR" functions="SET_MODE" from="ADVISER"/>
    </Mode>
    <Mode name="rest">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="WHEEL" configuration="NOMINAL" state="SafeOperational"/>
      <Commission subsystem="ADVISER" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
    </Mode>
  </Modes>
  <Recovery><Plan name="note"><When severity="low info"/><Do action="log"/></Plan></Recovery>
</Mission>
)";

constexpr auto wheel_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="WHEEL" id="22"><Configuration name="NOMINAL" id="1" sampling_us="10000"/></Subsystem>
)";

constexpr auto adviser_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="ADVISER" id="23">
  <Commands subsystem="SUPERVISOR" functions="SET_MODE SAFE_ALL"/>
  <Subscribes subsystem="SUPERVISOR" housekeeping="4701"/>
  <ParamRef name="MODE" id="1" type="UINT8" from="SUPERVISOR.MODE" age_ms="2500"/>
  <Configuration name="NOMINAL" id="1" sampling_us="10000"/>
</Subsystem>
)";

class IdleWheel final : public Subsystem {
  Result<Step> software_init() override { return done; }
};

/// What the adviser is told to ask, and what it has heard.
struct Advice {
  std::optional<std::uint8_t> mode{};
  bool stop{false};
  std::vector<RequestReport::Stage> stages{};
  std::string why{};
  int mode_in_cycle{-1};
  int mode_in_report{-1};
};

class Adviser final : public Subsystem {
 public:
  explicit Adviser(Advice& advice) : advice_{advice} {}

 private:
  Result<Step> software_init() override {
    publish("MODE", mode_);
    const auto hear = [this](const RequestReport& report) {
      advice_.stages.push_back(report.stage);
      if (report.is_end()) advice_.why = report.reason;
    };
    use_request(set_mode_, hear);
    use_request(safe_all_, hear);
    use_subscription(craft_,
                     [this](Octets values) { advice_.mode_in_report = OctetReader{values}.get<std::uint8_t>(); });
    return done;
  }
  void service(TimePoint) override {
    if (const auto mode = std::exchange(advice_.mode, std::nullopt)) static_cast<void>(request(set_mode_, *mode));
    if (std::exchange(advice_.stop, false)) static_cast<void>(request(safe_all_));
  }
  Result<> operational(const Cycle&) noexcept override {
    advice_.mode_in_cycle = mode_.load();
    return ok();
  }

  Advice& advice_;
  Parameter<std::uint8_t> mode_;
  Request<std::uint8_t> set_mode_{"SUPERVISOR", "SET_MODE"};
  Request<> safe_all_{"SUPERVISOR", "SAFE_ALL"};
  OpenSubscription craft_{"SUPERVISOR", SubscriptionPort::What::Structure, "4701"};
};

struct Advised : ::testing::Test {
  using Stage = RequestReport::Stage;
  static constexpr std::uint8_t open = 1, rest = 2;

  void commission() { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  /// The adviser asks, and how that ended.
  Stage ask_for(std::uint8_t mode) {
    advice.stages.clear();
    advice.mode = mode;
    flight.craft().run(3s);
    EXPECT_FALSE(advice.stages.empty()) << flight.story().text();
    return advice.stages.empty() ? Stage::TimedOut : advice.stages.back();
  }
  bool by_ground(const char* whom, const char* function, double argument) {
    const bool completed = flight.craft().command(whom, function, {argument}, 5s).completed;
    flight.craft().run(1s);
    return completed;
  }
  void expect_known(int mode) {
    EXPECT_EQ(advice.mode_in_cycle, mode) << "by its own parameter";
    EXPECT_EQ(advice.mode_in_report, mode) << "by the report";
  }

  Advice advice;
  Flight flight{
      {.mission = "hello",  // its folder: the texts stand in for the files there
       .subsystems = {{"wheel", [] { return std::make_unique<IdleWheel>(); }},
                      {"adviser", [this] { return std::make_unique<Adviser>(advice); }}},
       .files = {{"mission.xml", advised_mission_text}, {"wheel.xml", wheel_text}, {"adviser.xml", adviser_text}},
       .revives_after = std::chrono::milliseconds{300}}};
};

TEST_F(Advised, ASubsystemAsksForAModeIsToldThatItIsThereAndHearsItOfTheSupervisor) {
  commission();
  flight.craft().run(2s);
  expect_known(open);
  EXPECT_EQ(ask_for(rest), Stage::Completed) << advice.why << flight.story().text();
  EXPECT_TRUE(flight.story().has("mode rest"));
  expect_known(rest);
  EXPECT_EQ(std::ranges::count(advice.stages, Stage::Accepted), 1);
  EXPECT_EQ(std::ranges::count(advice.stages, Stage::Started), 1);
}

TEST_F(Advised, WhereNoRowNamesItItIsRefusedAndTheGroundIsNot) {
  commission();
  ASSERT_EQ(ask_for(rest), Stage::Completed);
  EXPECT_EQ(ask_for(open), Stage::Refused);
  EXPECT_EQ(advice.why, "not permitted in this mode");
  EXPECT_TRUE(by_ground("SUPERVISOR", "SET_MODE", open)) << flight.story().text();
}

TEST_F(Advised, NobodyIsLetMoveByIt) {
  commission();
  ASSERT_TRUE(by_ground("WHEEL", "SET_STATE", static_cast<double>(State::SafeOperational)));
  EXPECT_EQ(ask_for(open), Stage::Refused) << "the mode would let the wheel move again";
  EXPECT_TRUE(flight.story().has("it lets WHEEL move, which the ground may ask for and no subsystem"));
  EXPECT_TRUE(by_ground("SUPERVISOR", "SET_MODE", open)) << flight.story().text();
}

TEST_F(Advised, AStopIsItsToAskForInEveryModeAndNothingThatItAsksLiftsIt) {
  commission();
  ASSERT_EQ(ask_for(rest), Stage::Completed);
  ASSERT_TRUE(by_ground("SUPERVISOR", "SET_MODE", open));
  advice.stop = true;
  flight.craft().run(3s);
  EXPECT_TRUE(flight.story().has("every actuator inhibited")) << flight.story().text();
  const auto before = flight.story().lines().size();
  advice.stages.clear();
  advice.mode = open;
  flight.craft().run(3s);
  EXPECT_EQ(std::ranges::count(advice.stages, Stage::Completed), 0) << advice.why;
  EXPECT_TRUE(flight.story().find("mode open is impossible", before)) << flight.story().text();
  EXPECT_EQ(flight.state("WHEEL"), State::SafeOperational);
}

/// Whoever goes on knows who hears, and is asked like the one before.
TEST_F(Advised, AfterTheDeathOfASupervisorTheNextOneIsAskedAndHeard) {
  commission();
  flight.craft().run(2s);
  flight.craft().kill_supervisor();
  flight.craft().run(3s);
  advice.mode_in_report = -1;
  EXPECT_EQ(ask_for(rest), Stage::Completed) << advice.why << flight.story().text();
  expect_known(rest);
}

}  // namespace
}  // namespace hirosco::testing
