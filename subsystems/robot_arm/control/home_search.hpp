// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Where joints are to be while they look for their marks one by one (docs/adr/0208). What is measured of a joint may jump, when it finds its zero or loses it:
/// its setpoint jumps along in the same cycle, and an answer to it does not.
class HomeSearch {
 public:
  /// How one joint looks.
  struct Way {
    double speed{0};  ///< rad/s or m/s, to the side of its sign
    double distance{0};  ///< rad or m, so far at most, what it takes to come to rest included
  };
  enum class End : std::uint8_t {
    None,  ///< not yet, or nobody looks
    Done,  ///< all joints know their zero, and it stands
    NotFound,  ///< within the distance there is no mark
    Presses,  ///< something is in the way: it lets go of it, and stands
    Lost,  ///< a joint that knew its zero does not any more
  };
  struct News {
    std::size_t found{
        0};  ///< this joint, the n-th of those that looked, has its zero and stands; 0: none has in this cycle
    End end{End::None};
    std::size_t joint{0};  ///< of the end, from 0
  };
  /// Of a cycle.
  struct Sees {
    const Measured& measured;
    std::span<const std::uint8_t> referenced;  ///< 1 where a joint knows its zero
    std::optional<std::size_t> presses{};  ///< of the law
  };

  explicit HomeSearch(double cycle_s) noexcept : cycle_s_{cycle_s} {}

  /// Stands there from now on, and nobody looks.
  void begin(const Sees& sees) noexcept;
  /// At rest: from the next cycle on those look that do not know their zero, in this order (joints from 0), each with its own way.
  void look(std::span<const std::uint8_t> order, std::span<const Way> ways) noexcept;
  /// Nobody looks any more: who moves comes to rest.
  void stop() noexcept { looks_ = false; }
  /// Moves on by one cycle. An end is told once, in the cycle in which it comes; who moves then comes to rest behind it.
  News advance(const Sees& sees) noexcept;

  [[nodiscard]] const Setpoint& now() const noexcept { return now_; }
  [[nodiscard]] bool at_rest() const noexcept;
  /// Who looks now, from 0: it takes its zero where its mark is.
  [[nodiscard]] std::optional<std::size_t> looking() const noexcept;

 private:
  [[nodiscard]] std::optional<std::size_t> follow_zeros(const Sees& sees) noexcept;
  [[nodiscard]] News search(const Sees& sees) noexcept;
  [[nodiscard]] bool at_its_end() const noexcept;
  void move() noexcept;
  void remember(const Sees& sees) noexcept;
  void stand_at(const JointVector& position) noexcept;
  [[nodiscard]] std::size_t joint() const noexcept { return order_[next_]; }

  double cycle_s_;
  Setpoint now_;
  std::array<std::uint8_t, max_joints> order_{};
  std::array<Way, max_joints> ways_{};
  std::size_t count_{0}, next_{0};  ///< of order_
  std::size_t found_{0};  ///< of those that looked
  bool looks_{false};
  bool goes_{false};  ///< the next one has begun
  bool at_mark_{false};  ///< and has come to its mark
  double begun_at_{0};
  double yields_s_{0};  ///< it is to be wherever it is, so long yet
  JointVector last_position_, last_velocity_;  ///< measured
  std::array<bool, max_joints> knew_{};
};

}  // namespace hirosco::robot_arm
