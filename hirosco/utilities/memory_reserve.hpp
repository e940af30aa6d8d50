// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace hirosco {

/// Memory that nobody uses until `new` finds none, in whichever thread: then it is given back, once, so that what was begun comes to its end,
/// and whoever looks at used() ends the process at a moment of its own choice (docs/adr/0114). What finds no memory after that throws
/// std::bad_alloc, as ever; malloc() knows nothing of it. One at a time in a process.
class MemoryReserve {
 public:
  /// Throws std::bad_alloc. Untouched, it costs addresses and no memory.
  explicit MemoryReserve(std::size_t octets);
  ~MemoryReserve();
  MemoryReserve(const MemoryReserve&) = delete;
  MemoryReserve& operator=(const MemoryReserve&) = delete;

  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] bool used() const noexcept;

 private:
  void (*before_)();  ///< what was asked for memory before this
};

}  // namespace hirosco
