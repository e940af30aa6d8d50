// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/rokviss_corners.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/coupled_craft.hpp"

namespace hirosco::simulation {
namespace {

using Values = std::map<std::string, double>;

/// A corner before it is flown.
struct CornerCase {
  std::string mode;
  std::string what;
  Values initial;
  double bump_m{0.010};
  std::function<void(class CornerFlight&)> fly;
};

double larger(const Vec2& values) noexcept { return std::max(std::abs(values[0]), std::abs(values[1])); }

/// Watches the world at every step of anything, also when the subsystems are down.
class CornerFlight {
 public:
  explicit CornerFlight(const CraftOptions& options) : craft_{options} {}

  void run(double seconds) {
    const auto watch = [this] {
      look();
      return false;
    };
    static_cast<void>(craft_.craft().run_until(watch, Duration{std::llround(seconds * 1e9)}));
  }
  /// Sends and does not wait: what becomes of it shows in the world.
  void send(std::string_view subsystem, std::string_view function, const std::vector<Value>& arguments = {}) {
    static_cast<void>(craft_.craft().command(subsystem, function, arguments, 1ms));
    look();
  }
  void robot(std::string_view function, const std::vector<Value>& arguments = {}) {
    send("MANIPULATOR", function, arguments);
  }
  void hand(const std::string& line) { craft_.hand(line); }
  [[nodiscard]] const Loads& loads() const noexcept { return loads_; }

  [[nodiscard]] std::string end() {
    std::string text{to_text(craft_.flight().state("MANIPULATOR"))};
    for (const char* told : {"TORQUE_LIMIT_EXCEEDED", "TORQUE_HARD_EXCEEDED", "MOTION_DONE"})
      if (craft_.flight().story().has(told)) text += fmt::format(" {}", told);
    return text;
  }

 private:
  void look() {
    const TwoJointArm& arm = craft_.arm();
    loads_.torque_n_m = std::max(loads_.torque_n_m, larger(arm.joint_torque_n_m()));
    loads_.speed_rad_s = std::max(loads_.speed_rad_s, larger(arm.state().link_rad_s));
    loads_.motor_n_m = std::max(loads_.motor_n_m, larger(craft_.robot().motor_torque_n_m()));
    const Vec2 outside = arm.contact().force_n + arm.spring_force_n();
    loads_.force_n = std::max(loads_.force_n, std::hypot(outside[0], outside[1]));
  }

  CoupledCraft craft_;
  Loads loads_{};
};

/// Smallest and largest value of a parameter, as declared.
std::array<double, 2> range_of(const descriptor::Mission& mission, std::string_view subsystem, std::string_view name) {
  const auto* member = mission.find_subsystem(subsystem);
  for (const auto& parameter : member->subsystem.parameters) {
    if (parameter.field.name == name)
      return {parameter.field.minimum.value_or(0).real(), parameter.field.maximum.value_or(0).real()};
    for (const auto& part : parameter.members)
      if (fmt::format("{}.{}", parameter.field.name, part.field.name) == name)
        return {part.field.minimum.value_or(0).real(), part.field.maximum.value_or(0).real()};
  }
  return {};
}

class Cases {
 public:
  explicit Cases(const descriptor::Mission& mission) : mission_{mission} {
    standalone();
    held_and_hooked();
    for (const char* mode : {"telepresence", "feel", "remote"}) coupled(mode);
    programmes();
  }
  [[nodiscard]] std::vector<CornerCase> take() { return std::move(cases_); }

 private:
  [[nodiscard]] std::array<double, 2> robot_range(std::string_view name) const {
    return range_of(mission_, "MANIPULATOR", name);
  }
  /// Both gains at both ends, and as they are.
  [[nodiscard]] std::vector<Values> gains() const {
    std::vector<Values> all{{}};
    for (const double kp : robot_range("KP"))
      for (const double kd : robot_range("KD")) all.push_back({{"MANIPULATOR.KP", kp}, {"MANIPULATOR.KD", kd}});
    return all;
  }
  [[nodiscard]] static std::string words(const Values& values) {
    std::string text;
    for (const auto& [name, value] : values) text += fmt::format(" {} {:g}", name.substr(name.find('.') + 1), value);
    return text;
  }
  void add(std::string mode, std::string what, Values initial, std::function<void(CornerFlight&)> fly,
           double bump_m = 0.010) {
    what += words(initial);
    cases_.push_back({std::move(mode), std::move(what), std::move(initial), bump_m, std::move(fly)});
  }

  /// From home to every corner of the joints, as fast as it is taken: the first durations are refused.
  void standalone() {
    constexpr std::array lowest{-2.0, 0.2}, highest{1.0, 2.6};
    for (const Values& with : gains())
      for (const double q1 : {lowest[0], highest[0], 0.1, -0.5})
        for (const double q2 : {lowest[1], highest[1], 0.9}) {
          const auto move = [q1, q2](CornerFlight& flight) {
            for (const double duration_s : {0.1, 0.3, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 2.3, 2.6, 3.0, 3.3, 3.6})
              flight.robot("MOVE_TO", {q1, q2, duration_s});
            flight.run(3);
          };
          add("standalone", fmt::format("MOVE_TO {:g} {:g}", q1, q2), with, move);
        }
    for (const double limit : robot_range("TORQUE_LIMIT"))
      add("standalone", "MOVE_TO into the rail", {{"MANIPULATOR.TORQUE_LIMIT", limit}}, [](CornerFlight& flight) {
        flight.robot("MOVE_TO", {-0.5, 1.2, 1.0});
        flight.run(3);
      });
  }

  /// What is changed or taken away while the arm moves, presses or pulls.
  void held_and_hooked() {
    const auto kp = robot_range("KP");
    const auto kd = robot_range("KD");
    for (const Values& with : gains()) {
      add("standalone", "HOLD at full speed", with, [](CornerFlight& flight) {
        flight.robot("MOVE_TO", {-1.6, 2.4, 1.6});
        flight.run(0.8);
        flight.robot("HOLD");
        flight.run(1);
      });
      add("standalone", "pressing, then all gains in turn", with, [kp, kd](CornerFlight& flight) {
        flight.robot("MOVE_TO", {-0.8, 1.46, 1.5});
        flight.run(2.5);
        for (const double p : {kp[1], kp[0], kp[1]})
          for (const double d : {kd[0], kd[1]}) {
            flight.robot("SET_GAINS", {p, d});
            flight.run(0.8);
          }
      });
      add("standalone", "spring hooked, pulled to the end", with, [](CornerFlight& flight) {
        flight.robot("HOOK_SPRING", {2});
        flight.run(0.1);
        flight.robot("MOVE_TO", {-1.6, 1.0, 1.6});
        flight.run(3);
      });
      add("standalone", "spring hooked, released under load", with, [](CornerFlight& flight) {
        flight.robot("HOOK_SPRING", {2});
        flight.run(0.1);
        flight.robot("MOVE_TO", {-0.88, 1.5, 1.6});
        flight.run(2.5);
        flight.robot("RELEASE_SPRING");
        flight.run(1);
      });
    }
  }

  void coupled(const char* mode) {
    const auto scale = range_of(mission_, "JOYSTICK", "FORCE_SCALE");
    const bool remote = std::string_view{mode} == "remote";
    for (const double position : robot_range("POS_SCALE"))
      for (const double force : scale)
        for (const double passivity : {0.0, 1.0}) {
          const Values with{
              {"MANIPULATOR.POS_SCALE", position}, {"JOYSTICK.FORCE_SCALE", force}, {"JOYSTICK.PASSIVITY", passivity}};
          const auto far = [remote](CornerFlight& flight) {
            if (remote) flight.send("COMMUNICATION", "SET_DELAY", {60, 0});
          };
          add(mode, "commanded hand to every corner", with, [far](CornerFlight& flight) {
            far(flight);
            flight.send("JOYSTICK", "SET_HAND", {1});
            for (const double a : {0.4, -0.4})
              for (const double b : {-0.4, 0.4, -0.4}) {
                flight.send("JOYSTICK", "HAND", {a, b});
                flight.run(0.7);
              }
          });
          for (const char* line : {"hold 0.1 -0.35", "hold -0.4 -0.4", "hold 0.4 -0.4", "cartesian 0.0226 0 0.5",
                                   "ramp 0.065 0 0.5", "ramp 0.030 0.08 1"})
            add(mode, fmt::format("hand {}", line), with, [far, line](CornerFlight& flight) {
              far(flight);
              flight.hand(line);
              flight.run(2);
            });
          add(mode, "hand shakes 0.3 rad at 3 Hz", with, [far](CornerFlight& flight) {
            far(flight);
            flight.hand("sine 1 0.3 3");
            flight.hand("sine 2 0.3 3 1.5");
            flight.run(2);
          });
          if (remote) continue;
          add(mode, "spring hooked, hand pulls", with, [](CornerFlight& flight) {
            flight.robot("HOOK_SPRING", {2});
            flight.run(0.1);
            flight.hand("ramp -0.10 -0.10 0.5");
            flight.run(2);
          });
        }
  }

  void programmes() {
    for (const Values& with : gains())
      for (const double speed : robot_range("SCRIPT.SPEED"))
        for (const double press : robot_range("SCRIPT.OVER_PRESS"))
          for (const double believed : robot_range("SCRIPT.BUMP_HEIGHT"))
            for (const double bump_m : {0.0, 0.010}) {
              Values values = with;
              values["MANIPULATOR.SCRIPT.SPEED"] = speed;
              values["MANIPULATOR.SCRIPT.OVER_PRESS"] = press;
              values["MANIPULATOR.SCRIPT.BUMP_HEIGHT"] = believed;
              // The slow ones are flown until they have pressed in and climbed the bump, not to their end.
              add(
                  "automatic", fmt::format("contour, real bump {:g} mm,", 1e3 * bump_m), values,
                  [](CornerFlight& flight) {
                    flight.robot("RUN_SCRIPT", {1});
                    flight.run(12);
                  },
                  bump_m);
            }
    for (const Values& with : gains())
      add("automatic", "spring programme", with, [](CornerFlight& flight) {
        flight.robot("RUN_SCRIPT", {2});
        flight.run(12);
      });
  }

  const descriptor::Mission& mission_;
  std::vector<CornerCase> cases_;
};

constexpr std::string_view torque_limit_event = "TORQUE_LIMIT_EXCEEDED", hard_limit_event = "TORQUE_HARD_EXCEEDED";
/// Far above what the law can ask for.
constexpr double no_limit_n_m = 1000;

double largest_of(const descriptor::Field& field) noexcept {
  return std::max(std::abs(field.minimum.value_or(0).real()), std::abs(field.maximum.value_or(0).real()));
}

}  // namespace

bool Loads::within(const Loads& promise) const noexcept {
  return torque_n_m <= promise.torque_n_m && force_n <= promise.force_n && speed_rad_s <= promise.speed_rad_s &&
         motor_n_m <= promise.motor_n_m;
}

Loads promised_loads(const descriptor::Mission& mission) {
  const auto range = [&](std::string_view name) {
    const auto ends = range_of(mission, "MANIPULATOR", name);
    return std::max(std::abs(ends[0]), std::abs(ends[1]));
  };
  Loads promise{.torque_n_m = range("CUR_VALUES.TORQUE"),
                .force_n = range("TIP_FORCE"),
                .speed_rad_s = range("CUR_VALUES.VELOCITY")};
  for (const auto& device : mission.find_subsystem("MANIPULATOR")->subsystem.devices)
    for (const auto& output : device.output)
      if (output.field.name == "TORQUE") promise.motor_n_m = largest_of(output.field);
  return promise;
}

CornerTable fly_corners(const CornerSettings& settings) {
  const Flight first{{.mission = settings.mission}};
  CornerTable table{.promise = promised_loads(first.mission())};
  const std::vector<CornerCase> cases = Cases{first.mission()}.take();
  for (std::size_t i = 0; i < cases.size(); i += std::max<std::size_t>(settings.one_in, 1)) {
    const CornerCase& one = cases[i];
    CraftOptions options{.mission = settings.mission, .seed = settings.seed};
    options.initial = one.initial;
    options.start_mode = one.mode;
    options.bump_m = one.bump_m;
    options.cycles_per_report = 0;
    if (settings.planted_limit_n_m > 0)
      for (const char* limit : {"MANIPULATOR.TORQUE_LIMIT", "MANIPULATOR.TORQUE_HARD"})
        options.initial[limit] = settings.planted_limit_n_m;
    CornerFlight flight{options};
    one.fly(flight);
    Corner& corner = table.corners.emplace_back(one.mode, one.what, flight.loads(), flight.end());
    if (corner.end.find(torque_limit_event) == std::string::npos) continue;
    options.initial["MANIPULATOR.TORQUE_LIMIT"] = no_limit_n_m;
    CornerFlight unstopped{options};
    one.fly(unstopped);
    corner.unstopped = {unstopped.loads().torque_n_m, unstopped.end()};
  }
  return table;
}

std::size_t CornerTable::beyond() const noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(corners, [&](const Corner& corner) { return !corner.loads.within(promise); }));
}

std::size_t CornerTable::tripped() const noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(corners, [](const Corner& corner) { return corner.unstopped.has_value(); }));
}

std::size_t CornerTable::tripping_harder() const {
  return static_cast<std::size_t>(std::ranges::count_if(corners, [](const Corner& corner) {
    return corner.unstopped && corner.unstopped->end.find(hard_limit_event) != std::string::npos;
  }));
}

std::string CornerTable::text() const {
  constexpr const char* line = "{:13} {:78} {:>8} {:>8} {:>7} {:>7}  {} {}\n";
  constexpr const char* numbers = "{:13} {:78} {:8.3f} {:8.2f} {:7.3f} {:7.2f}  {} {}\n";
  std::string text = fmt::format(fmt::runtime(line), "mode", "corner", "N m", "N", "rad/s", "motor", "verdict", "end");
  Loads worst;
  for (const Corner& corner : corners) {
    const Loads& loads = corner.loads;
    text += fmt::format(fmt::runtime(numbers), corner.mode, corner.what, loads.torque_n_m, loads.force_n,
                        loads.speed_rad_s, loads.motor_n_m, loads.within(promise) ? "holds " : "BEYOND", corner.end);
    if (corner.unstopped) {
      text.pop_back();
      text += fmt::format("; without the limit {:.1f} N m, {}\n", corner.unstopped->torque_n_m, corner.unstopped->end);
    }
    worst = {std::max(worst.torque_n_m, loads.torque_n_m), std::max(worst.force_n, loads.force_n),
             std::max(worst.speed_rad_s, loads.speed_rad_s), std::max(worst.motor_n_m, loads.motor_n_m)};
  }
  const auto row = [&](const char* name, const Loads& loads) {
    text += fmt::format(fmt::runtime(numbers), name, "", loads.torque_n_m, loads.force_n, loads.speed_rad_s,
                        loads.motor_n_m, "", "");
  };
  row("largest", worst);
  row("promise", promise);
  text += fmt::format("{} of {} corners are within what the descriptor promises\n", corners.size() - beyond(),
                      corners.size());
  text += fmt::format("{} trip the torque limit; without it {} of them would go on to the hard limit\n", tripped(),
                      tripping_harder());
  return text;
}

}  // namespace hirosco::simulation
