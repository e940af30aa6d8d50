// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {
namespace {

std::expected<Obstacle, std::string> read(std::string_view line) {
  std::vector<std::string_view> words;
  while (!line.empty()) {
    const auto blank = std::min(line.find(' '), line.size());
    words.push_back(line.substr(0, blank));
    line.remove_prefix(std::min(blank + 1, line.size()));
  }
  return read_obstacle("it", words);
}

TEST(Shapes, AnObstacleIsItsShapeSizesPlaceFrictionAndTurn) {
  const auto box = read("box 0.1,1,0.8 0.6,-0.2,0.4 0.7 0,0,0.5");
  ASSERT_TRUE(box) << box.error();
  EXPECT_EQ(box->name, "it");
  EXPECT_EQ(box->shape.kind, ShapeKind::Box);
  EXPECT_EQ(box->shape.sizes, (std::array{0.1, 1.0, 0.8}));
  EXPECT_EQ(box->shape.place_m, (std::array{0.6, -0.2, 0.4}));
  EXPECT_EQ(box->shape.turned_rad, (std::array{0.0, 0.0, 0.5}));
  EXPECT_EQ(box->friction, 0.7);
  const auto cylinder = read("cylinder 0.05,1 0,0,0");
  ASSERT_TRUE(cylinder) << cylinder.error();
  EXPECT_EQ(cylinder->shape.kind, ShapeKind::Cylinder);
  EXPECT_EQ(cylinder->friction, 0.5) << "where nothing is said";
  EXPECT_EQ(read("sphere 0.2 1,2,3 0").value().shape.kind, ShapeKind::Sphere);
  EXPECT_EQ(read("plane 0,0,-0.1 1").value().shape.kind, ShapeKind::Plane);
}

TEST(Shapes, WhatIsNoObstacleIsRefusedWithWhatIsWrongAndHowItIsWritten) {
  const std::string box = "write box A,B,C X,Y,Z [FRICTION [ROLL,PITCH,YAW]]";
  for (const auto& [line, why] : {
           std::pair<const char*, std::string>{"", "'' is no shape of an obstacle: box, cylinder, sphere or plane"},
           {"cube 1,1,1 0,0,0", "'cube' is no shape of an obstacle: box, cylinder, sphere or plane"},
           {"box 1,1,1", "2 words are not those of a box: " + box},
           {"box 1,1,1 0,0,0 1 0,0,0 1", "6 words are not those of a box: " + box},
           {"box 1,1 0,0,0", "the size '1,1' has 2 numbers, not 3; " + box},
           {"box 1,1,x 0,0,0", "the size '1,1,x': number 3 is none; " + box},
           {"box 1,1,-1 0,0,0", "the size '1,1,-1' is not within 0.0001 to 1000"},
           {"box 1,1,1 0,0", "the place '0,0' has 2 numbers, not 3; " + box},
           {"box 1,1,1 0,0,nan", "the place '0,0,nan': number 3 is none; " + box},
           {"sphere 1 0,0,0 11", "the friction '11' is not within 0 to 10"},
           {"plane 0,0,0 1 0,0,7", "the turn '0,0,7' is not within -6.283185307179586 to 6.283185307179586"},
       }) {
    const auto obstacle = read(line);
    ASSERT_FALSE(obstacle) << line;
    EXPECT_EQ(obstacle.error(), why) << line;
  }
}

TEST(Shapes, ALinkMayHaveSeveralAndWhatIsNoneIsTold) {
  const auto tree = xml::read_tree(R"(<robot name="r"><link name="a">
    <collision><origin xyz="0 0 +0.5" rpy=" 0 1.5 0 "/><geometry><cylinder radius="0.1" length="1"/></geometry></collision>
    <collision><geometry><mesh filename="a.stl" scale="1 1 2"/></geometry></collision>
    <collision><geometry><box size="1 1"/></geometry></collision>
    <collision><geometry><sphere radius="0"/></geometry></collision>
    <collision><geometry><capsule radius="1" length="1"/></geometry></collision>
    <collision><origin xyz="0 0"/><geometry><sphere radius="1"/></geometry></collision>
    <collision><geometry/></collision><collision><geometry><mesh/></geometry></collision>
    <visual><geometry><sphere radius="1"/></geometry></visual></link></robot>)");
  ASSERT_TRUE(tree) << tree.error().reason;
  const LinkShapes shapes = link_shapes(*tree);
  ASSERT_EQ(shapes.taken.size(), 2U);
  EXPECT_EQ(shapes.taken[0].link, "a");
  EXPECT_EQ(shapes.taken[0].shape.place_m, (std::array{0.0, 0.0, 0.5}));
  EXPECT_EQ(shapes.taken[0].shape.turned_rad, (std::array{0.0, 1.5, 0.0}));
  EXPECT_EQ(shapes.taken[1].shape.mesh, "a.stl");
  EXPECT_EQ(shapes.left_out, (std::vector<std::string>{
                                 "a shape of link 'a': the sizes of its <box> are no numbers from 0.0001 to 1000 m",
                                 "a shape of link 'a': the sizes of its <sphere> are no numbers from 0.0001 to 1000 m",
                                 "a shape of link 'a': <capsule> is no shape of a URDF file",
                                 "a shape of link 'a': its <origin> is not three numbers each",
                                 "a shape of link 'a': its <geometry> is not one shape",
                                 "a shape of link 'a': its <mesh> names no file"}));
}

TEST(Shapes, AMeshLiesBesideItsFile) {
  EXPECT_EQ(mesh_file("meshes/arm.stl"), "meshes/arm.stl");
  EXPECT_EQ(mesh_file("package://lab/arm.OBJ"), "lab/arm.OBJ");
  for (const char* elsewhere : {"/opt/arm.stl", "file:///opt/arm.stl", "http://lab/arm.stl", "arm.dae", "stl"})
    EXPECT_FALSE(mesh_file(elsewhere)) << elsewhere;
  EXPECT_EQ(mesh_file("meshes/arm.DAE").error(),
            "meshes/arm.DAE is neither STL nor OBJ: hirosco new robot writes it as STL");
  EXPECT_EQ(mesh_file("arm.ply").error(), "arm.ply is neither STL nor OBJ");
}

}  // namespace
}  // namespace hirosco::simulation
