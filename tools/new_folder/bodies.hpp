// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "robotics/urdf/robot.hpp"

/// `hirosco new robot`: links of which the world of a simulated flight makes no bodies.
namespace hirosco::tools {

struct RefusedBody {
  std::string link;
  const char* code{nullptr};  ///< of docs/urdf-errors.md
  std::string message, hint;
};
/// First those with moments that no body has, then those that lack some. Of links that are fixed to each other that of all of them counts; one that
/// carries a joint may have no moment at all.
[[nodiscard]] std::vector<RefusedBody> refused_bodies(const robotics::urdf::Robot& robot);

}  // namespace hirosco::tools
