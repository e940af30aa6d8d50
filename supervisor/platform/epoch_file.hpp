// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// Remembers beyond the flight which epochs devices may have seen, so that one that outlives the supervisor neither stays
/// latched nor takes an old command for a new one (hazard SF11).
namespace hirosco::supervisor {

/// Thread: the supervisor's. Realtime: blocks; hardly ever after first().
class EpochFile {
 public:
  explicit EpochFile(std::filesystem::path path) : path_{std::move(path)} {}
  /// Epoch that a flight begins with: above all that were kept, and not below the seconds since 2020.
  /// OutOfRange: the numbers have run out. A file that cannot be read or written leaves the clock's number.
  [[nodiscard]] Result<std::uint32_t> first(OnboardTime now);
  /// Reserves further epochs before they are used up.
  void keep_above(std::uint32_t used);
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  void write(std::uint32_t reserved);
  std::filesystem::path path_;
  std::uint32_t reserved_{0};
};

}  // namespace hirosco::supervisor
