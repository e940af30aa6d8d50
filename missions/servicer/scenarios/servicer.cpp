// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/servicer/scenarios/servicer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "hirosco/descriptor/read/read.hpp"
#include "missions/servicer/scenarios/servicer_power.hpp"

namespace hirosco::simulation {
namespace {

using Place = ServicerCraft::Place;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr const char* stow = "0,-1.2,0,2.4,0,-1.2,0";
constexpr std::array ready{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0};
constexpr double step_m = 0.2, step_s = 20;

struct Direction {
  const char* name;
  Place offset_m;
};
constexpr std::array directions{Direction{"x", {step_m, 0, 0}}, Direction{"-x", {-step_m, 0, 0}},
                                Direction{"y", {0, step_m, 0}}, Direction{"-y", {0, -step_m, 0}},
                                Direction{"z", {0, 0, step_m}}, Direction{"-z", {0, 0, -step_m}}};

[[nodiscard]] std::span<const Direction> flown(const ServicerSettings& settings) {
  return std::span{directions}.first(settings.brief ? 1 : directions.size());
}

[[nodiscard]] double distance(const Place& one, const Place& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

/// Where a tool is to be that goes from rest to rest: a polynomial of the fifth degree.
[[nodiscard]] Place planned(const Place& from, const Place& offset_m, double t_s) {
  const double x = std::clamp(t_s / step_s, 0.0, 1.0), share = x * x * x * (10 + x * (6 * x - 15));
  Place at = from;
  for (std::size_t i = 0; i < at.size(); ++i) at[i] += share * offset_m[i];
  return at;
}

[[nodiscard]] std::vector<Value> move_tool(const Place& offset_m) {
  return {offset_m[0], offset_m[1], offset_m[2], step_s};
}

// --- SV1 ---------------------------------------------------------------------------------------------------------------

using Vector = FloatingBase::Vector;
[[nodiscard]] double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }
[[nodiscard]] double apart(const Vector& one, const Vector& other) { return distance(one, other); }

[[nodiscard]] std::expected<MujocoRobot, std::string> tumbling(const ServicerSettings& settings) {
  const auto file = settings.mission.parent_path() / "page/servicer.urdf";
  const auto text = descriptor::file_system()(file);
  if (!text) return std::unexpected{file.string() + " " + text.error().text};
  // In a minute joints turn farther than their ranges: the design's tumble has no stops, which would take energy.
  std::string without_stops = *text;
  constexpr std::string_view with_range = "type=\"revolute\"";
  for (auto at = without_stops.find(with_range); at != std::string::npos; at = without_stops.find(with_range, at))
    without_stops.replace(at, with_range.size(), "type=\"continuous\"");
  // And no shapes: its links go through each other and through the base.
  constexpr std::string_view begins = "<collision>", ends = "</collision>";
  for (auto at = without_stops.find(begins); at != std::string::npos; at = without_stops.find(begins, at))
    without_stops.erase(at, without_stops.find(ends, at) + ends.size() - at);
  auto robot = MujocoRobot::make(without_stops);
  if (!robot) return robot;
  robot->set_gravity(0, 0, 0);
  if (auto floats = robot->let_float(); !floats) return std::unexpected{floats.error()};
  if (auto placed = robot->place(std::array{0.3, -0.6, 0.4, 1.2, -0.5, 0.8, 0.2}); !placed)
    return std::unexpected{placed.error()};
  robot->set_in_motion({0.02, -0.03, 0.05, 0.01, 0, -0.01}, std::array{0.2, -0.15, 0.1, 0.25, -0.3, 0.2, 0.4});
  return robot;
}

Findings fly_tumble(const ServicerSettings& settings) {
  Findings findings;
  std::array<std::vector<double>, 2> ends;
  for (auto& end : ends) {
    auto robot = tumbling(settings);
    if (!robot) {
      findings.problems.push_back(robot.error());
      return findings;
    }
    const auto begun = robot->base().momentum(robot->model(), robot->data());
    // The design tells it about the inertial origin; MuJoCo's world has nothing else in it.
    Vector about_origin;
    mju_cross(about_origin.data(), robot->data().subtree_com, begun.linear_n_s.data());
    for (std::size_t i = 0; i < about_origin.size(); ++i) about_origin[i] += begun.angular_n_m_s[i];
    const double energy_j = robot->kinetic_energy_j();
    double angular = 0, linear = 0, energy = 0;
    constexpr int cycles = 60'000, look_every = 100;
    const std::vector<double> nothing(robot->joints(), 0.0);
    for (int i = 1; i <= cycles; ++i) {
      robot->step(nothing, MujocoRobot::Brakes::Open, std::chrono::milliseconds{1});
      if (i % look_every != 0) continue;
      const auto now = robot->base().momentum(robot->model(), robot->data());
      angular = std::max(angular, apart(now.angular_n_m_s, begun.angular_n_m_s) / length(begun.angular_n_m_s));
      linear = std::max(linear, apart(now.linear_n_s, begun.linear_n_s) / length(begun.linear_n_s));
      energy = std::max(energy, std::abs(robot->kinetic_energy_j() - energy_j) / energy_j);
    }
    findings.figures["SV1-angular-n-m-s"] = length(about_origin);
    findings.figures["SV1-energy-j"] = energy_j;
    findings.figures["SV1-angular"] = angular;
    findings.figures["SV1-linear"] = linear;
    findings.figures["SV1-energy"] = energy;
    end.assign(robot->data().qpos, robot->data().qpos + robot->model().nq);
    end.insert(end.end(), robot->data().qvel, robot->data().qvel + robot->model().nv);
  }
  findings.figures["SV1-same"] = ends[0] == ends[1] ? 1 : 0;
  return findings;
}

// --- SV2 ---------------------------------------------------------------------------------------------------------------

Findings fly_unfolding(const ServicerSettings& settings) {
  Findings findings;
  for (const double duration_s : {40.0, 80.0}) {
    if (settings.brief && duration_s > 40) continue;
    ServicerCraft craft{{.mission = settings.mission, .seed = settings.seed, .mode = "joints", .posture = stow}};
    std::vector<Value> arguments(ready.begin(), ready.end());
    arguments.emplace_back(duration_s);
    craft.begin("MOVE_JOINT", arguments);
    Curve turned{fmt::format("{:g} s", duration_s)};
    const double start_s = craft.time_s();
    for (double t = 0; t < duration_s; t += 0.5) {
      craft.run(0.5);
      turned.add(craft.time_s() - start_s, craft.base_deg());
    }
    constexpr double settles_s = 6;
    craft.run(settles_s);
    const std::string name = fmt::format("SV2-{:g}s-", duration_s);
    findings.figures[name + "base-deg"] = craft.base_deg();
    findings.figures[name + "rate-deg-s"] = craft.base_deg_s();
    const auto base = craft.robot().base().orientation(craft.robot().data());
    constexpr std::array expected{"qw", "qx", "qy", "qz"};
    if (duration_s == 40)
      for (std::size_t i = 0; i < expected.size(); ++i)
        findings.figures[fmt::format("SV2-{}", expected[i])] = std::copysign(1, base[0]) * base[i];
    if (findings.plots.empty())
      findings.plots.push_back({.name = "sv2-base",
                                .title = "How far the base is turned while the arm unfolds",
                                .x_label = "time, s",
                                .y_label = "deg",
                                .caption = "It ends at the same attitude however long it takes: only the way counts."});
    findings.plots.front().curves.push_back(std::move(turned));
  }
  return findings;
}

// --- SV3 ---------------------------------------------------------------------------------------------------------------

struct Moved {
  double largest_error_m{0};
  double largest_turn_deg{0};
  double fastest_rad_s{0};
  Curve error;
};

/// `stuck_after_s`: from then on the pose of the base that is told is the one that it had then.
[[nodiscard]] Moved move(const ServicerSettings& settings, const std::string& mode, const Direction& direction,
                         Noise noise, std::optional<double> stuck_after_s = {}) {
  ServicerCraft craft{{.mission = settings.mission, .seed = settings.seed, .mode = mode, .noise = noise}};
  const Place from = craft.tool_m();
  const double begun_s = craft.begin("MOVE_TOOL", move_tool(direction.offset_m));
  Moved seen{.error = Curve{fmt::format("{} {}", mode, direction.name)}};
  int count = 0;
  craft.each_cycle([&] {
    const double t_s = craft.time_s() - begun_s;
    const double error_m = distance(craft.tool_m(), planned(from, direction.offset_m, t_s));
    seen.largest_error_m = std::max(seen.largest_error_m, error_m);
    seen.largest_turn_deg = std::max(seen.largest_turn_deg, craft.base_deg());
    seen.fastest_rad_s = std::max(seen.fastest_rad_s, craft.fastest_joint_rad_s());
    constexpr int draw_every = 20;
    if (count++ % draw_every == 0) seen.error.add(t_s, 1e3 * error_m);
  });
  const double ends_s = craft.time_s() + step_s + 1;
  if (stuck_after_s) {
    craft.run(begun_s + *stuck_after_s - craft.time_s());
    if (!craft.flight().device<SimulatedDevice>("base").fault("stuck on")) throw std::runtime_error{"not stuck"};
  }
  craft.run(ends_s - craft.time_s());
  craft.each_cycle([] {});
  if (stuck_after_s && craft.flight().inhibited("MCS") != 0)
    throw std::runtime_error{"it was stopped on its way\n" + craft.flight().story().text()};
  return seen;
}

/// The largest and the least of several moves.
struct MovedBy {
  double least_m{never}, most_m{0}, least_deg{never}, most_deg{0}, fastest{0};
  void take(const Moved& seen) {
    least_m = std::min(least_m, seen.largest_error_m);
    most_m = std::max(most_m, seen.largest_error_m);
    least_deg = std::min(least_deg, seen.largest_turn_deg);
    most_deg = std::max(most_deg, seen.largest_turn_deg);
    fastest = std::max(fastest, seen.fastest_rad_s);
  }
  void tell(Figures& figures, std::string_view name) const {
    figures[fmt::format("SV3-{}-least-mm", name)] = 1e3 * least_m;
    figures[fmt::format("SV3-{}-most-mm", name)] = 1e3 * most_m;
    figures[fmt::format("SV3-{}-least-deg", name)] = least_deg;
    figures[fmt::format("SV3-{}-most-deg", name)] = most_deg;
    figures[fmt::format("SV3-{}-fastest", name)] = fastest;
  }
};

/// Who believes a pose that stands still moves its tool as if the base stood: nobody tells the arm. Without noise, as the design has it: that of the one
/// sample that is left would count for the rest of the way.
void move_by_a_stuck_pose(const ServicerSettings& settings, Findings& findings) {
  constexpr double stuck_after_s = 8;
  MovedBy all;
  Plot plot{.name = "sv3-frozen",
            .title = "Distance of the tool from where it is to be, mode track, the pose of the base stuck after 8 s",
            .x_label = "time, s",
            .y_label = "mm"};
  for (const Direction& direction : flown(settings)) {
    Moved seen = move(settings, "track", direction, Noise::None, stuck_after_s);
    all.take(seen);
    plot.curves.push_back(std::move(seen.error));
  }
  all.tell(findings.figures, "frozen");
  findings.plots.push_back(std::move(plot));
}

Findings fly_moves(const ServicerSettings& settings) {
  Findings findings;
  for (const auto& [mode, name] : {std::pair{"joints", "without-link"}, {"track", "track"}, {"approach", "hold"}}) {
    MovedBy all;
    double fastest_quiet = 0;
    const bool by_pose = mode != std::string_view{"joints"};
    Plot plot{.name = fmt::format("sv3-{}", name),
              .title = fmt::format("Distance of the tool from where it is to be, mode {}", mode),
              .x_label = "time, s",
              .y_label = "mm"};
    for (const Direction& direction : flown(settings)) {
      Moved seen = move(settings, mode, direction, Noise::AsDeclared);
      all.take(seen);
      // Of many noisy values the largest lies above the one that the design tells, which has no noise.
      if (by_pose) fastest_quiet = std::max(fastest_quiet, move(settings, mode, direction, Noise::None).fastest_rad_s);
      plot.curves.push_back(std::move(seen.error));
    }
    all.tell(findings.figures, name);
    if (by_pose) {
      findings.figures[fmt::format("SV3-{}-fastest-with-noise", name)] = all.fastest;
      findings.figures[fmt::format("SV3-{}-fastest", name)] = fastest_quiet;
    }
    findings.plots.push_back(std::move(plot));
  }
  move_by_a_stuck_pose(settings, findings);
  return findings;
}

// --- SV4 ---------------------------------------------------------------------------------------------------------------

Findings fly_cut(const ServicerSettings& settings) {
  Findings findings;
  ServicerCraft craft{{.mission = settings.mission, .seed = settings.seed, .mode = "track"}};
  const Direction& direction = directions[0];
  const Place from = craft.tool_m();
  const double begun_s = craft.begin("MOVE_TOOL", move_tool(direction.offset_m));
  constexpr double cut_after_s = 8;
  craft.run(begun_s + cut_after_s - craft.time_s());
  const double cut_s = craft.time_s();
  const Place then = planned(from, direction.offset_m, cut_s - begun_s);
  const double h_s = 1e-3;
  const double speed_m_s = distance(then, planned(from, direction.offset_m, cut_s - begun_s + h_s)) / h_s;
  double told_s = never, rest_s = never;
  craft.flight().story().on_line = [&](std::string_view line) {
    if (told_s == never && line.find("POSE_STALE") != line.npos) told_s = craft.time_s();
  };
  // Whoever measures the pose stands still.
  craft.craft().stop("AOCS", true);
  constexpr double rests_rad_s = 1e-4;
  double farthest_m = 0;
  for (int i = 0; i < 2000; ++i) {
    craft.run(1e-3);
    const bool rests = craft.fastest_joint_rad_s() < rests_rad_s;
    if (!rests) rest_s = never;
    else if (rest_s == never) rest_s = craft.time_s();
    farthest_m = std::max(farthest_m, distance(craft.tool_m(), then));
  }
  findings.figures["SV4-told-ms"] = 1e3 * (told_s - cut_s);
  findings.figures["SV4-rest-s"] = rest_s - cut_s;
  findings.figures["SV4-beyond-mm"] = 1e3 * (farthest_m - 0.5 * speed_m_s);
  findings.notes.push_back(fmt::format("When it was cut the tool went at {:.1f} mm/s; it stood {:.2f} mm farther on.",
                                       1e3 * speed_m_s, 1e3 * farthest_m));
  return findings;
}

// --- SV8 ---------------------------------------------------------------------------------------------------------------

struct HandedOver {
  double died_deg{0}, died_deg_s{0}, stood_deg{0}, taken_s{never}, settled_s{never}, momentum{0};
  Curve turned{"attitude", {}, {}};
};

/// `stands_still`: for so long the supervisor does nothing when it happens. Its guard and the devices' own watchdogs brake the arm all the same.
[[nodiscard]] HandedOver hand_over(const ServicerSettings& settings, const Direction& direction,
                                   Duration stands_still = {}) {
  ServicerCraft craft{{.mission = settings.mission, .seed = settings.seed, .mode = "track"}};
  const double begun_s = craft.begin("MOVE_TOOL", move_tool(direction.offset_m));
  constexpr double dies_after_s = 10;
  craft.run(begun_s + dies_after_s - craft.time_s());
  HandedOver seen{.died_deg = craft.base_deg(), .died_deg_s = craft.base_deg_s()};
  const double died_s = craft.time_s();
  craft.craft().kill("MCS");
  if (stands_still > Duration{}) craft.craft().hang_supervisor(stands_still);
  bool brakes = true;
  constexpr double watched_s = 60, h_s = 0.01;
  for (double t = 0; t < watched_s; t += h_s) {
    craft.run(h_s);
    const double now_s = craft.time_s() - died_s;
    if (brakes) seen.stood_deg = std::max(seen.stood_deg, craft.base_deg());
    if (seen.taken_s == never && craft.flight().state("AOCS") == State::Operational &&
        craft.craft().vital("AOCS")->configuration.load() == 1) {
      seen.taken_s = now_s;
      brakes = false;
    }
    const bool settled = craft.base_deg() < 0.1 && craft.base_deg_s() < 0.01;
    if (!settled) seen.settled_s = never;
    else if (seen.settled_s == never) seen.settled_s = now_s;
    seen.momentum = std::max(seen.momentum, craft.momentum_n_m_s());
    seen.turned.add(now_s, craft.base_deg());
  }
  return seen;
}

Findings fly_hand_over(const ServicerSettings& settings) {
  Findings findings;
  double worst_settled_s = 0, worst_taken_s = 0, momentum = 0;
  std::string each;
  Plot plot{.name = "sv8-attitude",
            .title = "Attitude after the arm's control was killed",
            .x_label = "time, s",
            .y_label = "deg",
            .caption = "Its brakes hold the arm, then the AOCS takes the station over."};
  // The design tells of one run, without its direction: taken is x, of which SV4 tells. The note has all of them.
  std::optional<HandedOver> told;
  for (const Direction& direction : flown(settings)) {
    HandedOver seen = hand_over(settings, direction);
    each += fmt::format("{}{}: {:.2f} deg, {:.2f} deg/s, stood at {:.2f} deg, taken {:.2f} s, settled {:.1f} s",
                        each.empty() ? "" : "; ", direction.name, seen.died_deg, seen.died_deg_s, seen.stood_deg,
                        seen.taken_s, seen.settled_s);
    worst_settled_s = std::max(worst_settled_s, seen.settled_s);
    worst_taken_s = std::max(worst_taken_s, seen.taken_s);
    momentum = std::max(momentum, seen.momentum);
    seen.turned.name = direction.name;
    plot.curves.push_back(seen.turned);
    if (!told) told = std::move(seen);
  }
  findings.figures["SV8-died-deg"] = told->died_deg;
  findings.figures["SV8-died-deg-s"] = told->died_deg_s;
  findings.figures["SV8-stood-deg"] = told->stood_deg;
  findings.figures["SV8-settled-s"] = told->settled_s;
  findings.figures["SV8-all-settled-s"] = worst_settled_s;
  findings.figures["SV8-all-taken-s"] = worst_taken_s;
  // What else a hand-over takes is 0.07 s.
  HandedOver late = hand_over(settings, directions[0], std::chrono::milliseconds{930});
  findings.figures["SV8-late-stood-deg"] = late.stood_deg;
  findings.figures["SV8-late-taken-s"] = late.taken_s;
  findings.figures["SV8-late-settled-s"] = late.settled_s;
  each += fmt::format("; {} and 0.93 s without a supervisor: stood at {:.2f} deg, taken {:.2f} s, settled {:.1f} s",
                      directions[0].name, late.stood_deg, late.taken_s, late.settled_s);
  momentum = std::max(momentum, late.momentum);
  findings.figures["SV8-momentum"] = momentum;
  late.turned.name = fmt::format("{}, handed over after 1 s", directions[0].name);
  plot.curves.push_back(std::move(late.turned));
  findings.notes.push_back(each + ".");
  findings.plots.push_back(std::move(plot));
  return findings;
}

constexpr std::array runs{
    ServicerRun{"SV1", "Tumbling", "the world alone: 60 s without a torque, base and all joints in motion", fly_tumble},
    ServicerRun{"SV2", "Unfolding", "joints: from stow to ready in 40 and 80 s, nobody keeps the attitude",
                fly_unfolding},
    ServicerRun{
        "SV3", "The tool by 0.2 m",
        "from ready along x, y and z both ways in 20 s, sensors with noise: without the pose of the base (joints), in "
        "inertial axes (track), with the base unturned (approach); with the pose a second time without noise, for the "
        "fastest joint; and track without noise with a pose that stands still from 8 s on, and is told as new",
        fly_moves},
    ServicerRun{"SV4", "Pose lost", "track, 0.2 m along x: after 8 s the AOCS stands still", fly_cut},
    ServicerRun{"SV8", "Station keeping handed over",
                "track, 0.2 m in 20 s: after 10 s the arm's control is killed; figures of one run are of that along x; "
                "once more along x with a supervisor that stands still for 0.93 s then",
                fly_hand_over},
    ServicerRun{"SV9", "Power",
                "the sun at four angles, an eclipse: whether track is entered; then, track, 0.2 m in 20 s: after 8 s "
                "the sun is gone",
                fly_power},
};

}  // namespace

std::span<const ServicerRun> servicer_runs() { return runs; }

Findings fly(const ServicerRun& run, const ServicerSettings& settings) {
  try {
    return run.fly(settings);
  } catch (const std::exception& problem) {
    Findings findings;
    findings.problems.emplace_back(problem.what());
    return findings;
  }
}

}  // namespace hirosco::simulation
