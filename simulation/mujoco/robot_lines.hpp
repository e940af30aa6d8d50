// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/devices/words.hpp"
#include "simulation/mujoco/mujoco_robot.hpp"

namespace hirosco::simulation {

/// Lines of a device that change its robot in a world, whosever world it is:
///   tip LINK | posture Q1,Q2,... | rotors J1,J2,... | springs K1,K2,... [D1,D2,...] | mass FACTOR | inertia FACTOR | friction FACTOR [MORE] | payload KG | push X Y Z
class RobotLines {
 public:
  static constexpr std::array known{"tip",     "posture",  "rotors",  "springs", "mass",
                                    "inertia", "friction", "payload", "push"};
  [[nodiscard]] static bool knows(std::string_view word) noexcept;

  /// One of these lines. Why it is not done stays until the next one.
  [[nodiscard]] Result<> take(const Words& words, MujocoRobot& robot, std::size_t number);
  /// What is told of it at the start: what of its file's shapes touches nothing.
  [[nodiscard]] static std::vector<std::string> remarks(const MujocoRobot& robot, std::size_t number);
  /// Tip and contacts, as words of a truth.
  [[nodiscard]] static std::string truth(const MujocoRobot& robot, std::size_t number);
  /// Joint `joint` of the world as words of a truth, where it is the device's `index`th.
  [[nodiscard]] static std::string truth_of_joint(const MujocoRobot& robot, std::size_t joint, std::size_t index);

 private:
  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, std::string why);
  [[nodiscard]] Result<> give_way(const Words& words, MujocoRobot& robot, std::size_t number);
  /// A,B,...: as many as it has joints.
  [[nodiscard]] Result<std::vector<double>> each_joint(std::string_view text, const MujocoRobot& robot,
                                                       std::size_t number);
  [[nodiscard]] Result<> place(const Words& words, MujocoRobot& robot, std::size_t number);
  [[nodiscard]] Result<> differ(const Words& words, MujocoRobot& robot, std::size_t number);

  std::string problem_;
};

}  // namespace hirosco::simulation
