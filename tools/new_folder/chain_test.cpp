// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/chain.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/new_folder/robot.hpp"

/// One arm of a robot that has more joints (docs/adr/0131).
namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

[[nodiscard]] std::string joint(const std::string& name, const std::string& parent, const std::string& more = "",
                                const char* type = "revolute") {
  return fmt::format(
      "<link name='{0}'><inertial><mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' "
      "izz='0.1'/></inertial></link><joint name='j_{0}' type='{1}'><origin xyz='0.1 0 0'/><parent link='{2}'/><child "
      "link='{0}'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' velocity='1' effort='99'/>{3}</joint>\n",
      name, type, parent, more);
}
/// A torso with two arms; the left one has a hand whose finger follows its thumb.
[[nodiscard]] std::string two_arms(int joints_of_right = 1) {
  std::string text = "<robot name='two'>\n<link name='base'/>" + joint("torso", "base") + joint("left", "torso") +
                     joint("hand", "left") + joint("thumb", "hand", "", "prismatic") +
                     joint("finger", "hand", "<mimic joint='j_thumb'/>", "prismatic");
  std::string parent = "torso";
  for (int i = 1; i <= joints_of_right; ++i)
    text += joint(fmt::format("right_{}", i), std::exchange(parent, fmt::format("right_{}", i)));
  return text + "</robot>";
}
[[nodiscard]] JudgedRobot judged_chain(const std::string& text, const std::string& tip, const std::string& gripper = "",
                                       bool chain = true) {
  return judge_robot(
      "two.urdf", [&](const std::filesystem::path&) -> Result<std::string> { return text; }, tip, gripper, {}, chain);
}

TEST(Chain, EndsWithMostJointsComeFirst) {
  const auto ends = chain_ends(two_arms(5));
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_EQ(ends[0].link, "right_5");
  EXPECT_EQ(ends[0].joints, 6u);
  EXPECT_EQ(ends[2].link, "finger");
  EXPECT_EQ(ends[2].joints, 3u) << "who follows does not move by itself";
  EXPECT_THAT(chain_ends("no XML"), IsEmpty());
}

TEST(Chain, WhatDoesNotMoveItsToolStandsAndNothingElseIsAnother) {
  const std::string text = two_arms();
  const auto chain = keep_chain(text, "hand", {});
  EXPECT_THAT(chain.standing, ElementsAre("j_thumb", "j_finger", "j_right_1"));
  std::string expected = text;
  for (const char* name : {"j_thumb' type='prismatic", "j_finger' type='prismatic", "j_right_1' type='revolute"}) {
    const std::string word = name;
    const auto equals = word.rfind('\'') + 1;
    expected.replace(expected.find(word) + equals, word.size() - equals, "fixed");
  }
  EXPECT_EQ(chain.urdf, expected);
}

TEST(Chain, WhoIsFollowedOrFollowsAFingerMovesToo) {
  EXPECT_THAT(keep_chain(two_arms(), "finger", {}).standing, ElementsAre("j_right_1"));
  const std::vector<std::string> thumb{"j_thumb"};
  EXPECT_THAT(keep_chain(two_arms(), "hand", thumb).standing, ElementsAre("j_right_1"));
  EXPECT_THAT(keep_chain(two_arms(), "", thumb).standing, ElementsAre("j_right_1"));
}

TEST(Chain, IsAnArmOfARobotWithMoreJointsThanAnArmMayHave) {
  const std::string text = two_arms(14);
  const auto refused = judged_chain(text, "hand", "", false);
  ASSERT_FALSE(refused.robot);
  EXPECT_EQ(refused.problems.front().code, "U0309");
  EXPECT_THAT(refused.problems.front().hint, HasSubstr("--tip LINK --chain: right_14 (15 joints), thumb (4 joints)"));
  const auto left = judged_chain(text, "hand");
  ASSERT_TRUE(left.robot) << left.problems.front().message;
  EXPECT_EQ(left.robot->model.joint_count(), 3);
  EXPECT_THAT(left.robot->world_joints, ElementsAre("j_torso", "j_left", "j_hand"));
  const auto said = std::ranges::find(left.warnings, std::string{"U0609"}, &descriptor::Diagnostic::code);
  ASSERT_NE(said, left.warnings.end());
  EXPECT_THAT(said->message, HasSubstr("16 joints stand at 0"));
  const auto hand = judged_chain(text, "", "j_thumb");
  ASSERT_TRUE(hand.robot) << hand.problems.front().message;
  EXPECT_EQ(hand.robot->tip, "hand");
  EXPECT_EQ(hand.robot->world_joints.size(), 4u);
}

TEST(Chain, ThatFliesIsLookedForFromAnEndToMoreThanHalfOfItsJoints) {
  std::vector<std::string> asked;
  const auto found = [&](const std::vector<std::string>& flying, std::size_t most = 6) {
    asked.clear();
    std::vector<std::string> named;
    for (const ChainEnd& end :
         chains_that_fly(two_arms(5), most, [&](const std::string& urdf, const std::string& tip) -> std::size_t {
           asked.push_back(tip);
           EXPECT_EQ(urdf, keep_chain(two_arms(5), tip, {}).urdf);
           return std::ranges::find(flying, tip) != flying.end() ? 10 + asked.size() : 0;
         }))
      named.push_back(fmt::format("{} {}", end.link, end.joints));
    return named;
  };
  EXPECT_THAT(found({"right_3", "hand"}), ElementsAre("hand 15", "right_3 13")) << "those with more joints first";
  EXPECT_THAT(asked, ElementsAre("right_5", "right_4", "right_3", "thumb", "hand", "finger")) << "each once";
  EXPECT_THAT(found({"right_2", "left"}), IsEmpty()) << "that is half of it, or less";
  EXPECT_THAT(found({"right_5", "thumb", "finger"}, 1), ElementsAre("right_5 11"));
  EXPECT_THAT(asked, ElementsAre("right_5"));
}

TEST(Chain, IsNamedWhereOneJointKeepsTheWholeRobotFromFlying) {
  std::string text = two_arms();
  const std::string effort = "effort='99'";
  text.replace(text.find(effort, text.find("j_thumb")), effort.size(), "effort='0'");
  const auto refused = judged_chain(text, "hand", "", false);
  ASSERT_FALSE(refused.robot);
  ASSERT_EQ(refused.problems.size(), 1u);
  EXPECT_EQ(refused.problems[0].code, "U0601");
  EXPECT_THAT(refused.problems[0].hint, HasSubstr("--tip LINK --chain: hand (3 joints), right_1 (2 joints)"));
  EXPECT_TRUE(judged_chain(text, "hand").robot);
  // Of a chain, too, that goes too far.
  const auto thumb = judged_chain(text, "thumb");
  ASSERT_FALSE(thumb.robot);
  EXPECT_THAT(thumb.problems[0].hint, HasSubstr("--tip LINK --chain: hand (3 joints)"));
}

TEST(Chain, IsNotNamedWhereItWouldNotFlyEither) {
  std::string text = two_arms();
  const std::string effort = "effort='99'";
  text.replace(text.find(effort, text.find("j_torso")), effort.size(), "effort='0'");
  const auto refused = judged_chain(text, "hand", "", false);
  ASSERT_FALSE(refused.robot);
  EXPECT_THAT(refused.problems[0].hint, ::testing::Not(HasSubstr("--chain")));
}

TEST(Chain, OfALinkThatIsNotThereIsSaid) {
  const auto wrong = judged_chain(two_arms(), "hnad");
  ASSERT_FALSE(wrong.robot);
  EXPECT_THAT(wrong.problems.front().message, HasSubstr("no link 'hnad'"));
}

}  // namespace
}  // namespace hirosco::tools
