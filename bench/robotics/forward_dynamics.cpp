// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>
#include <random>
#include <vector>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"

/// Forward dynamics beside Pinocchio's: one program, one compiler, the same flags, the same states, in turns. Built and run by
/// bench/robotics/run.
namespace {

using namespace hirosco::robotics;
using Clock = std::chrono::steady_clock;

constexpr int states = 256;
constexpr int rounds = 400;

/// Microseconds a call, of the round that was disturbed least.
template <class Call>
class Timed {
 public:
  explicit Timed(Call call) : call_{std::move(call)} {}
  void round() {
    const auto before = Clock::now();
    for (int i = 0; i < states; ++i) call_(i);
    best_ = std::min(best_, std::chrono::duration<double, std::micro>(Clock::now() - before).count() / states);
  }
  [[nodiscard]] double best() const { return best_; }

 private:
  Call call_;
  double best_{1e9};
};

template <class One, class Other>
double in_turns(const char* what, One one, Other other) {
  Timed ours{one};
  Timed theirs{other};
  for (int i = 0; i < rounds; ++i) {
    ours.round();
    theirs.round();
  }
  std::printf("  %-36s %7.3f us   Pinocchio %7.3f us   ratio %.2f\n", what, ours.best(), theirs.best(),
              ours.best() / theirs.best());
  return ours.best() / theirs.best();
}

[[nodiscard]] pinocchio::Inertia inertia_of(const Inertia& body) {
  return {body.mass, body.centre, pinocchio::Symmetric3(body.about_centre)};
}

/// The same robot; the kinds of joints that are quickest there.
[[nodiscard]] pinocchio::Model theirs_of(const ModelDescription& description, Base base) {
  pinocchio::Model model;
  pinocchio::JointIndex root = 0;
  if (base == Base::Free)
    root = model.addJoint(0, pinocchio::JointModelFreeFlyer(), pinocchio::SE3::Identity(), "root");
  model.appendBodyToJoint(root, inertia_of(description.base), pinocchio::SE3::Identity());
  std::vector<pinocchio::JointIndex> index;
  for (const auto& joint : description.joints) {
    const auto parent = joint.parent ? index[*joint.parent] : root;
    const pinocchio::SE3 placement{joint.placement.rotation, joint.placement.position};
    const bool along_z = joint.axis == Vector3::UnitZ();
    if (joint.kind == JointKind::Revolute)
      index.push_back(
          along_z ? model.addJoint(parent, pinocchio::JointModelRZ(), placement, joint.name)
                  : model.addJoint(parent, pinocchio::JointModelRevoluteUnaligned(joint.axis), placement, joint.name));
    else
      index.push_back(
          model.addJoint(parent, pinocchio::JointModelPrismaticUnaligned(joint.axis), placement, joint.name));
    model.appendBodyToJoint(index.back(), inertia_of(joint.moved), pinocchio::SE3::Identity());
  }
  return model;
}

double compare(const ModelDescription& description, Base base) {
  const Model model = Model::make(description).value();
  Dynamics dynamics{model, base};
  dynamics.set_gravity({0, 0, -9.81});
  const pinocchio::Model their_model = theirs_of(description, base);
  pinocchio::Data data{their_model};
  std::mt19937 random{1};
  std::uniform_real_distribution<double> any{-2, 2};
  const auto next = [&] { return any(random); };
  const int joints = model.joint_count(), first = base == Base::Free ? 6 : 0;
  std::vector<State> ours(states);
  std::vector<Coordinates> forces;
  std::vector<Eigen::VectorXd> q, v, tau;
  for (State& state : ours) {
    state.q = JointVector::NullaryExpr(joints, next);
    state.qd = JointVector::NullaryExpr(joints, next);
    state.base_position = Vector3::NullaryExpr(next);
    state.base_orientation = Quaternion{Eigen::Vector4d::NullaryExpr(next).normalized()};
    state.base_twist = Vector6::NullaryExpr(next);
    forces.push_back(Coordinates::NullaryExpr(first + joints, next));
    q.emplace_back(their_model.nq);
    v.emplace_back(their_model.nv);
    tau.emplace_back(forces.back());
    q.back().tail(joints) = state.q;
    v.back().tail(joints) = state.qd;
    if (base == Base::Fixed) {
      state.base_orientation.setIdentity();
      continue;
    }
    q.back().head<3>() = state.base_position;
    q.back().segment<4>(3) = state.base_orientation.coeffs();
    v.back().head<3>() = state.base_twist.tail<3>();
    v.back().segment<3>(3) = state.base_twist.head<3>();
    tau.back().head<3>() = forces.back().segment<3>(3);
    tau.back().segment<3>(3) = forces.back().head<3>();
  }
  Coordinates acceleration;
  double apart = 0, sink = 0;
  for (std::size_t i = 0; i < states; ++i) {
    dynamics.update(ours[i]);
    if (!dynamics.forward(forces[i], acceleration)) return 1e9;
    const Eigen::VectorXd theirs = pinocchio::aba(their_model, data, q[i], v[i], tau[i]);
    apart = std::max(
        apart, (acceleration.tail(joints) - theirs.tail(joints)).cwiseAbs().maxCoeff() / theirs.cwiseAbs().maxCoeff());
  }
  std::printf("%d joints, base %s; accelerations differ by %.1e at most\n", joints,
              base == Base::Free ? "free" : "fixed", apart);
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const double ratio = in_turns(
      "forward dynamics",
      [&](int i) {
        dynamics.update(ours[at(i)]);
        sink += dynamics.forward(forces[at(i)], acceleration) ? acceleration[0] : 0;
      },
      [&](int i) { sink += pinocchio::aba(their_model, data, q[at(i)], v[at(i)], tau[at(i)])[0]; });
  std::printf("  (%g)\n", sink);
  return apart < 1e-9 ? ratio : 1e9;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double most = 1.5;
  double worst = 0;
  bool good = argc > 1;  // of no robot there is no figure
  for (int i = 1; i < argc; ++i) {
    const auto reading = urdf::read(argv[i], hirosco::descriptor::file_system());
    if (!reading.value) return 2;
    std::printf("%s\n", reading.value->name.c_str());
    for (const Base base : {Base::Fixed, Base::Free}) {
      const double ratio = compare(urdf::describe(*reading.value), base);
      good = good && ratio > 0 && ratio <= most;  // neither holds of what is no number
      worst = std::max(worst, ratio);
    }
  }
  std::printf("largest ratio of forward dynamics: %.2f (at most %.2f)\n", worst, most);
  return good ? 0 : 1;
}
