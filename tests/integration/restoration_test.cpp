// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "simulation/world/random.hpp"
#include "tests/integration/flight.hpp"

/// Who crashed comes back to its commanded state by itself (docs/adr/0076): rokviss, with plans that say so.
namespace hirosco::testing {
namespace {

constexpr std::uint16_t manipulator = 10;
constexpr std::uint16_t joystick = 11;
constexpr std::uint16_t of_the_test = 9000;

[[nodiscard]] std::function<void(descriptor::Mission&)> comes_back(State to, std::int64_t limit = 1000) {
  return [=](descriptor::Mission& mission) {
    simulation::hand_rests(mission);
    for (auto& plan : mission.plans)
      for (auto& step : plan.steps)
        if (step.kind == "restart") step.values = {limit, 60, 20, static_cast<std::int64_t>(to)};
  };
}

struct RestorationTest : ::testing::Test {
  explicit RestorationTest(State to = State::Operational, std::int64_t limit = 1000)
      : flight{{.edit = comes_back(to, limit)}} {}
  Flight flight;
  std::uint16_t count{0};
  std::map<std::uint16_t, std::vector<std::byte>> heard;  ///< newest source data by service and subtype

  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      if (report.apid() != manipulator) return;
      heard[static_cast<std::uint16_t>(report.service() << 8 | report.subtype())] = {report.source_data().begin(),
                                                                                     report.source_data().end()};
    };
  }

  template <class... Values>
  static std::vector<std::byte> octets(Values... values) {
    std::vector<std::byte> data(64);
    OctetWriter writer{data};
    (writer.put(values), ...);
    data.resize(writer.size());
    return data;
  }
  static std::uint32_t pos_scale() { return ParameterId{manipulator, Type::Double, 8}.wire(); }
  void send(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = manipulator,
                                                .sequence_count = ++count,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    const auto verdict = flight.send(*packet);
    ASSERT_EQ(verdict.subtype, 7) << int{service} << "," << int{subtype} << " code " << verdict.code;
  }
  void set_everything() {
    constexpr std::uint8_t one = 1;
    ASSERT_TRUE(flight.set_state("MANIPULATOR", State::SafeOperational).completed);
    send(20, 3, octets(one, pos_scale(), 0.9));
    ASSERT_TRUE(flight.set_state("MANIPULATOR", State::Operational).completed);
    send(3, 31, octets(one, std::uint16_t{4711}, std::uint32_t{1000}));
    send(3, 6, octets(one, std::uint16_t{4712}));
    send(3, 1, octets(of_the_test, std::uint32_t{400}, one, pos_scale(), std::uint8_t{0}));
    send(3, 5, octets(one, of_the_test));
    send(5, 6, octets(one, descriptor::framework_event::state_changed));
  }
  void everything_is_set() {
    constexpr std::uint8_t one = 1;
    send(20, 1, octets(one, pos_scale()));
    EXPECT_EQ((heard[20 << 8 | 2]), octets(one, pos_scale(), 0.9));
    send(3, 33, octets(std::uint8_t{3}, std::uint16_t{4711}, std::uint16_t{4712}, of_the_test));
    EXPECT_EQ((heard[3 << 8 | 35]),
              octets(std::uint8_t{3}, std::uint16_t{4711}, one, std::uint32_t{1000}, std::uint16_t{4712},
                     std::uint8_t{0}, std::uint32_t{2000}, of_the_test, one, std::uint32_t{400}));
    send(5, 7, {});
    EXPECT_EQ((heard[5 << 8 | 8]), octets(one, descriptor::framework_event::state_changed));
  }
  /// What is not as the mode wants it; empty: all is.
  [[nodiscard]] std::string missing() {
    for (const auto& step : flight.craft().supervisor().mode().commission) {
      const auto& subsystem = flight.mission().find_subsystem(step.subsystem)->subsystem;
      if (flight.state(step.subsystem) != step.state)
        return step.subsystem + " is " + std::string{to_text(flight.state(step.subsystem))};
      const auto in_force = flight.craft().vital(step.subsystem)->configuration.load(std::memory_order_relaxed);
      if (in_force != subsystem.find_configuration(step.configuration)->id) return step.subsystem + "'s configuration";
      if (flight.inhibited(step.subsystem) != 0) return step.subsystem + " is inhibited";
    }
    for (const std::uint8_t link : flight.craft().supervisor().mode().establish)
      if (!flight.craft().supervisor().links().is_up(link)) return "link " + std::to_string(link);
    return {};
  }
  [[nodiscard]] bool may_move(const char* name) {
    const auto* page = flight.craft().permit(name);
    return page != nullptr && page->permits(page->epoch.load());
  }
};

TEST_F(RestorationTest, TheDeadComesBackWithAllThatItWasToldAndItsNetworkWithIt) {
  set_everything();
  everything_is_set();
  for (int time = 1; time <= 3; ++time) {
    flight.craft().kill("MANIPULATOR");
    flight.craft().run(3s);
    ASSERT_EQ(missing(), "") << time << "\n" << flight.story().text();
    everything_is_set();
  }
  EXPECT_TRUE(flight.story().has("MANIPULATOR, JOYSTICK: as commanded")) << flight.story().text();
}

TEST_F(RestorationTest, ThePartnerOfTheDeadKeepsItsSettingsToo) {
  set_everything();
  flight.craft().kill("JOYSTICK");
  flight.craft().run(3s);
  ASSERT_EQ(missing(), "") << flight.story().text();
  everything_is_set();
}

TEST_F(RestorationTest, WhoIsKilledAgainOnItsWayComesBackAllTheSame) {
  simulation::Random random{76};
  set_everything();
  const int rounds = whole() ? 12 : 4;  // four: each after each
  for (int round = 0; round < rounds; ++round) {
    flight.craft().kill(round % 2 == 0 ? "MANIPULATOR" : "JOYSTICK");
    flight.craft().run(Duration{static_cast<std::int64_t>(random.uniform(0, 400e6))});
    flight.craft().kill(round % 3 == 0 ? "MANIPULATOR" : "JOYSTICK");
    flight.craft().run(15s);
    ASSERT_EQ(missing(), "") << round << "\n" << flight.story().text();
    everything_is_set();
  }
}

TEST_F(RestorationTest, WhoHangsIsEndedAndComesBack) {
  set_everything();
  flight.craft().spin("MANIPULATOR");
  flight.craft().run(8s);
  EXPECT_EQ(missing(), "") << flight.story().text();
  everything_is_set();
}

TEST_F(RestorationTest, InEachStateItComesBackToThatState) {
  for (const State state : {State::SafeOperational, State::PreOperational}) {
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::SafeOperational).completed || state != State::SafeOperational);
    ASSERT_TRUE(flight.set_state("JOYSTICK", state).completed || flight.state("JOYSTICK") == state);
    flight.craft().kill("JOYSTICK");
    flight.craft().run(3s);
    EXPECT_EQ(flight.state("JOYSTICK"), state) << flight.story().text();
    EXPECT_FALSE(may_move("JOYSTICK"));
  }
  ASSERT_TRUE(flight.set_state("JOYSTICK", State::Offline).completed);
  flight.craft().kill("JOYSTICK");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
}

TEST_F(RestorationTest, AfterAStopNobodyComesBackToMove) {
  ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
  flight.craft().run(100ms);
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational) << flight.story().text();
  EXPECT_EQ(flight.state("JOYSTICK"), State::SafeOperational);
  for (const char* name : {"MANIPULATOR", "JOYSTICK"}) EXPECT_FALSE(may_move(name)) << name;
}

TEST(Restorations, AStopAtWhateverMomentEndsThem) {
  const Duration apart = whole() ? 15ms : 60ms;
  for (Duration after = 0ms; after < 360ms; after += apart) {
    Flight flight{{.edit = comes_back(State::Operational)}};
    ASSERT_TRUE(flight.commission());
    flight.craft().kill("MANIPULATOR");
    flight.craft().run(after);
    static_cast<void>(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}));
    flight.craft().run(4s);
    for (const char* name : {"MANIPULATOR", "JOYSTICK"}) {
      const auto* page = flight.craft().permit(name);
      EXPECT_NE(flight.state(name), State::Operational) << after / 1ms << " ms\n" << flight.story().text();
      EXPECT_FALSE(page != nullptr && page->permits(page->epoch.load())) << name << " " << after / 1ms << " ms";
    }
  }
}

TEST_F(RestorationTest, WhatProtectsIsNotLoosenedByIt) {
  const auto set = flight.craft().command("MANIPULATOR", "SET_TORQUE_LIMIT", {5.0});
  ASSERT_TRUE(set.completed);
  flight.craft().kill("JOYSTICK");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational) << flight.story().text();
  EXPECT_FALSE(may_move("MANIPULATOR"));
  EXPECT_TRUE(flight.story().has("MANIPULATOR comes back to Safe-Operational only"));
}

/// None of its arguments is of what it sets: three limits in one parameter (docs/adr/0170).
TEST_F(RestorationTest, LimitsThatAFunctionSetsByItsCodeAloneAreNotLoosenedByItEither) {
  ASSERT_TRUE(flight.craft().command("MANIPULATOR", "SET_TEMP_LIMITS", {40.0, 50.0, 60.0}).completed);
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational) << flight.story().text();
  EXPECT_FALSE(may_move("MANIPULATOR"));
  EXPECT_TRUE(flight.story().has(
      "MANIPULATOR comes back to Safe-Operational only, without what functions had set: TEMP_LIMITS"));
}

TEST_F(RestorationTest, TheOperatorsWordCountsMore) {
  flight.craft().kill("MANIPULATOR");
  ASSERT_TRUE(flight.run_until_state("JOYSTICK", State::PreOperational, 3s)) << flight.story().text();
  static_cast<void>(flight.set_state("JOYSTICK", State::Offline));
  flight.craft().run(3s);
  EXPECT_NE(flight.state("MANIPULATOR"), State::Operational);
  EXPECT_TRUE(flight.story().has("not brought back: JOYSTICK was commanded otherwise")) << flight.story().text();
  EXPECT_TRUE(flight.story().has("SUPERVISOR medium NOT_RESTORED APID=10"));
}

TEST_F(RestorationTest, ALostDeviceIsNoDeathAndStaysDown) {
  ASSERT_TRUE(flight.craft().device("joystick")->fault("unplug"));
  flight.craft().run(2s);
  ASSERT_EQ(flight.state("MANIPULATOR"), State::Offline);
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Offline) << flight.story().text();
}

struct AsFarAsSafe : RestorationTest {
  AsFarAsSafe() : RestorationTest{State::SafeOperational} {}
};
TEST_F(AsFarAsSafe, TheLastStepIsTheOperators) {
  set_everything();
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  for (const char* name : {"MANIPULATOR", "JOYSTICK"}) {
    EXPECT_EQ(flight.state(name), State::SafeOperational) << flight.story().text();
    EXPECT_FALSE(may_move(name));
  }
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 2U);
  everything_is_set();
  EXPECT_TRUE(flight.set_state("JOYSTICK", State::Operational).completed);
  EXPECT_TRUE(flight.set_state("MANIPULATOR", State::Operational).completed);
}

struct NoFurtherThanOffline : RestorationTest {
  NoFurtherThanOffline() : RestorationTest{State::Offline} {}
};
TEST_F(NoFurtherThanOffline, ItStaysAsItAlwaysWas) {
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Offline);
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
}

struct TwiceAtMost : RestorationTest {
  TwiceAtMost() : RestorationTest{State::Operational, 2} {}
};
TEST_F(TwiceAtMost, WhoDiesTooOftenStaysDownAndNobodyWaitsForIt) {
  for (int time = 1; time <= 2; ++time) {
    flight.craft().kill("MANIPULATOR");
    flight.craft().run(3s);
    ASSERT_EQ(missing(), "") << time << flight.story().text();
  }
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(3s);
  EXPECT_TRUE(flight.story().has("MANIPULATOR stays down"));
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
}

}  // namespace
}  // namespace hirosco::testing
