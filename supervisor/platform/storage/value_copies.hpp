// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <expected>
#include <filesystem>

#include "hirosco/utilities/result.hpp"
#include "supervisor/platform/storage/value_copy.hpp"
#include "supervisor/platform/storage/value_disk.hpp"

namespace hirosco::supervisor {

/// Of both copies, each by itself.
using TwoCopies = std::array<std::expected<ValueCopy, CopyFault>, 2>;

/// The two copies of one subsystem's values, NAME.1 and NAME.2. A change is written into both, one after the other, each into a file
/// beside it that takes its name when it is on the disk; first into the one that is not the newest whole one. So at any moment one is
/// whole and has the newest change or the one before it, and when write() has returned either of them alone has the newest.
/// Thread: one.
class ValueCopies {
 public:
  /// `disk` must outlive this.
  ValueCopies(ValueDisk& disk, std::filesystem::path file) : disk_{disk}, file_{std::move(file)} {}

  /// Missing: it is not there; both are before anything was kept.
  [[nodiscard]] TwoCopies read();
  /// Into both. After an error the next call does all of it again.
  [[nodiscard]] Result<> write(const ValueCopy& copy);
  [[nodiscard]] std::filesystem::path path(std::size_t copy) const;

 private:
  [[nodiscard]] Result<> replace(std::size_t copy, Octets octets);

  ValueDisk& disk_;
  std::filesystem::path file_;
  std::size_t whole_{1};  ///< the newest whole one
};

}  // namespace hirosco::supervisor
