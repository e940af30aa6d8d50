// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/handler.hpp"
#include "robotics/shapes/clearance.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// As numbers of reports have them.
[[nodiscard]] inline std::int64_t millimetres(double metres) noexcept {
  return static_cast<std::int64_t>(std::clamp(1e3 * metres, -1e6, 1e6));
}

/// What links of an arm, on whatever base, must not come near: each other, that base, and volumes that are kept out of. It tells before they do; to
/// brake is others' to do.
/// Realtime: wait-free, but read(). Thread: the cycle, and the service loop while there is none.
class Obstacles {
 public:
  using Nearest = robotics::Clearance::Nearest;

  /// Of the descriptor.
  struct Parts {
    Parameter<double>& limit_m;  ///< CLEARANCE_LIMIT
    Parameter<double>& clearance_m;  ///< CLEARANCE tells how near they are
    Parameter<KeepOut>& kept_out;  ///< KEPT_OUT
  };
  explicit Obstacles(const Parts& parts) noexcept : parts_{parts} {}
  /// The words of an error that it gave live as long as it does, where it is.
  Obstacles(const Obstacles&) = delete;
  Obstacles& operator=(const Obstacles&) = delete;

  /// The shapes of all links; of those that somebody else's joints move, all over their ranges. Meshes beside the file, too. Of what is wrong in them the first is told; what is not seen, to whoever reads standard
  /// error.  Realtime: allocates. Thread: the service loop.
  /// `tip`: of an arm that may carry() something.
  [[nodiscard]] Result<> read(const UrdfArm::Source& source, const robotics::Model& model,
                              std::optional<robotics::FrameId> tip = std::nullopt);
  /// As it was written last.
  void take_limit() noexcept { clearance_->set_limit(parts_.limit_m.load()); }
  /// These volumes from now on, in the base's axes.
  [[nodiscard]] Outcome keep_out(const KeepOut& numbers) noexcept;

  /// A tool and a payload (docs/adr/0194) from now on, each from the tip's origin to there, in its frame, with all that is so near to that line; there itself: none.
  void carry(const Vector3& tool_m, const Vector3& payload_m, double radius_m) noexcept;

  /// Tells how near they are with the joints there.
  void tell(const JointVector& position) noexcept;
  /// Who would be nearer at `goal` than they may, and by more than `by_m` than they are at `now`; infinitely far: nobody.
  [[nodiscard]] Nearest nearer(const JointVector& now, const JointVector& goal,
                               double by_m = robotics::Clearance::same_m) noexcept {
    return clearance_->nearer(now, goal, by_m);
  }
  /// Who is nearer there than they may be, wherever they come from; infinitely far: nobody.
  [[nodiscard]] Nearest too_near(const JointVector& position) noexcept { return clearance_->too_near(position); }
  /// Of who is measured with noise: who would be too near in that posture, and by more than `noise_m` nearer than in the last place where nobody was.
  /// What shakes about the limit comes no nearer by that, however often it begins.
  [[nodiscard]] std::optional<Nearest> near_at(const JointVector& posture, double noise_m) noexcept;
  /// Likewise of one that is `here` and goes there. Who was stopped, and has shaken a little farther while he held, may go away: within twice the noise, on no way
  /// that comes nearer.
  [[nodiscard]] std::optional<Nearest> near_on_way(const JointVector& here, const JointVector& posture,
                                                   double noise_m) noexcept;
  /// Of near_at(): it comes by there.
  void pass(const JointVector& now) noexcept {
    if (clearance_->keeps_limits(now)) clear_at_ = now;
  }
  /// Of near_at(): it stands there, near or not, and may go away.
  void stand_at(const JointVector& position) noexcept { clear_at_ = position; }
  /// Each cycle: who would meet, if it is not braked now. Who is too near already may go away.
  [[nodiscard]] std::optional<Nearest> watch(const Setpoints& setpoints) noexcept;
  /// Each cycle in which it gives way: who would meet soon. CLEARANCE tells of where it is.
  [[nodiscard]] std::optional<Nearest> watch_led(const Measured& measured) noexcept;

 private:
  Parts parts_;
  std::optional<robotics::Clearance> clearance_;
  JointVector clear_at_;  ///< of near_at()
  robotics::urdf::NotRead not_read_;  ///< of shapes, for whoever reads the refusal
};

}  // namespace hirosco::robot_arm
