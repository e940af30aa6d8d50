// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/robot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "robotics/dynamics/dynamics.hpp"

/// What an arm needs besides what the reader of URDF files wants, each refusal with its place.
namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A rod of 1 m and 2 kg that lies along x at 0 and turns about y; and what else there is.
struct Parts {
  std::string inertia{R"(<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.17" iyz="0" izz="0.17"/>)"};
  std::string type{"revolute"};
  std::string limit{R"(<limit lower="-1" upper="2" velocity="3" effort="60"/>)"};
  std::string more{};
};
[[nodiscard]] std::string text_of(const Parts& parts = {}) {
  return "<robot name=\"rod\">\n<link name=\"base\"/>\n<link name=\"rod\"><inertial><origin xyz=\"0.5 0 0\"/><mass "
         "value=\"2\"/>\n" +
         parts.inertia + "</inertial></link>\n<joint name=\"swing\" type=\"" + parts.type +
         "\"><parent link=\"base\"/><child link=\"rod\"/><axis xyz=\"0 1 0\"/>\n" + parts.limit +
         "</joint>\n<joint name=\"end\" type=\"fixed\"><origin xyz=\"1 0 0\"/><parent link=\"rod\"/><child "
         "link=\"tool\"/></joint><link name=\"tool\"/>\n" +
         parts.more + "</robot>";
}
[[nodiscard]] JudgedRobot judged(const std::string& text, const std::string& tip = "",
                                 const std::string& gripper = "") {
  return judge_robot("rod.urdf", [&](const fs::path&) -> Result<std::string> { return text; }, tip, gripper);
}
[[nodiscard]] std::string in_repository(const char* file) {
  return descriptor::file_system()(fs::path{HIROSCO_SOURCE_DIR} / file).value();
}

TEST(NewRobot, BeginsWhereItsDrivesHoldItAndGoesWhereTheyDoToo) {
  const auto rod = judged(text_of());
  ASSERT_TRUE(rod.robot);
  EXPECT_THAT(rod.problems, testing::IsEmpty());
  EXPECT_THAT(rod.warnings, testing::IsEmpty());
  EXPECT_EQ(rod.robot->tip, "tool");
  EXPECT_THAT(rod.robot->posture, ElementsAre(0.0)) << "2 kg at 0.5 m take 9.81 N m of 60";
  EXPECT_THAT(rod.robot->goal, ElementsAre(0.3));
  EXPECT_NEAR(rod.robot->reach_m, 1, 1e-9);
  EXPECT_EQ(rod.robot->acceleration, 4) << "45 - 9.81 N m are left for 0.67 kg m2";
}

TEST(NewRobot, GoesToWhereItsToolCanGoStraightOn) {
  int arms = 0;
  for (const auto& entry : fs::recursive_directory_iterator{fs::path{HIROSCO_SOURCE_DIR} / "subsystems"}) {
    if (entry.path().extension() != ".urdf") continue;
    const auto made = judged(descriptor::file_system()(entry.path()).value());
    if (!made.robot || made.robot->goal.size() != 6) continue;
    ++arms;
    robotics::Dynamics dynamics{made.robot->model, robotics::Base::Fixed};
    robotics::State state;
    state.q = Eigen::Map<const Eigen::VectorXd>(made.robot->goal.data(), 6);
    state.qd = robotics::JointVector::Zero(6);
    dynamics.update(state);
    robotics::Jacobian jacobian;
    dynamics.jacobian(*made.robot->model.find_frame(made.robot->tip), jacobian);
    robotics::Matrix6 square;
    square.noalias() = jacobian.lazyProduct(jacobian.transpose());
    EXPECT_GT(square.determinant(), 1e-5) << entry.path() << ": a stretched arm has 0";
  }
  EXPECT_GT(arms, 0) << "one with six goals";
}

TEST(NewRobot, SpeedsUpAsSlowlyAsItsDrivesAreWeak) {
  const auto weak = judged(text_of({.limit = R"(<limit lower="-1" upper="2" velocity="3" effort="15"/>)"}));
  ASSERT_TRUE(weak.robot);
  // Lying: (0.75 * 15 - 9.81) / (0.17 + 2 * 0.25), in tenths.
  EXPECT_NEAR(weak.robot->acceleration, 2.1, 1e-9);
}

TEST(NewRobot, SpeedsUpNoFasterThanItsFileSays) {
  const auto with = [](const std::string& limits, const char* effort = "60") {
    return judged(text_of(
        {.limit = fmt::format(R"(<limit lower="-1" upper="2" velocity="3" effort="{}" {}/>)", effort, limits)}));
  };
  const auto made = [&](const std::string& limits, const char* effort = "60") {
    const auto found = with(limits, effort);
    EXPECT_TRUE(found.robot) << limits;
    if (!found.robot) return std::pair{0.0, 0.0};
    const auto words = parts_of(*found.robot, new_name("rod").value()).words;
    return std::pair{std::stod(words.at("@acceleration@")), std::stod(words.at("@jerk@"))};
  };
  EXPECT_EQ(made(""), (std::pair{4.0, 40.0}));
  EXPECT_EQ(made(R"(acceleration="3" jerk="4")"), (std::pair{3.0, 4.0}));
  EXPECT_EQ(made(R"(acceleration="3" deceleration="2.55")"), (std::pair{2.5, 25.0}));
  EXPECT_EQ(made(R"(jerk="1000000")"), (std::pair{4.0, 1000.0})) << "as much as its descriptor has room for";
  EXPECT_EQ(made(R"(acceleration="50")", "6000"), (std::pair{20.0, 200.0}));
  EXPECT_EQ(made(R"(acceleration="50")", "15").first, 2.1) << "its drive can give no more";
  EXPECT_EQ(made(R"(acceleration="0.1" jerk="1")"), (std::pair{0.1, 1.0}));
  for (const char* slow : {R"(acceleration="0.09")", R"(jerk="0.9")"}) {
    const auto found = with(slow);
    ASSERT_EQ(found.problems.size(), 1u) << slow;
    EXPECT_EQ(found.problems[0].code, "U0612");
    EXPECT_EQ(found.problems[0].at.line, 6);
  }
}

TEST(NewRobot, LooksForAPostureThatItsDrivesHoldWhereZeroIsTooHeavy) {
  const auto heavy = judged(text_of({.limit = R"(<limit lower="-1.5" upper="2" velocity="3" effort="12"/>)"}));
  ASSERT_TRUE(heavy.robot);
  EXPECT_LE(9.81 * std::cos(heavy.robot->posture[0]), 0.5 * 12 + 1e-3);
  ASSERT_EQ(heavy.warnings.size(), 1u) << "where it lies it is too heavy";
  EXPECT_EQ(heavy.warnings[0].code, "U0606");
}

TEST(NewRobot, StandsWithinARangeThatZeroIsNotIn) {
  const auto bent = judged(text_of({.limit = R"(<limit lower="0.4" upper="2.4" velocity="3" effort="60"/>)"}));
  ASSERT_TRUE(bent.robot);
  EXPECT_THAT(bent.robot->posture, ElementsAre(0.5));
}

TEST(NewRobot, IsRefusedWithPlaceReasonAndWhatToDo) {
  const std::string second =
      R"(<joint name="side" type="fixed"><parent link="rod"/><child link="other"/></joint><link name="other"/>)";
  struct Case {
    const char* code;
    int line;
    int column;
    const char* told;
    std::string text;
    std::string tip{};
  };
  const std::vector<Case> cases{
      {"U0601", 6, 1, "joint 'swing' has no effort above 0",
       text_of({.limit = R"(<limit lower="-1" upper="2" velocity="3" effort="0"/>)"})},
      {"U0601", 6, 1, "joint 'swing' has no velocity above 0",
       text_of({.limit = R"(<limit lower="-1" upper="2" velocity="0" effort="5"/>)"})},
      {"U0601", 5, 1, "joint 'swing' has no velocity above 0", text_of({.type = "continuous", .limit = ""})},
      {"U0602", 6, 1, "the range of joint 'swing' is from 0 to 0",
       text_of({.limit = R"(<limit velocity="3" effort="60"/>)"})},
      {"U0603", 1, 1, "the robot has 2 ends that move", text_of({.more = second})},
      {"U0603", 1, 1, "the robot has no link 'tol'", text_of(), "tol"},
      {"U0603", 2, 1, "no joint moves link 'base'", text_of(), "base"},
      {"U0604", 4, 1, "no body has the inertia of link 'rod'",
       text_of({.inertia = R"(<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.17" iyz="0" izz="0.3"/>)"})},
      {"U0604", 4, 1, "principal moments 0, 0.17 and 0.17",
       text_of({.inertia = R"(<inertia ixx="0" ixy="0" ixz="0" iyy="0.17" iyz="0" izz="0.17"/>)"})},
      {"U0607", 4, 1, "joint 'swing' moves link 'rod', which has no mass or no inertia about some axis",
       text_of({.inertia = R"(<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>)"})},
      {"U0605", 6, 1, "takes 9.", text_of({.limit = R"(<limit lower="-0.2" upper="0.2" velocity="3" effort="10"/>)"})},
      {"U0605", 6, 1, "of the effort 5 of joint 'swing'",
       text_of({.limit = R"(<limit lower="-1.5" upper="2" velocity="3" effort="5"/><dynamics friction="4"/>)"})},
      {"U0611", 9, 1, "the name of link 'left hand' has white space",
       text_of({.more = R"(<joint name="side" type="fixed"><parent link="rod"/><child link="left hand"/></joint>
<link name="left hand"/>)"}),
       "left hand"},
      // Of the reader, as it says it.
      {"U0303", 5, 1, "joint 'swing' has no <limit>", text_of({.limit = ""})},
      {"U0102", 8, 1, "lnik", text_of({.more = "<lnik/>"})},
  };
  for (const Case& each : cases) {
    const auto found = judged(each.text, each.tip);
    EXPECT_FALSE(found.robot) << each.code;
    ASSERT_FALSE(found.problems.empty()) << each.code << " " << each.told;
    const auto& problem = found.problems.front();
    EXPECT_EQ(problem.code, each.code) << problem.message;
    EXPECT_EQ(problem.at.line, each.line) << problem.message;
    EXPECT_EQ(problem.at.column, each.column) << problem.message;
    EXPECT_THAT(problem.message, HasSubstr(each.told));
    EXPECT_EQ(problem.file, "rod.urdf");
    EXPECT_NE(problem.hint, "") << "what to do about " << each.code;
    EXPECT_EQ(problem.grade, descriptor::Grade::Error);
  }
  EXPECT_TRUE(judged(text_of({.more = second}), "other").robot) << "once the tool is named";
}

TEST(NewRobot, TakesALinkThatIsNoBodyWhereItIsOneWithWhatItIsFixedTo) {
  const auto with = [](const char* inertia) {
    return judged(text_of({.more = fmt::format(
                               R"(<joint name="screw" type="fixed"><parent link="rod"/><child link="antenna"/></joint>
<link name="antenna"><inertial><mass value="0.001"/>{}</inertial></link>)",
                               inertia)}),
                  "tool");
  };
  const auto light = with(R"(<inertia ixx="-1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/>)");
  EXPECT_TRUE(light.robot);
  ASSERT_EQ(light.warnings.size(), 1u);
  EXPECT_EQ(light.warnings.front().code, "U0508");
  const auto heavy = with(R"(<inertia ixx="9" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/>)");
  ASSERT_EQ(heavy.problems.size(), 1u);
  EXPECT_THAT(heavy.problems.front().message, HasSubstr("no body has the inertia of link 'antenna'"));
  EXPECT_TRUE(heavy.warnings.empty()) << "said once";
}

/// A shoulder of two axes that meet, and whatever is between them; then a forearm.
[[nodiscard]] std::string shoulder(const char* between, const char* at_end = "") {
  return fmt::format(R"(<robot name="shoulder"><link name="base"/><link name="cross">{}</link>
<joint name="yaw" type="revolute"><parent link="base"/><child link="cross"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="60"/></joint>
<joint name="pitch" type="revolute"><parent link="cross"/><child link="arm"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="60"/></joint>
<link name="arm"><inertial><origin xyz="0.3 0 0"/><mass value="2"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>{}</robot>)",
                     between, at_end);
}

TEST(NewRobot, TakesALinkOfNothingBetweenTwoJoints) {
  constexpr const char* point =
      R"(<inertial><mass value="0.1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>)";
  for (const char* cross : {"", point}) {
    const auto found = judged(shoulder(cross));
    ASSERT_TRUE(found.robot) << found.problems.front().message;
    EXPECT_EQ(found.robot->model.joint_count(), 2);
  }
  const auto at_end = judged(shoulder("", R"(
<joint name="roll" type="revolute"><parent link="arm"/><child link="hand"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="60"/></joint>
<link name="hand"><inertial><mass value="0.1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>)"));
  ASSERT_EQ(at_end.problems.size(), 1u) << "what carries nothing has to be a body";
  EXPECT_EQ(at_end.problems[0].code, "U0607");
  EXPECT_THAT(at_end.problems[0].message, HasSubstr("joint 'roll' moves link 'hand'"));
  EXPECT_THAT(at_end.problems[0].hint, HasSubstr("--tip LINK --chain: arm (2 joints)"));
  const auto half = judged(shoulder(
      R"(<inertial><mass value="0.1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>)"));
  ASSERT_FALSE(half.problems.empty()) << "a moment about some axes is an error in the file, wherever it is";
  EXPECT_EQ(half.problems[0].code, "U0604");
}

TEST(NewRobot, ProposesAToolThatNearlyAllJointsMove) {
  const auto part = [](const char* name, const char* parent, const char* type) {
    return fmt::format(
        R"(<link name="{0}"><inertial><mass value="0.1"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
<joint name="to_{0}" type="{2}"><parent link="{1}"/><child link="{0}"/><axis xyz="0 1 0"/><limit lower="0" upper="1" velocity="1" effort="60"/></joint>)",
        name, parent, type);
  };
  const auto found = judged("<robot name=\"mobile\"><link name=\"base\"/>" + part("wheel", "base", "revolute") +
                            part("shoulder", "base", "revolute") + part("elbow", "shoulder", "revolute") +
                            part("wrist", "elbow", "revolute") + part("flange", "wrist", "fixed") +
                            part("finger", "wrist", "prismatic") + "</robot>");
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_EQ(found.problems[0].code, "U0603");
  EXPECT_THAT(found.problems[0].hint, HasSubstr("--tip flange; ends that move are: wheel, flange, finger"));
}

TEST(NewRobot, ItsReadmeGivesEachNumberItsOwnUnitAndALineForAStraightMotion) {
  const std::string page = in_repository("templates/robot/README.md");
  EXPECT_THAT(page, HasSubstr("@acceleration@ @acceleration_unit@ and @jerk@ @jerk_unit@"));
  EXPECT_THAT(page, HasSubstr("hirosco tc newpart MOVE_L X,Y,Z W,QX,QY,QZ 0.1 0.5"));
}

TEST(NewRobot, EveryCodeIsExplained) {
  const std::string page = in_repository("docs/urdf-errors.md");
  for (const char* code : {"U0601", "U0602", "U0603", "U0604", "U0605", "U0606", "U0607", "U0608", "U0609", "U0610",
                           "U0611", "U0612", "U0706", "U0707", "U0708"})
    EXPECT_THAT(page, HasSubstr(std::string{"| "} + code + " |"));
}

TEST(NewRobot, ItsSceneNamesItsJointsAndWhatLeadsThem) {
  const auto name = new_name("MyRod").value();
  const auto parts = parts_of(*judged(text_of()).robot, name);
  ASSERT_EQ(parts.files.size(), 2u);
  EXPECT_EQ(parts.files[0], (std::pair<std::string, std::string>{"page/newpart.urdf", text_of()})) << "octet by octet";
  EXPECT_EQ(parts.files[1].first, "page/scene.json");
  const auto scene = nlohmann::json::parse(parts.files[1].second);
  const auto& robot = scene.at("robots").at(0);
  EXPECT_EQ(robot.at("urdf"), "my_rod.urdf");
  EXPECT_EQ(robot.at("joints").at("swing"), "MY_ROD.CUR_VALUES.POSITION") << "one alone is no array";
  EXPECT_EQ(robot.at("names").at("swing"), "1 swing");
  EXPECT_EQ(robot.at("goal").at("joints").at("swing"), "GOAL");
  EXPECT_EQ(robot.at("jog").at("joints").at("swing"), "VELOCITY");
  EXPECT_EQ(robot.at("tip"), "tool");
  EXPECT_EQ(scene.at("plots").size(), 2u);
}

TEST(NewRobot, NamesOfAPictureLeaveOutWhatAllBeginWith) {
  std::string text =
      text_of({.more = R"(<joint name="left_arm_wrist" type="continuous"><parent link="rod"/><child link="hand"/>
<limit velocity="1" effort="30"/></joint><link name="hand"><inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>)"});
  text.replace(text.find("\"swing\""), 7, "\"left_arm_swing\"");
  const auto parts = parts_of(*judged(text, "hand").robot, new_name("rod").value());
  const auto shown = nlohmann::json::parse(parts.files[1].second).at("robots").at(0);
  EXPECT_EQ(shown.at("names").at("left_arm_swing"), "1 swing");
  EXPECT_EQ(shown.at("names").at("left_arm_wrist"), "2 wrist");
  EXPECT_EQ(shown.at("joints").at("left_arm_wrist"), "ROD.CUR_VALUES.POSITION[1]");
  EXPECT_EQ(shown.at("goal").at("joints").at("left_arm_wrist"), "GOAL[1]");
  EXPECT_THAT(parts.words.at("@joint_names@"), HasSubstr(">left_arm_wrist<")) << "in events it has its whole name";
  // Numbers alone would stand beside the places.
  for (const auto& [old, now] : {std::pair{"left_arm_swing", "left_arm_1"}, std::pair{"left_arm_wrist", "left_arm_2"}})
    text.replace(text.find(old), std::string_view{old}.size(), now);
  const auto numbered = parts_of(*judged(text, "hand").robot, new_name("rod").value());
  const auto names = nlohmann::json::parse(numbered.files[1].second).at("robots").at(0).at("names");
  EXPECT_EQ(names.at("left_arm_1"), "1 arm_1");
  EXPECT_EQ(names.at("left_arm_2"), "2 arm_2");
}

TEST(NewRobot, SaysBothUnitsWhereSomeJointsSlide) {
  const std::string slide =
      R"(<joint name="slide" type="prismatic"><parent link="rod"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.2" velocity="1" effort="30"/></joint><link name="cart"><inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>)";
  const auto name = new_name("both").value();
  const auto words = parts_of(*judged(text_of({.more = slide}), "cart").robot, name).words;
  EXPECT_EQ(words.at("@joints@"), "2");
  EXPECT_EQ(words.at("@place_unit@"), "rad|m");
  EXPECT_EQ(words.at("@force_unit@"), "N m|N");
  EXPECT_EQ(words.at("@rotors@"), "0.2 0.1");
  EXPECT_EQ(words.at("@lowest@"), "-1.05");
  EXPECT_EQ(words.at("@least_stored@"), "-1.05");
  EXPECT_EQ(words.at("@strongest@"), "60");
}

TEST(NewRobot, MayStoreNothingWhereNoJointOfItCanStandAt0) {
  const auto found = judged(text_of({.limit = R"(<limit lower="0.5" upper="2" velocity="3" effort="60"/>)"}));
  ASSERT_TRUE(found.robot);
  const auto words = parts_of(*found.robot, new_name("rod").value()).words;
  EXPECT_EQ(words.at("@lowest@"), "0.45");
  EXPECT_EQ(words.at("@least_stored@"), "0");
  EXPECT_EQ(words.at("@most_stored@"), "2.05");
}

/// A pair of fingers at the tool, the second of which follows the first; both at the middle at `lower`.
[[nodiscard]] std::string with_fingers(const char* lower = "0", const char* upper = "0.04") {
  std::string more;
  for (const char* side : {"left", "right"}) {
    const bool left = std::string_view{side} == "left";
    more += fmt::format(
        R"(<joint name="{0}_slide" type="prismatic"><parent link="tool"/><child link="{0}"/><axis xyz="0 {1} 0"/>
<limit lower="{2}" upper="{3}" velocity="0.1" effort="40"/>{4}</joint><link name="{0}"><inertial><mass value="0.1"/>
<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>)",
        side, left ? 1 : -1, lower, upper, left ? "" : R"(<mimic joint="left_slide"/>)");
  }
  return text_of({.more = more});
}

TEST(NewRobot, TakesFingersForASubsystemOfTheirOwnInTheArmsWorld) {
  const auto found = judged(with_fingers(), "", "left_slide");
  ASSERT_TRUE(found.robot) << found.problems.front().message;
  const NewRobot& robot = *found.robot;
  EXPECT_EQ(robot.tip, "tool") << "where they slide";
  EXPECT_EQ(robot.model.joint_count(), 1);
  ASSERT_TRUE(robot.hand);
  EXPECT_NEAR(robot.hand->full_width_m, 0.08, 1e-12);
  EXPECT_NEAR(robot.hand->most_force_n, 20, 1e-9) << "one drive of 40 N for both";
  EXPECT_NEAR(robot.hand->most_speed_m_s, 0.2, 1e-12);
  EXPECT_FALSE(robot.hand->closed_is_upper);
  const auto parts = parts_of(robot, new_name("rod").value());
  EXPECT_EQ(parts.words.at("@posture@"), "0,0.038") << "of both, fingers nearly open";
  EXPECT_EQ(parts.words.at("@joints@"), "1");
  EXPECT_EQ(named_text("@hand@a @hand_joints@\nb @closed@ @most_grip@ @gap_speed@\n", new_name("rod").value(), parts),
            "a left_slide\nb lower 16 0.2\n");
  const auto shown = nlohmann::json::parse(parts.files[1].second).at("robots").at(0);
  EXPECT_EQ(shown.at("joints").at("left_slide"), "ROD_GRIPPER.CUR_VALUES.POSITION");
  EXPECT_FALSE(shown.at("goal").at("joints").contains("left_slide"));
}

TEST(NewRobot, OfAPlaceholderForAnEffortGuessesNoRotorThatItsWorldRefuses) {
  const auto with = [](const char* effort) {
    return judged(text_of({.limit = fmt::format(R"(<limit lower="-1" upper="2" velocity="3" effort="{}"/>)", effort)}));
  };
  const auto name = new_name("rod").value();
  for (const char* effort : {"300001", "1e9", "1e20"}) {
    const auto found = with(effort);
    ASSERT_TRUE(found.robot) << "it is taken: " << effort;
    ASSERT_EQ(found.warnings.size(), 1u) << effort;
    EXPECT_EQ(found.warnings[0].code, "U0610");
    EXPECT_EQ(found.warnings[0].at.line, 6);
    EXPECT_THAT(found.warnings[0].message, HasSubstr("joint 'swing'"));
    EXPECT_THAT(found.warnings[0].message, HasSubstr(": 1000 is written"));
    const auto words = parts_of(*found.robot, name).words;
    EXPECT_EQ(words.at("@rotors@"), "1000") << "as robot_lines.cpp takes it";
    EXPECT_EQ(words.at("@rotors_of_world@"), "1000");
    EXPECT_EQ(words.at("@rotors_most@"), "2000");
  }
  const auto strong = with("300000");
  EXPECT_THAT(strong.warnings, testing::IsEmpty());
  EXPECT_EQ(parts_of(*strong.robot, name).words.at("@rotors@"), "1000");
  std::string fingers = with_fingers();
  for (const std::string effort = "effort=\"40\""; fingers.find(effort) != std::string::npos;)
    fingers.replace(fingers.find(effort), effort.size(), "effort=\"1e20\"");
  const auto hand = judged(fingers, "", "left_slide");
  ASSERT_TRUE(hand.robot);
  ASSERT_EQ(hand.warnings.size(), 1u);
  EXPECT_THAT(hand.warnings[0].message, HasSubstr("joint 'left_slide' would have a rotor of 3.33e+17: 100 is written"));
  const auto words = parts_of(*hand.robot, name).words;
  EXPECT_EQ(words.at("@finger_rotors@"), "100") << "as newpart_gripper.xml has room for";
  EXPECT_EQ(words.at("@rotors_of_world@"), "0.2,100");
  EXPECT_EQ(words.at("@move_force@"), "1000");
  EXPECT_EQ(words.at("@felt_force@"), "1000");
}

TEST(NewRobot, SeesAtWhichEndFingersAreClosed) {
  EXPECT_TRUE(judged(with_fingers("-0.04", "0"), "", "left_slide").robot->hand->closed_is_upper);
}

TEST(NewRobot, SaysWhatIsNoGripper) {
  const auto why = [](const char* gripper) { return judged(with_fingers(), "tool", gripper).problems.at(0); };
  EXPECT_THAT(why("thumb").message, HasSubstr("no joint 'thumb' that moves by itself"));
  EXPECT_THAT(why("right_slide").message, HasSubstr("no joint 'right_slide'")) << "it follows another one";
  EXPECT_THAT(why("swing").message, HasSubstr("joint 'swing' turns"));
  EXPECT_EQ(why("swing").code, "U0608");
  EXPECT_EQ(why("swing").at.line, 5);
}

/// A lift that slides up and carries the rod, as a torso does.
[[nodiscard]] std::string on_a_lift(const std::string& more = "") {
  std::string text = with_fingers();
  const std::string base = "<link name=\"base\"/>";
  text.replace(text.find(base), base.size(),
               R"(<link name="floor"/><link name="base"><inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<joint name="lift" type="prismatic"><parent link="floor"/><child link="base"/><axis xyz="0 0 1"/>
<limit lower="0" upper="0.3" velocity="0.1" effort="900"/></joint>)");
  text.insert(text.rfind("</robot>"), more);
  return text;
}

TEST(NewRobot, TakesNoJointForAFingerThatCarriesTheArm) {
  const auto why = [](const char* tip, const char* gripper, const std::string& more = "") {
    const auto found = judged(on_a_lift(more), tip, gripper);
    EXPECT_FALSE(found.robot) << tip << " " << gripper;
    return found.problems.empty() ? descriptor::Diagnostic{} : found.problems.front();
  };
  EXPECT_EQ(why("tool", "lift").code, "U0608");
  EXPECT_EQ(why("tool", "lift").message, "--gripper: joint 'lift' carries link 'tool'");
  EXPECT_EQ(why("tool", "lift").at.line, 4) << "its place in the file";
  EXPECT_THAT(why("tool", "lift").hint, HasSubstr("behind the tool"));
  EXPECT_THAT(why("tool", "lift,left_slide").message, HasSubstr("'lift' carries link 'tool'")) << "not beside a finger";
  EXPECT_THAT(why("", "lift").message, HasSubstr("'lift' carries joint 'swing'")) << "where no tool is named";
  EXPECT_THAT(why("left", "left_slide").message, HasSubstr("'left_slide' carries link 'left'"));
  EXPECT_THAT(why("right", "left_slide").message, HasSubstr("'right_slide' carries link 'right'")) << "it follows it";
  const std::string second =
      R"(<joint name="far" type="prismatic"><parent link="floor"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.2" velocity="1" effort="30"/></joint><link name="cart"><inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>)";
  EXPECT_THAT(why("tool", "left_slide,far", second).message,
              HasSubstr("joint 'far' slides at link 'floor', and 'left_slide' at 'tool', which moves otherwise"))
      << "fingers of two hands are no gripper";
  EXPECT_TRUE(judged(on_a_lift(), "tool", "left_slide").robot) << "behind the tool it may slide";
}

TEST(NewRobot, WithoutAGripperItsLinesAndItsFileAreLeftOut) {
  const auto parts = parts_of(*judged(text_of()).robot, new_name("rod").value());
  EXPECT_EQ(named_text("a\n@hand@b\nc\n", new_name("rod").value(), parts), "a\nc\n");
  EXPECT_THAT(parts.without_files, ElementsAre("newpart_gripper.xml"));
}

TEST(NewRobot, NamesOfAFileAreNoMarkup) {
  std::string text = text_of();
  for (std::size_t at = 0; (at = text.find("\"swing\"", at)) != std::string::npos;)
    text.replace(at, 7, "\"a&lt;b &amp; &quot;c&quot;\"");
  const auto name = new_name("rod").value();
  const auto parts = parts_of(*judged(text).robot, name);
  EXPECT_THAT(parts.words.at("@joint_names@"), HasSubstr(">a&lt;b &amp; &quot;c&quot;<"));
  EXPECT_EQ(nlohmann::json::parse(parts.files[1].second).at("robots").at(0).at("joints").count("a<b & \"c\""), 1u);
  text = text_of();
  for (std::size_t at = 0; (at = text.find("\"tool\"", at)) != std::string::npos;) text.replace(at, 6, "\"a&quot;b\"");
  EXPECT_EQ(parts_of(*judged(text).robot, name).words.at("@tip@"), "a&quot;b");
}

}  // namespace
}  // namespace hirosco::tools
