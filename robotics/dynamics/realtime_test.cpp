// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/utilities/allocation_guard.hpp"
#include "robotics/dynamics/integrator.hpp"
#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

class Constant final : public Integrator::Force {
 public:
  void at(double, Coordinates& force) const noexcept override { force.setConstant(0.1); }
};

/// Everything that a cycle may ask for, of the largest robots.
void ask_all(Dynamics& dynamics, Integrator& integrator, State& state) {
  Coordinates force, acceleration;
  MassMatrix mass;
  Jacobian jacobian;
  dynamics.set_gravity({0, 0, -9.81});
  dynamics.update(state);
  dynamics.bias(force);
  EXPECT_TRUE(dynamics.forward(force, acceleration));
  dynamics.inverse(acceleration, force);
  dynamics.mass_matrix(mass);
  dynamics.jacobian({0}, jacobian);
  EXPECT_TRUE(dynamics.generalised_jacobian({0}, jacobian));
  EXPECT_TRUE(dynamics.model().find_frame("tip"));
  EXPECT_TRUE(
      (dynamics.frame_pose({0}).position + dynamics.frame_twist({0}).tail<3>() + dynamics.frame_drift({0}).tail<3>())
          .allFinite());
  EXPECT_TRUE((dynamics.momentum().angular + dynamics.centre_of_mass()).allFinite());
  EXPECT_GT(dynamics.kinetic_energy() + dynamics.potential_energy(), -1e9);
  EXPECT_TRUE(integrator.step(state, 0, 1e-3, Constant{}));
}

TEST(Cycle, UsesNoHeap) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  for (const Base base : {Base::Fixed, Base::Free})
    for (const auto mimicry : {testing::Mimicry::None, testing::Mimicry::EveryThird}) {
      const auto model = testing::tree(max_joints, mimicry);
      Dynamics dynamics{model, base};
      Integrator integrator{dynamics};
      State state = testing::any_state(model, 1);
      const RealtimeScope scope;
      ask_all(dynamics, integrator, state);
      EXPECT_EQ(scope.count(), AllocationCount{});
    }
}

}  // namespace
}  // namespace hirosco::robotics
