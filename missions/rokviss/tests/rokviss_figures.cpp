// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The figures of the rokviss mission on the whole spacecraft, judged against missions/rokviss/expected.csv, and the
// controls: an error of one percent in the model must show. `hirosco report rokviss` prints the same figures.
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "missions/rokviss/scenarios/rokviss.hpp"

namespace hirosco::simulation {
namespace {

const std::filesystem::path mission_folder = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions" / "rokviss";

/// What a run of an id found, judged; prints it.
struct Judgement {
  std::vector<std::string> problems;
  std::vector<Row> rows;

  [[nodiscard]] std::vector<std::string> failing() const {
    std::vector<std::string> names = problems;
    for (const Row& row : rows)
      if (!row.holds) names.push_back(row.expected.name);
    return names;
  }
};

Judgement judge(std::string_view id, const Plant& plant = {}) {
  static const auto table = ExpectedTable::read(mission_folder / "expected.csv");
  if (!table) return {{table.error()}, {}};
  const auto run = std::ranges::find(rokviss_runs(), id, &Run::id);
  // Fewer and shorter than a whole report, which is a test of its own, labelled `long`.
  const Findings findings = fly(*run, {.mission = mission_folder / "mission.xml",
                                       .plant = plant,
                                       .repetitions = id == "RO9" ? 20 : 5,
                                       .endurance_s = 60});
  Judgement judgement{findings.problems, judged(*table, id, findings.figures)};
  for (const Row& row : judgement.rows)
    std::cout << fmt::format("{:34} {:>20} {:>12.7g} {}\n", row.expected.name, row.expected.text(), row.value,
                             row.holds ? "holds" : "FAILS");
  return judgement;
}

class RokvissFigures : public ::testing::TestWithParam<std::string_view> {};

TEST_P(RokvissFigures, HoldOnTheWholeSpacecraft) { EXPECT_EQ(judge(GetParam()).failing(), std::vector<std::string>{}); }

INSTANTIATE_TEST_SUITE_P(Runs, RokvissFigures, ::testing::ValuesIn([] {
                           std::vector<std::string_view> ids;
                           for (const Run& run : rokviss_runs()) ids.push_back(run.id);
                           return ids;
                         }()),
                         [](const auto& named) { return std::string{named.param}; });

/// A figure that was measured and does not hold; one that was not measured shows nothing.
bool sees(std::string_view id, std::string_view figure, const Plant& plant) {
  const Judgement judgement = judge(id, plant);
  const auto row = std::ranges::find(judgement.rows, figure, [](const Row& each) { return each.expected.name; });
  return judgement.problems.empty() && row != judgement.rows.end() && row->measured && !row->holds;
}

TEST(RokvissFiguresSee, OnePercentOfJointStiffness) {
  EXPECT_TRUE(sees("RO2", "RO2-22.6mm-windup2", {.stiffness = 1.01}));
}
TEST(RokvissFiguresSee, OnePercentOfRailStiffness) {
  EXPECT_TRUE(sees("RO2", "RO2-22.6mm-penetration", {.rail = 1.01}));
}
TEST(RokvissFiguresSee, OnePercentOfMass) { EXPECT_TRUE(sees("RO1", "RO1-inertia-11", {.mass = 1.01})); }
TEST(RokvissFiguresSee, OnePercentOfForceScale) {
  EXPECT_TRUE(sees("RO3", "RO3-display-ratio", {.force_scale = 1.01}));
}

}  // namespace
}  // namespace hirosco::simulation
