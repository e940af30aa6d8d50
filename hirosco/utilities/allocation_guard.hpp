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
  AllocationCount& operator+=(const AllocationCount& more) noexcept {
    allocations += more.allocations;
    frees += more.frees;
    octets += more.octets;
    return *this;
  }
  friend bool operator==(const AllocationCount&, const AllocationCount&) = default;
};

/// What one thread has done that real time forbids, in numbers of calls.
struct RealtimeUses {
  std::uint64_t heap{0};     ///< allocations and frees
  std::uint64_t locks{0};    ///< of mutexes, read-write locks and semaphores, whether they were free or not
  std::uint64_t outputs{0};  ///< of text or octets: stdio, streams, fmt, write()
  friend bool operator==(const RealtimeUses&, const RealtimeUses&) = default;
};

/// What happens on a use of the heap inside a RealtimeScope.
enum class HeapUse : std::uint8_t {
  Count,
  Abort,  ///< for tests: the stack of the core dump shows who it was
};

/// Marks the code of a scope as real time: it must neither use the heap nor lock nor put out. Counts what the calling thread
/// does of it since the outermost scope began; a scope inside a scope counts on. Needs `hirosco_malloc_hook` linked into the
/// executable for the heap, `hirosco_realtime_hook` for all; otherwise it counts nothing and hook_present() says so.
/// Realtime: wait-free. Thread: the one that made it, which also destroys it.
class RealtimeScope {
 public:
  /// A use of the heap does what it does in the scope around this one; it is counted where there is none.
  RealtimeScope() noexcept;
  explicit RealtimeScope(HeapUse use) noexcept;
  ~RealtimeScope();
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;

  /// Since this scope began.
  [[nodiscard]] AllocationCount count() const noexcept;
  [[nodiscard]] RealtimeUses uses() const noexcept;
  /// Whether this executable counts at all.
  [[nodiscard]] static bool hook_present() noexcept;

 private:
  AllocationCount start_;
  RealtimeUses start_waits_;  ///< `heap` is not counted here
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
/// For the hooks only: one use by the calling thread.
void hirosco_note_allocation(std::size_t octets) noexcept;
void hirosco_note_free() noexcept;
void hirosco_note_lock() noexcept;
void hirosco_note_output() noexcept;
/// Called by each of these inside a scope. It does nothing: a debugger stops here, and the stack shows who it was.
void hirosco_forbidden_use() noexcept;
}
