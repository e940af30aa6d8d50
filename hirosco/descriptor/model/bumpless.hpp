// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hirosco/descriptor/model/location.hpp"

/// Between which configurations a subsystem goes without a break (docs/adr/0096). Plain data, as the descriptor says it.
namespace hirosco::descriptor {

/// Configurations between which CONFIGURE goes while the subsystem acts, both ways, each with each.
struct Bumpless {
  std::vector<std::uint8_t> configurations;  ///< ids
  /// The largest difference of an actuator's output from one cycle to the next where the configuration changes.
  struct Step {
    std::uint16_t device{};  ///< index into SubsystemDescriptor::devices
    std::uint16_t output{};  ///< index into Device::output; each element of an array
    double most{0};  ///< in the unit of the output
  };
  std::vector<Step> steps;  ///< one for each output of each actuator that they use
  Location at{};
};

}  // namespace hirosco::descriptor
