// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

/// The joint comes before the one that carries it; two links are fixed to the moved one, one to the base.
constexpr const char* lumped = R"(<robot name="A">
  <link name="world"/><link name="base"><inertial><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="late" type="continuous"><parent link="hand"/><child link="finger"/><axis xyz="1 0 0"/><origin xyz="0 1 0"/></joint>
  <joint name="j" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/><origin xyz="0 0 2"/></joint>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/><origin xyz="1 0 0"/></joint>
  <joint name="flange" type="fixed"><parent link="rod"/><child link="hand"/><origin xyz="3 0 0" rpy="0 0 1.5707963267948966"/></joint>
  <link name="rod"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="hand"><inertial><origin xyz="1 0 0"/><mass value="2"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0.5"/></inertial></link>
  <link name="finger"><inertial><mass value="0.5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
</robot>)";

TEST(Description, LumpsWhatIsFixedAndKeepsTheOrderOfTheFile) {
  const auto reading = read("a.urdf", lumped);
  ASSERT_TRUE(reading.value);
  const auto description = describe(*reading.value);
  ASSERT_EQ(description.joints.size(), 2U);
  EXPECT_EQ(description.joints[0].name, "late");
  EXPECT_EQ(description.joints[0].parent, 1U);
  EXPECT_LT((description.joints[0].placement.position - Vector3(2, 0, 0)).norm(), 1e-15);
  EXPECT_FALSE(description.joints[1].parent);
  EXPECT_EQ(description.joints[1].placement.position, Vector3(1, 0, 2));
  EXPECT_EQ(description.base.mass, 4);
  EXPECT_EQ(description.base.centre, Vector3(1, 0, 0));
  // The hand's centre is at (3, 1, 0) of the rod.
  EXPECT_EQ(description.joints[1].moved.mass, 3);
  EXPECT_LT((description.joints[1].moved.centre - Vector3(2, 2.0 / 3, 0)).norm(), 1e-15);
  EXPECT_NEAR(description.joints[1].moved.about_centre(2, 2), 0.5 + 2.0 / 3 * 10, 1e-14);
}

TEST(Description, EveryLinkIsAFrameWhereItsJointPutsIt) {
  const auto reading = read("a.urdf", lumped);
  ASSERT_TRUE(reading.value);
  const auto model = Model::make(describe(*reading.value));
  ASSERT_TRUE(model);
  Dynamics dynamics{*model, Base::Fixed};
  State state;
  state.q.resize(2);
  state.q << 0.3, 0.7;
  state.qd.setZero(2);
  dynamics.update(state);
  const auto at = [&](const char* link) { return dynamics.frame_pose(model->find_frame(link).value()); };
  EXPECT_EQ(at("world").position, Vector3::Zero());
  EXPECT_EQ(at("base").position, Vector3(1, 0, 0));
  EXPECT_LT((at("hand").position - Vector3(1 + 3 * std::cos(0.7), 3 * std::sin(0.7), 2)).norm(), 1e-14);
  EXPECT_LT((at("finger").position - Vector3(1 + 2 * std::cos(0.7), 2 * std::sin(0.7), 2)).norm(), 1e-14);
  // x of the hand, about which the finger turns, is y of the rod.
  EXPECT_LT((at("finger").rotation.col(0) - Vector3(-std::sin(0.7), std::cos(0.7), 0)).norm(), 1e-14);
  EXPECT_NEAR(at("finger").rotation(2, 2), std::cos(0.3), 1e-14);
}

}  // namespace
}  // namespace hirosco::robotics::urdf
