// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/collision.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace hirosco::robotics {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Folder {
  std::map<std::string, std::string> files;
  [[nodiscard]] descriptor::Reading<CollisionShapes> read(const std::string& collision) const {
    const auto source = [this](const std::filesystem::path& file) -> Result<std::string> {
      const auto found = files.find(file.string());
      if (found == files.end()) return fail(ErrorCode::NotFound, "does not exist");
      return found->second;
    };
    return read_collision_shapes("robots/r.urdf",
                                 "<robot name=\"r\">\n<link name=\"a\">" + collision + "</link></robot>", source);
  }
};

[[nodiscard]] double apart(const LinkHull& one, const Vector3& point) {
  const Pose here;
  const RoundedHull alone{std::span{&point, 1}, 0};
  return distance_m({one.hull, here}, {alone, here});
}

TEST(CollisionShapes, EncloseCylindersBoxesAndBallsWhereTheyAre) {
  const auto reading = Folder{}.read(
      R"(<collision><origin xyz="1 2 3" rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.1" length="2"/></geometry></collision>
         <collision><geometry><box size="0.3 1 0.4"/></geometry></collision>
         <collision><origin xyz="0 0 1"/><geometry><sphere radius="0.2"/></geometry></collision>
         <visual><geometry><sphere radius="9"/></geometry></visual>)");
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(reading.value->hulls.size(), 3u);
  EXPECT_THAT(reading.value->unseen, IsEmpty());
  const auto& hulls = reading.value->hulls;
  EXPECT_EQ(hulls[0].link, "a");
  EXPECT_NEAR(apart(hulls[0], {3, 2, 3}), 1, 1e-6) << "behind its end";
  EXPECT_NEAR(apart(hulls[0], {1, 2, 4}), 0.9, 0.003) << "beside it";
  EXPECT_LE(apart(hulls[0], {1, 2, 4}), 0.9);
  EXPECT_NEAR(apart(hulls[1], {0, 0.6, 0}), 0.1, 1e-6);
  EXPECT_NEAR(apart(hulls[2], {0, 0, 0}), 0.8, 1e-6);
}

const std::string triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(CollisionShapes, OfMeshesBesideTheFileAreScaledAndPlaced) {
  const Folder folder{{{"robots/lab/m.obj", triangle_obj}}};
  const auto reading = folder.read(
      R"(<collision><origin xyz="0 0 1"/><geometry><mesh filename="package://lab/m.obj" scale="0.1 -0.1 1"/></geometry></collision>)");
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(reading.value->hulls.size(), 1u);
  EXPECT_NEAR(apart(reading.value->hulls[0], {0.1, 0, 1.5}), 0.5, 1e-6);
  EXPECT_NEAR(apart(reading.value->hulls[0], {0, -0.3, 1}), 0.2, 1e-6);
}

TEST(CollisionShapes, ThatAreNotThereCostTheirLinkAndAreTold) {
  const Folder folder{{{"robots/m.ply", ""}}};
  const auto code = [&](const std::string& mesh) {
    const auto reading = folder.read("<collision><geometry>" + mesh + "</geometry></collision>");
    if (!reading.value || reading.warnings.size() != 1) return std::string{"another outcome"};
    EXPECT_THAT(reading.value->unseen, ElementsAre("a"));
    EXPECT_EQ(reading.warnings[0].at.line, 2);
    EXPECT_GT(reading.warnings[0].at.column, 1);
    EXPECT_THAT(reading.warnings[0].message, HasSubstr("link 'a'"));
    EXPECT_FALSE(reading.warnings[0].hint.empty());
    return reading.warnings[0].code;
  };
  EXPECT_EQ(code(R"(<mesh filename="../m.stl"/>)"), "U0701");
  EXPECT_EQ(code(R"(<mesh filename="/m.stl"/>)"), "U0701");
  EXPECT_EQ(code(R"(<mesh filename="http://host/m.stl"/>)"), "U0701");
  EXPECT_EQ(code(R"(<mesh filename="m.stl"/>)"), "U0702");
  EXPECT_EQ(code(R"(<mesh filename="m.ply"/>)"), "U0702");
  EXPECT_EQ(code(R"(<capsule radius="1" length="1"/>)"), "U0703");
  EXPECT_EQ(code(R"(<box size="1 1 1"/><box size="1 1 1"/>)"), "U0703");
}

TEST(CollisionShapes, ThatAreWrongAreRefusedWithTheirPlace) {
  const Folder folder{{{"robots/m.obj", "v 0 0 0\nf 1 2 3\n"}}};
  const auto first = [&](const std::string& collision) {
    const auto reading = folder.read("<collision>" + collision + "</collision>");
    EXPECT_FALSE(reading.value);
    EXPECT_FALSE(reading.problems.empty());
    return reading.problems.empty() ? descriptor::Diagnostic{} : reading.problems.front();
  };
  const auto mesh = first(R"(<geometry><mesh filename="m.obj"/></geometry>)");
  EXPECT_EQ(mesh.code, "U0704");
  EXPECT_EQ(mesh.file, "robots/m.obj");
  EXPECT_EQ(mesh.at, (descriptor::Location{2, 5}));
  EXPECT_THAT(mesh.message, HasSubstr("link 'a'"));
  for (const char* collision :
       {R"(<geometry><box size="1 1"/></geometry>)", R"(<geometry><box size="1 1 -1"/></geometry>)",
        R"(<geometry><sphere/></geometry>)", R"(<geometry><cylinder radius="1"/></geometry>)",
        R"(<origin xyz="0 0"/><geometry><sphere radius="1"/></geometry>)",
        R"(<geometry><mesh filename="m.obj" scale="1 1 nan"/></geometry>)"}) {
    const auto wrong = first(collision);
    EXPECT_EQ(wrong.code, "U0705") << collision;
    EXPECT_EQ(wrong.at.line, 2);
  }
}

}  // namespace
}  // namespace hirosco::robotics
