// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "subsystems/manipulator/control_law.hpp"

/// Programmes that run on board without a link, as ROKVISS did between two passes over its ground station.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::manipulator {

/// Where the programmes believe the surroundings to be: a rail along y with a cosine bump towards the arm.
struct Surroundings {
  double rail_x_m{0.350};
  double bump_height_m{0.010};
  double bump_half_width_m{0.040};
  double bump_y_m{0.05};
  double finger_radius_m{0.010};
};

/// Where a spring's free end hangs and where its other end is fixed.
struct SpringPlace {
  Joints anchor_m{};
  Joints slack_end_m{};
};
inline constexpr std::array<SpringPlace, 2> springs{
    {{{0.3275, 0.050}, {0.3275, 0.000}}, {{0.280, -0.0215}, {0.330, -0.0215}}}};
inline constexpr double hook_reach_m = 0.005;
/// From the tip to the slack end; `spring` counts from 1.
[[nodiscard]] double distance_to_spring(std::size_t spring, const Joints& tip_m) noexcept;

/// Centre of a finger that is `depth_m` deep in the contour at the surface's ordinate `y_m`, along its true normal.
[[nodiscard]] Joints pressed_finger(const Surroundings& surroundings, double y_m, double depth_m) noexcept;

/// A sequence of motions of the tip. Each leg ends at rest.
class Script {
 public:
  enum class Id : std::uint8_t { Contour = 1, Spring = 2 };
  enum class Deed : std::uint8_t { None, Hook, Release };
  struct Settings {
    double speed_m_s{0.020};      ///< along the rail
    double over_press_m{0.006};   ///< of the setpoint into the contour
    Surroundings surroundings{};
  };

  /// Begins where the tip is.
  void start(Id id, const Joints& tip_m, const Joints& home_m, const Settings& settings) noexcept;
  /// Moves on and returns the setpoint of the tip, m. Stays at the end of a leg with a deed until deed_done().
  Joints advance(double span_s) noexcept;
  [[nodiscard]] bool done() const noexcept { return leg_ >= legs_; }
  [[nodiscard]] std::size_t leg() const noexcept { return leg_; }  ///< legs that are done
  [[nodiscard]] std::size_t legs() const noexcept { return legs_; }
  /// What is to be done before the script goes on.
  [[nodiscard]] Deed deed() const noexcept;
  void deed_done() noexcept;

 private:
  struct Leg {
    enum class Path : std::uint8_t { Straight, AlongContour };
    Path path{Path::Straight};
    Joints from_m{};
    Joints to_m{};  ///< AlongContour: [1] of both is the ordinate on the surface
    double duration_s{0};
    Deed deed{Deed::None};  ///< at its end
  };
  void straight(const Joints& to_m, double duration_s, Deed deed = Deed::None) noexcept;
  void along_contour(double from_y_m, double to_y_m) noexcept;
  [[nodiscard]] Joints on(const Leg& leg, double past_s) const noexcept;

  static constexpr std::size_t most_legs = 8;
  Settings settings_{};
  std::array<Leg, most_legs> plan_{};
  Joints end_m_{};
  std::size_t legs_{0};
  std::size_t leg_{0};
  double past_s_{0};
};

}  // namespace hirosco::manipulator
