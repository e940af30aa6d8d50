// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include "hirosco/utilities/time.hpp"
#include "simulation/world/numerics.hpp"
#include "simulation/world/random.hpp"

/// The joystick of the demonstrator as nature has it, with a hand on it.
namespace hirosco::simulation {

/// Where the operator wants the handle to be; he pulls it there through the softness of his arm.
struct Intent {
  Vec2 angle_rad{};
  Vec2 rate_rad_s{};
};

/// The operator's mind: intended angles over time. Every change starts from what is intended at that moment, so that
/// only `hold` jumps. Cartesian wishes are for the tip of the robot, turned into handle angles by the inverse Jacobian of
/// the robot's home, as a trained operator does.
/// Realtime: bounded; custom() allocates. Thread: one.
class OperatorHand {
 public:
  /// `home_jacobian` of the robot: handle angles = J^-1 (dx, dy).
  OperatorHand(std::uint64_t seed, const Mat2& home_jacobian) noexcept : random_{seed}, jacobian_{home_jacobian} {}

  void hold(const Vec2& angle_rad) noexcept;
  /// One axis moves as amplitude sin(2 pi f t + phase); the other one keeps what it does when it is a sine, else holds.
  void sine(std::size_t axis, double amplitude_rad, double frequency_hz, double phase_rad = 0) noexcept;
  /// Straight to (dx, dy) from home at a constant tip speed, then holds.
  void ramp(const Vec2& offset_m, double speed_m_s) noexcept;
  /// To (dx, dy) from home in the given time by minimum jerk, then holds.
  void cartesian(const Vec2& offset_m, double span_s) noexcept;
  /// Slow gentle wandering about home, touching the wall now and then; all from the seed.
  void wander() noexcept;
  /// As commanded: straight to the angles within the time between two commands at 50 Hz, or as fast as a careful hand
  /// goes, then holds.
  void follow(const Vec2& angle_rad) noexcept;
  [[nodiscard]] bool wandering() const noexcept { return mode_ == Mode::Wander; }
  /// Whatever the caller wants, by seconds since now.
  void custom(std::function<Intent(double)> intent);

  void advance(double span_s) noexcept;
  [[nodiscard]] Intent intent() const noexcept;

 private:
  enum class Mode : std::uint8_t { Hold, Sine, Ramp, Cartesian, Wander, Custom };
  struct Sine {
    double amplitude_rad{0}, frequency_hz{0}, phase_rad{0}, started_s{0}, offset_rad{0};
  };
  void begin(Mode mode, const Vec2& target_rad, double span_s) noexcept;
  void next_wish() noexcept;
  [[nodiscard]] Intent path(bool smooth) const noexcept;

  Random random_;
  Mat2 jacobian_;
  Mode mode_{Mode::Hold};
  double time_s_{0};
  double started_s_{0};
  double span_s_{0};
  Vec2 from_rad_{};
  Vec2 target_rad_{};
  std::array<Sine, 2> sines_{};
  std::function<Intent(double)> custom_;
};

struct HandleParameters {
  double inertia_kg_m2{0.003};
  double friction_n_m_s{0.01};
  double torque_max_n_m{1.5};
  double range_rad{0.40};
  double stop_n_m_per_rad{60};  ///< of the rubber at the end of the range
  double stop_n_m_s_per_rad{0.3};
  double hand_inertia_kg_m2{0.0072};
  double hand_stiffness_n_m_per_rad{4.3};
  double hand_damping_n_m_s_per_rad{0.144};
  double hand_pull_max_n_m{std::numeric_limits<double>::infinity()};
  bool hand_on{true};
  Duration largest_sub_step{std::chrono::microseconds{125}};
};

/// Two independent axes.  Realtime: bounded by the span, no allocation. Thread: one.
class JoystickHandle {
 public:
  JoystickHandle(std::uint64_t seed, const Mat2& home_jacobian, const HandleParameters& parameters = {}) noexcept
      : parameters_{parameters}, hand_{seed, home_jacobian} {}

  /// Moves on by `span` under a constant motor torque (limited to what the motors can give).
  void step(const Vec2& torque_n_m, Duration span) noexcept;

  /// From here on the hand pulls no harder than this towards what it intends: it gives way.
  void give_way_at(double pull_n_m) noexcept { parameters_.hand_pull_max_n_m = pull_n_m; }

  [[nodiscard]] const HandleParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] OperatorHand& hand() noexcept { return hand_; }
  [[nodiscard]] const OperatorHand& hand() const noexcept { return hand_; }
  [[nodiscard]] const Vec2& angle_rad() const noexcept { return angle_rad_; }
  [[nodiscard]] const Vec2& rate_rad_s() const noexcept { return rate_rad_s_; }
  /// What the operator feels: torque of his hand on the handle.
  [[nodiscard]] Vec2 hand_torque_n_m() const noexcept;

 private:
  [[nodiscard]] double pull_n_m(double ahead_rad) const noexcept;

  HandleParameters parameters_;
  OperatorHand hand_;
  Vec2 angle_rad_{};
  Vec2 rate_rad_s_{};
};

}  // namespace hirosco::simulation
