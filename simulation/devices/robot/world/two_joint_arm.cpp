// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/robot/world/two_joint_arm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hirosco::simulation {
namespace {

struct CurvePoint {
  double x, slope, curvature;        // x(y) of the contour's surface and its derivatives by y
};

CurvePoint contour_at(const ContourParameters& contour, double y) noexcept {
  const double across = y - contour.bump_y_m;
  if (std::abs(across) >= contour.bump_half_width_m) return {contour.rail_x_m, 0, 0};
  const double wave = std::numbers::pi / contour.bump_half_width_m;
  const double half = contour.bump_height_m / 2;
  return {contour.rail_x_m - half * (1 + std::cos(wave * across)), half * wave * std::sin(wave * across),
          half * wave * wave * std::cos(wave * across)};
}

/// y of the point of the contour nearest to `tip`: Newton's method, a fixed number of steps so that a cycle is bounded.
double foot_point(const ContourParameters& contour, const Vec2& tip) noexcept {
  double y = tip[1];
  for (int i = 0; i < 8; ++i) {
    const CurvePoint at = contour_at(contour, y);
    const double residual = (at.x - tip[0]) * at.slope + (y - tip[1]);
    if (residual == 0) break;  // at once where the rail is straight
    const double gradient = 1 + at.slope * at.slope + (at.x - tip[0]) * at.curvature;
    y -= residual / std::max(gradient, 0.1);
  }
  return y;
}

Mat2 mass_matrix(const ArmParameters& arm, const Vec2& q) noexcept {
  const auto& [one, two] = arm.links;
  const double coupling = two.mass_kg * one.length_m * two.com_m * std::cos(q[1]);
  const double outer = two.inertia_kg_m2 + two.mass_kg * two.com_m * two.com_m;
  const double inner =
      one.inertia_kg_m2 + one.mass_kg * one.com_m * one.com_m + two.mass_kg * one.length_m * one.length_m;
  return {{{inner + outer + 2 * coupling, outer + coupling}, {outer + coupling, outer}}};
}

Vec2 coriolis(const ArmParameters& arm, const Vec2& q, const Vec2& rate) noexcept {
  const auto& [one, two] = arm.links;
  const double h = two.mass_kg * one.length_m * two.com_m * std::sin(q[1]);
  return {-h * (2 * rate[0] + rate[1]) * rate[1], h * rate[0] * rate[0]};
}

Vec2 joint_torque(const JointParameters& joint, const Vec2& twist, const Vec2& twist_rate) noexcept {
  return joint.stiffness_n_m_per_rad * twist + joint.damping_n_m_s_per_rad * twist_rate;
}

double friction(const JointParameters& joint, double rate) noexcept {
  return joint.friction_viscous_n_m_s * rate + joint.friction_coulomb_n_m * std::tanh(rate / joint.friction_rate_rad_s);
}

double square(double x) noexcept { return x * x; }

}  // namespace

ArmParameters ArmParameters::without_friction() const noexcept {
  ArmParameters clean = *this;
  clean.joint.friction_viscous_n_m_s = 0;
  clean.joint.friction_coulomb_n_m = 0;
  clean.contour.friction = 0;
  return clean;
}

Placement placement_of(const ArmParameters& arm, const Vec2& q) noexcept {
  const double x1 = arm.links[0].length_m * std::cos(q[0]);
  const double y1 = arm.links[0].length_m * std::sin(q[0]);
  const double x2 = arm.links[1].length_m * std::cos(q[0] + q[1]);
  const double y2 = arm.links[1].length_m * std::sin(q[0] + q[1]);
  return {.tip_m = {x1 + x2, y1 + y2}, .jacobian = {{{-y1 - y2, -y2}, {x1 + x2, x2}}}};
}

Contact contact_at(const ContourParameters& contour, const Vec2& tip, const Vec2& velocity) noexcept {
  const double y = foot_point(contour, tip);
  const CurvePoint at = contour_at(contour, y);
  const double scale = 1 / magnitude({1.0, at.slope});
  const Vec2 normal{-scale, scale * at.slope};  // out of the rail, towards the arm
  const Vec2 tangent{scale * at.slope, scale};
  Contact contact;
  contact.penetration_m = contour.finger_radius_m - dot(tip - Vec2{at.x, y}, normal);
  if (contact.penetration_m <= 0) return contact;
  const double closing = -dot(velocity, normal);
  const double elastic = contour.stiffness_n_per_m * contact.penetration_m;
  contact.normal_force_n = std::max(0.0, elastic * (1 + contour.damping_s_per_m * closing));
  const double slip = std::tanh(dot(velocity, tangent) / contour.friction_speed_m_s);
  contact.force_n = contact.normal_force_n * normal - contour.friction * contact.normal_force_n * slip * tangent;
  return contact;
}

TwoJointArm::TwoJointArm(const ArmParameters& parameters) noexcept
    : made_{parameters},
      parameters_{parameters},
      state_{.motor_rad = parameters.home_rad, .motor_rad_s = {}, .link_rad = parameters.home_rad, .link_rad_s = {}},
      temperature_c_{parameters.thermal.ambient_c, parameters.thermal.ambient_c} {}

TwoJointArm::Numbers TwoJointArm::derivative(const Numbers& x, const Vec2& motor_torque_n_m) const noexcept {
  const Vec2 motor{x[0], x[1]};
  const Vec2 motor_rate{x[2], x[3]};
  const Vec2 link{x[4], x[5]};
  const Vec2 link_rate{x[6], x[7]};
  const JointParameters& joint = parameters_.joint;
  const Vec2 between = joint_torque(joint, motor - link, motor_rate - link_rate);
  const auto [tip, jacobian] = placement_of(parameters_, link);
  const Vec2 force = tip_force(tip, times(jacobian, link_rate));
  const Vec2 drive = between + transposed_times(jacobian, force) - coriolis(parameters_, link, link_rate);
  const Vec2 link_acceleration = solve(mass_matrix(parameters_, link), drive);
  Numbers rate{x[2], x[3], 0, 0, x[6], x[7], link_acceleration[0], link_acceleration[1]};
  for (std::size_t i = 0; i < 2; ++i)
    rate[2 + i] = (motor_torque_n_m[i] - between[i] - friction(joint, motor_rate[i])) / joint.motor_inertia_kg_m2;
  return rate;
}

void TwoJointArm::step(const Vec2& motor_torque_n_m, Duration span) noexcept {
  if (span <= Duration::zero()) return;
  const double limit = parameters_.joint.torque_max_n_m;
  const Vec2 applied{std::clamp(motor_torque_n_m[0], -limit, limit), std::clamp(motor_torque_n_m[1], -limit, limit)};
  const auto largest = parameters_.largest_sub_step;
  const auto sub_steps = (span + largest - Duration{1}) / largest;
  const double h = seconds(span) / static_cast<double>(sub_steps);
  Numbers x{state_.motor_rad[0], state_.motor_rad[1], state_.motor_rad_s[0], state_.motor_rad_s[1],
            state_.link_rad[0],  state_.link_rad[1],  state_.link_rad_s[0],  state_.link_rad_s[1]};
  for (std::int64_t i = 0; i < sub_steps; ++i) {
    const int pieces = pieces_of(x, h);
    for (int piece = 0; piece < pieces; ++piece)
      x = runge_kutta_4(x, h / pieces, [&](const Numbers& at) { return derivative(at, applied); });
  }
  state_ = {{x[0], x[1]}, {x[2], x[3]}, {x[4], x[5]}, {x[6], x[7]}};
  heat(applied, seconds(span));
}

/// Friction of a pressed finger is the stiffest part: near rest it damps the sliding motion at a rate of mu N / (v0 m), m
/// the mass of the arm as felt along the rail. A step has to stay below a part of that time, or a sticking finger creeps.
int TwoJointArm::pieces_of(const Numbers& x, double h) const noexcept {
  constexpr double largest_share = 0.9;
  constexpr double most_pieces = 32;  // so that a cycle is bounded: beyond 1 kN at 125 us
  const ContourParameters& contour = parameters_.contour;
  const Vec2 link{x[4], x[5]};
  const auto [tip, jacobian] = placement_of(parameters_, link);
  if (contour.friction == 0 || tip[0] + contour.finger_radius_m < contour.rail_x_m - contour.bump_height_m) return 1;
  const Vec2 velocity = times(jacobian, {x[6], x[7]});
  const Contact contact = contact_at(contour, tip, velocity);
  const double deeper_n = contour.stiffness_n_per_m * magnitude(velocity) * h;
  const double normal_n = contact.normal_force_n + (contact.penetration_m > 0 ? deeper_n : 0);
  if (normal_n <= 0) return 1;
  // Along y, as if there were no bump: its slope of at most 38 degrees changes what is felt by less than the share's reserve.
  const Vec2 along = transposed_times(jacobian, {0, 1});
  const double felt_per_kg = dot(along, solve(mass_matrix(parameters_, link), along));
  const double rate = contour.friction * normal_n / contour.friction_speed_m_s * felt_per_kg;
  return static_cast<int>(std::clamp(std::ceil(h * rate / largest_share), 1.0, most_pieces));
}

void TwoJointArm::heat(const Vec2& motor_torque_n_m, double span_s) noexcept {
  const ThermalParameters& thermal = parameters_.thermal;
  // Exact for a constant torque, so that neither the cycle nor the acceleration shows in the answer.
  const double share =
      -std::expm1(-span_s * thermal.acceleration / (thermal.capacity_j_per_k * thermal.resistance_k_per_w));
  for (std::size_t i = 0; i < 2; ++i) {
    const double rise = thermal.resistance_k_per_w * thermal.heat_w_per_n2_m2 * square(motor_torque_n_m[i]);
    temperature_c_[i] += share * (thermal.ambient_c + rise - temperature_c_[i]);
  }
}

Vec2 TwoJointArm::joint_torque_n_m() const noexcept {
  return joint_torque(parameters_.joint, state_.motor_rad - state_.link_rad, state_.motor_rad_s - state_.link_rad_s);
}

Vec2 TwoJointArm::tip_m_s() const noexcept { return times(jacobian(), state_.link_rad_s); }

Contact TwoJointArm::contact() const noexcept { return contact_at(parameters_.contour, tip_m(), tip_m_s()); }

Vec2 TwoJointArm::tip_force(const Vec2& tip, const Vec2& velocity) const noexcept {
  return contact_at(parameters_.contour, tip, velocity).force_n + spring_force_at(tip);
}

Vec2 TwoJointArm::spring_force_at(const Vec2& tip) const noexcept {
  if (!hooked_) return {};
  const Spring& spring = parameters_.springs[*hooked_];
  const Vec2 along = tip - spring.anchor_m;
  const double length = magnitude(along);
  if (length <= spring.free_length_m) return {};
  return -spring.stiffness_n_per_m * (length - spring.free_length_m) / length * along;
}

Vec2 TwoJointArm::spring_force_n() const noexcept { return spring_force_at(tip_m()); }

double TwoJointArm::energy_j() const noexcept {
  const JointParameters& joint = parameters_.joint;
  const Vec2 twist = state_.motor_rad - state_.link_rad;
  double energy = dot(state_.link_rad_s, times(mass_matrix(parameters_, state_.link_rad), state_.link_rad_s)) / 2;
  energy += joint.motor_inertia_kg_m2 * dot(state_.motor_rad_s, state_.motor_rad_s) / 2;
  energy += joint.stiffness_n_m_per_rad * dot(twist, twist) / 2;
  energy += parameters_.contour.stiffness_n_per_m * square(std::max(0.0, contact().penetration_m)) / 2;
  if (!hooked_) return energy;
  const Spring& spring = parameters_.springs[*hooked_];
  const Vec2 along = tip_m() - spring.anchor_m;
  const double stretch = std::max(0.0, magnitude(along) - spring.free_length_m);
  return energy + spring.stiffness_n_per_m * square(stretch) / 2;
}

void TwoJointArm::set_friction(bool on) noexcept { parameters_ = on ? made_ : made_.without_friction(); }

bool TwoJointArm::hook_spring(std::size_t spring) noexcept {
  if (spring >= parameters_.springs.size()) return false;
  const Vec2 away = tip_m() - parameters_.springs[spring].slack_end_m;
  if (magnitude(away) > parameters_.hook_reach_m) return false;
  hooked_ = spring;
  return true;
}

}  // namespace hirosco::simulation
