// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco {

/// Lets allocations of one thread find no memory, to try what is done then; one at a time. Needs `hirosco_malloc_hook`. Who asked by `new`
/// comes to the handler that std::set_new_handler() has set, and there is memory again for it and for all that follows.
/// Thread: the one that made it, which also destroys it.
class RefusedAllocations {
 public:
  RefusedAllocations() noexcept = default;
  ~RefusedAllocations();
  RefusedAllocations(const RefusedAllocations&) = delete;
  RefusedAllocations& operator=(const RefusedAllocations&) = delete;
  /// Of those that are counted from now on this one is refused, from 1; 0: none.
  void refuse(std::uint64_t number) noexcept;
  /// It has been, since then.
  [[nodiscard]] bool refused() const noexcept;
  /// Whether what is asked for from now on counts. At first it does not.
  void set_counting(bool on) noexcept;
};

}  // namespace hirosco

extern "C" {
/// For the hook: this one finds no memory.
[[nodiscard]] bool hirosco_refuses_allocation() noexcept;
}
