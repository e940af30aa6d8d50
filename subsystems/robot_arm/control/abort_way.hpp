// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Out by a stored path (docs/adr/0199): postures, all joints on a straight line from each to the next, and to one of them from where the arm stands. Before it goes
/// that is judged, a posture in a cycle: the path from its end back, as far as it is free, by itself; then the way to the nearest posture of that part, and to the next nearest where
/// something is in the way. Who is too near already where he stands may go away from there, as in any motion; to what is stored that is nothing.
/// How many postures are looked at is bounded: what needs more is not judged in part, and not gone.
class AbortWay {
 public:
  static constexpr std::size_t most = 8;
  /// Between two postures that are looked at, of the joint that has farthest to go, rad or m. What lies between them the motion itself is watched for.
  static constexpr double spacing = 0.02;

  enum class Judged : std::uint8_t {
    PathAlone,  ///< all of it; the arm goes nowhere
    FromHere,
  };
  enum class Found : std::uint8_t {
    NotYet,
    Way,
    Nothing,
    TooLong,  ///< more would have to be looked at than may
  };

  /// 1 to `most` postures, of which with all that lies between `most_looks` are looked at; then found() is NotYet, or TooLong: as soon as it is known.
  void begin(std::span<const JointVector> postures, const JointVector& here, Judged what,
             std::size_t most_looks) noexcept;

  // --- while found() is NotYet, once in each cycle ------------------------------------------------------------------------
  /// Who is nearer there than he may be; and, unless that is judged by_itself(), than in the posture before it? heed() takes the answer.
  [[nodiscard]] const JointVector& then() const noexcept { return then_; }
  [[nodiscard]] const JointVector& before() const noexcept { return before_; }
  /// It is of what is stored, and not of the way there.
  [[nodiscard]] bool by_itself() const noexcept { return !joins_; }
  void heed(const robotics::Clearance::Nearest& nearer) noexcept;

  // --- of what was judged -------------------------------------------------------------------------------------------------
  [[nodiscard]] Found found() const noexcept { return found_; }
  /// Of all that there may be to look at, 0 to 1; 1 as soon as it is judged.
  [[nodiscard]] double progress() const noexcept;
  /// Of Nothing: who is in the way, and of which posture, from 0.
  [[nodiscard]] const robotics::Clearance::Nearest& in_the_way() const noexcept { return in_the_way_; }
  [[nodiscard]] std::size_t blocked() const noexcept { return blocked_; }
  /// Of Way: it begins with going there, from 0.
  [[nodiscard]] std::size_t joined() const noexcept { return to_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const JointVector& posture(std::size_t i) const noexcept { return postures_[i]; }
  /// Where the arm stood.
  [[nodiscard]] const JointVector& here() const noexcept { return here_; }

 private:
  void count_looks() noexcept;
  void look_along(const JointVector& from, std::size_t to) noexcept;
  void step() noexcept;
  void end_of_segment() noexcept;
  void join() noexcept;

  std::array<JointVector, most> postures_{};
  std::size_t size_{0};
  JointVector here_, from_, before_, then_;
  std::size_t to_{0};
  std::size_t steps_{1}, step_{0};
  std::size_t most_looks_{0}, all_looks_{1}, looked_{0};
  Judged what_{Judged::PathAlone};
  Found found_{Found::Nothing};
  bool joins_{false};
  std::size_t first_{0};  ///< from it on the path is free
  std::array<bool, most> tried_{};
  bool was_blocked_{false};  ///< on a way to join
  robotics::Clearance::Nearest in_the_way_;
  std::size_t blocked_{0};
};

}  // namespace hirosco::robot_arm
