// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

namespace hirosco::robotics {
namespace {

using ::testing::HasSubstr;

[[nodiscard]] std::string word(std::uint32_t number) {
  std::string octets;
  for (int i = 0; i < 4; ++i) octets += static_cast<char>(number >> (8 * i) & 0xFF);
  return octets;
}
/// One triangle, of points that are twelve octets each.
[[nodiscard]] std::string binary_stl(std::uint32_t triangles, std::initializer_list<float> numbers) {
  std::string octets(80, 's');
  octets.replace(0, 5, "solid");
  octets += word(triangles) + std::string(12, '\0');
  for (const float number : numbers) octets += word(std::bit_cast<std::uint32_t>(number));
  return octets + std::string(2, '\0');
}
[[nodiscard]] MeshProblem problem_of(MeshKind kind, std::string_view text) {
  const auto mesh = read_mesh(kind, text);
  EXPECT_FALSE(mesh.has_value());
  return mesh ? MeshProblem{} : mesh.error();
}
[[nodiscard]] Mesh mesh_of(MeshKind kind, std::string_view text) {
  auto mesh = read_mesh(kind, text);
  EXPECT_TRUE(mesh.has_value()) << (mesh ? "" : mesh.error().text);
  return mesh.value_or(Mesh{});
}

TEST(Meshes, AreKnownByTheirEnding) {
  EXPECT_EQ(mesh_kind("a/b.STL"), MeshKind::Stl);
  EXPECT_EQ(mesh_kind("b.obj"), MeshKind::Obj);
  EXPECT_EQ(mesh_kind("b.dae"), MeshKind::Collada);
  EXPECT_FALSE(mesh_kind("stl"));
  EXPECT_FALSE(mesh_kind("b.ply"));
}

TEST(Stl, IsReadBinaryAlsoWhenItBeginsAsATextDoes) {
  const Mesh mesh = mesh_of(MeshKind::Stl, binary_stl(1, {0, 0, 0, 1, 0, 0, 0, 2.5F, 0}));
  ASSERT_EQ(mesh.points.size(), 3u);
  EXPECT_EQ(mesh.points[2], Vector3(0, 2.5, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Mesh::Triangle>{{0, 1, 2}}));
}

TEST(Stl, IsReadAsText) {
  const Mesh mesh = mesh_of(MeshKind::Stl, R"(solid it has a name
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1e0 0 0
      vertex 0 +2.5 0
    endloop
  endfacet
endsolid
)");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.points[2], Vector3(0, 2.5, 0));
}

TEST(Stl, ThatIsWrongIsToldWithItsPlace) {
  EXPECT_THAT(problem_of(MeshKind::Stl, binary_stl(2, {0, 0, 0, 1, 0, 0, 0, 2, 0})).text, HasSubstr("has 134"));
  EXPECT_THAT(problem_of(MeshKind::Stl, "short").text, HasSubstr("shorter"));
  EXPECT_THAT(problem_of(MeshKind::Stl, binary_stl(1, {0, 0, 0, 1, 0, 0, 0, NAN, 0})).text, HasSubstr("triangle 1"));
  const auto wrong = problem_of(MeshKind::Stl, "solid a\nfacet normal 0 0 1\nouter loop\n vertex 0 nine 0\n");
  EXPECT_EQ(wrong.at, (descriptor::Location{4, 11}));
  EXPECT_THAT(wrong.text, HasSubstr("'nine' is no number"));
  EXPECT_EQ(problem_of(MeshKind::Stl, "solid a\nvertex 1 2\nvertex 3 4 5\n").at.line, 2);
  EXPECT_THAT(problem_of(MeshKind::Stl, "solid a\nfacet\nvertex 0 0 0\nendfacet\n").text, HasSubstr("three points"));
  EXPECT_THAT(problem_of(MeshKind::Stl, "solid a\nendsolid\n").text, HasSubstr("no triangle"));
  EXPECT_THAT(problem_of(MeshKind::Stl, binary_stl(1, {0, 0, 0, 1, 0, 0, 0, 2e4F, 0})).text, HasSubstr("10 km"));
}

TEST(Obj, HasPolygonsAsFansAndCountsBackFromTheEnd) {
  const Mesh mesh = mesh_of(MeshKind::Obj, R"(# a comment
o thing
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1 0
vn 0 0 1
f 1//1 2//1 3//1 -1//1
)");
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Stl, IsWrittenAsEveryReaderHasIt) {
  const Mesh square{.points = {{0, 0, 0.5}, {2.5, 0, 0.5}, {2.5, 2.5, 0.5}, {0, 2.5, 0.5}},
                    .triangles = {{0, 1, 2}, {3, 0, 2}}};
  const std::string octets = as_binary_stl(square);
  ASSERT_EQ(octets.size(), 84u + 2 * 50);
  EXPECT_FALSE(octets.starts_with("solid")) << "no reader takes it for a text";
  EXPECT_EQ(octets.substr(80, 4), word(2));
  const auto of_number = [](float number) { return word(std::bit_cast<std::uint32_t>(number)); };
  const std::string second = octets.substr(84 + 50);
  EXPECT_EQ(second.substr(8, 4), of_number(1)) << "its normal points along z";
  std::string corners;
  for (const float number : {0.0F, 2.5F, 0.5F, 0.0F, 0.0F, 0.5F, 2.5F, 2.5F, 0.5F}) corners += of_number(number);
  EXPECT_EQ(second.substr(12), corners + std::string(2, '\0'));
  EXPECT_TRUE(is_binary_stl(octets));
  EXPECT_FALSE(is_binary_stl("solid it\nendsolid\n"));
  EXPECT_FALSE(is_binary_stl(octets + "more"));
  const Mesh read = mesh_of(MeshKind::Stl, octets);
  EXPECT_EQ(read.points[3], Vector3(0, 2.5, 0.5));
}

TEST(Stl, OfATriangleWithoutAreaHasNoNormal) {
  const std::string octets = as_binary_stl({.points = {{1, 1, 1}}, .triangles = {{0, 0, 0}}});
  EXPECT_EQ(octets.substr(84, 12), std::string(12, '\0'));
}

TEST(Obj, ThatIsWrongIsToldWithItsPlace) {
  EXPECT_EQ(problem_of(MeshKind::Obj, "v 0 0 0\nv 1 0 0\nf 1 2 3\n").at, (descriptor::Location{3, 7}));
  EXPECT_EQ(problem_of(MeshKind::Obj, "v 0 0 0\nf 0 1 1\n").at, (descriptor::Location{2, 3}));
  EXPECT_EQ(problem_of(MeshKind::Obj, "v 0 0 0\nf 1 1 -2\n").at, (descriptor::Location{2, 7}));
  EXPECT_EQ(problem_of(MeshKind::Obj, "v 0 0\nv 1 1 1\n").at.line, 1);
  EXPECT_THAT(problem_of(MeshKind::Obj, "v 0 0 0\nf 1 1\n").text, HasSubstr("at least three"));
}

/// A unit square in mm, turned and moved by two nodes.
[[nodiscard]] std::string collada(std::string_view primitive, std::string_view scene) {
  return std::string{R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
 <library_geometries><geometry id="g"><mesh>
  <source id="s"><float_array id="a" count="12">
    0 0 0  1 0 0
    1 1 0  0 1 0</float_array>
   <technique_common><accessor source="#a" count="4" stride="3"/></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
)"} + std::string{primitive} +
         "</mesh></geometry></library_geometries>" + std::string{scene} + "</COLLADA>";
}
constexpr std::string_view triangles =
    "<triangles count=\"2\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/><input semantic=\"NORMAL\" "
    "source=\"#n\" offset=\"0\"/><p>9 0 9 1 9 2 9 0 9 2 9 3</p></triangles>";
constexpr std::string_view scene = R"(<library_visual_scenes><visual_scene id="w">
  <node><translate>0 0 5</translate><rotate>0 0 1 90</rotate>
   <node><matrix>2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1</matrix><instance_geometry url="#g"/></node></node>
 </visual_scene></library_visual_scenes><scene><instance_visual_scene url="#w"/></scene>)";

TEST(Collada, IsReadInItsUnitsAndWhereItsNodesHaveIt) {
  const Mesh mesh = mesh_of(MeshKind::Collada, collada(triangles, scene));
  EXPECT_EQ(mesh.triangles, (std::vector<Mesh::Triangle>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.points.size(), 4u);
  EXPECT_LT((mesh.points[1] - Vector3(0, 0.002, 0.005)).norm(), 1e-12);
  EXPECT_LT((mesh.points[3] - Vector3(-0.002, 0, 0.005)).norm(), 1e-12);
  EXPECT_LT((mesh_of(MeshKind::Collada, collada(triangles, "")).points[2] - Vector3(0.001, 0.001, 0)).norm(), 1e-12)
      << "without a scene as it stands";
}

TEST(Collada, HasPolygonsStripsAndFans) {
  const auto taken = [](std::string_view kind, std::string_view p) {
    return mesh_of(MeshKind::Collada,
                   collada("<" + std::string{kind} + "><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>" +
                               std::string{p} + "</" + std::string{kind} + ">",
                           scene))
        .triangles.size();
  };
  EXPECT_EQ(taken("polylist", "<vcount>3 4</vcount><p>0 1 2 0 1 2 3</p>"), 3u);
  EXPECT_EQ(taken("polygons", "<p>0 1 2 3</p><p>0 1 2</p>"), 3u);
  EXPECT_EQ(taken("tristrips", "<p>0 1 2 3</p>"), 2u);
  EXPECT_EQ(taken("trifans", "<p>0 1 2 3</p>"), 2u);
}

TEST(Collada, ThatIsWrongIsToldWithItsPlace) {
  const auto wrong = [](const std::string& from, const std::string& to) {
    std::string text = collada(triangles, scene);
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return problem_of(MeshKind::Collada, text);
  };
  const auto number = wrong("1 1 0", "1 one 0");
  EXPECT_EQ(number.at, (descriptor::Location{7, 7}));
  EXPECT_THAT(number.text, HasSubstr("'one'"));
  EXPECT_THAT(wrong("9 3</p>", "9 4</p>").text, HasSubstr("there are 4"));
  EXPECT_THAT(wrong("source=\"#s\"", "source=\"#q\"").text, HasSubstr("'q'"));
  EXPECT_THAT(wrong("url=\"#g\"", "url=\"#s\"").text, HasSubstr("no <mesh>"));
  EXPECT_THAT(wrong("url=\"#g\"", "url=\"#q\"").text, HasSubstr("not in this file"));
  EXPECT_THAT(wrong("0.001", "0").text, HasSubstr("metres"));
  EXPECT_THAT(wrong("<rotate>0 0 1 90", "<rotate>0 0 1").text, HasSubstr("4 numbers"));
  EXPECT_THAT(wrong("<rotate>0 0 1 90</rotate>", "<lookat/>").text, HasSubstr("<matrix>"));
  EXPECT_THAT(wrong("semantic=\"VERTEX\"", "semantic=\"TEXCOORD\"").text, HasSubstr("no input VERTEX"));
  EXPECT_THAT(wrong("offset=\"1\"", "offset=\"1000\"").text, HasSubstr("offset"));
  EXPECT_THAT(wrong("stride=\"3\"", "stride=\"2\"").text, HasSubstr("three numbers"));
  EXPECT_THAT(wrong("</COLLADA>", "").text, ::testing::Not(""));
  EXPECT_THAT(problem_of(MeshKind::Collada, "<x/>").text, HasSubstr("COLLADA"));
}

/// z of the normals, whose sign says on which side the outside is.
[[nodiscard]] std::vector<double> outsides(const Mesh& mesh) {
  std::vector<double> found;
  for (const auto& [a, b, c] : mesh.triangles)
    found.push_back((mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).z());
  return found;
}

TEST(Collada, KeepsItsOutsideOutside) {
  const auto all = [](const std::vector<double>& normals) {
    return std::ranges::all_of(normals, [](double z) { return z > 0; });
  };
  EXPECT_TRUE(all(outsides(mesh_of(MeshKind::Collada, collada(triangles, scene)))));
  std::string mirrored{scene};
  mirrored.replace(mirrored.find("2 0 0 0"), 1, "-2");
  EXPECT_TRUE(all(outsides(mesh_of(MeshKind::Collada, collada(triangles, mirrored)))));
  const Mesh strip =
      mesh_of(MeshKind::Collada, collada("<tristrips><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
                                         "<p>0 1 3 2</p></tristrips>",
                                         scene));
  EXPECT_EQ(strip.triangles.size(), 2u);
  EXPECT_TRUE(all(outsides(strip)));
}

TEST(Collada, ThatHasMoreSurfaceThanIsReadIsRefused) {
  EXPECT_THAT(
      problem_of(MeshKind::Collada,
                 collada("<polygons><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><ph><p>0 1 2</p><h>0 "
                         "1 3</h></ph></polygons>",
                         scene))
          .text,
      HasSubstr("holes"));
  std::string skin{scene};
  const std::string shown = "<instance_geometry url=\"#g\"/>";
  skin.replace(skin.find(shown), shown.size(), shown + "<instance_controller url=\"#c\"/>");
  EXPECT_THAT(problem_of(MeshKind::Collada, collada(triangles, skin)).text, HasSubstr("skin"));
}

/// What no axis of a file turns: URDF says where a mesh is.
TEST(Collada, IsTurnedByNoAxisThatIsUp) {
  std::string text = collada(triangles, scene);
  const std::vector<Vector3> y_up = mesh_of(MeshKind::Collada, text).points;
  for (const char* up : {"Z_UP", "X_UP"}) {
    text.replace(text.find("_UP") - 1, 4, up);
    EXPECT_EQ(mesh_of(MeshKind::Collada, text).points, y_up) << up;
  }
}

TEST(Collada, OfANodeThatIsInItselfHasAnEnd) {
  EXPECT_THAT(
      problem_of(MeshKind::Collada, collada(triangles,
                                            "<library_visual_scenes><visual_scene id='w'><node id='n'><instance_node "
                                            "url='#n'/></node></visual_scene></library_visual_scenes><scene>"
                                            "<instance_visual_scene url='#w'/></scene>"))
          .text,
      HasSubstr("deeper"));
}

}  // namespace
}  // namespace hirosco::robotics
