// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "hirosco/subsystem/testing/driven.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm::testing {

/// ABORT_PATH by TC[20,3], as ground writes it.
inline hirosco::testing::Sent write_path(hirosco::testing::Driven& arm, const std::vector<JointVector>& postures) {
  const auto& descriptor = arm.rig.descriptor();
  const auto its = std::ranges::find(descriptor.parameters, std::string_view{"ABORT_PATH"},
                                     [](const auto& each) { return std::string_view{each.field.name}; });
  std::vector<std::byte> data(1 + 4 + its->octets());
  OctetWriter writer{data};
  writer.put(std::uint8_t{1}).put(ParameterId{descriptor.id, its->field.type, its->id}.wire());
  writer.put(static_cast<std::uint8_t>(postures.size()));
  for (const JointVector& posture : postures)
    for (const double joint : posture) writer.put(static_cast<float>(joint));
  const auto sent = arm.rig.send(20, 3, data);
  arm.cycle(3);
  return sent;
}

}  // namespace hirosco::robot_arm::testing
