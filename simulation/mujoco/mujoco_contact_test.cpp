// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "simulation/mujoco/mujoco_robot.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;

constexpr double mass_kg = 2, weight_n = mass_kg * 9.81;

std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}
std::string link(const std::string& name, const std::string& shapes) {
  return "<link name='" + name + R"('><inertial><mass value="2"/>
    <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>)" +
         shapes + "</link>";
}
std::string slide(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& axis) {
  return "<joint name='" + name + "' type='prismatic'><parent link='" + parent + "'/><child link='" + child +
         "'/><axis xyz='" + axis + "'/><limit lower='-5' upper='5' velocity='9' effort='200'/></joint>";
}
/// A cube of 0.2 m and 2 kg that goes along x, by a carriage without much mass, and up and down.
std::string cube(const std::string& shape = R"(<box size="0.2 0.2 0.2"/>)") {
  return R"(<robot name="cube"><link name="base"/><link name="carriage"><inertial><mass value="1e-6"/>
    <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>)" +
         link("cube", collision(shape)) + slide("x", "base", "carriage", "1 0 0") +
         slide("z", "carriage", "cube", "0 0 1") + "</robot>";
}
constexpr std::array undriven{0.0, 0.0};

Obstacle plane(double friction) { return {"floor", {.kind = ShapeKind::Plane}, friction}; }
void run(MujocoRobot& robot, std::span<const double> drives, int milliseconds) {
  for (int i = 0; i < milliseconds; ++i) robot.step(drives, Brakes::Open, 1ms);
}

TEST(MujocoContact, ABoxFallsOnAPlaneAndRestsThereWithItsWeight) {
  auto robot = MujocoRobot::make(cube()).value();
  ASSERT_TRUE(robot.place(std::array{0.0, 0.4}));
  ASSERT_TRUE(robot.put(plane(0.5)));
  int cycles = 0;
  for (; robot.touched().contacts == 0; ++cycles) run(robot, undriven, 1);
  EXPECT_NEAR(cycles * 0.001, std::sqrt(2 * 0.3 / 9.81), 0.002) << "falls freely until then";
  run(robot, undriven, 1000);
  EXPECT_NEAR(robot.position(1), 0.1, 0.001);
  EXPECT_LT(std::abs(robot.velocity(1)), 1e-4);
  EXPECT_NEAR(robot.touched().normal_n, weight_n, 0.01);
}

TEST(MujocoContact, FrictionHoldsWhatSlidesUntilItIsPulledHarderAndSlowsItThen) {
  constexpr double friction = 0.4, held_n = friction * weight_n;
  auto robot = MujocoRobot::make(cube()).value();
  ASSERT_TRUE(robot.place(std::array{0.0, 0.1}));
  ASSERT_TRUE(robot.put(plane(friction)));
  run(robot, undriven, 500);
  run(robot, std::array{0.9 * held_n, 0.0}, 1000);
  EXPECT_LT(std::abs(robot.position(0)), 2e-3) << "holds";
  run(robot, undriven, 100);
  run(robot, std::array{2 * held_n, 0.0}, 300);
  const double fast = 0.3 * held_n / mass_kg;
  EXPECT_NEAR(robot.velocity(0), fast, 0.03 * fast) << "slides, and friction takes its half";
  const double before = robot.velocity(0);
  run(robot, undriven, 200);
  EXPECT_NEAR(robot.velocity(0), before - friction * 9.81 * 0.2, 0.03 * before) << "slows";
  run(robot, undriven, 500);
  EXPECT_LT(std::abs(robot.velocity(0)), 1e-3) << "stops";
}

/// A rod of 0.5 m that turns about y, with a sphere at its end.
std::string rod() {
  return R"(<robot name="rod"><link name="base"/>)" +
         link("rod", collision(R"(<sphere radius="0.05"/>)", R"(<origin xyz="0 0 0.5"/>)")) +
         R"(<joint name="turn" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" velocity="9" effort="50"/></joint></robot>)";
}

TEST(MujocoContact, ALinkPressesOnAnObstacleWithWhatItsJointFeels) {
  auto robot = MujocoRobot::make(rod()).value();
  robot.set_gravity(0, 0, 0);
  ASSERT_TRUE(robot.put({"wall", {.kind = ShapeKind::Box, .sizes = {0.1, 1, 1}, .place_m = {0.3, 0, 0.5}}, 0.0}));
  constexpr double torque_n_m = 8;
  run(robot, std::array{torque_n_m}, 1500);
  const double at_rad = std::asin((0.25 - 0.05) / 0.5);
  EXPECT_NEAR(robot.position(0), at_rad, 0.003) << "stands at the wall";
  EXPECT_NEAR(robot.torque(0), torque_n_m, 0.01);
  EXPECT_NEAR(robot.touched().normal_n, torque_n_m / (0.5 * std::cos(at_rad)), 0.2);
  ASSERT_TRUE(robot.take_away("wall"));
  EXPECT_NEAR(robot.position(0), at_rad, 0.003) << "goes on where it is";
  run(robot, std::array{torque_n_m}, 200);
  EXPECT_GT(robot.position(0), at_rad + 0.1);
  EXPECT_EQ(robot.touched().contacts, 0);
}

TEST(MujocoContact, NothingIsPutIntoTheRobotNorTheRobotIntoIt) {
  auto robot = MujocoRobot::make(rod()).value();
  const Obstacle ball{"ball", {.kind = ShapeKind::Sphere, .sizes = {0.1}, .place_m = {0, 0, 0.55}}};
  const auto refused = robot.put(ball);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), "link 'rod' stands in obstacle 'ball', 100 mm deep, where the robot is now");
  ASSERT_TRUE(robot.place(std::array{1.5}));
  ASSERT_TRUE(robot.put(ball));
  EXPECT_FALSE(robot.place(undriven));
  EXPECT_EQ(robot.position(0), 1.5) << "it stands where it stood";
  EXPECT_FALSE(robot.take_away("wall"));
}

TEST(MujocoContact, WhatChangedInTheWorldOutlivesAnObstacle) {
  auto robot = MujocoRobot::make(rod()).value();
  robot.set_gravity(0, 0, 0);
  robot.set_rotors(std::array{0.3});
  robot.set_mass_factor(1.5);
  robot.push(1, 0, 0);
  run(robot, undriven, 100);
  auto other = MujocoRobot::make(rod()).value();
  other.set_gravity(0, 0, 0);
  other.set_rotors(std::array{0.3});
  other.set_mass_factor(1.5);
  other.push(1, 0, 0);
  ASSERT_TRUE(other.put(plane(0.5)) && other.take_away("floor"));
  run(other, undriven, 100);
  EXPECT_EQ(robot.position(0), other.position(0));
  EXPECT_EQ(robot.velocity(0), other.velocity(0));
}

TEST(MujocoContact, TakesSixteenObstaclesAndOneOfTheSameNameInPlaceOfAnother) {
  auto robot = MujocoRobot::make(rod()).value();
  Obstacle ball{"", {.kind = ShapeKind::Sphere, .sizes = {0.1}, .place_m = {3, 0, 0}}};
  for (std::size_t i = 0; i < most_obstacles; ++i) {
    ball.name = std::to_string(i);
    ASSERT_TRUE(robot.put(ball));
  }
  ASSERT_TRUE(robot.put(ball));
  ball.name = "one more";
  EXPECT_FALSE(robot.put(ball));
}

/// Three links on each other, each longer than the way to the next but one: all of them overlap at 0.
TEST(MujocoContact, NeighboursPassThroughEachOtherAndWhoIsAtEachOtherAtZeroIsTold) {
  const std::string shape = collision(R"(<box size="0.1 0.1 0.5"/>)");
  const auto turn = [](const char* name, const char* parent, const char* child) {
    return std::string{"<joint name='"} + name + "' type='revolute'><origin xyz='0 0 0.2'/><parent link='" + parent +
           "'/><child link='" + child +
           "'/><axis xyz='0 1 0'/><limit lower='-3' upper='3' velocity='9' effort='50'/></joint>";
  };
  auto robot = MujocoRobot::make("<robot name='r'><link name='base'>" + shape + "</link>" + link("a", shape) +
                                 link("b", shape) + turn("one", "base", "a") + turn("two", "a", "b") + "</robot>");
  ASSERT_TRUE(robot) << robot.error();
  ASSERT_EQ(
      robot->left_out(),
      std::vector<std::string>{"contact of links 'base' and 'b', which are at each other where all joints are at 0"});
  run(*robot, undriven, 1);
  EXPECT_EQ(robot->touched().contacts, 0);
}

using Facets = std::vector<std::array<std::array<float, 3>, 3>>;
/// The twelve triangles of a box, by its middle and half of its sides.
void add_box(const std::array<float, 3>& middle, const std::array<float, 3>& half, Facets& facets) {
  constexpr std::array<std::array<unsigned, 3>, 12> faces{{{0, 2, 1},
                                                           {1, 2, 3},
                                                           {4, 5, 6},
                                                           {5, 7, 6},
                                                           {0, 1, 4},
                                                           {1, 5, 4},
                                                           {2, 6, 3},
                                                           {3, 6, 7},
                                                           {0, 4, 2},
                                                           {2, 4, 6},
                                                           {1, 3, 5},
                                                           {3, 7, 5}}};
  for (const auto& face : faces) {
    auto& facet = facets.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        facet[i][axis] = middle[axis] + ((face[i] >> axis & 1U) != 0 ? half[axis] : -half[axis]);
  }
}
/// As octets of a binary STL file.
std::string stl_of(const Facets& facets) {
  std::string octets(80, ' ');
  const auto put = [&](const auto& value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    octets.append(raw.data(), raw.size());
  };
  put(static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    put(std::array{0.0F, 0.0F, 0.0F});
    put(facet);
    put(std::uint16_t{0});
  }
  return octets;
}
/// Of a cube; `extent`: half of its side.
std::string stl(float extent) {
  Facets facets;
  add_box({}, {extent, extent, extent}, facets);
  return stl_of(facets);
}
MeshSource only(std::string octets) {
  return [octets = std::move(octets)](const std::string&) -> std::expected<std::string, std::string> { return octets; };
}

/// The last link folds back onto the base.
TEST(MujocoContact, LinksThatAreNoNeighboursTouchWhetherTheyAreBoxesOrMeshes) {
  const std::string box = R"(<box size="0.1 0.1 0.2"/>)", mesh = R"(<mesh filename="cube.stl" scale="0.05 0.05 0.1"/>)";
  const auto at = [](const std::string& shape, const char* z) {
    return collision(shape, std::string{"<origin xyz='0 0 "} + z + "'/>");
  };
  const auto turn = [](const char* name, const char* parent, const char* child, const char* most) {
    return std::string{"<joint name='"} + name + "' type='revolute'><origin xyz='0 0 0.3'/><parent link='" + parent +
           "'/><child link='" + child + "'/><axis xyz='0 1 0'/><limit lower='-" + most + "' upper='" + most +
           "' velocity='9' effort='50'/></joint>";
  };
  double of_boxes_rad = 0;
  for (const auto& [base, end] : {std::pair{box, box}, {box, mesh}, {mesh, box}, {mesh, mesh}}) {
    auto robot = MujocoRobot::make("<robot name='r'><link name='base'>" + at(base, "0") + "</link>" +
                                       link("a", at(box, "0")) + link("b", at(end, "0.6")) +
                                       turn("one", "base", "a", "0.001") + turn("two", "a", "b", "3.1") + "</robot>",
                                   only(stl(1)));
    ASSERT_TRUE(robot) << robot.error();
    EXPECT_TRUE(robot->left_out().empty()) << robot->left_out().front();
    robot->set_gravity(0, 0, 0);
    ASSERT_TRUE(robot->place(std::array{0.0, 2.2}));
    run(*robot, std::array{0.0, 5.0}, 1500);
    EXPECT_GT(robot->touched().contacts, 0) << base << end;
    EXPECT_LT(robot->position(1), 3.05) << base << end;
    if (base == box && end == box) of_boxes_rad = robot->position(1);
    EXPECT_NEAR(robot->position(1), of_boxes_rad, 0.02) << base << end;
  }
}

/// A trough of 0.4 m and walls of 0.05 m, whose one hull is full, and in it a cube of 0.1 m, two links away.
TEST(MujocoContact, WhatIsInTheHollowOfAMeshTouchesItAtItsWall) {
  Facets trough;
  add_box({0, 0, -0.575F}, {0.2F, 0.2F, 0.025F}, trough);
  for (const float x : {-0.175F, 0.175F}) add_box({x, 0, -0.4F}, {0.025F, 0.2F, 0.2F}, trough);
  auto robot = MujocoRobot::make(
      "<robot name='r'><link name='base'>" + collision("<mesh filename='trough.stl'/>") + "</link>" +
          link("carriage", "") + link("cube", collision("<box size='0.1 0.1 0.1'/>")) +
          slide("x", "base", "carriage", "1 0 0") + slide("z", "carriage", "cube", "0 0 1") + "</robot>",
      only(stl_of(trough)));
  ASSERT_TRUE(robot) << robot.error();
  ASSERT_TRUE(robot->left_out().empty()) << robot->left_out().front();
  robot->set_gravity(0, 0, 0);
  ASSERT_TRUE(robot->place(std::array{0.0, -0.3}));
  run(*robot, undriven, 100);
  EXPECT_EQ(robot->touched().contacts, 0) << "it is within the hull, and touches nothing";
  EXPECT_NEAR(robot->position(0), 0, 1e-12);
  run(*robot, std::array{20.0, 0.0}, 2000);
  EXPECT_NEAR(robot->position(0), 0.1, 0.006) << "at the wall";
  EXPECT_NEAR(robot->touched().normal_n, 20, 0.5);
}

/// A cube with a sheet, which has no inside.
TEST(MujocoContact, PiecesOfAMeshThatHaveNoInsideAreTold) {
  Facets facets{{{{0.1F, 0, 0}, {0.9F, 0.1F, 0}, {0.9F, -0.1F, 0}}}};
  add_box({}, {0.1F, 0.1F, 0.1F}, facets);
  const auto robot = MujocoRobot::make(cube("<mesh filename='flag.stl'/>"), only(stl_of(facets)));
  ASSERT_TRUE(robot) << robot.error();
  ASSERT_EQ(robot->left_out().size(), 1U);
  EXPECT_TRUE(robot->left_out().front().starts_with("contact of link 'cube' with links where "))
      << robot->left_out().front();
  EXPECT_NE(robot->left_out().front().find(" pieces of flag.stl are: MuJoCo: "), std::string::npos)
      << robot->left_out().front();
}

TEST(MujocoContact, MeshesOfStlAndObjAreWhatTheirFilesSayAndStandOnAPlane) {
  std::string obj;
  for (int corner = 0; corner < 8; ++corner)
    obj += "v " + std::string{(corner & 1) != 0 ? "0.1" : "-0.1"} + ((corner & 2) != 0 ? " 0.1" : " -0.1") +
           ((corner & 4) != 0 ? " 0.1\n" : " -0.1\n");
  obj += "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n";
  const std::map<std::string, std::string> files{{"shapes/cube.stl", stl(100)}, {"cube.OBJ", obj}};
  const MeshSource meshes = [&](const std::string& file) -> std::expected<std::string, std::string> {
    if (const auto found = files.find(file); found != files.end()) return found->second;
    return std::unexpected{"does not exist"};
  };
  for (const char* shape : {R"(<mesh filename="package://shapes/cube.stl" scale="0.001 0.001 0.001"/>)",
                            R"(<mesh filename="cube.OBJ"/>)"}) {
    auto robot = MujocoRobot::make(cube(shape), meshes);
    ASSERT_TRUE(robot) << robot.error();
    ASSERT_TRUE(robot->left_out().empty()) << robot->left_out().front();
    ASSERT_TRUE(robot->place(std::array{0.0, 0.15}));
    ASSERT_TRUE(robot->put(plane(0.5)));
    run(*robot, undriven, 1000);
    EXPECT_NEAR(robot->position(1), 0.1, 0.001) << shape;
    EXPECT_NEAR(robot->touched().normal_n, weight_n, 0.05) << shape;
  }
}

TEST(MujocoContact, MeshesThatCannotBeReadAreToldAndCostNothingElse) {
  const MeshSource meshes = [&](const std::string& file) -> std::expected<std::string, std::string> {
    if (file == "text.stl") return "solid none\nendsolid none\n";
    return std::unexpected{"does not exist"};
  };
  for (const auto& [file, why] : {std::pair{"package://not/here.stl", "package://not/here.stl does not exist"},
                                  {"text.stl", "text.stl: MuJoCo: "},
                                  {"hull.dae", "hull.dae is neither STL nor OBJ"},
                                  {"file:///hull.stl", "file:///hull.stl is not beside the URDF file"}}) {
    auto robot = MujocoRobot::make(cube(std::string{"<mesh filename='"} + file + "'/>"), meshes);
    ASSERT_TRUE(robot) << robot.error();
    ASSERT_EQ(robot->left_out().size(), 1U);
    EXPECT_TRUE(robot->left_out().front().starts_with(std::string{"a shape of link 'cube': "} + why))
        << robot->left_out().front();
    EXPECT_EQ(robot->joints(), 2U);
  }
}

TEST(MujocoContact, LinksThatAreMeshesMeetObstaclesAsBoxesDo) {
  for (const bool mesh : {false, true}) {
    const std::string shape =
        collision(mesh ? R"(<mesh filename="cube.stl" scale="0.1 0.1 0.1"/>)" : R"(<box size="0.2 0.2 0.2"/>)");
    std::string text = R"(<robot name="train"><link name="base"/>)";
    for (const char* name : {"one", "two", "three"}) text += link(name, shape);
    text +=
        slide("a", "base", "one", "1 0 0") + slide("b", "one", "two", "1 0 0") + slide("c", "two", "three", "1 0 0");
    auto robot = MujocoRobot::make(text + "</robot>", only(stl(1)));
    ASSERT_TRUE(robot) << robot.error();
    ASSERT_EQ(robot->left_out().size(), 1U);
    EXPECT_TRUE(robot->left_out().front().starts_with("contact of links 'one' and 'three'"))
        << robot->left_out().front();
    ASSERT_TRUE(robot->place(std::array{0.0, 0.3, 0.3}));
    ASSERT_TRUE(
        robot->put({.name = "wall", .shape = {.kind = ShapeKind::Box, .sizes = {0.1, 1, 1}, .place_m = {0.76, 0, 0}}}));
    run(*robot, std::array{20.0, 20.0, 20.0}, 1000);  // of which the first two have nothing
    EXPECT_GT(robot->touched().normal_n, 1) << (mesh ? "mesh" : "box");
  }
}

}  // namespace
}  // namespace hirosco::simulation
