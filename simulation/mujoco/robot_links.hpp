// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simulation/mujoco/joint_drives.hpp"
#include "simulation/mujoco/mujoco_world.hpp"

namespace hirosco::simulation {

/// The links of one of a world's robots: which bodies of the world they are, how heavy they are against their file, and what hangs on its tip.
/// Realtime: find() and whatever weighs allocate. Thread: one.
class RobotLinks {
 public:
  /// A link is what is behind one of its joints, or, of a URDF file, everything of it. Loose bodies begin at `first_loose`.
  void find(const MujocoWorld& world, const JointDrives& drives, std::size_t robot, int first_loose);
  [[nodiscard]] bool have(int body) const noexcept { return of_robot_[static_cast<std::size_t>(body)]; }
  /// Whether it is one that a joint or the base moves.
  [[nodiscard]] bool have_moved(int body, const mjModel& model) const noexcept {
    return have(body) && model.body_weldid[body] != 0;
  }

  void set_mass_factor(double factor) noexcept { mass_factor_ = factor; }
  void set_inertia_factor(double factor) noexcept { inertia_factor_ = factor; }
  /// A point with this mass at the tip's origin.
  void set_payload(double mass_kg) noexcept { payload_kg_ = mass_kg; }
  /// From now on all of a world's robots resist in it by what was set here and at their drives.
  static void weigh(MujocoWorld& world, std::span<const RobotLinks> robots) noexcept;

 private:
  void give_masses(MujocoWorld& world) const noexcept;
  void bound_contacts(mjModel& model) const noexcept;

  std::size_t robot_{0};
  std::vector<bool> of_robot_;  ///< by bodies
  std::vector<double> mass_,
      inertia_;  ///< of the file, by bodies without loose ones; none of those that are another robot's
  double mass_factor_{1};
  double inertia_factor_{1};
  double payload_kg_{0};
};

}  // namespace hirosco::simulation
