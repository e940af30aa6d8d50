// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Fault cases that take more than one step: a process that hangs and goes on (FC6), a lost ground link (FC8), a
// manipulator that the power does not suffice for (FC9), a report that changes nothing (FC13).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "missions/rokviss/scenarios/rokviss.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {
namespace {

/// One repetition each: seeds as those of the other fault cases.
template <class Repetition>
void repeat(const RunSettings& settings, const Repetition& repetition) {
  for (int i = 0; i < settings.repetitions; ++i) {
    const std::uint64_t seed = settings.seed * 1'000 + static_cast<std::uint64_t>(i);
    repetition(seed, Random{seed});
  }
}

CraftOptions options(const RunSettings& settings, std::uint64_t seed, const char* mode) {
  CraftOptions made = craft_options(settings);
  made.seed = seed;
  made.start_mode = mode;
  return made;
}

/// Puts into `cycles` how many cycles of `member` after this moment a line that begins with `what` is told; `never` before.
void measure_until(Flight& flight, std::string_view member, std::string_view what, double& cycles) {
  cycles = never;
  flight.story().on_line = [&flight, &cycles, member, what, since = flight.cycles(member)](std::string_view line) {
    if (line.starts_with(what)) cycles = static_cast<double>(flight.cycles(member) - since);
  };
}

// --- FC6 ---------------------------------------------------------------------------------------------------------------

/// Stopped for longer than a hang takes, then continued: it must find itself fenced.
void continue_a_hung_joystick(const RunSettings& settings, Findings& findings) {
  double active_cycles = 0, end_s = 0;
  repeat(settings, [&](std::uint64_t seed, Random random) {
    CoupledCraft craft{options(settings, seed, "")};
    craft.hand("sine 1 0.15 0.5");
    craft.run(random.uniform(1.0, 2.0));
    craft.craft().stop("JOYSTICK", true);
    craft.run(random.uniform(0.3, 1.5));
    if (!craft.flight().story().has("JOYSTICK hangs")) findings.problems.emplace_back("a hang was not found");
    double active = 0;
    craft.craft().on_cycle([&](std::string_view member, TimePoint) {
      if (member == "JOYSTICK" && (craft.joystick().active() || craft.felt_n_m() != Vec2{})) ++active;
    });
    craft.craft().stop("JOYSTICK", false);
    const double continued_s = craft.time_s();
    const bool ended = craft.craft().run_until(
        [&] {
          return craft.flight().state("MANIPULATOR") == State::Offline &&
                 craft.flight().state("JOYSTICK") == State::Offline;
        },
        4s);
    active_cycles = std::max(active_cycles, active);
    end_s = std::max(end_s, ended ? craft.time_s() - continued_s : never);
  });
  findings.figures["FC-6-continued-active"] = active_cycles;
  findings.figures["FC-6-continued-end"] = end_s * 1e3;
}

// --- FC8 ---------------------------------------------------------------------------------------------------------------

/// With the joystick on ground every sample is lost from some instant on: the robot holds, ground is told after 2 s.
void lose_the_ground_link(const RunSettings& settings, Findings& findings) {
  double event_cycles = 0, way_rad = 0;
  int held = 0;
  repeat(settings, [&](std::uint64_t seed, Random random) {
    CoupledCraft craft{options(settings, seed, "remote")};
    Flight& flight = craft.flight();
    craft.hand("sine 1 0.1 0.5");
    craft.run(random.uniform(0.5, 1.5));
    craft.command("COMMUNICATION", "SET_DELAY", {20, 1});
    double event = never;
    measure_until(flight, "COMMUNICATION", "COMMUNICATION medium GROUND_LINK_LOST", event);
    craft.run(1.0);
    const Vec2 q = craft.arm().state().link_rad;
    craft.run(1.5);
    const Vec2 now = craft.arm().state().link_rad;
    way_rad = std::max({way_rad, std::abs(now[0] - q[0]), std::abs(now[1] - q[1])});
    event_cycles = std::max(event_cycles, event);
    if (flight.state("MANIPULATOR") == State::Operational && flight.state("JOYSTICK") == State::Operational) ++held;
  });
  findings.figures["FC-8-ground-event"] = event_cycles;
  findings.figures["FC-8-ground-way"] = way_rad * 1e3;
  findings.figures["FC-8-ground-holds"] = static_cast<double>(held) / settings.repetitions;
}

// --- FC9 ---------------------------------------------------------------------------------------------------------------

/// What the mission's descriptors say of the configurations that mode standalone commissions.
struct Demand {
  double others_w{0};
  double robot_w{0};
};

Demand demand_of(const descriptor::Mission& mission) {
  Demand demand{.others_w = mission.supervisor.configurations.front().power_w};
  for (const descriptor::CommissionStep& step : mission.find_mode("standalone")->commission) {
    const double watts =
        mission.find_subsystem(step.subsystem)->subsystem.find_configuration(step.configuration)->power_w;
    (step.subsystem == "MANIPULATOR" ? demand.robot_w : demand.others_w) += watts;
  }
  return demand;
}

/// What came of asking for the manipulator while the power does not suffice, and again when it does.
struct Asked {
  bool refused{false};
  bool numbers{false};
  double event_cycles{never};  ///< of the supervisor, from the refusal to the event
  bool granted_later{false};
};

Asked ask_for_the_robot(CoupledCraft& craft, Random& random) {
  Flight& flight = craft.flight();
  static_cast<void>(flight.set_mode("commissioning"));
  for (const State down : {State::SafeOperational, State::PostOperational, State::PreOperational})
    static_cast<void>(flight.set_state("MANIPULATOR", down));
  static_cast<void>(flight.configure("MANIPULATOR", "STANDALONE"));
  const Demand demand = demand_of(flight.mission());
  // Whole milliwatts, as the ledger keeps them, so that the texts below are what is told.
  const double budget_w = std::round(random.uniform(demand.others_w, demand.others_w + demand.robot_w) * 10) / 10 - 0.1;
  craft.command("SUPERVISOR", "SET_POWER_BUDGET", {std::max(budget_w, demand.others_w)});
  const double told_w = std::max(budget_w, demand.others_w);
  const auto cycles = [&] { return craft.craft().supervisor().own_statistics().cycles; };
  std::uint64_t refused_at = 0;
  Asked asked;
  const std::string numbers =
      fmt::format("BUDGET={:g} W RESERVED={:g} W REQUESTED={:g} W", told_w, demand.others_w, demand.robot_w);
  flight.story().on_line = [&](std::string_view line) {
    if (line.starts_with("power short: MANIPULATOR")) refused_at = cycles();
    if (!line.starts_with("SUPERVISOR low POWER_REFUSED")) return;
    asked.event_cycles = static_cast<double>(cycles() - refused_at);
    asked.numbers = line.find(numbers) != line.npos;
  };
  asked.refused = flight.set_state("MANIPULATOR", State::SafeOperational).failure == pus::FailureCode::PowerShort;
  craft.run(0.05);
  flight.story().on_line = nullptr;
  craft.command("SUPERVISOR", "SET_POWER_BUDGET", {demand.others_w + demand.robot_w});
  asked.granted_later = flight.set_state("MANIPULATOR", State::SafeOperational).completed;
  return asked;
}

void refuse_the_manipulator(const RunSettings& settings, Findings& findings) {
  double event_cycles = 0;
  int refused = 0, numbers = 0, granted = 0;
  repeat(settings, [&](std::uint64_t seed, Random random) {
    CoupledCraft craft{options(settings, seed, "standalone")};
    craft.run(random.uniform(0.1, 0.3));
    const Asked asked = ask_for_the_robot(craft, random);
    refused += asked.refused ? 1 : 0;
    numbers += asked.numbers ? 1 : 0;
    granted += asked.granted_later ? 1 : 0;
    event_cycles = std::max(event_cycles, asked.event_cycles);
  });
  const double all = settings.repetitions;
  findings.figures["FC-9-refused"] = refused / all;
  findings.figures["FC-9-refused-numbers"] = numbers / all;
  findings.figures["FC-9-refused-event"] = event_cycles;
  findings.figures["FC-9-refused-granted"] = granted / all;
}

// --- FC13 --------------------------------------------------------------------------------------------------------------

/// A spring asked for that the pressing finger is far from: low, so it is told and nothing else happens.
void ask_for_a_distant_spring(const RunSettings& settings, Findings& findings) {
  double event_cycles = 0;
  int undisturbed = 0;
  repeat(settings, [&](std::uint64_t seed, Random random) {
    CoupledCraft craft{options(settings, seed, "")};
    Flight& flight = craft.flight();
    craft.hand("cartesian 0.0226 0 0.5");
    craft.run(random.uniform(0.7, 1.7));
    double event = never;
    measure_until(flight, "MANIPULATOR", "MANIPULATOR low SPRING_OUT_OF_REACH", event);
    static_cast<void>(craft.craft().command("MANIPULATOR", "HOOK_SPRING", {1}));
    craft.run(0.3);
    event_cycles = std::max(event_cycles, event);
    if (!flight.story().has("plan ") && craft.robot().active() && craft.joystick().active()) ++undisturbed;
  });
  findings.figures["FC-13-low-event"] = event_cycles;
  findings.figures["FC-13-low-goes-on"] = static_cast<double>(undisturbed) / settings.repetitions;
}

}  // namespace

void fly_fault_procedures(const RunSettings& settings, Findings& findings) {
  continue_a_hung_joystick(settings, findings);
  lose_the_ground_link(settings, findings);
  refuse_the_manipulator(settings, findings);
  ask_for_a_distant_spring(settings, findings);
}

}  // namespace hirosco::simulation
