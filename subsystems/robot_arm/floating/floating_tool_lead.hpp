// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/lead.hpp"

namespace hirosco::robot_arm {

/// Whoever leads the tool of an arm on a base that floats over a real-time link, in the axes of TOOL, and whether it still goes along (docs/adr/0245). What it is asked for becomes velocities of
/// the tool's goal, with the limits of its jogs whatever is asked; who is lost, lets go, or asks for what no tool should do, is followed no more: the goal slows down within them, and stands.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingToolLead {
 public:
  static constexpr std::string_view set = "TOOL_POSE";
  /// A goal turns no faster: as JOG_L of the descriptor about one axis.
  static constexpr double most_turning_rad_s = 0.05;

  explicit FloatingToolLead(const FloatingParameters& parameters) noexcept : parameters_{parameters} {}

  /// Calls `publish(name, cell)` for each parameter of it.
  template <class Publish>
  void each(const Publish& publish) {
    publish("TOOL_LEAD", told_);
    publish("TOOL_LEAD_LIMITS", limits_);
  }
  /// For require_link().
  [[nodiscard]] LinkInputPort& port() noexcept { return pose_; }

  /// In configure().  Thread: the service loop.
  void begin(const descriptor::Configuration& configuration, double cycle_s) noexcept;
  /// Somebody does in this configuration, or may.
  [[nodiscard]] bool leads() const noexcept { return leads_; }
  /// FOLLOW, from a goal that stands there: from now on. It has to be near: nothing between them is kept.
  [[nodiscard]] std::optional<Lead::NotLed> follow(const robotics::Pose& goal) noexcept;

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  /// TOOL_LEAD. `goes`: the goal still does as it says; HOLD, or whatever else brought the arm to rest, has ended it.
  void tell(const robotics::Pose& goal, bool goes) noexcept;
  /// Before the goal, which is there now, goes on; why it ends, once, without a joint.
  [[nodiscard]] std::optional<Lead::End> advance(const robotics::Pose& goal) noexcept;
  /// With which velocities: rad/s and m/s.
  [[nodiscard]] const Vector3& turning() const noexcept { return turning_; }
  [[nodiscard]] const Vector3& moving() const noexcept { return moving_; }
  /// Nobody is followed any more, and the goal stands.
  [[nodiscard]] bool over() const noexcept { return phase_ == Phase::Off; }

 private:
  enum class Phase : std::uint8_t { Off, Follows, Stops };  ///< of LEADING
  /// How far the goal is from where it is led, and how fast that goes.
  struct Way {
    Vector3 left_m, left_rad, velocity_m_s, turning_rad_s;
  };
  [[nodiscard]] Way way(const robotics::Pose& goal) const noexcept;
  [[nodiscard]] std::optional<Lead::End> unfit(const robotics::Pose& goal, double most_m,
                                               double most_rad) const noexcept;

  const FloatingParameters& parameters_;
  Parameter<ToolLeadValues> told_;
  Parameter<ToolLeadLimits> limits_;
  LinkInput<LedTool> pose_;
  double cycle_s_{0.001};
  bool leads_{false};
  Phase phase_{Phase::Off};
  Vector3 turning_{Vector3::Zero()}, moving_{Vector3::Zero()};
};

}  // namespace hirosco::robot_arm
