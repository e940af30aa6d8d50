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
  [[nodiscard]] bool there(const std::string& path) const { return files->file(path, {}).has_value(); }

  fs::path folder;
  std::optional<PageFiles> files;
};

TEST_F(PageFilesTest, OfAMissionAreServedWithTheTypeThatTheirNameSays) {
  const auto scene = files->file("/mission/scene.json", {});
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->body, "{}");
  EXPECT_EQ(scene->type, "application/json");
  EXPECT_EQ(files->file("/mission/tour.js", {})->type, "text/javascript; charset=utf-8");
  EXPECT_EQ(files->file("/mission/arm.urdf", {})->type, "application/xml");
  EXPECT_EQ(files->file("/mission/meshes/link.stl", {})->type, "model/stl");
}

TEST_F(PageFilesTest, OfAMissionAreListedSoThatAPageNeedNotTry) {
  write("page/index.json", "[\"forged\"]");
  EXPECT_EQ(files->file("/mission/index.json", {})->body, R"(["arm.urdf","index.json","scene.json","tour.js"])");
}

TEST_F(PageFilesTest, OfAMissionWithoutThemAreAnEmptyList) {
  EXPECT_EQ(PageFiles({}, folder / "none").file("/mission/index.json", {})->body, "[]");
  EXPECT_EQ(PageFiles({}, {}).file("/mission/index.json", {})->body, "[]");
  EXPECT_FALSE(PageFiles({}, {}).file("/mission/arm.urdf", {}));
  EXPECT_FALSE(PageFiles({}, {}).file("/mission/etc/passwd.txt", {}));
}

TEST_F(PageFilesTest, OfAMissionHaveASceneAlwaysWhichIsNullWhereThereIsNone) {
  for (const PageFiles& none : {PageFiles({}, folder / "none"), PageFiles({}, {})}) {
    const auto scene = none.file("/mission/scene.json", {});
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->body, "null");
    EXPECT_EQ(scene->type, "application/json");
    EXPECT_FALSE(none.file("/mission/meshes/scene.json", {}));
  }
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
  EXPECT_EQ(both.file("/main.js", {})->body, "page");
  EXPECT_EQ(both.file("/mission/main.js", {})->body, "mission");
  EXPECT_FALSE(both.file("/scene.json", {}));
}

[[nodiscard]] std::string header_of(const std::optional<HttpResponse>& response, const std::string& name) {
  if (response)
    for (const auto& [key, value] : response->headers)
      if (key == name) return value;
  return {};
}

TEST_F(PageFilesTest, AreSentCompressedAsTheBrowserTakesThemTheBestFirst) {
  fs::create_directories(folder / "own");
  write("own/main.js", "plain");
  write("own/main.js.gz", "gzip");
  write("own/main.js.br", "brotli");
  write("own/alone.js", "alone");
  const PageFiles own{folder / "own", {}};
  EXPECT_EQ(own.file("/main.js", {.accepts = "gzip, deflate, br", .has = {}})->body, "brotli");
  EXPECT_EQ(own.file("/main.js", {.accepts = "gzip", .has = {}})->body, "gzip");
  EXPECT_EQ(own.file("/main.js", {})->body, "plain");
  EXPECT_EQ(header_of(own.file("/main.js", {.accepts = "br", .has = {}}), "Content-Encoding"), "br");
  EXPECT_EQ(own.file("/main.js", {.accepts = "br", .has = {}})->type, "text/javascript; charset=utf-8");
  const auto alone = own.file("/alone.js", {.accepts = "gzip, br", .has = {}});
  EXPECT_EQ(alone->body, "alone");
  EXPECT_EQ(header_of(alone, "Content-Encoding"), "");
}

TEST_F(PageFilesTest, AreKeptForGoodWhereTheirNameHoldsTheirHashAndAskedForAgainElsewhere) {
  fs::create_directories(folder / "own");
  for (const char* name : {"main-AB12CD34.js", "main.js", "feed-worker.js", "main-ab12cd34.js"})
    write(std::string{"own/"} + name, "x");
  write("page/parts-AB12CD34.js", "x");
  const PageFiles own{folder / "own", folder / "page"};
  EXPECT_EQ(header_of(own.file("/main-AB12CD34.js", {}), "Cache-Control"), "public, max-age=31536000, immutable");
  for (const char* path : {"/main.js", "/feed-worker.js", "/main-ab12cd34.js", "/", "/mission/parts-AB12CD34.js"})
    EXPECT_EQ(header_of(own.file(path, {}), "Cache-Control"), "no-cache") << path;
}

TEST_F(PageFilesTest, AreNotSentAgainToABrowserThatHasThemAsTheyAre) {
  const std::string tag = header_of(files->file("/mission/scene.json", {}), "ETag");
  ASSERT_FALSE(tag.empty());
  const auto again = files->file("/mission/scene.json", {.accepts = {}, .has = "\"other\", " + tag});
  EXPECT_EQ(again->status, 304U);
  EXPECT_EQ(again->body, "");
  write("page/scene.json", "{\"robots\":[]}");
  const auto changed = files->file("/mission/scene.json", {.accepts = {}, .has = tag});
  EXPECT_EQ(changed->status, 200U);
  EXPECT_EQ(changed->body, "{\"robots\":[]}");
}

}  // namespace
}  // namespace hirosco::ground
