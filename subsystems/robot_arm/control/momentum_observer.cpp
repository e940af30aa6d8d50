// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/momentum_observer.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// For longer no device holds what it was told last: what its drives gave in such a pause nobody knows.
constexpr double longest_pause_s = 0.1;

}  // namespace

MomentumObserver::MomentumObserver(int joints, double cycle_s, double gain_per_s) noexcept
    : cycle_s_{cycle_s}, gain_per_s_{gain_per_s}, kept_of_cycle_{std::max(0.0, 1 - gain_per_s * cycle_s)} {
  known_.setZero(joints);
  begun_.setZero(joints);
  external_.setZero(joints);
}

void MomentumObserver::reset() noexcept {
  started_ = false;
  known_.setZero();
  external_.setZero();
}

void MomentumObserver::update(const Measured& measured, robotics::Dynamics& dynamics,
                              const robotics::Coordinates& payload_torque,
                              std::optional<SampleTime::Between> between) noexcept {
  robotics::MassMatrix mass;
  dynamics.mass_matrix(mass);
  robotics::Coordinates bias;
  dynamics.bias(bias);
  update(measured, mass, bias, payload_torque, between);
}

void MomentumObserver::update(const Measured& measured, const robotics::MassMatrix& mass,
                              const robotics::Coordinates& bias, const robotics::Coordinates& payload_torque,
                              std::optional<SampleTime::Between> between) noexcept {
  Sample now{.momentum = {}, .velocity = measured.velocity, .torque = measured.torque, .taken = bias, .mass = mass};
  now.momentum.noalias() = mass.lazyProduct(measured.velocity);
  now.taken += payload_torque;
  kept_ = 1;
  if (!started_) return begin_with(now);
  const SampleTime::Between its = between.value_or(SampleTime::Between{.s = cycle_s_});
  // When it was measured is found from what comes behind it; of so many in a row, so that nobody is unfelt for longer.
  if (its.unsure && passed_over_count_ < most_passed_over) {
    passed_s_ += its.s;
    passed_over_[passed_over_count_++] = {now.torque, passed_s_};
    return;
  }
  const bool regular = passed_over_count_ == 0 && its.s == cycle_s_;
  const bool anew = !regular && passed_s_ + its.s > longest_pause_s && !began_anew_;
  if (regular) take_cycle(now);
  else if (anew) begin_anew(now);
  else take_longer(now, its.s);
  began_anew_ = anew;
  passed_over_count_ = 0;
  passed_s_ = 0;
  before_ = now;
}

void MomentumObserver::begin_with(const Sample& now) noexcept {
  started_ = true;
  began_anew_ = false;
  passed_over_count_ = 0;
  passed_s_ = 0;
  begun_ = now.momentum;
  before_ = now;
}

void MomentumObserver::take_cycle(const Sample& now) noexcept {
  // d/dt (M qd) = dM/dt qd + M qdd, and M qdd = torque - bias + external.
  JointVector growth = now.torque - now.taken;
  growth.noalias() += (now.mass - before_.mass).lazyProduct(now.velocity) / cycle_s_;
  known_ += (growth + external_) * cycle_s_;
  external_ = gain_per_s_ * (now.momentum - begun_ - known_);
  kept_ = kept_of_cycle_;
}

/// More than a cycle, or another span: what acted in its mean, as if it had done so in each of its cycles.
void MomentumObserver::take_longer(const Sample& now, double passed_s) noexcept {
  const double whole_s = passed_s_ + passed_s;
  JointVector growth = (now.torque - 0.5 * (before_.taken + now.taken)) * whole_s;
  growth.noalias() += 0.5 * (now.mass - before_.mass).lazyProduct(before_.velocity + now.velocity);
  JointVector acted = now.momentum - before_.momentum - growth;
  find_times(now.torque, whole_s, acted);
  kept_ = std::pow(kept_of_cycle_, whole_s / cycle_s_);
  external_ += (1 - kept_) * (acted / whole_s - external_);
  known_ = now.momentum - begun_ - external_ / gain_per_s_;
}

/// Nothing is found out about such a pause; who pushed before it is felt as before, and never are two of them passed by.
void MomentumObserver::begin_anew(const Sample& now) noexcept {
  known_ = now.momentum - begun_ - external_ / gain_per_s_;
}

/// A drive gives the torque that it was told last until it is told another one. Where samples were passed over, torques changed sometime between, those of all joints at once: where
/// that explains most of what the joints did is when it was. `acted`: as if the last `torque` had been there all the time; less what is explained, N m s.
void MomentumObserver::find_times(const JointVector& torque, double whole_s, JointVector& acted) const noexcept {
  constexpr int rounds = 8;
  std::array<double, most_passed_over> at_s{};
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < passed_over_count_; ++i) {
      const bool last = i + 1 == passed_over_count_;
      const JointVector change = passed_over_[i].torque - (last ? torque : passed_over_[i + 1].torque);
      const double size = change.squaredNorm();
      const double earliest_s = passed_over_[i].earliest_s;
      const double latest_s = std::max(earliest_s, (last ? whole_s : passed_over_[i + 1].earliest_s) - cycle_s_);
      const double found_s = size > 0 ? at_s[i] + change.dot(acted) / size : earliest_s;
      const double best_s = std::clamp(found_s, earliest_s, latest_s);
      acted -= change * (best_s - at_s[i]);
      at_s[i] = best_s;
    }
}

}  // namespace hirosco::robot_arm
