// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mujoco/mujoco.h>

#include "hirosco/utilities/time.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"

namespace hirosco::simulation {

/// A robot of a URDF file as MuJoCo moves it: rigid links on a base that stands or floats, joints with dry friction and brakes that slip. Its
/// collision shapes touch each other (mujoco_spec.hpp), obstacles that stand around it and bodies that move by themselves. Joints are numbered as in the file, fixed
/// ones left out.
/// Runge-Kutta of 4th order with sub-steps of at most 0.5 ms: the same bits twice from one version of MuJoCo on one architecture.
/// Realtime: step() and push() do not allocate, what changes the world does. Thread: one.
class MujocoRobot {
 public:
  enum class Brakes : std::uint8_t {
    Open,
    Slowing,  ///< what holds the load, and 0.3 of the joint's drive
    Closed,  ///< twice as strong
  };

  /// What of the robot touches, and with how much in all across the surfaces.
  struct Touched {
    int contacts{0};
    double normal_n{0};
  };

  /// In words why there is none. `meshes`: without it shapes that are meshes are left out.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make(std::string_view urdf,
                                                                    const MeshSource& meshes = {});
  /// In a world of an MJCF file; of the robot's URDF file its joints count, which the world has by the same names. In words why there is none.
  [[nodiscard]] static std::expected<MujocoRobot, std::string> make_in_scene(std::string_view mjcf,
                                                                             std::string_view urdf,
                                                                             const MeshSource& files = {});
  /// What of the file's shapes does not touch, each in words.
  [[nodiscard]] const std::vector<std::string>& left_out() const noexcept { return spec_.left_out(); }

  [[nodiscard]] std::size_t joints() const noexcept { return joints_.size(); }
  [[nodiscard]] double position(std::size_t joint) const noexcept;
  [[nodiscard]] double velocity(std::size_t joint) const noexcept;
  /// What the drive and the brake give to the link: behind friction and rotor, which are theirs.
  [[nodiscard]] double torque(std::size_t joint) const noexcept { return joints_[joint].torque; }
  [[nodiscard]] double effort(std::size_t joint) const noexcept { return joints_[joint].effort; }
  /// From now on this link is its tip, which pushes and payloads act at; at first it is the first one that carries nothing. In words why not.
  [[nodiscard]] std::expected<void, std::string> set_tip(const std::string& link);
  /// Of the tip's origin, in the axes of the base, of one that floats in inertial ones, m.
  [[nodiscard]] std::span<const double, 3> tip_m() const noexcept;
  /// w x y z.
  [[nodiscard]] std::span<const double, 4> tip_orientation() const noexcept;

  /// At the end of the last step.
  [[nodiscard]] const Touched& touched() const noexcept { return touched_; }

  /// Nothing holds its root link any more: it is at rest at the inertial origin, with all joints at 0. In words why not.
  [[nodiscard]] std::expected<void, std::string> let_float();
  /// What floats, and the state that its functions want.
  [[nodiscard]] const FloatingBase& base() const noexcept { return base_; }
  [[nodiscard]] FloatingBase& base() noexcept { return base_; }
  [[nodiscard]] const mjModel& model() const noexcept { return *model_; }
  [[nodiscard]] mjData& data() const noexcept { return *data_; }
  /// It goes on from where it is with these: [rate; velocity] of its base, where that floats, and of its joints.
  void set_in_motion(const std::array<double, 6>& base_twist, std::span<const double> velocities) noexcept;
  [[nodiscard]] double kinetic_energy_j() const;

  /// Puts it there, at rest; in words why not: it would stand in an obstacle.
  [[nodiscard]] std::expected<void, std::string> place(std::span<const double> positions);
  /// What a joint's drive does from the next step on, held to its effort.
  void drive(std::size_t joint, double torque, Brakes brakes) noexcept;
  void step(Duration span) noexcept;
  /// All joints alike.
  void step(std::span<const double> torques, Brakes brakes, Duration span) noexcept;
  /// The joint of this name, where it moves by itself.
  [[nodiscard]] std::optional<std::size_t> joint(std::string_view name) const noexcept;

  // --- what stands around it -----------------------------------------------------------------------------------------
  /// In place of the one of this name, if there is one. In words why not: too many, or the robot stands in it.
  [[nodiscard]] std::expected<void, std::string> put(const Obstacle& obstacle);
  [[nodiscard]] std::expected<void, std::string> take_away(std::string_view name);
  /// The time constant by which all that touches gives way, without swinging; at least two sub-steps.
  void set_softness(double time_constant_s) noexcept;

  // --- what lies around it (mujoco_bodies.cpp) -------------------------------------------------------------------------
  /// Of a body that moves by itself; in the axes of the base.
  struct BodyTruth {
    std::string_view name;
    std::array<double, 3> place_m{};  ///< of its centre
    std::array<double, 4> turned_wxyz{};
    std::array<double, 3> velocity_m_s{};
    double pressed_n{0};  ///< by links of the robot, in all across the surfaces
  };
  /// At rest, in place of the one of this name, if there is one. In words why not: too many, or something is there already.
  [[nodiscard]] std::expected<void, std::string> lay(const LooseBody& body);
  [[nodiscard]] std::expected<void, std::string> take_body_away(std::string_view name);
  /// A force at its centre, N, in the axes of the base, until it is another. False: there is no such body.
  [[nodiscard]] bool pull(std::string_view name, std::array<double, 3> force_n) noexcept;
  void let_go_of_bodies() noexcept;
  [[nodiscard]] std::size_t bodies() const noexcept { return bodies_.size(); }
  [[nodiscard]] BodyTruth body(std::size_t index) const noexcept;

  // --- how it differs from its file ----------------------------------------------------------------------------------
  void set_mass_factor(double factor) noexcept;
  void set_inertia_factor(double factor) noexcept;
  /// Of the file's friction and damping, and more dry friction of every joint, N m or N.
  void set_friction(double factor, double more) noexcept;
  /// What the drive of each joint moves besides links, behind its gear, kg m2 or kg; the file does not have it.
  void set_rotors(std::span<const double> inertias) noexcept;
  /// A point with this mass at the tip's origin.
  void set_payload(double mass_kg) noexcept;
  void set_gravity(double x, double y, double z) noexcept;
  /// A force at the tip's origin, N, in the axes of the base, until it is another.
  void push(double x, double y, double z) noexcept;

 private:
  struct Joint {
    std::string name;
    double effort{0};
    int position{0};  ///< index in MuJoCo
    int dof{0};
    double friction{0};  ///< of the file
    double damping{0};
    std::optional<double> rotor{};  ///< empty: as the file says, which is 0 in a URDF file
    double torque{0};
    Brakes brakes{Brakes::Closed};
  };
  explicit MujocoRobot(MujocoSpec spec) noexcept : spec_{std::move(spec)} {}
  [[nodiscard]] static std::expected<MujocoRobot, std::string> made_of(MujocoSpec spec);
  /// What is behind one of its joints, or, where the world is its file's alone, everything that is no loose body.
  [[nodiscard]] bool is_of_robot(int body) const noexcept { return of_robot_[static_cast<std::size_t>(body)]; }
  void find_its_bodies();
  /// How what moves stands, so that it goes on in another model of the same robot.
  struct Standing {
    struct Body {
      std::string name{};
      std::array<double, 7> pose{};
      std::array<double, 6> velocity{};
    };
    std::vector<double> positions{}, velocities{};  ///< of the robot
    std::array<double, 6> pushed{};
    std::vector<Body> bodies{};
  };
  [[nodiscard]] Standing standing() const;
  /// Whatever body is not in it stays where it is.
  void stand(const Standing& standing) noexcept;
  [[nodiscard]] int first_body() const noexcept {
    return static_cast<int>(model_->nbody) - static_cast<int>(bodies_.size());
  }
  void pull_bodies() noexcept;
  [[nodiscard]] std::expected<void, std::string> build(std::span<const Obstacle> obstacles,
                                                       std::span<const LooseBody> bodies);
  /// `moved`: name of the body that is put somewhere, where there is one.
  [[nodiscard]] std::expected<void, std::string> surround(std::vector<Obstacle> obstacles,
                                                          std::vector<LooseBody> bodies, std::string_view moved = {});
  [[nodiscard]] std::optional<std::string> overlap() const;
  void follow() noexcept;
  void brake() noexcept;
  void feel() noexcept;
  void change_inertia() noexcept;

  MujocoSpec spec_;
  std::vector<Joint> joints_;
  std::vector<Obstacle> obstacles_;
  std::vector<LooseBody> bodies_;
  std::vector<std::array<double, 3>> pulled_n_;  ///< each of them
  MujocoModel model_;
  MujocoData data_;
  FloatingBase base_;
  Touched touched_;
  std::vector<double> mass_, inertia_;  ///< of the file, by bodies
  std::vector<bool> of_robot_;  ///< by bodies
  int tip_{0};
  double mass_factor_{1};
  double inertia_factor_{1};
  double friction_factor_{1};
  double more_friction_{0};
  double payload_kg_{0};
  /// Joints of this world do not give way: what gears and skins do stands in here. MuJoCo's own; none: each shape's, as its scene says.
  std::optional<double> softness_s_{0.02};
};

}  // namespace hirosco::simulation
