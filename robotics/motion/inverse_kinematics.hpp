// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "hirosco/utilities/result.hpp"
#include "robotics/dynamics/dynamics.hpp"

namespace hirosco::robotics {

struct InverseKinematicsOptions {
  double singular{0.05};  ///< below this smallest singular value of the Jacobian it is damped, the more the smaller
  double damping{0.1};  ///< at a singularity; at most this much of a twist becomes that much faster joints
  double posture_gain{1};  ///< 1/s, with which joints that are free go to the posture
  double margin{0.05};  ///< rad or m before a limit in which a joint is slowed down on its way there
  double tolerance{1e-9};  ///< rad and m, of solve()
  int most_iterations{200};  ///< of solve()
  /// Of solve(): it goes on until no joint would move by more, rad or m, so that what is left over has come to the posture, too. Infinite: with the tip in its place it is done.
  double settled{INFINITY};
};

/// From what a tip is to do to what the joints do: damped least squares, what is left over goes towards a posture, and no joint beyond
/// its limits. The same question has the same answer.
/// Realtime: construction allocates, nothing else; bounded by joints and iterations. Thread: one.
class InverseKinematics {
 public:
  /// `model` must outlive this.
  InverseKinematics(const Model& model, FrameId tip, const InverseKinematicsOptions& options);

  /// Joint velocities for a twist [ω; v] of the tip's origin in inertial axes. `dynamics` was updated with a state of these `q`; of a free base it
  /// is the generalised Jacobian that counts. What cannot be had is left out: along a singularity, and where a limit is in the way.
  void rates(Dynamics& dynamics, const Vector6& twist, const JointVector& q, const JointVector& posture,
             JointVector& qd) const noexcept;

  /// Where the joints are with the tip in a place, of a base that is fixed at the inertial origin: from `q`, on the branch that is nearest.
  /// How many iterations it took. Unavailable: not reached; `q` is as near as it came.
  [[nodiscard]] Result<int> solve(const Pose& tip, const JointVector& posture, JointVector& q) noexcept;
  /// What is left to a place, of a base as solve() has it: how it is to be turned about the inertial axes, rad, and the way, m.
  [[nodiscard]] Vector6 left(const Pose& tip, const JointVector& q) noexcept;
  /// Of the Jacobian there, of such a base: 0 in a singular posture. Of fewer than 6 joints, the one with which the last of them moves the tip.
  [[nodiscard]] double smallest_singular_value(const JointVector& q) noexcept;

 private:
  const Model* model_;
  FrameId tip_;
  InverseKinematicsOptions options_;
  Dynamics dynamics_;
  State state_;
};

}  // namespace hirosco::robotics
