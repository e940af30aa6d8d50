// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/swept.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace hirosco::robotics {
namespace {

/// A hand that turns, with a finger that slides, a tip that is fixed to it, a thumb that follows the finger and a flap that turns.
constexpr const char* joints = R"(
<joint name="wrist" type="revolute"><parent link="base"/><child link="palm"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="slide" type="prismatic"><origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/><parent link="palm"/><child link="finger"/><axis xyz="0 1 0"/>
  <limit lower="0.01" upper="0.05" velocity="1" effort="1"/></joint>
<joint name="end" type="fixed"><origin xyz="0 0 0.1"/><parent link="finger"/><child link="tip"/></joint>
<joint name="follows" type="prismatic"><parent link="palm"/><child link="thumb"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>
  <mimic joint="slide" multiplier="-2" offset="0.02"/></joint>
<joint name="turn" type="revolute"><parent link="palm"/><child link="flap"/><axis xyz="0 0 1"/><limit lower="0" upper="1.5707963267948966" velocity="1" effort="1"/></joint>
<joint name="bend" type="revolute"><origin xyz="0.1 0 0"/><parent link="flap"/><child link="nail"/><axis xyz="0 1 0"/><limit lower="-0.5" upper="0.5" velocity="1" effort="1"/></joint>
</robot>)";

[[nodiscard]] urdf::Robot robot() {
  std::string text = "<robot name='hand'><link name='base'/>";
  for (const char* link : {"palm", "finger", "tip", "thumb", "flap", "nail"})
    text += std::string{"<link name='"} + link +
            "'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
  const auto reading = urdf::read("hand.urdf", text + joints);
  for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
  return reading.value.value();
}
[[nodiscard]] RoundedHull swept_ball(double radius_m = 0.01) {
  return {std::array{Vector3{Vector3::Zero()}}, radius_m};
}
[[nodiscard]] double outside(const RoundedHull& hull, const Vector3& point) {
  const RoundedHull alone{std::span{&point, 1}, 0};
  return distance_m({hull, Pose{}}, {alone, Pose{}});
}
[[nodiscard]] RoundedHull swept(const char* link, std::vector<std::string> standing,
                                const RoundedHull& hull = swept_ball()) {
  std::vector<LinkHull> hulls{{link, hull}};
  sweep(hulls, robot(), standing);
  return hulls[0].hull;
}

/// In the finger's frame with the joint at 0, from where it may be to where it may be, and no farther.
TEST(Swept, AFingerIsAllAlongItsWay) {
  const RoundedHull all = swept("finger", {"slide"});
  for (const double q : {0.01, 0.03, 0.05}) EXPECT_NEAR(outside(all, {0, q, 0}), -0.01, 1e-5) << q;
  EXPECT_NEAR(outside(all, {0, 0.1, 0}), 0.04, 1e-5);
  EXPECT_NEAR(outside(all, {0, -0.05, 0}), 0.05, 1e-5);
  EXPECT_NEAR(outside(all, {0, 0.03, 0.05}), 0.04, 1e-5);
}

TEST(Swept, WhatIsFixedToAFingerGoesWithIt) {
  const RoundedHull all = swept("tip", {"slide"});
  for (const double q : {0.01, 0.05}) EXPECT_LT(outside(all, {0, q, 0}), -0.009) << q;
  EXPECT_NEAR(outside(all, {0, 0.1, 0}), 0.04, 1e-5);
}

/// Its own frame stands at its offset, 0.02; it is at -2 q + 0.02.
TEST(Swept, WhoFollowsGoesAsFarAsItIsLed) {
  const RoundedHull all = swept("thumb", {"slide"});
  for (const double q : {0.01, 0.05}) EXPECT_LT(outside(all, {-2 * q, 0, 0}), -0.009) << q;
  EXPECT_NEAR(outside(all, {0.05, 0, 0}), 0.06, 1e-5);
  EXPECT_NEAR(outside(all, {-0.2, 0, 0}), 0.09, 1e-5);
}

/// The whole arc, also between the places that are looked at, and of what turns on what turns.
TEST(Swept, WhatTurnsIsEnclosedInEveryPlaceOfIts) {
  RoundedHull bar{std::array{Vector3{0.05, 0, 0}, Vector3{0.2, 0, 0}}, 0.005};
  const RoundedHull all = swept("flap", {"turn", "bend"}, bar);
  for (int i = 0; i <= 100; ++i) {
    const double q = std::numbers::pi / 2 * i / 100;
    const Pose there{Eigen::AngleAxisd{q, Vector3::UnitZ()}.toRotationMatrix(), Vector3::Zero()};
    EXPECT_LT(outside(all, there * Vector3{0.2, 0, 0}), -0.0049) << q;
  }
  EXPECT_GT(outside(all, {-0.1, -0.1, 0}), 0.05);
  const RoundedHull chain = swept("nail", {"turn", "bend"}, bar);
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j) {
      const Pose turned{Eigen::AngleAxisd{std::numbers::pi / 2 * i / 20, Vector3::UnitZ()}.toRotationMatrix(),
                        Vector3::Zero()};
      const Pose bent{Eigen::AngleAxisd{-0.5 + j / 20.0, Vector3::UnitY()}.toRotationMatrix(), {0.1, 0, 0}};
      // In the nail's frame with both at 0, which is 0.1 m out.
      EXPECT_LT(outside(chain, turned * (bent * Vector3{0.2, 0, 0}) - Vector3{0.1, 0, 0}), -0.0049) << i << " " << j;
    }
}

TEST(Swept, WhoeverMovesByItselfStaysAsItIs) {
  for (const char* link : {"base", "palm", "flap", "nobody"}) {
    const RoundedHull same = swept(link, {"slide"});
    EXPECT_EQ(same.corners(), 1u) << link;
    EXPECT_EQ(same.radius_m(), 0.01) << link;
  }
  EXPECT_EQ(swept("finger", {}).corners(), 1u);
}

}  // namespace
}  // namespace hirosco::robotics
