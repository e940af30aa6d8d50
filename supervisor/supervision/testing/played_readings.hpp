// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "supervisor/platform/launch/descriptor_readings.hpp"

namespace hirosco::supervisor::testing {

/// A disk that gives what the test says, when it says so.
struct PlayedReadings final : DescriptorReadings {
  Result<> begin(const descriptor::Mission&, const std::filesystem::path& file) override {
    asked.push_back(file.string());
    return ok();
  }
  std::optional<DescriptorReading> outcome() override { return std::exchange(next, std::nullopt); }
  std::vector<std::string> asked;
  std::optional<DescriptorReading> next;
};

}  // namespace hirosco::supervisor::testing
