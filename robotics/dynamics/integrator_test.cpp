// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/dynamics/integrator.hpp"

#include <gtest/gtest.h>

#include "hirosco/utilities/testing/slice.hpp"
#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

using testing::ball;
using testing::joint;

class NoForce final : public Integrator::Force {
 public:
  void at(double, Coordinates&) const noexcept override {}
};
class RisingForce final : public Integrator::Force {
 public:
  void at(double t_s, Coordinates& force) const noexcept override { force[0] = 6 * t_s; }
};

[[nodiscard]] Model slider(double mass, double damping) {
  ModelDescription description;
  description.joints = {joint(JointKind::Prismatic, Vector3::UnitX(), {0, 0, 0}, ball(mass, {0, 0, 0}))};
  description.joints[0].damping = damping;
  return testing::make(description);
}

[[nodiscard]] State after(Integrator& integrator, State state, double end_s, int steps,
                          const Integrator::Force& force) {
  const double h = end_s / steps;
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(integrator.step(state, i * h, h, force));
  return state;
}

TEST(RungeKutta, IsExactWhereTheMotionIsACubic) {
  const auto model = slider(2, 0);
  Dynamics dynamics{model, Base::Fixed};
  Integrator integrator{dynamics};
  const State state = after(integrator, testing::state({1}, {2}), 2, 4, RisingForce{});
  // 2 kg under 6 t N: qd = 2 + 1.5 t2, q = 1 + 2 t + 0.5 t3.
  EXPECT_NEAR(state.qd[0], 8, 1e-13);
  EXPECT_NEAR(state.q[0], 9, 1e-13);
}

TEST(RungeKutta, HasTheFourthOrderAgainstADecayThatDampingMakes) {
  const auto model = slider(2, 3);
  Dynamics dynamics{model, Base::Fixed};
  Integrator integrator{dynamics};
  const auto error = [&](int steps) {
    return std::abs(after(integrator, testing::state({0}, {1}), 1, steps, NoForce{}).qd[0] - std::exp(-1.5));
  };
  const double ratio = error(10) / error(20);
  EXPECT_GT(ratio, 14);
  EXPECT_LT(ratio, 18);
}

TEST(RungeKutta, KeepsMomentumAndEnergyOfAFreeTumble) {
  ModelDescription description;
  description.base = ball(5, {0.1, 0, 0}, 2);
  description.joints = {joint(JointKind::Revolute, Vector3::UnitY(), {0.3, 0, 0}, ball(2, {0.5, 0, 0}, 0.3)),
                        joint(JointKind::Revolute, Vector3::UnitX(), {1, 0, 0}, ball(1, {0, 0.4, 0}, 0.1), 0)};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Free};
  Integrator integrator{dynamics};
  State state = testing::any_state(model, 6);
  dynamics.update(state);
  const Momentum before = dynamics.momentum();
  const double energy = dynamics.kinetic_energy();
  const int seconds = 5 / hirosco::testing::one_in(5);
  state = after(integrator, state, seconds, 1000 * seconds, NoForce{});
  dynamics.update(state);
  EXPECT_LT((dynamics.momentum().linear - before.linear).norm(), 1e-9 * before.linear.norm());
  EXPECT_LT((dynamics.momentum().angular - before.angular).norm(), 1e-9 * before.angular.norm());
  EXPECT_NEAR(dynamics.kinetic_energy(), energy, 1e-9 * energy);
  EXPECT_NEAR(state.base_orientation.norm(), 1, 1e-15);
}

TEST(RungeKutta, TellsAMotionThatBecomesNoNumber) {
  const auto model = slider(1, 1e6);
  Dynamics dynamics{model, Base::Fixed};
  Integrator integrator{dynamics};
  State state = testing::state({0}, {1});
  Result<> made = ok();
  for (int i = 0; i < 100 && made; ++i) made = integrator.step(state, i, 1, NoForce{});
  EXPECT_FALSE(made);
}

}  // namespace
}  // namespace hirosco::robotics
