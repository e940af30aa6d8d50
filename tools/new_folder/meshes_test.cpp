// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/meshes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "robotics/shapes/mesh.hpp"
#include "tools/new_folder/robot.hpp"

/// Which meshes come along into a robot's folder, and what is told of the others (docs/adr/0131).
namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

/// A box about its origin, m.
[[nodiscard]] std::string box(double x, double y, double z) {
  std::string text;
  for (const double i : {-x, x})
    for (const double j : {-y, y})
      for (const double k : {-z, z}) text += fmt::format("v {} {} {}\n", i / 2, j / 2, k / 2);
  return text + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
}

using Disk = std::map<fs::path, std::string>;
[[nodiscard]] descriptor::FileSource on(const Disk& disk) {
  return [disk](const fs::path& file) -> Result<std::string> {
    const auto found = disk.find(file);
    if (found == disk.end()) return fail(ErrorCode::NotFound, "does not exist");
    if (found->second == "large") return fail(ErrorCode::ResourceExhausted, "is larger than 4 MiB");
    return found->second;
  };
}
[[nodiscard]] std::string link(const std::string& mesh, const char* name = "a") {
  return fmt::format(
      "<link name='{}'><visual><geometry><mesh filename=\"{}\"/></geometry></visual>\n"
      "<collision><geometry><mesh filename=\"{}\"/></geometry></collision></link>\n",
      name, mesh, mesh);
}

TEST(TakenMeshes, AreFoundInPackagesAboveTheFileAndOnlyTheirNamesAreOthers) {
  const Disk disk{{"/ws/src/arm_description/meshes/base.obj", box(1, 1, 1)}};
  const std::string named = "package://arm_description/meshes/base.obj";
  const auto taken = take_meshes("/ws/src/arm_description/urdf/arm.urdf",
                                 "<robot>\n" + link(named) + link(named, "b") + "</robot>", on(disk));
  EXPECT_THAT(taken.warnings, IsEmpty());
  EXPECT_THAT(taken.files, ElementsAre(std::pair{std::string{"meshes/base.obj"}, box(1, 1, 1)})) << "once";
  EXPECT_EQ(taken.urdf,
            "<robot>\n"
            "<link name='a'><visual><geometry><mesh filename=\"package://arm_description/meshes/base.obj\"/></geometry>"
            "</visual>\n<collision><geometry><mesh filename=\"meshes/base.obj\"/></geometry></collision></link>\n"
            "<link name='b'><visual><geometry><mesh filename=\"package://arm_description/meshes/base.obj\"/></geometry>"
            "</visual>\n<collision><geometry><mesh filename=\"meshes/base.obj\"/></geometry></collision></link>\n"
            "</robot>");
}

TEST(TakenMeshes, AreFoundHoweverTheyAreNamed) {
  const Disk disk{
      {"/robots/meshes/a.obj", box(1, 1, 1)}, {"/ros/tool/A.OBJ", box(2, 1, 1)}, {"/robots/package.xml", "<package/>"}};
  const std::vector<fs::path> packages{"/ros"};
  for (const char* named : {"../meshes/a.obj", "file:///robots/meshes/a.obj", "/robots/meshes/a.obj",
                            "package://renamed/meshes/a.obj", "package://tool/A.OBJ", "model://tool/A.OBJ"}) {
    const auto taken = take_meshes("/robots/urdf/r.urdf", "<robot>" + link(named) + "</robot>", on(disk), packages);
    EXPECT_EQ(taken.files.size(), 1u) << named;
    EXPECT_THAT(taken.warnings, IsEmpty()) << named;
  }
}

TEST(TakenMeshes, OfOneNameAreKeptApartAndHaveNamesThatNobodyMinds) {
  const Disk disk{{"/r/x/a.obj", box(1, 1, 1)}, {"/r/y/A.obj", box(2, 1, 1)}, {"/r/\xC3\xA4 &.obj", box(3, 1, 1)}};
  const auto taken = take_meshes("/r/r.urdf",
                                 "\xEF\xBB\xBF<robot n='\xC3\xA4'>" + link("x/a.obj") +
                                     link("y/A.obj", "\xC3\xA4\xC3\xB6") + link("\xC3\xA4 &amp;.obj") + "</robot>",
                                 on(disk));
  EXPECT_THAT(taken.files, ElementsAre(std::pair{std::string{"meshes/a.obj"}, box(1, 1, 1)},
                                       std::pair{std::string{"meshes/A_2.obj"}, box(2, 1, 1)},
                                       std::pair{std::string{"meshes/____.obj"}, box(3, 1, 1)}));
  EXPECT_THAT(taken.urdf,
              HasSubstr("<collision><geometry><mesh filename=\"meshes/____.obj\"/></geometry></collision>"));
  EXPECT_THAT(taken.urdf, HasSubstr("<visual><geometry><mesh filename=\"\xC3\xA4 &amp;.obj\"/></geometry></visual>"));
}

TEST(TakenMeshes, ThatStayWhereTheyAreAreToldWithPlaceReasonAndWhatToDo) {
  struct Case {
    const char* named;
    const char* code;
    const char* told;
  };
  const Disk disk{{"/r/large.stl", "large"}, {"/r/wrong.obj", "v 1 2\n"}, {"/r/a.ply", "ply"}};
  for (const Case& each : {Case{"missing.stl", "U0706", "is nowhere: not as /r/missing.stl"},
                           Case{"package://p/missing.stl", "U0706", "is nowhere: not as /r/p/missing.stl"},
                           Case{"http://host/a.stl", "U0706", "in a way that nobody follows"},
                           Case{"package://../a.stl", "U0706", "in a way that nobody follows"},
                           Case{"large.stl", "U0707", "/r/large.stl is larger than 4 MiB"},
                           Case{"a.ply", "U0702", "neither STL, OBJ nor COLLADA"},
                           Case{"wrong.obj", "U0704", "a point has three numbers"}}) {
    const std::string text = "<robot>\n" + link(each.named) + link(each.named, "b") + "</robot>";
    const auto taken = take_meshes("/r/r.urdf", text, on(disk));
    EXPECT_EQ(taken.urdf, text) << each.named;
    EXPECT_THAT(taken.files, IsEmpty());
    ASSERT_EQ(taken.warnings.size(), 1u) << each.named << ": said once";
    const auto& said = taken.warnings.front();
    EXPECT_EQ(said.code, each.code);
    EXPECT_THAT(said.message, HasSubstr(each.told));
    EXPECT_THAT(said.message, HasSubstr("is not seen"));
    EXPECT_NE(said.hint, "");
    EXPECT_EQ(said.grade, descriptor::Grade::Warning);
    const bool of_mesh = said.code == "U0704";
    EXPECT_EQ(said.file, of_mesh ? "/r/wrong.obj" : "/r/r.urdf");
    EXPECT_EQ(said.at.line, of_mesh ? 1 : 3);
  }
}

/// A triangle of 300 and 400 mm, as often as is said.
[[nodiscard]] std::string collada(std::size_t times) {
  std::string corners;
  for (std::size_t i = 0; i < times; ++i) corners += "0 1 2 ";
  return "<COLLADA><asset><unit meter='0.001'/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry "
         "id='g'><mesh>"
         "<source id='s'><float_array>0 0 0 300 0 0 0 400 0</float_array></source>"
         "<vertices id='v'><input semantic='POSITION' source='#s'/></vertices>"
         "<triangles><input semantic='VERTEX' source='#v' offset='0'/><p>" +
         corners + "</p></triangles></mesh></geometry></library_geometries></COLLADA>";
}

TEST(TakenMeshes, ThatNoWorldReadsBecomeStlWhichBothRead) {
  const std::string text =
      "solid of words\nfacet\nouter loop\nvertex 0 0 0\nvertex 0.3 0 0\nvertex 0 0.4 0\nendloop\nendfacet\nendsolid\n";
  const Disk disk{{"/r/a.dae", collada(1)}, {"/r/b.STL", text}};
  const std::string scaled =
      "<link name='c'><collision><geometry><mesh filename='a.dae' scale='2 2 2'/></geometry></collision></link>";
  const auto taken =
      take_meshes("/r/r.urdf", "<robot>" + link("a.dae") + link("b.STL", "b") + scaled + "</robot>", on(disk));
  EXPECT_THAT(taken.warnings, IsEmpty());
  ASSERT_EQ(taken.files.size(), 2u);
  EXPECT_EQ(taken.files[0].first, "meshes/a.stl");
  EXPECT_EQ(taken.files[1].first, "meshes/b.stl");
  for (const auto& [name, octets] : taken.files) {
    EXPECT_TRUE(robotics::is_binary_stl(octets)) << name;
    const auto mesh = robotics::read_mesh(robotics::MeshKind::Stl, octets);
    ASSERT_TRUE(mesh) << name;
    EXPECT_LT((mesh->points[2] - robotics::Vector3(0, 0.4, 0)).norm(), 1e-7) << "in m, and turned by no axis: " << name;
  }
  EXPECT_THAT(taken.urdf, HasSubstr("<collision><geometry><mesh filename=\"meshes/a.stl\"/>"));
  EXPECT_THAT(taken.urdf, HasSubstr("<mesh filename='meshes/a.stl' scale='2 2 2'/>")) << "its scale is as it was";
  EXPECT_THAT(taken.urdf, HasSubstr("<visual><geometry><mesh filename=\"a.dae\"/>")) << "nobody reads these";
}

TEST(TakenMeshes, ThatWouldBeTooLargeAsStlStayWhatTheyAreWhichIsTold) {
  constexpr std::size_t most = (4 * 1024 * 1024 - 84) / 50;
  for (const std::size_t triangles : {most, most + 1}) {
    const Disk disk{{"/r/a.dae", collada(triangles)}};
    const auto taken = take_meshes("/r/r.urdf", "<robot>\n" + link("a.dae") + "</robot>", on(disk));
    ASSERT_EQ(taken.files.size(), 1u);
    EXPECT_EQ(taken.files[0].first, triangles > most ? "meshes/a.dae" : "meshes/a.stl");
    ASSERT_EQ(taken.warnings.size(), triangles > most ? 1u : 0u);
    if (taken.warnings.empty()) continue;
    EXPECT_EQ(taken.warnings[0].code, "U0708");
    EXPECT_THAT(taken.warnings[0].message, HasSubstr("mesh 'a.dae' of link 'a' has 83885 triangles"));
    EXPECT_THAT(taken.warnings[0].message, HasSubstr("its world does not"));
    EXPECT_EQ(taken.warnings[0].at.line, 3);
    EXPECT_EQ(taken.warnings[0].grade, descriptor::Grade::Warning);
  }
}

TEST(TakenMeshes, AreBoundedInAll) {
  std::string text = "<robot>\n";
  Disk disk;
  for (std::size_t i = 0; i <= most_taken_meshes; ++i) {
    disk[fmt::format("/r/{}.obj", i)] = box(1, 1, 1);
    text += link(fmt::format("{}.obj", i));
  }
  const auto taken = take_meshes("/r/r.urdf", text + "</robot>", on(disk));
  EXPECT_EQ(taken.files.size(), most_taken_meshes);
  ASSERT_EQ(taken.warnings.size(), 1u);
  EXPECT_EQ(taken.warnings.front().code, "U0707");
  EXPECT_THAT(taken.urdf,
              HasSubstr(fmt::format("<mesh filename=\"{}.obj\"/></geometry></collision>", most_taken_meshes)));
}

/// Three links of 1 m in a row along x that turn about y; a post beside the base is in the last one's way: only its mesh says so.
[[nodiscard]] std::string folding(bool with_post) {
  const auto bar = [](const char* name) {
    return fmt::format(
        "<link name='{}'><inertial><origin xyz='0.5 0 0'/><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' "
        "iyy='0.1' iyz='0' izz='0.1'/></inertial><collision><origin xyz='0.5 0 0'/><geometry><mesh "
        "filename='package://p/bar.obj'/></geometry></collision></link>\n",
        name);
  };
  const auto joint = [](const char* name, const char* parent, const char* child, double x) {
    return fmt::format(
        "<joint name='{}' type='revolute'><origin xyz='{} 0 0'/><parent link='{}'/><child link='{}'/><axis "
        "xyz='0 1 0'/><limit lower='-1.2' upper='2' velocity='1' effort='200'/></joint>\n",
        name, x, parent, child);
  };
  return fmt::format("<robot name='folding'><link name='base'>{}</link>\n",
                     with_post ? "<collision><origin xyz='2.5 0 -0.28'/><geometry><mesh "
                                 "filename='package://p/post.obj'/></geometry></collision>"
                               : "") +
         bar("one") + bar("two") + bar("three") + joint("j1", "base", "one", 0) + joint("j2", "one", "two", 1) +
         joint("j3", "two", "three", 1) + "</robot>";
}

TEST(NewRobot, GoesWhereItsMeshesAreClearOfEachOther) {
  const Disk disk{{"/r/urdf/free.urdf", folding(false)},
                  {"/r/urdf/post.urdf", folding(true)},
                  {"/r/p/bar.obj", box(0.8, 0.1, 0.1)},
                  {"/r/p/post.obj", box(0.4, 0.4, 0.4)}};
  const auto free = judge_robot("/r/urdf/free.urdf", on(disk), "");
  ASSERT_TRUE(free.robot) << free.problems.front().message;
  EXPECT_THAT(free.robot->goal, ElementsAre(0.3, 0.3, 0.3)) << "downwards, towards the middles of the ranges";
  EXPECT_EQ(free.robot->meshes.size(), 1u);
  const auto post = judge_robot("/r/urdf/post.urdf", on(disk), "");
  ASSERT_TRUE(post.robot) << post.problems.front().message;
  EXPECT_THAT(post.robot->posture, ElementsAre(0.0, 0.0, 0.0)) << "beside it, which is how it is built";
  EXPECT_NE(post.robot->goal, free.robot->goal);
  EXPECT_LT(post.robot->goal[0] + post.robot->goal[1] / 2, 0.05) << "not down into the post";
  EXPECT_THAT(post.robot->urdf, HasSubstr("meshes/post.obj"));
}

TEST(NewRobot, IsRefusedWhereItsArmWouldNotStartForItsShapes) {
  std::string text = folding(false);
  text.replace(text.find("xyz='0.5 0 0'/><geometry>"), 13, "xyz='0.5 0'  ");
  const auto judged = judge_robot("/r/urdf/r.urdf", on({{"/r/urdf/r.urdf", text}}), "");
  ASSERT_FALSE(judged.robot);
  EXPECT_EQ(judged.problems.front().code, "U0705");
}

}  // namespace
}  // namespace hirosco::tools
