// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/abort_motion.hpp"
#include "subsystems/robot_arm/beforehand.hpp"
#include "subsystems/robot_arm/control/arrival.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/posture.hpp"
#include "subsystems/robot_arm/trouble.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Where the arm is to be from cycle to cycle, and how far a motion is, one at a time. It reports nothing: it says what is to be told.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class Guidance {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    Obstacles& obstacles;  ///< no goal is near them, and no way of joints
    Parameters& parameters;  ///< MOTION tells how far it is
    AbortPath& abort_path;
    const Posture& posture;
  };
  enum class End : std::uint8_t {
    None,  ///< not yet
    Reached,
    NotReached,  ///< its path has ended, and it is not there
    LineLost,  ///< the joints cannot follow: it brakes
    NoWay,  ///< it was judged before it went, and stands
    Judged,  ///< nothing was to move, and nothing is in the way
  };
  /// What a cycle has brought, in the order in which it is told.
  struct News {
    bool begun{false};  ///< it stands, and what waited for that moves it from now on
    bool half_way{false};  ///< once in a motion that has a goal
    End end{End::None};
    Reason why{};  ///< of LineLost and NoWay
  };
  explicit Guidance(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  [[nodiscard]] bool begun() const noexcept { return setpoints_.has_value(); }
  /// Takes the present position as the reference, to which it came by no way.
  void engage() noexcept;
  /// Goes back by the way it came, RETRACT_DISTANCE at most.
  void retract() noexcept;
  [[nodiscard]] bool retracting() const noexcept { return retracting_; }
  /// It brakes, or backs off from what it met: nothing that leads it anywhere.
  [[nodiscard]] bool comes_to_rest() const noexcept {
    return !at_rest() && (setpoints_->braking() || setpoints_->kind() == Setpoints::Kind::Retract);
  }

  // --- functions: refused, or running; all numbers in the order of the descriptor -----------------------------------------
  using Begin = Outcome (Guidance::*)(const FunctionValues&) noexcept;
  /// Its way is judged while it stands, in the next cycles, before it goes.
  [[nodiscard]] Outcome move_j(const FunctionValues& values) noexcept;
  /// The posture is looked for while it stands, in the next cycles, and judged; then the way to it, as move_j()'s.
  [[nodiscard]] Outcome move_p(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome move_l(const FunctionValues& values) noexcept;
  /// Back by the way it came.
  [[nodiscard]] Outcome retreat(const FunctionValues& values) noexcept;
  /// Out by the stored path, which is judged while it stands, in the next cycles.
  [[nodiscard]] Outcome move_abort(const FunctionValues& values) noexcept;
  /// The stored path alone is judged; nothing moves.
  [[nodiscard]] Outcome check_abort() noexcept;
  [[nodiscard]] bool only_judges() const noexcept { return abort_.only_judges(); }
  /// One of these, of who comes_to_rest(): it begins once it stands, unless end_motion() comes before.
  [[nodiscard]] Outcome once_it_stands(Begin way_out, const FunctionValues& values) noexcept;
  [[nodiscard]] bool waits() const noexcept { return waiting_.has_value(); }
  [[nodiscard]] Outcome jog_j(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome jog_l(const FunctionValues& values) noexcept;
  /// Torques lead it from now on: it is wherever they have it.
  void lead() noexcept;
  /// No faster than POWER_LIMIT permits while joints hold so much.
  void keep_power(const JointVector& held) noexcept {
    setpoints_->keep_power(held, parts_.parameters.power_limit_w.load());
  }
  /// The motion that was begun last is a jog that was begun so: another one may take its place, from the velocities that it has.
  [[nodiscard]] bool jogs(Begin by) const noexcept { return jog_ == by; }
  /// Whatever its time was, and whatever was looked for: nobody waits for it any more.
  void end_motion() noexcept {
    jog_left_s_ = 0, jog_ = nullptr;
    waiting_.reset(), abort_.end(), before_.end();
  }

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  /// `led`: it is to be wherever it is.
  void advance(bool led) noexcept;
  /// It has come to the end of its way back: how far that was, rad or m. Once.
  [[nodiscard]] std::optional<double> end_retract() noexcept;
  /// MOTION.
  void tell() noexcept;
  /// Of the motion that was begun last, while somebody waits for it. Who `gives_way` is wherever he was pushed, and done with his path.
  [[nodiscard]] News look(bool gives_way) noexcept;

  [[nodiscard]] Setpoints& setpoints() noexcept { return *setpoints_; }
  [[nodiscard]] const Setpoints& setpoints() const noexcept { return *setpoints_; }
  [[nodiscard]] bool at_rest() const noexcept { return setpoints_->at_rest(); }

 private:
  [[nodiscard]] News lose_line() noexcept;
  [[nodiscard]] News wait() noexcept;
  [[nodiscard]] Outcome judge_abort(AbortWay::Judged what, double speed_share) noexcept;
  [[nodiscard]] News look_at_abort(bool gives_way) noexcept;
  [[nodiscard]] double progress() const noexcept;
  [[nodiscard]] Outcome start(const Result<>& planned) noexcept;
  [[nodiscard]] Outcome start_jog(Begin by, double seconds) noexcept;
  [[nodiscard]] End arrive(bool gives_way) noexcept;

  Parts parts_;
  std::optional<Setpoints> setpoints_;
  Beforehand before_{{parts_.known, parts_.obstacles}};
  /// RETREAT or MOVE_ABORT of who does not stand yet.
  struct Waiting {
    Begin begin{nullptr};
    FunctionValues values;
    double left_s{0};
  };
  std::optional<Waiting> waiting_;
  AbortMotion abort_{parts_.abort_path, longest_motion_s};
  Arrival arrival_;  ///< of the motion that was begun last
  double cycle_s_{0.001};
  double jog_left_s_{0};
  Begin jog_{nullptr};  ///< the one that is under way
  bool retracting_{false};
};

}  // namespace hirosco::robot_arm
