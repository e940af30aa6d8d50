// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulation/mujoco/joint_drives.hpp"
#include "simulation/mujoco/mujoco_world.hpp"

namespace hirosco::simulation {

/// The links of a robot: which bodies of the world they are, how heavy they are against their file, and what hangs on the tip.
/// Realtime: find() and whatever weighs allocate. Thread: one.
class RobotLinks {
 public:
  /// A link is what is behind one of its joints, or, where the world is its file's alone, everything that is no loose body. Those begin at `first_loose`.
  void find(const MujocoWorld& world, const JointDrives& drives, int first_loose);
  [[nodiscard]] bool have(int body) const noexcept { return of_robot_[static_cast<std::size_t>(body)]; }
  /// Whether it is one that a joint or the base moves.
  [[nodiscard]] bool have_moved(int body, const mjModel& model) const noexcept {
    return have(body) && model.body_weldid[body] != 0;
  }

  void set_mass_factor(double factor) noexcept { mass_factor_ = factor; }
  void set_inertia_factor(double factor) noexcept { inertia_factor_ = factor; }
  /// A point with this mass at the tip's origin.
  void set_payload(double mass_kg) noexcept { payload_kg_ = mass_kg; }
  /// From now on they resist in this world by what was set here and at their drives.
  void weigh(MujocoWorld& world) const noexcept;

 private:
  std::vector<bool> of_robot_;  ///< by bodies
  std::vector<double> mass_, inertia_;  ///< of the file, by bodies without loose ones
  double mass_factor_{1};
  double inertia_factor_{1};
  double payload_kg_{0};
};

}  // namespace hirosco::simulation
