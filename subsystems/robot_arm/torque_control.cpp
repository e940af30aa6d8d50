// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/torque_control.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "robotics/motion/sampled_rates.hpp"

namespace hirosco::robot_arm {

Result<> TorqueControl::begin(double cycle_s) {
  HIROSCO_TRY(robotics::check_cycle(cycle_s));
  laws_.emplace(parts_.known.model(), parts_.known.tip(), cycle_s);
  fastest_rad_s_ = robotics::fastest_rad_s(cycle_s);
  const double wanted = parts_.parameters.bandwidth_rad_s.load();
  if (wanted > fastest_rad_s_)
    fmt::print(
        stderr,
        "BANDWIDTH is {:.3g} rad/s; with cycles of {:.3g} ms {:.3g} are in force, the most that leaves it stable\n",
        wanted, 1e3 * cycle_s, fastest_rad_s_);
  parts_.parameters.bandwidth_in_force.store(bandwidth_rad_s());
  return ok();
}

double TorqueControl::bandwidth_rad_s() const noexcept {
  return std::min(parts_.parameters.bandwidth_rad_s.load(), fastest_rad_s_);
}

Laws::Settings TorqueControl::settings() noexcept {
  const Parameters& values = parts_.parameters;
  const auto gravity = values.gravity_m_s2.load();
  rotor_ = values.rotor_inertia.load();
  return {.position = {.bandwidth_rad_s = bandwidth_rad_s(),
                       .rotor = rotor_,
                       .gravity_m_s2 = {gravity[0], gravity[1], gravity[2]}},
          .float_damping_per_s = values.float_damping.load(),
          .lever = &parts_.model.lever(),
          .work = parts_.limits.work_limits()};
}

void TorqueControl::control() noexcept {
  const Setpoint& wanted = parts_.guidance.setpoints().now();
  parts_.parameters.desired_position.store(joints_of(wanted.position));
  parts_.parameters.desired_velocity.store(joints_of(wanted.velocity));
  parts_.drives.put_out(joints_of(laws_->torque(wanted, parts_.drives.measured(), parts_.model.dynamics(),
                                                parts_.model.payload(), parts_.known.bounds(), settings())));
  parts_.parameters.bandwidth_in_force.store(bandwidth_rad_s());
  const Impedance& impedance = laws_->impedance();
  parts_.parameters.law.store(
      {static_cast<std::uint8_t>(laws_->kind()), impedance.tool_n_m, impedance.tool_n_m_rad, impedance.damping_ratio});
  parts_.parameters.joint_stiffness.store(joints_of(impedance.joint_n_m_rad));
}

}  // namespace hirosco::robot_arm
