// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {

/// The threads of a process, as the system lists them. Whoever has real time may list them, by which he waits at most for who looks at the
/// same one for the first time; he may not open what is told of each, nor the list itself of a process that may have ended: who walks there
/// can be held for good (docs/adr/0240).
/// Thread: one at a time.
class ProcessThreads {
 public:
  /// Of none.
  ProcessThreads() = default;
  /// Of a process whose number is not used anew meanwhile; none where it has ended. Realtime: no, but of a child that nobody has collected.
  [[nodiscard]] static ProcessThreads of(int process) noexcept;

  [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(folder_); }
  /// Calls `with` for each by its number, which it may be ended before. It takes nothing from the heap. Realtime: system calls, bounded.
  template <class With>
  void each(With&& with) noexcept {
    if (!rewind()) return;
    std::array<int, 64> numbers;
    for (std::size_t count = 0; (count = next(numbers)) > 0;)
      for (const int thread : std::span{numbers}.first(count)) with(thread);
  }
  /// What the system tells of one of them: "stat", "comm", "children"; none where it has ended. Realtime: no.
  [[nodiscard]] FileDescriptor open(int thread, std::string_view file) const noexcept;

 private:
  explicit ProcessThreads(FileDescriptor folder) noexcept : folder_{std::move(folder)} {}
  [[nodiscard]] bool rewind() noexcept;
  /// How many; 0: that was all.
  [[nodiscard]] std::size_t next(std::span<int, 64> numbers) noexcept;
  FileDescriptor folder_;
};

}  // namespace hirosco
