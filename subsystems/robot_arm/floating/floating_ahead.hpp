// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/range_ends.hpp"
#include "subsystems/robot_arm/floating/stop_ramp.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// What the noise of the base's pose may bring links nearer to each other than where they are too near: the tool shakes by up to 0.42 mm (SV3). Who holds it,
/// where a motion was stopped for that, may come so much nearer once more before brakes hold him.
inline constexpr double shakes_m = 0.002;

/// Where joints of a craft that floats would come if they were stopped now: to an end of a range, or near to somebody (docs/adr/0174, 0180).
/// Realtime: wait-free. Thread: the cycle.
class FloatingAhead {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    const FloatingCraft& craft;
    Obstacles& obstacles;
  };
  explicit FloatingAhead(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().
  void begin(double cycle_s) noexcept { cycle_s_ = cycle_s; }
  /// Who of joints that go like that goes to an end of its range too fast to stand before it.
  [[nodiscard]] std::optional<EndAhead> end(const JointVector& rates) const noexcept {
    return end_ahead(parts_.drives.measured().position, rates, parts_.known.bounds(), parts_.craft.followed_per_s());
  }
  enum class Doing : std::uint8_t { Goes, Holds };
  /// Who would be too near somebody, or to a volume.
  [[nodiscard]] std::optional<Obstacles::Nearest> near(const JointVector& rates, Doing what) noexcept {
    const Measured& measured = parts_.drives.measured();
    const JointVector there =
        measured.position + StopRamp::way(rates, measured.velocity, cycle_s_, parts_.craft.followed_per_s());
    return what == Doing::Holds ? parts_.obstacles.near_at(there, 2 * shakes_m)
                                : parts_.obstacles.near_on_way(measured.position, there, shakes_m);
  }

 private:
  Parts parts_;
  double cycle_s_{0.001};
};

}  // namespace hirosco::robot_arm
