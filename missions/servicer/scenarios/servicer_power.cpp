// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/servicer/scenarios/servicer_power.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

/// SV9: whether the sun suffices for the arm, and what becomes of a motion when it goes.
namespace hirosco::simulation {
namespace {

constexpr double not_yet = std::numeric_limits<double>::infinity();

void shine(ServicerCraft& craft, const Light& light) {
  auto& unit = craft.flight().device<SimulatedDevice>("power");
  for (const std::string& line :
       {fmt::format("sun_angle {}", light.sun_angle_deg), fmt::format("charge {}", light.charge),
        fmt::format("eclipse {}", light.eclipse ? "on" : "off")})
    if (!unit.fault(line)) throw std::runtime_error{"no such line: " + line};
  // Each half second the budget is told.
  constexpr double until_told_s = 1;
  craft.run(until_told_s);
}

[[nodiscard]] double apart_m(const ServicerCraft::Place& one, const ServicerCraft::Place& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

}  // namespace

Grant ask_for_track(ServicerCraft& craft, const Light& light) {
  shine(craft, light);
  const Story& story = craft.flight().story();
  const std::size_t before = story.lines().size();
  if (craft.flight().set_mode("track").completed) return {.granted = true};
  constexpr std::string_view reason = "MCS needs 260 W, ";
  const auto refusal = story.find(reason, before);
  if (!refusal) return {};
  const std::string& line = story.lines()[*refusal].text;
  return {.free_w = std::strtod(line.c_str() + line.find(reason) + reason.size(), nullptr)};
}

Brake eclipse_in_motion(ServicerCraft& craft, double after_s) {
  const double begun_s = craft.begin("MOVE_TOOL", {0.2, 0.0, 0.0, 20.0});
  constexpr double h_s = 0.01;
  craft.run(begun_s + after_s - h_s - craft.time_s());
  const auto before = craft.tool_m();
  craft.run(h_s);
  const auto then = craft.tool_m();
  Brake seen{.told_s = not_yet, .rest_s = not_yet, .speed_m_s = apart_m(then, before) / h_s};
  const double gone_s = craft.time_s();
  craft.flight().story().on_line = [&](std::string_view line) {
    if (seen.told_s == not_yet && line.find("BUS_LOW") != line.npos) seen.told_s = craft.time_s() - gone_s;
  };
  if (!craft.flight().device<SimulatedDevice>("power").fault("eclipse on")) throw std::runtime_error{"no eclipse"};
  constexpr double rests_rad_s = 1e-4;
  for (int i = 0; i < 1500; ++i) {
    craft.run(1e-3);
    if (craft.fastest_joint_rad_s() >= rests_rad_s) seen.rest_s = not_yet;
    else if (seen.rest_s == not_yet) seen.rest_s = craft.time_s() - gone_s;
    seen.farthest_m = std::max(seen.farthest_m, apart_m(craft.tool_m(), then));
  }
  craft.flight().story().on_line = {};
  return seen;
}

Findings fly_power(const ServicerSettings& settings) {
  Findings findings;
  ServicerCraft craft{{.mission = settings.mission, .seed = settings.seed, .mode = "coast"}};
  const auto ask = [&](const char* name, const Light& light) {
    const Grant answer = ask_for_track(craft, light);
    findings.figures[fmt::format("SV9-granted-{}", name)] = answer.granted ? 1 : 0;
    if (answer.granted && !craft.flight().set_mode("coast").completed) throw std::runtime_error{"not back in coast"};
    return answer;
  };
  constexpr double low = 0.35;
  ask("69", {.sun_angle_deg = 69});
  findings.figures["SV9-free-70-w"] = ask("70", {.sun_angle_deg = 70}).free_w;
  ask("59-low", {.sun_angle_deg = 59, .charge = low});
  findings.figures["SV9-free-60-w"] = ask("60-low", {.sun_angle_deg = 60, .charge = low}).free_w;
  ask("eclipse", {.eclipse = true});
  if (!ask_for_track(craft, {}).granted)
    throw std::runtime_error{"no track in full sun\n" + craft.flight().story().text()};
  constexpr double after_s = 8;
  const Brake seen = eclipse_in_motion(craft, after_s);
  findings.figures["SV9-told-ms"] = 1e3 * seen.told_s;
  findings.figures["SV9-rest-s"] = seen.rest_s;
  findings.figures["SV9-beyond-mm"] = 1e3 * (seen.farthest_m - 0.5 * seen.speed_m_s);
  Flight& flight = craft.flight();
  const bool safe = flight.state("MCS") == State::SafeOperational && flight.state("AOCS") == State::Operational &&
                    flight.state("POWER") == State::Operational && flight.state("COMMUNICATION") == State::Operational;
  findings.figures["SV9-safe"] = safe ? 1 : 0;
  findings.figures["SV9-again"] = flight.set_mode("track").completed ? 1 : 0;
  findings.notes.push_back(
      fmt::format("When the sun went the tool went at {:.1f} mm/s; it stood {:.2f} mm farther on. The station is kept "
                  "again by mode coast.",
                  1e3 * seen.speed_m_s, 1e3 * seen.farthest_m));
  return findings;
}

}  // namespace hirosco::simulation
