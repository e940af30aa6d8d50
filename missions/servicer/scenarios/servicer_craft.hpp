// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "simulation/mujoco/mujoco_device.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

namespace hirosco::simulation {

/// Of what measures where the base is.
enum class Noise : std::uint8_t { AsDeclared, None };

struct ServicerOptions {
  std::filesystem::path mission;  ///< the mission file
  std::uint64_t seed{1};
  std::string mode{"track"};
  std::string posture{};  ///< empty: the mission's
  Noise noise{Noise::AsDeclared};
  /// Texts that stand in for files, by file name.
  std::map<std::string, std::string> files{};
  /// Of the arm's device, behind those of the mission.
  std::vector<descriptor::Setting> arm_settings{};
  SubsystemCatalogue subsystems{};  ///< besides modules
};

/// The servicer in a mode, with what its world tells.
class ServicerCraft {
 public:
  /// Throws std::runtime_error with the supervisor's story when the mode is not reached.
  explicit ServicerCraft(const ServicerOptions& options);

  [[nodiscard]] Flight& flight() noexcept { return flight_; }
  [[nodiscard]] Spacecraft& craft() noexcept { return flight_.craft(); }
  void run(double seconds);
  [[nodiscard]] double time_s() { return seconds(craft().now() - TimePoint{}); }
  /// From ground; returns when it is under way, with the time of that. Throws std::runtime_error when it does not begin within a second.
  double begin(std::string_view function, const std::vector<Value>& arguments);
  /// After each millisecond of the arm's control; where its process is gone, of nobody's.
  void each_cycle(std::function<void()> watch);

  using Place = std::array<double, 3>;
  [[nodiscard]] const MujocoRobot& robot() const noexcept { return arm_->robot(); }
  [[nodiscard]] Place tool_m() const;
  /// By which angle the base is turned away from where it was when the world began, and how fast it turns.
  [[nodiscard]] double base_deg() const;
  [[nodiscard]] double base_deg_s() const;
  [[nodiscard]] double fastest_joint_rad_s() const;
  /// What all momentum is, the wheels' included.
  [[nodiscard]] double momentum_n_m_s() const;

 private:
  static Plan plan_of(const ServicerOptions& options);
  Flight flight_;
  MujocoDevice* arm_{nullptr};
};

}  // namespace hirosco::simulation
