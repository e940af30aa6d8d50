// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "subsystems/robot_arm/abort_path.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/no_way_out.hpp"

namespace hirosco::robot_arm {

/// MOVE_ABORT and CHECK_ABORT under way: the stored path is judged while the arm stands, and gone from posture to posture.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class AbortMotion {
 public:
  /// `longest_s`: a telecommand is waited for a little longer.
  AbortMotion(AbortPath& path, double longest_s) noexcept : path_{path}, longest_s_{longest_s} {}

  /// The path has begun to be judged; then it is gone with this share of the joints' velocities, where that is to be.
  void begin(AbortWay::Judged what, double speed_share) noexcept;
  /// Nobody waits for it any more.
  void end() noexcept { phase_ = Phase::None; }
  [[nodiscard]] bool under_way() const noexcept { return phase_ != Phase::None; }
  [[nodiscard]] bool only_judges() const noexcept { return under_way() && what_ == AbortWay::Judged::PathAlone; }
  /// It was judged, and leads the arm.
  [[nodiscard]] bool goes() const noexcept { return phase_ == Phase::Goes; }

  enum class At : std::uint8_t {
    OnWay,  ///< or judged yet
    Judged,  ///< nothing was to move, and nothing is in the way
    Last,  ///< the setpoint has come to the last posture
    Lost,  ///< it rests elsewhere
    NoWay,  ///< why()
  };
  /// Each cycle while it is under way.
  [[nodiscard]] At step(Setpoints& setpoints) noexcept;
  /// Of NoWay.
  [[nodiscard]] const NoWayOut& why() const noexcept { return why_; }

  // --- of all, while it goes ----------------------------------------------------------------------------------------------
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  /// 0 to 1; its time was foreseen with the power of where it began.
  [[nodiscard]] double progress(const Setpoints& setpoints) const noexcept;

 private:
  enum class Phase : std::uint8_t { None, Judged, Goes };
  [[nodiscard]] At judge(Setpoints& setpoints) noexcept;
  [[nodiscard]] At set_out(Setpoints& setpoints) noexcept;
  [[nodiscard]] At no_way(const NoWayOut& why) noexcept;
  [[nodiscard]] bool go(Setpoints& setpoints) noexcept;

  AbortPath& path_;
  double longest_s_;
  Phase phase_{Phase::None};
  AbortWay::Judged what_{};
  double speed_share_{0};
  std::size_t posture_{0};  ///< to which it goes, from 0
  double gone_s_{0};  ///< behind which it was before
  double duration_s_{0};
  NoWayOut why_;
};

}  // namespace hirosco::robot_arm
