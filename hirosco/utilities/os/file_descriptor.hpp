// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Owns one descriptor of the operating system and closes it. -1 is none.
/// Realtime: get() is wait-free, the rest blocks. Thread: one at a time.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int number) noexcept : number_{number} {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { reset(); }

  [[nodiscard]] int get() const noexcept { return number_; }
  [[nodiscard]] bool valid() const noexcept { return number_ >= 0; }
  explicit operator bool() const noexcept { return valid(); }
  /// Gives ownership away.
  [[nodiscard]] int release() noexcept { return std::exchange(number_, -1); }
  /// Closes what it owned and owns `number` instead.
  void reset(int number = -1) noexcept;
  /// A second descriptor of the same open file, closed on exec.
  [[nodiscard]] Result<FileDescriptor> duplicate() const noexcept;

 private:
  int number_{-1};
};

}  // namespace hirosco
