// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hirosco/utilities/time.hpp"
#include "simulation/world/numerics.hpp"

/// A robot as nature has it: a planar arm of two flexible joints in zero gravity, a contour to
/// touch and two springs to hook. Shares no code and no number file with the controller: a wrong model there must show.
namespace hirosco::simulation {

struct LinkParameters {
  double length_m;
  double mass_kg;
  double com_m;  ///< from the joint, along the link
  double inertia_kg_m2;  ///< about the centre of mass
};

struct JointParameters {
  double motor_inertia_kg_m2{1.28};  ///< seen at the link
  double stiffness_n_m_per_rad{4000};
  double damping_n_m_s_per_rad{4};
  double friction_viscous_n_m_s{2};
  double friction_coulomb_n_m{1};
  double friction_rate_rad_s{0.01};  ///< of the tanh
  double torque_max_n_m{60};
};

/// Rail along y with a cosine bump towards the arm; contact after Hunt and Crossley along the true normal.
struct ContourParameters {
  double rail_x_m{0.350};
  double bump_height_m{0.010};
  double bump_half_width_m{0.040};
  double bump_y_m{0.05};
  double finger_radius_m{0.010};
  double stiffness_n_per_m{5e4};
  double damping_s_per_m{2};
  double friction{0.15};
  double friction_speed_m_s{1e-3};  ///< of the tanh
};

/// Pulls the tip towards its anchor when longer than its free length, never pushes.
struct Spring {
  Vec2 anchor_m{};
  Vec2 slack_end_m{};
  double free_length_m{0.05};
  double stiffness_n_per_m{400};
};

struct ThermalParameters {
  double capacity_j_per_k{60};
  double resistance_k_per_w{4};
  double heat_w_per_n2_m2{0.12};
  double ambient_c{20};
  double acceleration{1};  ///< runs the thermal clock faster, for demonstrations
};

struct ArmParameters {
  std::array<LinkParameters, 2> links{{{0.25, 3.0, 0.17, 0.020}, {0.22, 1.6, 0.10, 0.008}}};
  JointParameters joint{};
  ContourParameters contour{};
  std::array<Spring, 2> springs{{{{0.3275, 0.050}, {0.3275, 0.000}}, {{0.280, -0.0215}, {0.330, -0.0215}}}};
  double hook_reach_m{0.005};
  ThermalParameters thermal{};
  Vec2 home_rad{-0.80, 1.60};
  Duration largest_sub_step{std::chrono::microseconds{125}};

  /// Without any dissipation but the joints' D, which closed forms take apart.
  [[nodiscard]] ArmParameters without_friction() const noexcept;
};

/// Where the two links put the tip, and how it moves with them. In one, because both need the same sines.
struct Placement {
  Vec2 tip_m{};
  Mat2 jacobian{};
};
[[nodiscard]] Placement placement_of(const ArmParameters& arm, const Vec2& q) noexcept;

struct ArmState {
  Vec2 motor_rad{};
  Vec2 motor_rad_s{};
  Vec2 link_rad{};
  Vec2 link_rad_s{};
};

struct Contact {
  double penetration_m{0};  ///< negative: the gap
  double normal_force_n{0};
  Vec2 force_n{};  ///< on the tip, friction included
};

/// Steps by Runge-Kutta with sub-steps of at most `largest_sub_step`, shorter the harder the finger presses: 31 us at 140 N;
/// the same bits from the same inputs.
/// Realtime: bounded by the span, no allocation. Thread: one.
class TwoJointArm {
 public:
  explicit TwoJointArm(const ArmParameters& parameters = {}) noexcept;

  /// Moves on by `span` under a constant motor torque (limited to what the motor can give).
  void step(const Vec2& motor_torque_n_m, Duration span) noexcept;

  [[nodiscard]] const ArmParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] const ArmState& state() const noexcept { return state_; }
  void set_state(const ArmState& state) noexcept { state_ = state; }
  /// K (theta - q) + D (theta' - q'): what the torque sensors see.
  [[nodiscard]] Vec2 joint_torque_n_m() const noexcept;
  [[nodiscard]] Vec2 tip_m() const noexcept { return placement_of(parameters_, state_.link_rad).tip_m; }
  [[nodiscard]] Vec2 tip_m_s() const noexcept;
  [[nodiscard]] Mat2 jacobian() const noexcept { return placement_of(parameters_, state_.link_rad).jacobian; }
  [[nodiscard]] Contact contact() const noexcept;
  [[nodiscard]] Vec2 spring_force_n() const noexcept;
  /// Kinetic, elastic and contact energy.
  [[nodiscard]] double energy_j() const noexcept;

  [[nodiscard]] const Vec2& temperature_c() const noexcept { return temperature_c_; }
  void set_temperature(std::size_t joint, double celsius) noexcept { temperature_c_[joint] = celsius; }

  /// Runs the thermal clock faster, for demonstrations.
  void set_thermal_acceleration(double factor) noexcept {
    made_.thermal.acceleration = parameters_.thermal.acceleration = factor;
  }

  /// Joint and contact friction as they were made, or none.
  void set_friction(bool on) noexcept;

  /// False when the tip is not within reach of the spring's slack end.
  bool hook_spring(std::size_t spring) noexcept;
  void release_spring() noexcept { hooked_.reset(); }
  [[nodiscard]] std::optional<std::size_t> hooked_spring() const noexcept { return hooked_; }

 private:
  using Numbers = std::array<double, 8>;
  [[nodiscard]] Numbers derivative(const Numbers& x, const Vec2& motor_torque_n_m) const noexcept;
  [[nodiscard]] int pieces_of(const Numbers& x, double h) const noexcept;
  [[nodiscard]] Vec2 tip_force(const Vec2& tip, const Vec2& velocity) const noexcept;
  [[nodiscard]] Vec2 spring_force_at(const Vec2& tip) const noexcept;
  void heat(const Vec2& motor_torque_n_m, double seconds) noexcept;

  ArmParameters made_;
  ArmParameters parameters_;
  ArmState state_;
  Vec2 temperature_c_;
  std::optional<std::size_t> hooked_;
};

/// Contact of a finger at `tip` moving with `velocity`; a free function so that its closed form is testable.
[[nodiscard]] Contact contact_at(const ContourParameters& contour, const Vec2& tip, const Vec2& velocity) noexcept;

}  // namespace hirosco::simulation
