// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/result.hpp"
#include "subsystems/manipulator/control/joints.hpp"

namespace hirosco::manipulator {

/// What an arm is told by its descriptor: how many joints it has, how far each moves, where home is.
class DescribedJoints {
 public:
  /// As many joints as DES_POSITION has elements, `count`, whose initial value is home; MOVE_TO says how far each moves.
  /// Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> read(const descriptor::SubsystemDescriptor& arm, std::size_t count);

  [[nodiscard]] std::size_t count() const noexcept { return home_rad_.size(); }
  [[nodiscard]] const Joints& home_rad() const noexcept { return home_rad_; }
  [[nodiscard]] const Joints& lowest_rad() const noexcept { return lowest_rad_; }
  [[nodiscard]] const Joints& highest_rad() const noexcept { return highest_rad_; }
  /// The nearest position that the joints can take.  Realtime: bounded, no allocation.
  [[nodiscard]] Joints within_range(Joints position_rad) const noexcept;

 private:
  Joints home_rad_, lowest_rad_, highest_rad_;
};

}  // namespace hirosco::manipulator
