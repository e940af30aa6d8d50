// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// RO6 and RO8: hard contact and the torque limit.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/beside.hpp"
#include "missions/rokviss/scenarios/rokviss.hpp"

namespace hirosco::simulation {
namespace {

// --- RO6 ---------------------------------------------------------------------------------------------------------------

struct Bounce {
  double lost_share{0};
  double peak_n{0};
  double steady_n{0};
  int departures{0};  ///< from the rail
  double last_departure_s{0};
  Curve force;
};

constexpr double bounce_span_s = 6, judged_span_s = 2;

Bounce press_hard(const RunSettings& settings, bool passivity) {
  CraftOptions options = craft_options(settings);
  options.initial = {{"JOYSTICK.FORCE_SCALE", 0.08},
                     {"JOYSTICK.PASSIVITY", passivity ? 1 : 0},
                     {"MANIPULATOR.TORQUE_LIMIT", 100},
                     {"MANIPULATOR.TORQUE_HARD", 100}};
  CoupledCraft craft{options};
  Bounce seen;
  seen.force.name = passivity ? "with passivity" : "without passivity";
  if (passivity) seen.force.stroke = Stroke::Solid;
  int judged = 0, lost = 0;
  craft.hand("cartesian 0.0325 0 1");
  craft.each_cycle([&] {
    const double force_n = craft.arm().contact().normal_force_n;
    seen.peak_n = std::max(seen.peak_n, force_n);
    if (seen.steady_n > 0 && force_n <= 0) {
      ++seen.departures;
      seen.last_departure_s = craft.time_s();
    }
    seen.steady_n = force_n;
    seen.force.add(craft.time_s(), force_n);
    if (craft.time_s() <= bounce_span_s - judged_span_s) return;
    ++judged;
    if (force_n <= 0) ++lost;
  });
  craft.run(bounce_span_s);
  seen.lost_share = judged > 0 ? static_cast<double>(lost) / judged : 1;
  return seen;
}

/// With the limits of the mission the bouncing must end by itself.
double limit_ends_bouncing(const RunSettings& settings) {
  CraftOptions options = craft_options(settings);
  options.initial = {{"JOYSTICK.FORCE_SCALE", 0.08}};
  CoupledCraft craft{options};
  craft.hand("cartesian 0.0325 0 1");
  craft.run(bounce_span_s);
  const bool told = craft.flight().story().has("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED");
  return told && craft.flight().state("MANIPULATOR") == State::SafeOperational ? 1 : 0;
}

// --- RO8 ---------------------------------------------------------------------------------------------------------------

/// What happened around the trip of the torque limit, at cycle rate.
struct Trip {
  double event_s{-1};
  double time_s{-1};
  double force_n{0};
  double peak_n_m{0};
  double off_s{-1};  ///< since when the robot's motors do not obey
  double display_zero_s{-1};  ///< since when the hand feels nothing
  double force_at_80ms_n{-1};
  double force_after_85ms_n{0};
  Curve torque{"torque of joint 2"}, felt{"felt by the hand x 50", {}, {}, Stroke::Dashed}, force{"contact force"};
};

void watch_trip(CoupledCraft& craft, Trip& trip) {
  const double now_s = craft.time_s();
  const double force_n = craft.arm().contact().normal_force_n;
  const double torque_n_m = craft.arm().joint_torque_n_m()[1];
  trip.torque.add(now_s, torque_n_m);
  trip.felt.add(now_s, 50 * craft.felt_n_m()[1]);
  trip.force.add(now_s, force_n);
  trip.peak_n_m = std::max(trip.peak_n_m, std::abs(torque_n_m));
  if (trip.time_s < 0 && (craft.flight().inhibited("MANIPULATOR") & inhibited_by_author) != 0) {
    trip.time_s = now_s;
    trip.force_n = force_n;
  }
  if (trip.time_s < 0) return;
  if (craft.robot().active()) trip.off_s = -1;
  else if (trip.off_s < 0) trip.off_s = now_s;
  if (craft.felt_n_m() != Vec2{}) trip.display_zero_s = -1;
  else if (trip.display_zero_s < 0) trip.display_zero_s = now_s;
  const double past_s = now_s - trip.time_s;
  if (past_s >= 0.080 && trip.force_at_80ms_n < 0) trip.force_at_80ms_n = force_n;
  if (past_s >= 0.085) trip.force_after_85ms_n = std::max(trip.force_after_85ms_n, force_n);
}

/// Only what lies close to the moment.
Curve around(Curve curve, double moment_s, double before_s, double after_s) {
  Curve near{.name = std::move(curve.name), .stroke = curve.stroke};
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double past_s = curve.x[i] - moment_s;
    if (past_s >= -before_s && past_s <= after_s) near.add(1e3 * past_s, curve.y[i]);
  }
  return near;
}

void plot_trip(Findings& findings, Trip& trip) {
  constexpr double before_s = 0.15, after_s = 0.15;
  const auto near = [&](Curve curve, double moment_s) { return around(std::move(curve), moment_s, before_s, after_s); };
  const independent::Conditions ramp{.hand = independent::Hand::Ramp,
                                     .offset_m = {0.065, 0},
                                     .hand_span_s = 0.065 / 0.04,
                                     .span_s = 2,
                                     .torque_limit_n_m = 12};
  // Its trip is its own.
  double other_trip_s = 0;
  Curve other_force{.name = "independent loop", .stroke = Stroke::Dotted}, other_torque = other_force;
  for (const independent::Sample& at : independent::fly(ramp)) {
    if (!at.stopping) other_trip_s = at.time_s;
    other_force.add(at.time_s, at.force_n);
    other_torque.add(at.time_s, at.torque_n_m[1]);
  }
  Plot torque{.name = "ro8-torque",
              .title = "RO8: the torque limit trips",
              .x_label = "time from the trip / ms",
              .y_label = "torque / N m",
              .caption =
                  "After two of three samples beyond 12 N m the joints stop by themselves in the same cycle, damped "
                  "and giving way; the joystick's display goes to zero because the link says that the robot is "
                  "not active.",
              .curves = {near(trip.torque, trip.time_s), near(trip.felt, trip.time_s)},
              .marks = {{"soft limit -12 N m", -12}, {"joints stop by themselves", 0, true}}};
  findings.figures["RO8-independent-torque"] = draw_beside(torque, 0, near(other_torque, other_trip_s), "N m");
  findings.plots.push_back(std::move(torque));
  Plot force{
      .name = "ro8-force",
      .title = "RO8: the finger lets go of the rail",
      .x_label = "time from the trip / ms",
      .y_label = "normal force / N",
      .caption =
          "The joints give way, so that the finger does not stay pressed; then they hold what is left, and brake.",
      .curves = {near(trip.force, trip.time_s)},
      .marks = {{"80 ms: below 10 %", 80, true}}};
  findings.figures["RO8-independent-force"] = draw_beside(force, 0, near(other_force, other_trip_s), "N");
  findings.plots.push_back(std::move(force));
}

}  // namespace

Findings fly_bounce(const RunSettings& settings) {
  Bounce without = press_hard(settings, false);
  Bounce with = press_hard(settings, true);
  Findings findings;
  findings.figures = {{"RO6-off-lost", without.lost_share}, {"RO6-off-peak", without.peak_n},
                      {"RO6-on-lost", with.lost_share},     {"RO6-on-peak", with.peak_n},
                      {"RO6-on-steady", with.steady_n},     {"RO6-off-limit", limit_ends_bouncing(settings)}};
  independent::Conditions hard{.force_scale = 0.08, .offset_m = {0.0325, 0}, .span_s = bounce_span_s};
  const auto force_of = [](const independent::Sample& at) { return at.force_n; };
  Plot bounce{.name = "ro6-bounce",
              .title = "RO6: hard contact without time-domain passivity",
              .x_label = "time / s",
              .y_label = "normal force / N",
              .caption = "Force scale 0.08, 32.5 mm in 1 s. The finger goes on bouncing.",
              .curves = {std::move(without.force)}};
  draw_beside(bounce, 0, independently(hard, force_of), "N");
  findings.plots.push_back(std::move(bounce));
  hard.passivity = independent::Passivity::On;
  Plot calm{.name = "ro6-calm",
            .title = "RO6: the same with passivity",
            .x_label = "time / s",
            .y_label = "normal force / N",
            .caption = fmt::format("It leaves the rail {} times in the first {:.1f} s, then the contact comes to rest.",
                                   with.departures, with.last_departure_s),
            .curves = {std::move(with.force)}};
  findings.figures["RO6-on-independent"] = draw_beside(calm, 0, independently(hard, force_of), "N");
  findings.plots.push_back(std::move(calm));
  return findings;
}

Findings fly_torque_limit(const RunSettings& settings) {
  CoupledCraft craft{craft_options(settings)};
  Trip trip;
  craft.flight().story().on_line = [&](std::string_view line) {
    if (line.starts_with("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED")) trip.event_s = craft.time_s();
  };
  craft.hand("ramp 0.065 0 0.04");
  craft.each_cycle([&] { watch_trip(craft, trip); });
  craft.run(2);
  Findings findings;
  if (trip.time_s < 0 || trip.event_s < 0) {
    findings.problems.emplace_back(trip.time_s < 0 ? "the limit never tripped" : "no event 1020 came");
    return findings;
  }
  const auto cycles_since = [&](double time_s) { return std::round((time_s - trip.time_s) / CoupledCraft::period_s); };
  const double display = trip.display_zero_s < 0 ? HUGE_VAL : cycles_since(trip.display_zero_s);
  const double off = trip.off_s < 0 ? HUGE_VAL : cycles_since(trip.off_s);
  findings.figures = {// A cycle judges what the device answered in the one before it: the sample is that much older.
                      {"RO8-trip-time", trip.time_s - CoupledCraft::period_s},
                      {"RO8-trip-force", trip.force_n},
                      {"RO8-peak", trip.peak_n_m},
                      {"RO8-event", cycles_since(trip.event_s)},
                      {"RO8-torque-off", off},
                      {"RO8-force-80ms", trip.force_at_80ms_n / trip.force_n},
                      {"RO8-force-85ms", trip.force_after_85ms_n},
                      {"RO8-display-zero", display},
                      {"RO8-end-gap", -1e3 * craft.arm().contact().penetration_m},
                      {"RO8-states", (craft.flight().state("MANIPULATOR") == State::SafeOperational ? 1 : 0) +
                                         (craft.flight().state("JOYSTICK") == State::Operational ? 1 : 0)}};
  plot_trip(findings, trip);
  return findings;
}

}  // namespace hirosco::simulation
