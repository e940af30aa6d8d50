// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// RO9 and RO10: devices unplugged again and again, and half an hour in which nothing must be lost.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/rokviss.hpp"

namespace hirosco::simulation {
namespace {

// --- RO9 ---------------------------------------------------------------------------------------------------------------

/// One unplugging: times since the plug was pulled, infinite for what never happened.
struct Unplugging {
  double event_s{never};
  double torque_off_s{never};
  double display_zero_s{never};
  double offline_s{never};
  double way_rad{0};  ///< of the joints until they came to rest
  bool told{false};
  Curve motor{"motor of joint 2"}, felt{"felt by the hand x 50", {}, {}, Stroke::Dashed};
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
    // Commissioning, then Error-, Post-Operational, both deinits and Offline: each its own event with its own time.
    if (story.count(fmt::format("{} info STATE_CHANGED", member)) < 5 + 5) return false;
  }
  return true;
}

/// A little before and after.
void plot_sample(CoupledCraft& craft, double past_s, Unplugging& seen) {
  constexpr double shown_s = 0.020;
  if (std::abs(past_s) > shown_s) return;
  seen.motor.add(1e3 * past_s, craft.robot().motor_torque_n_m()[1]);
  seen.felt.add(1e3 * past_s, 50 * craft.felt_n_m()[1]);
}

void watch_unplugging(CoupledCraft& craft, double pulled_s, const Vec2& q, Unplugging& seen) {
  const double past_s = craft.time_s() - pulled_s;
  constexpr double rounding_s = 1e-9;
  plot_sample(craft, past_s, seen);
  if (past_s < rounding_s) return;
  if (!craft.robot().active()) seen.torque_off_s = std::min(seen.torque_off_s, past_s);
  if (craft.felt_n_m() == Vec2{}) seen.display_zero_s = std::min(seen.display_zero_s, past_s);
  for (std::size_t i = 0; i < 2; ++i)
    seen.way_rad = std::max(seen.way_rad, std::abs(craft.arm().state().link_rad[i] - q[i]));
}

Unplugging unplug(const RunSettings& settings, const std::string& which, const std::string& hand, double after_s) {
  CoupledCraft craft{craft_options(settings)};
  Unplugging seen;
  craft.hand(hand);
  const double pulled_s = craft.time_s() + after_s;
  Vec2 q{};
  craft.craft().on_cycle([&](std::string_view, TimePoint) { watch_unplugging(craft, pulled_s, q, seen); });
  craft.run(after_s);
  q = craft.arm().state().link_rad;
  craft.flight().story().on_line = [&](std::string_view line) {
    if (line.find(" high ") != line.npos && line.find("_LOST") != line.npos)
      seen.event_s = std::min(seen.event_s, craft.time_s() - pulled_s);
  };
  if (!craft.craft().device(which)->fault("unplug")) return seen;
  const auto both_offline = [&] {
    return craft.flight().state("MANIPULATOR") == State::Offline && craft.flight().state("JOYSTICK") == State::Offline;
  };
  if (craft.craft().run_until(both_offline, 5s)) seen.offline_s = craft.time_s() - pulled_s;
  // Nobody cycles any more: what the devices do now is looked at all the same.
  constexpr int shown_cycles = 40;
  for (int i = 0; i < shown_cycles; ++i) {
    craft.run(CoupledCraft::period_s);
    plot_sample(craft, craft.time_s() - pulled_s, seen);
  }
  craft.run(0.3);
  for (std::size_t i = 0; i < 2; ++i)
    seen.way_rad = std::max(seen.way_rad, std::abs(craft.arm().state().link_rad[i] - q[i]));
  const bool robot = which == "robot";
  seen.told = log_names_all(craft.flight(), robot ? "MANIPULATOR" : "JOYSTICK", robot ? "ROBOT" : "JOYSTICK");
  return seen;
}

struct Condition {
  const char* name;
  const char* hand;
  double after_s;
  double spread_s;  ///< between the instants of two runs
  bool plotted;
};

Plot plot_of(const std::string& which, Unplugging& seen) {
  return {.name = "ro9-" + which,
          .title = fmt::format("RO9: the {} is unplugged in contact", which),
          .x_label = "time from the plug / ms",
          .y_label = "torque / N m",
          .caption =
              "Both subsystems act within 2 ms. A device that nobody commands any more keeps its last torque until its "
              "own watchdog of 10 ms.",
          .curves = {std::move(seen.motor), std::move(seen.felt)},
          .marks = {{"unplugged", 0, true},
                    {fmt::format("both Offline after {:.1f} ms", 1e3 * seen.offline_s), 1e3 * seen.offline_s, true}}};
}

void unplug_again_and_again(const RunSettings& settings, const std::string& which, const Condition& condition,
                            Findings& findings) {
  double event_s = 0, quiet_s = 0, offline_s = 0, way_rad = 0;
  int told = 0;
  for (int i = 0; i < settings.repetitions; ++i) {
    RunSettings one = settings;
    one.seed = settings.seed + static_cast<std::uint64_t>(i);
    Unplugging seen = unplug(one, which, condition.hand, condition.after_s + i * condition.spread_s);
    event_s = std::max(event_s, seen.event_s);
    quiet_s = std::max(quiet_s, which == "robot" ? seen.display_zero_s : seen.torque_off_s);
    offline_s = std::max(offline_s, seen.offline_s);
    way_rad = std::max(way_rad, seen.way_rad);
    told += seen.told ? 1 : 0;
    if (i == 0 && condition.plotted) findings.plots.push_back(plot_of(which, seen));
  }
  const std::string prefix = fmt::format("RO9-{}-{}-", which, condition.name);
  findings.figures[prefix + "event"] = event_s * 1e3;
  findings.figures[prefix + (which == "robot" ? "display" : "torque")] = quiet_s * 1e3;
  findings.figures[prefix + "offline"] = offline_s;
  findings.figures[prefix + "told"] = static_cast<double>(told) / settings.repetitions;
  findings.notes.push_back(
      fmt::format("{} unplugged, {}: {} times; without torque and brakes the joints coast by at most {:.0f} mrad.",
                  which, condition.name, settings.repetitions, way_rad * 1e3));
}

// --- RO10 --------------------------------------------------------------------------------------------------------------

/// Compares what a consumer of a link works on with what its producer had some cycles before. A link that is whole, without
/// gaps and of constant delay has one delay without a mismatch; a torn, lost or doubled sample is a mismatch in all.
class LinkCheck {
 public:
  /// `offset`: the consumer adds a constant of its own (the clutch).
  explicit LinkCheck(bool offset) : offset_{offset} {}

  void produced(const Vec2& value) {
    std::ranges::rotate(history_, history_.end() - 1);
    history_[0] = value;
    ++produced_;
  }
  /// The value that the consumer works on, in the producer's units.
  void consumed(const Vec2& value) {
    if (produced_ < delays) return;
    for (std::size_t delay = 0; delay < delays; ++delay) {
      const Vec2 difference = value - history_[delay];
      if (samples_ == 0 && offset_) constant_[delay] = difference;
      const Vec2 rest = difference - constant_[delay];
      if (std::max(std::abs(rest[0]), std::abs(rest[1])) > rounding) ++mismatches_[delay];
    }
    ++samples_;
  }
  [[nodiscard]] double mismatches() const { return static_cast<double>(*std::ranges::min_element(mismatches_)); }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }

 private:
  static constexpr std::size_t delays = 6;
  static constexpr double rounding = 1e-12;
  bool offset_;
  std::array<Vec2, delays> history_{};
  std::array<Vec2, delays> constant_{};
  std::array<std::uint64_t, delays> mismatches_{};
  std::uint64_t produced_{0};
  std::uint64_t samples_{0};
};

}  // namespace

Findings fly_unplugging(const RunSettings& settings) {
  constexpr Condition in_free_motion{"free", "sine 1 0.15 0.5", 2.0, 0.1, false};
  constexpr Condition in_contact{"contact", "cartesian 0.0226 0 1", 1.2, 0.037, true};
  Findings findings;
  for (const char* which : {"joystick", "robot"})
    for (const Condition& condition : {in_free_motion, in_contact})
      unplug_again_and_again(settings, which, condition, findings);
  return findings;
}

Findings fly_endurance(const RunSettings& settings) {
  constexpr double force_scale = 0.02;  // of the note
  CraftOptions options = craft_options(settings);
  options.hand_of_mission = true;
  options.cycles_per_report = 0;
  CoupledCraft craft{options};
  LinkCheck to_joystick{false}, to_manipulator{true};
  double contact_cycles = 0;
  craft.each_cycle([&] {
    to_joystick.consumed(-1 / force_scale * craft.felt_n_m());
    to_joystick.produced(craft.arm().joint_torque_n_m());
    to_manipulator.produced(craft.joystick().handle().angle_rad());
    if (craft.arm().contact().normal_force_n > 0) ++contact_cycles;
  });
  double last_report_s = craft.time_s(), longest_silence_s = 0;
  craft.on_report = [&] {
    longest_silence_s = std::max(longest_silence_s, craft.time_s() - last_report_s);
    last_report_s = craft.time_s();
    to_manipulator.consumed(craft.report().desired_rad);
  };
  const std::uint64_t cycles_before = craft.flight().cycles("JOYSTICK");
  craft.run(settings.endurance_s);
  const auto cycles = static_cast<double>(craft.flight().cycles("JOYSTICK") - cycles_before);
  double received = 0, lost = craft.incoming().size() == 2 ? 0 : never;
  for (const auto& [apid, link] : craft.incoming()) {
    received += link.received;
    lost += link.lost;
  }
  Findings findings;
  const Story& story = craft.flight().story();
  findings.figures = {
      {"RO10-torque-mismatches", to_joystick.mismatches()},
      {"RO10-angle-mismatches", to_manipulator.mismatches()},
      {"RO10-received", received / cycles / 2},
      {"RO10-lost", lost},
      {"RO10-missing-cycles", settings.endurance_s / CoupledCraft::period_s - cycles},
      {"RO10-report-silence", longest_silence_s * 1e3},
      {"RO10-reactions", static_cast<double>(story.count("plan ") + story.count(" high ") + story.count(" medium "))}};
  findings.notes.push_back(fmt::format(
      "{:.0f} cycles of 0.5 ms; {} samples of the torque and {} of the handle compared with what was sent; in contact "
      "{:.0f} % of the time.",
      cycles, to_joystick.samples(), to_manipulator.samples(), 100 * contact_cycles / cycles));
  if (to_joystick.samples() + 10 < static_cast<std::uint64_t>(cycles))
    findings.problems.emplace_back("not every sample was compared");
  return findings;
}

}  // namespace hirosco::simulation
