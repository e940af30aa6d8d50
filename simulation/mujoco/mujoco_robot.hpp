// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <expected>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "hirosco/utilities/time.hpp"
#include "simulation/mujoco/contacts.hpp"
#include "simulation/mujoco/joint_drives.hpp"
#include "simulation/mujoco/loose_bodies.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"
#include "simulation/mujoco/mujoco_world.hpp"
#include "simulation/mujoco/robot_links.hpp"
#include "simulation/mujoco/standing.hpp"

namespace hirosco::simulation {

/// A robot of a URDF file as MuJoCo moves it: rigid links on a base that stands or floats, joints with dry friction and brakes that slip. Its
/// collision shapes touch each other (mujoco_urdf.hpp), obstacles that stand around it and bodies that move by themselves. Other robots of other files are mounted in its
/// world (mount()): they are number 1 and further, it is 0. Joints are numbered robot by robot as in their files, fixed
/// ones left out. Whenever something comes to its world or goes, this is what moves it into another model.
/// Runge-Kutta of 4th order with sub-steps of at most 0.5 ms: the same bits twice from one version of MuJoCo on one architecture.
/// Realtime: step() and push() do not allocate, what changes the world does. Thread: one.
class MujocoRobot {
 public:
  using Brakes = JointDrives::Brakes;
  using Touched = Contacts::Touched;
  using BodyTruth = LooseBodies::Truth;

  /// In words why there is none. `meshes`: without it shapes that are meshes are left out.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make(std::string_view urdf,
                                                                    const MeshSource& meshes = {});
  /// In a world of an MJCF file; of the robot's URDF file its joints count, which the world has by the same names. In words why there is none.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make_in_scene(std::string_view mjcf,
                                                                             std::string_view urdf,
                                                                             const MeshSource& files = {});
  /// Of what a file or two say already.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make(MujocoSpec spec);
  /// What of the file's shapes does not touch, each in words.
  [[nodiscard]] const std::vector<std::string>& left_out(std::size_t robot = 0) const noexcept {
    return world_.spec().left_out(robot);
  }

  /// Another robot stands there from now on, at rest where its file has it at zero; all else goes on. Its number; in words why not, and nothing is changed.
  [[nodiscard]] std::expected<std::size_t, std::string> mount(MujocoSpec robot, const Mount& at);
  [[nodiscard]] std::size_t robots() const noexcept { return links_.size(); }
  /// What is in each other now, in words: where robots were mounted, or put, into something.
  [[nodiscard]] std::optional<std::string> overlap() const { return Contacts::overlap(world_); }

  [[nodiscard]] std::size_t joints(std::size_t robot = 0) const noexcept { return of(robot).joints; }
  [[nodiscard]] std::size_t first_joint(std::size_t robot) const noexcept { return of(robot).first_joint; }
  [[nodiscard]] double position(std::size_t joint) const noexcept { return drives_.position(joint, world_); }
  [[nodiscard]] double velocity(std::size_t joint) const noexcept { return drives_.velocity(joint, world_); }
  /// What the drive and the brake give to the link: behind friction and rotor, which are theirs.
  [[nodiscard]] double torque(std::size_t joint) const noexcept { return drives_.torque(joint); }
  [[nodiscard]] double effort(std::size_t joint) const noexcept { return drives_.effort(joint); }
  /// By how much a joint's link is ahead of its drive, whose place position() is.
  [[nodiscard]] double given_way(std::size_t joint) const noexcept { return drives_.given_way(joint, world_); }
  [[nodiscard]] bool gives_way(std::size_t joint) const noexcept { return drives_.gives_way(joint); }
  /// From now on this link is its tip, which pushes and payloads act at; at first it is the first one that carries nothing. In words why not.
  [[nodiscard]] std::expected<void, std::string> set_tip(const std::string& link, std::size_t robot = 0);
  /// Of the tip's origin, in the axes of the base, of one that floats in inertial ones, m; also that of a robot that is mounted.
  [[nodiscard]] std::span<const double, 3> tip_m(std::size_t robot = 0) const noexcept { return world_.tip_m(robot); }
  /// w x y z.
  [[nodiscard]] std::span<const double, 4> tip_orientation(std::size_t robot = 0) const noexcept {
    return world_.tip_orientation(robot);
  }

  /// At the end of the last step.
  [[nodiscard]] const Touched& touched(std::size_t robot = 0) const noexcept { return contacts_.touched(robot); }

  /// Nothing holds its root link any more: it is at rest at the inertial origin, with all joints at 0. In words why not.
  [[nodiscard]] std::expected<void, std::string> let_float();
  /// What floats, and the state that its functions want.
  [[nodiscard]] const FloatingBase& base() const noexcept { return world_.base(); }
  [[nodiscard]] FloatingBase& base() noexcept { return world_.base(); }
  [[nodiscard]] const mjModel& model() const noexcept { return world_.model(); }
  [[nodiscard]] mjData& data() const noexcept { return world_.data(); }
  /// It goes on from where it is with these: [rate; velocity] of its base, where that floats, and of its joints.
  void set_in_motion(const std::array<double, 6>& base_twist, std::span<const double> velocities) noexcept;
  [[nodiscard]] double kinetic_energy_j() const { return world_.kinetic_energy_j(); }

  /// Puts it there, at rest; in words why not: it would stand in an obstacle, a body or another robot.
  [[nodiscard]] std::expected<void, std::string> place(std::span<const double> positions, std::size_t robot = 0);
  /// What a joint's drive does from the next step on, held to its effort.
  void drive(std::size_t joint, double torque, Brakes brakes) noexcept { drives_.drive(joint, torque, brakes, world_); }
  void step(Duration span) noexcept;
  /// All joints of the first robot alike.
  void step(std::span<const double> torques, Brakes brakes, Duration span) noexcept;
  /// The joint of this name, where it moves by itself; NAME/JOINT of a robot that is mounted.
  [[nodiscard]] std::optional<std::size_t> joint(std::string_view name) const noexcept { return drives_.named(name); }

  // --- what stands around it -----------------------------------------------------------------------------------------
  /// In place of the one of this name, if there is one. In words why not: too many, or the robot stands in it.
  [[nodiscard]] std::expected<void, std::string> put(const Obstacle& obstacle);
  [[nodiscard]] std::expected<void, std::string> take_away(std::string_view name);
  /// The time constant by which all that touches gives way, without swinging; at least two sub-steps.
  void set_softness(double time_constant_s) noexcept { contacts_.set_softness(time_constant_s, world_); }

  // --- what lies around it -------------------------------------------------------------------------------------------
  /// At rest, in place of the one of this name, if there is one. In words why not: too many, or something is there already.
  [[nodiscard]] std::expected<void, std::string> lay(const LooseBody& body);
  [[nodiscard]] std::expected<void, std::string> take_body_away(std::string_view name);
  /// A force at its centre, N, in the axes of the base, until it is another. False: there is no such body.
  [[nodiscard]] bool pull(std::string_view name, std::array<double, 3> force_n) noexcept {
    return bodies_.pull(name, force_n, world_);
  }
  void let_go_of_bodies() noexcept { bodies_.let_go(world_); }
  [[nodiscard]] std::size_t bodies() const noexcept { return bodies_.count(); }
  [[nodiscard]] BodyTruth body(std::size_t index) const noexcept { return bodies_.truth(index, world_, links_); }

  // --- how it differs from its file ----------------------------------------------------------------------------------
  void set_mass_factor(double factor, std::size_t robot = 0) noexcept;
  void set_inertia_factor(double factor, std::size_t robot = 0) noexcept;
  /// Of the file's friction and damping, and more dry friction of every joint, N m or N.
  void set_friction(double factor, double more, std::size_t robot = 0) noexcept {
    drives_.set_friction(factor, more, of(robot));
  }
  /// What the drive of each joint moves besides links, behind its gear, kg m2 or kg; the file does not have it.
  void set_rotors(std::span<const double> inertias, std::size_t robot = 0) noexcept;
  /// From now on what is between drives and links gives way: a spring and a damper for each of its joints, N m/rad and N m s/rad, or N/m and N s/m; 0: it does
  /// not. Once, with rotors, where all its joints are at 0, and before another robot is mounted. In words why not, and nothing is changed.
  [[nodiscard]] std::expected<void, std::string> give_way(std::span<const double> stiffness,
                                                          std::span<const double> damping, std::size_t robot = 0);
  /// A point with this mass at the tip's origin.
  void set_payload(double mass_kg, std::size_t robot = 0) noexcept;
  void set_gravity(double x, double y, double z) noexcept { world_.set_gravity(x, y, z); }
  /// As a sensor between the tip and what hangs on it and pushes it: force in N, moment in N m, in the axes of the tip. What touches the tip's own
  /// shapes it does not feel.
  [[nodiscard]] std::array<double, 6> tip_force(std::size_t robot = 0) const noexcept {
    return world_.tip_force(robot);
  }
  /// A force at the tip's origin, N, in the axes of the base, until it is another.
  void push(double x, double y, double z, std::size_t robot = 0) noexcept { world_.push({x, y, z}, robot); }

 private:
  explicit MujocoRobot(MujocoSpec spec);
  [[nodiscard]] const MujocoSpec::Robot& of(std::size_t robot) const noexcept { return world_.spec().robots()[robot]; }
  /// The robot is at rest where its file has it at zero.
  [[nodiscard]] std::expected<void, std::string> build(std::span<const Obstacle> obstacles, LooseBodies bodies);
  /// What moves goes on where it is, as fast as it is. `moved`: name of the body that is put somewhere, where there is one.
  [[nodiscard]] std::expected<void, std::string> surround(std::vector<Obstacle> obstacles, LooseBodies bodies,
                                                          std::string_view moved = {});
  /// The world is told this instead, with as many drives and robots as it has; all goes on. In words why not: then it goes on as before.
  [[nodiscard]] std::expected<void, std::string> become(MujocoSpec spec,
                                                        const std::function<std::optional<std::string>()>& judge = {});
  void stand(const Standing& standing) noexcept;
  void feel() noexcept;

  MujocoWorld world_;
  JointDrives drives_;
  std::vector<RobotLinks> links_{1};  ///< robot by robot
  Contacts contacts_;
  std::vector<Obstacle> obstacles_;
  LooseBodies bodies_;
};

}  // namespace hirosco::simulation
