// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "hirosco/utilities/time.hpp"

namespace hirosco::simulation {

/// A robot of a URDF file as MuJoCo moves it: rigid links on a base that stands, joints with dry friction and brakes that slip. Shapes
/// are left out, so nothing touches. Joints are numbered as in the file, fixed ones left out.
/// Runge-Kutta of 4th order with sub-steps of at most 0.5 ms: the same bits twice from one version of MuJoCo on one architecture.
/// Realtime: make() and what changes masses allocate, nothing else. Thread: one.
class MujocoRobot {
 public:
  enum class Brakes : std::uint8_t {
    Open,
    Slowing,  ///< what holds the load, and 0.3 of the joint's drive
    Closed,  ///< twice as strong
  };

  /// In words why there is none.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make(std::string_view urdf);

  [[nodiscard]] std::size_t joints() const noexcept { return joints_.size(); }
  [[nodiscard]] double position(std::size_t joint) const noexcept;
  [[nodiscard]] double velocity(std::size_t joint) const noexcept;
  /// What the drive and the brake give to the link: behind friction and rotor, which are theirs.
  [[nodiscard]] double torque(std::size_t joint) const noexcept { return joints_[joint].torque; }
  [[nodiscard]] double effort(std::size_t joint) const noexcept { return joints_[joint].effort; }
  /// Of the last link, in the axes of the base, m.
  [[nodiscard]] std::span<const double, 3> tip_m() const noexcept;

  /// Puts it there, at rest.
  void place(std::span<const double> positions) noexcept;
  /// Drives are held to the joints' efforts.
  void step(std::span<const double> torques, Brakes brakes, Duration span) noexcept;

  // --- how it differs from its file ----------------------------------------------------------------------------------
  void set_mass_factor(double factor) noexcept;
  void set_inertia_factor(double factor) noexcept;
  /// Of the file's friction and damping, and more dry friction of every joint, N m or N.
  void set_friction(double factor, double more) noexcept;
  /// What the drive of each joint moves besides links, behind its gear, kg m2 or kg; the file does not have it.
  void set_rotors(std::span<const double> inertias) noexcept;
  /// A point with this mass at the origin of the last link.
  void set_payload(double mass_kg) noexcept;
  void set_gravity(double x, double y, double z) noexcept;
  /// A force at the last link's origin, N, in the axes of the base, until it is another.
  void push(double x, double y, double z) noexcept;

 private:
  struct Joint {
    std::string name;
    double effort{0};
    int position{0};  ///< index in MuJoCo
    int dof{0};
    double friction{0};  ///< of the file
    double damping{0};
    double torque{0};
  };
  struct Free {
    void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
    void operator()(mjData* data) const noexcept { mj_deleteData(data); }
    void operator()(mjSpec* spec) const noexcept { mj_deleteSpec(spec); }
  };
  MujocoRobot() = default;
  void brake(Brakes brakes) noexcept;
  void feel() noexcept;
  void change_inertia() noexcept;

  std::vector<Joint> joints_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::vector<double> mass_, inertia_;  ///< of the file, by bodies
  int tip_{0};
  double mass_factor_{1};
  double inertia_factor_{1};
  double friction_factor_{1};
  double more_friction_{0};
  double payload_kg_{0};
};

}  // namespace hirosco::simulation
