// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace hirosco::tools {

/// Lines of a file that somebody else writes: whatever comes, no more of a line is kept than `most` octets.  Thread: one.
class BoundedLines {
 public:
  enum class Next : std::uint8_t {
    Line,  ///< in line(), without its end
    TooLong,  ///< passed over to its end; the next one comes as if it had not been there
    End,
    Failed,  ///< errno says why
  };
  /// `file` must outlive this.
  BoundedLines(std::FILE* file, std::size_t most) : file_{file}, most_{most} {}

  /// Waits for it.  Realtime: allocates.
  [[nodiscard]] Next next();
  [[nodiscard]] const std::string& line() const noexcept { return line_; }

 private:
  std::FILE* file_;
  std::size_t most_;
  std::string line_;
};

}  // namespace hirosco::tools
