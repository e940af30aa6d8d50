// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"

/// The ten states as one table (paper 4.2, figure 4). Code, tests and the drawn diagram use this one.
namespace hirosco {

using descriptor::State;

enum class EdgeKind : std::uint8_t {
  Commanded,   ///< taken on a command, or on the way to a commanded state
  Failure,     ///< taken only when the state it leaves has failed
};

struct Edge {
  State from;
  State to;
  EdgeKind kind;
};

inline constexpr std::array transitions{
    Edge{State::Offline, State::SoftwareInit, EdgeKind::Commanded},
    Edge{State::SoftwareInit, State::HardwareInit, EdgeKind::Commanded},
    Edge{State::SoftwareInit, State::SoftwareDeinit, EdgeKind::Failure},
    Edge{State::HardwareInit, State::PreOperational, EdgeKind::Commanded},
    Edge{State::HardwareInit, State::HardwareDeinit, EdgeKind::Failure},
    Edge{State::PreOperational, State::SafeOperational, EdgeKind::Commanded},
    Edge{State::PreOperational, State::PostOperational, EdgeKind::Commanded},
    Edge{State::PreOperational, State::ErrorOperational, EdgeKind::Commanded},
    Edge{State::SafeOperational, State::Operational, EdgeKind::Commanded},
    Edge{State::SafeOperational, State::PostOperational, EdgeKind::Commanded},
    Edge{State::SafeOperational, State::ErrorOperational, EdgeKind::Commanded},
    Edge{State::Operational, State::SafeOperational, EdgeKind::Commanded},
    Edge{State::Operational, State::ErrorOperational, EdgeKind::Commanded},
    Edge{State::ErrorOperational, State::PostOperational, EdgeKind::Commanded},
    Edge{State::PostOperational, State::PreOperational, EdgeKind::Commanded},
    Edge{State::PostOperational, State::HardwareDeinit, EdgeKind::Commanded},
    Edge{State::HardwareDeinit, State::SoftwareDeinit, EdgeKind::Commanded},
    Edge{State::SoftwareDeinit, State::Offline, EdgeKind::Commanded},
};

[[nodiscard]] constexpr bool is_edge(State from, State to) noexcept {
  for (const Edge& edge : transitions)
    if (edge.from == from && edge.to == to) return true;
  return false;
}

/// States that run in phases until they are done and then go on by themselves.
[[nodiscard]] constexpr bool is_transient(State state) noexcept {
  return state == State::SoftwareInit || state == State::HardwareInit || state == State::HardwareDeinit ||
         state == State::SoftwareDeinit;
}

/// States in which the cycle may run.
[[nodiscard]] constexpr bool is_cyclic(State state) noexcept {
  return state == State::PreOperational || state == State::SafeOperational || state == State::Operational ||
         state == State::ErrorOperational;
}

/// Where a failure in a state leads; empty where the state stays as it is.
[[nodiscard]] constexpr std::optional<State> failure_target(State state) noexcept {
  switch (state) {
    case State::SoftwareInit: return State::SoftwareDeinit;
    case State::HardwareInit: return State::HardwareDeinit;
    case State::PreOperational:
    case State::SafeOperational:
    case State::Operational: return State::ErrorOperational;
    default: return std::nullopt;
  }
}

/// The states passed on the way to a commanded one, the commanded one last.
struct Route {
  std::array<State, 5> states{};
  std::uint8_t size{0};
};

/// The way from a state to a commanded steady state: one commanded edge, or several through transient states and
/// Post-Operational. Empty: the command is illegal here.
[[nodiscard]] constexpr std::optional<Route> route(State from, State to) noexcept {
  if (is_transient(to) || is_transient(from) || from == to) return std::nullopt;
  Route way;
  const auto passes = [](State state) { return is_transient(state) || state == State::PostOperational; };
  State at = from;
  while (way.size < way.states.size()) {
    std::optional<State> next;
    for (const Edge& edge : transitions) {
      if (edge.from != at || edge.kind != EdgeKind::Commanded) continue;
      if (edge.to == to) {
        next = to;
        break;
      }
      // From Post-Operational only the way down is passed through; up again is a target of its own.
      if (passes(edge.to)) next = edge.to;
    }
    if (!next) return std::nullopt;
    way.states[way.size++] = *next;
    if (*next == to) return way;
    at = *next;
  }
  return std::nullopt;
}

}  // namespace hirosco
