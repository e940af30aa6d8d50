// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/page_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::ground {
namespace {

namespace fs = std::filesystem;

/// A mission's folder with a page and, beside it, what is nobody's business.
class PageFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path{::testing::TempDir()} / ("page_files_" + std::to_string(::getpid()));
    fs::create_directories(folder / "page/meshes");
    write("mission.xml", "<Mission/>");
    write("page/scene.json", "{}");
    write("page/tour.js", "export const tour = () => [];");
    write("page/arm.urdf", "<robot/>");
    write("page/meshes/link.stl", "solid");
    write("page/.hidden.json", "{}");
    write("page/notes.docx", "words");
    files.emplace(fs::path{}, folder / "page");
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& content) { std::ofstream{folder / name} << content; }
  [[nodiscard]] bool there(const std::string& path) const { return files->file(path, false).has_value(); }

  fs::path folder;
  std::optional<PageFiles> files;
};

TEST_F(PageFilesTest, OfAMissionAreServedWithTheTypeThatTheirNameSays) {
  const auto scene = files->file("/mission/scene.json", false);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->body, "{}");
  EXPECT_EQ(scene->type, "application/json");
  EXPECT_EQ(files->file("/mission/tour.js", false)->type, "text/javascript; charset=utf-8");
  EXPECT_EQ(files->file("/mission/arm.urdf", false)->type, "application/xml");
  EXPECT_EQ(files->file("/mission/meshes/link.stl", true)->type, "model/stl");
}

TEST_F(PageFilesTest, OfAMissionAreListedSoThatAPageNeedNotTry) {
  write("page/index.json", "[\"forged\"]");
  EXPECT_EQ(files->file("/mission/index.json", false)->body, R"(["arm.urdf","index.json","scene.json","tour.js"])");
}

TEST_F(PageFilesTest, OfAMissionWithoutThemAreAnEmptyList) {
  EXPECT_EQ(PageFiles({}, folder / "none").file("/mission/index.json", false)->body, "[]");
  EXPECT_EQ(PageFiles({}, {}).file("/mission/index.json", false)->body, "[]");
  EXPECT_FALSE(PageFiles({}, {}).file("/mission/scene.json", false));
  EXPECT_FALSE(PageFiles({}, {}).file("/mission/etc/passwd.txt", false));
}

TEST_F(PageFilesTest, LeadOutOfTheirFolderByNoName) {
  for (const char* path :
       {"/mission/../mission.xml", "/mission/..", "/mission/.", "/mission/", "/mission//scene.json",
        "/mission/./scene.json", "/mission/meshes/../../mission.xml", "/mission/meshes/../scene.json",
        "/mission/%2e%2e/mission.xml", "/mission/..%2fmission.xml", "/mission/..\\mission.xml",
        "/mission//etc/hosts.txt", "/mission/.hidden.json", "/mission/scene.json/", "/mission/scene.json\n",
        "mission/scene.json", "/mission/sc\xC3\xA9ne.json"})
    EXPECT_FALSE(there(path)) << path;
  EXPECT_FALSE(there(std::string{"/mission/scene.json\0.xml", 24}));
  EXPECT_FALSE(there("/mission/" + std::string(100'000, 'a') + ".json"));
}

TEST_F(PageFilesTest, LeadOutOfTheirFolderByNoLink) {
  write("secret.json", "{\"secret\":1}");
  fs::create_symlink(folder / "secret.json", folder / "page/link.json");
  fs::create_symlink("..", folder / "page/up");
  fs::create_symlink(folder / "page/scene.json", folder / "page/inside.json");
  fs::create_symlink("loop.json", folder / "page/loop.json");
  EXPECT_FALSE(there("/mission/link.json"));
  EXPECT_FALSE(there("/mission/up/secret.json"));
  EXPECT_FALSE(there("/mission/loop.json"));
  EXPECT_TRUE(there("/mission/inside.json"));
}

TEST_F(PageFilesTest, AreOnlyWhatAPageCanUseAndNotTooLarge) {
  EXPECT_FALSE(there("/mission/notes.docx"));
  EXPECT_FALSE(there("/mission/meshes"));
  EXPECT_FALSE(there("/mission/none.json"));
  ASSERT_EQ(::mkfifo((folder / "page/pipe.json").c_str(), 0600), 0);
  EXPECT_FALSE(there("/mission/pipe.json"));
  write("page/large.json", "");
  fs::resize_file(folder / "page/large.json", PageFiles::most_octets + 1);
  EXPECT_FALSE(there("/mission/large.json"));
  fs::resize_file(folder / "page/large.json", PageFiles::most_octets);
  EXPECT_TRUE(there("/mission/large.json"));
}

TEST_F(PageFilesTest, OfThePageAreNotHiddenByAMission) {
  fs::create_directories(folder / "own");
  write("own/main.js", "page");
  write("page/main.js", "mission");
  const PageFiles both{folder / "own", folder / "page"};
  EXPECT_EQ(both.file("/main.js", false)->body, "page");
  EXPECT_EQ(both.file("/mission/main.js", false)->body, "mission");
  EXPECT_FALSE(both.file("/scene.json", false));
}

}  // namespace
}  // namespace hirosco::ground
