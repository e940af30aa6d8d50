// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "subsystems/robot_arm/control/following.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Whoever leads the joints of an arm, on whatever base, over a real-time link, and whether it still goes along (docs/adr/0179, 0235). What is put out goes through Following, whatever is
/// asked, and no faster than the joints' power may be; who is lost, lets go, or asks for what no arm should do, is followed no more: it slows down within its limits, and stands.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class Lead {
 public:
  /// Places with their velocities, or velocities alone: which of the two a configuration requires is followed there.
  static constexpr std::string_view positions_set = "JOINT_POSITIONS", speeds_set = "JOINT_SPEEDS";

  enum class Why : std::uint8_t {
    Lost,  ///< nothing comes, or what came is too old or said to be wrong
    LetGo,
    NoNumber,
    OutOfRange,
    TooFar,  ///< from the setpoint
    TooFast,
  };
  /// It follows no more; joint from 1, 0: it is no matter of one.
  struct End {
    Why why{};
    std::uint8_t joint{0};
    double value{0};
    double limit{0};
  };
  /// It follows nobody: why, and with which number.
  struct NotLed {
    const char* text{""};
    std::int64_t number{0};
  };
  explicit Lead(const UrdfArm& known) noexcept : known_{known} {}

  /// Whether the descriptor has a configuration in which somebody leads.
  [[nodiscard]] static bool declared(const descriptor::SubsystemDescriptor& subsystem, std::string_view set);
  /// Calls `publish(name, cell)` for each parameter of it.
  template <class Publish>
  void each(const Publish& publish) {
    publish("LEAD", told_);
    publish("LEAD_LIMITS", limits_);
  }
  /// For require_link().
  [[nodiscard]] LinkInputPort& positions() noexcept { return positions_; }
  [[nodiscard]] LinkInputPort& speeds() noexcept { return speeds_; }

  /// In configure().  Mismatch: a required set has another length than the robot has joints, or there are two that lead.
  /// Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> begin(const descriptor::Configuration& configuration, double cycle_s);
  /// FOLLOW, at rest: from now on. Places have to be near the setpoint: it goes to where they are, and nothing between them is kept.
  [[nodiscard]] std::optional<NotLed> follow(Setpoints& setpoints) noexcept;

  /// Somebody does in this configuration, or may.
  [[nodiscard]] bool leads() const noexcept { return by_ != By::Nobody; }

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  /// LEAD.
  void tell(const Setpoints& setpoints) noexcept;
  /// Nobody is followed any more, and it does not stand yet.
  [[nodiscard]] bool slows_down() const noexcept { return phase_ == Phase::Stops; }
  /// Before the setpoint is advanced; why it ends, once.
  [[nodiscard]] std::optional<End> advance(Setpoints& setpoints) noexcept;

 private:
  enum class By : std::uint8_t { Nobody, Positions, Speeds };
  enum class Phase : std::uint8_t { Off, Follows, Stops };  ///< of LEADING
  [[nodiscard]] const LinkInputPort& port() const noexcept;
  [[nodiscard]] std::optional<End> unfit(double most_apart, const Setpoint& now) const noexcept;
  [[nodiscard]] std::optional<End> unfit_joint(std::size_t joint, double most_apart,
                                               const Setpoint& now) const noexcept;
  [[nodiscard]] const Setpoint& next() noexcept;
  [[nodiscard]] double apart(const Setpoint& now) const noexcept;

  const UrdfArm& known_;
  Parameter<LeadValues> told_;
  Parameter<LeadLimits> limits_;
  LinkInput<LedToPositions> positions_;
  LinkInput<LedWithSpeeds> speeds_;
  std::optional<Following> following_;
  By by_{By::Nobody};
  Phase phase_{Phase::Off};
};

}  // namespace hirosco::robot_arm
