// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_beforehand.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_doing.hpp"
#include "subsystems/robot_arm/floating/floating_drive.hpp"
#include "subsystems/robot_arm/floating/floating_jog.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"
#include "subsystems/robot_arm/floating/floating_way_out.hpp"
#include "subsystems/robot_arm/floating/kept_joints.hpp"
#include "subsystems/robot_arm/floating/kept_tool.hpp"
#include "subsystems/robot_arm/floating/soft_law.hpp"
#include "subsystems/robot_arm/floating/stop_ramp.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/posture.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Where joints and tool of a craft that floats are to be from cycle to cycle, how fast the joints go for that, and how far a motion is, one at a
/// time. It reports nothing: it says what is to be told. What telecommands ask of it is FloatingMotions'.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingGuidance : public FloatingDoing {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    const FloatingCraft& craft;
    Obstacles& obstacles;  ///< no goal of joints is near them, and no way of the tool
    FloatingParameters& parameters;  ///< PROGRESS, PHASE and ERR tell how far it is
    AbortPath& abort_path;
    const Posture& posture;
  };
  /// What a cycle has brought to the motion.
  enum class News : std::uint8_t {
    None,
    Reached,
    NotReached,  ///< its path has ended, and it is not there
    IllConditioned,  ///< it cannot move the tool and leave the base unturned
    NoWay,  ///< its way was judged before it went, and it stands: why()
    Judged,  ///< nothing was to move, and nothing is in the way
  };
  explicit FloatingGuidance(const Parts& parts) noexcept
      : parts_{parts},
        before_{{parts.known, parts.drives, parts.obstacles}},
        out_{{parts.known, parts.drives, parts.abort_path}},
        jog_{{parts.known, parts.drives, parts.craft, parts.parameters}},
        kept_{{parts.craft, parts.parameters}},
        joints_{parts.drives},
        drive_{{parts.known, parts.drives, parts.craft, parts.obstacles, parts.parameters}} {}

  /// In configure(), when drives and craft have begun.  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  /// Takes the present place as the reference, to which it came by no way: entering Operational moves nothing. What only judges goes on.
  void engage() noexcept;
  /// Keeps joints and tool where they are; who holds, his base, too, where it was let go.
  void stand() noexcept;
  /// A motion goes on no further: it keeps to what it came to.
  void end_motion() noexcept;
  /// From these velocities to rest in so long, wherever it was to go; then it stands.
  void stop(const JointVector& rates, double span_s = StopRamp::span_s) noexcept;

  /// As hard as it may from the velocities that are measured: what it was met with.
  void halt() noexcept;
  /// Backs off from there by the way it came, so far; who came by none stands.
  void retract(double distance) noexcept;
  /// Whoever leads it has it: it is to be where it is, and came by no way.
  void let_go() noexcept;
  /// Where it stands it is held so from now on, until it is told to or engages: hard (Position), or by springs. They begin where it is; springs of the same kind go on from where they are.
  void hold_by(LawKind kind) noexcept;
  /// Of who follows: Lead has them then.
  [[nodiscard]] Setpoints& setpoints() noexcept { return jog_.setpoints(); }

  /// What is at the tip from now on, of ways that are judged. The craft has it already.
  void carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept {
    before_.carry(tool_in_tip, payload);
  }
  /// While it holds: where the tool is, that is another one now, it is to be.
  void take_tool() noexcept { kept_.keep(), kept_.forget_error(); }

  /// What waits begins no more; what comes to rest goes on to do so.
  void call_off() noexcept { out_.end(); }
  [[nodiscard]] bool only_judges() const noexcept { return out_.only_judges(); }

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  [[nodiscard]] News advance() noexcept;
  /// Of NoWay.
  [[nodiscard]] const FloatingReason& why() const noexcept { return why_; }
  /// It has come to the end of its way back: how far that was, rad or m. Once.
  [[nodiscard]] std::optional<double> end_retreat() noexcept { return out_.end_retreat(); }
  /// rad/s or m/s of each joint, none faster than it may be; of who gives way as they are.
  [[nodiscard]] JointVector wanted_rates() const noexcept;
  /// Of springs.
  [[nodiscard]] SoftGoal goal() const noexcept;
  /// Of torques.
  [[nodiscard]] const Driven& torques() const noexcept { return drive_.driven(); }
  /// A law of the tool has them, or they come to rest: of paths of joints both ends are in range, and so is what is between.
  [[nodiscard]] bool may_end_range() const noexcept { return (keeps_tool() && !gives_way()) || stops(); }
  /// PHASE and ERR. `braked`: the brakes hold it.
  void tell(bool braked) noexcept;
  [[nodiscard]] bool retracts() const noexcept { return out_.retracts(); }

 protected:
  void start(Phase phase, double duration_s) noexcept;

  Parts parts_;
  FloatingBeforehand before_;
  FloatingWayOut out_;
  FloatingJog jog_;
  KeptTool kept_;
  KeptJoints joints_;
  FloatingDrive drive_;

  double cycle_s_{0.001};

 private:
  void come_to_hold() noexcept;
  [[nodiscard]] News go_out() noexcept;
  [[nodiscard]] News jog_on() noexcept;
  [[nodiscard]] News come_to_rest() noexcept;
  [[nodiscard]] News judge() noexcept;
  [[nodiscard]] News arrive() noexcept;
  [[nodiscard]] bool keeps_tool() const noexcept;

  double moved_s_{0}, duration_s_{0}, settled_s_{0};
  StopRamp stop_;
  bool stands_behind_drive_{false};  ///< whoever drove it waits for that
  FloatingReason why_;
};

}  // namespace hirosco::robot_arm
