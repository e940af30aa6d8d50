// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// FC1 to FC9 and FC13: every fault case again and again at instants that the seed chooses, in motion and in contact. Deadlines
// are counted in cycles of the member that acts, from the fault on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/rokviss.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {
namespace {

/// What must come to rest.
enum class Rest : std::uint8_t { Robot, Hand };
/// How it must end.
/// A process that hangs cannot say Offline: its device has let go and its epoch is fenced.
enum class End : std::uint8_t { GoesOn, RobotSafe, BothSafe, RobotOffline, NetworkOffline };

struct Case {
  std::string_view name;
  std::string_view event;  ///< beginning of the line that tells of it
  std::string_view teller;  ///< whose cycles count until the event
  Rest rest;
  End end;
  void (*inject)(CoupledCraft&, Random&);
  std::string_view begin{};  ///< of the line from which on cycles count; empty = from the injection on
};

void inject_fault(CoupledCraft& craft, std::string_view device, const std::string& line) {
  if (!craft.craft().device(device)->fault(line)) throw std::runtime_error{"the device does not take '" + line + "'"};
}
std::string joint(Random& random) { return random.uniform() < 0.5 ? "1" : "2"; }

/// Stands still for fewer cycles than a hang has, then goes on.
void make_stale(CoupledCraft& craft, Random& random) {
  craft.craft().stop("JOYSTICK", true);
  craft.run(random.uniform(0.0035, 0.0075));
  craft.craft().stop("JOYSTICK", false);
}

/// Works for longer than its period of 0.5 ms, for a while.
void make_overrun(CoupledCraft& craft, Random& random) {
  constexpr int cycles = 20;
  craft.craft().strain("MANIPULATOR", cycles, std::chrono::microseconds{static_cast<int>(random.uniform(550, 950))});
}

constexpr std::array cases{
    Case{"1-limit", "MANIPULATOR medium TORQUE_LIMIT_EXCEEDED", "MANIPULATOR", Rest::Robot, End::RobotSafe, nullptr},
    Case{"2-warning", "MANIPULATOR low TEMPERATURE_WARNING", "MANIPULATOR", Rest::Robot, End::GoesOn,
         [](CoupledCraft& craft, Random& random) {
           inject_fault(craft, "robot", "temperature " + joint(random) + " 56");
         }},
    Case{"2-critical", "MANIPULATOR medium TEMPERATURE_CRITICAL", "MANIPULATOR", Rest::Robot, End::RobotSafe,
         [](CoupledCraft& craft, Random& random) {
           inject_fault(craft, "robot", "temperature " + joint(random) + " 71");
         }},
    Case{"2-maximum", "MANIPULATOR high TEMPERATURE_MAXIMUM", "MANIPULATOR", Rest::Robot, End::NetworkOffline,
         [](CoupledCraft& craft, Random& random) {
           inject_fault(craft, "robot", "temperature " + joint(random) + " 81");
         }},
    Case{"3-unplug", "JOYSTICK high JOYSTICK_LOST", "JOYSTICK", Rest::Robot, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { inject_fault(craft, "joystick", "unplug"); }},
    Case{"3-silent", "JOYSTICK high JOYSTICK_LOST", "JOYSTICK", Rest::Robot, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { inject_fault(craft, "joystick", "silent"); }},
    Case{"4-unplug", "MANIPULATOR high ROBOT_LOST", "MANIPULATOR", Rest::Hand, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { inject_fault(craft, "robot", "unplug"); }},
    Case{"4-garbled", "MANIPULATOR high ROBOT_LOST", "MANIPULATOR", Rest::Hand, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { inject_fault(craft, "robot", "corrupt 1000000"); }},
    Case{"5-joystick", "JOYSTICK died", "MANIPULATOR", Rest::Robot, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { craft.craft().kill("JOYSTICK"); }},
    Case{"5-robot", "MANIPULATOR died", "JOYSTICK", Rest::Hand, End::NetworkOffline,
         [](CoupledCraft& craft, Random&) { craft.craft().kill("MANIPULATOR"); }},
    Case{"6-hang", "JOYSTICK hangs", "MANIPULATOR", Rest::Robot, End::RobotOffline,
         [](CoupledCraft& craft, Random&) { craft.craft().stop("JOYSTICK", true); }},
    Case{"6-overruns", "MANIPULATOR medium CYCLE_OVERRUNS", "MANIPULATOR", Rest::Robot, End::RobotSafe, make_overrun},
    Case{"7-stale", "MANIPULATOR medium JOYSTICK_STATE_STALE", "MANIPULATOR", Rest::Robot, End::RobotSafe, make_stale},
    // 105 W are reserved in telepresence: less than a tenth above that, then less than that.
    Case{"9-low", "SUPERVISOR medium POWER_LOW", "MANIPULATOR", Rest::Robot, End::BothSafe,
         [](CoupledCraft& craft, Random& random) {
           craft.command("SUPERVISOR", "SET_POWER_BUDGET", {random.uniform(105.1, 116.6)});
         },
         "power budget "},
    Case{"9-shed", "SUPERVISOR high LOAD_SHED", "MANIPULATOR", Rest::Robot, End::NetworkOffline,
         [](CoupledCraft& craft, Random& random) {
           craft.command("SUPERVISOR", "SET_POWER_BUDGET", {random.uniform(25, 104.9)});
         },
         "power budget "},
};

/// Cycles of the members since the fault, and when what happened in them; infinite for what never did.
struct Seen {
  bool counting{false};
  double robot_cycles{0}, hand_cycles{0};
  double event{never}, rest{never}, end_s{never};
  double fault_s{0};
};

void motion(CoupledCraft& craft, Random& random, bool to_the_limit) {
  if (to_the_limit) return craft.hand(fmt::format("ramp 0.065 0 {:.4f}", random.uniform(0.03, 0.05)));
  if (random.uniform() < 0.5) craft.hand(fmt::format("sine 1 0.15 {:.3f}", random.uniform(0.2, 0.8)));
  else craft.hand("cartesian 0.0226 0 0.7");
  // Anywhere in a cycle, not at its instant only.
  craft.run(random.uniform(1.0, 2.0));
}

void watch(CoupledCraft& craft, const Case& what, std::string_view member, Seen& seen) {
  if (what.inject == nullptr && !seen.counting) {
    seen.counting = member == "MANIPULATOR" && std::abs(craft.arm().joint_torque_n_m()[1]) > 12;
    seen.fault_s = craft.time_s();
  } else if (seen.counting) ++(member == "MANIPULATOR" ? seen.robot_cycles : seen.hand_cycles);
  if (!seen.counting) return;
  const bool robot = what.rest == Rest::Robot;
  const bool rests = robot ? !craft.robot().active() : craft.felt_n_m() == Vec2{};
  if (rests) seen.rest = std::min(seen.rest, robot ? seen.robot_cycles : seen.hand_cycles);
}

bool ended(CoupledCraft& craft, End end) {
  Flight& flight = craft.flight();
  const State robot = flight.state("MANIPULATOR"), hand = flight.state("JOYSTICK");
  switch (end) {
    case End::GoesOn: return robot == State::Operational && hand == State::Operational;
    case End::RobotSafe: return robot == State::SafeOperational && hand == State::Operational;
    case End::BothSafe: return robot == State::SafeOperational && hand == State::SafeOperational;
    case End::RobotOffline: return robot == State::Offline && !craft.joystick().active();
    case End::NetworkOffline: return robot == State::Offline && hand == State::Offline;
  }
  return false;
}

Seen suffer(const RunSettings& settings, const Case& what, std::uint64_t seed) {
  RunSettings own = settings;
  own.seed = seed;
  Random random{seed};
  CoupledCraft craft{craft_options(own)};
  Seen seen;
  motion(craft, random, what.inject == nullptr);
  craft.flight().story().on_line = [&](std::string_view line) {
    if (!what.begin.empty() && !seen.counting && line.starts_with(what.begin)) {
      seen.counting = true;
      seen.fault_s = craft.time_s();
    }
    if (seen.counting && line.starts_with(what.event))
      seen.event = std::min(seen.event, what.teller == "MANIPULATOR" ? seen.robot_cycles : seen.hand_cycles);
  };
  craft.craft().on_cycle([&](std::string_view member, TimePoint) { watch(craft, what, member, seen); });
  seen.fault_s = craft.time_s();
  seen.counting = what.inject != nullptr && what.begin.empty();
  if (what.inject != nullptr) what.inject(craft, random);
  if (what.end == End::GoesOn) craft.run(0.3);
  if (craft.craft().run_until([&] { return ended(craft, what.end); }, 4s)) seen.end_s = craft.time_s() - seen.fault_s;
  if (what.end == End::RobotSafe || what.end == End::BothSafe) {
    craft.run(0.3);
    if (!ended(craft, what.end)) seen.end_s = never;  // and stays there
  }
  return seen;
}

void repeat(const RunSettings& settings, const Case& what, Findings& findings) {
  Seen worst{.event = 0, .rest = 0, .end_s = 0};
  std::array<double, 2> earliest{never, never};
  for (int i = 0; i < settings.repetitions; ++i) {
    const Seen seen = suffer(settings, what, settings.seed * 1'000 + static_cast<std::uint64_t>(i));
    worst.event = std::max(worst.event, seen.event);
    worst.rest = std::max(worst.rest, seen.rest);
    worst.end_s = std::max(worst.end_s, seen.end_s);
    earliest[0] = std::min(earliest[0], seen.event);
    earliest[1] = std::min(earliest[1], seen.rest);
  }
  const std::string prefix = fmt::format("FC-{}-", what.name);
  findings.figures[prefix + "event"] = worst.event;
  if (what.end == End::GoesOn) {
    findings.figures[prefix + "goes-on"] = std::isfinite(worst.end_s) ? 1 : 0;
  } else {
    findings.figures[prefix + "rest"] = worst.rest;
    findings.figures[prefix + "end"] = worst.end_s * 1e3;
  }
  findings.notes.push_back(fmt::format(
      "FC{}: told in cycle {:g} to {:g}{}", what.name, earliest[0], worst.event,
      what.end == End::GoesOn ? "" : fmt::format(", at rest in cycle {:g} to {:g}", earliest[1], worst.rest)));
}

}  // namespace

Findings fly_faults(const RunSettings& settings) {
  Findings findings;
  for (const Case& what : cases) repeat(settings, what, findings);
  fly_fault_procedures(settings, findings);
  findings.notes.push_back(
      fmt::format("{} repetitions of each, seeds {} and up; cycles of whoever acts: 0.5 ms, on ground's way 2 ms, the "
                  "supervisor's 10 ms.",
                  settings.repetitions, settings.seed * 1'000));
  return findings;
}

}  // namespace hirosco::simulation
