// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace hirosco {

/// Uses of the heap by one thread.
struct AllocationCount {
  std::uint64_t allocations{0};  ///< malloc, calloc, realloc, aligned_alloc and what stands on them (operator new)
  std::uint64_t frees{0};
  std::uint64_t octets{0};       ///< asked for
  friend bool operator==(const AllocationCount&, const AllocationCount&) = default;
};

/// What happens on a use of the heap inside a RealtimeScope.
enum class HeapUse : std::uint8_t {
  Count,
  Abort,  ///< for tests: the stack of the core dump shows who it was
};

/// Marks the code of a scope as real time: it must not use the heap. Counts the calling thread's uses since the
/// outermost scope began; a scope inside a scope counts on. Needs the hook `hirosco_malloc_hook` linked into the
/// executable, otherwise it counts nothing and hook_present() says so.
/// Realtime: wait-free. Thread: the one that made it, which also destroys it.
class RealtimeScope {
 public:
  explicit RealtimeScope(HeapUse use = HeapUse::Count) noexcept;
  ~RealtimeScope();
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;

  /// Since this scope began.
  [[nodiscard]] AllocationCount count() const noexcept;
  /// Whether this executable counts at all.
  [[nodiscard]] static bool hook_present() noexcept;

 private:
  AllocationCount start_;
  HeapUse outer_use_;
};

/// Suspends the innermost RealtimeScope of this thread, for a place that is allowed the heap (a state change between two
/// cycles). Realtime: wait-free.
class HeapPermitted {
 public:
  HeapPermitted() noexcept;
  ~HeapPermitted();
  HeapPermitted(const HeapPermitted&) = delete;
  HeapPermitted& operator=(const HeapPermitted&) = delete;

 private:
  unsigned depth_;
};

}  // namespace hirosco

extern "C" {
/// For the hook only: one use of the heap by the calling thread.
void hirosco_note_allocation(std::size_t octets) noexcept;
void hirosco_note_free() noexcept;
}
