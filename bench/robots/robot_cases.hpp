// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace hirosco::simulation {
class Flight;
}

/// An arm in worlds that differ from its file: a mission that `hirosco new robot` made, on virtual time, judged by what its world tells.
namespace hirosco::bench {

/// What is required of every arm in every case.
inline constexpr double most_joint_error_rad = 1e-3, most_tool_error_m = 1e-3, most_beside_line_m = 2e-3;

struct RobotCase {
  std::string name;
  std::vector<std::string> differs;  ///< fault lines of its world
  bool loaded{false};  ///< something hangs at the tool
  double declared_kg{0};  ///< told to the arm by SET_PAYLOAD
};
/// As the file says; links a tenth heavier; inertias; friction of a tenth of what the weakest drive can, in every joint; 2 kg at the tool, not
/// declared and declared. `weakest`: that effort, N m or N.
[[nodiscard]] std::vector<RobotCase> robot_cases(double weakest);

/// What an arm is flown to: of its file alone, the same at each call.
struct RobotTask {
  std::string subsystem, device;  ///< names in its mission
  std::string tip;  ///< link
  std::vector<std::string> joints;
  double weakest{0};  ///< effort
  struct Goal {
    std::vector<double> joints;
    bool loaded{
        true};  ///< the drives hold 2 kg at the tool there, and on the way to and from the next such goal; else it is flown without
  };
  std::vector<Goal>
      goals;  ///< of MOVE_J, one after the other; the last one is where lines begin, and whoever carries something
  std::vector<std::vector<double>> lines;  ///< x y z, m: there and back; such as joints, velocities and drives permit
};
/// Of any robot: to the goal of its README and back. In words why there is none.
[[nodiscard]] std::expected<RobotTask, std::string> first_task(const std::filesystem::path& mission);
/// Further goals, with a load, too, and lines. In words why there is none.
[[nodiscard]] std::expected<RobotTask, std::string> robot_task(const std::filesystem::path& mission);

struct CaseFound {
  /// Worst of all goals and lines, by the world. Joints: where MOVE_J was completed; turned: the tool, at the end of a line; tool: off that end, and
  /// off where a goal of MOVE_J has it; beside: of the line, on the way.
  double joint_rad{0}, turned_rad{0}, tool_m{0}, beside_m{0};
  int goals{0}, lines{0};  ///< that were reached
  std::vector<std::string> problems;

  [[nodiscard]] bool reaches_goals() const noexcept;  ///< of first_task()
  [[nodiscard]] bool holds() const noexcept;  ///< of robot_task()
};
/// `look`: at the flight, before it begins.
[[nodiscard]] CaseFound fly_case(const std::filesystem::path& mission, const RobotTask& task, const RobotCase& wanted,
                                 std::uint64_t seed, const std::function<void(simulation::Flight&)>& look = {});

}  // namespace hirosco::bench
