// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/coupled_craft.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::uint16_t manipulator_apid = 10;
constexpr std::uint16_t cycle_report = 4713, manipulator_links = 4714, joystick_links = 4723;

ArmParameters arm_of(const CraftOptions& options) {
  const Plant& plant = options.plant;
  ArmParameters arm;
  arm.contour.bump_height_m = options.bump_m;
  arm.joint.stiffness_n_m_per_rad *= plant.stiffness;
  arm.contour.stiffness_n_per_m *= plant.rail;
  arm.largest_sub_step = std::chrono::duration_cast<Duration>(
      plant.sub_step * std::chrono::duration<double, std::nano>{arm.largest_sub_step});
  for (LinkParameters& link : arm.links) {
    link.mass_kg *= plant.mass;
    link.inertia_kg_m2 *= plant.mass;
  }
  return arm;
}

/// Initial values of the dictionary and those that configurations set over them.
void each_initial(descriptor::Mission& mission, const std::function<void(std::string, std::vector<Value>&)>& visit) {
  for (auto& member : mission.subsystems) {
    const std::string owner = member.subsystem.name + ".";
    for (auto& parameter : member.subsystem.parameters) visit(owner + parameter.field.name, parameter.init);
    for (auto& configuration : member.subsystem.configurations)
      for (auto& initial : configuration.initial) visit(owner + initial.parameter.text, initial.values);
  }
}

void edit(descriptor::Mission& mission, const CraftOptions& options) {
  if (!options.hand_of_mission) hand_rests(mission);
  if (!options.start_mode.empty()) mission.start_mode = options.start_mode;
  each_initial(mission, [&](const std::string& name, std::vector<Value>& init) {
    if (const auto value = options.initial.find(name); value != options.initial.end()) init = {Number{value->second}};
    if (name == "JOYSTICK.FORCE_SCALE" && !init.empty())
      init[0] = Number{std::get<Number>(init[0]).real() * options.plant.force_scale};
  });
  if (options.cycles_per_report == 0) return;
  for (auto& member : mission.subsystems)
    for (auto& configuration : member.subsystem.configurations)
      for (auto& structure : configuration.housekeeping)
        if (structure.id == cycle_report) structure.interval_cycles = options.cycles_per_report;
}

}  // namespace

Plan CoupledCraft::plan_of(const CraftOptions& options) {
  Plan plan;
  plan.mission = options.mission;
  plan.seed = options.seed;
  plan.edit = [&options](descriptor::Mission& mission) { edit(mission, options); };
  plan.devices["hirosco-sim-robot"] = [arm = arm_of(options)](FlowFactory& flows, const FlowAddress& address,
                                                              const SimulatedDevice::Settings& settings) {
    return std::make_unique<RobotDevice>(flows, address, settings, arm);
  };
  plan.devices["hirosco-sim-joystick"] = [clock = options.plant.hand_clock](FlowFactory& flows,
                                                                            const FlowAddress& address,
                                                                            SimulatedDevice::Settings settings) {
    settings.clock = clock;
    return std::make_unique<JoystickDevice>(flows, address, settings);
  };
  return plan;
}

CoupledCraft::CoupledCraft(const CraftOptions& options) : flight_{plan_of(options)} {
  if (!flight_.commission()) throw std::runtime_error{"not commissioned:\n" + flight_.story().text()};
  robot_ = &flight_.device<RobotDevice>("robot");
  joystick_ = &flight_.device<JoystickDevice>("joystick");
  if (!options.friction) robot_->arm().set_friction(false);
  flight_.story().on_telemetry = [this](const pus::TelemetryView& packet) { take(packet); };
  delay_joystick(options.plant.delay_ms);
  start_ = craft().now();
}

/// By a cycle at a time: the joystick must not seem silent.
void CoupledCraft::delay_joystick(double delay_ms) {
  constexpr double cycle_ms = 1e3 * period_s;
  for (double reached_ms = 0; reached_ms < delay_ms;) {
    reached_ms = std::min(reached_ms + cycle_ms, delay_ms);
    if (!joystick_->fault("delay " + std::to_string(reached_ms))) throw std::runtime_error{"no such delay"};
    run(10 * period_s);
  }
}

void CoupledCraft::hand(const std::string& line) {
  if (!joystick_->hand(line)) throw std::runtime_error{"the hand does not take '" + line + "'"};
}

void CoupledCraft::run(double seconds) { craft().run(Duration{std::llround(seconds * 1e9)}); }

void CoupledCraft::command(std::string_view subsystem, std::string_view function, const std::vector<Value>& arguments) {
  constexpr Duration limit = 60s;
  if (!craft().command(subsystem, function, arguments, limit).completed)
    throw std::runtime_error{"not completed: " + std::string{subsystem} + " " + std::string{function}};
}

void CoupledCraft::each_cycle(std::function<void()> watch) {
  craft().on_cycle([watch = std::move(watch)](std::string_view subsystem, TimePoint) {
    if (subsystem == "JOYSTICK") watch();
  });
}

void CoupledCraft::take(const pus::TelemetryView& packet) {
  if (packet.service() != 3 || packet.subtype() != 25) return;
  OctetReader reader{packet.source_data()};
  const auto structure = reader.get<std::uint16_t>();
  if (structure == manipulator_links || structure == joystick_links) {
    constexpr std::size_t octets_of_cycle_times = 2 * 16 * 4;
    static_cast<void>(reader.get(octets_of_cycle_times));
    const auto received = reader.get<std::uint32_t>();
    incoming_[packet.apid()] = {received, reader.get<std::uint32_t>()};
  }
  if (packet.apid() != manipulator_apid || structure != cycle_report) return;
  for (Vec2* values : {&report_.position_rad, &report_.torque_n_m, &report_.desired_rad})
    for (double& value : *values) value = reader.get<double>();
  if (on_report) on_report();
}

}  // namespace hirosco::simulation
