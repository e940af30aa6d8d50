// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_arm/control/work_watch.hpp"
#include "subsystems/robot_arm/drives.hpp"

namespace hirosco::robot_arm {

/// Force at the tool and work of joints and tool, of an arm on whatever base: whether what is told of them keeps what was set (docs/adr/0178, 0184).
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class ToolWork {
 public:
  struct Parts {
    Drives& drives;
    Parameter<std::array<double, 3>>& force_n;  ///< TOOL_FORCE
    Parameter<double>& power_w;  ///< JOINT_POWER
    Parameter<double>& tool_power_w;  ///< TOOL_POWER
    Parameter<double>& force_limit_n;  ///< TOOL_FORCE_LIMIT
    Parameter<double>& power_limit_w;  ///< POWER_LIMIT
    Parameter<double>& tool_power_limit_w;  ///< TOOL_POWER_LIMIT
  };
  explicit ToolWork(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().
  void begin(double cycle_s) noexcept { cycle_s_ = cycle_s; }
  void arm() noexcept { watch_.arm(), free_s_ = waited_s_ = 0; }
  /// Something was told since it was armed.
  [[nodiscard]] bool tripped() const noexcept { return watch_.tripped(); }
  /// Each cycle, behind whoever tells what acts on the tool: what is to be told now; nothing mostly. `free`: no brakes hold it, in whatever law and motion.
  [[nodiscard]] std::optional<WorkFinding> update(bool free) noexcept;
  /// Brakes have just let it go: what the model feels by now is theirs.
  [[nodiscard]] bool lets_go() const noexcept { return free_s_ > 0 && !feels(); }
  /// As they are set.
  [[nodiscard]] WorkLimits limits() const noexcept;

  /// TOOL_FORCE and TOOL_POWER of what acts on the tool, N, either way; and JOINT_POWER of what is measured: how much work joints give. A joint that brakes takes it: that is none that it
  /// gives, and none of what another gives (docs/adr/0184).
  void tell(const Vector3& force_n, const Vector3& velocity_m_s) noexcept;

  /// A limit that the present load exceeds already would only stop the arm: what is more, and how much of it there is.
  struct Above {
    const char* what{""};
    double is{0};
  };
  /// It is set, N; or there is more.
  [[nodiscard]] std::optional<Above> set_force_limit(double force_n) noexcept;
  /// Likewise, W, of all joints and of the tool.
  [[nodiscard]] std::optional<Above> set_power_limits(double power_w, double tool_power_w) noexcept;

 private:
  [[nodiscard]] WorkWatch::Is is() const noexcept;
  [[nodiscard]] bool feels() const noexcept;
  [[nodiscard]] bool gives() const noexcept;

  Parts parts_;
  WorkWatch watch_;
  double cycle_s_{0.001};
  double free_s_{0};  ///< since brakes have let it go, as far as drives tell
  double waited_s_{0};  ///< since they were told to
};

}  // namespace hirosco::robot_arm
