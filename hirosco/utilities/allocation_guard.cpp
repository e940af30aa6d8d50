// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/allocation_guard.hpp"

#include <cstdlib>
#include <utility>

#include "hirosco/utilities/refused_allocations.hpp"

// Defined by the hook, absent without it.
extern "C" [[gnu::weak]] bool hirosco_malloc_hook_present() noexcept;

namespace hirosco {
namespace {

struct ThreadState {
  unsigned depth{0};
  HeapUse use{HeapUse::Count};
  AllocationCount count;
  RealtimeUses waits;  // `heap` is in `count`
  bool refusals_count{false};
  std::uint64_t until_refusal{0};  // of those that count; 0: none is refused
  bool refused{false};
};
// The one thread_local of the framework: malloc has no parameter to pass it in. Constant initialisation and this model
// keep its access free of malloc, which would recur.
[[gnu::tls_model("initial-exec")]] constinit thread_local ThreadState thread_state;

}  // namespace

RealtimeScope::RealtimeScope() noexcept : RealtimeScope{thread_state.use} {}

RealtimeScope::RealtimeScope(HeapUse use) noexcept
    : start_{thread_state.count}, start_waits_{thread_state.waits}, outer_use_{std::exchange(thread_state.use, use)} {
  ++thread_state.depth;
}

RealtimeScope::~RealtimeScope() {
  --thread_state.depth;
  thread_state.use = outer_use_;
}

AllocationCount RealtimeScope::count() const noexcept {
  const AllocationCount& now = thread_state.count;
  return {now.allocations - start_.allocations, now.frees - start_.frees, now.octets - start_.octets};
}

RealtimeUses RealtimeScope::uses() const noexcept {
  const AllocationCount heap = count();
  const RealtimeUses& now = thread_state.waits;
  return {heap.allocations + heap.frees, now.locks - start_waits_.locks, now.outputs - start_waits_.outputs};
}

bool RealtimeScope::hook_present() noexcept {
  return hirosco_malloc_hook_present != nullptr && hirosco_malloc_hook_present();
}

HeapPermitted::HeapPermitted() noexcept : depth_{std::exchange(thread_state.depth, 0U)} {}

HeapPermitted::~HeapPermitted() { thread_state.depth = depth_; }

void RefusedAllocations::refuse(std::uint64_t number) noexcept {
  thread_state.until_refusal = number;
  thread_state.refused = false;
}

bool RefusedAllocations::refused() const noexcept { return thread_state.refused; }

void RefusedAllocations::set_counting(bool on) noexcept { thread_state.refusals_count = on; }

RefusedAllocations::~RefusedAllocations() {
  set_counting(false);
  refuse(0);
}

}  // namespace hirosco

bool hirosco_refuses_allocation() noexcept {
  auto& state = hirosco::thread_state;
  const bool refuses = state.refusals_count && state.until_refusal > 0 && --state.until_refusal == 0;
  state.refused = state.refused || refuses;
  return refuses;
}

[[gnu::noinline]] void hirosco_forbidden_use() noexcept { asm volatile(""); }

void hirosco_note_allocation(std::size_t octets) noexcept {
  auto& state = hirosco::thread_state;
  if (state.depth == 0) return;
  if (state.use == hirosco::HeapUse::Abort) std::abort();
  hirosco_forbidden_use();
  ++state.count.allocations;
  state.count.octets += octets;
}

void hirosco_note_free() noexcept {
  auto& state = hirosco::thread_state;
  if (state.depth == 0) return;
  if (state.use == hirosco::HeapUse::Abort) std::abort();
  hirosco_forbidden_use();
  ++state.count.frees;
}

void hirosco_note_lock() noexcept {
  auto& state = hirosco::thread_state;
  if (state.depth == 0) return;
  hirosco_forbidden_use();
  ++state.waits.locks;
}

void hirosco_note_output() noexcept {
  auto& state = hirosco::thread_state;
  if (state.depth == 0) return;
  hirosco_forbidden_use();
  ++state.waits.outputs;
}
