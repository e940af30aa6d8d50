// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "bench/robots/arm_cycles.hpp"
#include "bench/robots/robot_cases.hpp"
#include "tools/new_folder/robot.hpp"

/// What bench/robots/run flies of the robots of others, of one robot of ours: made by the template, nothing in it edited.
namespace hirosco::bench {
namespace {

namespace fs = std::filesystem;

struct MadeRobot : ::testing::Test {
  fs::path folder = fs::temp_directory_path() / fmt::format("hirosco-robot-cases-{}", ::getpid());
  fs::path mission = folder / "made/mission.xml";

  void SetUp() override {
    const auto judged =
        tools::judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "missions/arm_and_fingers/page/arm_and_fingers.urdf",
                           descriptor::file_system(), "palm", "left_slide");
    ASSERT_TRUE(judged.robot);
    const auto name = tools::new_name("made").value();
    const auto made = tools::make_folder(fs::path{HIROSCO_SOURCE_DIR} / "templates/robot", folder / "made", name,
                                         tools::parts_of(*judged.robot, name));
    ASSERT_TRUE(made) << made.error();
  }
  void TearDown() override { fs::remove_all(folder); }
};

TEST_F(MadeRobot, GoesWhereItIsToldToWithALoadThatNobodyDeclared) {
  auto task = robot_task(mission);
  ASSERT_TRUE(task) << task.error();
  EXPECT_EQ(task->tip, "palm");
  EXPECT_EQ(task->joints.size(), 6u);
  EXPECT_GE(task->goals.size(), 3u);
  ASSERT_FALSE(task->lines.empty());
  // Two goals and a line of them, which is what there is time for.
  task->goals.erase(task->goals.begin(), task->goals.end() - 2);
  task->lines.erase(task->lines.begin() + 1, task->lines.end());
  const auto cases = robot_cases(task->weakest);
  const auto found = fly_case(mission, *task, cases.at(4), 1);
  std::cout << fmt::format("  {}: {:.2f} and {:.2f} mrad, {:.2f} mm, {:.2f} mm beside its line\n", cases.at(4).name,
                           1e3 * found.joint_rad, 1e3 * found.turned_rad, 1e3 * found.tool_m, 1e3 * found.beside_m);
  EXPECT_TRUE(found.holds()) << fmt::format("{}", fmt::join(found.problems, "\n"));
  EXPECT_EQ(found.lines, 2) << "there and back";
}

/// How long they take here says nothing: others are at work beside this.
TEST_F(MadeRobot, HasCyclesThatAreMeasuredInMotionWithAllThatBelongsToThem) {
  auto task = robot_task(mission);
  ASSERT_TRUE(task) << task.error();
  task->goals.erase(task->goals.begin(), task->goals.end() - 2);
  task->lines.erase(task->lines.begin() + 1, task->lines.end());
  constexpr std::size_t wanted = 1500;
  const auto found = measure_arm_cycles(mission, *task, wanted, 1);
  EXPECT_TRUE(found.problems.empty()) << fmt::format("{}", fmt::join(found.problems, "\n"));
  EXPECT_TRUE(found.missing().empty()) << fmt::format("{}", fmt::join(found.missing(), "\n"));
  EXPECT_EQ(found.period_us, 1000);
  EXPECT_GE(found.processor_ns.size(), wanted);
  EXPECT_EQ(found.wall_ns.size(), found.processor_ns.size());
  EXPECT_GT(found.processor().p50, 0);
  EXPECT_GE(found.processor().p99, found.processor().p50);
  EXPECT_GT(found.told, 0);
  EXPECT_GT(found.most_external, 0);
  EXPECT_GT(found.least_clearance_m, 0);
}

TEST(ArmCycles, HoldWithATenthOfThePeriodAndAllThatBelongsToThemOnly) {
  ArmCycles found;
  found.period_us = 1000;
  // The hundredth longest of ten thousand, and those that are longer.
  found.processor_ns.assign(9900, 99'000);
  found.processor_ns.insert(found.processor_ns.end(), 100, 900'000);
  found.wall_ns = found.processor_ns;
  found.told = 1;
  found.most_external = 0.1;
  found.least_clearance_m = 0.02;
  EXPECT_TRUE(found.holds());
  EXPECT_EQ(found.processor().max, 900);
  const auto without = [&](auto change) {
    ArmCycles other = found;
    change(other);
    return !other.holds();
  };
  EXPECT_TRUE(without([](ArmCycles& one) { one.processor_ns.insert(one.processor_ns.end(), 100, 101'000); }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.period_us = 980; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.processor_ns.clear(); }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.told = 0; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.by_positions = false; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.watches_contact = false; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.most_external = 0; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.least_clearance_m = HUGE_VAL; }));
  EXPECT_TRUE(without([](ArmCycles& one) { one.problems.emplace_back("a contact"); }));
}

TEST(RobotCases, HoldOnlyWhereSomethingWasFlownAndNothingWasWrong) {
  CaseFound found{
      .joint_rad = 1e-3, .turned_rad = 1e-3, .tool_m = 1e-3, .beside_m = 2e-3, .goals = 1, .lines = 1, .problems = {}};
  EXPECT_TRUE(found.holds());
  const auto without = [&](auto change) {
    CaseFound other = found;
    change(other);
    return !other.holds();
  };
  EXPECT_TRUE(without([](CaseFound& one) { one.joint_rad = 1.01e-3; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.turned_rad = 1.01e-3; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.tool_m = 1.01e-3; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.beside_m = 2.01e-3; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.beside_m = std::nan(""); }));
  EXPECT_TRUE(without([](CaseFound& one) { one.goals = 0; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.lines = 0; }));
  EXPECT_TRUE(without([](CaseFound& one) { one.problems.emplace_back("a contact"); }));
}

}  // namespace
}  // namespace hirosco::bench
