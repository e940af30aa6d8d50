// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The figures of the rokviss mission on the whole spacecraft: supervisor, subsystems, links, devices and world on virtual
// time, judged against missions/rokviss/expected.csv. Run it by hand for the table: bin/rokviss_figures
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/devices/joystick_device.hpp"
#include "simulation/devices/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using simulation::JoystickDevice;
using simulation::RobotDevice;
using simulation::Vec2;

constexpr double cycle_s = 0.0005;
constexpr double rail_n_per_m = 5e4;
constexpr std::uint16_t manipulator_apid = 10;

struct Expected {
  std::string quantity;
  double value;
  double tolerance;
  std::string unit;
};

std::map<std::string, Expected> read_expected() {
  std::map<std::string, Expected> table;
  std::ifstream file{HIROSCO_SOURCE_DIR "/missions/rokviss/expected.csv"};
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::stringstream rest{line};
    for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
    if (cells.size() != 5) ADD_FAILURE() << line;
    else table[cells[0]] = {cells[1], std::stod(cells[2]), std::stod(cells[3]), cells[4]};
  }
  return table;
}

/// Collects every figure of the run and prints them as one table at its end.
class Table final : public ::testing::Environment {
 public:
  void TearDown() override {
    std::cout << fmt::format("\n{:34} {:>11} {:>11} {:>12}  {}\n", "figure", "expected", "tolerance", "measured",
                             "verdict");
    for (const std::string& row : rows_) std::cout << row;
  }
  void add(const std::string& name, const Expected& expected, double measured, bool holds) {
    rows_.push_back(fmt::format("{:34} {:>11.6g} {:>11.4g} {:>12.7g}  {}\n",
                                fmt::format("{} [{}]", name, expected.unit), expected.value, expected.tolerance,
                                measured, holds ? "holds" : "FAILS"));
  }

 private:
  std::vector<std::string> rows_;
};
Table& table() {
  static auto* const shared = static_cast<Table*>(::testing::AddGlobalTestEnvironment(new Table));
  return *shared;
}
const Table& registered_before_main = table();

/// Every figure by name, as measured on one spacecraft or several.
using Figures = std::map<std::string, double>;

/// Names of the figures that do not hold.
std::vector<std::string> failing(const Figures& figures, bool tabulate) {
  static const auto expected = read_expected();
  std::vector<std::string> names;
  for (const auto& [name, measured] : figures) {
    const auto row = expected.find(name);
    if (row == expected.end()) {
      ADD_FAILURE() << name << " is not in expected.csv";
      continue;
    }
    const bool holds = std::abs(measured - row->second.value) <= row->second.tolerance;
    if (!holds) names.push_back(name);
    if (tabulate) table().add(name, row->second, measured, holds);
  }
  return names;
}

void judge(const Figures& figures) { EXPECT_EQ(failing(figures, true), std::vector<std::string>{}); }

/// Rokviss in telepresence with a resting hand; the test moves it.
class Rokviss {
 public:
  explicit Rokviss(Plan plan = {}) : flight_{with_resting_hand(std::move(plan))} {
    if (!flight_.commission()) throw std::runtime_error{flight_.story().text()};
    robot = &flight_.device<RobotDevice>("robot");
    joystick = &flight_.device<JoystickDevice>("joystick");
    flight_.story().on_telemetry = [this](const pus::TelemetryView& packet) { take(packet); };
    start_ = craft().now();
  }

  [[nodiscard]] Flight& flight() noexcept { return flight_; }
  [[nodiscard]] simulation::Spacecraft& craft() noexcept { return flight_.craft(); }
  void hand(const std::string& line) { ASSERT_TRUE(joystick->hand(line)) << line; }
  void run(double seconds) { craft().run(Duration{std::llround(seconds * 1e9)}); }
  [[nodiscard]] double time_s() { return seconds(craft().now() - start_); }
  /// Called once per control cycle, when both subsystems have done theirs.
  void each_cycle(std::function<void()> watch) {
    craft().on_cycle([watch = std::move(watch)](std::string_view subsystem, TimePoint) {
      if (subsystem == "JOYSTICK") watch();
    });
  }

  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};
  /// From housekeeping 4713, of one cycle.
  Vec2 position_rad{}, torque_n_m{}, desired_rad{};
  std::function<void()> on_housekeeping;

 private:
  static Plan with_resting_hand(Plan plan) {
    plan.edit = [more = plan.edit](descriptor::Mission& mission) {
      hand_rests(mission);
      // Ten times as often as in the mission, so that a peak between two reports is no more than 0.01 % higher.
      for (auto& member : mission.subsystems)
        for (auto& configuration : member.subsystem.configurations)
          for (auto& structure : configuration.housekeeping)
            if (structure.id == 4713) structure.interval_cycles = 10;
      if (more) more(mission);
    };
    return plan;
  }
  void take(const pus::TelemetryView& packet) {
    if (packet.apid() != manipulator_apid || packet.service() != 3 || packet.subtype() != 25) return;
    OctetReader reader{packet.source_data()};
    if (reader.get<std::uint16_t>() != 4713) return;
    for (Vec2* values : {&position_rad, &torque_n_m, &desired_rad})
      for (double& value : *values) value = reader.get<double>();
    if (on_housekeeping) on_housekeeping();
  }

  Flight flight_;
  TimePoint start_{};
};

// --- RO1 ---------------------------------------------------------------------------------------------------------------

double tracking_error(double frequency_hz, bool both_axes) {
  Rokviss rokviss;
  rokviss.hand(fmt::format("sine 1 0.15 {}", frequency_hz));
  if (both_axes) rokviss.hand(fmt::format("sine 2 0.15 {}", frequency_hz));
  rokviss.run(2 / frequency_hz);
  double worst = 0;
  int reports = 0;
  rokviss.on_housekeeping = [&] {
    ++reports;
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max(worst, std::abs(rokviss.position_rad[i] - rokviss.desired_rad[i]));
  };
  double nearest_m = -1;
  rokviss.each_cycle([&] { nearest_m = std::max(nearest_m, rokviss.robot->arm().contact().penetration_m); });
  rokviss.run(4 / frequency_hz);
  EXPECT_GT(reports, 100 / frequency_hz);
  EXPECT_LT(nearest_m, 0) << "the motion must be free";
  return worst;
}

TEST(RokvissFigures, RO1TheRobotFollowsTheHandInFreeMotion) {
  Figures figures;
  for (const auto& [frequency_hz, text] : {std::pair{0.25, "0.25Hz"}, {0.5, "0.5Hz"}, {1.0, "1Hz"}}) {
    const double alone = tracking_error(frequency_hz, false);
    const double both = tracking_error(frequency_hz, true);
    figures[fmt::format("RO1-axis-1-{}", text)] = alone;
    figures[fmt::format("RO1-both-{}", text)] = both;
    figures[fmt::format("RO1-limit-{}", text)] = std::max(alone, both);
  }
  judge(figures);
}

// --- RO2 and its control -----------------------------------------------------------------------------------------------

Figures pressed_against_the_rail(const Plan& plan) {
  Figures figures;
  for (const double dx_mm : {17.6, 22.6, 27.6}) {
    Rokviss rokviss{plan};
    EXPECT_TRUE(rokviss.robot->fault("friction off"));
    rokviss.hand(fmt::format("cartesian {} 0 1", dx_mm * 1e-3));
    rokviss.run(6);
    const auto& arm = rokviss.robot->arm();
    const auto name = [&](const char* what) { return fmt::format("RO2-{:.1f}mm-{}", dx_mm, what); };
    figures[name("force")] = arm.contact().normal_force_n;
    figures[name("penetration")] = arm.contact().penetration_m * 1e3;
    figures[name("tau2")] = rokviss.torque_n_m[1];
    figures[name("windup2")] = (arm.state().motor_rad[1] - arm.state().link_rad[1]) * 1e3;
  }
  return figures;
}

TEST(RokvissFigures, RO2PressesTheRailAsTheClosedFormSays) { judge(pressed_against_the_rail({})); }

Plan with_arm(const simulation::ArmParameters& arm) {
  Plan plan;
  plan.devices["hirosco-sim-robot"] = [arm](FlowFactory& flows, const FlowAddress& address,
                                            const simulation::SimulatedDevice::Settings& settings) {
    return std::make_unique<RobotDevice>(flows, address, settings, arm);
  };
  return plan;
}

TEST(RokvissFigures, RO2WouldSeeOnePercentOfArmStiffness) {
  simulation::ArmParameters arm;
  arm.joint.stiffness_n_m_per_rad *= 1.01;
  const auto names = failing(pressed_against_the_rail(with_arm(arm)), false);
  EXPECT_NE(std::ranges::find(names, "RO2-22.6mm-windup2"), names.end());
}

TEST(RokvissFigures, RO2WouldSeeOnePercentOfRailStiffness) {
  simulation::ArmParameters arm;
  arm.contour.stiffness_n_per_m *= 1.01;
  const auto names = failing(pressed_against_the_rail(with_arm(arm)), false);
  EXPECT_NE(std::ranges::find(names, "RO2-22.6mm-penetration"), names.end());
}

// --- RO3 ---------------------------------------------------------------------------------------------------------------

/// The shift at which the display fits the torque best.
std::size_t lag_of(const std::vector<double>& display, const std::vector<double>& torque) {
  const auto mismatch = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = 10; k < display.size(); ++k) sum += std::abs(display[k] + 0.02 * torque[k - lag]);
    return sum;
  };
  std::size_t best = 0;
  for (std::size_t candidate = 1; candidate < 10; ++candidate)
    if (mismatch(candidate) < mismatch(best)) best = candidate;
  return best;
}

TEST(RokvissFigures, RO3TheHandFeelsWhatTheRobotFeels) {
  Rokviss rokviss;
  ASSERT_TRUE(rokviss.robot->fault("friction off"));
  rokviss.hand("cartesian 0.0226 0 1");
  std::vector<double> display, torque;
  rokviss.each_cycle([&] {
    display.push_back(rokviss.joystick->motor_torque_n_m()[1]);
    torque.push_back(rokviss.robot->arm().joint_torque_n_m()[1]);
  });
  rokviss.run(1.5);
  const auto lag = static_cast<double>(lag_of(display, torque));
  rokviss.each_cycle([] {});
  rokviss.run(4.5);
  const auto contact = rokviss.robot->arm().contact();
  judge({{"RO3-lag", lag},
         {"RO3-display-ratio", rokviss.joystick->motor_torque_n_m()[1] / rokviss.torque_n_m[1]},
         {"RO3-force-ratio", contact.normal_force_n / (rail_n_per_m * contact.penetration_m)}});
}

// --- RO8 ---------------------------------------------------------------------------------------------------------------

/// What happened around the trip of the torque limit, at cycle rate.
struct Trip {
  double time_s{-1};
  double force_n{0};
  double peak_n_m{0};
  double off_s{-1};  ///< since when the robot's motors are off
  double display_zero_s{-1};  ///< since when the hand feels nothing
  double force_at_80ms_n{-1};
  double force_after_85ms_n{0};
};

void watch_trip(Rokviss& rokviss, Trip& trip) {
  rokviss.each_cycle([&] {
    const double now_s = rokviss.time_s();
    const double force_n = rokviss.robot->arm().contact().normal_force_n;
    trip.peak_n_m = std::max(trip.peak_n_m, std::abs(rokviss.robot->arm().joint_torque_n_m()[1]));
    if (trip.time_s < 0 && (rokviss.flight().inhibited("MANIPULATOR") & inhibited_by_author) != 0) {
      trip.time_s = now_s;
      trip.force_n = force_n;
    }
    if (trip.time_s < 0) return;
    if (rokviss.robot->active()) trip.off_s = -1;
    else if (trip.off_s < 0) trip.off_s = now_s;
    if (rokviss.joystick->motor_torque_n_m() != Vec2{}) trip.display_zero_s = -1;
    else if (trip.display_zero_s < 0) trip.display_zero_s = now_s;
    const double past_s = now_s - trip.time_s;
    if (past_s >= 0.080 && trip.force_at_80ms_n < 0) trip.force_at_80ms_n = force_n;
    if (past_s >= 0.085) trip.force_after_85ms_n = std::max(trip.force_after_85ms_n, force_n);
  });
}

TEST(RokvissFigures, RO8TheTorqueLimitTripsAndTheFingerLetsGo) {
  Rokviss rokviss;
  double event_s = -1;
  rokviss.flight().story().on_line = [&](std::string_view line) {
    if (line.starts_with("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED")) event_s = rokviss.time_s();
  };
  rokviss.hand("ramp 0.065 0 0.04");
  Trip trip;
  watch_trip(rokviss, trip);
  rokviss.run(2);
  ASSERT_GT(trip.time_s, 0) << "the limit never tripped";
  ASSERT_GT(event_s, 0) << "no event 1020";
  // A cycle judges what the device answered in the one before it: the sample is that much older.
  judge({{"RO8-trip-time", trip.time_s - cycle_s},
         {"RO8-trip-force", trip.force_n},
         {"RO8-peak-bound", trip.peak_n_m},
         {"RO8-event", std::round((event_s - trip.time_s) / cycle_s)},
         {"RO8-torque-off", std::round((trip.off_s - trip.time_s) / cycle_s)},
         {"RO8-force-80ms", trip.force_at_80ms_n / trip.force_n},
         {"RO8-force-85ms", trip.force_after_85ms_n},
         {"RO8-display-zero", std::round((trip.display_zero_s - trip.time_s) / cycle_s)}});
  EXPECT_LT(rokviss.robot->arm().contact().penetration_m, 0) << "the finger ends free of the rail";
  EXPECT_EQ(rokviss.flight().state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(rokviss.flight().state("JOYSTICK"), State::Operational) << "FC1 leaves the joystick running";
}

// --- RO9 ---------------------------------------------------------------------------------------------------------------

/// One unplugging: times since the plug was pulled.
struct Unplugging {
  double event_s{-1};
  double torque_off_s{-1};
  double display_zero_s{-1};
  double offline_s{-1};
  double motion_rad{0};
  double largest_kick{0};  ///< change of the display in one cycle, as a share of what was felt
  bool told{false};
};

bool log_names_all(Flight& flight, const std::string& subsystem, const std::string& device) {
  const Story& story = flight.story();
  if (!story
           .missing_in_order({subsystem + " high " + device + "_LOST",
                              "network {MANIPULATOR, JOYSTICK} to ErrorOperational and down"})
           .empty())
    return false;
  for (const char* member : {"MANIPULATOR", "JOYSTICK"}) {
    if (!story.has(std::string{member} + " is Offline")) return false;
    // Error-, Post-Operational, both deinits and Offline: each its own event with its own time.
    if (story.count(fmt::format("{} info STATE_CHANGED", member)) < 5 + 5) return false;
  }
  return true;
}

Unplugging unplug(const std::string& which, const std::string& hand, double after_s) {
  Rokviss rokviss;
  Unplugging seen;
  rokviss.hand(hand);
  rokviss.run(after_s);
  const double pulled_s = rokviss.time_s();
  const Vec2 q = rokviss.robot->arm().state().link_rad;
  Vec2 felt = rokviss.joystick->motor_torque_n_m();
  const double felt_at_first = std::max({std::abs(felt[0]), std::abs(felt[1]), 1e-6});
  rokviss.flight().story().on_line = [&](std::string_view line) {
    if (seen.event_s < 0 && line.find(" high ") != line.npos && line.find("_LOST") != line.npos)
      seen.event_s = rokviss.time_s() - pulled_s;
  };
  rokviss.craft().on_cycle([&](std::string_view, TimePoint) {
    const double past_s = rokviss.time_s() - pulled_s;
    if (seen.torque_off_s < 0 && !rokviss.robot->active()) seen.torque_off_s = past_s;
    const Vec2 now_felt = rokviss.joystick->motor_torque_n_m();
    if (seen.display_zero_s < 0 && now_felt == Vec2{}) seen.display_zero_s = past_s;
    for (std::size_t i = 0; i < 2; ++i) {
      seen.largest_kick = std::max(seen.largest_kick, std::abs(now_felt[i] - felt[i]) / felt_at_first);
      seen.motion_rad = std::max(seen.motion_rad, std::abs(rokviss.robot->arm().state().link_rad[i] - q[i]));
    }
    felt = now_felt;
  });
  EXPECT_TRUE(rokviss.craft().device(which)->fault("unplug"));
  const auto both_offline = [&] {
    return rokviss.flight().state("MANIPULATOR") == State::Offline &&
           rokviss.flight().state("JOYSTICK") == State::Offline;
  };
  if (rokviss.craft().run_until(both_offline, 5s)) seen.offline_s = rokviss.time_s() - pulled_s;
  rokviss.run(0.3);
  for (std::size_t i = 0; i < 2; ++i)
    seen.motion_rad = std::max(seen.motion_rad, std::abs(rokviss.robot->arm().state().link_rad[i] - q[i]));
  seen.told = log_names_all(rokviss.flight(), which == "robot" ? "MANIPULATOR" : "JOYSTICK",
                            which == "robot" ? "ROBOT" : "JOYSTICK");
  return seen;
}

struct Condition {
  const char* name;
  const char* hand;
  double after_s;
  double spread_s;  ///< between the instants of two runs
};

Figures unplug_twenty_times(const std::string& which, const Condition& condition) {
  constexpr int runs = 20;
  constexpr double never = std::numeric_limits<double>::infinity();
  Unplugging worst;
  int complete = 0;
  for (int run = 0; run < runs; ++run) {
    const Unplugging seen = unplug(which, condition.hand, condition.after_s + run * condition.spread_s);
    const double quiet_s = which == "robot" ? seen.display_zero_s : seen.torque_off_s;
    const auto late = [](double time_s) { return time_s < 0 ? never : time_s; };
    worst.event_s = std::max(worst.event_s, late(seen.event_s));
    worst.torque_off_s = std::max(worst.torque_off_s, late(quiet_s));
    worst.offline_s = std::max(worst.offline_s, late(seen.offline_s));
    worst.motion_rad = std::max(worst.motion_rad, seen.motion_rad);
    worst.largest_kick = std::max(worst.largest_kick, seen.largest_kick);
    if (late(seen.event_s) <= 0.002 && late(quiet_s) <= 0.005 && late(seen.offline_s) <= 2 && seen.told) ++complete;
  }
  const std::string prefix = fmt::format("RO9-{}-{}-", which, condition.name);
  std::cout << fmt::format(
      "  {}: motion after the last frame {:.3f} mrad, largest change of the display in one cycle {:.2f}\n", prefix,
      worst.motion_rad * 1e3, worst.largest_kick);
  return {{prefix + "event", worst.event_s * 1e3},
          {prefix + (which == "robot" ? "display" : "torque"), worst.torque_off_s * 1e3},
          {prefix + "offline", worst.offline_s},
          {prefix + "complete", complete}};
}

constexpr Condition in_free_motion{"free", "sine 1 0.15 0.5", 2.0, 0.1};
constexpr Condition in_contact{"contact", "cartesian 0.0226 0 1", 1.2, 0.037};

TEST(RokvissFigures, RO9UnpluggingTheJoystickInFreeMotionStopsTheNetwork) {
  judge(unplug_twenty_times("joystick", in_free_motion));
}
TEST(RokvissFigures, RO9UnpluggingTheJoystickInContactStopsTheNetwork) {
  judge(unplug_twenty_times("joystick", in_contact));
}
TEST(RokvissFigures, RO9UnpluggingTheRobotInFreeMotionStopsTheNetwork) {
  judge(unplug_twenty_times("robot", in_free_motion));
}
TEST(RokvissFigures, RO9UnpluggingTheRobotInContactStopsTheNetwork) { judge(unplug_twenty_times("robot", in_contact)); }

}  // namespace
}  // namespace hirosco::testing
