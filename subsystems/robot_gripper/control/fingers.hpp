// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "hirosco/parameter/sized.hpp"

/// The control of a gripper that is known by its URDF file, free of the framework: numbers in, numbers out. A finger's joint is in rad
/// or m, its torque in N m or N.
/// All of it: Realtime: bounded, no allocation after construction, no system call. Thread: the cycle.
namespace hirosco::robot_gripper {

inline constexpr std::size_t max_fingers = 4;
/// A number for each joint that drives fingers, in the order of the URDF file.
using Joints = Sized<double, max_fingers>;

/// A joint that drives a finger, or several that follow it.
struct Finger {
  double closed{0};
  double open{0};
  double effort{0};
  double velocity{0};
  double moved{0};  ///< what the joint moves: links, its own rotor, what mimics it; kg or kg m2
  double friction{0};  ///< of the file

  [[nodiscard]] double lowest() const noexcept { return closed < open ? closed : open; }
  [[nodiscard]] double highest() const noexcept { return closed < open ? open : closed; }
};

struct Measured {
  Joints position;
  Joints velocity;
  Joints torque;  ///< that drives give to links: behind gears and their friction
};

/// What is between the fingers, as it is measured.
struct Gap {
  double width_m{0};
  double speed_m_s{0};  ///< positive where it opens
  double force_n{0};  ///< with which each side presses on what is between them
};

/// What all fingers do together, in numbers of the gap between them: width, m; speed, m/s, positive where it opens; force with which each side presses on
/// what is between them, N. All joints go from closed to open in proportion; forces are those that do the same work, so what
/// mimics a joint counts, and of joints that turn it is a mean over their range.
class Fingers {
 public:
  Fingers() = default;
  /// `full_width_m`: with all joints open, above 0.
  Fingers(std::span<const Finger> fingers, double full_width_m) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return fingers_.size(); }
  [[nodiscard]] const Finger& operator[](std::size_t i) const noexcept { return fingers_[i]; }
  [[nodiscard]] double full_width_m() const noexcept { return full_width_m_; }
  /// With all efforts that there are.
  [[nodiscard]] double most_force_n() const noexcept { return most_force_n_; }
  [[nodiscard]] double most_speed_m_s() const noexcept { return most_speed_m_s_; }
  /// What resists a change of the speed of the gap.
  [[nodiscard]] double moved_kg() const noexcept { return moved_kg_; }
  [[nodiscard]] double friction_n() const noexcept { return friction_n_; }

  [[nodiscard]] double width(const Joints& position) const noexcept;
  [[nodiscard]] double speed(const Joints& velocity) const noexcept;
  [[nodiscard]] double force(const Joints& torque) const noexcept;
  /// All three.
  [[nodiscard]] Gap gap(const Measured& measured) const noexcept {
    return {width(measured.position), speed(measured.velocity), force(measured.torque)};
  }

  /// The torques of a force that closes, and of what keeps the joints in proportion; each at most its effort.
  [[nodiscard]] Joints torques(double closing_n, const Measured& measured, double bandwidth_rad_s) const noexcept;

 private:
  /// Of a joint, for a metre of width.
  [[nodiscard]] double way(std::size_t i) const noexcept {
    return (fingers_[i].open - fingers_[i].closed) / full_width_m_;
  }

  Sized<Finger, max_fingers> fingers_;
  double full_width_m_{1};
  double most_force_n_{0}, most_speed_m_s_{0}, moved_kg_{0}, friction_n_{0};
};

}  // namespace hirosco::robot_gripper
