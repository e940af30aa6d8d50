// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <sstream>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"

/// Says all that the library says of a robot, in numbers that a judge compares with those of other libraries (compare_test.py).
///   robotics_probe MODEL.urdf TIP: first what was read, then an answer to each line of standard input:
///   base (0 fixed, 1 free), gravity 3, position 3, orientation wxyz 4, twist 6, q, qd, force, acceleration.
namespace {

using namespace hirosco;
using namespace hirosco::robotics;

void say(const char* name, const Eigen::Ref<const Eigen::MatrixXd>& values) {
  fmt::print("{}", name);
  for (const double value : values.reshaped<Eigen::RowMajor>()) fmt::print(" {}", value);
  fmt::print("\n");
}

void say_model(const Model& model) {
  for (const auto& joint : model.joints()) {
    const auto& limits = joint.limits;
    fmt::print("joint {} {} {} {} {} {} {}\n", joint.name, joint.damping, joint.friction,
               limits.lower.value_or(-INFINITY), limits.upper.value_or(INFINITY), limits.velocity.value_or(INFINITY),
               limits.effort.value_or(INFINITY));
  }
  fmt::print("mass {}\nread\n", model.mass());
}

template <class Vector>
void take(std::istream& in, Vector& to) {
  for (Eigen::Index i = 0; i < to.size(); ++i) in >> to[i];
}

void answer(const Model& model, FrameId tip, std::istream& in) {
  int free = 0;
  in >> free;
  Dynamics dynamics{model, free != 0 ? Base::Free : Base::Fixed};
  Vector3 gravity;
  Eigen::Vector4d wxyz;
  State state;
  state.q.resize(model.joint_count());
  state.qd.resize(model.joint_count());
  Coordinates force(dynamics.coordinate_count()), acceleration(dynamics.coordinate_count());
  take(in, gravity);
  take(in, state.base_position);
  take(in, wxyz);
  take(in, state.base_twist);
  take(in, state.q);
  take(in, state.qd);
  take(in, force);
  take(in, acceleration);
  if (!in) {
    fmt::print("error\n");
    return;
  }
  state.base_orientation = Quaternion{wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
  dynamics.set_gravity(gravity);
  dynamics.update(state);
  Coordinates found, bias;
  MassMatrix mass;
  Jacobian jacobian, generalised;
  dynamics.mass_matrix(mass);
  say("mass_matrix", mass);
  dynamics.bias(bias);
  say("bias", bias);
  dynamics.inverse(acceleration, found);
  say("inverse", found);
  if (!dynamics.forward(force, found)) fmt::print("error\n");
  say("forward", found);
  dynamics.jacobian(tip, jacobian);
  say("jacobian", jacobian);
  if (!dynamics.generalised_jacobian(tip, generalised)) fmt::print("error\n");
  say("generalised_jacobian", generalised);
  const Pose pose = dynamics.frame_pose(tip);
  say("position", pose.position);
  say("rotation", pose.rotation);
  say("twist", dynamics.frame_twist(tip));
  say("drift", dynamics.frame_drift(tip));
  say("centre_of_mass", dynamics.centre_of_mass());
  const Momentum momentum = dynamics.momentum();
  say("linear", momentum.linear);
  say("angular", momentum.angular);
  fmt::print("kinetic {}\npotential {}\nend\n", dynamics.kinetic_energy(), dynamics.potential_energy());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto reading = urdf::read(argv[1], descriptor::file_system());
  for (const auto& problem : reading.problems)
    fmt::print(stderr, "{} {}:{} {}\n", problem.code, problem.at.line, problem.at.column, problem.message);
  if (!reading.value) return 1;
  const auto model = Model::make(urdf::describe(*reading.value));
  if (!model) {
    fmt::print(stderr, "{}\n", model.error().text);
    return 1;
  }
  const auto tip = model->find_frame(argv[2]);
  if (!tip) return 2;
  say_model(*model);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in{line};
    answer(*model, *tip, in);
  }
}
