// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/programme.hpp"
#include "subsystems/manipulator/two_joint/contour.hpp"

namespace hirosco::manipulator::two_joint {

/// Motions of the tip: along the contour, or with the vertical spring.
class Script final : public Programme {
 public:
  enum class Id : std::uint8_t { Contour = 1, Spring = 2 };
  struct Settings {
    double speed_m_s{0.020};      ///< along the rail
    double over_press_m{0.006};   ///< of the setpoint into the contour
    Surroundings surroundings{};
  };

  explicit Script(const Geometry& geometry) noexcept : geometry_{geometry} {}
  /// Begins at `from_rad` and ends at `home_rad`.
  void start(Id id, const Joints& from_rad, const Joints& home_rad, const Settings& settings) noexcept;
  /// Moves on and returns where the tip is to be, m.
  Point advance_tip(double span_s) noexcept;

  Joints advance(double span_s) noexcept override { return joints_for(geometry_, advance_tip(span_s)); }
  [[nodiscard]] std::optional<std::uint8_t> tool() const noexcept override { return legs_.tool(); }
  void tool_done() noexcept override { legs_.tool_done(); }
  [[nodiscard]] bool done() const noexcept override { return legs_.done(); }
  [[nodiscard]] std::size_t leg() const noexcept override { return legs_.leg(); }
  [[nodiscard]] Joints goal_rad() const noexcept override { return home_rad_; }

 private:
  struct Way {
    enum class Path : std::uint8_t { Straight, AlongContour };
    Path path{Path::Straight};
    Point from_m{};
    Point to_m{};  ///< AlongContour: [1] of both is the ordinate on the surface
  };
  void straight(const Point& to_m, double duration_s, std::optional<std::uint8_t> tool = {}) noexcept;
  void along_contour(double from_y_m, double to_y_m) noexcept;
  void add(const Way& way, const Legs::Leg& leg) noexcept;

  Geometry geometry_;
  Settings settings_{};
  Legs legs_;
  std::array<Way, Legs::most> ways_{};
  Point end_m_{};
  Joints home_rad_{};
};

}  // namespace hirosco::manipulator::two_joint
