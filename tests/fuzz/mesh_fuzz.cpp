// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "robotics/shapes/mesh.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A mesh from whatever octets come, as each kind of file. What is taken has triangles of points that there are, each a place, and
/// is the same surface where it is written as STL; what is refused says why.
namespace {

using namespace hirosco::robotics;

using hirosco::fuzz::expect;

void check(const Mesh& mesh) {
  hirosco::fuzz::taken();
  expect(!mesh.triangles.empty(), "a mesh has a triangle");
  for (const Mesh::Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      expect(corner < mesh.points.size(), "a corner is a point that there is");
  for (const Vector3& point : mesh.points) expect(point.allFinite(), "a point is a place");
  if (mesh.triangles.size() > most_mesh_points / 3) return;  // each has three points of its own there
  const auto written = read_mesh(MeshKind::Stl, as_binary_stl(mesh));
  expect(written && written->triangles.size() == mesh.triangles.size(), "what is written as STL is read as such");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3& meant = mesh.points[mesh.triangles[i][k]];
      const Vector3& is = written->points[written->triangles[i][k]];
      expect((is - meant).cwiseAbs().maxCoeff() <= 1e-7 * meant.cwiseAbs().maxCoeff() + 1e-40,
             "a corner is where it was, but for the rounding of FLOAT");
    }
}

/// One octet from 80 on for each part of a COLLADA file.
[[nodiscard]] std::string spelled(std::string_view octets) {
  static constexpr std::string_view words[] = {
      "<library_geometries><geometry id=\"g\"><mesh>",
      "<source id=\"s\"><float_array>",
      "</float_array></source>",
      "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>",
      "<triangles><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>",
      "</p></triangles>",
      "<polylist><input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/><vcount>",
      "</vcount><p>",
      "</p></polylist>",
      "</mesh></geometry></library_geometries>",
      "<library_visual_scenes><visual_scene id=\"w\">",
      "<node id=\"n\">",
      "</node>",
      "<matrix>",
      "</matrix>",
      "<instance_geometry url=\"#g\"/>",
      "<instance_node url=\"#n\"/>",
      "</visual_scene></library_visual_scenes>",
      "<scene><instance_visual_scene url=\"#w\"/></scene>"};
  std::string text = "<COLLADA>";
  for (const char c : octets) {
    const auto octet = static_cast<unsigned char>(c);
    if (octet >= 128 && octet - 128U < std::size(words)) text += words[octet - 128U];
    else text += c;
  }
  return text + "</COLLADA>";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view octets{reinterpret_cast<const char*>(data), size};
  const auto look = [](MeshKind kind, std::string_view text) {
    const auto mesh = read_mesh(kind, text);
    if (mesh) check(*mesh);
    else expect(!mesh.error().text.empty(), "what is refused says why");
  };
  look(MeshKind::Stl, octets);
  look(MeshKind::Stl, "solid " + std::string{octets});
  look(MeshKind::Obj, octets);
  look(MeshKind::Collada, spelled(octets));
  return 0;
}
