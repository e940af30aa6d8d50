// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/rokviss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <exception>
#include <numbers>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/beside.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::array runs{
    Run{"RO1", "Free motion", "coupled, the hand moves 0.15 rad as sines of 0.25, 0.5 and 1 Hz", fly_tracking},
    Run{"RO2", "Pressing the rail", "coupled, friction off, the hand intends J⁻¹(dx, 0) and rests", fly_rail},
    Run{"RO3", "What the hand feels", "coupled, friction off, 22.6 mm in 1 s", fly_display},
    Run{"RO4", "Springs", "a spring hooked, friction off, the hand intends to move away from its anchor and rests",
        fly_springs},
    Run{"RO5", "Contour programme", "automatic: along the rail at 20 mm/s, 6 mm pressed in, without and with a bump",
        fly_contour},
    Run{"RO6", "Hard contact", "force scale 0.08, torque limits raised to 100 N m, the hand intends 32.5 mm in 1 s",
        fly_bounce},
    Run{"RO7", "Over the ground link",
        "remote: 500 Hz, round trips of 20, 30 and 60 ms, the hand intends 22.6 mm in 3 s", fly_remote},
    Run{"RO8", "Torque limit", "coupled, the hand ramps at 40 mm/s to 65 mm", fly_torque_limit},
    Run{"RO9", "Unplugging", "each device unplugged in free motion and in contact", fly_unplugging},
    Run{"FC", "Fault cases", "FC1 to FC9 and FC13, each again and again in motion and in contact", fly_faults, false},
    Run{"RO10", "Endurance", "30 minutes coupled, the hand wanders", fly_endurance},
};

// --- RO1 ---------------------------------------------------------------------------------------------------------------

struct Tracking {
  double worst_rad{0};
  Curve desired{"commanded"}, position{"measured", {}, {}, Stroke::Dashed};
  Curve error{"error"};
};

Tracking track(const RunSettings& settings, double frequency_hz, bool both_axes, Findings& findings) {
  CoupledCraft craft{craft_options(settings)};
  craft.hand(fmt::format("sine 1 0.15 {}", frequency_hz));
  if (both_axes) craft.hand(fmt::format("sine 2 0.15 {}", frequency_hz));
  craft.run(2 / frequency_hz);
  Tracking seen;
  const double start_s = craft.time_s();
  craft.on_report = [&] {
    const auto& report = craft.report();
    for (std::size_t i = 0; i < 2; ++i)
      seen.worst_rad = std::max(seen.worst_rad, std::abs(report.position_rad[i] - report.desired_rad[i]));
    const double now_s = craft.time_s() - start_s;
    seen.desired.add(now_s, report.desired_rad[0]);
    seen.position.add(now_s, report.position_rad[0]);
    seen.error.add(now_s, 1e3 * (report.desired_rad[0] - report.position_rad[0]));
  };
  double deepest_m = -1;
  craft.each_cycle([&] { deepest_m = std::max(deepest_m, craft.arm().contact().penetration_m); });
  craft.run(4 / frequency_hz);
  if (seen.error.x.size() < 100) findings.problems.emplace_back("too few reports to judge tracking by");
  if (deepest_m >= 0) findings.problems.emplace_back("the motion was not free: the finger touched the rail");
  return seen;
}

/// Fundamental of joint torque and joint angle in a periodic motion of one axis.
struct Fundamental {
  std::array<std::complex<double>, 2> torque_n_m{}, angle_rad{};
};

constexpr double identification_hz = 2;

Fundamental excite(const RunSettings& settings, int axis) {
  CoupledCraft craft{craft_options(settings)};
  craft.hand(fmt::format("sine {} 0.05 {}", axis, identification_hz));
  craft.run(4 / identification_hz);
  Fundamental sum;
  int cycle = 0;
  const double step = 2 * std::numbers::pi * identification_hz * CoupledCraft::period_s;
  craft.each_cycle([&] {
    const auto turn = std::polar(1.0, -step * cycle++);
    const Vec2 torque = craft.arm().joint_torque_n_m();
    for (std::size_t i = 0; i < 2; ++i) {
      sum.torque_n_m[i] += turn * torque[i];
      sum.angle_rad[i] += turn * craft.arm().state().link_rad[i];
    }
  });
  craft.run(4 / identification_hz);
  return sum;
}

/// The mass matrix at home, as an engineer would measure it: two experiments, tau = M q'' for both fundamentals.
void identify_inertia(const RunSettings& settings, Findings& findings) {
  const Fundamental one = excite(settings, 1), two = excite(settings, 2);
  const auto determinant = one.angle_rad[0] * two.angle_rad[1] - two.angle_rad[0] * one.angle_rad[1];
  const double w = 2 * std::numbers::pi * identification_hz;
  const auto entry = [&](std::size_t row, std::size_t column) {
    const auto& [a, b] = std::pair{one.torque_n_m[row], two.torque_n_m[row]};
    const auto value =
        column == 0 ? a * two.angle_rad[1] - b * one.angle_rad[1] : b * one.angle_rad[0] - a * two.angle_rad[0];
    return -(value / determinant).real() / (w * w);
  };
  findings.figures["RO1-inertia-11"] = entry(0, 0);
  findings.figures["RO1-inertia-12"] = entry(0, 1);
  findings.figures["RO1-inertia-22"] = entry(1, 1);
}

// --- RO3 ---------------------------------------------------------------------------------------------------------------

/// The shift in cycles at which the display fits the torque best.
double lag_of(const std::vector<double>& display, const std::vector<double>& torque, double force_scale) {
  constexpr std::size_t most = 10;
  const auto mismatch = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = most; k < display.size(); ++k) sum += std::abs(display[k] + force_scale * torque[k - lag]);
    return sum;
  };
  std::size_t best = 0;
  for (std::size_t candidate = 1; candidate < most; ++candidate)
    if (mismatch(candidate) < mismatch(best)) best = candidate;
  return static_cast<double>(best);
}

}  // namespace

std::span<const Run> rokviss_runs() { return runs; }

Findings fly(const Run& run, const RunSettings& settings) {
  try {
    return run.fly(settings);
  } catch (const std::exception& error) {
    return {.problems = {error.what()}};
  }
}

CraftOptions craft_options(const RunSettings& settings) {
  return {.mission = settings.mission, .seed = settings.seed, .plant = settings.plant};
}

Findings fly_tracking(const RunSettings& settings) {
  Findings findings;
  for (const auto& [frequency_hz, text] : {std::pair{0.25, "0.25Hz"}, {0.5, "0.5Hz"}, {1.0, "1Hz"}}) {
    const Tracking alone = track(settings, frequency_hz, false, findings);
    const Tracking both = track(settings, frequency_hz, true, findings);
    findings.figures[fmt::format("RO1-axis-1-{}", text)] = alone.worst_rad;
    findings.figures[fmt::format("RO1-both-{}", text)] = both.worst_rad;
    findings.figures[fmt::format("RO1-limit-{}", text)] = std::max(alone.worst_rad, both.worst_rad);
    if (frequency_hz < 1) continue;
    independent::Conditions swings{.hand = independent::Hand::Sine, .sine_rad = {0.15, 0}, .sine_hz = frequency_hz};
    swings.span_s = 6 / frequency_hz;
    Plot tracking{.name = "ro1-tracking",
                  .title = "RO1: joint 1 follows the hand, 1 Hz",
                  .x_label = "time / s",
                  .y_label = "joint 1 / rad",
                  .caption =
                      "Commanded by the handle over the real-time link, and measured behind the "
                      "flexible joint; after two periods of start-up.",
                  .curves = {alone.desired, alone.position}};
    const double start_s = 2 / frequency_hz;
    findings.figures["RO1-independent"] =
        1e3 *
        draw_beside(tracking, 1, independently(swings, [](const auto& at) { return at.met_rad[0]; }, start_s), "rad");
    findings.plots.push_back(std::move(tracking));
    Plot error{.name = "ro1-error",
               .title = "RO1: tracking error of joint 1, 1 Hz",
               .x_label = "time / s",
               .y_label = "q_d - q / mrad",
               .caption = "The kinks are the Coulomb friction of the motor where it turns round.",
               .curves = {alone.error}};
    const auto error_of = [](const auto& at) { return 1e3 * (at.asked_rad[0] - at.met_rad[0]); };
    draw_beside(error, 0, independently(swings, error_of, start_s), "mrad");
    findings.plots.push_back(std::move(error));
  }
  identify_inertia(settings, findings);
  return findings;
}

Findings fly_rail(const RunSettings& settings) {
  Findings findings;
  Plot plot{.name = "ro2-contact",
            .title = "RO2: contact force while the hand presses by 17.6, 22.6 and 27.6 mm",
            .x_label = "time / s",
            .y_label = "normal force / N",
            .caption = "World truth at cycle rate. The steady forces are those of the closed form within 0.1 %."};
  CraftOptions options = craft_options(settings);
  options.friction = false;
  Stroke stroke = Stroke::Solid;
  for (const double dx_mm : {17.6, 22.6, 27.6}) {
    CoupledCraft craft{options};
    Curve curve{.name = fmt::format("{:.1f} mm", dx_mm), .stroke = stroke};
    craft.each_cycle([&] { curve.add(craft.time_s(), craft.arm().contact().normal_force_n); });
    craft.hand(fmt::format("cartesian {} 0 1", dx_mm * 1e-3));
    craft.run(6);
    const auto& arm = craft.arm();
    const auto name = [&](const char* what) { return fmt::format("RO2-{:.1f}mm-{}", dx_mm, what); };
    findings.figures[name("force")] = arm.contact().normal_force_n;
    findings.figures[name("penetration")] = arm.contact().penetration_m * 1e3;
    findings.figures[name("tau2")] = craft.report().torque_n_m[1];
    findings.figures[name("windup2")] = (arm.state().motor_rad[1] - arm.state().link_rad[1]) * 1e3;
    plot.curves.push_back(std::move(curve));
    stroke = Stroke::Dashed;
    independent::Conditions beside{.friction = independent::Friction::Off, .offset_m = {dx_mm * 1e-3, 0}, .span_s = 6};
    Curve other = independently(beside, [](const auto& at) { return at.force_n; });
    other.name = fmt::format("independent loop, {:.1f} mm", dx_mm);
    findings.figures[name("independent")] = draw_beside(plot, plot.curves.size() - 1, std::move(other), "N");
  }
  findings.plots.push_back(std::move(plot));
  return findings;
}

Findings fly_display(const RunSettings& settings) {
  constexpr double rail_n_per_m = 5e4, force_scale = 0.02;  // of the note, as RO3's ratios are made of them
  Findings findings;
  CraftOptions options = craft_options(settings);
  options.friction = false;
  CoupledCraft craft{options};
  craft.hand("cartesian 0.0226 0 1");
  Curve display{.name = "felt by the hand"}, torque{.name = "-0.02 x torque of joint 2", .stroke = Stroke::Dashed};
  std::vector<double> measured;
  craft.each_cycle([&] {
    display.add(craft.time_s(), craft.felt_n_m()[1]);
    measured.push_back(craft.arm().joint_torque_n_m()[1]);
    torque.add(craft.time_s(), -force_scale * measured.back());
  });
  craft.run(1.5);
  findings.figures["RO3-lag"] = lag_of(display.y, measured, force_scale);
  craft.each_cycle([] {});
  craft.run(4.5);
  const auto contact = craft.arm().contact();
  findings.figures["RO3-display-ratio"] = craft.felt_n_m()[1] / craft.report().torque_n_m[1];
  findings.figures["RO3-force-ratio"] = contact.normal_force_n / (rail_n_per_m * contact.penetration_m);
  Plot plot{.name = "ro3-display",
            .title = "RO3: the hand feels what the robot feels",
            .x_label = "time / s",
            .y_label = "torque of axis 2 / N m",
            .caption = "One cycle of 0.5 ms lies between the two curves.",
            .curves = {std::move(display), std::move(torque)}};
  independent::Conditions beside{.friction = independent::Friction::Off, .offset_m = {0.0226, 0}, .span_s = 1.5};
  findings.figures["RO3-independent"] =
      draw_beside(plot, 0, independently(beside, [](const auto& at) { return at.display_n_m[1]; }), "N m");
  findings.plots.push_back(std::move(plot));
  return findings;
}

}  // namespace hirosco::simulation
