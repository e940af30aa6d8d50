// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Why a motion ended that met somebody while cycles were missed, before how many (SampleTime): what was felt then is to be doubted sooner (docs/adr/0229).
inline constexpr const char* cycles_missed_before = "cycles were missed in the second before:";

/// Whether what acts on the joints of an arm, on whatever base, is a contact (docs/adr/0117): more than a share of a joint's effort for some cycles, beside what stood there before.
/// Realtime: wait-free, no allocation. Thread: the cycle, and the service loop while there is none.
class JointContact {
 public:
  /// What is done about one; REACTIONS of the descriptor.
  enum class Reaction : std::uint8_t {
    None,
    Stop,  ///< stands where it was met
    Float,  ///< gives way from then on
    Retract,  ///< backs off by the way it came, then stands
  };
  /// What acts from outside already counts from now on, too; or stands beside, where a motion begins with it, and what comes to it counts.
  enum class Before : std::uint8_t { Counts, Stands };
  /// Of efforts.
  struct Limits {
    double contact{0};
    double torque{0};  ///< that its joints are stopped at
  };
  /// N m or N of the joint, from 0, that feels most of it; the limit with what stood there when its motion began.
  struct Contact {
    std::size_t joint{0};
    double torque{0};
    double limit{0};
  };

  /// Whoever is met from now on is told, whatever was told before. `external`: N m or N of each joint.
  void arm(Before load, const JointVector& external, Bounds bounds, const Limits& limits) noexcept;
  /// Each cycle: what it met, once for each time; nothing mostly.
  [[nodiscard]] std::optional<Contact> meet(const JointVector& external, Bounds bounds, double limit) noexcept;

 private:
  [[nodiscard]] double counts_from(Eigen::Index joint, double share, double limit) noexcept;

  std::uint32_t cycles_{0};
  JointVector borne_;  ///< shares of efforts, of a load that stood when a motion began; of no length: none
};

}  // namespace hirosco::robot_arm
