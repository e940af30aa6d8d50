// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/mesh_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::descriptor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(MeshFiles, LieBesideTheFileThatNamesThemOrNowhere) {
  EXPECT_EQ(mesh_beside("meshes/a.stl"), "meshes/a.stl");
  EXPECT_EQ(mesh_beside("./meshes/../a.stl"), "a.stl");
  EXPECT_EQ(mesh_beside("package://robot/meshes/a.stl"), "robot/meshes/a.stl");
  for (const char* nowhere : {"", "/a.stl", "../a.stl", "meshes/../../a.stl", "package:///a.stl", "package://../a.stl",
                              "file:///a.stl", "http://host/a.stl", "meshes/"})
    EXPECT_FALSE(mesh_beside(nowhere)) << nowhere;
}

TEST(MeshFiles, AreAllThatItsElementsNameEachOnce) {
  EXPECT_THAT(meshes_named("robots/r.urdf",
                           "<robot><link><collision><geometry><mesh filename='a.stl'/></geometry></collision>"
                           "<visual><geometry><mesh filename='package://b/c.obj'/></geometry></visual></link>"
                           "<link><visual><geometry><mesh filename='a.stl'/></geometry></visual></link>"
                           "<mesh filename='/etc/passwd'/><texture filename='t.png'/><mesh/></robot>"),
              ElementsAre("robots/a.stl", "robots/b/c.obj"));
  EXPECT_THAT(meshes_named("@hirosco/r.urdf", "<robot><mesh filename='a.stl'/></robot>"),
              ElementsAre("@hirosco/a.stl"));
  EXPECT_THAT(meshes_named("r.urdf", "no XML"), IsEmpty());
}

}  // namespace
}  // namespace hirosco::descriptor
