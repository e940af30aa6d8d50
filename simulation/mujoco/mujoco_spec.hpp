// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "simulation/mujoco/floating_base.hpp"
#include "simulation/mujoco/mount.hpp"
#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {

struct MujocoFree {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
  void operator()(mjSpec* spec) const noexcept { mj_deleteSpec(spec); }
};
using MujocoModel = std::unique_ptr<mjModel, MujocoFree>;
using MujocoData = std::unique_ptr<mjData, MujocoFree>;

/// A joint of the file that moves by itself.
struct DrivenJoint {
  std::string name;
  double effort{0};
  bool of_scene{false};  ///< how the ends of its range give way its file says
};

/// As MuJoCo calls a link: one of the name of MuJoCo's own world has another one.
[[nodiscard]] std::string body_name(const std::string& link);
/// What MuJoCo has said against it, in one line.
[[nodiscard]] std::string error_of(mjSpec& spec);
/// A body without mass at the origin of this one, by this name, in place of the one that has it. False: there is no such body.
[[nodiscard]] bool hang_payload(mjSpec& spec, const std::string& carrier, const std::string& name);

/// What MuJoCo is told of a world: of its robots, each as its file says (mujoco_urdf.hpp, mujoco_scene.hpp). Compiled anew whenever
/// an obstacle, a loose body or another robot comes to it or goes.  Realtime: allocates. Thread: one.
class MujocoSpec {
 public:
  static constexpr double longest_sub_step_s = 0.0005;
  static constexpr double friction_s = 0.001;  ///< time constant by which dry friction and mimics give way
  static constexpr double end_s =
      0.002;  ///< by which the ends of ranges do: MuJoCo's own lets light fingers millimetres beyond theirs
  static constexpr const char* payload_body = "hirosco_payload";

  /// What a file says.
  struct Content {
    std::unique_ptr<mjSpec, MujocoFree> spec{};
    std::vector<DrivenJoint> joints{};
    std::string root{};  ///< as MuJoCo calls it
    bool of_scene{false};
    std::size_t further_dofs{0};
    std::size_t equalities{0};
    std::size_t pairs_left_out{0};  ///< of bodies that pass through each other
    std::map<std::string, std::string> octets{};  ///< of files, by the names that MuJoCo is told
    std::vector<std::string> left_out{};  ///< what of its shapes does not touch, each in words
  };
  explicit MujocoSpec(Content content);

  /// One of those that are in it: the first one is that whose world it is, the others are mounted there.
  struct Robot {
    std::string prefix;  ///< of its links and joints; the first one has none
    std::size_t first_joint{0};
    std::size_t joints{0};
    bool of_scene{false};  ///< its contacts and the ends of its ranges are as its MJCF file says
    std::vector<std::string> left_out;  ///< what of its file's shapes does not touch, each in words
  };
  /// The same with this robot in it (mujoco_mount.cpp): its names have the mount's before them, and what of it touches meets the others and
  /// all that stands and lies there. In words why not.
  [[nodiscard]] std::expected<MujocoSpec, std::string> with(MujocoSpec robot, const Mount& mount) const;
  [[nodiscard]] const std::vector<Robot>& robots() const noexcept { return robots_; }
  /// What is between a joint's drive and its link (mujoco_springs.cpp).
  struct Spring {
    double stiffness{0};  ///< N m/rad or N/m; 0: nothing gives way
    double damping{0};
    double rotor{0};  ///< what its drive moves on the other side, kg m2 or kg: more than 0 where it gives way
  };
  /// The same with joints of one of its robots that give way: its first ones, as many as there are springs. In words why not.
  [[nodiscard]] std::expected<MujocoSpec, std::string> giving_way(std::span<const Spring> springs,
                                                                  std::size_t robot) const;
  static constexpr const char* spring_mark = " spring";  ///< behind a joint's name, of what of it is the spring's
  /// Whose this body of such a model is. What is nobody's else is the first one's.
  [[nodiscard]] std::size_t robot_of(const mjModel& model, int body) const noexcept;

  /// Robot by robot, each in the order of its URDF file.
  [[nodiscard]] const std::vector<DrivenJoint>& joints() const noexcept { return joints_; }
  /// Of what moves besides them: what mimics them, and whatever else a scene has.
  [[nodiscard]] std::size_t further_dofs() const noexcept { return further_dofs_; }
  /// Its contacts and drives are as its file says, and not all that moves is the robot.
  [[nodiscard]] bool is_scene() const noexcept { return robots_.front().of_scene; }
  /// What pushes and hangs on a robot does so at the origin of this link; at first of the first one that carries nothing. False: it has no such link.
  [[nodiscard]] bool hang_payload_on(const std::string& link, std::size_t robot = 0);
  /// From now on nothing holds the root link (floating_base.hpp). In words why not.
  [[nodiscard]] std::expected<void, std::string> let_float();
  [[nodiscard]] bool floats() const noexcept { return floats_; }
  [[nodiscard]] const std::string& root() const noexcept { return root_; }  ///< as MuJoCo calls it
  /// What of the file's shapes does not touch, each in words.
  [[nodiscard]] const std::vector<std::string>& left_out(std::size_t robot = 0) const noexcept {
    return robots_[robot].left_out;
  }
  /// Loose bodies are the last of the model's bodies and joints, in their order here.
  [[nodiscard]] std::expected<MujocoModel, std::string> compile(std::span<const Obstacle> obstacles,
                                                                std::span<const LooseBody> bodies = {}) const;
  /// Name of the obstacle that a geom of such a model is; empty: it is a link's.
  [[nodiscard]] static std::string_view obstacle_of(const mjModel& model, int geom) noexcept;
  /// The same for a loose body.
  [[nodiscard]] static std::string_view loose_body_of(const mjModel& model, int geom) noexcept;

 private:
  MujocoSpec() = default;
  [[nodiscard]] std::expected<MujocoSpec, std::string> copied() const;

  std::unique_ptr<mjSpec, MujocoFree> spec_;
  std::vector<DrivenJoint> joints_;
  std::string root_;
  bool floats_{false};
  std::size_t further_dofs_{0};
  std::size_t equalities_{0};
  std::size_t pairs_left_out_{0};
  std::map<std::string, std::string> octets_;  ///< of files, by the names that MuJoCo is told
  std::vector<Robot> robots_{1};
};

}  // namespace hirosco::simulation
