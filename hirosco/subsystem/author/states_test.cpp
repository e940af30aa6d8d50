// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/states.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace hirosco {
namespace {

constexpr std::array all_states{
    State::Offline,     State::SoftwareInit,     State::HardwareInit,    State::PreOperational, State::SafeOperational,
    State::Operational, State::ErrorOperational, State::PostOperational, State::HardwareDeinit, State::SoftwareDeinit};

/// Figure 4 written by hand: row = from, column = to, in the order of all_states; f is an edge of a failure only.
constexpr std::array<std::string_view, 10> figure_4{
    ".1........",  // Offline
    "..1......f",  // SoftwareInit
    "...1....f.",  // HardwareInit
    "....1.11..",  // PreOperational
    ".....111..",  // SafeOperational
    "....1.1...",  // Operational
    ".......1..",  // ErrorOperational
    "...1....1.",  // PostOperational
    ".........1",  // HardwareDeinit
    "1.........",  // SoftwareDeinit
};

TEST(States, AreConnectedAsFigure4Says) {
  for (std::size_t from = 0; from < 10; ++from)
    for (std::size_t to = 0; to < 10; ++to)
      EXPECT_EQ(is_edge(all_states[from], all_states[to]), figure_4[from][to] != '.')
          << to_text(all_states[from]) << " -> " << to_text(all_states[to]);
}

TEST(States, AnEdgeIsOfTheKindThatFigure4Says) {
  const auto place = [](State state) {
    return static_cast<std::size_t>(std::ranges::find(all_states, state) - all_states.begin());
  };
  for (const Edge& edge : transitions)
    EXPECT_EQ(edge.kind == EdgeKind::Failure, figure_4[place(edge.from)][place(edge.to)] == 'f')
        << to_text(edge.from) << " -> " << to_text(edge.to);
}

/// Written by hand, in the order of all_states: t goes on by itself, c runs in cycles.
TEST(States, AreTransientOrCyclicAsThePaperSays) {
  constexpr std::string_view kinds = ".ttcccc.tt";
  for (std::size_t i = 0; i < all_states.size(); ++i) {
    EXPECT_EQ(is_transient(all_states[i]), kinds[i] == 't') << to_text(all_states[i]);
    EXPECT_EQ(is_cyclic(all_states[i]), kinds[i] == 'c') << to_text(all_states[i]);
  }
}

/// Which commands are legal, written by hand: O offline, P pre, S safe, X operational, E error, T post.
TEST(States, EveryCommandIsRoutedOrRefusedAsWritten) {
  struct Case {
    State from;
    std::string_view legal;
  };
  constexpr std::array cases{
      Case{State::Offline, "P"},       Case{State::PreOperational, "OSET"},  Case{State::SafeOperational, "OPXET"},
      Case{State::Operational, "SE"},  Case{State::ErrorOperational, "OPT"}, Case{State::PostOperational, "OP"},
      Case{State::SoftwareInit, ""},   Case{State::HardwareInit, ""},        Case{State::HardwareDeinit, ""},
      Case{State::SoftwareDeinit, ""},
  };
  constexpr std::array targets{std::pair{'O', State::Offline},          std::pair{'P', State::PreOperational},
                               std::pair{'S', State::SafeOperational},  std::pair{'X', State::Operational},
                               std::pair{'E', State::ErrorOperational}, std::pair{'T', State::PostOperational}};
  for (const Case& c : cases)
    for (const auto& [letter, to] : targets)
      EXPECT_EQ(route(c.from, to).has_value(), c.legal.find(letter) != std::string_view::npos)
          << to_text(c.from) << " commanded to " << to_text(to);
}

TEST(States, ARouteIsAChainOfEdgesThatEndsAtTheTarget) {
  for (const State from : all_states)
    for (const State to : all_states) {
      const auto way = route(from, to);
      if (!way) continue;
      State at = from;
      for (std::uint8_t i = 0; i < way->size; ++i) {
        EXPECT_TRUE(is_edge(at, way->states[i]));
        at = way->states[i];
      }
      EXPECT_EQ(at, to);
    }
}

TEST(States, TheWayDownPassesThroughTheDeinitStates) {
  const auto way = route(State::SafeOperational, State::Offline);
  ASSERT_TRUE(way);
  ASSERT_EQ(way->size, 4);
  EXPECT_EQ(way->states[0], State::PostOperational);
  EXPECT_EQ(way->states[1], State::HardwareDeinit);
  EXPECT_EQ(way->states[2], State::SoftwareDeinit);
  EXPECT_EQ(way->states[3], State::Offline);
}

/// Written by hand from figure 4: - leads nowhere, S and H to the deinit states, E to Error-Operational.
TEST(States, AFailureLeadsWhereFigure4Says) {
  constexpr std::string_view targets = "-SHEEE----";
  for (std::size_t i = 0; i < all_states.size(); ++i) {
    const auto target = failure_target(all_states[i]);
    const State wanted = targets[i] == 'S'   ? State::SoftwareDeinit
                         : targets[i] == 'H' ? State::HardwareDeinit
                                             : State::ErrorOperational;
    EXPECT_EQ(target.has_value(), targets[i] != '-') << to_text(all_states[i]);
    EXPECT_EQ(target.value_or(wanted), wanted) << to_text(all_states[i]);
  }
}

TEST(States, AFailureLeadsAlongAnEdge) {
  for (const State state : all_states) {
    const auto target = failure_target(state);
    EXPECT_TRUE(!target || is_edge(state, *target)) << to_text(state);
  }
}

}  // namespace
}  // namespace hirosco
