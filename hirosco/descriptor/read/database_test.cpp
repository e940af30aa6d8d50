// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hirosco/descriptor/testing.hpp"

/// What a mission says of its log: bounds of files bound no server.
namespace hirosco::descriptor {
namespace {

/// Of the good mission whose <Database> says this; whether PostgreSQL is built in is no matter here.
std::vector<Diagnostic> warnings_of_log(const std::string& said) {
  const std::string text = testing::changed(R"(strategy="sqlite" path="log/orbiter.db")", said);
  auto warnings = read_mission(testing::data / "mission.xml", testing::overlay({{"mission.xml", text}})).warnings;
  std::erase_if(warnings, [](const Diagnostic& each) { return each.code != "E0353"; });
  return warnings;
}

TEST(LogBounds, OfALogInAServerAreToldEachToBoundFilesOnly) {
  const std::string in_server = R"(strategy="postgresql" server="service=hirosco" )";
  const auto told = warnings_of_log(in_server + R"(rotate_MB="1" rotate_h="24" keep_MB="2")");
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0].message, "'rotate_MB' bounds files, and this log is in a server");
  EXPECT_EQ(told[0].grade, Grade::Warning);
  EXPECT_NE(told[0].hint.find("SET_DATABASE"), std::string::npos) << told[0].hint;
  EXPECT_EQ(told[1].message, "'rotate_h' bounds files, and this log is in a server");
  EXPECT_EQ(told[2].message, "'keep_MB' bounds files, and this log is in a server");
  EXPECT_TRUE(warnings_of_log(in_server).empty());
}

TEST(LogBounds, OfALogInFilesAreInForceAlsoWhereAServerIsNamed) {
  EXPECT_TRUE(warnings_of_log(R"(strategy="ascii" server="service=hirosco" rotate_MB="1" keep_MB="2")").empty());
  EXPECT_TRUE(warnings_of_log(R"(rotate_h="24")").empty());
}

}  // namespace
}  // namespace hirosco::descriptor
