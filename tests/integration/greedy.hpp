// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "tests/integration/flight.hpp"

/// A careless subsystem, GREEDY, with a motor that notes all that it hears: it writes torque in every node of the state
/// machine, so that whatever keeps the motor safe is not the author's care.
namespace hirosco::testing {

inline constexpr double greedy_torque = 7.0;
inline constexpr double greedy_safe_torque = -1.0;  // not 0: what arrives must be the descriptor's value

/// What the author's nodes and the motor saw; lives outside both.
struct GreedyTrace {
  State node{State::Offline};  ///< whose method ran last
  std::array<int, 10> node_runs{};  ///< by State
  bool configured{false};
  struct Frame {
    DeviceMode mode{};
    double torque{};
  };
  std::vector<Frame> frames;  ///< every command that reached the motor's side of the flow
  bool flow_open{false};  ///< the subsystem's side, as the motor last saw it
};

/// A mission of GREEDY and the ground link; `start` is Operational unless the mission's text is changed.
[[nodiscard]] Plan greedy_plan(GreedyTrace& trace);

}  // namespace hirosco::testing
