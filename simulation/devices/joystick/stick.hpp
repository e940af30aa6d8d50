// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "hirosco/utilities/result.hpp"
#include "simulation/world/numerics.hpp"

namespace hirosco::simulation {

/// A stick with a person's hand on it.  Thread: one.
class Stick {
 public:
  virtual ~Stick() = default;
  /// Deflection of both axes, -1..1; nothing once it is unplugged. Never blocks.
  [[nodiscard]] virtual std::optional<Vec2> deflection() noexcept = 0;
  /// Lets the hand feel this share of the largest force, -1..1 per axis, as far as the stick has motors. Never blocks.
  virtual void feel(const Vec2& share) noexcept = 0;
};

/// Opens a stick by its path, or the first one there is by "auto". NotFound: there is none.
using OpenStick = std::function<Result<std::unique_ptr<Stick>>(std::string_view path)>;

}  // namespace hirosco::simulation
