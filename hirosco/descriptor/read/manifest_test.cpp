// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hirosco/descriptor/testing.hpp"

/// Which executables a mission may start (docs/adr/0089), as it is read.
namespace hirosco::descriptor {
namespace {

using namespace testing;
using ::testing::HasSubstr;

const std::string digest_a(64, 'a');
const std::string digest_b = "0123456789ABCDEF0123456789abcdef0123456789abcdef0123456789abcdef";

Reading<Manifest> read_lines(const std::string& text) { return read_manifest("manifest.sha256", text_source(text)); }

std::string with_element(const std::string& element) { return changed("<Power", element + "\n  <Power"); }

Reading<Mission> read_listed(const std::string& element, const std::string& lines) {
  return read_mission(data / "mission.xml",
                      overlay({{"mission.xml", with_element(element)}, {"manifest.sha256", lines}}));
}

TEST(ManifestTest, IsReadAsTheOperatorsToolWritesIt) {
  const auto reading =
      read_lines("# of the second build\n\n" + digest_a + "  arm\n" + digest_b + " *hirosco-hand@1.2\n");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(""));
  ASSERT_EQ(reading.value->listed.size(), 2U);
  EXPECT_EQ(reading.value->find("arm")->digest, digest_a);
  EXPECT_EQ(reading.value->find("hirosco-hand@1.2")->digest, "0123456789abcdef" + digest_b.substr(16))
      << "in small letters";
  EXPECT_EQ(reading.value->find("hirosco-hand"), nullptr) << "a version of it is listed, not it";
  EXPECT_TRUE(read_lines("").value) << "nothing may be started";
}

TEST(ManifestTest, ALineOfAnotherFormIsReportedWhereItIs) {
  for (const std::string& line :
       {std::string{"arm"}, digest_a + " arm", digest_a + "  ", digest_a.substr(1) + "  arm",
        "g" + digest_a.substr(1) + "  arm", digest_a + "\tarm", "SHA256 (arm) = " + digest_a, "\\" + digest_a + "  arm",
        digest_a + "  bin/arm", digest_a + "  ../arm", digest_a + "  /bin/arm", digest_a + "  arm@",
        digest_a + "  arm@a@b", digest_a + "  @2", digest_a + "  arm@" + std::string(25, '1'), digest_a + "  arm\r",
        digest_a + "  an arm"}) {
    const auto reading = read_lines("#\n" + line + "\n");
    ASSERT_EQ(reading.problems.size(), 1U) << line;
    EXPECT_EQ(reading.problems[0].code, "E0361") << line;
    EXPECT_EQ(reading.problems[0].at.line, 2) << line;
    EXPECT_FALSE(reading.value) << line;
  }
}

TEST(ManifestTest, TwoLinesForOneNameAreReported) {
  const auto reading = read_lines(digest_a + "  arm\n" + digest_b + "  arm\n");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "E0362");
  EXPECT_EQ(reading.problems[0].at, (Location{2, 67}));
}

TEST(ManifestTest, HasAnEnd) {
  std::string lines;
  for (int i = 0; i < 1001; ++i) lines += digest_a + "  arm" + std::to_string(i) + "\n";
  EXPECT_EQ(read_lines(lines).problems.at(0).code, "E0361");
}

TEST(ManifestTest, IsNamedByItsMission) {
  const auto reading = read_listed(R"(<Manifest path="manifest.sha256"/>)", digest_a + "  hirosco-flywheel\n");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.value->manifest.value().file, data / "manifest.sha256");
  EXPECT_NE(reading.value->manifest->find("hirosco-flywheel"), nullptr);
  EXPECT_FALSE(read_listed("", "").value.value().manifest);
}

TEST(ManifestTest, ThatCannotBeReadIsNotTakenForNone) {
  const auto missing = read_mission(data / "mission.xml",
                                    overlay({{"mission.xml", with_element(R"(<Manifest path="manifest.sha256"/>)")}}));
  ASSERT_EQ(missing.problems.size(), 1U);
  EXPECT_EQ(missing.problems[0].code, "E0360");
  EXPECT_THAT(missing.problems[0].hint, HasSubstr("hirosco manifest"));
  EXPECT_EQ(read_listed(R"(<Manifest path="manifest.txt"/>)", "").problems.at(0).code, "E0360");
  EXPECT_EQ(read_listed(R"(<Manifest path="../manifest.sha256"/>)", "").problems.at(0).code, "E0314");
  EXPECT_EQ(read_listed(R"(<Manifest/>)", "").problems.at(0).code, "E0105");
  const auto broken = read_listed(R"(<Manifest path="manifest.sha256"/>)", "nonsense\n");
  ASSERT_EQ(broken.problems.size(), 1U);
  EXPECT_EQ(broken.problems[0].code, "E0361");
  EXPECT_EQ(broken.problems[0].file, data / "manifest.sha256");
}

Reading<Mission> not_started(const std::string& name) {
  const std::string begin = "<Subsystem executable=\"hirosco-" + name + "\"";
  return read_mission(data / "mission.xml", overlay({{"mission.xml", changed(begin, begin + " start=\"no\"")}}));
}

TEST(ManifestTest, WhoIsNotStartedWithTheFlightIsNeitherItsFirstModeNorItsGroundLink) {
  EXPECT_EQ(not_started("flywheel").problems.at(0).code, "E0330");
  EXPECT_THAT(not_started("flywheel").problems.at(0).message,
              HasSubstr("FLYWHEEL, which is not started with the flight"));
  EXPECT_EQ(not_started("groundstation").problems.at(0).code, "E0363");
  const auto mission = read_listed("", "").value.value();
  EXPECT_TRUE(mission.subsystems[0].starts);
}

}  // namespace
}  // namespace hirosco::descriptor
