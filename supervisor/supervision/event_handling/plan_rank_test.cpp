// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_rank.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::Severity;

/// Each rank by its whole order: safety first, then priority, then severity, as docs/adr/0090 says.
std::vector<PlanRank> ranks_from_the_lowest() {
  std::vector<PlanRank> ranks;
  for (const Safety safety : {Safety::None, Safety::Stop, Safety::Network})
    for (const auto priority : std::array<std::uint8_t, 3>{1, 100, 255})
      for (const Severity severity : {Severity::Info, Severity::Low, Severity::Medium, Severity::High})
        ranks.push_back({safety, priority, severity});
  return ranks;
}

TEST(PlanRank, WhatIsSaferGoesFirstThenThePriorityThenTheSeverity) {
  const auto ranks = ranks_from_the_lowest();
  for (std::size_t begins = 0; begins < ranks.size(); ++begins)
    for (std::size_t runs = 0; runs < ranks.size(); ++runs)
      EXPECT_EQ(pre_empts(ranks[begins], ranks[runs]), begins > runs) << begins << " against " << runs;
}

TEST(PlanRank, OfEqualsTheFirstGoesOn) {
  for (const PlanRank& rank : ranks_from_the_lowest()) EXPECT_FALSE(pre_empts(rank, rank));
}

TEST(PlanRank, StepsAreAsSafeAsTheSafestOfThem) {
  constexpr std::uint16_t subject = 10;
  const ProcedureStep notes = step("log", subject, {}), fences = step("fence", subject, {}),
                      takes_down = step("shut_down_network", subject, {});
  const auto stops = to_state(subject, descriptor::State::SafeOperational);
  const auto lets_go = to_state(subject, descriptor::State::Operational);
  EXPECT_EQ(safety_of({}), Safety::None);
  EXPECT_EQ(safety_of(std::array{notes}), Safety::None) << "a kind that says nothing of it stops nobody";
  EXPECT_EQ(safety_of(std::array{lets_go, notes}), Safety::None);
  EXPECT_EQ(safety_of(std::array{notes, fences}), Safety::Stop);
  EXPECT_EQ(safety_of(std::array{stops, lets_go}), Safety::Stop) << "wherever it stands";
  EXPECT_EQ(safety_of(std::array{fences, takes_down, notes}), Safety::Network);
}

}  // namespace
}  // namespace hirosco::supervisor
