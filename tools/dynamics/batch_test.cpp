// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/dynamics/batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace hirosco::tools {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Two masses that slide along x, the second on the first: 2 kg and 1 kg; the first is damped.
[[nodiscard]] robotics::Model sliders(double damping) {
  robotics::ModelDescription description;
  description.base = {4, robotics::Vector3::Zero(), robotics::Matrix3::Identity()};
  for (const double mass : {2.0, 1.0}) {
    robotics::JointDescription joint;
    joint.kind = robotics::JointKind::Prismatic;
    joint.moved = {mass, robotics::Vector3::Zero(), robotics::Matrix3::Identity()};
    if (!description.joints.empty()) joint.parent = 0;
    else joint.damping = damping;
    description.joints.push_back(joint);
  }
  description.frames = {{"tip", 1, {}}};
  return robotics::Model::make(description).value();
}

[[nodiscard]] Json question() {
  return {{"fixed_base", true},
          {"gravity_m_s2", {0, 0, 0}},
          {"base_position_m", {1, 2, 3}},
          {"base_orientation_wxyz", {1, 0, 0, 0}},
          {"base_twist", {0, 0, 0, 0, 0, 0}},
          {"q", {0.5, 0.25}},
          {"qd", {1, -1}},
          {"torque", {0, 0}},
          {"step_s", 0.1},
          {"end_s", 1},
          {"output_s", {0, 1}}};
}

struct Answers {
  bool good{true};
  std::vector<Json> lines;
};
[[nodiscard]] Answers answers_to(const std::string& line, double damping = 0) {
  const auto model = sliders(damping);
  Batch batch{model, {0}};
  Answers answers;
  answers.good = batch.answer(line, 7, [&](const std::string& text) { answers.lines.push_back(Json::parse(text)); });
  return answers;
}
[[nodiscard]] Answers answers_to(const Json& asked, double damping = 0) { return answers_to(asked.dump(), damping); }

TEST(DynamicsCommand, TellsAllThatItPromisesForEachOutputTime) {
  const auto [good, lines] = answers_to(question());
  ASSERT_TRUE(good);
  ASSERT_EQ(lines.size(), 2U);
  const Json& first = lines[0];
  EXPECT_EQ(first.size(), 13U);
  EXPECT_EQ(first["t"], 0);
  EXPECT_EQ(first["base_position_m"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(first["base_orientation_wxyz"], Json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(first["mass_matrix"], Json({{3.0, 1.0}, {1.0, 1.0}}));
  EXPECT_EQ(first["jacobian"], first["generalised_jacobian"]);
  EXPECT_EQ(first["jacobian"][3], Json({1.0, 1.0}));
  EXPECT_EQ(first["momentum_linear"], Json({2.0, 0.0, 0.0}));
  EXPECT_EQ(first["momentum_angular_com"], Json({0.0, 0.0, 0.0}));
  EXPECT_EQ(first["energy_j"], 1.0);
  EXPECT_EQ(first["qdd"], Json({0.0, 0.0}));
  EXPECT_NEAR(lines[1]["q"][0].get<double>(), 1.5, 1e-14);
  EXPECT_NEAR(lines[1]["q"][1].get<double>(), -0.75, 1e-14);
}

TEST(DynamicsCommand, TellsItInOneOrderWithAllDigitsThatADoubleHas) {
  Json asked = question();
  // Two that take 17 digits, and the smallest that there is.
  const std::vector<double> position{0.1 + 0.2, -1.2345678901234567e100, std::numeric_limits<double>::denorm_min()};
  asked["base_position_m"] = position;
  asked["output_s"] = {0};
  const auto model = sliders(0);
  std::string line;
  ASSERT_TRUE((Batch{model, {0}}.answer(asked.dump(), 1, [&](const std::string& text) { line = text; })));
  EXPECT_EQ(Json::parse(line)["base_position_m"].get<std::vector<double>>(), position);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  std::vector<std::string> keys;
  const auto told = nlohmann::ordered_json::parse(line);
  for (const auto& [key, value] : told.items()) keys.push_back(key);
  EXPECT_THAT(keys, ::testing::ElementsAre("t", "base_position_m", "base_orientation_wxyz", "base_twist", "q", "qd",
                                           "qdd", "momentum_linear", "momentum_angular_com", "energy_j", "mass_matrix",
                                           "jacobian", "generalised_jacobian"));
}

TEST(DynamicsCommand, PutsAFreeBaseBeforeTheJoints) {
  Json asked = question();
  asked["fixed_base"] = false;
  asked["base_twist"] = {0, 0, 0, 0, 3, 0};
  const auto [good, lines] = answers_to(asked);
  ASSERT_TRUE(good);
  EXPECT_EQ(lines[0]["mass_matrix"].size(), 8U);
  EXPECT_EQ(lines[0]["mass_matrix"][3], Json({0.0, 0.0, 0.0, 7.0, 0.0, 0.0, 3.0, 1.0}));
  EXPECT_EQ(lines[0]["jacobian"][0].size(), 8U);
  EXPECT_EQ(lines[0]["generalised_jacobian"][0].size(), 2U);
  EXPECT_EQ(lines[0]["momentum_linear"], Json({2.0, 21.0, 0.0}));
  // What a tip does that is pushed by 3 kg of 7: the rest goes the other way.
  EXPECT_NEAR(lines[0]["generalised_jacobian"][3][0].get<double>(), 1 - 3.0 / 7, 1e-15);
  EXPECT_NEAR(lines[1]["base_position_m"][1].get<double>(), 5, 1e-13);
}

TEST(DynamicsCommand, AppliesDampingAndTorques) {
  Json asked = question();
  asked["qd"] = {1, 0};
  asked["torque"] = {0, 0};
  const auto [good, lines] = answers_to(asked, 4);
  ASSERT_TRUE(good);
  EXPECT_EQ(lines[0]["qdd"], Json({-2.0, 2.0}));  // 4 N against 2 kg; the other one stays where it is
}

TEST(DynamicsCommand, GoesInStraightLinesFromRowToRowOfATable) {
  Json asked = question();
  asked.erase("torque");
  asked["torque_table"] = {{0.2, 3, 3}, {0.6, 6, 3}, {0.8, 0, 3}};
  asked["output_s"] = {0, 0.2, 0.4, 0.6, 0.7, 0.9};
  const auto [good, lines] = answers_to(asked);
  ASSERT_TRUE(good);
  const std::vector<double> expected{3, 3, 4.5, 6, 3, 0};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(3 * lines[i]["qdd"][0].get<double>() + lines[i]["qdd"][1].get<double>(), expected[i], 1e-12);
}

TEST(DynamicsCommand, AnOutputBetweenStepsIsOneShorterStepAndChangesNoOther) {
  Json asked = question();
  asked["qd"] = {1, 0};
  asked["output_s"] = {0.25, 1};
  const auto with = answers_to(asked, 4).lines;
  asked["output_s"] = {1};
  EXPECT_EQ(with[1], answers_to(asked, 4).lines[0]);
  // By hand: qd' = -2 qd; a step of h multiplies by this polynomial of z = -2 h.
  const auto grown = [](double h) {
    const double z = -2 * h;
    return 1 + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
  };
  EXPECT_NEAR(with[0]["qd"][0].get<double>(), grown(0.1) * grown(0.1) * grown(0.05), 1e-14);
  EXPECT_NEAR(with[1]["qd"][0].get<double>(), std::pow(grown(0.1), 10), 1e-13);
}

TEST(DynamicsCommand, SaysWhatIsWrongWithALineAndWhichItWas) {
  const auto wrong = [](auto change, const char* says) {
    Json asked = question();
    change(asked);
    const auto [good, lines] = answers_to(asked);
    EXPECT_FALSE(good) << says;
    ASSERT_EQ(lines.size(), 1U) << says;
    EXPECT_EQ(lines[0].size(), 2U);
    EXPECT_EQ(lines[0]["line"], 7);
    EXPECT_THAT(lines[0]["error"].get<std::string>(), HasSubstr(says));
  };
  const Json whole = question();
  for (const auto& [name, value] : whole.items()) wrong([&](Json& asked) { asked.erase(name); }, name.c_str());
  wrong([](Json& asked) { asked["colour"] = 1; }, "'colour' is not known");
  wrong([](Json& asked) { asked["q"] = {1}; }, "'q' has 1 numbers instead of 2");
  wrong([](Json& asked) { asked["qd"] = {1, "2"}; }, "'qd' is no list of numbers");
  wrong([](Json& asked) { asked["fixed_base"] = 1; }, "neither true nor false");
  wrong([](Json& asked) { asked["step_s"] = 0; }, "'step_s' is not above 0");
  wrong([](Json& asked) { asked["step_s"] = 1e-9; }, "steps");
  wrong([](Json& asked) { asked["output_s"] = {0.5, 0.2}; }, "do not ascend");
  wrong([](Json& asked) { asked["output_s"] = {2}; }, "not between 0 and 'end_s'");
  wrong([](Json& asked) { asked["output_s"] = {-1}; }, "not between 0 and 'end_s'");
  wrong([](Json& asked) { asked["base_orientation_wxyz"] = {1, 1, 0, 0}; }, "not of length 1");
  wrong([](Json& asked) { asked["torque_table"] = {{0, 0, 0}}; }, "both");
  const auto table = [](Json rows) {
    return [rows](Json& asked) {
      asked.erase("torque");
      asked["torque_table"] = rows;
    };
  };
  wrong(table(Json::array()), "no list of rows");
  wrong(table({{0, 0}}), "has 2 numbers instead of 3");
  wrong(table({{1, 0, 0}, {0, 1, 1}}), "descend");
}

/// One record with and without its base fixed, and times that were added up.
TEST(DynamicsCommand, LetsAFixedBaseRestAndRoundsNoTimeAway) {
  Json asked = question();
  asked["base_twist"] = {0, 0, 1, 0, 2, 0};
  asked["end_s"] = 0.3;
  asked["output_s"] = {0, 0.1 + 0.2};
  const auto [good, lines] = answers_to(asked);
  ASSERT_TRUE(good) << lines[0];
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1]["base_twist"], Json({0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(lines[1]["base_position_m"], Json({1.0, 2.0, 3.0}));
  EXPECT_NEAR(lines[1]["q"][0].get<double>(), 0.8, 1e-14);
}

/// 3 kg and 1 kg on one axis: nothing for a second, then 3 N at the first of them.
TEST(DynamicsCommand, TakesTwoRowsOfOneTimeAsAJumpOfTorque) {
  Json asked = question();
  asked["qd"] = {0, 0};
  asked.erase("torque");
  asked["torque_table"] = {{0, 0, 0}, {1, 0, 0}, {1, 3, 1}, {2, 3, 1}};
  asked["end_s"] = 2;
  asked["output_s"] = {0.95, 1, 2};
  const auto [good, lines] = answers_to(asked);
  ASSERT_TRUE(good) << lines[0];
  EXPECT_EQ(lines[0]["qdd"][0], 0.0);
  EXPECT_NEAR(lines[1]["qdd"][0].get<double>(), 1, 1e-14);
  EXPECT_NEAR(lines[2]["qd"][0].get<double>(), 1, 0.02) << "the step that ends with the jump may have half of it";
}

TEST(DynamicsCommand, RefusesWhatIsNoJsonObject) {
  for (const char* line : {"{", "[]", "3", "{\"q\":[1,],}", "{\"q\":1e999}", "\xFF", "{\"q\":[],\"q\":[]}"}) {
    const auto [good, lines] = answers_to(std::string{line});
    EXPECT_FALSE(good) << line;
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].contains("error"));
  }
  EXPECT_THAT(answers_to(std::string{"{\"q\":[],\"q\":[]}"}).lines[0]["error"].get<std::string>(),
              HasSubstr("stands twice"));
  EXPECT_TRUE(answers_to(std::string{"  \r"}).good);
  EXPECT_TRUE(answers_to(std::string{}).lines.empty());
}

TEST(DynamicsCommand, TellsAMotionThatBecomesNoNumberAfterWhatCouldBeTold) {
  Json asked = question();
  asked["step_s"] = 1;
  asked["end_s"] = 200;
  asked["output_s"] = {0, 200};
  const auto [good, lines] = answers_to(asked, 1e6);
  EXPECT_FALSE(good);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["t"], 0);
  EXPECT_THAT(lines[1]["error"].get<std::string>(), HasSubstr("steps up to about 5.6e-06 s"));
}

TEST(DynamicsCommand, SaysThatNumbersAreTooLargeAndNotThatNothingHasInertia) {
  Json asked = question();
  asked["qd"] = {1e308, 1e308};
  const auto [good, lines] = answers_to(asked);
  EXPECT_FALSE(good);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0]["error"].get<std::string>(), HasSubstr("number"));
}

}  // namespace
}  // namespace hirosco::tools
