// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "simulation/mujoco/mujoco_spec.hpp"
#include "simulation/mujoco/mujoco_world.hpp"

namespace hirosco::simulation {

/// The joints of a world's robots that move by themselves, robot by robot as in their files, and what is at each: drive, gear with dry friction, a brake that slips, and a
/// torque sensor behind both.
/// Realtime: does not allocate once it is made. Thread: one.
class JointDrives {
 public:
  enum class Brakes : std::uint8_t {
    Open,
    Slowing,  ///< what holds the load, and 0.3 of the joint's drive
    Closed,  ///< twice as strong
  };

  explicit JointDrives(std::span<const DrivenJoint> joints) { add(joints); }
  /// Behind those that are there.  Realtime: allocates.
  void add(std::span<const DrivenJoint> joints);
  /// Looks for them in a model, and gives it what they are like. In words why not.  Realtime: allocates.
  [[nodiscard]] std::expected<void, std::string> find(mjModel& model);

  [[nodiscard]] std::size_t count() const noexcept { return joints_.size(); }
  /// The joint of this name.
  [[nodiscard]] std::optional<std::size_t> named(std::string_view name) const noexcept;
  /// Whether this body is what one of this robot's moves.
  [[nodiscard]] bool move(int body, const mjModel& model, const MujocoSpec::Robot& robot) const noexcept;

  [[nodiscard]] double position(std::size_t joint, const MujocoWorld& world) const noexcept;
  [[nodiscard]] double velocity(std::size_t joint, const MujocoWorld& world) const noexcept;
  /// By how much its link is ahead of its drive: nothing gives way where it has no spring.
  [[nodiscard]] double given_way(std::size_t joint, const MujocoWorld& world) const noexcept;
  [[nodiscard]] bool gives_way(std::size_t joint) const noexcept { return joints_[joint].spring.has_value(); }
  /// What the drive and the brake give to the link, or to the spring before it: behind friction and rotor, which are theirs.
  [[nodiscard]] double torque(std::size_t joint) const noexcept { return joints_[joint].torque; }
  [[nodiscard]] double effort(std::size_t joint) const noexcept { return joints_[joint].effort; }
  /// From the `first` on, as many as there are numbers, stand there.
  void place(std::span<const double> positions, std::size_t first, MujocoWorld& world) const noexcept;
  /// What is to be between the drives of this robot and their links, N m/rad and N m s/rad, or N/m and N s/m: of its first ones, as many as there are
  /// numbers, with the rotors that they have. In words why not: they are to stand at 0.  Realtime: allocates.
  [[nodiscard]] std::expected<std::vector<MujocoSpec::Spring>, std::string> springs(std::span<const double> stiffness,
                                                                                    std::span<const double> damping,
                                                                                    const MujocoSpec::Robot& robot,
                                                                                    const MujocoWorld& world) const;
  /// In words which spring of this robot would swing faster between its drive and its link, where all joints are at 0, than sub-steps can tell; empty: none
  /// does.  Realtime: allocates.
  [[nodiscard]] std::optional<std::string> too_fast(const MujocoSpec::Robot& robot, const MujocoWorld& world) const;
  /// Where this robot rests, its springs give way to what weighs on them.
  void settle(const MujocoSpec::Robot& robot, MujocoWorld& world) const noexcept;
  /// The first of them, as many as there are numbers, go on as fast as that.
  void set_in_motion(std::span<const double> velocities, MujocoWorld& world) const noexcept;

  /// What a joint's drive does from the next step on, held to its effort.
  void drive(std::size_t joint, double torque, Brakes brakes, MujocoWorld& world) noexcept;
  /// All brakes are closed.
  void close_brakes(MujocoWorld& world) noexcept;
  /// Before a step: what friction and brakes hold in it.
  void brake(MujocoWorld& world) const noexcept;
  /// After it: what the torque sensors have.
  void feel(const MujocoWorld& world) noexcept;

  /// Of the file's friction and damping, and more dry friction of every joint of this robot, N m or N.
  void set_friction(double factor, double more, const MujocoSpec::Robot& robot) noexcept;
  /// What the drive of each joint moves besides links, behind its gear, kg m2 or kg, from the `first` on; the file does not have it.
  void set_rotors(std::span<const double> inertias, std::size_t first, MujocoWorld& world) noexcept;

 private:
  struct Spring {
    int position{0};  ///< index in MuJoCo
    int dof{0};
    double stiffness{0};
  };
  struct Joint {
    std::string name;
    double effort{0};
    bool of_scene{false};
    int position{0};  ///< index in MuJoCo
    int dof{0};
    double friction{0};  ///< of the file
    double damping{0};
    double friction_factor{1};
    double more_friction{0};
    std::optional<Spring> spring{};
    std::optional<double> rotor{};  ///< empty: as the file says, which is 0 in a URDF file
    double torque{0};
    Brakes brakes{Brakes::Closed};
  };

  std::vector<Joint> joints_;
};

}  // namespace hirosco::simulation
