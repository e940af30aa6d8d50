// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/dynamics/integrator.hpp"

#include <array>

namespace hirosco::robotics {
namespace {

constexpr Error diverged{ErrorCode::OutOfRange, "the motion has become no number: the step may be too long for it"};

}  // namespace

Integrator::Integrator(Dynamics& dynamics) noexcept : dynamics_{&dynamics} {}

Result<> Integrator::acceleration(const State& state, double t_s, const Force& force,
                                  Coordinates& acceleration) noexcept {
  const auto joints = dynamics_->model().joints();
  const int first = dynamics_->coordinate_count() - dynamics_->model().joint_count();
  dynamics_->update(state);
  force_.setZero(dynamics_->coordinate_count());
  force.at(t_s, force_);
  for (int i = 0; i < dynamics_->model().joint_count(); ++i)
    force_[first + i] -= joints[static_cast<std::size_t>(i)].damping * state.qd[i];
  return dynamics_->forward(force_, acceleration);
}

Result<> Integrator::slope(const Point& at, double t_s, const Force& force, Point& slope) noexcept {
  stage_.base_position = at.position;
  stage_.base_orientation.coeffs() = at.orientation.normalized();
  stage_.base_twist = at.twist;
  stage_.q = at.q;
  stage_.qd = at.qd;
  if (!at.orientation.allFinite() || !at.twist.allFinite() || !at.q.allFinite() || !at.qd.allFinite())
    return fail(diverged);
  HIROSCO_TRY(acceleration(stage_, t_s, force, acceleration_));
  slope.q = at.qd;
  slope.qd = acceleration_.tail(at.q.size());
  if (dynamics_->base() == Base::Fixed) {
    slope.position.setZero();
    slope.orientation.setZero();
    slope.twist.setZero();
    return ok();
  }
  slope.twist = acceleration_.head<6>();
  slope.position = stage_.base_orientation * at.twist.tail<3>();
  const Quaternion turned{at.orientation};
  Quaternion rate;
  rate.w() = 0;
  rate.vec() = 0.5 * at.twist.head<3>();
  slope.orientation = (turned * rate).coeffs();
  return ok();
}

void Integrator::add(Point& to, double h, const Point& slope) const noexcept {
  to.position += h * slope.position;
  to.orientation += h * slope.orientation;
  to.twist += h * slope.twist;
  to.q += h * slope.q;
  to.qd += h * slope.qd;
}

Result<> Integrator::step(State& state, double t_s, double h_s, const Force& force) noexcept {
  const Point from{state.base_position, state.base_orientation.coeffs(), state.base_twist, state.q, state.qd};
  static constexpr std::array<double, 4> nodes{0, 0.5, 0.5, 1};
  static constexpr std::array<double, 4> weights{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  Point to = from;
  Point slopes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Point at = from;
    if (i > 0) add(at, h_s * nodes[i], slopes);
    HIROSCO_TRY(slope(at, t_s + h_s * nodes[i], force, slopes));
    add(to, h_s * weights[i], slopes);
  }
  if (!to.position.allFinite() || !to.orientation.allFinite() || !to.twist.allFinite() || !to.q.allFinite() ||
      !to.qd.allFinite())
    return fail(diverged);
  state.base_position = to.position;
  // A fixed base stays where it is to the last bit.
  if (dynamics_->base() == Base::Free) state.base_orientation.coeffs() = to.orientation.normalized();
  state.base_twist = to.twist;
  state.q = to.q;
  state.qd = to.qd;
  return ok();
}

}  // namespace hirosco::robotics
