// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// The coupled robot and joystick a second time, written from the mission's note alone, to judge the craft by. Shares no
/// line and no number with simulation/devices/robot/world, the devices or the control laws: other coordinates (absolute angles of the
/// links), another integrator (Dormand and Prince 5(4), step sizes from its own error), no framework, no frames, no
/// sensors with steps. What both say alike is the physics; what only one says is a mistake.
namespace hirosco::independent {

using Pair = std::array<double, 2>;

enum class Hand : std::uint8_t { MinimumJerk, Ramp, Sine };
enum class Passivity : std::uint8_t { Off, On };
enum class Friction : std::uint8_t { Off, On };

/// Of the hand: from `begin_s` on to this offset of the tip from home, by minimum jerk.
struct Leg {
  double begin_s{0};
  Pair offset_m{};
  double span_s{1};
};

/// Pulls the tip towards its anchor when longer than it is free.
struct Spring {
  Pair anchor_m{};
  double free_m{0.05}, n_per_m{400};
};

struct Conditions {
  double force_scale{0.02};
  Passivity passivity{Passivity::Off};
  Friction friction{Friction::On};
  Hand hand{Hand::MinimumJerk};
  Pair offset_m{};  ///< that the hand intends for the tip, from home
  double hand_span_s{1};  ///< in which it goes there
  std::vector<Leg> legs{};  ///< of a hand that goes on: each begins where the one before has led
  Pair sine_rad{};  ///< of a hand that swings: amplitudes of the handle's axes
  double sine_hz{1};
  int ticks_per_handle_cycle{1};  ///< robot cycles of 0.5 ms in one of the joystick: 1 coupled, 4 remote
  int handle_phase_ticks{0};  ///< which of them
  int up_ticks{1};  ///< from the joystick's cycle until the robot's controller has its angles
  int down_ticks{0};  ///< from the robot's cycle until the joystick's controller has its torques
  double filter{1};  ///< share of the newest angles in those that the controller follows, per handle cycle
  double span_s{8};
  std::optional<Spring> spring{};
  double hooked_s{0};  ///< since when the spring is
  double torque_limit_n_m{0};  ///< the joints stop by themselves after two of three samples beyond it; 0 = none
};

/// At the end of one tick of 0.5 ms.
struct Sample {
  double time_s{0};
  double force_n{0};  ///< normal force of the rail
  double penetration_m{0};
  double spring_n{0};
  Pair torque_n_m{};  ///< of the flexible joints
  Pair motor_n_m{};
  Pair motor_rad{}, link_rad{}, handle_rad{}, display_n_m{};
  bool stopping{false};  ///< by themselves
  Pair asked_rad{}, met_rad{};  ///< what the controller followed in this tick, and where the links were then
};

[[nodiscard]] std::vector<Sample> fly(const Conditions& conditions);

/// At rest, without friction: what the rail pushes back with where the controller wants the tip at this ordinate, so deep in it.
[[nodiscard]] double resting_force_n(double ordinate_m, double depth_m, double gain_n_m_per_rad);

/// What RO7 asks of a flight.
struct Figures {
  double lost_share{0};  ///< of 4 s to 8 s without contact
  double peak_n_m{0};  ///< largest joint torque
  double end_force_n{0};  ///< mean of the eighth second
};
[[nodiscard]] Figures figures_of(const std::vector<Sample>& flight);

}  // namespace hirosco::independent
