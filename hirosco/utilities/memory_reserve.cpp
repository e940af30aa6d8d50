// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/memory_reserve.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace hirosco {
namespace {

/// Whoever is asked for memory has no argument.
std::atomic<void*>& kept_in_reserve() noexcept {
  static std::atomic<void*> octets{nullptr};
  return octets;
}

void give_reserve_back() {
  void* const octets = kept_in_reserve().exchange(nullptr);
  if (octets == nullptr) throw std::bad_alloc{};
  std::free(octets);
}

}  // namespace

MemoryReserve::MemoryReserve(std::size_t octets) {
  void* const taken = std::malloc(octets);
  if (taken == nullptr) throw std::bad_alloc{};
  kept_in_reserve().store(taken);
  before_ = std::set_new_handler(give_reserve_back);
}

MemoryReserve::~MemoryReserve() {
  std::set_new_handler(before_);
  std::free(kept_in_reserve().exchange(nullptr));
}

bool MemoryReserve::used() const noexcept { return kept_in_reserve().load(std::memory_order_relaxed) == nullptr; }

}  // namespace hirosco
