// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "robotics/urdf/robot.hpp"

/// Every problem has its code, stands where it is, and does not hide the others.
namespace hirosco::robotics::urdf {
namespace {

using ::testing::HasSubstr;

constexpr const char* body =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";

/// Two links and a joint; each part can be another.
struct Parts {
  std::string robot{R"(name="A")"};
  std::string inside{body};
  std::string joint{R"(name="j" type="revolute")"};
  std::string connection{R"(<parent link="a"/><child link="b"/>)"};
  std::string rest{R"(<limit lower="-1" upper="1" velocity="1" effort="1"/>)"};
  std::string more{};
};
[[nodiscard]] std::string text_of(const Parts& parts) {
  return "<robot " + parts.robot + "><link name=\"a\"/>\n<link name=\"b\">" + parts.inside + "</link>\n<joint " +
         parts.joint + ">" + parts.connection + "\n" + parts.rest + "</joint>\n" + parts.more + "</robot>";
}

struct Case {
  const char* code;
  int line;
  Parts parts;
};

[[nodiscard]] std::vector<Case> errors() {
  const std::string link = R"(<link name="c"/>)";
  const std::string moving = std::string{R"(<link name="c">)"} + body +
                             R"(</link><joint name="k" type="continuous"><parent link="b"/><child link="c"/>)";
  std::string many;
  for (int i = 0; i < 16; ++i) {
    const std::string n = std::to_string(i);
    many += "<link name=\"l" + n + "\">" + body + "</link><joint name=\"j" + n +
            R"(" type="continuous"><parent link="b"/><child link="l)" + n + "\"/></joint>";
  }
  return {
      {"U0002", 5, {.more = "<link>"}},
      {"U0102", 5, {.more = "<lnik name=\"c\"/>"}},
      {"U0102", 2, {.inside = std::string{body} + "<inertail/>"}},
      {"U0103", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1"/><dynamics dampnig="1"/>)"}},
      {"U0104", 1, {.robot = ""}},
      {"U0104", 2, {.inside = R"(<inertial><mass value="1"/></inertial>)"}},
      {"U0104", 3, {.connection = R"(<parent link="a"/>)"}},
      {"U0104", 4, {.rest = R"(<limit lower="-1" upper="1"/>)"}},
      {"U0105", 2, {.inside = std::string{body} + body}},
      {"U0106", 4, {.rest = R"(<limit lower="-1" upper="1 rad" velocity="1" effort="1"/>)"}},
      {"U0106", 4, {.rest = R"(<limit lower="-1" upper="inf" velocity="1" effort="1"/>)"}},
      {"U0106", 4, {.rest = R"(<axis xyz="0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>)"}},
      {"U0106", 4, {.rest = R"(<axis xyz="0 0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>)"}},
      {"U0106", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1e21" effort="1"/>)"}},
      {"U0107", 5, {.robot = R"(name="A" xmlns:xacro="x")", .more = "<xacro:include filename=\"a\"/>"}},
      {"U0107",
       2,
       {.inside =
            R"(<inertial><mass value="${m}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"}},
      {"U0108", 5, {.more = "words"}},
      {"U0109", 3, {.joint = R"(name="" type="continuous")"}},
      {"U0110", 2, {.inside = std::string{body} + "<gravity>0</gravity>"}},
      {"U0201", 5, {.more = R"(<link name="b"/>)"}},
      {"U0201",
       5,
       {.more = std::string{R"(<link name="c">)"} + body +
                R"(</link><joint name="j" type="continuous"><parent link="b"/><child link="c"/></joint>)"}},
      {"U0202", 3, {.connection = R"(<parent link="nobody"/><child link="b"/>)"}},
      {"U0203", 5, {.more = R"(<joint name="k" type="fixed"><parent link="a"/><child link="b"/></joint>)"}},
      {"U0204", 5, {.more = link}},
      {"U0205",
       5,
       {.more =
            R"(<link name="c"/><link name="d"/><joint name="k" type="fixed"><parent link="c"/><child link="d"/></joint>
<joint name="l" type="fixed"><parent link="d"/><child link="c"/></joint>)"}},
      {"U0205", 1, {.more = R"(<joint name="k" type="fixed"><parent link="b"/><child link="a"/></joint>)"}},
      {"U0301", 3, {.joint = R"(name="j" type="floating")"}},
      {"U0301", 3, {.joint = R"(name="j" type="revolut")"}},
      {"U0302", 4, {.rest = R"(<axis xyz="0 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>)"}},
      {"U0303", 3, {.rest = ""}},
      {"U0304", 4, {.rest = R"(<limit lower="1" upper="-1" velocity="1" effort="1"/>)"}},
      {"U0304", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="-1" effort="1"/>)"}},
      {"U0304", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1" acceleration="0"/>)"}},
      {"U0304", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1" deceleration="-2"/>)"}},
      {"U0304", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1" jerk="-1"/>)"}},
      {"U0106", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1" jerk="inf"/>)"}},
      {"U0103", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1" snap="1"/>)"}},
      {"U0305",
       2,
       {.inside =
            R"(<inertial><mass value="-1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"}},
      {"U0306",
       2,
       {.inside =
            R"(<inertial><mass value="1"/><inertia ixx="1" ixy="2" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"}},
      {"U0307", 4, {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1"/><dynamics damping="-1"/>)"}},
      {"U0308", 5, {.more = moving + R"(<mimic joint="nobody"/></joint>)"}},
      {"U0308", 5, {.more = moving + R"(<mimic joint="k"/></joint>)"}},
      {"U0308", 5, {.more = moving + R"(<mimic joint="j" multiplier="0"/></joint>)"}},
      {"U0309", 1, {.joint = R"(name="j" type="fixed")", .rest = ""}},
      {"U0309", 1, {.more = many}},
      {"U0310", 3, {.inside = ""}},
  };
}

[[nodiscard]] std::vector<Case> warnings() {
  return {
      {"U0501", 2, {.inside = std::string{body} + "<contact/>"}},
      {"U0502", 4, {.rest = R"(<axis xyz="0 0 2"/><limit lower="-1" upper="1" velocity="1" effort="1"/>)"}},
      {"U0503",
       5,
       {.more =
            R"(<link name="c"><visual/></link><joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint>)"}},
      {"U0504",
       2,
       {.inside =
            R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="3"/></inertial>)"}},
      {"U0505", 4, {.joint = R"(name="j" type="continuous")"}},
      {"U0506",
       2,
       {.inside =
            R"(<inertial><mass value="0"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"}},
      {"U0508",
       5,
       {.more =
            R"(<link name="c"><inertial><mass value="1e-6"/><inertia ixx="1e-9" ixy="2e-9" ixz="0" iyy="1e-9" iyz="0" izz="1e-9"/></inertial></link>
<joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint>)"}},
      {"U0501",
       4,
       {.rest = R"(<limit lower="-1" upper="1" velocity="1" effort="1"/><dynamics damping="1" K="7000"/>)"}},
      {"U0507", 4, {.rest = R"(<limit upper="1" velocity="1" effort="1"/>)"}},
      {"U0509", 4, {.rest = R"(<limit lower="-170" upper="90" velocity="1" effort="1"/>)"}},
      {"U0509",
       4,
       {.joint = R"(name="j" type="prismatic")", .rest = R"(<limit lower="0" upper="400" velocity="1" effort="1"/>)"}},
  };
}

TEST(UrdfErrors, ARobotWithoutAnyIsTaken) {
  const auto reading = read("a.urdf", text_of({}));
  EXPECT_TRUE(reading.value);
  EXPECT_TRUE(reading.warnings.empty());
}

TEST(UrdfErrors, EachIsTheOnlyOneAndStandsInItsLine) {
  for (const Case& each : errors()) {
    const auto reading = read("a.urdf", text_of(each.parts));
    EXPECT_FALSE(reading.value) << text_of(each.parts);
    ASSERT_FALSE(reading.problems.empty()) << each.code;
    EXPECT_EQ(reading.problems.front().code, each.code) << text_of(each.parts) << reading.problems.front().message;
    EXPECT_EQ(reading.problems.front().at.line, each.line) << text_of(each.parts);
    EXPECT_FALSE(reading.problems.front().hint.empty()) << each.code;
    for (const auto& problem : reading.problems) EXPECT_EQ(problem.code, each.code) << text_of(each.parts);
  }
}

TEST(UrdfErrors, WarningsKeepNoRobotFromBeingTaken) {
  for (const Case& each : warnings()) {
    const auto reading = read("a.urdf", text_of(each.parts));
    EXPECT_TRUE(reading.value) << each.code;
    ASSERT_EQ(reading.warnings.size(), 1U) << text_of(each.parts);
    EXPECT_EQ(reading.warnings.front().code, each.code) << reading.warnings.front().message;
    EXPECT_EQ(reading.warnings.front().at.line, each.line) << each.code;
  }
}

TEST(UrdfErrors, AllAreToldAtOnceInTheOrderOfTheFile) {
  const auto reading = read(
      "a.urdf",
      text_of(
          {.inside =
               R"(<inertial><mass value="heavy"/><inertia ixx="1" ixy="0" ixz="0" iyy="-1" iyz="0" izz="1"/></inertial>)",
           .joint = R"(name="j" type="prismatic" colour="red")",
           .connection = R"(<parent link="a"/><child link="c"/>)",
           .rest = R"(<axis xyz="0 0 0"/>)",
           .more = "<link name=\"a\"/>"}));
  std::vector<std::string> codes;
  for (const auto& problem : reading.problems) codes.push_back(problem.code);
  EXPECT_THAT(codes, ::testing::ElementsAre("U0106", "U0303", "U0103", "U0202", "U0302", "U0201"));
}

TEST(UrdfErrors, AFileOfAnotherKindIsSaidToBeOne) {
  const auto reading = read("a.xml", "<mujoco/>");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "U0101");
  EXPECT_THAT(reading.problems[0].hint, HasSubstr("convert"));
}

TEST(UrdfErrors, EntitiesAreNotTaken) {
  const auto reading = read("a.xml", "<!DOCTYPE robot [<!ENTITY a \"b\">]>\n<robot name=\"&a;\"/>");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "U0003");
}

TEST(UrdfErrors, TheRestOfATemplateIsSaidToBeOne) {
  const auto reading = read("a.urdf", R"(<robot name="a" xmlns:xacro="x"/>)");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "U0204");
  EXPECT_THAT(reading.problems[0].hint, HasSubstr("expand"));
}

TEST(UrdfErrors, AreBoundedHoweverBadAFileIs) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "<wrong/>";
  EXPECT_EQ(read("a.urdf", "<robot name=\"a\">" + text + "</robot>").problems.size(), 200U);
}

std::set<std::string> codes_in(const std::string& file, const std::regex& form) {
  std::ifstream stream{std::string{HIROSCO_SOURCE_DIR} + "/" + file};
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  std::set<std::string> codes;
  for (std::sregex_iterator it{text.begin(), text.end(), form}, end; it != end; ++it) codes.insert((*it)[1]);
  return codes;
}

TEST(UrdfErrors, AreListedInTheDocumentationAndOnlyThose) {
  auto emitted = codes_in("robotics/urdf/read.cpp", std::regex{"\"(U[0-9]{4})\""});
  emitted.merge(codes_in("robotics/urdf/connect.cpp", std::regex{"\"(U[0-9]{4})\""}));
  EXPECT_GT(emitted.size(), 30U);
  EXPECT_EQ(emitted, codes_in("docs/urdf-errors.md", std::regex{"\\| (U0[0-5][0-9]{2}) \\|"}))
      << "the others are of who wants more of a robot";
  std::set<std::string> tried{"U0001", "U0003", "U0004", "U0101"};
  for (const Case& each : errors()) tried.insert(each.code);
  for (const Case& each : warnings()) tried.insert(each.code);
  EXPECT_EQ(emitted, tried);
}

}  // namespace
}  // namespace hirosco::robotics::urdf
