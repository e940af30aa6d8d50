// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "missions/servicer/scenarios/servicer.hpp"

namespace hirosco::simulation {

/// What the sun and the battery are.
struct Light {
  double sun_angle_deg{0};
  double charge{0.9};
  bool eclipse{false};
};

/// Whether the whole craft is let into mode track in that light, asked from where it is.
struct Grant {
  bool granted{false};
  double free_w{0};  ///< as the refusal says; nothing where it does not
};
[[nodiscard]] Grant ask_for_track(ServicerCraft& craft, const Light& light);

/// The sun goes while the arm moves its tool.
struct Brake {
  double told_s{0};  ///< from the eclipse to BUS_LOW, and to the arm at rest
  double rest_s{0};
  double farthest_m{0};  ///< that the tool went on
  double speed_m_s{0};  ///< of the tool when it happened
};
/// In mode track, `after_s` into a motion of 0.2 m in 20 s.
[[nodiscard]] Brake eclipse_in_motion(ServicerCraft& craft, double after_s);

[[nodiscard]] Findings fly_power(const ServicerSettings& settings);

}  // namespace hirosco::simulation
