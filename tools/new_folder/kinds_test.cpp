// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/kinds.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <sstream>

namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

TEST(NewName, IsWrittenInThreeWaysWhicheverOneIsGiven) {
  for (const char* text : {"heat_pipe", "HEAT_PIPE", "HeatPipe", "heat-pipe", "heatPipe"}) {
    const auto name = new_name(text);
    ASSERT_TRUE(name) << text << ": " << name.error();
    EXPECT_EQ(name->lower, "heat_pipe") << text;
    EXPECT_EQ(name->upper, "HEAT_PIPE") << text;
    EXPECT_EQ(name->camel, "HeatPipe") << text;
  }
  EXPECT_EQ(new_name("lamp2")->camel, "Lamp2");
  EXPECT_EQ(new_name("LAMP")->lower, "lamp");
}

TEST(NewName, RefusesWhatIsNoNameOrIsTaken) {
  for (const char* text : {"", "2lamps", "_lamp", "lamp_", "a__b", "a b", "../lamp", "lamp.xml", "l\xC3\xA4mp", "-x",
                           "a_name_that_is_much_too_long_for_it"})
    EXPECT_FALSE(new_name(text)) << text;
  for (const char* text : {"supervisor", "SUPERVISOR", "Ground", "test", "all"}) EXPECT_FALSE(new_name(text)) << text;
}

TEST(NewFolder, PutsTheNameInAndTheLicenceOfThisRepositoryOut) {
  const auto name = new_name("heat_pipe").value();
  EXPECT_EQ(named_text("// SP"
                       "DX-License-Identifier: X\n#include \"newpart.hpp\"\nNewPart NEWPART\n",
                       name),
            "#include \"heat_pipe.hpp\"\nHeatPipe HEAT_PIPE\n");
  EXPECT_EQ(named_text("newpart_test.cpp", name), "heat_pipe_test.cpp");
  EXPECT_EQ(named_text("<!-- SP"
                       "DX-X\n\nno end of line newpart",
                       name),
            "no end of line heat_pipe");
  EXPECT_EQ(named_text("", name), "");
}

class Made : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "hirosco-new-test-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Made, EveryKindHasATemplateAndNothingOfItsWordsIsLeft) {
  for (const NewKind& kind : new_kinds()) {
    const fs::path target = folder_ / kind.name;
    const auto made =
        make_folder(fs::path{HIROSCO_SOURCE_DIR} / "templates" / kind.name, target, new_name("pipe").value());
    ASSERT_TRUE(made) << made.error();
    EXPECT_TRUE(fs::exists(target / "mission.xml") && fs::exists(target / "CMakeLists.txt") &&
                fs::exists(target / "README.md"))
        << kind.name;
    EXPECT_EQ(kind.compiles, fs::exists(target / "pipe.cpp"));
    EXPECT_EQ(kind.of_urdf,
              fs::exists(referred(fs::path{HIROSCO_SOURCE_DIR} / "templates" / kind.name, "page/newpart.urdf")))
        << "where none is named";
    for (const fs::path& file : *made) {
      EXPECT_NE(file.extension(), reference_ending) << file;
      std::stringstream text;
      text << std::ifstream{file}.rdbuf();
      for (const char* word : {"newpart", "NEWPART", "NewPart",
                               "SP"
                               "DX"})
        EXPECT_EQ((file.string() + text.str()).find(word), std::string::npos) << file << ": " << word;
      EXPECT_NE(text.str(), "") << file;
    }
  }
}

TEST(NewFolder, OfEachKindHasAMissionWhoseInitialModePermitsToReadADescriptorAgain) {
  for (const NewKind& kind : new_kinds()) {
    std::stringstream text;
    text << std::ifstream{fs::path{HIROSCO_SOURCE_DIR} / "templates" / kind.name / "mission.xml"}.rdbuf();
    const std::string mission = text.str();
    const auto begin = mission.find("<Mode name=\"commissioning\">");
    ASSERT_NE(begin, std::string::npos) << kind.name;
    EXPECT_NE(mission.find("<Modes initial=\"commissioning\""), std::string::npos) << kind.name;
    const std::string initial = mission.substr(begin, mission.find("</Mode>", begin) - begin);
    EXPECT_NE(initial.find(" REREAD "), std::string::npos) << kind.name;
  }
}

TEST_F(Made, NothingIsCalledAsWhatCarriesTheGroundLinkOfItsTemplate) {
  std::ofstream{folder_ / "mission.xml"} << R"(<Ground subsystem="RADIO_LINK" telemetry="127.0.0.1:10015"/>)";
  EXPECT_TRUE(carries_ground_link(folder_, new_name("radio-link").value()));
  for (const char* free : {"radio", "link", "pipe"}) EXPECT_FALSE(carries_ground_link(folder_, new_name(free).value()));
  for (const NewKind& kind : new_kinds()) {
    const fs::path from = fs::path{HIROSCO_SOURCE_DIR} / "templates" / kind.name;
    std::stringstream text;
    text << std::ifstream{from / "mission.xml"}.rdbuf();
    const std::string mission = text.str();
    const std::string_view before = "<Ground subsystem=\"";
    ASSERT_NE(mission.find(before), std::string::npos) << kind.name;
    const auto begin = mission.find(before) + before.size();
    const std::string carrier = mission.substr(begin, mission.find('"', begin) - begin);
    EXPECT_TRUE(carries_ground_link(from, new_name(carrier).value())) << kind.name << ": " << carrier;
  }
}

TEST_F(Made, WordsOfItsOwnAreReplacedAndFilesOfItsOwnAreAsTheyAre) {
  fs::create_directory(folder_ / "template");
  std::ofstream{folder_ / "template/newpart.txt"} << "newpart has @joints@ joints";
  const NewParts parts{.words = {{"@joints@", "3"}}, .files = {{"page/newpart.urdf", "newpart @joints@"}}};
  const auto made = make_folder(folder_ / "template", folder_ / "made", new_name("pipe").value(), parts);
  ASSERT_TRUE(made) << made.error();
  std::string text;
  std::getline(std::ifstream{folder_ / "made/pipe.txt"}, text);
  EXPECT_EQ(text, "pipe has 3 joints");
  std::getline(std::ifstream{folder_ / "made/page/pipe.urdf"}, text);
  EXPECT_EQ(text, "newpart @joints@");
}

TEST_F(Made, WhatIsThereIsLeftAsItIs) {
  const fs::path from = fs::path{HIROSCO_SOURCE_DIR} / "templates/mission";
  fs::create_symlink("nowhere", folder_ / "link");
  std::ofstream{folder_ / "file"} << "mine";
  for (const char* taken : {"", "link", "file"}) {
    const auto made = make_folder(from, folder_ / taken, new_name("pipe").value());
    ASSERT_FALSE(made) << taken;
    EXPECT_NE(made.error().find("is there already"), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(folder_ / "mission.xml"));
}

TEST_F(Made, WhereThereIsNoTemplateNothingIsLeft) {
  EXPECT_FALSE(make_folder(folder_ / "no-template", folder_ / "pipe", new_name("pipe").value()));
  EXPECT_FALSE(fs::exists(folder_ / "pipe"));
}

}  // namespace
}  // namespace hirosco::tools
