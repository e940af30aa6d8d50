// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "simulation/spacecraft/observed_flight.hpp"

/// The imager of this folder on virtual time, judged at its device and in the supervisor's story.
namespace hirosco {
namespace {

using simulation::SimulatedDevice;

struct Endnodes : ::testing::Test {
  explicit Endnodes(std::function<void(descriptor::Mission&)> edit = {}) : edit_{std::move(edit)} {}
  std::function<void(descriptor::Mission&)> edit_;
  simulation::Flight flight{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/endnodes/mission.xml",
                             .edit = edit_,
                             .subsystems = {},
                             .devices = {}}};

  SimulatedDevice& imager() { return *flight.craft().device("imager"); }
  double truth(std::string_view name) {
    const std::string words = imager().truth();
    const auto at = words.find(std::string{name} + "=");
    return at == words.npos ? -1000 : std::atof(words.c_str() + at + name.size() + 1);
  }
  void fault(std::string_view line) { ASSERT_TRUE(imager().fault(line)) << line; }
  void point(double angle_rad) {
    ASSERT_TRUE(flight.craft().command("IMAGER", "POINT", {angle_rad}).completed) << flight.story().text();
  }
  bool points_to(double angle_rad) { return std::abs(truth("angle") - angle_rad) < 0.001; }
  bool operational() { return flight.state("IMAGER") == State::Operational && flight.inhibited("IMAGER") == 0; }
};

TEST_F(Endnodes, AllOfADeviceAreUsedTogether) {
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  point(0.1);
  ASSERT_TRUE(flight.craft().command("IMAGER", "EXPOSE", {12}).completed);
  flight.craft().run(3s);
  EXPECT_TRUE(points_to(0.1)) << imager().truth();
  EXPECT_EQ(truth("exposure"), 12);
  EXPECT_TRUE(operational());
  EXPECT_FALSE(flight.story().has("FALL_BACK")) << flight.story().text();
  EXPECT_FALSE(flight.story().has("IMAGER high")) << flight.story().text();
}

TEST_F(Endnodes, InOfflineTheDeviceHasNoPower) {
  flight.craft().run(100us);
  EXPECT_EQ(truth("powered"), 0) << "nobody has asked for it";
  ASSERT_TRUE(flight.commission());
  EXPECT_EQ(truth("powered"), 1);
  for (const State down : {State::SafeOperational, State::PostOperational, State::Offline})
    ASSERT_TRUE(flight.set_state("IMAGER", down).completed) << to_text(down);
  ASSERT_EQ(flight.state("IMAGER"), State::Offline);
  EXPECT_EQ(truth("powered"), 0) << "at the instant in which it is Offline";
  flight.craft().run(10s);
  EXPECT_EQ(truth("powered"), 0);
  ASSERT_TRUE(flight.set_mode("operation").completed) << flight.story().text();
  EXPECT_TRUE(operational());
  EXPECT_EQ(truth("powered"), 1);
}

TEST_F(Endnodes, WhoseSubsystemIsKilledAtSpeedStopsAndThenHasNoPower) {
  ASSERT_TRUE(flight.commission());
  point(1);
  flight.craft().run(1s);
  ASSERT_EQ(truth("moves"), 1);
  flight.craft().kill("IMAGER");
  ASSERT_TRUE(flight.craft().run_until([&] { return truth("moves") == 0; }, 100ms));
  EXPECT_EQ(truth("powered"), 1) << "its stop is its own, and needs power";
  EXPECT_EQ(imager().output(), DeviceOutput::Holding);
  EXPECT_TRUE(flight.craft().run_until([&] { return truth("powered") == 0; }, 500ms)) << imager().truth();
}

TEST_F(Endnodes, GoesOverToAFallBackInFlightAndNeverMovesOnOldData) {
  ASSERT_TRUE(flight.commission());
  point(1);
  flight.craft().run(1s);
  ASSERT_EQ(truth("moves"), 1);
  fault("endnode POINTING 0 silent");
  bool held = false;
  const bool over = flight.craft().run_until(
      [&] {
        const bool inhibited = flight.inhibited("IMAGER") != 0;
        held = held || inhibited;
        return held && !inhibited;
      },
      1s);
  ASSERT_TRUE(over) << flight.story().text();
  EXPECT_TRUE(flight.story().has("IMAGER_POINTING_FALL_BACK")) << flight.story().text();
  flight.craft().run(8s);
  EXPECT_TRUE(points_to(1)) << imager().truth();
  EXPECT_TRUE(operational());
  EXPECT_EQ(flight.story().count("IMAGER_POINTING_FALL_BACK"), 1U);
}

TEST_F(Endnodes, WhileItGoesOverTheActuatorIsAtRest) {
  ASSERT_TRUE(flight.commission());
  point(1);
  flight.craft().run(1s);
  fault("endnode POINTING 0 silent");
  fault("endnode POINTING 1 silent");
  // Cut for a while only: the fall-back's first answer comes late, within its silence limit.
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.inhibited("IMAGER") != 0; }, 1s));
  flight.craft().run(1ms);
  EXPECT_EQ(truth("moves"), 0) << "it has been told to let go by the way that was left";
  const double angle = truth("angle");
  fault("endnode POINTING 1 heal");
  flight.craft().run(15ms);
  EXPECT_EQ(truth("angle"), angle) << "the watchdog of what was left has not run out";
  flight.craft().run(1s);
  EXPECT_GT(truth("angle"), angle);
}

/// Of its second inhibit and its power switch (docs/adr/0237).
[[nodiscard]] descriptor::Device& pointing_of(descriptor::Mission& mission) {
  for (auto& member : mission.subsystems)
    for (auto& device : member.subsystem.devices)
      if (device.name == "IMAGER.POINTING") return device;
  throw std::runtime_error{"the mission has no IMAGER.POINTING"};
}

struct EndnodesGoOn : Endnodes {
  EndnodesGoOn() : Endnodes{[](descriptor::Mission& mission) { pointing_of(mission).enable_terms.goes_on = true; }} {}
};

constexpr std::array faults_of_a_way{"unplug", "silent", "deaf", "corrupt 1000000"};

TEST_F(Endnodes, AWayToTheSecondInhibitThatIsLostInMotionStopsTheDeviceInTheWorldAndItsSubsystemIsFenced) {
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  for (const char* what : faults_of_a_way) {
    point(truth("angle") > 0 ? -1 : 1);
    ASSERT_TRUE(flight.craft().run_until([&] { return truth("moves") == 1; }, 1s)) << what;
    const std::size_t told = flight.story().count("SUPERVISOR medium INHIBIT_LOST");
    fault("enable 0 " + std::string{what});
    EXPECT_TRUE(flight.craft().run_until([&] { return truth("moves") == 0; }, 50ms)) << what;
    flight.craft().run(100ms);
    EXPECT_EQ(truth("moves"), 0) << what << ": the other way gives nothing back";
    EXPECT_EQ(flight.story().count("SUPERVISOR medium INHIBIT_LOST"), told + 1) << what << flight.story().text();
    EXPECT_TRUE(flight.run_until_state("IMAGER", State::SafeOperational, 2s)) << what << flight.story().text();
    ASSERT_TRUE(flight.set_state("IMAGER", State::Operational).completed) << what << flight.story().text();
    const double angle = truth("angle");
    point(angle > 0 ? -1 : 1);
    flight.craft().run(500ms);
    EXPECT_TRUE(operational()) << what << ": by the other way" << flight.story().text();
    EXPECT_NE(truth("angle"), angle) << what;
    fault("heal");
    fault("enable 0 plug");
    ASSERT_TRUE(flight.set_state("IMAGER", State::SafeOperational).completed);
    flight.craft().run(100ms);
    ASSERT_TRUE(flight.set_state("IMAGER", State::Operational).completed) << flight.story().text();
  }
  EXPECT_EQ(flight.story().count("SUPERVISOR low INHIBIT_FALL_BACK"), faults_of_a_way.size()) << flight.story().text();
}

TEST_F(EndnodesGoOn, ByTheNextWayToTheSecondInhibitWithoutAPause) {
  for (const char* what : faults_of_a_way) {
    simulation::Flight each{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/endnodes/mission.xml",
                             .edit = edit_,
                             .subsystems = {},
                             .devices = {}}};
    ASSERT_TRUE(each.commission());
    ASSERT_TRUE(each.craft().command("IMAGER", "POINT", {1}).completed);
    each.craft().run(1s);
    SimulatedDevice& device = *each.craft().device("imager");
    ASSERT_TRUE(device.active());
    ASSERT_TRUE(device.fault("enable 0 " + std::string{what}));
    bool always = true;
    for (int i = 0; i < 500; ++i) {
      each.craft().run(1ms);
      always = always && device.active();
    }
    EXPECT_TRUE(always) << what << each.story().text();
    EXPECT_EQ(each.story().count("INHIBIT_FALL_BACK"), 1U) << what << each.story().text();
    EXPECT_FALSE(each.story().has("INHIBIT_LOST")) << what;
    ASSERT_TRUE(device.fault("enable 1 " + std::string{what}));
    EXPECT_TRUE(each.craft().run_until([&] { return !device.active(); }, 50ms)) << what << ": there is no third one";
    each.craft().run(1s);
    EXPECT_FALSE(device.active()) << what;
    EXPECT_TRUE(each.story().has("INHIBIT_LOST")) << what << each.story().text();
  }
}

TEST_F(EndnodesGoOn, ByTheWayInUseBetweenTwoSupervisorsAndUnderTheNextOne) {
  simulation::Flight each{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/endnodes/mission.xml",
                           .edit = edit_,
                           .subsystems = {},
                           .devices = {},
                           .revives_after = 300ms}};
  ASSERT_TRUE(each.commission());
  ASSERT_TRUE(each.craft().command("IMAGER", "POINT", {1}).completed);
  SimulatedDevice& device = *each.craft().device("imager");
  ASSERT_TRUE(device.fault("enable 0 silent"));
  each.craft().run(200ms);
  ASSERT_TRUE(device.active());
  each.craft().kill_supervisor();
  bool always = true;
  for (int i = 0; i < 1000; ++i) {
    each.craft().run(1ms);
    always = always && device.active();
  }
  EXPECT_TRUE(always) << each.story().text();
  EXPECT_EQ(each.state("IMAGER"), State::Operational);
  EXPECT_FALSE(each.story().has("INHIBIT_LOST")) << each.story().text();
  ASSERT_TRUE(device.fault("enable 1 silent"));
  EXPECT_TRUE(each.craft().run_until([&] { return !device.active(); }, 50ms)) << each.story().text();
}

TEST_F(EndnodesGoOn, AStopOfEverythingReachesTheDeviceByEitherWay) {
  ASSERT_TRUE(flight.commission());
  for (const int way : {0, 1}) {
    point(way == 0 ? 1 : -1);
    ASSERT_TRUE(flight.craft().run_until([&] { return imager().active(); }, 1s)) << way << flight.story().text();
    fault("enable " + std::to_string(way) + " silent");
    flight.craft().run(200ms);
    ASSERT_TRUE(imager().active()) << way << ": a way that it is enabled by, or one that waits";
    ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed) << way << flight.story().text();
    EXPECT_FALSE(imager().active()) << way;
    fault("heal");
    flight.craft().run(1s);
    ASSERT_TRUE(flight.set_state("IMAGER", State::Operational).completed) << flight.story().text();
  }
}

TEST_F(Endnodes, OfflineSwitchesOffByWhicheverWayIsLeft) {
  ASSERT_TRUE(flight.commission());
  for (const char* what : faults_of_a_way)
    for (const int way : {0, 1}) {
      SCOPED_TRACE(std::string{what} + " " + std::to_string(way));
      ASSERT_EQ(truth("powered"), 1);
      fault("power " + std::to_string(way) + " " + what);
      flight.craft().run(3s);
      EXPECT_EQ(truth("powered"), 1) << "longer than a switch waits that hears nothing";
      EXPECT_TRUE(operational()) << flight.story().text();
      for (const State down : {State::SafeOperational, State::PostOperational, State::Offline})
        ASSERT_TRUE(flight.set_state("IMAGER", down).completed) << to_text(down) << flight.story().text();
      EXPECT_EQ(truth("powered"), 0);
      fault("heal");
      fault("power " + std::to_string(way) + " plug");
      ASSERT_TRUE(flight.set_mode("operation").completed) << flight.story().text();
    }
}

TEST_F(Endnodes, APowerSwitchThatIsHeardByNoWayIsToldAndTheDeviceIsStoppedWhileItHasPower) {
  ASSERT_TRUE(flight.commission());
  point(1);
  flight.craft().run(1s);
  fault("power 0 unplug");
  flight.craft().run(500ms);
  EXPECT_TRUE(flight.story().has("SUPERVISOR low POWER_FALL_BACK")) << flight.story().text();
  EXPECT_FALSE(flight.story().has("POWER_SILENT"));
  fault("power 1 unplug");
  ASSERT_TRUE(flight.craft().run_until([&] { return truth("moves") == 0; }, 1s)) << flight.story().text();
  EXPECT_EQ(truth("powered"), 1) << "it stops before its power is gone";
  EXPECT_TRUE(flight.story().has("SUPERVISOR medium POWER_SILENT")) << flight.story().text();
}

/// What a fault of one way does: with a fall-back the flight goes on, without one the device is lost.
struct OneFault {
  const char* endnode;
  const char* fault;
  int ways;
};

struct EachEndnode : Endnodes, ::testing::WithParamInterface<OneFault> {};

TEST_P(EachEndnode, FailsAloneAndTheFlightGoesOnByItsFallBacksOrEndsSafelyAndFliesAgain) {
  const auto& [endnode, what, ways] = GetParam();
  ASSERT_TRUE(flight.commission());
  point(1);
  flight.craft().run(500ms);
  for (int way = 0; way < ways; ++way) {
    SCOPED_TRACE(way);
    EXPECT_TRUE(operational()) << flight.story().text();
    fault("endnode " + std::string{endnode} + " " + std::to_string(way) + " " + what);
    flight.craft().run(400ms);
    const bool last = way + 1 == ways;
    EXPECT_EQ(flight.story().count(std::string{"IMAGER_"} + endnode + "_FALL_BACK"),
              static_cast<std::size_t>(last ? way : way + 1))
        << flight.story().text();
    EXPECT_EQ(flight.story().has(std::string{"IMAGER_"} + endnode + "_LOST"), last) << flight.story().text();
  }
  EXPECT_EQ(truth("moves"), 0);
  ASSERT_TRUE(flight.run_until_state("IMAGER", State::Offline, 10s)) << flight.story().text();
  EXPECT_EQ(truth("powered"), 0);
  fault("heal");
  for (int way = 0; way < ways; ++way) fault("endnode " + std::string{endnode} + " " + std::to_string(way) + " plug");
  ASSERT_TRUE(flight.set_mode("operation").completed) << flight.story().text();
  point(-0.2);
  flight.craft().run(8s);
  EXPECT_TRUE(points_to(-0.2)) << imager().truth();
  EXPECT_TRUE(operational());
}

/// Two of them, of one descriptor: where each is the mission says.
struct TwoThatPoint : ::testing::Test {
  simulation::Flight flight{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/endnodes/two_pointing.xml",
                             .subsystems = {},
                             .devices = {}}};

  double truth(std::string_view device, std::string_view name) {
    const std::string words = flight.craft().device(device)->truth();
    const auto at = words.find(std::string{name} + "=");
    return at == words.npos ? -1000 : std::atof(words.c_str() + at + name.size() + 1);
  }
};

TEST_F(TwoThatPoint, FlyBesideEachOtherEachByFallBacksAndASwitchOfItsOwn) {
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  ASSERT_TRUE(flight.craft().device("second")->fault("endnode POINTING 0 silent"));
  flight.craft().run(1s);
  EXPECT_EQ(flight.story().count("IMAGER_POINTING_FALL_BACK"), 1U) << flight.story().text();
  for (const char* name : {"IMAGER", "SECOND"}) {
    EXPECT_EQ(flight.state(name), State::Operational) << name << flight.story().text();
    EXPECT_EQ(flight.inhibited(name), 0) << name;
  }
  ASSERT_TRUE(flight.craft().command("SECOND", "POINT", {0.1}).completed) << flight.story().text();
  flight.craft().run(3s);
  EXPECT_NEAR(truth("second", "angle"), 0.1, 0.001) << "by its own fall-back";
  EXPECT_NEAR(truth("imager", "angle"), 0, 0.001);
  for (const State down : {State::SafeOperational, State::PostOperational, State::Offline})
    ASSERT_TRUE(flight.set_state("SECOND", down).completed) << to_text(down);
  EXPECT_EQ(truth("second", "powered"), 0);
  EXPECT_EQ(truth("imager", "powered"), 1);
}

std::vector<OneFault> all_faults() {
  std::vector<OneFault> all;
  for (const auto& [endnode, ways] : {std::pair{"POINTING", 2}, {"COMMAND", 1}, {"STATUS", 1}, {"IMAGE", 3}})
    for (const char* what : {"silent", "deaf", "unplug", "corrupt 1000000"}) all.push_back({endnode, what, ways});
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllEndnodes, EachEndnode, ::testing::ValuesIn(all_faults()), [](const auto& row) {
  std::string name = std::string{row.param.endnode} + "_" + row.param.fault;
  return name.substr(0, name.find(' '));
});

}  // namespace
}  // namespace hirosco
