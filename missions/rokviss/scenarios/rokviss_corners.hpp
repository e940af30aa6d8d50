// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// Every corner of the ranges that rokviss declares, flown on the whole spacecraft: what functions, writable parameters and
/// hands can be combined into, judged in the world's own trace by what the manipulator's descriptor promises (adr 0034).
namespace hirosco::simulation {

/// The largest sizes of what is felt outside the controller.
struct Loads {
  double torque_n_m{0};  ///< of a joint
  double force_n{0};  ///< of contact and spring on the tip
  double speed_rad_s{0};  ///< of a joint
  double motor_n_m{0};  ///< of a motor

  [[nodiscard]] bool within(const Loads& promise) const noexcept;
};

/// What the descriptor declares of its measured values: the ranges of CUR_VALUES.TORQUE, CUR_VALUES.VELOCITY, TIP_FORCE and
/// of the device's TORQUE. What declares none promises nothing and is held by nothing: 0.
[[nodiscard]] Loads promised_loads(const descriptor::Mission& mission);

/// A corner that trips the torque limit, flown again without that limit (adr 0048).
struct Unstopped {
  double torque_n_m{0};  ///< largest of a joint
  std::string end{};
};

struct Corner {
  std::string mode{};
  std::string what{};
  Loads loads{};
  std::string end{};  ///< state of the manipulator and what it told of its limits
  std::optional<Unstopped> unstopped{};
};

struct CornerSettings {
  std::filesystem::path mission{};  ///< the mission file
  std::uint64_t seed{1};
  /// The bug to be found: the limits that the control law keeps to are raised to this, N m; 0 = as declared.
  double planted_limit_n_m{0};
  /// Every n-th corner only.
  std::size_t one_in{1};
};

struct CornerTable {
  Loads promise{};
  std::vector<Corner> corners{};

  [[nodiscard]] std::size_t beyond() const noexcept;  ///< corners that are not within the promise
  [[nodiscard]] std::size_t tripped() const noexcept;  ///< that trip the torque limit
  [[nodiscard]] std::size_t tripping_harder()
      const;  ///< of these, that go on to the hard limit where nothing stops them
  [[nodiscard]] std::string text() const;  ///< one line per corner, the promise and the verdict
};

/// Throws std::runtime_error when the mission cannot be flown.
[[nodiscard]] CornerTable fly_corners(const CornerSettings& settings);

}  // namespace hirosco::simulation
