// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "robotics/motion/inverse_kinematics.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/line_motion.hpp"
#include "subsystems/robot_arm/control/path_motion.hpp"
#include "subsystems/robot_arm/control/power_pace.hpp"
#include "subsystems/robot_arm/control/tool_kinematics.hpp"
#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {

/// What moves the setpoint. One at a time; whatever it is, the setpoint keeps the joints' ranges and velocities, and is brought to
/// rest by brake().
class Setpoints {
 public:
  enum class Kind : std::uint8_t { Rest, JointPath, Line, JointJog, TipJog, Retract, Follow };

  /// How it goes back: with which share of the velocities, and for how long at most.
  struct WayBack {
    double speed_share{0.25};
    double longest_s{10};
  };

  Setpoints(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s)
      : Setpoints{model, tip, bounds, cycle_s, WayBack{}} {}
  Setpoints(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s,
            const WayBack& way_back);

  /// Stands there from now on.
  void rest(const JointVector& position) noexcept;
  /// All joints at once, each by the same share of its way, jerk-limited, with this share of their velocities. InvalidArgument: as of PointToPoint.
  [[nodiscard]] Result<> go(const JointVector& goal, double speed_share) noexcept;
  /// So long it would take from one place to the other; infinitely, where go() would refuse.
  [[nodiscard]] double duration_s(const JointVector& from, const JointVector& goal, double speed_share) const noexcept {
    return path_.foreseen_s(from, goal, speed_share, power_);
  }
  /// The tool on a straight line: it stands until line() has found whether it can, and rests where it cannot. InvalidArgument: as of Line.
  /// Joints that it leaves free go to the posture that is preferred.
  [[nodiscard]] Result<> go_straight(const robotics::Pose& goal, const Line::Speed& speed,
                                     const PreferredPosture& preferred = {}) noexcept;
  /// The last one.
  [[nodiscard]] const Line& line() const noexcept { return line_.line(); }
  /// With these velocities from now on, until brake(); of the joints, or a twist [ω; v] of the tool in the axes of the base.
  void jog(const JointVector& velocity) noexcept;
  void jog(const Vector6& twist) noexcept;
  /// Comes to rest from here as fast as four times the accelerations permit, whatever way it was on.
  void halt(const JointVector& position, const JointVector& velocity) noexcept;
  /// As halt(), and tells no accelerations: a law that comes into force makes no step of them.
  void settle(const JointVector& position, const JointVector& velocity) noexcept;
  /// Goes back by the way it came, and rests. `distance`: in rad or m of whatever joint has the
  /// farthest to go, bit by bit; less where the way since begin() is shorter.
  void retract(const JointVector& position, const JointVector& velocity, double distance) noexcept;
  /// Stands there from now on, as rest(), and came by no way.
  void begin(const JointVector& position) noexcept;
  /// Somebody else has it there, who goes by: as rest(), and a place of the way that it came by.
  void pass(const JointVector& position) noexcept;
  /// Somebody else finds each setpoint, within the same limits: this is the next cycle's (Following).
  void take(const Setpoint& next) noexcept;
  /// Comes to rest: on its path, where there is one.
  void brake() noexcept;

  /// From now on it goes no faster than this power permits while joints hold so much; on its path, where there is one.
  void keep_power(const JointVector& held, double limit_w) noexcept { power_.set(held, bounds_, limit_w); }
  /// Likewise for whoever finds setpoints in its place.
  [[nodiscard]] const PowerPace& power() const noexcept { return power_; }

  /// Moves on by one cycle.
  const Setpoint& advance() noexcept;
  [[nodiscard]] const Setpoint& now() const noexcept { return now_; }
  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  [[nodiscard]] bool at_rest() const noexcept { return kind_ == Kind::Rest; }
  [[nodiscard]] bool braking() const noexcept { return braking_; }
  /// Where it would come to rest if it went on for a cycle and braked then: who brakes as soon as that is too far rests where it was not. Never nearer, but for the
  /// last digits of a line and what bends between two steps of its survey; on a path or a line a little farther (braking.hpp).
  [[nodiscard]] JointVector braked() const noexcept;
  /// Of the last path, or line: 0 to 1.
  [[nodiscard]] double progress() const noexcept { return on_line_ ? line_.progress() : path_.progress(); }
  /// The last retreat went as far as it was to, before its time was over.
  [[nodiscard]] bool retreated() const noexcept { return retract_left_s_ > 0; }
  /// Of the last retreat: how far it went, rad or m.
  [[nodiscard]] double retracted_by() const noexcept { return apart(now_.position, met_); }
  [[nodiscard]] double duration_s() const noexcept { return on_line_ ? line_.duration_s() : path_.duration_s(); }
  /// How far the setpoint's tool is from where its line has it, m; 0 without one.
  [[nodiscard]] double off_line_m() const noexcept { return kind_ == Kind::Line ? line_.off_m() : 0; }
  /// How far its line has led it.
  [[nodiscard]] double gone_m() const noexcept { return kind_ == Kind::Line ? line_.gone_m() : 0; }
  /// Of a line that cannot be followed: who is near an end of its range and on the way there; nobody: a singular posture is in the way.
  [[nodiscard]] std::optional<std::size_t> joint_in_the_way() const noexcept;
  /// Where the tool of the setpoint is.
  [[nodiscard]] robotics::Pose tool() noexcept { return tool_.pose(now_.position); }
  /// Where the tip is when the tool is there.
  [[nodiscard]] robotics::Pose tip_with(const robotics::Pose& tool) const noexcept { return tool_.tip_with(tool); }
  /// Where the tool is in the tip's frame; while nothing moves.
  void set_tool(const robotics::Pose& in_tip) noexcept { tool_.set_in_tip(in_tip); }

 private:
  void advance_line() noexcept;
  void advance_jog(const JointVector& wanted) noexcept;
  [[nodiscard]] JointVector way_back() noexcept;
  void follow(const JointVector& velocity) noexcept;
  void come_to_rest() noexcept;

  Bounds bounds_;
  double cycle_s_;
  WayBack back_;
  ToolKinematics tool_;
  robotics::InverseKinematics kinematics_;
  PathMotion path_;
  LineMotion line_;
  Setpoint now_;
  Kind kind_{Kind::Rest};
  bool braking_{false};
  bool tells_acceleration_{true};
  double urgency_{1};  ///< factor of accelerations while it halts
  bool on_line_{false};  ///< its last path is a line
  JointVector posture_;
  JointVector jog_;
  PowerPace power_;
  Trail trail_;
  JointVector met_, end_;  ///< of a retreat: where it begins and ends
  std::size_t places_back_{0};  ///< of the trail, before its end
  double left_behind_{0};  ///< from the next of these places to the end
  double retract_left_s_{0};
  Vector6 twist_{Vector6::Zero()};
};

}  // namespace hirosco::robot_arm
