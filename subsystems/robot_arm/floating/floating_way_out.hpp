// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "subsystems/robot_arm/abort_motion.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/no_way_out.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Out for an arm whose base floats (docs/adr/0209): back by the way that its joints came, or by the stored path, with the setpoints and the judgement of the arm that stands. Its
/// postures are those of the joints, whatever the base does meanwhile.
/// Realtime: bounded, no allocation, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingWayOut {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    AbortPath& abort_path;
  };
  explicit FloatingWayOut(const Parts& parts) noexcept;

  /// In configure(), when drives have begun.  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  [[nodiscard]] bool begun() const noexcept { return setpoints_.has_value(); }
  /// It stands where it is measured, and came by no way.
  void forget_way() noexcept;
  /// Each cycle in which somebody else has the joints, whom it may be led back along.
  void record() noexcept;

  // --- functions: why not, or it is under way -----------------------------------------------------------------------------
  enum class By : std::uint8_t {
    WayBack,  ///< that it came, so far, rad or m
    AbortPath,  ///< judged while the arm stands, in the next cycles, and gone with this share of the joints' velocities
  };
  [[nodiscard]] std::optional<NoWayOut> begin(By by, double number) noexcept;
  /// Back by the way that it came, so far, from the velocities that it is measured with; false: it came by none.
  [[nodiscard]] bool retract(double distance) noexcept;
  [[nodiscard]] bool retracts() const noexcept { return retreats_; }
  /// Likewise in the next step(): of who does not stand yet, and is stepped once he does.
  void wait(By by, double number) noexcept { waiting_ = Waiting{by, number}; }
  [[nodiscard]] std::optional<NoWayOut> check_abort() noexcept;

  enum class At : std::uint8_t {
    OnWay,  ///< or judged yet
    Judged,  ///< nothing was to move, and nothing is in the way
    Last,  ///< the setpoint has come to its end
    Lost,  ///< it rests elsewhere
    NoWay,  ///< why()
  };
  /// Each cycle while it is under way and the arm stands, or is led by it.
  [[nodiscard]] At step() noexcept;
  /// Joints go no faster from now on than their power permits.
  void keep_power(double limit_w) noexcept {
    setpoints_->keep_power(JointVector::Zero(static_cast<Eigen::Index>(parts_.known.joints())), limit_w);
  }
  /// Nobody waits for it any more.
  void end() noexcept { retreats_ = false, abort_.end(), waiting_.reset(); }

  [[nodiscard]] bool under_way() const noexcept { return retreats_ || abort_.under_way() || waiting_; }
  [[nodiscard]] bool only_judges() const noexcept { return abort_.only_judges(); }
  /// It leads the joints: judged, where it is to be judged.
  [[nodiscard]] bool goes() const noexcept { return retreats_ || abort_.goes(); }
  /// Where the joints are to be, and how fast.
  [[nodiscard]] const Setpoint& now() const noexcept { return setpoints_->now(); }
  /// 0 to 1; 0 until it goes.
  [[nodiscard]] double progress() const noexcept;
  /// It has come to the end of its way back: how far that was, rad or m. Once.
  [[nodiscard]] std::optional<double> end_retreat() noexcept { return std::exchange(retreated_, std::nullopt); }
  /// Of NoWay.
  [[nodiscard]] const NoWayOut& why() const noexcept { return why_; }

 private:
  [[nodiscard]] std::optional<NoWayOut> retreat(double distance, const JointVector& velocity) noexcept;
  [[nodiscard]] std::optional<NoWayOut> judge(AbortWay::Judged what, double speed_share) noexcept;
  [[nodiscard]] At no_way(const NoWayOut& why) noexcept;
  [[nodiscard]] At step_back() noexcept;

  Parts parts_;
  std::optional<Setpoints> setpoints_;
  AbortMotion abort_;
  double retreat_{1};  ///< how far it is to go, rad or m
  bool retreats_{false};
  bool retreat_told_{true};
  std::optional<double> retreated_;
  /// What is to begin once it stands.
  struct Waiting {
    By by{};
    double number{0};
  };
  std::optional<Waiting> waiting_;
  NoWayOut why_;
};

}  // namespace hirosco::robot_arm
