// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// A telecommand by its names, as `hirosco tc` and `hirosco simulate --at` take it.
namespace hirosco::tools {

struct NamedRequest {
  const descriptor::SubsystemDescriptor* subsystem{nullptr};  ///< of the mission: it lives as long
  descriptor::Function request;
  std::vector<std::byte> data;  ///< behind the secondary header
};

/// Names in either case; values in order, or as NAME=VALUE, with states, modes, configurations and strategies by their names where a request
/// of everybody's takes one.  \return In words: which of them is none, and which ones there are, in one line or several.
[[nodiscard]] std::expected<NamedRequest, std::string> named_request(const descriptor::Mission& mission,
                                                                     const std::string& subsystem,
                                                                     const std::string& function,
                                                                     std::span<const std::string> arguments);

}  // namespace hirosco::tools
