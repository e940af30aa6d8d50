// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"

namespace {

constexpr const char* pendulum = R"(<robot name="pendulum">
  <link name="ceiling"/>
  <joint name="swing" type="continuous">
    <parent link="ceiling"/> <child link="rod"/> <axis xyz="0 1 0"/>
  </joint>
  <link name="rod">
    <inertial> <origin xyz="0 0 -0.5"/> <mass value="2"/> <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/> </inertial>
  </link>
</robot>)";

}  // namespace

int main() {
  namespace robotics = hirosco::robotics;
  const auto reading = robotics::urdf::read("pendulum.urdf", pendulum);
  for (const auto& problem : reading.problems) std::printf("%d: %s\n", problem.at.line, problem.message.c_str());
  if (!reading.value) return 1;
  const auto model = robotics::Model::make(robotics::urdf::describe(*reading.value));
  if (!model) return 1;

  robotics::Dynamics dynamics{*model, robotics::Base::Fixed};  // the last thing that uses the heap
  dynamics.set_gravity({0, 0, -9.81});
  robotics::State state;
  state.q.setConstant(1, 0.3);
  state.qd.setZero(1);
  dynamics.update(state);
  robotics::Coordinates torque = robotics::Coordinates::Zero(1), acceleration;
  if (!dynamics.forward(torque, acceleration)) return 1;
  dynamics.bias(torque);
  std::printf("falls with %.2f rad/s2, is held by %.2f N m\n", acceleration[0], torque[0]);
}
